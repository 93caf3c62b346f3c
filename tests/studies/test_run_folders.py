"""Folders of runs: what is not of the program stays, and one process uses them at a time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from support.study_decks import PILE, ROOT, piles, started, wait_until

from udec_ia import UdecError, sweep
from udec_ia.studies.accuracy_study import study_accuracy
from udec_ia.studies.execute_run import execute
from udec_ia.studies.run_folder import LOCK, RESULT, UNNAMED, clear, lock_folder, new_folder
from udec_ia.studies.setting_runner import Options
from udec_ia.studies.worker_pool import RUNS, WorkerPool, run_all

HOLD = """
import sys
from pathlib import Path
from udec_ia.studies.run_folder import lock_folder
with lock_folder(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""
SECOND = """
import sys
from pathlib import Path
from udec_ia import UdecError
from udec_ia.studies.run_folder import lock_folder
try:
    with lock_folder(Path(sys.argv[1])):
        print("held")
except UdecError as error:
    print(error)
"""


def foreign(place: Path, kind: str) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    if kind == "folder":
        place.mkdir()
        (place / "thesis.txt").write_text("mine")
    elif kind == "file":
        place.write_text("mine")
    else:
        place.symlink_to("elsewhere")


def process(code: str, folder: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", code, str(folder)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


@pytest.mark.parametrize("kind", ["folder", "file", "link"])
def test_what_is_not_ours_stays_and_nothing_is_run(kind: str, tmp_path: Path) -> None:
    place = tmp_path / RUNS / "F=0.2"
    foreign(place, kind)
    with pytest.raises(UdecError, match="31") as caught:
        run_all(piles(0.1, 0.2), tmp_path, jobs=0)
    assert f"{place}, the place of a run, " in caught.value.detail
    assert "move it away, or give another folder" in caught.value.advice
    assert sorted(os.listdir(tmp_path / RUNS)) == [LOCK, "F=0.2"]
    assert (
        place.is_symlink()
        if kind == "link"
        else "mine" in ((place / "thesis.txt").read_text() if kind == "folder" else place.read_text())
    )


def test_what_comes_to_stand_there_meanwhile_stays(tmp_path: Path) -> None:
    foreign(tmp_path / "F=0.1", "folder")
    with pytest.raises(UdecError, match="not made"):
        execute(piles(0.1, cycles=1)[0], tmp_path)
    assert [path.name for path in tmp_path.rglob("*")] == ["F=0.1", "thesis.txt"]


def test_a_trade_leaves_it_as_well(tmp_path: Path) -> None:
    foreign(tmp_path / RUNS / "i32r64,step=1", "folder")
    with pytest.raises(UdecError, match="not made"):
        study_accuracy(PILE, "pile.dat", {}, tmp_path, Options(jobs=0))
    assert (tmp_path / RUNS / "i32r64,step=1" / "thesis.txt").read_text() == "mine"


def test_an_empty_folder_and_one_of_ours_are_replaced(tmp_path: Path) -> None:
    (tmp_path / RUNS / "F=0.1").mkdir(parents=True)
    for cycles in (1, 2):
        (one,) = run_all(piles(0.1, cycles=cycles), tmp_path, jobs=0)
        assert one.cycles == cycles
    (tmp_path / RUNS / "F=0.1" / RESULT).write_text("{")
    assert run_all(piles(0.1, cycles=2), tmp_path, jobs=0)[0].cycles == 2


def test_only_what_was_begun_is_cleared(tmp_path: Path) -> None:
    new_folder(tmp_path, "F=0.1")
    (tmp_path / f"{UNNAMED}of mine").mkdir()
    clear(tmp_path)
    assert os.listdir(tmp_path) == [f"{UNNAMED}of mine"]


def test_a_second_sweep_is_refused_while_the_first_one_lives(tmp_path: Path) -> None:
    """At once, and the first goes on; after its death nobody is kept out."""
    (tmp_path / "pile.dat").write_text(PILE)
    arguments = ("sweep", "pile.dat", "--set", "F=0.1", "--jobs", "0", "--set")
    first = started(*arguments, "N=100000000", cwd=tmp_path)
    try:
        runs = tmp_path / "pile-sweep" / RUNS
        wait_until(lambda: any(runs.glob(f"{UNNAMED}*")))
        second = started(*arguments, "N=1", cwd=tmp_path)
        _, complaints = second.communicate(timeout=60)
        assert second.returncode == 1
        assert f"error 31: file cannot be written: {runs} is in use by another study" in complaints
        assert [*runs.glob(f"{UNNAMED}*")]
        assert first.poll() is None
    finally:
        os.kill(first.pid, signal.SIGKILL)
        first.communicate(timeout=60)
    third = started(*arguments, "N=1", cwd=tmp_path)
    third.communicate(timeout=60)
    assert third.returncode == 0


def test_a_study_keeps_its_folder_between_its_calls(tmp_path: Path) -> None:
    """So no second study comes between them; at its end the folder is free."""
    here = tmp_path / RUNS
    with WorkerPool(tmp_path, jobs=0) as pool:
        for cycles in (1, 2):
            pool.results(piles(0.1, cycles=cycles))
            assert "in use by another study" in process(SECOND, here).communicate(timeout=60)[0]
    assert process(SECOND, here).communicate(timeout=60)[0] == "held\n"
    sweep(PILE, {"N": 1}, jobs=0, out=tmp_path)
    assert process(SECOND, here).communicate(timeout=60)[0] == "held\n"


def test_the_lock_of_a_process_that_is_killed_is_nobodys(tmp_path: Path) -> None:
    other = process(HOLD, tmp_path)
    assert other.stdout is not None
    assert other.stdout.readline() == "held\n"
    with pytest.raises(UdecError, match="in use by another study"), lock_folder(tmp_path):
        pass
    other.kill()
    other.communicate(timeout=60)
    with lock_folder(tmp_path):
        pass


def test_two_threads_and_a_folder_that_was_removed(tmp_path: Path) -> None:
    caught: list[UdecError] = []

    def again() -> None:
        with pytest.raises(UdecError, match="in use by another study") as refused, lock_folder(tmp_path):
            pass
        caught.append(refused.value)

    with lock_folder(tmp_path):
        thread = threading.Thread(target=again)
        thread.start()
        thread.join(60)
    assert caught
    (tmp_path / LOCK).unlink()
    with lock_folder(tmp_path):
        assert (tmp_path / LOCK).exists()
