"""Runs two decks, word schemes or states side by side: the first cycle, pass and number in which they differ.

Both go on in steps of at most EVERY cycles and are compared after each. Where they differ the step is
repeated and halved until one cycle is left: that is executed as Python and compared after each pass.

A real differs if it is off by more than a share of the greatest number with its unit in either state: 1e-6,
or TIMES last digits of the narrower reals if that is more. Angles and moments count with the size of the
greatest block. Groups that only one has, codes and pointers differ always. The common block does not count in
the search. What commands have set there is compared before the first cycle.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from io import StringIO
from itertools import chain, groupby, islice
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.debug.cycle_trace import ROOT, CycleTrace
from udec_ia.debug.debugged_run import count_cycles, cycle_statement, cycled_time
from udec_ia.deck.command_monitor import RESTART_FILE, Monitor
from udec_ia.deck.deck_statements import Line, Statement, statements, tokens
from udec_ia.deck.deck_variables import Values
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.block_matching import Side
from udec_ia.heap_tools.state_comparison import COMMON, Compared, Differing, compare
from udec_ia.kernels.drive.unbalanced_force import at_rest
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field
from udec_ia.ops.common.array_growth import keep_spare
from udec_ia.printable_text import counted
from udec_ia.reader.word_map import KINDS
from udec_ia.running.cycle_replay import Replay
from udec_ia.running.history_series import SOLVE_LIMIT
from udec_ia.running.run_cycles import prepare
from udec_ia.running.time_goal import TimeGoal

EVERY = 60  # cycles between two comparisons; a multiple of those after which SOLVE looks for rest
SHARE, TIMES = 1e-6, 100
SET_BY_CYCLE = ("LREADY", "NCYC")  # variables that the next CYCLE finds or sets
ARMS = {"rad/s": ("m/s", -1), "N": ("N/m", 1)}  # units that are others times or over a length
States = tuple[MainArray, MainArray]


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
    """The worst difference of more than `share`, by default that of the real types; None if there is none."""
    found = compare(one.h, two.h, KINDS)
    for k, what in enumerate(("deleted", "made")):
        for kind, alone in found.alone.items():
            if len(alone[k]):
                return Difference(f"{kind}@{alone[k][0]}", what, "", "", np.inf)
    differing = (_worst(found, field) for field in found.fields)
    worst = max(differing, key=lambda off: off.share, default=None)
    return worst if worst is not None and worst.share > _ignored(one, two, share) else None


def _ignored(one: MainArray, two: MainArray, share: float | None) -> float:
    """The share up to which differences are ignored, by default that of the real types."""
    if share is not None:
        return share
    digits = [float(np.finfo(state.scheme.real_type).eps) for state in (one, two)]
    return max(SHARE, TIMES * max(digits))


def compare_settings(one: MainArray, two: MainArray, share: float | None) -> list[Difference]:
    """What commands have set otherwise in the common block, such as properties of materials and gravity.

    Reals differ by more than `share` of their own size. Lists, sums over time and counts of cycles do not
    count.
    """
    found = list[Difference]()
    for field in compare(one.h, two.h, [COMMON]).fields:
        name, several = field.field.name, field.field.count > 1
        if field.field.target or field.field.type == "double" or name in SET_BY_CYCLE:
            continue
        shares = field.distances.relative if field.field.real else np.full(len(field.one), np.inf)
        for k in np.flatnonzero(~(shares <= _ignored(one, two, share))).tolist():
            of = f"{name}({field.one[k] + 1})" if several else name
            first, second = (column[k].item() for column in field.values)
            found.append(Difference("common block", of, first, second, float(shares[k])))
    return found


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


def _in_states(sides: tuple[Side, Side], is_wanted: Callable[[Field], bool]) -> float:
    """The greatest finite number in certain real fields of two states, without its sign."""
    found = 0.0
    for atlas in (side.atlas for side in sides):
        for kind, words in atlas.shapes.items():
            for word in words:
                if word.field.real and is_wanted(word.field):
                    values = np.abs(atlas.gather(word, atlas.groups[kind]))
                    found = max(found, float(np.max(values[np.isfinite(values)], initial=0.0)))
    return found


# ---- runs in steps


Step = tuple[MainArray, str]  # a copy of the state, and the last or next line of the deck, "" without one


class SteppedRun(NamedTuple):
    """steps: iterates over the states that the model comes to."""

    model: Any
    steps: Iterator[Step]


def of_deck(
    model: Any, text: str, name: str = "deck", values: Values | None = None, folders: Sequence[Path] = ()
) -> SteppedRun:
    """The deck `text`, on a model. name: of the deck, "" to name no lines. folders: of its input files."""
    return SteppedRun(model, _deck(_Monitor(model, values, folders), text, name))


class _Monitor(Monitor):
    """Executes a deck; an input file that is not beside its own files is looked for in other folders."""

    def __init__(self, model: Any, values: Values | None, folders: Sequence[Path]) -> None:
        super().__init__(model, StringIO(), values=values)
        self._folders = folders

    def place(self, command: str, name: str | None, deck: str) -> Path | None:
        """As Monitor.place."""
        file = name or RESTART_FILE
        if command in ("restart", "function") and not (self.model.session.out / file).exists():
            for folder in self._folders:
                if (folder / file).exists():
                    return folder / file
        return super().place(command, name, deck)


def _deck(monitor: Monitor, text: str, name: str) -> Iterator[Step]:
    model: Any = monitor.model
    if model.session.started:
        yield model.array.copy(), ""
    monitor.variables.check(text.splitlines(), name)
    for statement in monitor.variables.filled(statements(text.splitlines(), name)):
        if not statement.tokens or monitor.ended:
            continue
        first = statement.tokens[0].line
        line = f"{name}:{first.number}: {first.shown.strip()}" if name else ""
        ratio, left = _rest_of(statement)
        time = cycled_time(statement)
        if not left and not time:
            monitor.execute(statement)
            continue
        monitor.execute(cycle_statement(statement, 0))
        yield model.array.copy(), line
        goal = TimeGoal(model.array, time) if time else None
        left = goal.left if goal else left
        while left > 0:
            piece = min(left, EVERY - int(model.array.h.ci[g.MCTOT]) % EVERY)
            monitor.execute(_part(statement, ratio, piece))
            left = goal.cycles_left(model.array) if goal else left - piece
            yield model.array.copy(), line
            if ratio is not None and at_rest(model.array.h, ratio):
                break


def _rest_of(statement: Statement) -> tuple[float | None, int]:
    """The force ratio of a SOLVE, and the greatest number of cycles of a SOLVE or CYCLE; 0 for others.

    SOLVE ... STATIC, at the end of which all velocities are 0, and SOLVE ... MEAN are not split: also 0.
    """
    call = parse(statement)
    if call.command.name != "solve":
        return None, count_cycles(statement)
    if call.named.get("static") or call.named.get("criterion") == "mean":
        return None, 0
    return float(call.positional[0]), int(call.named.get("limit", SOLVE_LIMIT))


def _part(statement: Statement, ratio: float | None, n: int) -> Statement:
    """`n` cycles of a CYCLE or SOLVE. A SOLVE in parts of EVERY ends after the same cycle as a whole one."""
    if ratio is None:
        return cycle_statement(statement, n)
    first = statement.tokens[0].line
    line = Line(first.file, first.number, f"SOLVE {ratio!r} LIMIT {n}")
    return Statement([line], tokens(line))


def take_first_states(*runs: SteppedRun) -> tuple[list[MainArray], list[SteppedRun]]:
    """The states before the first cycle, as far as there are any, and the runs with these before them."""
    begun = [[*islice(run.steps, 1)] for run in runs]
    again = [run._replace(steps=chain(step, run.steps)) for step, run in zip(begun, runs, strict=True)]
    return [state for step in begun for state, _ in step], again


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
    before: States | None = None
    agreed = 0
    for (a, line), (b, other) in zip(one.steps, two.steps, strict=False):
        cycle, of_other = (int(state.h.ci[g.MCTOT]) for state in (a, b))
        if cycle != of_other:
            raise UdecError(
                26,
                f"the first run has {counted(cycle, 'cycle')} {line and 'after '}{line}, the second "
                f"{counted(of_other, 'cycle')} {other and 'after '}{other}",
                "only runs with the same CYCLEs, and SOLVEs that end after as many cycles, can be compared",
            )
        done = cycle - int(before[0].h.ci[g.MCTOT]) if before else 0
        agreed += max(done, 0)  # START begins at 0 again
        off = find_difference(a, b, share)
        if off is not None:
            if before is None or done <= 0:
                return Divergence(cycle, "", off, line, (a, b))
            return _within((one, two), before, done, line, share)
        before = a, b
    return agreed


def _within(
    runs: tuple[SteppedRun, SteppedRun], start: States, cycles: int, line: str, share: float | None
) -> Divergence:
    """The same, where the runs differ within some cycles from a state on."""
    while cycles > 1:
        states = _on(runs, start, cycles // 2)
        if find_difference(*states, share) is None:
            start, cycles = states, cycles - cycles // 2
        else:
            cycles //= 2
    in_pass, off = "", None
    passes = [[*_passes(_ready(state), run)] for state, run in zip(start, runs, strict=True)]
    for (name, a), (other, b) in zip(*passes, strict=False):
        off = find_difference(a, b, share)
        if off is not None:
            in_pass = name if name == other else f"{name} and {other}"
            break
    states = _on(runs, start, 1)
    off = off or find_difference(*states, share)
    if off is None:
        what = "the runs differ after some cycles, but not when these are repeated"
        raise UdecError(26, what, "a user law may depend on more than its arguments")
    return Divergence(int(start[0].h.ci[g.MCTOT]) + 1, in_pass, off, line, states)


def _on(runs: tuple[SteppedRun, SteppedRun], start: States, cycles: int) -> States:
    """The states `cycles` cycles later."""
    states = _ready(start[0]), _ready(start[1])
    for run, array in zip(runs, states, strict=True):
        with suppress(UdecError):  # which the run has ended with
            Replay(array, run.model.session.laws).step(cycles)
    return states


def _ready(state: MainArray) -> MainArray:
    """A copy of the state, prepared to be cycled as CYCLE does."""
    array = state.copy()
    prepare(array)
    keep_spare(array)
    return array


def _passes(array: MainArray, run: SteppedRun) -> Iterator[tuple[str, MainArray]]:
    """The passes of the cycle that follows the state in `array`: the name of each, and the state after it."""
    trace = CycleTrace(array, run.model.session.laws)
    for name, accesses in groupby(enumerate(trace.accesses), key=lambda one: one[1].work.of):
        *_, (last, _) = accesses
        trace.go(bisect_right(trace.writes, last))
        if name != ROOT:  # the loop of the passes itself
            yield name, trace.state.copy()
