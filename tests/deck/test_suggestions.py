"""Suggestions: made only where the suggested keyword fits the spelling and the rest of the line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from udec_ia.deck.deck_statements import statements
from udec_ia.deck.lines_and_calls import parse
from udec_ia.deck.udec7_words import Reading, read_line
from udec_ia.errors import UdecError

# Lines as users of UDEC 7 type them: the command that they are, what they are read as, or ANSWER.
TYPED, FORMS = (
    [
        tuple(part.strip() for part in line.split("|", 1))
        for line in (Path(__file__).parent / name).read_text().splitlines()
    ]
    for name in ("typed_lines.txt", "typed_forms.txt")
)  # those of an old collection, and other forms of them


def answer(line: str) -> str:
    """The command that `line` is, or the number of the error and the keyword that it suggests."""
    (statement,) = statements([line], "typed")
    try:
        return parse(statement).command.name.upper()
    except UdecError as error:
        suggested = re.match(r"did you mean (.*)\?", error.advice)
        return f"{error.number} {suggested[1]}" if suggested else str(error.number)


def reading(line: str, has_zones: bool = False) -> str:
    """The same for a line in the words of UDEC 7, whose translation must be lines of ours."""
    (statement,) = statements([line], "typed")
    found = read_line(statement.tokens, lambda: has_zones)
    if not isinstance(found, Reading):
        assert found is None or found.text
        return "" if found is None else "ANSWER"
    for text in found.lines:
        (ours,) = statements([text], "read")
        parse(ours)
    return f"READ {'; '.join(found.lines)}".strip()


@pytest.mark.parametrize(("expected", "line"), TYPED + FORMS)
def test_the_answer_to_a_typed_line(expected: str, line: str) -> None:
    ours = answer(line)
    assert expected == (reading(line) if ours[0].isdigit() else ours)


def test_most_lines_are_understood() -> None:
    assert sum(expected != "ANSWER" for expected, _ in TYPED) >= 110
    assert len(TYPED) == 151


def test_the_page_on_udec_7_has_all_lines() -> None:
    page = (Path(__file__).parents[2] / "docs" / "from-udec-7.md").read_text()
    for expected, line in TYPED + FORMS:
        row = next(row for row in page.splitlines() if row.startswith(f"| `{line}` |"))
        if expected.startswith("READ "):
            assert all(f"`{text}`" in row for text in expected.removeprefix("READ ").split("; "))
        elif expected == "ANSWER":
            assert row.split(" | ")[1] == "-"


def test_angles_become_tangents_and_moduli_are_converted() -> None:
    assert "FRICTION=0.5773502692" in reading("prop jmat 2 jkn 1e9 jks 1e9 jfric 30")
    assert "DILATION=0.1763269807" in reading("prop jmat=2 jdil=10")
    line = reading("prop mat=3 dens=2500 ymod=3e9 prat=0.2")
    k, g = (float(re.search(rf"{name}=(\S+)", line)[1]) for name in ("BULK", "G"))  # type: ignore[index]
    assert 9 * k * g / (3 * k + g) == pytest.approx(3e9)
    assert (3 * k - 2 * g) / (2 * (3 * k + g)) == pytest.approx(0.2)
    assert reading("prop jmat=2 jfoo=10") == ""
    assert reading("block create polygon 0 0 20 0 20 20 0 20") == "READ BLOCK 0,20 20,20 20,0 0,0"


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("GRAVTY 0 -10", "2 GRAVITY"),
        ("GRAVITYY 0 -10", "2 GRAVITY"),
        ("GRAVTY", "2"),
        ("DEF F=0.5", "DEFAULT"),
        ("DEF F", "DEFAULT"),
        ("RESTRAT slope.h5", "2 RESTART"),
        ("RESTRAT slowly", "2"),
        ("HALP SPLIT", "2 HELP"),
        ("HALP ME", "2"),
        ("FIX 0 1 0 1 DENS", "10"),
        ("PLOT BLOKS", "10"),
        ("PROP MAT=1 DENSITEE=1", "10 DENSITY"),
        ("PROP MAT=1 DENSITEE=high", "10"),
    ],
)
def test_spelling_and_form_decide(line: str, expected: str) -> None:
    assert answer(line) == expected


def test_histories_of_a_place_are_those_of_a_grid_point_where_there_are_zones() -> None:
    assert reading("hist ydisp 5 20 unbal", True) == "READ HISTORY 10 KYG AT 5,20; HISTORY 10 UNBALANCED"
    assert (
        reading("hist n=5 xvel 5,20 sxx 1 1", True) == "READ HISTORY 5 KXDG AT 5,20; HISTORY 5 KZS11 AT 1,1"
    )


def test_words_whose_numbers_or_names_are_unusual() -> None:
    assert reading("prop mat=1 ymod=1e9 prat=0.5") == "ANSWER"
    assert reading("prop jmat=1 jfric=3d1") == "READ JPROPERTY JMATERIAL=1 FRICTION=0.5773502692"
    assert reading("frac 1d-1 0.2") == "READ FRACTION 1D-1"
    assert reading("block create polygon 0 0 20 0 20 20 0") == ""
    assert reading("prop jmat=1 jkn=1e9 jperm") == ""
    assert reading("model save 'results/a b.sav'") == "READ SAVE 'results/a b.sav'"
    assert reading("restore results/a.sav") == "READ RESTART results/a.sav"
    line = "jset 45,0 50,0 0,0 5,0 range mat 2"
    assert reading(line) == "READ JSET ANGLE 45 0 TRACE 50 0 GAP 0 0 SPACING 5 0 RANGE MATERIAL 2"
    assert reading("vor edge 0.5 range mat 2") == "READ VORONOI EDGE=0.5 RANGE MATERIAL 2"


def test_stresses_with_gradients() -> None:
    line = "insitu stress -1e6 0 -1e6 szz -1e6 ygrad 0 0 2.5e4 range 0,9 0,9"
    assert reading(line) == "READ INSITU 0 9 0 9 -1E6 0 -1E6 YGRAD 0 0 2.5E4"
    assert (
        reading("insitu stress 0 0 0 xgrad 1 0 0 ygrad 0 0 2e4")
        == "READ INSITU ALL 0 0 0 XGRAD 1 0 0 YGRAD 0 0 2E4"
    )
    line = "bound stress 0 0 -1e6 ygrad 0 0 2e4 range 0,1 0,9"
    assert reading(line) == "READ BOUNDARY STRESS 0 0 -1E6 YGRAD 0 0 2E4 RANGE 0 1 0 9"
