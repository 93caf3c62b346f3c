"""Distribution of zones and grid-points when a fully-deformable block is cut along zone sides.

The crack runs from grid-point to grid-point. Each zone goes to the part in which it lies, with its stress.
The grid-points of the crack double: each copy has the place and velocity of the old one and a third of the
mass of each zone that it has on its side. So stress, mass, linear and angular momentum and kinetic energy
stay. The copies at the ends are corners now, also where one was a point of an edge (KGEDGE).

Conditions at a grid-point that doubles go to both copies: velocities unchanged, loads by mass. So do the sums
of reactions to which it belongs.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64, puti, putr, real
from udec_ia.heap.find_lose import find
from udec_ia.kernels.body.displacements import put_mean_displacement
from udec_ia.kernels.body.fdef import pvelfd, reset_point_forces, sum_over_points
from udec_ia.kernels.geometry.block_shape import is_corner_turn, zcs
from udec_ia.kernels.geometry.point_distance import distance_outside
from udec_ia.kernels.links.linked_lists import next_corner
from udec_ia.kernels.links.longer_groups import find_gridpoint_copy
from udec_ia.kernels.split.split_conditions import LOADS, copy_after
from udec_ia.layout import offsets as g


@kernel
def _middle(h: Memory, iz: int) -> tuple[float, float]:
    """Centroid of zone `iz`."""
    x, y, third = real(h, 0.0), real(h, 0.0), real(h, 1.0) / real(h, 3.0)
    for k in range(3):
        ig = iget(h, iz, g.KZG, k)
        x += getr(h, ig, g.KXG) * third
        y += getr(h, ig, g.KYG) * third
    return x, y


@kernel
def _share_zones(h: Memory, ie: int, je: int, jb: int) -> None:
    """Move the zones of extension `ie` that lie in block `jb` to its extension `je`, in their order."""
    iz = iget(h, ie, g.KFZ)
    last, last_moved = int64(0), int64(0)
    puti(h, ie, g.KFNZ, 0)
    while iz != 0:
        following = iget(h, iz, g.KZ)
        x, y = _middle(h, iz)
        moves = distance_outside(h, jb, np.float64(x), np.float64(y)) == 0
        one, before = (je, last_moved) if moves else (ie, last)
        if before == 0:
            puti(h, one, g.KFZ, iz)
        else:
            puti(h, before, g.KZ, iz)
        puti(h, iz, g.KZ, 0)
        puti(h, one, g.KFNZ, iget(h, one, g.KFNZ) + 1)
        if moves:
            last_moved = iz
        else:
            last = iz
        iz = following


@kernel
def _add_masses(h: Memory, ie: int, field: Offset) -> None:
    """Add a third of the mass of each zone of extension `ie` to a field of its grid-points."""
    third = real(h, 1.0) / real(h, 3.0)
    iz = iget(h, ie, g.KFZ)
    while iz != 0:
        part = getr(h, iz, g.KZM) * third
        for k in range(3):
            ig = iget(h, iz, g.KZG, k)
            putr(h, ig, field, getr(h, ig, field) + part)
        iz = iget(h, iz, g.KZ)


@kernel
def _corner_at(h: Memory, ib: int, ig: int) -> int:
    """The corner of block `ib` at the place of grid-point `ig`."""
    ip = iget(h, ib, g.KP)
    while getr(h, ip, g.KXP) != getr(h, ig, g.KXG) or getr(h, ip, g.KYP) != getr(h, ig, g.KYG):
        ip = iget(h, ip, g.KR)
    return ip


@kernel
def _tie(h: Memory, ib: int, ig: int) -> None:
    """Tie grid-point `ig` on the crack to the corner of block `ib` there.

    Where the crack goes straight on, the corner is a point of an edge, as those of GENERATE are.
    """
    ip = _corner_at(h, ib, ig)
    z1, c1, s1 = zcs(h, ip)
    z2, c2, s2 = zcs(h, next_corner(h, ib, ip))
    bends = iget(h, ig, g.KCOR) != 0 or is_corner_turn(h, z1, c1, s1, z2, c2, s2, False)
    puti(h, ip, g.KGP, ig)
    puti(h, ig, g.KCOR, ip)
    puti(h, ig, g.KGEDGE, 0 if bends else 1)


@kernel
def _double(h: Memory, ig: int, ib: int, je: int, jb: int) -> int:
    """Make the copy of grid-point `ig` of block `ib` for block `jb` with extension `je`; returns it."""
    jg = find_gridpoint_copy(h, ig)
    putr(h, jg, g.KGPM, getr(h, ig, g.KGFX))
    iz = iget(h, je, g.KFZ)
    while iz != 0:
        for k in range(3):
            if iget(h, iz, g.KZG, k) == ig:
                puti(h, iz, g.KZG, jg, k)
        iz = iget(h, iz, g.KZ)
    _tie(h, ib, ig)
    _tie(h, jb, jg)
    return jg


@kernel
def _share_conditions(h: Memory, ig: int, jb: int, jg: int) -> None:
    """Conditions at grid-point `ig` go to block `jb`, or by mass to its copy `jg` too, if that is another."""
    iu = h.ci[g.IBNPNT]
    while iu != 0:
        following = iget(h, iu, g.KU)
        if iget(h, iu, g.KUG) == ig and jg == ig:
            puti(h, iu, g.KUB, jb)
        elif iget(h, iu, g.KUG) == ig:
            ju = copy_after(h, iu, g.NVBN, g.KU)
            part = getr(h, ig, g.KGPM) / (getr(h, ig, g.KGPM) + getr(h, jg, g.KGPM))
            puti(h, ju, g.KUB, jb)
            puti(h, ju, g.KUG, jg)
            for i in range(len(LOADS)):
                load = getr(h, iu, LOADS[i])
                putr(h, iu, LOADS[i], load * part)
                putr(h, ju, LOADS[i], load * (real(h, 1.0) - part))
        iu = following
    iq = h.ci[g.ISMPNT]
    while iq != 0:
        following = iget(h, iq, g.KQ)
        if iget(h, iq, g.KQG) == ig:
            if jg != ig:
                iq = copy_after(h, iq, g.NVSM, g.KQ)
                puti(h, iq, g.KQG, jg)
            puti(h, iq, g.KQB, jb)
        iq = following


@kernel
def _append(h: Memory, ie: int, last: int, ig: int) -> None:
    """Put grid-point `ig` at the end of the list of extension `ie`, whose last one is `last`; 0 for none."""
    if last == 0:
        puti(h, ie, g.KFG, ig)
    else:
        puti(h, last, g.KG, ig)
    puti(h, ig, g.KG, 0)
    puti(h, ie, g.KFNG, iget(h, ie, g.KFNG) + 1)


@kernel
def _share_points(h: Memory, ib: int, jb: int, ie: int, je: int) -> None:
    """Distribute the grid-points of block `ib`; KGPM has their mass in it, KGFX that in block `jb`."""
    zero = real(h, 0.0)
    ig = iget(h, ie, g.KFG)
    last, last_moved = int64(0), int64(0)
    puti(h, ie, g.KFG, 0)
    puti(h, ie, g.KFNG, 0)
    while ig != 0:
        following = iget(h, ig, g.KG)
        jg = int64(0)
        if getr(h, ig, g.KGPM) == zero:
            jg = int64(ig)
            putr(h, jg, g.KGPM, getr(h, jg, g.KGFX))
        elif getr(h, ig, g.KGFX) != zero:
            jg = _double(h, ig, ib, je, jb)
        if jg != 0:
            _share_conditions(h, ig, jb, jg)
            _append(h, je, last_moved, jg)
            last_moved = jg
        if jg != ig:
            _append(h, ie, last, ig)
            last = int64(ig)
        ig = following


@outlined
def share_zones(h: Memory, ib: int, jb: int) -> bool:
    """Give block `jb`, cut from fully-deformable block `ib` along zone sides, its zones and grid-points.

    There must be memory for an extension, and for a grid-point and its conditions at each point of the crack.
    """
    zero = real(h, 0.0)
    ie, je = iget(h, ib, g.KBEX), find(h, g.NVFD)
    puti(h, jb, HEAD, g.MFDEF)
    puti(h, jb, g.KBEX, je)
    puti(h, je, g.KFMIX, iget(h, ie, g.KFMIX))
    h.ci[g.NSOFT] += 1
    _share_zones(h, ie, je, jb)
    ig = iget(h, ie, g.KFG)
    while ig != 0:
        putr(h, ig, g.KGPM, zero)
        putr(h, ig, g.KGFX, zero)
        ig = iget(h, ig, g.KG)
    _add_masses(h, ie, g.KGPM)
    _add_masses(h, je, g.KGFX)
    _share_points(h, ib, jb, ie, je)
    for b in (ib, jb):
        reset_point_forces(h, b)
        sum_over_points(h, b)
        if h.ci[g.LDISP] != 0:
            put_mean_displacement(h, b)
        pvelfd(h, b)
    return True
