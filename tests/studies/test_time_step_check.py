"""A run whose time-steps are not those that its setting means is none of the deck, and is not compared."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from udec_ia.cli import main
from udec_ia.studies.accuracy_report import answer, half_step
from udec_ia.studies.accuracy_study import study_accuracy
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.setting_runner import Options, SettingRunner
from udec_ia.studies.settings import Numbers, Setting, cycled_time, has_its_fraction
from udec_ia.studies.significant_digits import measure_digits
from udec_ia.studies.survey_run import Segment

HEAD = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0 0 0 1 1 1 1 0\nGRAVITY 0 -10\n"
OWN = Segment(100, False, 0.0, 0.002, 0.1, False, 0.02, done=100)


def options(**named: object) -> Options:
    asked = ("way = block(0.5, 0.5).YDISPLACEMENT",)
    return Options(asked, builds=("i32r64",), jobs=0, **named)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "lines",
    [
        "PATCH FRAC = 0.05\nCYCLE 200\n",
        "CYCLE 100\nPATCH FRAC = 0.02\nCYCLE 100\nFRACTION 0.05\nCYCLE 100\n",
        f"FRACTION 0.05\nCYCLE 100\n{HEAD}CYCLE 100\n",
    ],
)
def test_a_deck_that_sets_its_step_itself_has_nothing_to_compare(lines: str, tmp_path: Path) -> None:
    price = study_accuracy(HEAD + lines, "x.dat", {}, tmp_path, options())
    assert price.best is None
    assert not any(row.errors for row in price.rows)
    assert "the deck sets its time-step itself" in answer(price)[0]
    half = study_accuracy(HEAD + lines, "x.dat", {}, tmp_path, options(half_step=True))
    assert len(half.levels) == 1
    assert "step=0.5: not compared: the deck sets its time-step itself" in half_step(half)[0]


def test_no_digits_of_a_step_that_cannot_be_varied(tmp_path: Path) -> None:
    deck = Deck(f"{HEAD}PATCH FRAC = 0.05\nCYCLE 20\n", "x.dat")
    with SettingRunner(deck, options(), tmp_path) as runner:
        found = measure_digits(runner, 3)
    assert "no digits of the step: the deck sets its time-step itself" in found.notes[0]
    ((*_, step, _),) = found.rows()
    assert step == ""


def test_the_check_of_the_command_line_is_no_false_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck = tmp_path / "x.dat"
    deck.write_text(f"{HEAD}PATCH FRAC = 0.05\nCYCLE 20\n")
    asked = ["--half-step", "--quantity", "way = time", "--jobs", "0", "--out", str(tmp_path / "out")]
    assert main(["trade", str(deck), *asked]) == 1
    told = capsys.readouterr().out
    assert "sets its time-step itself" in told
    assert "TOO LARGE" not in told


def test_the_fraction_of_a_setting() -> None:
    half = replace(OWN, fraction=0.05)
    assert has_its_fraction([OWN], [half], Setting(step=0.5), Numbers())
    assert not has_its_fraction([OWN], [OWN], Setting(step=0.5), Numbers())
    assert not has_its_fraction([OWN, OWN], [half, OWN], Setting(step=0.5), Numbers())
    assert has_its_fraction([OWN], [replace(OWN, fraction=0.9, safe=True)], Setting(safe=0.9), Numbers())
    assert not has_its_fraction([OWN], [replace(OWN, fraction=0.9)], Setting(safe=0.9), Numbers())
    static = replace(OWN, fraction=0.9, scaled=True)
    assert has_its_fraction([OWN], [static], Setting(static=True), Numbers())


def test_the_time_in_cycles() -> None:
    runs = [OWN, replace(OWN, began=0.2, solve=True), replace(OWN, began=0.9)]
    assert cycled_time(runs, 1.1) == pytest.approx(0.4)
