"""The way to rest: what SOLVE ... STATIC says of its own result, against loading in steps, of random models.

    python docs/studies/loading_paths.py [--models 1000] [--seed 1]

A model is a slope, wall, opening, stack, arch, or blocks in a trough, of random joints, strength, stiffness
and rounding, its blocks rigid or simply-deformable. It is loaded by gravity at once, and in STEPS; both come
to the same force ratio. What differs are the root of the sum of the squares of all contact forces, and the
sum of all shear forces over that of all normal ones. A result that is OFF by that much, and of which SOLVE
gave no remark, is silent; one that is not off by NEAR, and got a remark, has a needless one.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from random import Random
from typing import NamedTuple

import numpy as np
from joblib import Parallel, delayed
from cycles_to_rest import new

from udec_ia import Model, UdecError

RATIO, LIMIT, STEPS = 1e-5, 20_000, 40
OFF, NEAR = (0.01, 0.03), (0.003, 0.005)  # of the forces, and of the shear over the normal forces


class Result(NamedTuple):
    """forces, shear: differences as above. told: SOLVE spoke of its result."""

    forces: float
    shear: float
    told: bool


def courses(m: Model, r: Random, across: int, up: int) -> None:
    """Blocks of 1 x 1 m in a running bond of random offset, from (0, 0)."""
    shift = r.uniform(0.3, 0.7)
    for y in range(up):
        m.split(-1, y, across + 1, y)
        for x in np.arange(1 + y % 2 * shift, across):
            m.split(x, y - 0.01, x, y + 1.01)


def cuts(m: Model, angle: float, apart: float, x: float, y: float, many: int) -> None:
    """Parallel joints about (x, y); angle: degrees above the x axis."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    for k in range(-many, many):
        px, py = x - s * apart * (k + 0.3), y + c * apart * (k + 0.3)
        m.split(px - 50 * c, py - 50 * s, px + 50 * c, py + 50 * s)


def slope(m: Model, r: Random) -> None:
    """Two joint sets in a rock face of 5 to 7 m."""
    m.block(0, 0, 0, 14, 20, 14, 20, 0)
    cuts(m, r.uniform(-25, 25), r.uniform(1.5, 3), 10, 7, 14)
    cuts(m, r.uniform(60, 120), r.uniform(1.5, 2.5), 10, 7, 14)
    m.fix(-1, 21, -1, 2)
    m.delete(r.uniform(12, 16), 21, r.uniform(7, 9), 15)


def wall(m: Model, r: Random) -> None:
    """A wall of bricks on a base."""
    across, up = r.randint(5, 12), r.randint(4, 9)
    m.block(0, -1, 0, up, across, up, across, -1)
    courses(m, r, across, up)
    m.fix(0, across, -1, 0)


def opening(m: Model, r: Random) -> None:
    """A square opening in bricks that are held on three sides."""
    n = r.randint(5, 11)
    m.block(0, -1, 0, n, n, n, n, -1)
    courses(m, r, n, n)
    m.fix(0, n, -1, 0)
    m.fix(0, 1, 0, n)
    m.fix(n - 1, n, 0, n)
    m.delete(n // 2 - 1, n // 2 + 1, n // 2 - 1, n // 2 + 1)


def stack(m: Model, r: Random) -> None:
    """Blocks on each other, their joints a little askew."""
    n = r.randint(4, 12)
    m.block(0, -1, 0, n, 1.5, n, 1.5, -1)
    for y in range(n):
        askew = r.uniform(-0.1, 0.1)
        m.split(-1, y - askew, 2.5, y + askew)
    m.fix(0, 1.5, -1, -0.3)


def trough(m: Model, r: Random) -> None:
    """Two joint sets in a trough."""
    across, up = r.randint(5, 9), r.randint(5, 8)
    m.block(0, 0, 0, up, across, up, across, 0)
    for angle in (r.uniform(-20, 20), r.uniform(70, 110)):
        cuts(m, angle, 1.1, across / 2, up / 2, 2 * across)
    m.fix(-1, across + 1, -1, 1.2)
    m.fix(-1, 1, -1, up)
    m.fix(across - 1, across + 1, -1, up)


def arch(m: Model, r: Random) -> None:
    """A semicircular arch, whose first and last voussoirs are fixed."""
    n, inner, outer = r.choice([9, 13, 17]), 4.0, r.uniform(4.5, 5.5)
    turns = [math.pi * (1 - i / n) for i in range(n + 1)]
    points = [(outer * math.cos(t), outer * math.sin(t)) for t in turns]
    points += [(inner * math.cos(t), inner * math.sin(t)) for t in reversed(turns)]
    m.block(*[c for point in points for c in point])
    for t in turns[1:-1]:
        c, s = math.cos(t), math.sin(t)
        m.split(0.97 * inner * c, 0.97 * inner * s, 1.02 * outer * c, 1.02 * outer * s)
    for x in (-6, 4):
        m.fix(x, x + 2, 0, 0.7)


KINDS: tuple[Callable[[Model, Random], None], ...] = (slope, wall, opening, stack, trough, arch)


def built(seed: int) -> tuple[Model, float]:
    """A model without gravity, and how much that will lean, in degrees."""
    r = Random(seed)
    kn = 10 ** r.uniform(7.5, 9.5)
    m = new(kn=kn, friction=r.choice([0.5, 0.7, 0.9, 1.2, 2.0, 5.0]), d=r.choice([0.01, 0.02, 0.04]))
    if r.random() < 0.4:
        m.property(1, ks=kn * r.choice([0.1, 0.3]))
    if r.random() < 0.3:
        m.property(1, cohesion=10 ** r.uniform(3, 5))
    kind, leans = r.choice(KINDS), r.uniform(0, 10)
    kind(m, r)
    if r.random() < 0.35:
        m.change(-50, 50, -50, 50, type="sdef")
    return m, leans if kind in (wall, stack) else 0.0


def rest(seed: int, steps: int) -> tuple[float, float, bool] | None:
    """Forces and shear as above, and whether SOLVE spoke; None for a model that does not come to rest."""
    m, leans = built(seed)
    for k in range(1, steps + 1):
        pull = 10 * k / steps
        m.gravity(pull * math.sin(math.radians(leans)), -pull * math.cos(math.radians(leans)))
        solution = m.solve(RATIO, LIMIT, static=True)
        if not solution:
            return None
    contacts = m.table("contact")
    forces = float(np.sqrt((contacts["KCFN"] ** 2 + contacts["KCFS"] ** 2).sum()))
    return forces, float(np.abs(contacts["KCFS"]).sum() / contacts["KCFN"].sum()), "joints-slipped" in solution.keys


def study(seed: int) -> Result | None:
    """One model; None if it cannot be built, or does not come to rest both ways."""
    try:
        once, slowly = rest(seed, 1), rest(seed, STEPS)
    except UdecError:
        return None
    if once is None or slowly is None:
        return None
    return Result(abs(once[0] / slowly[0] - 1), abs(once[1] - slowly[1]), once[2])


def main() -> None:
    """Print how many are off, silent and told needlessly."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--models", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    seeds = range(given.seed * 10**6, given.seed * 10**6 + given.models)
    found = [one for one in Parallel(-1)(delayed(study)(seed) for seed in seeds) if one is not None]
    off = [one for one in found if one.forces > OFF[0] or one.shear > OFF[1]]
    silent = [one for one in off if not one.told]
    needlessly = [one for one in found if one.told and one.forces < NEAR[0] and one.shear < NEAR[1]]
    print(f"{len(found)} models come to rest: {len(off)} are off, {len(silent)} of them silent; ", end="")
    print(f"{len(needlessly)} are told needlessly")
    for one in silent:
        off_by = f"forces {100 * one.forces:.2g} %, shear {100 * one.shear:.2g} % of the normal forces"
        print(f"    silent: {off_by}")


if __name__ == "__main__":
    main()
