"""A block system laid down by hand: the smallest map with contacts, complete in every field.

Two unit squares, one on the other. They touch in two points, so there are two contacts and two domains
(Euler: 2 - 2 + 2 = 2): the inner one is the joint, the outer one is all the rest.

        b2 ------- b3          clockwise lists
        |  upper   |           lower: a1, c1, a2, c2, a3, a4
        b1 -c1-c2- b4          upper: b1, b2, b3, c2, b4, c1
        a2 ------- a3
        |  lower   |           c1 stands on the arcs of a2 and b1, c2 on the arcs of a3 and b4; by
        a1 ------- a4          Fig. 7 each stands before its corners in both lists.
"""

from __future__ import annotations

from math import sqrt

from udec_ia.heap.accessors import HEAD, Memory, Offset, puti, putr, size_of
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.layout import offsets as g

SIDE = 1.0
ROUNDING = 0.1
DENSITY = 2000.0
MASS = DENSITY * SIDE**2
INERTIA = MASS * SIDE**2 / 6
CLOCKWISE = ((0.0, 0.0), (0.0, SIDE), (SIDE, SIDE), (SIDE, 0.0))


def take(h: Memory, size: Offset, code: int) -> int:
    """Address of a fresh group with its head code."""
    group = int(h.ci[g.MFREE])
    h.ci[g.MFREE] += size_of(h, size)
    puti(h, group, HEAD, code)
    return group


def link(h: Memory, items: list[int], following: Offset, back: Offset, index: int, count: int) -> None:
    """Chain `items` both ways into a main list with its head and its count in the common block."""
    for here, after in zip(items, [*items[1:], 0], strict=True):
        puti(h, here, following, after)
    for here, before in zip(items, [0, *items[:-1]], strict=True):
        puti(h, here, back, before)
    h.ci[index], h.ci[count] = items[0], len(items)


def square(h: Memory, y: float, fixed: int) -> tuple[int, list[int]]:
    """A unit square with its lower left corner at (0, y): its address and its corners, clockwise.

    The clockwise list (KL, KLB) is left to the caller, who knows the contacts.
    """
    block = take(h, g.NVBL, g.MRIG)
    corners = [take(h, g.NVCR, g.MCOR) for _ in CLOCKWISE]
    for field, number in ((g.KP, corners[0]), (g.KMAT, 1), (g.KCONS, 1), (g.KBFIX, fixed)):
        puti(h, block, field, number)
    reals = ((g.KX, 0.5), (g.KY, y + 0.5), (g.KBM, MASS), (g.KBI, INERTIA), (g.KBRO, sqrt(0.5)))
    for field, value in reals:
        putr(h, block, field, value)
    for i, (corner, (x, height)) in enumerate(zip(corners, CLOCKWISE, strict=True)):
        puti(h, corner, g.KNB, block)
        puti(h, corner, g.KR, corners[i - 1])
        putr(h, corner, g.KXP, x)
        putr(h, corner, g.KYP, y + height)
        putr(h, corner, g.KXCP, x + (ROUNDING if x == 0.0 else -ROUNDING))
        putr(h, corner, g.KYCP, y + height + (ROUNDING if height == 0.0 else -ROUNDING))
        putr(h, corner, g.KRAD, ROUNDING)
    return block, corners


def two_blocks(scheme_name: str = "i32r64") -> MainArray:
    """Two unit squares, [0,1] x [0,1] (fixed) and [0,1] x [1,2], just touching: no force, no motion.

    Rounding length 0.1 m; material 1 with density, stiffness and friction; gravity (0, -10).
    """
    array = MainArray(scheme(scheme_name))
    h = array.h
    lower, (a1, a2, a3, a4) = square(h, 0.0, 1)
    upper, (b1, b2, b3, b4) = square(h, SIDE, 0)
    left, right = (take(h, g.NVCN, g.MCON) for _ in range(2))
    inner, outer = (take(h, g.NVDO, g.MDOM) for _ in range(2))
    link(h, [lower, upper], g.KB, g.KBB, g.IBPNT, g.NBLK)
    link(h, [left, right], g.KC, g.KCB, g.ICPNT, g.NCON)
    link(h, [inner, outer], g.KD, g.KDB, g.IDPNT, g.NDOM)
    h.ci[g.IODPNT] = outer
    for domain in (inner, outer):
        puti(h, domain, g.KDLOOP, left)

    contact_links = (
        # contact, x, KD1 (left of it, going up), KD2, KL1, KL2, KLB1, KLB2, KCP1, KCP2
        (left, ROUNDING, outer, inner, a2, b1, a1, b4, a2, b1),
        (right, SIDE - ROUNDING, inner, outer, a3, b4, a2, b3, a3, b4),
    )
    for contact, x, *links in contact_links:
        names = (g.KD1, g.KD2, g.KL1, g.KL2, g.KLB1, g.KLB2, g.KCP1, g.KCP2)
        values = dict(zip(names, links, strict=True))
        values |= {g.KB1: lower, g.KB2: upper, g.KCM: 1, g.KCC: 1, g.KCCOD: 1}
        for field, number in values.items():
            puti(h, contact, field, number)
        putr(h, contact, g.KXC, x)
        putr(h, contact, g.KYC, SIDE)
    for ring in ([a1, left, a2, right, a3, a4], [b1, b2, b3, right, b4, left]):
        for i, item in enumerate(ring):
            if item not in (left, right):
                puti(h, item, g.KL, ring[(i + 1) % len(ring)])
                puti(h, item, g.KLB, ring[i - 1])
    set_common(h)
    return array


def set_common(h: Memory) -> None:
    """Rounding length and the tolerances that follow from it, gravity, and material 1."""
    d = ROUNDING
    half = 0.5 * d
    reals = {g.DTOL: d, g.DTOL2: half, g.ATOL: half, g.BTOL: 0.55 * d, g.CTOL: half, g.ETOL: half / sqrt(2)}
    reals |= {g.FTOL: 0.05 * d, g.GTOL: 1e-4 * d, g.HTOL: 0.01 * half / sqrt(2)}
    reals |= {g.FRAC: 0.1, g.GRAVY: -10.0, g.AKN: 1e8, g.AKS: 1e8, g.AMU: 0.5, g.DENS: DENSITY}
    for index, value in reals.items():
        h.cr[index] = value
    h.ci[g.LROUND] = 1
