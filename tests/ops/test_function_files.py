"""FUNCTION n FILE: the points of a file, and errors with the line of the deck and that of the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model, UdecError

GOOD = """# time, factor
0, 1
0.5\t2D0

; blanks do as well
 1.5   -3e-1,
"""


def points(m: Model) -> list[tuple[float, float]]:
    rows = {int(row["address"]): row for row in m.table("tabpoint")}
    at, found = int(m.table("signal")["KTP"][0]), []
    while at:
        found.append((float(rows[at]["KTPT"]), float(rows[at]["KTPF"])))
        at = int(rows[at]["KTPN"])
    return found


@pytest.mark.parametrize("name", ["wave.csv", "a wave, 1=2.txt", "sub/wave.csv"])
def test_points_are_read_beside_the_deck(name: str, tmp_path: Path) -> None:
    file = tmp_path / "decks" / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(GOOD)
    deck = tmp_path / "decks" / "a.dat"
    deck.write_text(f'START\nFUNCTION 3 FILE "{name}" ; quoted\nFUNCTION 3 FILE {name} ; or not\nSTOP\n')
    m = Model(out=tmp_path / "out")
    m.run(deck)
    assert points(m) == [(0.0, 1.0), (0.5, 2.0), (1.5, -0.3)]
    other = Model()
    other.function(3, path=file)
    assert points(other) == points(m)
    third = Model()
    third.run(other.deck())
    assert points(third) == points(m)
    assert m.check() == []


@pytest.mark.parametrize(
    ("text", "number", "line"),
    [
        ("0 1\n1 x\n", 10, 2),
        ("t,f\n0,1\n", 10, 1),
        ("0 1\n\n1\n", 26, 3),
        ("0 1 2\n", 26, 1),
        ("0 1\n# more\n0 2\n", 28, 3),
        ("0 1\n1 1e999\n", 28, 2),
        ("# nothing\n", 26, None),
    ],
)
def test_errors_name_the_line_of_the_file(text: str, number: int, line: int | None, tmp_path: Path) -> None:
    (tmp_path / "wave.csv").write_text(text)
    deck = tmp_path / "a.dat"
    deck.write_text("START\nFUNCTION 3 0 1\nFUNCTION 3 FILE wave.csv\nSTOP\n")
    m = Model(out=tmp_path)
    with pytest.raises(UdecError) as caught:
        m.run(deck)
    error = caught.value
    assert (error.number, error.line, error.column) == (number, 3, 17)
    assert line is None or f"wave.csv:{line}: " in error.detail
    assert points(m) == [(0.0, 1.0)]


@pytest.mark.parametrize("name", ["no.csv", ".", "binary.csv"])
def test_a_file_that_cannot_be_read(name: str, tmp_path: Path) -> None:
    (tmp_path / "binary.csv").write_bytes(bytes(range(256)))
    with pytest.raises(UdecError) as caught:
        Model().function(1, path=tmp_path / name)
    assert caught.value.number == 26
    assert str(tmp_path / name) in caught.value.detail


def test_numbers_and_a_file_exclude_each_other(tmp_path: Path) -> None:
    (tmp_path / "wave.csv").write_text(GOOD)
    with pytest.raises(UdecError) as caught:
        Model().function(1, 0.0, 1.0, path=tmp_path / "wave.csv")
    assert (caught.value.number, caught.value.parameter) == (10, "path")


def test_a_later_error_keeps_what_was_read(tmp_path: Path) -> None:
    """The file is gone by then: it is not read again."""
    file = tmp_path / "wave.csv"
    file.write_text(GOOD)
    m = Model()
    m.block(0, 0, 0, 1, 1, 1, 1, 0)

    def fail() -> None:
        m.split(-1, 0.5, 2, 0.5)
        raise ValueError

    m.function(1, path=file)
    file.unlink()
    with pytest.raises(ValueError, match=r"^$"):
        m.whole(fail)
    assert len(m.table("block")) == 1
    np.testing.assert_array_equal(points(m), [(0.0, 1.0), (0.5, 2.0), (1.5, -0.3)])
