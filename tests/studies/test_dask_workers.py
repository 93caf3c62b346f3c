"""Studies on a scheduler of dask.distributed with two workers, one of which is killed on the way."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from support.study_decks import PILE, ROOT, outcome, piles, wait_until

from udec_ia import UdecError
from udec_ia.cli import main
from udec_ia.studies.run_folder import UNNAMED
from udec_ia.studies.study_run import RunResult
from udec_ia.studies.worker_pool import RUNS, run_all

FRICTIONS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """The address of a scheduler, and its two workers; all of them processes of their own."""
    pytest.importorskip("distributed", reason="dask.distributed is not installed: pip install udec-ia[dask]")
    address = tmp_path / "scheduler.json"
    common = ("--scheduler-file", str(address))
    with ExitStack() as stack:

        def start(*arguments: str) -> subprocess.Popen[bytes]:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *arguments, *common],
                cwd=tmp_path,
                env=os.environ | {"PYTHONPATH": str(ROOT)},
                stderr=subprocess.DEVNULL,
            )
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        workers = [start("worker", "--no-nanny", "--nthreads", "1", "--no-dashboard") for _ in range(2)]
        wait_until(address.exists)
        import json

        from distributed import Client

        where = ""

        def there() -> bool:
            nonlocal where
            where = json.loads(address.read_text() or "{}").get("address", "")
            return bool(where)

        wait_until(there)
        with Client(where, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
        yield where, workers


def test_a_worker_that_is_killed_is_made_up_for(
    cluster: tuple[str, list[subprocess.Popen[bytes]]], tmp_path: Path
) -> None:
    """It is killed while both workers have a run; the results are those of a single process, bit for bit."""
    address, workers = cluster
    runs = piles(*FRICTIONS, cycles=15000)
    run_all(piles(0.7, 0.8, cycles=1), tmp_path / "before", dask=address)  # both have loaded what they need
    killed: list[str] = []

    def told(result: RunResult, _: str) -> None:
        folder = tmp_path / "dask" / RUNS
        if not killed:
            wait_until(lambda: len([*folder.glob(f"{UNNAMED}*")]) == 2)
            os.kill(workers[0].pid, signal.SIGKILL)
            killed.append(result.name)

    results = run_all(runs, tmp_path / "dask", dask=address, report=told)
    serial = run_all(runs, tmp_path / "serial", jobs=0)
    assert killed
    assert workers[0].wait(10) == -signal.SIGKILL
    assert workers[1].poll() is None
    assert [*map(outcome, results)] == [*map(outcome, serial)]
    assert [one.status for one in results] == ["ended"] * len(runs)


def test_an_address_where_nobody_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("distributed", reason="dask.distributed is not installed: pip install udec-ia[dask]")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("udec_ia.studies.worker_pool.CONNECT", 1)
    Path("pile.dat").write_text(PILE)
    assert main(["sweep", "pile.dat", "--set", "F=0.1,0.2", "--dask", "tcp://127.0.0.1:9"]) == 2
    assert "udec sweep: no dask scheduler at tcp://127.0.0.1:9" in capsys.readouterr().err


@pytest.mark.parametrize(
    "wrong", ["nonsense", "nonsense://x:1", "tcp://:9", "tcp://host", "host:99999", "host:port", "[::1:9"]
)
def test_what_can_be_no_address_is_refused_at_once(
    wrong: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without asking dask, which would try, and leave a client behind that complains when it goes."""
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ValueError, match="it needs a host and a port; give the address") as caught:
        run_all(piles(0.1), tmp_path / "out", dask=wrong)
    assert wrong in str(caught.value)
    assert not (tmp_path / "out").exists()
    for good in ("host:8786", "tls://10.0.0.1:8786", "tcp://[::1]:8786", "inproc://10.0.0.1/1/2"):
        with pytest.raises(UdecError, match="needs dask"):
            run_all(piles(0.1), tmp_path, dask=good)


def test_without_dask_it_is_said_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UdecError, match="23") as caught:
        run_all(piles(0.1), tmp_path, dask="tcp://127.0.0.1:9")
    assert "udec-ia[dask]" in caught.value.advice
