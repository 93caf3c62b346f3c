"""The yardstick of cycle_speed.py for zones: the pass of a fully-deformable block over a structure of arrays.

`extract` takes grid-points and zones of a block out of the heap, every field into an array of its own and
every address into a row number; `run_arrays` does the arithmetic of FDEF with them: law of motion of the
grid-points, sums over the block, strain rates, turned stresses, linear elasticity, stiffness damping, forces.
It leaves out the corners, which the program moves along. `run_heap` runs the program's own pass as often.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from speed.array_cycle import compiled

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.fdef import move_fdef
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table


class Numbers(NamedTuple):
    """Scalars of the common block; elasticity is that of material 1."""

    dt: float
    con1: float
    con2: float
    gx: float
    gy: float
    beta: float
    one: float
    two: float
    shear: float


class Points(NamedTuple):
    """One row a grid-point."""

    x: Any
    y: Any
    xd: Any
    yd: Any
    fx: Any
    fy: Any
    m: Any


class Zones(NamedTuple):
    """One row a zone; a, b, c: its grid-points, anticlockwise."""

    a: Any
    b: Any
    c: Any
    s11: Any
    s12: Any
    s22: Any


class Body(NamedTuple):
    """A block of zones; sums: centroid, velocity, angular velocity, mass and moment of inertia."""

    numbers: Numbers
    points: Points
    zones: Zones
    sums: Any


def extract(array: MainArray) -> Body:
    """The only block with zones of the model in `array`, as a structure of arrays."""
    cr = array.h.cr
    names = (g.TDEL, g.CON1, g.CON2, g.GRAVX, g.GRAVY, g.BETA, g.ALAM1, g.ALAM2, g.SHEAR)
    points, zones, blocks = (table(array, kind) for kind in ("gridpoint", "zone", "block"))
    order = np.argsort(points["address"])
    rows = order[np.searchsorted(points["address"][order], zones["KZG"])].astype(np.uint32)
    (block,) = blocks[blocks["KBEX"] != 0]
    sums = np.array([block[name] for name in ("KX", "KY", "KXD", "KYD", "KTD", "KBM", "KBI")])
    return Body(
        Numbers(*(float(cr[i]) for i in names)),
        Points(*(points[name].copy() for name in ("KXG", "KYG", "KXDG", "KYDG", "KGFX", "KGFY", "KGPM"))),
        Zones(*(rows[:, k].copy() for k in (2, 1, 0)), *(zones[f"KZS{k}"].copy() for k in (11, 12, 22))),
        sums,
    )


@compiled
def move_points(p: Points, c: Numbers) -> float:
    """Law of motion of all grid-points; returns the greatest velocity."""
    fastest = 0.0
    for i in range(len(p.x)):
        fx, fy = p.fx[i] + p.m[i] * c.gx, p.fy[i] + p.m[i] * c.gy
        xd = (c.con1 * p.xd[i] + fx / p.m[i] * c.dt) * c.con2
        yd = (c.con1 * p.yd[i] + fy / p.m[i] * c.dt) * c.con2
        p.fx[i], p.fy[i], p.xd[i], p.yd[i] = 0.0, 0.0, xd, yd
        p.x[i], p.y[i] = p.x[i] + xd * c.dt, p.y[i] + yd * c.dt
        fastest = max(fastest, max(abs(xd), abs(yd)))
    return fastest


@compiled
def sum_points(p: Points, sums: Any) -> None:
    """Centroid, velocities, mass and moment of inertia of the block."""
    x0, y0 = sums[0], sums[1]
    mass, mx, my, px, py, turn, second = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(p.x)):
        m, xd, yd, dx, dy = p.m[i], p.xd[i], p.yd[i], p.x[i] - x0, p.y[i] - y0
        mass += m
        mx += m * dx
        my += m * dy
        px += m * xd
        py += m * yd
        turn += m * (dx * yd - dy * xd)
        second += m * (dx * dx + dy * dy)
    cx, cy = mx / mass, my / mass
    second -= mass * (cx * cx + cy * cy)
    sums[0], sums[1], sums[2], sums[3] = x0 + cx, y0 + cy, px / mass, py / mass
    sums[4], sums[5], sums[6] = (turn - (cx * py - cy * px)) / second, mass, second


@compiled
def strain_rates(p: Points, a: int, b: int, c: int, back: float) -> tuple[float, float, float, float]:
    """Strain rates 11, 12, 22 and spin of a zone, in mid-step."""
    x1, y1 = p.x[a] - p.xd[a] * back, p.y[a] - p.yd[a] * back
    x2, y2 = p.x[b] - p.xd[b] * back, p.y[b] - p.yd[b] * back
    x3, y3 = p.x[c] - p.xd[c] * back, p.y[c] - p.yd[c] * back
    b1, c1, b2, c2 = y2 - y3, x3 - x2, y3 - y1, x1 - x3
    u1, v1, u2, v2 = p.xd[a] - p.xd[c], p.yd[a] - p.yd[c], p.xd[b] - p.xd[c], p.yd[b] - p.yd[c]
    one = 1.0 / (b1 * c2 - b2 * c1)
    xy, yx = (c1 * u1 + c2 * u2) * one, (b1 * v1 + b2 * v2) * one
    return (b1 * u1 + b2 * u2) * one, (xy + yx) * 0.5, (c1 * v1 + c2 * v2) * one, (yx - xy) * 0.5


@compiled
def push_points(p: Points, a: int, b: int, c: int, s11: float, s12: float, s22: float) -> bool:
    """Forces of a zone on its grid-points; True if it has turned inside out."""
    b1, c1 = p.y[b] - p.y[c], p.x[c] - p.x[b]
    b2, c2 = p.y[c] - p.y[a], p.x[a] - p.x[c]
    fx1, fy1 = -(s11 * b1 + s12 * c1) * 0.5, -(s12 * b1 + s22 * c1) * 0.5
    fx2, fy2 = -(s11 * b2 + s12 * c2) * 0.5, -(s12 * b2 + s22 * c2) * 0.5
    p.fx[a], p.fy[a] = p.fx[a] + fx1, p.fy[a] + fy1
    p.fx[b], p.fy[b] = p.fx[b] + fx2, p.fy[b] + fy2
    p.fx[c], p.fy[c] = p.fx[c] - (fx1 + fx2), p.fy[c] - (fy1 + fy2)
    return b1 * c2 - b2 * c1 <= 0.0


@compiled
def strain_zones(p: Points, z: Zones, n: Numbers) -> bool:
    """Stresses of all zones and their forces; True if one has turned inside out."""
    rate, inside_out = n.beta / n.dt, False
    for i in range(len(z.a)):
        a, b, c = z.a[i], z.b[i], z.c[i]
        e11, e12, e22, spin = strain_rates(p, a, b, c, n.dt * 0.5)
        half = spin * n.dt * 0.5
        below = 1.0 + half * half
        co, si = (1.0 - half * half) / below, (half + half) / below
        cc, cs, ss = co * co, co * si, si * si
        s11, s12, s22 = z.s11[i], z.s12[i], z.s22[i]
        t = cs * (s12 + s12)
        s11, s12, s22 = cc * s11 - t + ss * s22, cs * (s11 - s22) + (cc - ss) * s12, ss * s11 + t + cc * s22
        e11, e12, e22 = e11 * n.dt, e12 * n.dt, e22 * n.dt
        d11, d12, d22 = n.one * e11 + n.two * e22, (n.shear + n.shear) * e12, n.two * e11 + n.one * e22
        s11, s12, s22 = s11 + d11, s12 + d12, s22 + d22
        z.s11[i], z.s12[i], z.s22[i] = s11, s12, s22
        inside_out |= push_points(p, a, b, c, s11 + d11 * rate, s12 + d12 * rate, s22 + d22 * rate)
    return inside_out


@compiled
def run_arrays(body: Body, n: int) -> float:
    """`n` steps of the yardstick; returns the greatest velocity, -1 if a zone has turned inside out."""
    fastest = 0.0
    for _ in range(n):
        fastest = move_points(body.points, body.numbers)
        sum_points(body.points, body.sums)
        if strain_zones(body.points, body.zones, body.numbers):
            return -1.0
    return fastest


@kernel
def run_heap(h: Memory, ib: int, n: int) -> float:
    """`n` steps of block `ib` as the program makes them; returns the greatest velocity."""
    fastest = 0.0
    for _ in range(n):
        fastest = move_fdef(h, ib, None)
    return fastest
