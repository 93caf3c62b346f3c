"""Distribution of the boundary conditions and the groups of a block that SPLIT cuts to its two parts.

Both parts belong to the groups of the block. Conditions at a centroid go to both parts: velocities unchanged,
loads by area. A load on an edge is two conditions, one at each end, next to each other in the list, the end
of the edge first. Those of an edge that is cut become four: its traction, linear from end to end, is
distributed to the two new edges.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, Offset, getr, iget, puti, putr, real
from udec_ia.heap.find_lose import find_copy
from udec_ia.kernels.geometry.block_shape import geo
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.layout import offsets as g

LOADS = (g.KUFX, g.KUFY, g.KUCXX, g.KUCXY, g.KUCYY)


@kernel
def off_grid(h: Memory) -> int:
    """Number of conditions that do not act on grid-points; a cut makes no more than as many new ones."""
    n = 0
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        n += iget(h, iu, g.KUG) == 0
        iu = iget(h, iu, g.KU)
    return n


@kernel
def on_grid(h: Memory) -> int:
    """Number of conditions on grid-points."""
    n = 0
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        n += iget(h, iu, g.KUG) != 0
        iu = iget(h, iu, g.KU)
    return n


@kernel
def share_bounds(h: Memory, ib: int, jb: int) -> None:
    """Share the conditions on block `ib` with block `jb`, which has been cut from it."""
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        following = iget(h, iu, g.KU)
        if iget(h, iu, g.KUG) != 0:
            pass  # share_zones
        elif iget(h, iu, g.KUB) == ib and iget(h, iu, g.KUP) == 0:
            _share_block(h, iu, jb)
        elif iget(h, iu, g.KUB) == ib and following != 0 and _are_ends(h, iu, following):
            ju = following
            following = iget(h, ju, g.KU)
            _share_edge(h, iu, ju)
        elif iget(h, iu, g.KUB) == ib:  # BOUNDARY ... FREE has removed that of the other end
            puti(h, iu, g.KUB, iget(h, iget(h, iu, g.KUP), g.KNB))
            puti(h, iu, g.KUQ, 0)
        iu = following


@kernel
def count_list(h: Memory, first: int, knext: Offset) -> int:
    """Number of groups in the list that starts at `first` and is linked by `knext`."""
    n = 0
    iad = first
    while iad != 0:
        n += 1
        iad = iget(h, iad, knext)
    return n


@kernel
def copy_after(h: Memory, iad: int, nv: Offset, knext: Offset) -> int:
    """A copy of the group of the size `nv` at `iad`, after it in the list linked by `knext`."""
    copy = find_copy(h, iad, nv)
    puti(h, iad, knext, copy)
    return copy


@kernel
def share_groups(h: Memory, ib: int, jb: int) -> None:
    """Block `jb`, which has been cut from block `ib`, belongs to the groups of that."""
    im = h.ci[g.IMBPNT]
    while im != 0:
        following = iget(h, im, g.KI)
        if iget(h, im, g.KIB) == ib:
            puti(h, copy_after(h, im, g.NVMB, g.KI), g.KIB, jb)
        im = following


@kernel
def share_strength(h: Memory, ib: int, jb: int) -> None:
    """Block `jb`, which has been cut from block `ib`, is as breakable as that."""
    ik = h.ci[g.IBRPNT]
    while ik != 0 and iget(h, ik, g.KBKB) != ib:
        ik = iget(h, ik, g.KBKN)
    if ik != 0:
        puti(h, copy_after(h, ik, g.NVBK, g.KBKN), g.KBKB, jb)


@kernel
def _share_block(h: Memory, iu: int, jb: int) -> None:
    """Replace condition `iu` on a block by one on each of the two parts."""
    area, other = geo(h, iget(h, iu, g.KUB))[0], geo(h, jb)[0]
    ju = copy_after(h, iu, g.NVBN, g.KU)
    puti(h, ju, g.KUB, jb)
    for k, part in ((iu, area / (area + other)), (ju, other / (area + other))):
        putr(h, k, g.KUFX, getr(h, k, g.KUFX) * part)
        putr(h, k, g.KUFY, getr(h, k, g.KUFY) * part)


@kernel
def _are_ends(h: Memory, iu: int, ju: int) -> bool:
    """True if the conditions `iu` and `ju` are those of both ends of one edge."""
    same = iget(h, ju, g.KUB) == iget(h, iu, g.KUB) and iget(h, ju, g.KUS) == iget(h, iu, g.KUS)
    return same and iget(h, ju, g.KUP) == iget(h, iu, g.KUQ) and iget(h, ju, g.KUQ) == iget(h, iu, g.KUP)


@kernel
def _put_on_edge(h: Memory, iu: int, ip: int, iq: int) -> None:
    """Move condition `iu` to corner `ip`, for the edge whose other end is corner `iq`."""
    puti(h, iu, g.KUB, iget(h, ip, g.KNB))
    puti(h, iu, g.KUP, ip)
    puti(h, iu, g.KUQ, iq)


@kernel
def _length(h: Memory, ip: int, iq: int) -> float:
    """Distance of two corners."""
    dx, dy = getr(h, ip, g.KXP) - getr(h, iq, g.KXP), getr(h, ip, g.KYP) - getr(h, iq, g.KYP)
    return np.sqrt(dx * dx + dy * dy)


@kernel
def _share_edge(h: Memory, iu: int, ju: int) -> None:
    """Distribute the load of an edge, `iu` at its end and `ju` at its start, to its parts.

    A corner that the cut goes through has a twin in the same place, and either may be an end of the edge now.
    """
    ip, iq = iget(h, iu, g.KUP), iget(h, ju, g.KUP)
    start, end = iget(h, ip, g.KR), next_corner(h, iget(h, iq, g.KNB), iq)
    if _length(h, end, ip) == 0:
        ip, start = end, iq
    elif _length(h, start, iq) == 0:
        iq, end = start, ip
    else:
        _share_traction(h, iu, ju, _length(h, ip, start), _length(h, iq, end))
        _put_on_edge(h, iget(h, iu, g.KU), start, ip)
        _put_on_edge(h, iget(h, iget(h, iu, g.KU), g.KU), end, iq)
    _put_on_edge(h, iu, ip, start)
    _put_on_edge(h, ju, iq, end)


@kernel
def _share_traction(h: Memory, iu: int, ju: int, z1: float, z2: float) -> None:
    """Two conditions between `iu` and `ju`, of an edge that is cut `z1` from its end and `z2` from its start.

    The traction t is linear: the ends of a length z get z (2 t + t') / 6 and z (t + 2 t') / 6.
    """
    one, two = z1 / (z1 + z2), z2 / (z1 + z2)
    near_end = copy_after(h, iu, g.NVBN, g.KU)
    near_start = copy_after(h, near_end, g.NVBN, g.KU)
    third = real(h, 1.0) / real(h, 3.0)
    for i in range(len(LOADS)):
        end, start = getr(h, iu, LOADS[i]), getr(h, ju, LOADS[i])
        t, u = end + end - start, start + start - end  # tractions there, times half the length
        v = t + (u - t) * one  # and where it is cut
        putr(h, iu, LOADS[i], one * (t + t + v) * third)
        putr(h, near_end, LOADS[i], one * (t + v + v) * third)
        putr(h, near_start, LOADS[i], two * (u + v + v) * third)
        putr(h, ju, LOADS[i], two * (u + u + v) * third)
