"""The calculation cycle (CYCLE; report 2.6): blocks, domains, contacts; between cycles, HISTORY and SOLVE.

JPHASE is the next pass. A cycle that stopped, because an update ran out of memory or a pass is not compiled
yet, continues at this point as if it had not stopped.

`soft` is None in a scene of rigid blocks only. numba then compiles nothing for deformable blocks, and the
scene tests nothing about them. A cycle calls long passes that are seldom needed by their address. They are
compiled when first needed, once for a word scheme, instead of in every kind of cycle. `passes` selects those
that a run needs.

The compiled loop of `run_with_records` runs from one recorded cycle to the next, writes the records into the
caller's arrays, and returns when these are full. Recorded cycles depend on the total number of cycles alone:
a history with KHN 10 is recorded after the cycles 10, 20, 30 ..., however the run is divided into commands.

To find contacts that open and close repeatedly, all contacts are examined every LOOK cycles. A mark is 1 if
its contact carried a force at the last examination, plus twice the number of changes since the beginning. Two
contacts are never so near to each other in IA() that they share a mark.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel, outlined
from udec_ia.compiling.kernel_memory import LEAD, fetch
from udec_ia.compiling.non_inlined_calls import call_entry, entry, entry_if
from udec_ia.errors import TOO_FAR
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, real
from udec_ia.heap.find_lose import room
from udec_ia.kernels.body.boundary_conditions import apply_boundary_conditions
from udec_ia.kernels.body.displacements import add_displacements
from udec_ia.kernels.body.fdef import move_fdef
from udec_ia.kernels.body.motion import motion
from udec_ia.kernels.body.sdef import move_sdef
from udec_ia.kernels.body.turned_blocks import any_turns, turn_blocks
from udec_ia.kernels.contact.edge_to_edge import average_ends, uses_ends
from udec_ia.kernels.contact.ford import ford_all
from udec_ia.kernels.contact.joint_lengths import update_joints
from udec_ia.kernels.contact.map_changes import NONE_WAITING, change_map
from udec_ia.kernels.crack.crack_pass import find_cracks
from udec_ia.kernels.detect.domain_pass import accumulate
from udec_ia.kernels.detect.large_domains import search_due_blocks, use_room
from udec_ia.kernels.detect.passage_through_block import detect_passages
from udec_ia.kernels.detect.update import updating
from udec_ia.kernels.drive.damped_forces import relax
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.drive.followed_functions import follow_functions
from udec_ia.kernels.drive.history_recording import NOT_MEASURED, measures, record
from udec_ia.kernels.drive.kinetic_damping import damp_by_motion
from udec_ia.kernels.drive.structure_pass import structure_pass
from udec_ia.kernels.drive.unbalanced_force import at_rest, at_rest_in_mean
from udec_ia.kernels.energy.work_account import (
    add_contact_work,
    add_load_work,
    add_rigid_work,
    add_work_after_motion,
    add_work_before_motion,
)
from udec_ia.kernels.geometry.block_shape import update_circles
from udec_ia.kernels.water.water_flow import water_pass
from udec_ia.layout import offsets as g

KEEP = 16  # cycles after which the circles of rigid blocks are recalculated
FINE = 1e-10  # reals in which 1 + FINE equals 1 need this


@inlined
def check_place(h: Memory, ib: int) -> None:
    """Error 36 if reals cannot resolve FTOL at the place of block `ib`, or if its place is not finite."""
    x, y, tolerance = abs(getr(h, ib, g.KX)), abs(getr(h, ib, g.KY)), h.cr[g.FTOL]
    if not (x + tolerance > x and y + tolerance > y) and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = TOO_FAR
        h.ci[g.IERAD] = ib


@kernel
def move_blocks(h: Memory, soft: Any, laws: Any) -> float:
    """Move every block; returns a bound on the velocity, in x or in y, of any point.

    Error 36 if a block is so far away that the precision is too low for contacts.
    """
    fastest = real(h, 0.0)
    narrow = real(h, 1.0) + real(h, FINE) == real(h, 1.0)
    keep = narrow and h.ci[g.MCTOT] % KEEP == 0
    large = h.ci[g.LLARGE]
    ib = h.ci[g.IBPNT]
    while ib != 0:
        fetch(h, ib, g.NVBL, LEAD)
        if soft is not None:
            kind = iget(h, ib, HEAD)
            if kind == g.MFDEF:
                speed = move_fdef(h, ib, laws)
            elif kind == g.MSDEF:
                speed = move_sdef(h, ib, laws)
            else:
                speed = motion(h, ib)
        else:
            speed = motion(h, ib)
        fastest = max(fastest, speed)
        if large != 0:
            use_room(h, ib, speed)
        if keep and iget(h, ib, HEAD) == g.MRIG and iget(h, ib, g.KBFIX) != g.FIXED:
            update_circles(h, ib)
        check_place(h, ib)
        ib = iget(h, ib, g.KB)
    return fastest


LOOK = 100  # cycles between two examinations
STRIDE = min(g.NVCN[:3])  # words of IA() that share a mark; after the three sizes there may be more


@outlined
def count_openings(h: Memory, marks: Any) -> bool:
    """Examine all contacts. marks: one byte for STRIDE words of IA(); none beyond its end."""
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        k = ic // STRIDE
        if k < len(marks):
            closed = 1 if getr(h, ic, g.KCFN) != 0 else 0
            if marks[k] % 2 != closed:
                marks[k] += 3 if closed == 1 else 1
        ic = iget(h, ic, g.KC)
    return True


UPDATE, TUNNELLING, FOLLOWERS, BOUNDARIES, TURNS, DAMPING, RELAX, WORK_BEFORE_MOTION, LOAD_WORK = range(9)
WORK_AFTER_MOTION, CONTACT_WORK, MAP_CHANGES, MEASURES, RECORD, REST, OPENINGS, JOINTS, ENDS = range(9, 18)
WATER, STRUCTURES, CRACKS, SEARCH, DISPLACEMENTS = range(18, 23)


def passes(
    h: Memory, soft: Any, recorded: tuple[Any, ...], ratio: float, mean: bool, marks: Any
) -> tuple[Any, ...]:
    """Addresses of passes in the order above, 0 for those that a run does not need; a tuple for MEASURES.

    soft: as in run_cycles. recorded: places, rows and count of `record`, () if nothing is recorded.
    ratio, marks: as in run_with_records. mean: the mean unbalanced force counts, not the greatest.
    A run of slow blocks does not need TUNNELLING, and one without large domains no SEARCH; a run that begins
    to need them stops before (lacks_pass).
    """
    keeps, loaded, mode = h.ci[g.LENER] != 0, h.ci[g.IBNPNT] != 0 or h.ci[g.IOUPNT] != 0, mode_of(h)
    asked = measures(h) if recorded else NOT_MEASURED
    none = h.cr.dtype.type(0)
    pair = none, none
    return (
        updating(h),
        entry_if(bool(h.ci[g.JPHASE] == g.AT_WAYS), detect_passages, h),
        entry(follow_functions, h) if h.ci[g.IFWPNT] != 0 else 0,
        entry(apply_boundary_conditions, h) if loaded else 0,
        entry(turn_blocks, h) if loaded and any_turns(h) else 0,
        entry(damp_by_motion, h) if mode and "motion" in mode.effects else 0,
        entry(relax, h) if (mode and "forces" in mode.effects) or h.ci[g.LSCALE] else 0,
        entry(add_rigid_work if soft is None else add_work_before_motion, h) if keeps else 0,
        entry(add_load_work, h) if keeps and loaded else 0,
        entry(add_work_after_motion, h) if keeps and soft is not None else 0,
        entry(add_contact_work, h, 0, False, none, pair, pair, pair, pair) if keeps else 0,
        entry(change_map, h, NONE_WAITING, 0, False),
        asked,
        entry(record, h, *recorded, asked) if recorded else 0,
        entry(at_rest_in_mean if mean else at_rest, h, ratio) if ratio >= 0 else 0,
        entry(count_openings, h, marks) if len(marks) else 0,
        entry(update_joints, h, False) if h.ci[g.LJOINT] else 0,
        entry(average_ends, h) if h.ci[g.LJOINT] and uses_ends(h) else 0,
        entry(water_pass, h) if h.ci[g.LWATER] else 0,
        entry(structure_pass, h) if h.ci[g.IBTPNT] or h.ci[g.INDPNT] else 0,
        entry(find_cracks, h) if h.ci[g.IBRPNT] else 0,
        entry_if(bool(h.ci[g.LLARGE]), search_due_blocks, h),
        entry(add_displacements, h) if h.ci[g.LDISP] else 0,
    )


def lacks_pass(h: Memory, passes: Any) -> bool:
    """True if a run has stopped before a pass that it did not need until now."""
    is_lost = h.ci[g.JPHASE] == g.AT_WAYS and passes[TUNNELLING] == 0
    return bool(is_lost or (h.ci[g.LLARGE] != 0 and passes[SEARCH] == 0))


CONTACTS = 1000  # for each of which the check of a safe time-step may wait a cycle


@kernel
def step_check_is_due(h: Memory) -> bool:
    """True if the time-step may be too long: contacts made since a SAFE one was found, or stiffer joints.

    In a large model the check waits for a cycle whose number is a multiple of its thousands of contacts. If
    masses are scaled new contacts do not change the step.
    """
    is_unaffected = h.ci[g.LSAFE] == 0 or h.ci[g.LSCALE] != 0 or h.ci[g.NMADE] == h.ci[g.MSCALE]
    if is_unaffected and h.ci[g.LSTIFF] == 0:
        return False
    return bool(h.ci[g.MCTOT] % (1 + h.ci[g.NCON] // CONTACTS) == 0)


@kernel
def change_is_due(h: Memory) -> bool:
    """True if blocks are to crack, or the time-step is to be checked, before the next cycle."""
    return h.ci[g.LCRACK] != 0 or step_check_is_due(h)


@inlined
def before_motion(h: Memory, passes: Any) -> None:
    """The passes before blocks move: conditions, damping, and the work of the present forces."""
    if passes[FOLLOWERS] != 0:
        call_entry(passes[FOLLOWERS], h)
    if passes[BOUNDARIES] != 0:
        call_entry(passes[BOUNDARIES], h)
    if passes[TURNS] != 0:
        call_entry(passes[TURNS], h)
    if passes[DAMPING] != 0:
        call_entry(passes[DAMPING], h)
    if passes[RELAX] != 0:
        call_entry(passes[RELAX], h)
    if passes[WORK_BEFORE_MOTION] != 0:
        call_entry(passes[WORK_BEFORE_MOTION], h)
    if passes[LOAD_WORK] != 0:
        call_entry(passes[LOAD_WORK], h)


@inlined
def update_map(h: Memory, passes: Any) -> bool:
    """Update the domains that need it, and let blocks search large ones; False if that is to be continued."""
    while call_entry(passes[UPDATE], h, int64(0)):
        if h.ci[g.NDUE] == 0:
            return True
        if passes[SEARCH] == 0 or not call_entry(passes[SEARCH], h):
            return False
    return False


@kernel
def run_cycles(h: Memory, n: int, soft: Any, laws: Any, joints: Any, passes: Any) -> int:
    """Up to `n` cycles; returns how many were completed. Stops early when NERR is set.

    soft: None if all blocks are rigid, else True. laws: of blocks, None if `soft` is. joints: None if no
    contact has a law of its own, else these laws (compiling.law_calls). passes: see `passes`. Also stops
    early when blocks are to crack or the time-step must be checked.
    """
    waiting = np.empty(h.ci[g.NCON], np.int64)
    done = 0
    while done < n:
        if h.ci[g.JPHASE] == g.AT_BLOCKS:
            if h.ci[g.NSPARE] > 0 and not room(h, h.ci[g.NSPARE]):
                return done  # IA() grows between two cycles, where this changes no result
            before_motion(h, passes)
            fastest = move_blocks(h, soft, laws)
            if passes[WORK_AFTER_MOTION] != 0:
                call_entry(passes[WORK_AFTER_MOTION], h)
            if passes[DISPLACEMENTS] != 0:
                call_entry(passes[DISPLACEMENTS], h)
            h.ci[g.JPHASE] = accumulate(h, fastest, soft)
        if h.ci[g.JPHASE] == g.AT_WAYS:
            if passes[TUNNELLING] == 0:
                return done  # compiled only when a step needs it
            call_entry(passes[TUNNELLING], h)
            h.ci[g.JPHASE] = g.AT_DOMAINS
        if h.ci[g.JPHASE] == g.AT_DOMAINS:
            if not update_map(h, passes):
                return done
            h.ci[g.JPHASE] = g.AT_CONTACTS
        if h.ci[g.JPHASE] == g.AT_CONTACTS:
            if passes[JOINTS] != 0 and not call_entry(passes[JOINTS], h, False):
                return done
            broken = h.ci[g.NBROKE]
            if len(waiting) < h.ci[g.NCON]:
                waiting = np.empty(2 * h.ci[g.NCON], np.int64)
            ford_all(h, soft, joints, passes[MAP_CHANGES], passes[CONTACT_WORK], waiting)
            if passes[ENDS] != 0:
                call_entry(passes[ENDS], h)
            h.ci[g.JPHASE] = g.AT_BLOCKS if h.ci[g.NBROKE] == broken else g.AT_BROKEN
        if h.ci[g.JPHASE] == g.AT_BROKEN:  # domains that merged are updated at once
            if not update_map(h, passes):
                return done
            h.ci[g.JPHASE] = g.AT_BLOCKS
        if passes[WATER] != 0:
            call_entry(passes[WATER], h)
        if passes[STRUCTURES] != 0:
            call_entry(passes[STRUCTURES], h)
        if passes[CRACKS] != 0:
            call_entry(passes[CRACKS], h)
        h.ci[g.MCTOT] += 1
        h.cd[g.TIME] += h.cr[g.TDEL]
        done += 1
        if h.ci[g.NERR] != 0 or change_is_due(h):
            return done
    return done


CHECK = 10  # cycles between two checks of the force ratio


@kernel
def cycles_until_record(h: Memory, limit: int) -> int:
    """Cycles until the next history is due, or `limit` if that comes first."""
    cycles = int64(limit)
    ih = int64(h.ci[g.IHPNT])
    while ih != 0:
        every = iget(h, ih, g.KHN)
        cycles = min(cycles, every - h.ci[g.MCTOT] % every)
        ih = iget(h, ih, g.KH)
    return cycles


@kernel
def run_with_records(
    h: Memory, n: int, laws: Any, ratio: float, places: Any, rows: Any, count: Any, marks: Any, passes: Any
) -> tuple[int, bool]:
    """Up to `n` cycles; returns how many were completed, and whether the model is at rest to within `ratio`.

    laws: three arguments of run_cycles. passes: see `passes`. places: without rows if nothing is recorded.
    marks: see above; empty if they are not used. Stops early when NERR is set, when `rows` is full, before a
    crack, when the time-step must be checked, and at rest. Rest is tested every CHECK cycles of the run; not
    at all if the ratio is negative.
    """
    recorded = len(places) > 0
    done = 0
    while done < n and count[0] < len(rows):
        ahead = min(int64(n - done), CHECK - h.ci[g.MCTOT] % CHECK) if ratio >= 0 else int64(n - done)
        if len(marks) > 0:
            ahead = min(ahead, int64(LOOK - h.ci[g.MCTOT] % LOOK))
        before = h.ci[g.MCTOT]
        asked = cycles_until_record(h, ahead) if recorded else ahead
        completed = run_cycles(h, asked, laws[0], laws[1], laws[2], passes)
        done += completed
        if recorded and h.ci[g.MCTOT] > before:
            call_entry(passes[RECORD], h, places, rows, count, passes[MEASURES])
        if len(marks) > 0 and h.ci[g.MCTOT] > before and h.ci[g.MCTOT] % LOOK == 0:
            call_entry(passes[OPENINGS], h, marks)
        if completed < asked or h.ci[g.NERR] != 0:
            return done, False
        if ratio >= 0 and h.ci[g.MCTOT] % CHECK == 0 and call_entry(passes[REST], h, ratio):
            return done, True
        if change_is_due(h):
            return done, False
    return done, False
