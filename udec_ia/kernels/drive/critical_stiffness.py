"""Masses and stiffnesses that limit the time-step: of the whole model, of deformable blocks, and in row sums.

The 1980 estimate is 2 sqrt(M/K) with a mass and the stiffness that acts on it (4.6: only approximate):

    rigid                M least mass, K greatest joint stiffness
    simply-deformable    M least principal value of the Euler tensor, K = A (K + 4G/3), the uniaxial mode
    fully-deformable     M mass of a grid-point, K stiffness of its zones and of the contacts that act on it

The safe bound needs the row sums of the stiffness matrix (running.stiffness_bound). A contact adds to them:
it has KN along its normal n and KS along its tangent t. With the displacement u = sum_j s_j q_j of its point,
q_j the degrees of freedom of both sides and s_j how far a unit of each moves the point, it has

    K_ij = KN (s_i n)(s_j n) + KS (s_i t)(s_j t)

Coupling between degrees of freedom of one body is summed with its sign over all contacts, and much of it
cancels. Coupling between two bodies counts with its absolute value. KN and KS are those of the joint's law
(constitutive.joint_laws.bounding_stiffness).

Each side of a contact moves with a body without zones and all its degrees of freedom, or with the grid-points
of a fully-deformable block: two at the ends of an edge, or one at a corner.

Row sums are calculated in 64 bits: np.float64 widens a real compiled and interpreted, float() only
interpreted.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.body.fdef import gradient
from udec_ia.kernels.constitutive.joint_laws import bounding_stiffness
from udec_ia.kernels.constitutive.joint_properties import stiffest
from udec_ia.kernels.constitutive.joint_stresses import joint_in_step, whole_length
from udec_ia.kernels.geometry.contact_geometry import meet
from udec_ia.kernels.links.linked_lists import corner_of
from udec_ia.kernels.links.longer_groups import joint_at, water_at
from udec_ia.kernels.map.domain_water import is_held
from udec_ia.layout import offsets as g


@kernel
def smallest_mass(h: Memory) -> tuple[float, int, int]:
    """Least mass of a free block (of any if none is free), that block, and a block without mass or 0."""
    free, smallest = real(h, np.inf), real(h, np.inf)
    at_free, at_smallest, massless = int64(0), int64(0), int64(0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        mass = getr(h, ib, g.KBM)
        if not mass > 0:
            massless = ib
        if mass < smallest:
            smallest, at_smallest = mass, ib
        if iget(h, ib, g.KBFIX) == 0 and mass < free:
            free, at_free = mass, ib
        ib = iget(h, ib, g.KB)
    if at_free == 0:
        return smallest, at_smallest, massless
    return free, at_free, massless


@kernel
def water_stiffness(h: Memory, ic: int) -> float:
    """Normal stiffness (N/m2) that the water on both sides adds to contact `ic`.

    KVLEN is such that no wall of a domain needs more (water_pressure.measure_domain).
    """
    zero = real(h, 0.0)
    if h.ci[g.LWATER] == 0 or h.ci[g.LFLOW] == g.DRAINED:
        return zero
    total = zero
    for idm in (iget(h, ic, g.KD1), iget(h, ic, g.KD2)):
        volume, length = getr(h, water_at(h, idm), g.KVVOL), getr(h, water_at(h, idm), g.KVLEN)
        if idm != h.ci[g.IODPNT] and not is_held(h, idm) and volume > 0:
            total += length * length / volume
    return total * h.cr[g.WKW]


@kernel
def allow_for_volumes(h: Memory) -> None:
    """The time-step that is found next allows for the present volumes of domains."""
    idm = int64(h.ci[g.IDPNT]) if h.ci[g.LWATER] != 0 else int64(0)
    while idm != 0:
        putr(h, water_at(h, idm), g.KVSTEP, getr(h, water_at(h, idm), g.KVVOL))
        idm = iget(h, idm, g.KD)


@kernel
def greatest_stiffness(h: Memory) -> tuple[float, int]:
    """Greatest joint stiffness of a contact, and a contact without stiffness or 0.

    A contact at the place of another one may have no length of their joint, and so no stiffness.
    """
    largest = real(h, 0.0)
    undefined = int64(0)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        joint, ix = joint_in_step(h, ic), joint_at(h, ic)
        has_none = not min(joint.kn, joint.ks) > 0 and (ix == 0 or whole_length(h, ix) > 0)
        if has_none and (iget(h, ic, g.KCCOD) != g.VIRTUAL or h.ci[g.LJOINT] == 0):
            undefined = ic  # with joint materials, virtual contacts need no stiffness
        largest = max(largest, stiffest(joint) + water_stiffness(h, ic))
        ic = iget(h, ic, g.KC)
    return largest, undefined


@kernel
def internal_mode(h: Memory, ib: int) -> float:
    """Mass over stiffness of the stiffest internal mode of simply-deformable block `ib`."""
    ie = iget(h, ib, g.KBEX)
    j11, j12, j22 = getr(h, ie, g.KSJ11), getr(h, ie, g.KSJ12), getr(h, ie, g.KSJ22)
    half = real(h, 0.5)
    mean, diff = (j11 + j22) * half, (j11 - j22) * half
    smallest = mean - np.sqrt(diff * diff + j12 * j12)
    return smallest / (getr(h, ie, g.KSAREA) * h.cr[g.ALAM1 + iget(h, ib, g.KMAT) - 1])


@kernel
def zone_stiffness(h: Memory, ib: int, stiffness: Any) -> None:
    """Add the stiffness of every zone of block `ib` at its grid-points; `stiffness`: one real per address."""
    modulus = h.cr[g.ALAM1 + iget(h, ib, g.KMAT) - 1]
    iz = iget(h, iget(h, ib, g.KBEX), g.KFZ)
    while iz != 0:
        g1, g2, g3, b1, c1, b2, c2, twice = gradient(h, iz, real(h, 0.0))
        b3, c3 = -(b1 + b2), -(c1 + c2)
        scale = modulus / (twice + twice)
        stiffness[g1] += scale * (b1 * b1 + c1 * c1)
        stiffness[g2] += scale * (b2 * b2 + c2 * c2)
        stiffness[g3] += scale * (b3 * b3 + c3 * c3)
        iz = iget(h, iz, g.KZ)


@kernel
def contact_stiffness(h: Memory, ic: int, stiffness: Any) -> None:
    """Add the stiffness of contact `ic` at the grid-points on both its sides."""
    stiffer = stiffest(joint_in_step(h, ic)) + water_stiffness(h, ic)
    for ib in (iget(h, ic, g.KB1), iget(h, ic, g.KB2)):
        if iget(h, ib, HEAD) == g.MFDEF:
            ip = corner_of(h, ib, ic)
            stiffness[iget(h, ip, g.KGP)] += stiffer
            stiffness[iget(h, iget(h, ip, g.KR), g.KGP)] += stiffer


@kernel
def soft_step(h: Memory, stiffness: Any) -> tuple[float, int]:
    """Least mass over stiffness of the internal modes and grid-points of blocks not fixed, and its address.

    A grid-point with prescribed velocities counts as any other; otherwise its zones could strain too much in
    one step. stiffness: one real for every word of IA() in use, all zero.
    """
    smallest, at = real(h, np.inf), int64(0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        kind, fixed = iget(h, ib, HEAD), iget(h, ib, g.KBFIX) == g.FIXED
        if kind == g.MFDEF and not fixed:
            zone_stiffness(h, ib, stiffness)
        elif kind == g.MSDEF and not fixed and internal_mode(h, ib) < smallest:
            smallest, at = internal_mode(h, ib), ib
        ib = iget(h, ib, g.KB)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            contact_stiffness(h, ic, stiffness)
        ic = iget(h, ic, g.KC)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        if iget(h, ib, g.KBFIX) != g.FIXED and iget(h, ib, HEAD) == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                if getr(h, ig, g.KGPM) < smallest * stiffness[ig]:
                    smallest, at = getr(h, ig, g.KGPM) / stiffness[ig], ig
                ig = iget(h, ig, g.KG)
        ib = iget(h, ib, g.KB)
    return smallest, at


# Of a block: x, y, rotation, and the strains 11, 22, 12 along its principal axes. Of a grid-point: x and y.
DOFS = 6
NORMAL, TANGENT = 0, 1


@kernel
def _position_on_edge(h: Memory, ip: int, x: float, y: float) -> float:
    """Position of the point (x, y) on the edge that ends at corner `ip`: 0 at its start, 1 at its end."""
    ia = iget(h, ip, g.KR)
    ax, ay = np.float64(getr(h, ia, g.KXP)), np.float64(getr(h, ia, g.KYP))
    dx, dy = np.float64(getr(h, ip, g.KXP)) - ax, np.float64(getr(h, ip, g.KYP)) - ay
    square = dx * dx + dy * dy
    if not square > 0:
        return 1.0
    return min(max(((x - ax) * dx + (y - ay) * dy) / square, 0.0), 1.0)


@kernel
def enter_displacements(
    h: Memory, ib: int, x: float, y: float, nx: float, ny: float, k: int, frame: Any, s: Any
) -> None:
    """Displacement of (x, y) along (nx, ny) for a unit of each degree of freedom of block `ib`, in row `k`.

    frame: radius of gyration and direction of the first principal axis of each row.
    """
    length, c, d = frame[k, 0], frame[k, 1], frame[k, 2]
    rx = (x - np.float64(getr(h, ib, g.KX))) / length
    ry = (y - np.float64(getr(h, ib, g.KY))) / length
    p, q = c * rx + d * ry, c * ry - d * rx
    along, across = c * nx + d * ny, c * ny - d * nx
    s[0], s[1], s[2] = nx, ny, rx * ny - ry * nx
    s[3], s[4], s[5] = p * along, q * across, q * along + p * across


@kernel
def _enter_side(h: Memory, ic: int, side: int, row: Any, frame: Any, way: Any, at: Any, moves: Any) -> None:
    """Rows of the bodies at one side of contact `ic`, and displacements of the contact along `way`."""
    ib, ip = iget(h, ic, g.KB1 if side == 0 else g.KB2), iget(h, ic, g.KCP1 if side == 0 else g.KCP2)
    x, y = np.float64(getr(h, ic, g.KXC)), np.float64(getr(h, ic, g.KYC))
    if iget(h, ib, HEAD) != g.MFDEF:
        at[0] = row[ib]
        for axis in range(2):
            enter_displacements(h, ib, x, y, way[axis, 0], way[axis, 1], at[0], frame, moves[0, axis])
        return
    on_edge = iget(h, ic, g.KCCOD) == (g.EDGE_CORNER if side == 0 else g.CORNER_EDGE)
    part = _position_on_edge(h, ip, x, y) if on_edge else 1.0
    at[0], at[1] = row[iget(h, ip, g.KGP)], row[iget(h, iget(h, ip, g.KR), g.KGP)]
    for axis in range(2):
        for i in range(2):
            moves[0, axis, i] = way[axis, i] * part
            moves[1, axis, i] = way[axis, i] * (1.0 - part)


@kernel
def add_matrix(kn: float, ks: float, at: Any, moves: Any, weight: Any, own: Any, total: Any) -> None:
    """Add the stiffness of two springs to the matrices of the rows `at`, and the coupling to the row sums.

    kn, ks: their stiffnesses, of a contact along normal and tangent. moves: displacement of both springs for
    each degree of freedom of the rows.
    """
    for a in range(len(at)):
        for b in range(len(at)):
            if at[a] == 0 or at[b] == 0:
                continue
            for i in range(DOFS):
                n, t = kn * moves[a, NORMAL, i], ks * moves[a, TANGENT, i]
                for j in range(DOFS):
                    k = n * moves[b, NORMAL, j] + t * moves[b, TANGENT, j]
                    if at[a] == at[b]:
                        own[at[a], i, j] += k
                    else:
                        total[at[a], i] += abs(k) * weight[at[b], j]


@kernel
def add_contacts(h: Memory, row: Any, frame: Any, weight: Any, own: Any, total: Any) -> None:
    """Add the stiffness of all contacts that are not virtual, to `own` within rows, to `total` between them.

    row: of the block or grid-point at each address; row 0 is unused. own: n by 6 by 6. total: n by 6. frame:
    n by 3, radii of gyration and directions of the first principal axes. weight: n by 6, factor of each
    column; 0 if it is fixed.
    """
    at, moves, way = np.zeros(4, np.int64), np.zeros((4, 2, DOFS)), np.zeros((2, 2))
    ic = h.ci[g.ICPNT]
    while ic != 0:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            found = meet(h, iget(h, ic, g.KCCOD), iget(h, ic, g.KCP1), iget(h, ic, g.KCP2))
            nx, ny = np.float64(found[0]), np.float64(found[1])
            way[NORMAL, 0], way[NORMAL, 1], way[TANGENT, 0], way[TANGENT, 1] = nx, ny, ny, -nx
            moves[:] = 0.0
            at[:] = 0
            for side in range(2):
                first = 2 * side
                _enter_side(h, ic, side, row, frame, way, at[first : first + 2], moves[first : first + 2])
            kn, ks = bounding_stiffness(h, ic)
            kn, ks = np.float64(kn) + water_stiffness(h, ic), np.float64(ks)
            add_matrix(kn, ks, at, moves, weight, own, total)
        ic = iget(h, ic, g.KC)
