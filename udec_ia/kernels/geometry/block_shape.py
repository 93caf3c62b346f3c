"""Shape of a block: area, centroid, inertia (GEO, INERT, MAKEB) and rounded corners (CRAD).

A block's outline is the polygon through its corners, clockwise. Mass and moment of inertia are those
of the unrounded polygon (report 2.3). Each corner is rounded by the arc that is tangent to its two
edges at the distance DTOL from the corner; the arc's radius is D tan(theta/2), theta the interior
angle. With t the unit vector along an edge, clockwise, and Jt = (ty, -tx) pointing into the block:

    centre = corner - D t_in + R J t_in = corner + D t_out + R J t_out

A concave corner gets R < 0: it carries no contact, and the edges at it extend to the corner itself. A flat
corner (R would be infinite) gets R = 0 and is a point of one long edge. A corner that GENERATE has put on an
edge (KGEDGE) always is one, however the block deforms.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.errors import TOO_SHORT
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.links.linked_lists import flag_beside, idomp
from udec_ia.layout import offsets as g

FLAT = 1.0e-3  # sine of the turn below which a corner may count as a point of a straight edge
BULGE = 0.02  # of D: distance from the line between its neighbours below which it may be such a point
KEPT = 0.9  # of both: a strained corner below it loses its radius, which would otherwise alternate


@kernel
def geo(h: Memory, ib: int) -> tuple[float, float, float, float, float, float]:
    """Area, centroid x and y, and second moments of area xx, xy, yy about the centroid (GEO, INERT).

    Sums over the triangles that a first corner makes with every edge; a clockwise outline is positive.
    """
    ip0 = iget(h, ib, g.KP)
    x0, y0 = getr(h, ip0, g.KXP), getr(h, ip0, g.KYP)
    zero, half = real(h, 0.0), real(h, 0.5)
    twice, sx, sy, sxx, sxy, syy = zero, zero, zero, zero, zero, zero
    ip = ip0
    while True:
        iq = iget(h, ip, g.KR)  # the edge from iq to ip
        ax, ay = getr(h, iq, g.KXP) - x0, getr(h, iq, g.KYP) - y0
        bx, by = getr(h, ip, g.KXP) - x0, getr(h, ip, g.KYP) - y0
        cross = bx * ay - ax * by
        twice += cross
        sx += cross * (ax + bx)
        sy += cross * (ay + by)
        sxx += cross * (ax * ax + ax * bx + bx * bx)
        sxy += cross * (ax * ay + (ax * by + ay * bx) * half + bx * by)
        syy += cross * (ay * ay + ay * by + by * by)
        ip = iq
        if ip == ip0:
            break
    area, three, twelve = twice * half, real(h, 3.0), real(h, 12.0)
    cx, cy = sx / (three * twice), sy / (three * twice)
    jxx, jyy = sxx / twelve - area * cx * cx, syy / twelve - area * cy * cy
    return area, x0 + cx, y0 + cy, jxx, sxy / twelve - area * cx * cy, jyy


@kernel
def density_of(h: Memory, ib: int) -> float:
    """Density of the material of block `ib`."""
    return h.cr[g.DENS + iget(h, ib, g.KMAT) - 1]


@kernel
def makeb(h: Memory, ib: int, dens: float) -> None:
    """Centroid, mass, moment of inertia and farthest corner of block `ib` of density `dens` (MAKEB)."""
    area, x, y, jxx, _, jyy = geo(h, ib)
    putr(h, ib, g.KX, x)
    putr(h, ib, g.KY, y)
    putr(h, ib, g.KBM, dens * area)
    putr(h, ib, g.KBI, dens * (jxx + jyy))
    ip0 = iget(h, ib, g.KP)
    far = real(h, 0.0)
    ip = ip0
    while True:
        dx, dy = getr(h, ip, g.KXP) - x, getr(h, ip, g.KYP) - y
        far = max(far, dx * dx + dy * dy)
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            break
    putr(h, ib, g.KBRO, np.sqrt(far))


@kernel
def zcs(h: Memory, ip: int) -> tuple[float, float, float]:
    """Length and unit vector of the edge that ends at corner `ip` (ZCS)."""
    ia = iget(h, ip, g.KR)
    dx, dy = getr(h, ip, g.KXP) - getr(h, ia, g.KXP), getr(h, ip, g.KYP) - getr(h, ia, g.KYP)
    z = np.sqrt(dx * dx + dy * dy)
    return z, dx / z, dy / z


@kernel
def is_edge_point(h: Memory, ip: int) -> bool:
    """True if corner `ip` was put on an edge by GENERATE."""
    ig = iget(h, ip, g.KGP)
    return ig != 0 and iget(h, ig, g.KGEDGE) == 1


@kernel
def span(h: Memory, ip: int, z: float) -> float:
    """Length for two roundings on the edge of length `z` that ends at corner `ip`.

    An edge between two roundings counts with its length, an edge from a rounding to an edge point with
    twice its length, and one between two edge points is infinite.
    """
    one, two = is_edge_point(h, ip), is_edge_point(h, iget(h, ip, g.KR))
    if one and two:
        return real(h, np.inf)
    return z + z if one or two else z


@inlined
def is_corner_turn(
    h: Memory, z1: float, c1: float, s1: float, z2: float, c2: float, s2: float, had_radius: bool
) -> bool:
    """True if two edges form a corner and not a point of one straight edge.

    Their lengths are z1 and z2, and they lie along (c1, s1) and (c2, s2). had_radius: it has been one.
    """
    share = real(h, KEPT) if had_radius else real(h, 1.0)
    sine = abs(c2 * s1 - c1 * s2)  # of the turn
    return sine >= share * real(h, FLAT) or (
        sine * z1 * z2 >= share * real(h, BULGE) * h.cr[g.DTOL] * (z1 + z2)
    )


@inlined
def circle(
    h: Memory, x: float, y: float, c1: float, s1: float, c2: float, s2: float
) -> tuple[float, float, float]:
    """Radius and centre of the circle at the corner (x, y) of the edges along (c1, s1) and (c2, s2).

    The radius in the form with the larger denominator (report 2.3).
    """
    d = h.cr[g.DTOL]
    rad = d * (c1 + c2) / (s1 - s2) if abs(s1 - s2) > abs(c1 - c2) else d * (s1 + s2) / (c2 - c1)
    return rad, x + (d * c2 + rad * s2), y + (d * s2 - rad * c2)


@kernel
def crad(h: Memory, ib: int, strained: bool) -> int:
    """Radius and circle centre for each corner of block `ib` (CRAD).

    strained: in this step. A corner that changes between convex, straight and concave then requests an update
    of its domain. Sets LSHORT if an edge between two roundings has a straight part shorter than FTOL. Returns
    the corner where an edge ends whose roundings overlap by more than FTOL; 0 if none does.
    """
    d = h.cr[g.DTOL]
    tight = int64(0)
    ip0 = iget(h, ib, g.KP)
    iq = ip0
    z2, c2, s2 = zcs(h, iq)
    while True:  # against the clock, from corner to corner: the other way leads through the contacts
        ip = iget(h, iq, g.KR)
        z, c1, s1 = zcs(h, ip)
        on_edge = is_edge_point(h, ip)
        if z - d - d < h.cr[g.FTOL]:
            if not (on_edge or is_edge_point(h, iget(h, ip, g.KR))):
                h.ci[g.LSHORT] = 1
            if tight == 0 and span(h, ip, z) - d - d < -h.cr[g.FTOL]:
                tight = ip
        rad = real(h, 0.0)
        x, y = getr(h, ip, g.KXP), getr(h, ip, g.KYP)
        if is_corner_turn(h, z, c1, s1, z2, c2, s2, strained and getr(h, ip, g.KRAD) != 0) and not on_edge:
            rad, x, y = circle(h, x, y, c1, s1, c2, s2)
        if strained and np.sign(rad) != np.sign(getr(h, ip, g.KRAD)):
            flag_beside(h, idomp(h, ib, ip), ib)
        putr(h, ip, g.KRAD, rad)
        putr(h, ip, g.KXCP, x)
        putr(h, ip, g.KYCP, y)
        iq, z2, c2, s2 = ip, z, c1, s1
        if iq == ip0:
            return tight


@kernel
def update_circles(h: Memory, ib: int) -> None:
    """Recalculate the circles of block `ib` from its corners.

    Circles and corners move separately. In 32-bit reals far from the origin, rounding shifts a creeping block
    in each cycle, its circles by another amount than its corners. Finally contacts on an arc would be
    mistaken for contacts beside it. A corner with a radius keeps one.
    """
    ip0 = iget(h, ib, g.KP)
    iq = ip0
    z2, c2, s2 = zcs(h, iq)
    while True:
        ip = iget(h, iq, g.KR)
        z1, c1, s1 = zcs(h, ip)
        if getr(h, ip, g.KRAD) != 0 and is_corner_turn(h, z1, c1, s1, z2, c2, s2, True):
            rad, x, y = circle(h, getr(h, ip, g.KXP), getr(h, ip, g.KYP), c1, s1, c2, s2)
            putr(h, ip, g.KRAD, rad)
            putr(h, ip, g.KXCP, x)
            putr(h, ip, g.KYCP, y)
        iq, z2, c2, s2 = ip, z1, c1, s1
        if iq == ip0:
            return


@kernel
def round_strained(h: Memory, ib: int) -> None:
    """CRAD for block `ib`, strained in this step. Error 14 if an edge is too short for its roundings."""
    ip = crad(h, ib, True)
    if ip != 0 and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = TOO_SHORT
        h.ci[g.IERAD] = ip
