"""Reactions: the forces that hold fixed blocks, and blocks and grid-points with prescribed velocities.

The reaction is opposite and equal to the force of contacts, zones, loads and own weight in the directions
that are held. The moment is that about the centroid; a grid-point has none. In sums it is about the origin.
The force that accelerates the held mass itself is not included: without acceleration the reactions of a model
at rest balance all weights and loads.

The loads are added to the force sums, whose old words are then restored (kernels.drive.unbalanced_force).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64
from udec_ia.kernels.body.motion import turns_freely
from udec_ia.kernels.drive.unbalanced_force import put_loads, take_loads_back
from udec_ia.layout import offsets as g


@kernel
def _force_on_hold(h: Memory, ib: int, ig: int) -> tuple[float, float, float]:
    """Reaction on grid-point `ig`, or on block `ib` if that is 0, from the force sums; 0 where it is free."""
    fix, zero = iget(h, ib, g.KBFIX), 0.0
    gx, gy = np.float64(h.cr[g.GRAVX]), np.float64(h.cr[g.GRAVY])
    if ig != 0:
        if fix == g.FIXED:
            return zero, zero, zero
        fix, m = iget(h, ig, g.KGFIX), getr(h, ig, g.KGPM)
        fx = -(getr(h, ig, g.KGFX) + m * gx) if fix & g.ALONG_X != 0 else zero
        fy = -(getr(h, ig, g.KGFY) + m * gy) if fix & g.ALONG_Y != 0 else zero
        return fx, fy, zero
    m, fixed = getr(h, ib, g.KBM), fix == g.FIXED
    fx = -(getr(h, ib, g.KBFX) + m * gx) if fixed or fix & g.GIVEN_X != 0 else zero
    fy = -(getr(h, ib, g.KBFY) + m * gy) if fixed or fix & g.GIVEN_Y != 0 else zero
    moment = -np.float64(getr(h, ib, g.KBFT)) if fixed or not turns_freely(fix) else zero
    return fx, fy, moment


@kernel
def _place(h: Memory, ib: int, ig: int) -> tuple[float, float]:
    """Place of a grid-point, or of the centroid of a block."""
    if ig != 0:
        return np.float64(getr(h, ig, g.KXG)), np.float64(getr(h, ig, g.KYG))
    return np.float64(getr(h, ib, g.KX)), np.float64(getr(h, ib, g.KY))


@kernel
def enter_reactions(h: Memory, rows: Any) -> int:
    """Enter all that is held in `rows`, or only count it if there are none. Returns how many there are.

    rows: shape (n, 7): block, grid-point or 0, x, y (m), force x, y (N/m), moment (N).
    """
    n = 0
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        held = iget(h, ib, g.KBFIX) != 0
        within = iget(h, ib, HEAD) == g.MFDEF and not held
        ig = iget(h, iget(h, ib, g.KBEX), g.KFG) if within else int64(0)
        while held or ig != 0:
            if held or iget(h, ig, g.KGFIX) != 0:
                if len(rows) > 0:
                    rows[n, 0], rows[n, 1] = ib, ig
                    rows[n, 2], rows[n, 3] = _place(h, ib, ig)
                    rows[n, 4], rows[n, 5], rows[n, 6] = _force_on_hold(h, ib, ig)
                n += 1
            if held:
                break
            ig = iget(h, ig, g.KG)
        ib = iget(h, ib, g.KB)
    return n


@kernel
def reactions_of(h: Memory) -> Any:
    """All reactions, shape (n, 7) as above."""
    rows = np.empty((enter_reactions(h, np.empty((0, 7))), 7))
    conditions, words = put_loads(h)
    enter_reactions(h, rows)
    take_loads_back(h, conditions, words)
    return rows


@kernel
def sum_of_reactions(h: Memory, ih: int) -> tuple[float, float, float]:
    """Sum of the reactions of the summands of history `ih`, of all if that is 0: force x, y and moment.

    NaN if the history has no summands any more.
    """
    fx, fy, moment, n = 0.0, 0.0, 0.0, 0
    if ih == 0:
        for row in reactions_of(h):
            fx += row[4]
            fy += row[5]
            moment += row[6] + row[2] * row[5] - row[3] * row[4]
        return fx, fy, moment
    conditions, words = put_loads(h)
    iq = int64(h.ci[g.ISMPNT])
    while iq != 0:
        if iget(h, iq, g.KQH) == ih:
            ib, ig = iget(h, iq, g.KQB), iget(h, iq, g.KQG)
            one = _force_on_hold(h, ib, ig)
            x, y = _place(h, ib, ig)
            fx += one[0]
            fy += one[1]
            moment += one[2] + x * one[1] - y * one[0]
            n += 1
        iq = iget(h, iq, g.KQ)
    take_loads_back(h, conditions, words)
    return (fx, fy, moment) if n > 0 else (np.nan, np.nan, np.nan)
