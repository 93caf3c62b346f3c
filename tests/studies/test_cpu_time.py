"""Seconds of a run, without compiling, and what a limit of them ends."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from support.study_decks import PILE

from udec_ia.studies import execute_run
from udec_ia.studies.execute_run import execute
from udec_ia.studies.study_run import StudyRun


class Times:
    """What the clocks of the system show."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.spent = self.passed = self.compiled = 0.0
        monkeypatch.setattr(execute_run, "thread_time", lambda: self.spent)
        monkeypatch.setattr(execute_run, "monotonic", lambda: self.passed)
        monkeypatch.setattr(execute_run, "compile_seconds", lambda: self.compiled)

    def go(self, spent: float, passed: float, compiled: float = 0.0) -> None:
        """Some seconds of the processor, of the wall, and of compiling by the clock of the wall."""
        self.spent, self.passed, self.compiled = (
            self.spent + spent,
            self.passed + passed,
            self.compiled + compiled,
        )


def test_a_busy_machine_takes_nothing_from_the_cycles(monkeypatch: pytest.MonkeyPatch) -> None:
    """Compiling took 30 s by the clock and 10 s of the processor: the cycles still have theirs."""
    times = Times(monkeypatch)
    one = execute_run.CpuTime()
    times.go(spent=12.0, passed=36.0, compiled=30.0)
    assert one.seconds == pytest.approx(2.0)
    times.go(spent=5.0, passed=9.0)
    assert one.seconds == pytest.approx(7.0)
    times.go(spent=3.0, passed=3.0, compiled=3.0)
    assert one.seconds == pytest.approx(7.0)


def test_a_machine_that_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    times = Times(monkeypatch)
    one = execute_run.CpuTime()
    times.go(spent=33.0, passed=33.0, compiled=30.0)
    assert one.seconds == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("rest", "status", "cycles"),
    [
        ("", "ended", 200),
        ("PRINT BLOCKS\nSAVE end.h5\nSTOP\nEND\n", "ended", 200),
        ("GRAVITY 0 0\n", "timed out", 200),
        ("CYCLE 1\n", "timed out", 200),
    ],
)
def test_a_run_that_has_done_its_cycles_is_not_late(
    rest: str, status: str, cycles: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The time is up while the last cycle is done: what is left to do says whether that ends the run."""

    def seconds(self: execute_run.CpuTime) -> float:
        return 0.0 if not watched[0].model.array.h.ci[MCTOT] >= 200 else 99.0

    from udec_ia.layout.offsets import MCTOT

    watched: list[execute_run.StudyObserver] = []
    begin = execute_run.StudyObserver.begin

    def begun(self: execute_run.StudyObserver, *about: Any) -> None:
        watched.append(self)
        begin(self, *about)

    monkeypatch.setattr(execute_run.StudyObserver, "begin", begun)
    monkeypatch.setattr(
        execute_run.CpuTime, "seconds", property(lambda self: seconds(self) if watched else 0.0)
    )
    result = execute(StudyRun("run", PILE + rest, limit=2.0), tmp_path)
    assert (result.status, result.cycles) == (status, cycles)
    assert (tmp_path / "run" / "end.h5").exists() == ("SAVE" in rest)
