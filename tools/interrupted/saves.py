"""Kills while files are written: the name stands for the old file or the new one."""

from __future__ import annotations

import os
import signal
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

from interrupted.commands import Lines
from udec_ia import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import MCTOT
from udec_ia.restart import load, save


def two_states(folder: Path) -> list[MainArray]:
    """A state, and the same after some cycles: their numbers of cycles tell them apart."""
    model = Lines(folder, cycled=False).model
    states = [model.array.copy()]
    model.cycle(20)
    return [*states, model.array.copy()]


def save_for_ever(states: list[MainArray], path: Path, before: int) -> None:
    """SAVE by turns, beginning with the state that is not there; ended from outside."""
    try:
        while True:
            before = 1 - before
            save(states[before], path)
    finally:
        os._exit(99)


def kill_saves(n: int, seed: int, seconds: float) -> list[str]:
    """Kill `n` processes that SAVE; returns the failures."""
    rng, failures, ends = np.random.default_rng(seed), [], time.monotonic() + seconds
    ended: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name:
        states, path = two_states(Path(name)), Path(name, "saved", "run.h5")
        cycles = [int(state.h.ci[MCTOT]) for state in states]
        save(states[0], path)
        start = time.perf_counter()
        save(states[0], path)
        longest = 3 * (time.perf_counter() - start)
        before = 0
        for done in range(n):
            if time.monotonic() > ends:
                print(f"{done} kills, then the time was over")
                break
            process = os.fork()
            if process == 0:
                save_for_ever(states, path, before)
            time.sleep(float(rng.uniform(0, longest)))
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            try:
                found = cycles.index(int(load(path).array.h.ci[MCTOT]))
                ended["the old file" if found == before else "the new file"] += 1
                before = found
            except (UdecError, ValueError) as error:
                failures.append(f"kill {done}: {error}")
                print(failures[-1], flush=True)
            for rest in {*path.parent.iterdir()} - {path}:
                ended["part of a file under another name"] += 1
                rest.unlink()
    print(dict(ended))
    return failures
