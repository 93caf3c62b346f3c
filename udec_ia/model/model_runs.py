"""CYCLE and SOLVE of a session: cycles with progress, histories, warnings and undo around them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import inf

from udec_ia.compiling.interpreting import mode
from udec_ia.errors import UdecError
from udec_ia.heap_tools.memory_order import arrange
from udec_ia.kernels.drive.unbalanced import at_rest, at_rest_in_mean, force_ratios, motion_ratio, unbalanced
from udec_ia.kernels.energy.stored import liveliest
from udec_ia.layout.offsets import MCTOT, WFRIC
from udec_ia.model.model_session import Session
from udec_ia.ops.common.deformable_scene import soft_or_loaded_in
from udec_ia.ops.run.aside import speed_after
from udec_ia.ops.run.cycle import cycle, finish
from udec_ia.ops.run.damped import UNDAMPED, damping
from udec_ia.ops.run.remarks import (
    on_joints,
    on_laws,
    on_loads,
    on_moduli,
    on_resolution,
    on_rest,
    on_rounding,
    on_slivers,
    on_softness,
)
from udec_ia.ops.run.scaling import relaxations_due
from udec_ia.ops.run.solution import MEAN, Solution
from udec_ia.ops.run.static import STATIC, statically
from udec_ia.ops.run.strides import given
from udec_ia.ops.run.timestep import describe, kind_of
from udec_ia.ops.run.unrest import Unrest
from udec_ia.ops.run.watch import Watch

PICTURES = 40  # pictures that an animation takes during one CYCLE command
GIVEN = "given strides"  # of that which BOUNDARY moves, before the run
STRIDES = "strides"  # what they lose of a steady way is told once, after the run
RESOLUTION = "resolution"  # what reals of few bits lose is told once, before the run or after it

LogPart = Callable[[int], None]  # logs so many cycles of a run that has ended early


def solve_as_given(session: Session, ratio: float, limit: int, criterion: str, log_part: LogPart) -> Solution:
    """SOLVE with the damping and the time-step that were given."""
    found = list(on_rest(session.array))
    session.remark(found)
    if found:  # CYCLE need not say it again
        session.skip_remark(UNDAMPED)
    return _run_to_rest(session, ratio, limit, criterion, log_part)


def solve_statically(
    session: Session, ratio: float, limit: int, criterion: str, log_part: LogPart
) -> Solution:
    """SOLVE STATIC."""
    session.inform(STATIC)
    undo = session.undo
    begun = undo.before
    try:
        with statically(session.array):
            return _run_to_rest(session, ratio, limit, criterion, log_part)
    finally:
        if undo.before is not begun:  # cycles are to stay, and with them what stood before
            undo.confirm_run(session)


def _run_to_rest(session: Session, ratio: float, limit: int, criterion: str, log_part: LogPart) -> Solution:
    """Up to `limit` cycles to rest."""
    array, guard, mean = session.array, session.guard, criterion == MEAN
    unrest = Unrest(guard.since_rest(array))
    watch = Watch(array, session.recorder.series, ratio, mean, unrest)
    cycles = run_cycles(session, limit, watch, log_part)
    h, kinds = array.h, soft_or_loaded_in(array.h)
    reached = cycles > 0 and bool((at_rest_in_mean if mean else at_rest)(h, float(ratio)))
    largest, average = map(float, force_ratios(h, kinds))
    worst, lively = (
        kind_of(h, int(at)) if at else "" for at in (unbalanced(h, kinds)[1], liveliest(h, kinds)[2])
    )

    def speed(ib: int, n: int) -> float:
        return inf if session.laws.given else speed_after(array, ib, n)  # a law may remember cycles

    state, why = unrest.explain(array, reached, ratio, session.guard, speed)
    motion = float(motion_ratio(h, kinds))
    solution = Solution(
        reached, ratio, largest, cycles, worst, motion, lively, criterion, average, state, why
    )
    session.recorder.solutions.append(solution)
    if reached:
        session.guard.rested = float(h.cd[WFRIC])
    return solution


def run_cycles(session: Session, n: int, watch: Watch | None, log_part: LogPart) -> int:
    """Up to `n` cycles observed by `watch`, with progress and files; returns how many were completed.

    log_part: logs the completed cycles when the run ends early.
    """
    array, undo, guard = session.array, session.undo, session.guard
    session.forget_boxes()
    if array.h.ci[MCTOT] == 0 or relaxations_due(array):
        undo.save_words(array)  # to be arranged, rounded, given masses and relaxations
    moved = arrange(array)
    if moved is not None:
        session.renumber(moved)
    guard.drift.begin(array)
    guard.since_rest(array)
    watch = session.around(watch)
    report = session.report(n)
    before = int(array.h.ci[MCTOT])
    every = max(1, n // PICTURES) if session.animate else None

    def confirm_piece() -> None:
        """The cycles of a run until now are to stay, whatever ends it."""
        if mode.python:
            finish(array, watch)
        undo.confirm_piece(session)

    try:
        done = cycle(
            array, n, report, every, lambda: _warn(session), session.laws, watch, confirm_piece, guard
        )
    except BaseException:
        log_part(int(array.h.ci[MCTOT]) - before)  # they stay
        finish(array, watch)
        with suppress(UdecError):  # of two errors the first one counts
            session.write_histories(watch)
        raise
    finally:
        report.close()
    undo.confirm_run(session)
    session.write_histories(watch)
    lost = list(guard.strides.told(array))
    session.remark(lost, what=STRIDES)
    if not lost:
        session.remark(guard.drift.told(array), what=RESOLUTION)
    return done


def _warn(session: Session) -> None:
    """Check the time-step and the materials of a CYCLE; explain the step on request."""
    array, guard = session.array, session.guard
    guard.runaway.judge(array, session.explain_step)
    guard.strides.begin(array)
    if session.explain_step:
        session.inform(describe(array, guard.runaway.safe))
        session.remark([damping(array.h)], session.inform)
    session.remark(on_moduli(array, session.laws.block_laws))
    session.remark(on_laws(array))
    session.remark(on_joints(array))
    session.remark(on_loads(array))
    session.remark(list(on_rounding(array)) or on_slivers(array))
    session.remark(on_softness(array))
    session.remark(on_resolution(array), what=RESOLUTION)
    session.remark(given(array), what=GIVEN)
