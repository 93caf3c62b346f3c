"""Runs two decks, word schemes or states side by side: the first cycle, pass and number in which they differ.

Both go on in steps of at most EVERY cycles and are compared after each. Where they differ the step is
repeated and halved until one cycle is left: that is executed as Python and compared after each pass.

A real differs if it is off by more than a share of the greatest number with its unit in either state: 1e-6,
or TIMES last digits of the narrower reals if that is more. Angles and moments count with the size of the
greatest block. Groups that only one has, codes and pointers differ always. The common block does not count.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from io import StringIO
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.interpreted_kernels import interpreted, observe
from udec_ia.debug.cycle_snapshots import StateCopy, copy_state
from udec_ia.debug.cycle_trace import ROOT, UNDER
from udec_ia.debug.debugged_run import count_cycles, cycle_statement
from udec_ia.deck.command_monitor import RESTART_FILE, Monitor
from udec_ia.deck.deck_statements import Line, Statement, statements, tokens
from udec_ia.deck.deck_variables import Values
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.block_matching import Side
from udec_ia.heap_tools.state_comparison import Compared, Differing, compare
from udec_ia.kernels.drive.unbalanced_force import at_rest
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field
from udec_ia.ops.common.array_growth import keep_spare
from udec_ia.ops.common.deformable_scene import soft
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.printable_text import counted
from udec_ia.reader.word_map import KINDS
from udec_ia.running.cycle_errors import raise_error
from udec_ia.running.cycle_replay import Replay
from udec_ia.running.history_series import SOLVE_LIMIT, run_unwatched
from udec_ia.running.run_cycles import prepare

EVERY = 60  # cycles between two comparisons; a multiple of those after which SOLVE looks for rest
STOPS = 1000  # times that a cycle may stop for memory
SHARE, TIMES = 1e-6, 100
ARMS = {"rad/s": ("m/s", -1), "N": ("N/m", 1)}  # units that are others times or over a length
States = tuple[StateCopy, StateCopy]


# ---- comparison of two states


class Difference(NamedTuple):
    """A number in which two states differ, or a group that only one has: then field is made or deleted.

    group: its name in the state that has it. share: of the greatest number of the unit.
    """

    group: str
    field: str
    first: Any
    second: Any
    share: float


def find_difference(one: MainArray, two: MainArray, share: float | None) -> Difference | None:
    """The worst difference that counts between two states, None if there is none.

    share: of the greatest number of a unit, by which a real may be off; None for that of the real types.
    """
    found = compare(one.h, two.h, KINDS)
    for k, what in enumerate(("deleted", "made")):
        for kind, alone in found.alone.items():
            if len(alone[k]):
                return Difference(f"{kind}@{alone[k][0]}", what, "", "", np.inf)
    if share is None:
        digits = [float(np.finfo(state.scheme.real_type).eps) for state in (one, two)]
        share = max(SHARE, TIMES * max(digits))
    differing = (_worst(found, field) for field in found.fields)
    worst = max(differing, key=lambda off: off.share, default=None)
    return worst if worst is not None and worst.share > share else None


def _worst(found: Compared, field: Differing) -> Difference:
    """The greatest difference of a field."""
    shares = np.full(len(field.one), np.inf)
    if field.field.real:
        with np.errstate(all="ignore"):
            off = field.distances.absolute / _greatest(found.matching.sides, field.field.unit)
        shares = np.nan_to_num(off, nan=np.inf)
    row = int(np.argmax(shares))
    one, two = (column[row].item() for column in field.values)
    return Difference(f"{field.kind}@{field.one[row]}", field.name, one, two, float(shares[row]))


def _greatest(sides: tuple[Side, Side], unit: str) -> float:
    """The greatest number with a unit in two states."""
    found = _in_states(sides, lambda field: field.unit == unit)
    if unit in ARMS:
        other, power = ARMS[unit]
        size = _in_states(sides, lambda field: field.name == "KBRO") or 1.0
        found = max(found, _in_states(sides, lambda field: field.unit == other) * size**power)
    return found


def _in_states(sides: tuple[Side, Side], is_meant: Callable[[Field], bool]) -> float:
    """The greatest finite number in certain real fields of two states, without its sign."""
    found = 0.0
    for atlas in (side.atlas for side in sides):
        for kind, words in atlas.shapes.items():
            for word in words:
                if word.field.real and is_meant(word.field):
                    values = np.abs(atlas.gather(word, atlas.groups[kind]))
                    found = max(found, float(np.max(values[np.isfinite(values)], initial=0.0)))
    return found


# ---- runs in steps


class Step(NamedTuple):
    """The state that a run has come to. line: the line of the deck that is next, or was last, "" for none."""

    copy: StateCopy
    cycle: int
    line: str


class SteppedRun(NamedTuple):
    """model: the model of the run. steps: gives its states, as they are asked for."""

    model: Any
    steps: Iterator[Step]


def of_state(model: Any, cycles: int) -> SteppedRun:
    """So many cycles from the state of a model."""
    return SteppedRun(model, _cycles(model, cycles))


def of_deck(
    model: Any, text: str, name: str = "deck", values: Values | None = None, beside: Sequence[Path] = ()
) -> SteppedRun:
    """The deck `text`, on a new model. values: of its variables, by name.

    beside: folders of files that RESTART finds if the deck wrote none.
    """
    return SteppedRun(model, _deck(_Monitor(model, values, beside), text, name))


class _Monitor(Monitor):
    """Obeys a deck whose own files are in a folder that had none."""

    def __init__(self, model: Any, values: Values | None, beside: Sequence[Path]) -> None:
        super().__init__(model, StringIO(), values=values)
        self._beside = beside

    def place(self, command: str, name: str | None) -> Path | None:
        """As Monitor.place; a restart file that is not there is looked for in the other folders."""
        if command == "restart" and not (self.model.session.out / (name or RESTART_FILE)).exists():
            for folder in self._beside:
                if (folder / (name or RESTART_FILE)).exists():
                    return folder / (name or RESTART_FILE)
        return super().place(command, name)


def _cycles(model: Any, cycles: int) -> Iterator[Step]:
    yield _step(model)
    last = int(model.array.h.ci[g.MCTOT]) + cycles
    while (left := last - int(model.array.h.ci[g.MCTOT])) > 0:
        model.cycle(min(left, _to_next(model)))
        yield _step(model)


def _deck(monitor: Monitor, text: str, name: str) -> Iterator[Step]:
    model: Any = monitor.model
    monitor.variables.check(text.splitlines(), name)
    for statement in monitor.variables.filled(statements(text.splitlines(), name)):
        if not statement.tokens or monitor.ended:
            continue
        line = f"{name}:{statement.tokens[0].line.number}: {statement.tokens[0].line.shown.strip()}"
        ratio, left = _rest_of(statement)
        if not left:
            monitor.obey(statement)
            continue
        monitor.obey(cycle_statement(statement, 0))
        yield _step(model, line)
        while left > 0:
            piece = min(left, _to_next(model))
            monitor.obey(_part(statement, ratio, piece))
            left -= piece
            yield _step(model, line)
            if ratio is not None and at_rest(model.array.h, ratio):
                break


def _rest_of(statement: Statement) -> tuple[float | None, int]:
    """The force ratio that a SOLVE asks for, and how many cycles it or a CYCLE has at most; 0 for others.

    SOLVE ... STATIC is one of the others: all stands still at its end, so it cannot be done in parts. So is
    SOLVE ... MEAN, which is seldom.
    """
    call = parse(statement)
    if call.command.name != "solve":
        return None, count_cycles(statement)
    if call.named.get("static") or call.named.get("criterion") == "mean":
        return None, 0
    return float(call.positional[0]), int(call.named.get("limit", SOLVE_LIMIT))


def _part(statement: Statement, ratio: float | None, n: int) -> Statement:
    """So many cycles of a CYCLE or SOLVE. A SOLVE in such parts ends after the same cycle as a whole one."""
    if ratio is None:
        return cycle_statement(statement, n)
    first = statement.tokens[0].line
    line = Line(first.file, first.number, f"SOLVE {ratio!r} LIMIT {n}")
    return Statement([line], tokens(line))


def _to_next(model: Any) -> int:
    """Cycles until the next comparison."""
    return EVERY - int(model.array.h.ci[g.MCTOT]) % EVERY


def _step(model: Any, line: str = "") -> Step:
    return Step(copy_state(model.array), int(model.array.h.ci[g.MCTOT]), line)


# ---- the passes of one cycle


class _PassStates:
    """The cycle that follows the state in `array`, which is changed. after: name of each pass, and a copy."""

    def __init__(self, array: MainArray, laws: LawBook) -> None:
        self.after: list[tuple[str, StateCopy]] = []
        self._array, self._name = array, ROOT
        with interpreted(), suppress(UdecError):
            bound = laws.bind(array)
            given = soft(array.h), bound.blocks, bound.joints
            cycle = int(array.h.ci[g.MCTOT])
            for _ in range(STOPS):
                run_unwatched(observe(array.h, self._observe), 1, given)
                raise_error(array, bound.book)
                if array.h.ci[g.MCTOT] > cycle:
                    break
        self._end()

    def _observe(self, part: str, where: Any, value: Any, written: bool) -> None:
        name = _pass_of(sys._getframe(2))
        if name != self._name:
            self._end()
            self._name = name

    def _end(self) -> None:
        """The pass is over. What the loop of the passes itself counts is no pass."""
        if self._name != ROOT:
            self.after.append((self._name, copy_state(self._array)))


def _pass_of(frame: FrameType | None) -> str:
    """The routine that the loop of the passes has called; that loop itself if it has called none."""
    name = ROOT
    while frame is not None and frame.f_code.co_name != ROOT:
        if not frame.f_globals["__name__"].startswith(UNDER):
            name = frame.f_code.co_name
        frame = frame.f_back
    return name


# ---- search


class Divergence(NamedTuple):
    """Where two runs differ first. cycle: its number; in_pass: "" if they differ before it.

    off: the worst difference after that pass. line: of the deck. states: both after the cycle.
    """

    cycle: int
    in_pass: str
    off: Difference
    line: str
    states: States


def find_divergence(one: SteppedRun, two: SteppedRun, share: float | None) -> Divergence | int:
    """Where two runs differ first, or how many cycles they agree. Raises the UdecError that ends one."""
    before: tuple[Step, Step] | None = None
    agreed = 0
    for now in zip(one.steps, two.steps, strict=False):
        if now[0].cycle != now[1].cycle:
            places = [f"{counted(one.cycle, 'cycle')} {one.line and 'after '}{one.line}" for one in now]
            raise UdecError(
                26,
                f"the first run has {places[0]}, the second {places[1]}",
                "only runs with the same CYCLEs, and SOLVEs that end after as many cycles, can be compared",
            )
        cycle = now[0].cycle
        agreed += max(cycle - before[0].cycle, 0) if before else 0  # START begins at 0 again
        off = find_difference(now[0].copy.array(), now[1].copy.array(), share)
        if off is not None:
            if before is None or before[0].cycle == cycle:
                return Divergence(cycle, "", off, now[0].line, (now[0].copy, now[1].copy))
            return _within((one, two), before, now, share)
        before = now
    return agreed


def _within(
    runs: tuple[SteppedRun, SteppedRun],
    before: tuple[Step, Step],
    now: tuple[Step, Step],
    share: float | None,
) -> Divergence:
    """The same, where the runs differ within a step."""
    low, high = before[0].cycle, now[0].cycle
    start = before[0].copy, before[1].copy
    while high - low > 1:
        middle = (low + high) // 2
        states = _on(runs, start, middle - low)
        if find_difference(states[0].array(), states[1].array(), share) is None:
            low, start = middle, states
        else:
            high = middle
    in_pass, off = _first_pass(runs, start, share)
    states = _on(runs, start, 1)
    off = off or find_difference(states[0].array(), states[1].array(), share)
    if off is None:
        raise UdecError(
            26,
            f"the runs differ in the cycles {low + 1} to {now[0].cycle}, but not when these are repeated",
            "a law of yours may depend on more than what it is given",
        )
    return Divergence(high, in_pass, off, now[0].line, states)


def _on(runs: tuple[SteppedRun, SteppedRun], start: States, cycles: int) -> States:
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


def _first_pass(
    runs: tuple[SteppedRun, SteppedRun], start: States, share: float | None
) -> tuple[str, Difference | None]:
    """The first pass of the next cycle after which the runs differ, and by what; "" if it is none alone."""
    passes = [
        _PassStates(_ready(copy), run.model.session.laws) for copy, run in zip(start, runs, strict=True)
    ]
    for (name, a), (other, b) in zip(passes[0].after, passes[1].after, strict=False):
        off = find_difference(a.array(), b.array(), share)
        if off is not None:
            return (name if name == other else f"{name} and {other}"), off
    return "", None
