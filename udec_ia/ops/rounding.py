"""ROUND: the rounding length, and with it all tolerances (report 4.4)."""

from __future__ import annotations

from offsets.generated import (
    DTOL,
    DTOL2,
    FTOL,
    IBPNT,
    ICPNT,
    KB1,
    KB2,
    KC,
    KCCOD,
    KCN,
    KXC,
    KXP,
    KYC,
    KYP,
    LROUND,
    MCTOT,
)
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget
from udec_ia.heap.array import MainArray
from udec_ia.kernels.bridge import flag_all
from udec_ia.kernels.ford import settle_all
from udec_ia.kernels.shape import span, zcs
from udec_ia.kernels.tolerances import default_rounding, edges, extent, set_rounding
from udec_ia.kernels.touch import VIRTUAL
from udec_ia.kernels.update import update_all
from udec_ia.ops.limits import ROUNDING_DIGITS, check_resolution, positive
from udec_ia.ops.memory import all_or_nothing, find_room, keep_spare

STRAINED = "strained as it is after cycle"  # in the message of the error that ends a run


def too_short(d: float, least: float, x: float, y: float, when: str = "") -> UdecError:
    """Error 14: roundings of length `d` have to share `least` on the edge that ends at (x, y)."""
    return UdecError(
        14,
        f"{d:g}, but the edge that ends at ({x:g}, {y:g}) holds roundings of {least / 2:g} at most{when}",
        "the rounding length must not exceed half the shortest edge, nor the shortest part of an edge that "
        "GENERATE has put between a corner and a point",
        parameter="d",
    )


def check_rounding(d: float, least: float, x: float, y: float) -> None:
    """Error 14 if the shortest edge, which ends at (x, y), cannot hold the roundings of its two corners."""
    if 2 * d > least * (1 + 1e-6):
        raise too_short(d, least, x, y)


def check_all_edges(array: MainArray, d: float) -> None:
    """Error 14 if an edge of a block is too short for the rounding length `d`."""
    h = array.h
    if h.ci[IBPNT] != 0:
        _, least, ip = edges(h)
        check_rounding(d, float(least), float(getr(h, ip, KXP)), float(getr(h, ip, KYP)))


def check_strained_edges(array: MainArray) -> None:
    """Error 14 if on an edge the roundings overlap by more than FTOL; by less they may, for blocks deform."""
    h = array.h
    _, least, ip = edges(h)
    if 2 * h.cr[DTOL] - least > h.cr[FTOL]:
        raise crowded(array, int(ip))


def crowded(array: MainArray, ip: int, cycle: int = 0) -> UdecError:
    """Error 14: the roundings of the edge that ends at corner `ip` overlap by too much, since that cycle."""
    h = array.h
    least = span(h, ip, zcs(h, ip)[0])
    when = f", {STRAINED} {cycle}" if cycle else ""
    return too_short(float(h.cr[DTOL]), float(least), float(getr(h, ip, KXP)), float(getr(h, ip, KYP)), when)


def check_overlaps(array: MainArray) -> None:
    """Error 14 if two blocks overlap by more than the rounding length, just set, allows."""
    h = array.h
    ic = int(h.ci[ICPNT])
    while ic != 0:
        overlap = getr(h, ic, KCN)
        if overlap > h.cr[DTOL2] and iget(h, ic, KCCOD) != VIRTUAL:
            place = f"at ({getr(h, ic, KXC):g}, {getr(h, ic, KYC):g})"
            detail = (
                f"{h.cr[DTOL]:g} allows overlaps up to {h.cr[DTOL2]:g}, but block@{iget(h, ic, KB1)} and "
                f"block@{iget(h, ic, KB2)} overlap by {overlap:g} {place}"
            )
            raise UdecError(14, detail, "give a greater rounding length, or stiffer joints", parameter="d")
        ic = iget(h, ic, KC)


def refresh(array: MainArray) -> None:
    """Bring all contacts and domains up to date with a changed rounding length."""
    settle_all(array.h)
    flag_all(array.h)
    update_flagged(array)


def update_flagged(array: MainArray) -> None:
    """Update every flagged domain, finding memory as needed."""
    keep_spare(array)
    while not update_all(array.h):
        find_room(array)


def round_corners(array: MainArray, d: float) -> None:
    """ROUND d. Error 28 unless `d` is positive and the reals resolve it; error 14, and nothing is changed, if
    an edge is too short for it or if an overlap would be more than half of it.
    """
    positive(array, d=d)
    check_all_edges(array, d)
    check_resolution(array, "d", "a rounding length", d, ROUNDING_DIGITS, float(extent(array.h)))
    with all_or_nothing(array):
        h = array.h
        h.ci[LROUND] = 1
        set_rounding(h, h.cr.dtype.type(d))
        refresh(array)
        check_overlaps(array)


def settle_default(array: MainArray) -> None:
    """Before the first cycle: without ROUND, take our own rounding length for the finished block system."""
    h = array.h
    if h.ci[LROUND] == 1 or h.ci[MCTOT] > 0:
        return
    d = default_rounding(h)
    if d != h.cr[DTOL]:
        with all_or_nothing(array):
            set_rounding(h, d)
            refresh(array)
