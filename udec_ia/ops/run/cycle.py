"""CYCLE: prepare (INI), then run the calculation cycle in pieces (report 2.6).

Between two pieces the caller hears how far the run has come; the pieces are as long as fits a few reports
a second and have no influence on the results.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from udec_ia.compiling.compile_time import working_time
from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.errors import (
    INSIDE_OUT,
    LAW_FAILED,
    OUT_OF_NOWHERE,
    OVERFLOW,
    OVERLAP_TOO_GREAT,
    TOO_FAR,
    TOO_SHORT,
    UdecError,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.masses import make_masses
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials, material_of
from udec_ia.kernels.drive.finite import not_finite
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table
from udec_ia.ops.commands import energy_account
from udec_ia.ops.commands.corner_rounding import check_strained_edges, crowded, settle_default
from udec_ia.ops.common.array_growth import find_room, keep_spare
from udec_ia.ops.common.block_ranges import chain
from udec_ia.ops.common.deformable_scene import soft
from udec_ia.ops.common.number_limits import last_digit
from udec_ia.ops.laws.law_book import Bound, LawBook
from udec_ia.ops.run.guard import Guard
from udec_ia.ops.run.remarks import sinks_too_far
from udec_ia.ops.run.renewal import ahead, put_step
from udec_ia.ops.run.scaling import renew_relaxations
from udec_ia.ops.run.timestep import kind_of, share_of, time_step
from udec_ia.ops.run.watch import Watch, run_unwatched
from udec_ia.signals import poll

NOT_FINITE = InterpretWhenSmall(not_finite, 2e3)
SPOILING = (TOO_SHORT, OVERLAP_TOO_GREAT, INSIDE_OUT, TOO_FAR, OUT_OF_NOWHERE)  # errors of impossible states
KINDS = {head.value: head.group for head in read_table().heads}
REPORT_SECONDS = 0.2
FIRST_PIECE = 10
Report = Callable[[int], None]
Prepared = Callable[[], None]


def prepare(array: MainArray) -> None:
    """Prepare for cycling (INI): masses, rounding, time-step and damping factors.

    Nothing is found anew unless a command has come since the last CYCLE: how many cycles a CYCLE has does not
    change the digits of any.
    Errors 11, 12, 13, 14, 16, 26 and 28.
    """
    h = array.h
    if h.ci[g.NBLK] == 0:
        raise UdecError(26, "there is no block to cycle", "create one with BLOCK")
    if h.ci[g.LREADY]:
        check_strained_edges(array)
        return
    if h.ci[g.MCTOT] == 0:
        make_masses(h, soft(array))
    settle_default(array)
    check_strained_edges(array)
    _check_deformable(array)
    renew_relaxations(array)
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
    report: Report | None = None,
    every: int | None = None,
    prepared: Prepared | None = None,
    laws: LawBook | None = None,
    watch: Watch | None = None,
    settled: Callable[[], None] | None = None,
    guard: Guard | None = None,
) -> int:
    """Run `n` cycles. Returns how many were completed.

    laws: those of the user's; error 9 if a constitutive number is in use for which there is none.
    report: called with the number of cycles done so far, every `every` cycles or a few times a second.
    prepared: called before the first cycle, when the time-step is known.
    watch: records on the way and may end the run before. guard: error 37 if it finds energy from nowhere.
    settled: called after every piece of the run, before its errors are raised: what was computed is to stay.
    Error 15 when a contact's overlap has become too great, 36 when a block has flown to where the reals are
    too coarse for contacts, or a force grown beyond them: the cycle in which it did is completed.
    """
    prepare(array)
    if prepared is not None:
        prepared()
    laws = laws or LawBook()
    bound = laws.bind(array)
    keep_spare(array)
    array.h.ci[g.NCYC] = n
    # a run that was interrupted may have left an error behind, or a wish for memory
    array.h.ci[g.NERR] = array.h.ci[g.IERAD] = array.h.ci[g.NWANT] = 0
    energy_account.begin(array)
    guard = guard or Guard()
    guard.runaway.begin(array, bound.own_blocks)
    try:
        try:
            done = _run(array, n, report, every, bound, watch, settled or (lambda: None), guard)
        finally:
            finish(array, watch)
            guard.runaway.end(array)
        _check_finite(array)
    except UdecError as error:
        if error.number in SPOILING:
            array.h.ci[g.NSPOIL], array.h.ci[g.MCSPOI] = error.number, array.h.ci[g.MCTOT]
        raise
    return done


def finish(array: MainArray, watch: Watch | None) -> None:
    """What a run that ends leaves, why ever it ends. To do it twice does no harm."""
    energy_account.end(array)
    if watch is not None:
        watch.hand_on()


def _run(
    array: MainArray,
    n: int,
    report: Report | None,
    every: int | None,
    bound: Bound,
    watch: Watch | None,
    settled: Callable[[], None],
    guard: Guard,
) -> int:
    """`n` cycles, in pieces. Returns how many were completed."""
    if watch is not None:
        watch.begin()
    done, piece = 0, FIRST_PIECE
    settled()
    while done < n and not (watch is not None and watch.reached):
        poll()
        start = working_time()
        before, target = done, min(done + piece, n, n if every is None else done - done % every + every)
        while done < target and not (watch is not None and watch.reached):
            cycles = ahead(array, min(target - done, guard.ahead(array.h)))
            if watch is not None:
                cycles = min(cycles, watch.ahead())
            given = soft(array), bound.blocks, bound.joints
            marks = guard.chatter.marks(array.h, n - done)
            if watch is None:
                done += run_unwatched(array.h, cycles, given, marks)
            else:
                done += watch.run(cycles, given, marks)
            settled()
            raise_error(array, bound.book)
            if array.h.ci[g.JPHASE] == g.AT_BLOCKS:  # else the cycle goes on first
                guard.look(array)
        if report is not None and (every is None or done % every == 0 or done == n):
            report(done)
        seconds = max(working_time() - start, 1e-6)
        piece = max(1, min(int((done - before) * REPORT_SECONDS / seconds), 4 * piece))
    return done


def _check_finite(array: MainArray) -> None:
    """Error 36 if the run has ended with a force, a velocity, a stress or an energy beyond the reals."""
    h, group = array.h, int(NOT_FINITE(int(array.h.ci[g.NBLK]), array.h))
    if group != 0:
        kind, *here = ("contact", g.KXC, g.KYC) if iget(h, group, HEAD) == g.MCON else ("block", g.KX, g.KY)
        x, y = (float(getr(h, group, k)) for k in here)
        what = f"a force, a velocity or a stress of {kind}@{group} at ({x:g}, {y:g}) is"
    elif not (np.isfinite(h.cr).all() and np.isfinite(h.cd).all()):
        what = "an energy or a displacement that the run has summed up is"
    else:
        return
    largest = float(np.finfo(array.scheme.real_type).max)
    detail = f"{what} greater than {array.scheme.real_bits}-bit reals can hold, {largest:.2g}, in cycle "
    raise UdecError(TOO_FAR, f"{detail}{int(h.ci[g.MCTOT])}", group=group)


def _strained(h: Memory, iz: int) -> str:
    """Zone `iz` and its block, or simply-deformable block `iz`, and its centroid, as a message names it."""
    if iget(h, iz, HEAD) == g.MSDEF:
        return f"block@{iz} at ({getr(h, iz, g.KX):g}, {getr(h, iz, g.KY):g})"
    corners = [iget(h, iz, g.KZG, i) for i in range(3)]
    x, y = (sum(float(getr(h, ig, k)) for ig in corners) / 3 for k in (g.KXG, g.KYG))
    return f"{kind_of(h, iz)} at ({x:g}, {y:g})"


def _too_far(array: MainArray, ib: int) -> UdecError:
    """Error 36: block `ib` is where the reals are too coarse for contacts."""
    h, bits = array.h, array.scheme.real_bits
    x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
    return UdecError(
        TOO_FAR,
        f"block@{ib} has come to ({x:g}, {y:g}) in cycle {int(h.ci[g.MCTOT])}, where {bits}-bit reals "
        f"resolve {last_digit(array, max(abs(x), abs(y))):g}, and the rounding length is {h.cr[g.DTOL]:g}",
        group=ib,
    )


def _without_contact(array: MainArray, ip: int) -> UdecError:
    """Error 15: corner `ip` has come into another block where there is no contact."""
    h = array.h
    x, y, ib = float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP)), iget(h, ip, g.KNB)
    detail = (
        f"blocks have gone into each other in cycle {int(h.ci[g.MCTOT])} of {h.cr[g.TDEL]:g} s, too fast for "
        f"a contact in time: block@{ib} with its corner at ({x:g}, {y:g})"
    )
    advice = "take a greater KN, lower velocities, a smaller FRACTION or a greater ROUND"
    return UdecError(OVERLAP_TOO_GREAT, detail, _what_to_do(h, advice), group=ip)


def _what_to_do(h: Memory, advice: str) -> str:
    """The advice on blocks that have gone into each other, but where masses are scaled."""
    if h.ci[g.LSCALE] == 0 or sinks_too_far(h):
        return advice
    return (
        "what falls with scaled masses goes by leaps: if the model collapses, CYCLE, or SOLVE with DAMPING "
        "LOCAL 0.8 and without STATIC or SCALED, shows it"
    )


def _too_deep(array: MainArray, group: int) -> UdecError:
    """Error 15: `group` is the corner or contact where blocks overlap too much, or was it."""
    h, cycle = array.h, int(array.h.ci[g.MCTOT])
    if iget(h, group, HEAD) == g.MCOR:
        return _without_contact(array, group)
    if iget(h, group, HEAD) != g.MCON:  # it vanished in a later pass of the same cycle
        return UdecError(OVERLAP_TOO_GREAT, f"in cycle {cycle}", "take a smaller FRACTION or a greater ROUND")
    m, overlap = material_of(h, group), getr(h, group, g.KCN)
    limit = f"{h.cr[g.DTOL2]:g}" if overlap > h.cr[g.DTOL2] else "the tip there is thick"
    detail = (
        f"contact@{group} of block@{iget(h, group, g.KB1)} and block@{iget(h, group, g.KB2)} at "
        f"({getr(h, group, g.KXC):g}, {getr(h, group, g.KYC):g}) overlaps by {overlap:g}, more than "
        f"{limit}, in cycle {cycle}"
    )
    advice = (
        f"KN of material {m} is {joints_of_materials(h, m).kn:g}, the time-step {h.cr[g.TDEL]:g} is "
        f"{share_of(h)}: a greater KN, a smaller FRACTION, less stiffness damping or a greater ROUND"
    )
    return UdecError(OVERLAP_TOO_GREAT, detail, _what_to_do(h, advice), group=group)


def raise_error(array: MainArray, laws: LawBook) -> None:
    """Find memory if that is what a kernel stopped for; else raise the error it left behind.

    An error of a cycle that needs memory, too, is raised when the cycle is complete, or if it cannot be.
    """
    h = array.h
    number = int(h.ci[g.NERR])
    if h.ci[g.JPHASE] == g.AT_WAYS:  # it waits for a pass that is compiled when a step needs it first
        return
    if number == OVERFLOW and h.ci[g.JPHASE] == g.AT_BLOCKS:
        h.ci[g.NERR] = h.ci[g.NWANT] = 0
        keep_spare(array)
        return
    if h.ci[g.NWANT] != 0:
        try:
            find_room(array)
            return
        except UdecError:
            if number == OVERFLOW:
                raise
    if number == 0:
        return
    group = int(h.ci[g.IERAD])
    h.ci[g.NERR] = h.ci[g.IERAD] = 0
    if number == INSIDE_OUT:
        raise UdecError(number, f"{_strained(h, group)} in cycle {int(h.ci[g.MCTOT])}", group=group)
    if number == TOO_SHORT:
        raise crowded(array, group, int(h.ci[g.MCTOT]))
    if number == LAW_FAILED:
        raise laws.failure(array, group)
    if number == TOO_FAR:
        raise _too_far(array, group)
    if number == OVERLAP_TOO_GREAT:
        raise _too_deep(array, group)
    named = f"{KINDS.get(iget(h, group, HEAD), '')}@{group} " if group else ""
    raise UdecError(number, f"{named}in cycle {int(h.ci[g.MCTOT])}", group=group)
