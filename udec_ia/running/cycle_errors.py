"""The errors that end a run, each with its group, its place and a remedy."""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.errors import (
    INSIDE_OUT,
    LAW_FAILED,
    OUT_OF_NOWHERE,
    OVERFLOW,
    OVERLAP_TOO_GREAT,
    TOO_FAR,
    TOO_SHORT,
    TOO_STIFF,
    UdecError,
)
from udec_ia.heap.accessors import HEAD, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials, material_of
from udec_ia.kernels.drive.finite_check import first_not_finite
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.corner_rounding import crowded
from udec_ia.ops.common.array_growth import find_room, keep_spare
from udec_ia.ops.common.number_limits import last_digit
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.critical_step import fraction_in_words
from udec_ia.running.group_names import contact_name, strained_name

NOT_FINITE = InterpretWhenSmall(first_not_finite, 2e3)
SPOILING = (
    TOO_SHORT,
    OVERLAP_TOO_GREAT,
    INSIDE_OUT,
    TOO_FAR,
    OUT_OF_NOWHERE,
    TOO_STIFF,
)  # the state is impossible
KINDS = {head.value: head.group for head in read_table().heads}


def raise_error(array: MainArray, laws: LawBook) -> None:
    """Raise the error that a kernel has left in NERR, or find the memory for which it stopped.

    If a cycle needs memory and has an error, the error is raised after the cycle is complete, or if there is
    no memory.
    """
    h = array.h
    number = int(h.ci[g.NERR])
    if h.ci[g.JPHASE] == g.AT_WAYS:  # it stopped for a pass that must be compiled first
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
        raise UdecError(number, f"{strained_name(h, group)} in cycle {int(h.ci[g.MCTOT])}", group=group)
    if number == TOO_SHORT:
        raise crowded(array, group, int(h.ci[g.MCTOT]))
    if number == LAW_FAILED:
        raise laws.failure(array, group)
    if number == TOO_FAR:
        raise _too_far(array, group)
    if number == OVERLAP_TOO_GREAT:
        raise _too_deep(array, group)
    if number == TOO_STIFF:
        raise UdecError(number, f"{contact_name(h, group)} in cycle {int(h.ci[g.MCTOT])}", group=group)
    named = f"{KINDS.get(iget(h, group, HEAD), '')}@{group} " if group else ""
    raise UdecError(number, f"{named}in cycle {int(h.ci[g.MCTOT])}", group=group)


def check_finite(array: MainArray) -> None:
    """Error 36 if a force, a velocity, a stress or an energy is not finite at the end of a run."""
    h, group = array.h, int(NOT_FINITE(int(array.h.ci[g.NBLK]), array.h))
    if group != 0:
        kind, *here = ("contact", g.KXC, g.KYC) if iget(h, group, HEAD) == g.MCON else ("block", g.KX, g.KY)
        x, y = (float(getr(h, group, k)) for k in here)
        what = f"a force, a velocity or a stress of {kind}@{group} at ({x:g}, {y:g}) is"
    elif not (np.isfinite(h.cr).all() and np.isfinite(h.cd).all()):
        what = "an energy or a displacement of the whole run is"
    else:
        return
    largest = float(np.finfo(array.scheme.real_type).max)
    detail = f"{what} greater than {array.scheme.real_bits}-bit reals can hold, {largest:.2g}, in cycle "
    raise UdecError(TOO_FAR, f"{detail}{int(h.ci[g.MCTOT])}", group=group)


def _too_far(array: MainArray, ib: int) -> UdecError:
    """Error 36: the reals are too coarse for contacts at the place of block `ib`."""
    h, bits = array.h, array.scheme.real_bits
    x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
    detail = (
        f"block@{ib} has come to ({x:g}, {y:g}) in cycle {int(h.ci[g.MCTOT])}, where {bits}-bit reals "
        f"resolve {last_digit(array, max(abs(x), abs(y))):g}, and the rounding length is {h.cr[g.DTOL]:g}"
    )
    return UdecError(TOO_FAR, detail, group=ib)


def _too_deep(array: MainArray, group: int) -> UdecError:
    """Error 15: blocks overlap too much at corner or contact `group`."""
    h, cycle = array.h, int(array.h.ci[g.MCTOT])
    if iget(h, group, HEAD) == g.MCOR:  # there is no contact
        x, y, ib = float(getr(h, group, g.KXP)), float(getr(h, group, g.KYP)), iget(h, group, g.KNB)
        detail = (
            f"blocks penetrate each other in cycle {cycle} of {h.cr[g.TDEL]:g} s, too fast for a "
            f"contact in time: block@{ib} with its corner at ({x:g}, {y:g})"
        )
        advice = "take a greater KN, lower velocities, a smaller FRACTION or a greater ROUND"
    elif iget(h, group, HEAD) == g.MCON:
        m, overlap = material_of(h, group), getr(h, group, g.KCN)
        limit = f"{h.cr[g.DTOL2]:g}" if overlap > h.cr[g.DTOL2] else "the tip there is thick"
        detail = f"{contact_name(h, group)} overlaps by {overlap:g}, more than {limit}, in cycle {cycle}"
        advice = (
            f"KN of material {m} is {joints_of_materials(h, m).kn:g}, the time-step {h.cr[g.TDEL]:g} is "
            f"{fraction_in_words(h)}: a greater KN or ROUND, a smaller FRACTION or less stiffness damping"
        )
    else:  # the contact has gone in a later pass of the same cycle
        return UdecError(OVERLAP_TOO_GREAT, f"in cycle {cycle}", "take a smaller FRACTION or a greater ROUND")
    if h.ci[g.LSCALE]:
        advice += (
            "; if the model collapses, CYCLE, or SOLVE with DAMPING LOCAL 0.8 and without STATIC or SCALED: "
            "positions change abruptly where blocks fall with scaled masses"
        )
    return UdecError(OVERLAP_TOO_GREAT, detail, advice, group=group)
