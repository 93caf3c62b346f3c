"""A budget is time by the clock: creating and starting runs count, and it is overrun by one run at most."""

from __future__ import annotations

from pathlib import Path

import pytest

from udec_ia.cli import main
from udec_ia.studies.accuracy_report import answer
from udec_ia.studies.accuracy_study import study_accuracy
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.setting_runner import Options, Rates, Row, SettingRunner
from udec_ia.studies.settings import Numbers, Setting
from udec_ia.studies.significant_digits import measure_digits
from udec_ia.studies.study_run import ENDED, RunResult, StudyRun

FINE = (  # a slice that 32-bit reals are too short for
    "START\nPROP MAT=1 DENS=2000 KN=1E11 KS=1E11 FRICTION=0.5\nBLOCK 0 0 0 4 60 4 60 0\nSPLIT -1 1 61 1\n"
    "SPLIT 10 -1 10 5\nSPLIT 10.05 -1 10.05 5\nROUND 0.01\nFIX 0 60 0 1\nGRAVITY 0 -9.81\nCYCLE 20\n"
)
FALL = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0 0 0 1 1 1 1 0\nGRAVITY 0 -10\nCYCLE 9\n"
ASKED = ("way = mean block.DISPLACEMENT",)


class Slow(SettingRunner):
    """Every run takes ten times what was predicted, by the clock."""

    spent = 0.0

    @property
    def left(self) -> float:
        """See SettingRunner."""
        return self.options.budget - self.spent

    def results(self, runs: list[StudyRun]) -> list[RunResult]:  # type: ignore[override]
        """See SettingRunner."""
        if not self.survey:
            return super().results(runs)
        self.spent += 10.0
        return [RunResult(run.name, {}, ENDED, seconds=10.0) for run in runs]


def test_a_budget_is_overrun_by_one_run_at_most(tmp_path: Path) -> None:
    with Slow(Deck(FALL, "x.dat"), Options(ASKED, budget=40.0, jobs=0), tmp_path) as runner:
        runner.run_own_deck()
        runner.rates = {build: Rates(1.0, 0.0) for build in runner.builds}
        rows = [runner.row(Setting("i32r64", step)) for step in range(1, 21)]
        others = runner.run_rows(rows)
    ran = [one for one in rows if one.result]
    assert len(ran) + len(others) == 20
    assert len(ran) == 4


def test_static_runs_first_and_then_the_cheapest(tmp_path: Path) -> None:
    with Slow(Deck(FALL, "x.dat"), Options(ASKED, budget=35.0, jobs=0), tmp_path) as runner:
        runner.run_own_deck()
        runner.rates = {build: Rates(0.0, 0.1) for build in runner.builds}
        rows = [runner.row(Setting("i32r64", step)) for step in (0.5, 2.0, 4.0)]
        rows.append(runner.row(Setting("i32r64", static=True)))
        runner.run_rows(rows)
    assert [one.result is not None for one in rows] == [False, True, True, True]


def test_starting_runs_counts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A budget of 0.1 s ends after what has to be started to know anything, and the answer says so."""
    (tmp_path / "x.dat").write_text(FALL.replace("CYCLE 9", "CYCLE 5000"))
    main(
        ["trade", str(tmp_path / "x.dat"), "--budget", "0.1s", "--jobs", "2", "--out", str(tmp_path / "out")]
    )
    assert "budget" in capsys.readouterr().out
    assert len([*(tmp_path / "out" / "runs").glob("*/result.json")]) == 1


def test_words_that_cannot_run_a_deck_are_left_out(tmp_path: Path) -> None:
    study = study_accuracy(FINE, "x.dat", {}, tmp_path / "a", Options(ASKED, jobs=0))
    assert {one.setting.build for one in study.rows} == {"i32r64"}
    left_out = "i32r32 is left out, as it cannot run the deck: "
    assert any(left_out in line for line in answer(study))
    with SettingRunner(Deck(FINE, "x.dat"), Options(ASKED, jobs=0), tmp_path / "b") as runner:
        found = measure_digits(runner, 3)
    assert any("i32r32 is left out" in one for one in found.notes)
    ((_, value, own, short, step, why),) = found.rows()
    assert isinstance(own, float)
    assert (short, value != "", isinstance(step, float)) == ("", True, True)
    assert "too few runs have shorter reals" in str(why)


def test_a_row_without_a_run_costs_nothing() -> None:
    assert Row(Setting(), Numbers(), 1.0).memory == 0
