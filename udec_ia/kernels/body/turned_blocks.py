"""Blocks whose rotation is prescribed (BOUNDARY ... ROTATION), in a pass after the other boundary conditions.

The angular velocity of a rigid or simply-deformable block becomes w f, and the law of motion leaves it.
Together with both velocities it moves the whole block, which is not strained then:

    simply-deformable    the applied stress is set to the internal stress, so no force strains the block
    fully-deformable     grid-points get the velocities V + (R - 1) r/dt, with r from the centroid and R the
                         rotation whose half angle has the tangent w dt/2: the block keeps its shape

Work is entered as for prescribed velocities (kernels.body.boundary_conditions), with moment and angular
velocity in place of force and velocity.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, integers, putr, real
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g

AS_WHOLE = g.GIVEN_X + g.GIVEN_Y + g.GIVEN_TURN  # of KBFIX: the block moves as a whole, and is not strained


def any_turns(h: Memory) -> bool:
    """True if a boundary condition prescribes a rotation."""
    conditions = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    return bool((integers(h, conditions, g.KUFIX) == g.TURNS).any())


@kernel
def turn_points(h: Memory, ib: int) -> None:
    """Velocities of the grid-points of block `ib` := those of its motion as a rigid body."""
    xd, yd, td = getr(h, ib, g.KXD), getr(h, ib, g.KYD), getr(h, ib, g.KTD)
    half = td * h.cr[g.TDEL] * real(h, 0.5)
    across = td / (real(h, 1.0) + half * half)
    inwards = across * half
    ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        rx, ry = getr(h, ig, g.KXG) - getr(h, ib, g.KX), getr(h, ig, g.KYG) - getr(h, ib, g.KY)
        putr(h, ig, g.KXDG, xd - across * ry - inwards * rx)
        putr(h, ig, g.KYDG, yd + across * rx - inwards * ry)
        ig = iget(h, ig, g.KG)


@kernel
def relieve(h: Memory, ie: int) -> None:
    """Applied stress of extension `ie` := its internal stress, times the area: nothing strains the block."""
    area = getr(h, ie, g.KSAREA)
    putr(h, ie, g.KSA11, area * getr(h, ie, g.KS111))
    putr(h, ie, g.KSA12, area * getr(h, ie, g.KS112))
    putr(h, ie, g.KSA21, area * getr(h, ie, g.KS112))
    putr(h, ie, g.KSA22, area * getr(h, ie, g.KS122))


@kernel
def _turn(h: Memory, ib: int, td: float) -> None:
    """Set the angular velocity of block `ib`, which is not fixed, and hold what moves as a whole."""
    before, inertia, moment = np.float64(getr(h, ib, g.KTD)), getr(h, ib, g.KBI), getr(h, ib, g.KBFT)
    putr(h, ib, g.KTD, td)
    now = np.float64(getr(h, ib, g.KTD))
    gained = inertia * (now * now - before * before) * 0.5
    h.cd[g.WDRIVE] += max(gained, 0.0) + max(-moment * now, 0.0) * h.cr[g.TDEL]
    if h.ci[g.LENER] != 0:
        h.cd[g.WBOUND] += gained + moment * (now - before) * h.cr[g.TDEL] * 0.5
    if iget(h, ib, g.KBFIX) == AS_WHOLE:
        if iget(h, ib, HEAD) == g.MFDEF:
            turn_points(h, ib)
        elif iget(h, ib, HEAD) == g.MSDEF:
            relieve(h, iget(h, ib, g.KBEX))


@outlined
def turn_blocks(h: Memory) -> bool:
    """Apply all prescribed rotations for the step that begins."""
    iu = int64(h.ci[g.IBNPNT])
    while iu != 0:
        ib = iget(h, iu, g.KUB)
        if iget(h, iu, g.KUFIX) == g.TURNS and iget(h, ib, g.KBFIX) != g.FIXED:
            factor = real(h, 1.0)
            if iget(h, iu, g.KUS) != 0:
                factor = getr(h, iget(h, iu, g.KUS), g.KTNOW)
            _turn(h, ib, getr(h, iu, g.KUVX) * factor)
        iu = iget(h, iu, g.KU)
    return True
