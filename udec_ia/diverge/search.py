"""The first cycle and pass after which two runs differ.

Both go on in step, and are compared after every step; of each run the state before the last step is kept, and
no other. Where they differ the step is gone through once more, and halved until one cycle is left: that
is run as Python, and compared after each pass.
"""

from __future__ import annotations

from contextlib import suppress
from typing import NamedTuple

from udec_ia.counting import counted
from udec_ia.debug.timeline import StateCopy, copy_state
from udec_ia.diverge.judge import Judge, Off
from udec_ia.diverge.passes import Passes
from udec_ia.diverge.runs import Run, Step
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.ops.common.array_growth import keep_spare
from udec_ia.running.cycle import prepare
from udec_ia.running.cycle_replay import Replay

States = tuple[StateCopy, StateCopy]


class Divergence(NamedTuple):
    """Where two runs differ first. cycle: its number; in_pass: "" if they differ before it.

    off: the worst difference after that pass. line: of the deck. states: both after the cycle.
    """

    cycle: int
    in_pass: str
    off: Off
    line: str
    states: States


def diverge(one: Run, two: Run, judge: Judge) -> Divergence | int:
    """Where two runs differ first, or how many cycles they agree. Raises the UdecError that ends one."""
    before: tuple[Step, Step] | None = None
    agreed = 0
    for now in zip(one.steps, two.steps, strict=False):
        if now[0].cycle != now[1].cycle:
            raise UdecError(
                26,
                f"{_at(now[0].line)} the first run has {counted(now[0].cycle, 'cycle')}, "
                f"{_at(now[1].line)} the second has {now[1].cycle}",
                "only runs with the same CYCLEs, and SOLVEs that end after as many cycles, can be compared",
            )
        cycle = now[0].cycle
        agreed += max(cycle - before[0].cycle, 0) if before else 0  # START begins at 0 again
        off = judge.off(now[0].copy.array(), now[1].copy.array())
        if off is not None:
            if before is None or before[0].cycle == cycle:
                return Divergence(cycle, "", off, now[0].line, (now[0].copy, now[1].copy))
            return _within((one, two), before, now, judge)
        before = now
    return agreed


def _at(line: str) -> str:
    """When a step was, in words."""
    return f"after {line}" if line else "at its beginning"


def _within(
    runs: tuple[Run, Run], before: tuple[Step, Step], now: tuple[Step, Step], judge: Judge
) -> Divergence:
    """The same, where the runs differ within a step."""
    low, high = before[0].cycle, now[0].cycle
    start = before[0].copy, before[1].copy
    while high - low > 1:
        middle = (low + high) // 2
        states = _on(runs, start, middle - low)
        if judge.off(states[0].array(), states[1].array()) is None:
            low, start = middle, states
        else:
            high = middle
    in_pass, off = _first_pass(runs, start, judge)
    states = _on(runs, start, 1)
    off = off or judge.off(states[0].array(), states[1].array())
    if off is None:
        raise UdecError(
            26,
            f"the runs differ in the cycles {low + 1} to {now[0].cycle}, but not when these are repeated",
            "a law of yours may depend on more than what it is given",
        )
    return Divergence(high, in_pass, off, now[0].line, states)


def _on(runs: tuple[Run, Run], start: States, cycles: int) -> States:
    """The states so many cycles later."""
    arrays = [_ready(copy) for copy in start]
    for run, array in zip(runs, arrays, strict=True):
        with suppress(UdecError):  # which the run has ended with
            Replay(array, run.model.session.laws).step(cycles)
    return copy_state(arrays[0]), copy_state(arrays[1])


def _ready(copy: StateCopy) -> MainArray:
    """The state, prepared to be cycled as CYCLE does."""
    array = copy.array()
    prepare(array)
    keep_spare(array)
    return array


def _first_pass(runs: tuple[Run, Run], start: States, judge: Judge) -> tuple[str, Off | None]:
    """The first pass of the next cycle after which the runs differ, and by what; "" if it is none alone."""
    passes = [Passes(_ready(copy), run.model.session.laws) for copy, run in zip(start, runs, strict=True)]
    for (name, a), (other, b) in zip(passes[0].after, passes[1].after, strict=False):
        off = judge.off(a.array(), b.array())
        if off is not None:
            return (name if name == other else f"{name} and {other}"), off
    return "", None
