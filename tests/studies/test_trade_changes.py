"""The lines to change are those of the user's deck, however its statements are laid out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.studies.accuracy_study import study_accuracy
from udec_ia.studies.deck_rewriting import Deck, list_changes
from udec_ia.studies.setting_runner import Options
from udec_ia.studies.settings import Fraction, Numbers, Setting

HEAD = "START ; begin\nPROP MAT=1 DENS=2000\n+ KN=1E8 KS=1E8 FRICTION=0.5\nBLOCK 0 0 0 1 1 1 1 0\n"
LAYOUTS = {
    "plain": "GRAVITY 0 -10\nFRAC 0.1\nCYCLE 0\nCYCLE 100\nCYCLE 20\n",
    "continued": "GRAV\n+ 0 -10\nFRAC\n* half of it\n+ 0.1 ; a fraction\nCYCLE\n+ 100\nCYC 20 ! more\n",
    "without a fraction": "GRAV\n+ 0 -10\nCYCLE\n+\n+ 100\n* next\nCYC 20\n",
    "safe on a line of its own": "GRAVITY 0 -10\nFRACTION 0.1\n+ SAFE\nCYCLE 120\n",
    "a history": "GRAVITY 0 -10\nHIST ; often\n+ 10 KINETIC\nCYCLE 120\n",
}
CHANGE = re.compile(r"line(?:s)? (\d+)(?:-(\d+))?: .* -> (.*)")
AFTER = re.compile(r"after line (\d+): (.*)")


def applied(text: str, told: list[str]) -> str:
    """The deck with what is told changed in it."""
    lines: list[list[str]] = [[line] for line in text.splitlines()]
    for change in told[1:]:
        if found := AFTER.fullmatch(change):
            lines[int(found[1]) - 1].append(found[2])
        elif found := CHANGE.fullmatch(change):
            first, last = int(found[1]), int(found[2] or found[1])
            lines[first - 1 : last] = [[found[3]], *([] for _ in range(last - first))]
        else:
            raise AssertionError(change)
    return "".join(f"{line}\n" for some in lines for line in some)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_lines_to_change_make_the_run(layout: str, tmp_path: Path) -> None:
    text, ways = HEAD + LAYOUTS[layout], []
    deck, own = Deck(text, "x.dat"), Fraction(0.1)
    cycles = tuple({0: 0, 20: 60, 100: 300, 120: 360}[n] for n in asked(text))
    setting, numbers = Setting(step=1 / 3), Numbers(1.0, cycles, (3.0,) * len(cycles))
    told = list_changes(deck, setting, numbers, own)
    assert not any("CYCLE 0" in line for line in told)
    for name, lines in (
        ("run", deck.written(setting, numbers, own)),
        ("told", applied(text, told)),
    ):
        m = Model(out=tmp_path / name)
        m.run(lines)
        ways.append((m.h.ci[2], float(m.table("block")["KY"][0]), [one.every for one in m.histories()]))
    assert ways[0] == ways[1]


def asked(text: str) -> list[int]:
    return [int(n) for n in re.findall(r"^CYC(?:LE)?\s+(?:\+\s+)*(\d+)", text, re.MULTILINE)]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_deck_keeps_the_number_of_its_lines(layout: str) -> None:
    text = HEAD + LAYOUTS[layout]
    one = Deck(text, "x.dat").written(Setting(step=0.5), Numbers(0.99, (7, 8, 9)))
    assert one.count("\n") == text.count("\n")


def test_what_stays_the_same_is_not_listed() -> None:
    text = HEAD + "GRAVITY 0 -10\nSOLVE 1E-3\n"
    deck, own = Deck(text, "x.dat"), Fraction(0.1)
    told = list_changes(deck, Setting(static=True), Numbers(), own)
    assert told == ["--build i32r64", "line 6: SOLVE 1E-3 -> SOLVE 0.001 LIMIT 100000 STATIC"]


def test_errors_name_the_line_of_the_users_deck(tmp_path: Path) -> None:
    text = HEAD + "CYCLE 5\nDELETE 0 1 0 1\n"
    price = study_accuracy(text, "x.dat", {}, tmp_path, Options(builds=("i32r64",), jobs=0))
    assert "nothing to compare: x.dat:6:1: error" in price.notes[-1]
