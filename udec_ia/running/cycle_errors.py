"""The errors that end a run, with the group and the place that they are about, and what to do."""

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
    UdecError,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of_materials, material_of
from udec_ia.kernels.drive.finite_check import not_finite
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.corner_rounding import crowded
from udec_ia.ops.common.array_growth import find_room, keep_spare
from udec_ia.ops.common.number_limits import last_digit
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.critical_step import fraction_in_words
from udec_ia.running.group_names import strained_name

NOT_FINITE = InterpretWhenSmall(not_finite, 2e3)
SPOILING = (TOO_SHORT, OVERLAP_TOO_GREAT, INSIDE_OUT, TOO_FAR, OUT_OF_NOWHERE)  # errors of impossible states
KINDS = {head.value: head.group for head in read_table().heads}


def raise_error(array: MainArray, laws: LawBook) -> None:
    """Find memory if that is what a kernel stopped for; else raise the error that it left.

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
        raise UdecError(number, f"{strained_name(h, group)} in cycle {int(h.ci[g.MCTOT])}", group=group)
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


def check_finite(array: MainArray) -> None:
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
    return UdecError(OVERLAP_TOO_GREAT, detail, advice + _unscaled(h), group=ip)


def _unscaled(h: Memory) -> str:
    """The advice to do without scaled masses, if they are."""
    if h.ci[g.LSCALE] == 0:
        return ""
    return (
        "; if the model collapses, CYCLE, or SOLVE with DAMPING LOCAL 0.8 and without STATIC or SCALED: "
        "positions change abruptly where blocks fall with scaled masses"
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
        f"{fraction_in_words(h)}: a greater KN, a smaller FRACTION, less stiffness damping or a greater ROUND"
    )
    return UdecError(OVERLAP_TOO_GREAT, detail, advice + _unscaled(h), group=group)
