"""ROUND: the rounding length and all tolerances that follow from it (report 4.4)."""

from __future__ import annotations

from udec_ia.errors import OVERLAP_TOO_GREAT, UdecError
from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.contact.map_changes import ALL, NONE_WAITING, change_map
from udec_ia.kernels.detect.contact_search import deep_overlap
from udec_ia.kernels.detect.large_domains import search_due_blocks
from udec_ia.kernels.detect.update import update_domains
from udec_ia.kernels.geometry.block_shape import span, zcs
from udec_ia.kernels.geometry.tolerances import default_rounding, edges, extent, set_rounding
from udec_ia.kernels.links.linked_lists import flag_all
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import all_or_nothing, find_room, keep_spare
from udec_ia.ops.common.number_limits import ROUNDING_DIGITS, check_resolution, positive
from udec_ia.reader.list_walks import chain

STIFFER = "use a larger rounding length, or stiffer joints"
Point = tuple[float, float]
STRAINED = "strained as it is after cycle"  # in the message of the error that ends a run


def too_short(d: float, shortest: float, x: float, y: float, when: str = "") -> UdecError:
    """Error 14: roundings of length `d` have to share the edge of length `shortest` that ends at (x, y)."""
    detail = f"{d:g}, but the edge that ends at ({x:g}, {y:g}) holds roundings of {shortest / 2:g}{when}"
    advice = "use at most half the shortest edge, or the shortest part of an edge beside a corner"
    return UdecError(14, detail, advice, parameter="d")


def check_rounding(d: float, shortest: float, x: float, y: float) -> None:
    """Error 14 if the shortest edge, which ends at (x, y), cannot hold the roundings of its two corners."""
    if 2 * d > shortest * (1 + 1e-6):
        raise too_short(d, shortest, x, y)


def check_all_edges(array: MainArray, d: float) -> None:
    """Error 14 if an edge of a block is too short for the rounding length `d`."""
    h = array.h
    if h.ci[g.IBPNT] != 0:
        _, shortest, ip = edges(h)
        check_rounding(d, float(shortest), float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP)))


def check_strained_edges(array: MainArray) -> None:
    """Error 14 if the roundings of an edge overlap by more than FTOL; less is allowed, as blocks deform."""
    h = array.h
    _, shortest, ip = edges(h)
    if 2 * h.cr[g.DTOL] - shortest > h.cr[g.FTOL]:
        raise crowded(array, int(ip))


def crowded(array: MainArray, ip: int, cycle: int = 0) -> UdecError:
    """Error 14: the roundings of the edge that ends at corner `ip` overlap too much, since that cycle."""
    h = array.h
    shortest = span(h, ip, zcs(h, ip)[0])
    when = f", {STRAINED} {cycle}" if cycle else ""
    return too_short(
        float(h.cr[g.DTOL]), float(shortest), float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP)), when
    )


def check_overlaps(array: MainArray, reach: float, advice: str) -> None:
    """Error 14 if two blocks overlap by more than contacts may after a change of their outlines.

    They may overlap at a contact, or by `reach` at most at a corner that did not touch its neighbour before.
    """
    h = array.h
    for ic in chain(h, int(h.ci[g.ICPNT]), g.KC):
        overlap = getr(h, ic, g.KCN)
        if overlap > h.cr[g.DTOL2] and iget(h, ic, g.KCCOD) != g.VIRTUAL:
            place = float(getr(h, ic, g.KXC)), float(getr(h, ic, g.KYC))
            raise _too_deep(h, iget(h, ic, g.KB1), iget(h, ic, g.KB2), overlap, place, advice)
    if h.ci[g.MCTOT] == 0:  # blocks that have not moved fit
        return
    ip, iq, overlap = deep_overlap(h, h.cr.dtype.type(reach))
    if ip != 0:
        place = float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP))
        raise _too_deep(h, iget(h, ip, g.KNB), iget(h, iq, g.KNB), overlap, place, advice)
    found = _found_without_contact(array)
    if found:
        detail = f"with {h.cr[g.DTOL]:g} {found} would lie inside another block without a contact"
        raise UdecError(14, detail, advice, parameter="d")


def _too_deep(h: Memory, ib: int, jb: int, overlap: float, place: Point, advice: str) -> UdecError:
    """Error 14: blocks `ib` and `jb` overlap too much at a place."""
    detail = (
        f"{h.cr[g.DTOL]:g} allows overlaps up to {h.cr[g.DTOL2]:g}, but block@{ib} and block@{jb} overlap by "
        f"{overlap:g} at ({place[0]:g}, {place[1]:g})"
    )
    return UdecError(14, detail, advice, parameter="d")


def refresh(array: MainArray) -> None:
    """Update contacts and domains for a changed rounding length."""
    change_map(array.h, NONE_WAITING, ALL, False)
    flag_all(array.h)
    bring_up(array)


def bring_up(array: MainArray) -> None:
    """Update every flagged domain, with more memory if needed. An error is left in NERR and IERAD."""
    array.h.ci[g.NERR] = array.h.ci[g.IERAD] = 0
    keep_spare(array)
    while not _update_map(array.h):
        find_room(array)


def _update_map(h: Memory) -> bool:
    """Update all flagged domains, and let blocks search large ones; False if memory ran out (cycle.py)."""
    while update_domains(h, 0):
        if not h.ci[g.NDUE]:
            return True
        if not search_due_blocks(h):
            return False
    return False


def update_flagged(array: MainArray) -> None:
    """Update every flagged domain. Error 15 if a block lies inside another one without a contact."""
    bring_up(array)
    found = _found_without_contact(array)
    if found:
        advice = "undo the change, or RESTART from a sound file"
        raise UdecError(OVERLAP_TOO_GREAT, f"{found} lies inside another block without a contact", advice)


def _found_without_contact(array: MainArray) -> str:
    """Name and place of a block inside another one without a contact, as found by updates; "" if none."""
    h = array.h
    if h.ci[g.NERR] != OVERLAP_TOO_GREAT or h.ci[g.MCTOT] == 0:  # blocks that have not moved fit
        return ""
    ip = int(h.ci[g.IERAD])
    x, y = float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP))
    return f"block@{iget(h, ip, g.KNB)} at ({x:g}, {y:g})"


def round_corners(array: MainArray, d: float) -> None:
    """ROUND d. Error 28 unless `d` is positive and the reals resolve it; error 14, and nothing is changed, if
    an edge is too short for it or if an overlap would be more than half of it.
    """
    positive(array, d=d)
    check_all_edges(array, d)
    check_resolution(array, "d", "a rounding length", d, ROUNDING_DIGITS, float(extent(array.h)))
    with all_or_nothing(array):
        h = array.h
        h.ci[g.LROUND] = 1
        hidden = 2.5 * float(h.cr[g.DTOL])  # the tips of two corners, each below DTOL, and DTOL2
        set_rounding(h, h.cr.dtype.type(d))
        refresh(array)
        check_overlaps(array, hidden, STIFFER)


def settle_default(array: MainArray) -> None:
    """Before the first cycle, without ROUND: use the default rounding length of the finished block system."""
    h = array.h
    if h.ci[g.LROUND] == 1 or h.ci[g.MCTOT] > 0:
        return
    d = default_rounding(h)
    if d != h.cr[g.DTOL]:
        with all_or_nothing(array):
            set_rounding(h, d)
            refresh(array)
