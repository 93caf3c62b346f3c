"""Warnings of runs: each result has its own, the table their number, and a few lines say what they are."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest
from support.study_decks import PILE, piles

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.studies.execute_run import execute
from udec_ia.studies.study_run import RunResult
from udec_ia.studies.sweep import summarise_warnings

TANGENT = "friction 10 of material 1 is a tangent, of 84.3 degrees: for an angle of 10 degrees give 0.176"


def test_a_result_has_the_warnings_of_its_run(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    """Those that a model of one's own tells, in the same order, and no notices."""
    (run,) = piles(10, cycles=20)
    told: list[str] = []
    model = Model(out=tmp_path)
    model.tell = told.append
    for line in PILE.replace("$F", "10").replace("$N", "20").splitlines():
        if not line.startswith(("DEFAULT", "CYCLE", "START")):
            model.run(f"START\n{line}" if line.startswith("PROP") else line)
    result = execute(run, tmp_path)
    assert len(result.warnings) == 1
    assert result.warnings[0].startswith(TANGENT)
    log = (tmp_path / run.name / "log.txt").read_text()
    assert f" PROPERTY: {result.warnings[0]}\n" in log
    assert " CYCLE: time-step " in log
    assert execute(piles(0.1, cycles=20)[0], tmp_path).warnings == ()


def test_they_are_shown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("pile.dat").write_text(PILE)
    command = ["sweep", "pile.dat", "--jobs", "0", "--set", "F=0.1,10,20", "--set", "N=2"]
    for _ in range(2):  # the second time the results are read
        assert main(command) == 0
        printed = capsys.readouterr().out
        assert f"\nwarning in 2 of 3 runs: {TANGENT}" in printed
        assert printed.count("warning in") == 1
        assert "(F=10,N=2, in log.txt)\n" in printed
        assert "seconds  warnings  message" in printed
        with Path("pile-sweep/pile.csv").open(newline="") as file:
            assert [row["warnings"] for row in csv.DictReader(file)] == ["0", "1", "1"]


def test_a_thousand_runs_are_a_few_lines() -> None:
    """Each kind is told once, the one that most runs were given first."""
    kinds = ("a step of {} s", "block@{} is a sliver", "force {}e-3 and {:.1f}", "often {}", "last {}")
    runs = [
        RunResult(f"F={k}", {}, "ended", warnings=tuple(text.format(k, k / 7) for text in kinds[: 1 + k % 5]))
        for k in range(1000)
    ]
    output = summarise_warnings(runs, "log.txt")
    assert output == [
        "warning in 1000 of 1000 runs: a step of 0 s (F=0, in log.txt)",
        "warning in 800 of 1000 runs: block@1 is a sliver (F=1, in log.txt)",
        "warning in 600 of 1000 runs: force 2e-3 and 0.3 (F=2, in log.txt)",
        "2 other warnings: see warnings in the table, and log.txt",
    ]
    assert summarise_warnings([RunResult("x", {}, "ended")], "log.txt") == []
