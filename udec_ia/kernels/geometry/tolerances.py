"""Tolerances from the rounding length (TOLSET; report 4.4) and the rounding itself for all blocks.

    ATOL  0.5 D        a contact is formed          BTOL   0.55 D        a contact is broken
    CTOL  0.5 D        overlap when forming         DTOL2  0.5 D         greatest overlap
    ETOL  ATOL/sqrt 2  update of a domain           HTOL   0.01 ETOL     domain pass may wait
    FTOL  0.05 D       two contacts are one         GTOL   0.0001 D      slack between codes

Without a ROUND command the rounding length is a twentieth of the mean edge, but at most an eighth of the
shortest one. The report does not give this rule.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, real
from udec_ia.kernels.geometry.block_shape import crad, span, zcs
from udec_ia.kernels.links.linked_lists import request_search
from udec_ia.layout import offsets as g


@kernel
def tolset(h: Memory, d: float) -> None:
    """Set the rounding length and all tolerances that are fractions of it (TOLSET)."""
    half = d * real(h, 0.5)
    h.cr[g.DTOL] = d
    h.cr[g.ATOL] = half
    h.cr[g.BTOL] = d * real(h, 0.55)
    h.cr[g.CTOL] = half
    h.cr[g.DTOL2] = half
    h.cr[g.ETOL] = half / np.sqrt(real(h, 2.0))
    h.cr[g.FTOL] = d * real(h, 0.05)
    h.cr[g.GTOL] = d * real(h, 0.0001)
    h.cr[g.HTOL] = h.cr[g.ETOL] * real(h, 0.01)


@kernel
def edges(h: Memory) -> tuple[float, float, int]:
    """Mean span of all edges, span of the shortest one and the corner where it ends."""
    total, shortest_length = real(h, 0.0), real(h, np.inf)
    n, shortest = 0, int64(0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        ip0 = iget(h, ib, g.KP)
        ip = ip0
        while True:
            z, _, _ = zcs(h, ip)
            z = span(h, ip, z)
            if z < real(h, np.inf):
                total += z
                n += 1
                if z < shortest_length:
                    shortest_length, shortest = z, ip
            ip = iget(h, ip, g.KR)
            if ip == ip0:
                break
        ib = iget(h, ib, g.KB)
    return total / real(h, n), shortest_length, shortest


@kernel
def extent(h: Memory) -> float:
    """Greatest |x| + |y| of any corner."""
    largest = real(h, 0.0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        ip0 = iget(h, ib, g.KP)
        ip = ip0
        while True:
            largest = max(largest, abs(getr(h, ip, g.KXP)) + abs(getr(h, ip, g.KYP)))
            ip = iget(h, ip, g.KR)
            if ip == ip0:
                break
        ib = iget(h, ib, g.KB)
    return largest


@kernel
def set_rounding(h: Memory, d: float) -> None:
    """Round every corner of every block with the length `d`; the caller updates the contacts."""
    tolset(h, d)
    h.ci[g.LSHORT] = 0
    ib = h.ci[g.IBPNT]
    while ib != 0:
        crad(h, ib, False)
        if h.ci[g.LLARGE] != 0:
            request_search(h, ib)
        ib = iget(h, ib, g.KB)


@kernel
def default_rounding(h: Memory) -> float:
    """Rounding length without ROUND."""
    mean, shortest_length, _ = edges(h)
    return min(mean * real(h, 0.05), shortest_length * real(h, 0.125))
