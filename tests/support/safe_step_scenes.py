"""Random small scenes whose critical time-step is known from their matrices.

Rigid ones and deformable ones, all cut from one block: grids, columns, fans, random cuts, slender and tiny
blocks; two materials whose stiffnesses differ by up to 1e12 and whose densities by up to 1e9; some blocks are
held. All contacts count as closed and sticking, in the program's bound and in the oracle's matrices alike.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from itertools import chain
from math import cos, pi, sin
from typing import Any

import numpy as np

from udec_ia import Model, UdecError
from udec_ia.studies.verification_tools import fan

KINDS = ("rigid", "deformable")
MANY = 40  # blocks


@dataclass(frozen=True)
class RandomScene:
    """A model, what is in it, and its materials: bulk and shear moduli, and joint stiffnesses, by number."""

    model: Model
    layout: str
    moduli: dict[int, tuple[float, float]]
    joints: dict[int, tuple[float, float]]


def draw(kind: str, seed: int) -> RandomScene:
    """Scene number `seed` of a kind, before its first cycle."""
    rng = np.random.default_rng([KINDS.index(kind), seed])
    size = 10 ** rng.uniform(-2, 3)
    layout = str(rng.choice(list(LAYOUTS)))
    outline, cuts = LAYOUTS[layout](rng)
    m = Model(out="/tmp")
    m.tell = m.inform = lambda _: None
    m.start()
    moduli, joints = materials(m, rng, size)
    if rng.random() < 0.3:
        angle = rng.uniform(0, 2 * pi)
        turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        outline, cuts = outline @ turn.T, [cut @ turn.T for cut in cuts]
    m.block(*chain.from_iterable((size * outline).tolist()))
    for cut in cuts:
        if len(m.table("block")) < MANY:
            with suppress(UdecError):  # too close to a corner
                m.split(*(size * cut).ravel().tolist())
    m.gravity(0, 0)
    furnish(m, rng, size, soft=kind == "deformable")
    return RandomScene(m, layout, moduli, joints)


def materials(m: Model, rng: Any, size: float) -> tuple[dict[int, Any], dict[int, Any]]:
    """Two materials; most often they are alike, and KS is a tenth of KN or more."""
    moduli, joints = {}, {}
    density, kn = 10 ** rng.uniform(2, 4), 10 ** rng.uniform(6, 11)
    apart = rng.random() < 0.3
    for number in (1, 2):
        if number == 2 and apart:
            density *= 10 ** rng.uniform(0, 9 if rng.random() < 0.3 else 2)
            kn *= 10 ** rng.uniform(0, 12 if rng.random() < 0.3 else 2)
        ks = kn * (10 ** rng.uniform(-1, 0) if rng.random() < 0.8 else 10 ** rng.uniform(-6, 1))
        bulk = kn * 10 ** rng.uniform(-2, 2)
        shear = bulk * rng.uniform(0.05, 1.4)
        m.property(number, density=density, kn=kn, ks=ks, bulk=bulk, g=shear, cohesion=1e30, friction=1.0)
        moduli[number], joints[number] = (bulk, shear), (kn, ks)
    return moduli, joints


def furnish(m: Model, rng: Any, size: float, soft: bool) -> None:
    """Materials, types and supports of the blocks."""
    for row in m.table("block"):
        x, y, far = float(row["KX"]), float(row["KY"]), 1e-9 * size
        near = x - far, x + far, y - far, y + far
        if rng.random() < 0.3:
            m.change(*near, material=2)
        kind = rng.integers(4) if soft else 0
        if kind == 1:
            m.change(*near, type="sdef")
        elif kind > 1:
            with suppress(UdecError):  # a sliver has no zones
                mesh(m, rng, near, row)
        if rng.random() < 0.15:
            m.fix(*near)


def mesh(m: Model, rng: Any, near: tuple[float, ...], row: Any) -> None:
    """Zones that meet in the centroid, which may be bad ones, or a mesh of the program's own."""
    m.change(*near, type="fdef")
    if rng.random() < 0.5:
        m.generate(*near, "automatic", edge=float(row["KBRO"]) * rng.uniform(0.3, 1.5))
    else:
        fan(m, float(row["KX"]), float(row["KY"]), edge_points=int(rng.integers(3)))


# ---- layouts: an outline, clockwise, and lines to cut it along


def box(w: float, h: float) -> Any:
    return np.array([(0, 0), (0, h), (w, h), (w, 0)], float)


def grid(rng: Any) -> tuple[Any, list[Any]]:
    """Up to 6 x 6 blocks, the second joint set perhaps inclined or offset."""
    nx, ny = rng.integers(1, 7, 2)
    w, h, lean = nx * rng.uniform(0.3, 1), ny * rng.uniform(0.3, 1), rng.choice([0.0, rng.uniform(-0.5, 0.5)])
    cuts = [np.array([(-1.0, h * i / ny), (w + 1, h * i / ny)]) for i in range(1, ny)]
    cuts += [
        np.array([(w * i / nx - 2 * lean * h, -h), (w * i / nx + lean * h, 2 * h)]) for i in range(1, nx)
    ]
    return box(w, h), cuts


def column(rng: Any) -> tuple[Any, list[Any]]:
    """Blocks on each other, of heights that differ by up to 1:100."""
    heights = 10 ** rng.uniform(-1, 1, int(rng.integers(2, 10)))
    w, tops = 10 ** rng.uniform(-1, 1), np.cumsum(heights)
    return box(w, float(tops[-1])), [np.array([(-1.0, y), (w + 1, y)]) for y in tops[:-1]]


def slender(rng: Any) -> tuple[Any, list[Any]]:
    """Slabs and needles of up to 1:300, cut across once or twice."""
    w, h = 1.0, 10 ** rng.uniform(-1.5, 0)
    n = int(rng.integers(2, 8))
    cuts = [np.array([(-1.0, h * i / n), (w + 1, h * i / n)]) for i in range(1, n)]
    cuts += [np.array([(x, -h), (x + rng.uniform(-h, h), 2 * h)]) for x in rng.uniform(0.1, 0.9, 2)]
    return box(w, h), cuts


def spokes(rng: Any) -> tuple[Any, list[Any]]:
    """Wedges that meet in a point."""
    n = int(rng.integers(2, 7))
    angles = np.sort(rng.uniform(0, pi, n))
    ways = np.stack([np.cos(angles), np.sin(angles)], axis=1) * 3
    return box(2, 2), [np.array([1.0 - way, 1.0 + way]) for way in ways]


def shards(rng: Any) -> tuple[Any, list[Any]]:
    """A convex outline and random lines through it: blocks of all sizes and angles."""
    n = int(rng.integers(3, 9))
    gaps = rng.uniform(1, 3, n)
    angles = -2 * pi * np.cumsum(gaps) / gaps.sum()
    a, b = rng.uniform(0.5, 2, 2)
    outline = np.stack([a * np.cos(angles), b * np.sin(angles)], axis=1)
    points = rng.uniform(-0.6, 0.6, (int(rng.integers(2, 8)), 2, 2)) * (a, b)
    return outline, [np.array([p - 20 * (q - p), p + 20 * (q - p)]) for p, q in points]


LAYOUTS = {"grid": grid, "column": column, "slender": slender, "fan": spokes, "shards": shards}
