"""CYCLE: preparation (INI), then the calculation cycle in pieces (report 2.6).

Between two pieces observers are called, progress is reported, and a safe time-step is updated. Pieces allow a
few reports a second, and have no influence on the results.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from udec_ia.compiling.compile_duration import working_time
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.kernels.body.mass_distribution import make_masses
from udec_ia.kernels.constitutive.joint_models import find_short_steps
from udec_ia.kernels.constitutive.joint_stresses import allow_for_stiffness
from udec_ia.kernels.drive.critical_stiffness import allow_for_volumes
from udec_ia.layout import offsets as g
from udec_ia.ops.commands import energy_account
from udec_ia.ops.commands.corner_rounding import check_strained_edges, settle_default
from udec_ia.ops.commands.joint_property_command import update_all_joints
from udec_ia.ops.commands.water_command import update_water
from udec_ia.ops.common.array_growth import keep_spare
from udec_ia.ops.common.kernel_arguments import renew_forces, soft
from udec_ia.ops.laws.registered_laws import Bound, LawBook
from udec_ia.reader.list_walks import chain
from udec_ia.running.between_cycles import cycles_to_update, put_step, update_between_cycles
from udec_ia.running.critical_step import time_step
from udec_ia.running.cycle_errors import SPOILING, check_finite, raise_error
from udec_ia.running.cycle_observer import Observer
from udec_ia.running.history_series import Recording
from udec_ia.running.mass_scaling import renew_relaxations
from udec_ia.running.time_goal import LIMIT_OF_CYCLES, TimeGoal

REPORT_SECONDS = 0.2
FIRST_PIECE = 10
Report = Callable[[int], None]
Action = Callable[[], None]


def prepare(array: MainArray) -> None:
    """Prepare for cycling (INI): masses, rounding, time-step and damping factors.

    All but the short steps of joints is done only if a command has come since the last CYCLE, so that the
    number of cycles of a CYCLE does not change a digit. Errors 11, 12, 13, 14, 16, 26 and 28.
    """
    h = array.h
    if h.ci[g.NBLK] == 0:
        raise UdecError(26, "there is no block to cycle", "create one with BLOCK")
    if h.ci[g.LJOINT]:
        find_short_steps(h)
    if h.ci[g.LREADY]:
        check_strained_edges(array)
        return
    if h.ci[g.MCTOT] == 0:
        make_masses(h, soft(array.h))
    settle_default(array)
    update_all_joints(array)
    update_water(array)
    if array.h.ci[g.MCTOT] == 0:
        renew_forces(array)  # of INSITU, which SPLIT and GENERATE have shared out since
    check_strained_edges(array)
    _check_deformable(array)
    renew_relaxations(array)
    h = array.h  # it may have grown
    allow_for_stiffness(h, True)
    allow_for_volumes(h)
    put_step(array, time_step(array))
    h.ci[g.MSCALE] = h.ci[g.NMADE]
    h.ci[g.LREADY] = 1


def _check_deformable(array: MainArray) -> None:
    """Error 26 for a fully-deformable block without zones, or a deformable one without stiffness."""
    h = array.h
    for ib in chain(h, int(h.ci[g.IBPNT]), g.KB) if h.ci[g.NSOFT] else ():
        if iget(h, ib, HEAD) == g.MFDEF and iget(h, iget(h, ib, g.KBEX), g.KFZ) == 0:
            place = f"({getr(h, ib, g.KX):g}, {getr(h, ib, g.KY):g})"
            raise UdecError(26, f"block@{ib} at {place} has no zones", "GENERATE divides it", group=ib)
        m = iget(h, ib, g.KMAT)
        if iget(h, ib, HEAD) != g.MRIG and not h.cr[g.ALAM1 + m - 1] > 0:
            detail = f"block@{ib} is deformable, and its material {m} has neither BULK nor G"
            raise UdecError(26, detail, f"PROPERTY MATERIAL={m} BULK=... G=...", group=ib)


def cycle(
    array: MainArray,
    n: int,
    *,
    recording: Recording | None = None,
    observers: Sequence[Observer] = (),
    goal: TimeGoal | None = None,
    laws: LawBook | None = None,
    report: Report | None = None,
    every: int | None = None,
    before_first_cycle: Action = lambda: None,
    after_each_piece: Action = lambda: None,
) -> int:
    """Run `n` cycles. Returns how many were completed.

    recording: of `array`; may end the run at its force ratio. goal: ends the run in place of `n`, then the
    number of cycles that is expected. laws: error 9 if one in use is missing. report: called with the number
    of cycles done, every `every` cycles or a few times a second. before_first_cycle: called when the
    time-step is known. after_each_piece: called once before the first piece, and after each one before its
    errors are raised, as its cycles stay. Errors 15 for a too great overlap, 36 for reals that are too coarse
    or too small; the cycle with the error is completed.
    """
    prepare(array)
    before_first_cycle()
    bound = (laws or LawBook()).bind(array)
    keep_spare(array)
    array.h.ci[g.NCYC] = n
    # an interrupted run may have left an error or a request for memory
    array.h.ci[g.NERR] = array.h.ci[g.IERAD] = array.h.ci[g.NWANT] = 0
    energy_account.begin(array)
    recording = recording or Recording(array, [])
    try:
        try:
            recording.begin(n)
            limit, watching = (n, observers) if goal is None else (LIMIT_OF_CYCLES, (*observers, goal))
            done = _run(array, limit, bound, recording, watching, report, every, after_each_piece)
        finally:
            finish(array, recording)
            for one in observers:
                one.end(array)
        check_finite(array)
    except UdecError as error:
        if error.number in SPOILING:
            array.h.ci[g.NSPOIL], array.h.ci[g.MCSPOI] = error.number, array.h.ci[g.MCTOT]
        raise
    return done


def finish(array: MainArray, recording: Recording) -> None:
    """Complete the sums and series of a run that ends, also after an error. May be called twice."""
    energy_account.end(array)
    recording.flush_rows()


def _run(
    array: MainArray,
    n: int,
    bound: Bound,
    recording: Recording,
    observers: Sequence[Observer],
    report: Report | None,
    every: int | None,
    after_each_piece: Action,
) -> int:
    """Up to `n` cycles, in pieces. Returns how many were completed."""
    for one in observers:
        one.begin(array, recording.ratio >= 0)

    def goes_on(goal: int) -> bool:
        return done < goal and not recording.reached and not any(one.is_over() for one in observers)

    done, piece = 0, FIRST_PIECE
    after_each_piece()
    while goes_on(n):
        poll()
        start = working_time()
        before, target = done, min(done + piece, n, n if every is None else done - done % every + every)
        while goes_on(target):
            cycles = cycles_to_update(array, target - done)
            for one in observers:
                cycles = one.cycles_ahead(array, cycles)
            completed = recording.run(cycles, (soft(array.h), bound.blocks, bound.joints))
            done += completed
            after_each_piece()
            for one in observers if completed else ():
                one.look(array, completed)
            raise_error(array, bound.book)
            if array.h.ci[g.JPHASE] == g.AT_BLOCKS and update_between_cycles(array):  # else the cycle goes on
                recording.renew()
        if report is not None and (every is None or done % every == 0 or done == n):
            report(done)
        seconds = max(working_time() - start, 1e-6)
        piece = max(1, min(int((done - before) * REPORT_SECONDS / seconds), 4 * piece))
    return done
