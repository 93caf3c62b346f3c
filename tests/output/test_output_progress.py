"""A terminal gets a bar, a pipe gets a few lines, and every command leaves one."""

from __future__ import annotations

import io
import sys
from itertools import pairwise
from pathlib import Path

import pytest
from support.handmade_map import two_blocks

from udec_ia import Model
from udec_ia.layout import offsets as g
from udec_ia.output import run_progress as progress
from udec_ia.output.run_progress import LINES, RunProgress, summary


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def fake_time(monkeypatch: pytest.MonkeyPatch, seconds_per_look: float) -> None:
    """A clock that advances by the same time whenever it is looked at."""
    now = [0.0]

    def tick() -> float:
        now[0] += seconds_per_look
        return now[0]

    monkeypatch.setattr(progress, "working_time", tick)


def run(stream: io.StringIO, total: int = 1000) -> str:
    h = two_blocks().h
    h.cr[g.TDEL], h.cr[g.FRAC], h.ci[g.NMADE], h.ci[g.NBROKE] = 0.002, 0.1, 3, 1
    bar = RunProgress(lambda: h, total, stream, None)
    for done in range(10, total + 1, 10):
        h.ci[g.MCTOT], h.cd[g.TIME] = done, 0.002 * done
        bar(done)
    bar.close()
    bar.close()
    return stream.getvalue()


def test_a_long_run_in_a_pipe_gives_ten_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_time(monkeypatch, 60.0)
    lines = run(io.StringIO()).splitlines()
    assert len(lines) == LINES
    assert [line.split(":")[0] for line in lines] == [f"cycle {n} of 1000" for n in range(100, 1001, 100)]
    for part in ("cycles/s", "t = 2 s", "dt 0.002 s (0.1 of the estimate)", " N/m", "contacts +3 -1"):
        assert part in lines[-1]


def test_few_cycles_give_no_more_lines_than_updates(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_time(monkeypatch, 60.0)
    assert len(run(io.StringIO(), 30).splitlines()) == 3


def test_a_short_run_in_a_pipe_leaves_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_time(monkeypatch, 0.001)
    (line,) = run(io.StringIO()).splitlines()
    assert line.startswith("cycle 1000 of 1000: ")


def test_a_terminal_shows_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm-256color")
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.delenv("NO_COLOR", raising=False)
    coloured = run(Terminal())
    assert "1000/1000" in coloured
    assert "cycle 1000 of 1000: " in coloured.splitlines()[-1]
    assert "contacts +3 -1" in coloured
    assert "\x1b[3" in coloured
    monkeypatch.setenv("NO_COLOR", "1")
    assert "\x1b[3" not in run(Terminal())


Notebook = type("OutStream", (io.StringIO,), {"__module__": "ipykernel.iostream"})


def test_a_notebook_shows_one_line_that_is_rewritten(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_time(monkeypatch, 60.0)
    written = run(Notebook())
    assert written.count("\n") == 1
    assert written.endswith("\n")
    states = written.rstrip("\n").split("\r")[1:]
    assert [one.split(":")[0] for one in states] == [f"cycle {n} of 1000" for n in range(10, 1001, 10)]
    assert all(len(later) >= len(former.rstrip()) for former, later in pairwise(states))


def test_a_short_run_in_a_notebook_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    fake_time(monkeypatch, 0.001)
    assert run(Notebook()) == ""


def test_a_model_in_a_notebook_shows_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    assert Model().progress is None
    monkeypatch.setattr(sys, "stdout", Notebook())
    assert Model().progress is sys.stdout


def test_the_last_line_of_a_cut_run_counts_all_its_cycles() -> None:
    """Cycles that were done before this command do not count, and those after the last report do."""
    h, out = two_blocks().h, io.StringIO()
    h.ci[g.MCTOT] = 100
    report = RunProgress(lambda: h, 1000, out, None)
    h.ci[g.MCTOT] = 110
    report(10)
    h.ci[g.MCTOT] = 350
    report.close()
    (line,) = out.getvalue().splitlines()
    assert line.startswith("cycle 250 of 1000: ")


def test_summary_is_one_line() -> None:
    files = [Path("/some/where") / name for name in ("a.h5", "a-plot-1.png", "a-plot-1.svg")]
    line = summary(1300, 2.6, 2, 1, 89443.2, files, 1.23)
    assert line == (
        "1300 cycles (t = 2.6 s), 2 blocks, 1 contact, largest normal force 8.944e+04 N/m; "
        "wrote a.h5, a-plot-1.png, a-plot-1.svg; 1.2 s"
    )
    assert "no file written" in summary(0, 0.0, 0, 0, 0.0, [], 0.1)
    assert "and 2 more" in summary(0, 0.0, 0, 0, 0.0, [*files, *files], 0.1)
