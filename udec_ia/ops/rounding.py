"""ROUND: the rounding length, and with it all tolerances (report 4.4)."""

from __future__ import annotations

from offsets.generated import DTOL, IBPNT, KXP, KYP, LROUND, MCTOT
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr
from udec_ia.heap.array import MainArray
from udec_ia.kernels.bridge import flag_all
from udec_ia.kernels.ford import settle_all
from udec_ia.kernels.tolerances import default_rounding, edges, set_rounding
from udec_ia.kernels.update import update_all
from udec_ia.ops.limits import finite
from udec_ia.ops.memory import find_room, keep_spare


def check_rounding(d: float, least: float, x: float, y: float) -> None:
    """Error 14 if the shortest edge, which ends at (x, y), cannot hold the roundings of its two corners."""
    if 2 * d > least * (1 + 1e-6):
        raise UdecError(
            14,
            f"{d:g}, but the edge that ends at ({x:g}, {y:g}) is only {least:g} long",
            f"the rounding length must not exceed half the shortest edge, {least / 2:g}",
        )


def check_all_edges(array: MainArray, d: float) -> None:
    """Error 14 if an edge of a block is too short for the rounding length `d`."""
    h = array.h
    if h.ci[IBPNT] != 0:
        _, least, ip = edges(h)
        check_rounding(d, float(least), float(getr(h, ip, KXP)), float(getr(h, ip, KYP)))


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
    """ROUND d. Error 28 if `d` is not positive, error 14 if an edge is too short for it."""
    finite(d)
    if d <= 0:
        raise UdecError(28, f"the rounding length must be positive, it is {d:g}")
    check_all_edges(array, d)
    h = array.h
    h.ci[LROUND] = 1
    set_rounding(h, h.cr.dtype.type(d))
    refresh(array)


def settle_default(array: MainArray) -> None:
    """Before the first cycle: without ROUND, take our own rounding length for the finished block system."""
    h = array.h
    if h.ci[LROUND] == 1 or h.ci[MCTOT] > 0:
        return
    d = default_rounding(h)
    if d != h.cr[DTOL]:
        set_rounding(h, d)
        refresh(array)
