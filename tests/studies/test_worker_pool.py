"""Many runs: the same results whoever runs them, and what is left when somebody dies or is interrupted."""

from __future__ import annotations

import os
import signal
from dataclasses import replace
from pathlib import Path

import pytest
from support.study_decks import KILLS, KILLS_ONCE, PILE, WAITS, outcome, piles, started, wait_until

from udec_ia.cli import main
from udec_ia.printable_text import counted
from udec_ia.studies.run_folder import LOCK, RESULT
from udec_ia.studies.study_run import RunResult
from udec_ia.studies.worker_pool import RUNS, run_all

FRICTIONS = (0.1, 0.3, 0.5, -1)
SWEEP = ("sweep", "pile.dat", "--set", "F=0.1:0.6:6", "--constitutive", "waits.py", "--jobs", "2")


def outcomes(results: list[RunResult]) -> list[str]:
    return [*map(outcome, results)]


def test_serial_and_by_joblib_bit_for_bit(tmp_path: Path) -> None:
    """Results, and what histories have recorded; and all of it is taken the next time."""
    runs = piles(*FRICTIONS)
    told: list[tuple[str, str]] = []
    serial = run_all(runs, tmp_path / "serial", jobs=0)
    parallel = run_all(
        runs, tmp_path / "parallel", jobs=2, report=lambda one, why: told.append((one.name, why))
    )
    assert [one.name for one in serial] == [run.name for run in runs]
    assert outcomes(serial) == outcomes(parallel)
    assert [one.status for one in serial] == ["ended"] * 3 + ["error"]
    assert sorted(told) == sorted((run.name, "") for run in runs)
    for name in ("F=0.1", "F=0.3", "F=0.5"):
        one, two = (tmp_path / kind / RUNS / name for kind in ("serial", "parallel"))
        assert sorted(os.listdir(one)) == sorted(os.listdir(two))
        assert (one / "pile-history.csv").read_bytes() == (two / "pile-history.csv").read_bytes()
    told.clear()
    again = run_all(runs, tmp_path / "parallel", jobs=0, report=lambda one, why: told.append((one.name, why)))
    assert outcomes(again) == outcomes(parallel)
    assert [one.seconds for one in again] == [one.seconds for one in parallel]
    assert told == [(run.name, "kept") for run in runs]


def test_a_run_that_kills_its_process_is_a_result(tmp_path: Path) -> None:
    """One that always does has died; one that did only once, and those beside it, have not."""
    (tmp_path / "kills.py").write_text(KILLS)
    (tmp_path / "once.py").write_text(KILLS_ONCE)
    runs = piles(0.1, 0.2, 0.3)
    runs[1] = replace(runs[1], constitutive=(str(tmp_path / "kills.py"),))
    runs[2] = replace(runs[2], constitutive=(str(tmp_path / "once.py"),))
    results = run_all(runs, tmp_path, jobs=2)
    assert [one.status for one in results] == ["ended", "died", "ended"]
    assert "memory ran out" in results[1].message
    assert sorted(os.listdir(tmp_path / RUNS)) == [LOCK, *(run.name for run in runs)]
    told: list[str] = []
    again = run_all(runs, tmp_path, jobs=1, report=lambda _, why: told.append(why))
    assert outcomes(again) == outcomes(results)
    assert sorted(told) == ["kept", "kept", "the system had failed"]


def whole(folder: Path) -> int:
    """How many runs have their result."""
    return len([*folder.glob(f"*/{RESULT}")])


def of_group(group: int) -> list[int]:
    """Processes of a process group that are alive."""
    found = []
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, its = path.read_text().rpartition(")")[2].split()[:3]
        except (OSError, ValueError):
            continue
        if int(its) == group and state != "Z":
            found.append(int(path.parent.name))
    return found


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks for processes in /proc")
def test_a_sweep_that_is_killed_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its workers end with it, what was done is kept, and the table is that of runs nobody has killed."""
    (tmp_path / "pile.dat").write_text(PILE)
    (tmp_path / "waits.py").write_text(WAITS)
    runs = tmp_path / "pile-sweep" / RUNS
    first = started(*SWEEP, cwd=tmp_path)
    wait_until(lambda: whole(runs) >= 2)
    os.kill(first.pid, signal.SIGKILL)
    first.communicate()
    wait_until(lambda: not of_group(first.pid))
    done = whole(runs)
    assert 2 <= done < 6
    assert not (tmp_path / "pile-sweep" / "pile.csv").exists()
    (tmp_path / "go").touch()
    monkeypatch.chdir(tmp_path)
    assert main([*SWEEP[:-1], "0"]) == 0  # goes on in this process
    printed = capsys.readouterr().out
    assert printed.count("(kept)") == done
    assert f"{counted(done, 'run')} kept, as the input is the same" in printed
    assert whole(runs) == len(os.listdir(runs)) - 1 == 6
    reference = run_all(piles(0.1, 0.6), tmp_path / "reference", jobs=0)
    rows = (tmp_path / "pile-sweep" / "pile.csv").read_text().splitlines()
    for row, result in zip((rows[1], rows[6]), reference, strict=True):
        assert ",".join(map(repr, result.quantities.values())) in row


def test_ctrl_c_leaves_what_is_done(tmp_path: Path) -> None:
    (tmp_path / "pile.dat").write_text(PILE)
    (tmp_path / "waits.py").write_text(WAITS)
    folder = tmp_path / "pile-sweep"
    process = started(*SWEEP[:-1], "1", cwd=tmp_path)
    wait_until(lambda: whole(folder / RUNS) >= 2)
    os.killpg(process.pid, signal.SIGINT)
    printed, complaints = process.communicate(timeout=120)
    assert process.returncode == 130
    assert complaints == "\ninterrupted: the results so far are saved in pile-sweep\n"
    table = (folder / "pile.csv").read_text().splitlines()
    assert 6 > len(table) - 1 == whole(folder / RUNS) >= printed.count(" ended, ")
    assert "Traceback" not in printed
