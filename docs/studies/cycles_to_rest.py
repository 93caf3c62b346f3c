"""To rest: how many cycles SOLVE needs, with the best Rayleigh damping that a scan finds, and STATIC.

    python docs/studies/cycles_to_rest.py [SCENE ...] [--ratio 1e-4]

prints the table of docs/rest.md. Each scene is brought to the same force ratio in each of these ways; the
scan goes over fractions of critical damping and over frequencies, at the default FRACTION and at one near the
safe bound. The stress that counts is the root of the sum of the squares of all contact forces, against that
of the same scene loaded slowly: gravity or the load grows in steps, and after each the model comes to rest
by mass damping. The last column has what STATIC says of its own result.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from statistics import median
from typing import NamedTuple

import numpy as np

from udec_ia import Model, UdecError

LIMIT = 20_000
CRITICAL, FREQUENCIES = (0.2, 0.5, 1.0), (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0)
STEPS = 10  # of slow loading
REMARKS = {"blocks-fallen": "fallen", "joints-slipped": "slip"}  # keys of Solution.remarks, and a word


class Scene(NamedTuple):
    """build: makes the model, all but what loads it. load: puts on the share of the load (0 to 1)."""

    build: Callable[[], Model]
    load: Callable[[Model, float], None]


def new(*, kn: float = 1e9, friction: float = 0.6, d: float = 0.02, density: float = 2500.0) -> Model:
    """A model of one material."""
    m = Model(out="/tmp")
    m.tell = m.inform = lambda _: None
    m.property(1, density=density, kn=kn, ks=kn, friction=friction, bulk=1e10, g=6e9)
    m.round(d)
    return m


def weight(m: Model, share: float) -> None:
    """Gravity."""
    m.gravity(0, -10 * share)


def column() -> Model:
    """Twelve blocks on each other."""
    m = new()
    m.block(0, -1, 0, 12, 1, 12, 1, -1)
    for y in range(12):
        m.split(-1, y, 2, y)
    m.fix(0, 1, -1, 0)
    return m


def wall() -> Model:
    """A running-bond wall, 10 x 8 m."""
    m = new()
    m.block(0, -1, 0, 8, 10, 8, 10, -1)
    for y in range(8):
        m.split(-1, y, 11, y)
    for y in range(8):
        for x in np.arange(1 if y % 2 else 2, 10, 2.0):
            m.split(x, y + 0.5 - 0.51, x, y + 0.5 + 0.51)
    m.fix(0, 10, -1, 0)
    return m


def slope() -> Model:
    """Two joint sets dipping into a slope of 60 degrees, 12 m high."""
    m = new(friction=0.8)
    m.block(0, 0, 0, 14, 20, 14, 20, 0)
    m.split(-1, 2, 21, 2)
    for y in range(-2, 14, 2):
        m.split(-1, 2.001 + y, 21, 2.001 + y + 22 * math.tan(math.radians(-8)) + 5)
    for x in range(2, 20, 2):
        m.split(x + 1.5, 2, x - 1, 15)
    m.fix(-1, 21, -1, 2)
    m.delete(14, 21, 6, 15)
    return m


def arch() -> Model:
    """A semicircular arch of 17 voussoirs, radii 4 and 5 m, of which the first and the last are fixed."""
    m, n = new(), 17
    turns = [math.pi * (1 - i / n) for i in range(n + 1)]
    outer = [(5 * math.cos(t), 5 * math.sin(t)) for t in turns]
    inner = [(4 * math.cos(t), 4 * math.sin(t)) for t in turns]
    m.block(*[c for point in [*outer, *reversed(inner)] for c in point])
    for t in turns[1:-1]:
        m.split(3.9 * math.cos(t), 3.9 * math.sin(t), 5.1 * math.cos(t), 5.1 * math.sin(t))
    m.fix(-5, -4, 0, 0.7)
    m.fix(4, 5, 0, 0.7)
    return m


def tunnel() -> Model:
    """A square opening of 3 x 3 m in blocks of 1 x 1 m, 11 x 11 m."""
    m = new(friction=0.7)
    m.block(0, 0, 0, 11, 11, 11, 11, 0)
    for i in range(1, 11):
        m.split(-1, i, 12, i)
    for j in range(11):
        for x in np.arange(1 + (j % 2) / 2, 11, 1.0):
            m.split(x, j - 0.01, x, j + 1.01)
    m.fix(0, 11, 0, 1)
    m.fix(0, 1, 0, 11)
    m.fix(10, 11, 0, 11)
    m.delete(4, 7, 4, 7)
    return m


def frame(kind: str, hole: bool) -> Model:
    """3 x 3 deformable blocks of 1 x 1 m on a fixed base, with or without the one in the middle."""
    m = new(kn=1e10)
    m.block(0, -1, 0, 3, 3, 3, 3, -1)
    for y in range(3):
        m.split(-1, y, 4, y)
    for x in (1, 2):
        m.split(x, -0.01, x, 4)
    m.fix(0, 3, -1, 0)
    if hole:
        m.delete(1, 2, 1, 2)
    m.change(0, 3, 0, 3, type=kind)
    for x in range(3) if kind == "fdef" else ():
        for y in range(3):
            if not (hole and x == y == 1):
                m.generate(x, x + 1, y, y + 1, "automatic", edge=0.35)
    return m


def pressed(m: Model, share: float) -> None:
    """A stress of 1 MPa on the top."""
    m.boundary(-0.1, 3.1, 2.95, 3.05, free=True)
    m.boundary(-0.1, 3.1, 2.95, 3.05, stress=(0.0, 0.0, -1e6 * share))


def footed(m: Model, share: float) -> None:
    """A stress of 1 MPa on the middle of the top."""
    m.boundary(0.95, 2.05, 2.95, 3.05, free=True)
    m.boundary(0.95, 2.05, 2.95, 3.05, stress=(0.0, 0.0, -1e6 * share))


SCENES = {
    "slope": Scene(slope, weight),
    "wall": Scene(wall, weight),
    "arch": Scene(arch, weight),
    "tunnel": Scene(tunnel, weight),
    "column": Scene(column, weight),
    "plate with a hole": Scene(lambda: frame("fdef", hole=True), pressed),
    "footing": Scene(lambda: frame("sdef", hole=False), footed),
    "pillar": Scene(lambda: frame("fdef", hole=False), pressed),
}


def carried(m: Model) -> float:
    """Root of the sum of the squares of all contact forces, in N/m: one that hardly bears does not count."""
    contacts = m.table("contact")
    return float(np.sqrt((contacts["KCFN"] ** 2 + contacts["KCFS"] ** 2).sum()))


def slowly(scene: Scene, ratio: float) -> Model:
    """The scene, loaded in steps, each of which comes to rest."""
    m = scene.build()
    m.fraction(0.8, safe=True)
    for i in range(1, STEPS + 1):
        scene.load(m, i / STEPS)
        m.damping(1.0, 8.0, "mass")
        m.solve(ratio, limit=LIMIT)
    return m


def rayleigh(scene: Scene, ratio: float, safe: bool) -> tuple[int, float, float]:
    """Cycles of the best damping of the scan, its fraction of critical and its frequency; 0 for none."""
    best = (LIMIT, 0.0, 0.0)
    for fcrit in CRITICAL:
        for frequency in FREQUENCIES:
            m = scene.build()
            scene.load(m, 1.0)
            m.fraction(0.8, safe=True) if safe else m.fraction(0.1)
            try:
                m.damping(fcrit, frequency, "mass")
                if m.table("sdef").size:
                    m.damping(fcrit, frequency, "internal")
                solution = m.solve(ratio, limit=best[0])
            except UdecError:
                continue
            if solution and solution.cycles < best[0]:
                best = solution.cycles, fcrit, frequency
    return best


def main() -> None:
    """Print a line for each scene."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=list(SCENES), metavar="SCENE")
    parser.add_argument("--ratio", type=float, default=1e-4)
    given = parser.parse_args()
    print("| scene | blocks | best Rayleigh, FRAC 0.1 | 0.8 SAFE | STATIC | gain | forces off | remark |")
    print("|---|---|---|---|---|---|---|---|")
    gains = []
    for name in given.scenes:
        scene = SCENES[name]
        m = scene.build()
        scene.load(m, 1.0)
        static = m.solve(given.ratio, limit=LIMIT, static=True)
        tenth, safe = (rayleigh(scene, given.ratio, safe) for safe in (False, True))
        slow = carried(slowly(scene, given.ratio))
        off = 100 * abs(carried(m) / slow - 1)
        best = [f"{cycles:,} ({fcrit:g} at {f:g} Hz)" for cycles, fcrit, f in (tenth, safe)]
        cells = [
            name,
            str(len(m.table("block"))),
            *best,
            f"{static.cycles:,}{'' if static else ' NOT REACHED'}",
        ]
        gains.append((tenth[0] / static.cycles, safe[0] / static.cycles))
        gain = ", ".join(f"{one:.1f}" for one in gains[-1])
        remark = next((REMARKS[key] for key in REMARKS if key in static.keys), "-")
        print("|", " | ".join([*cells, gain, f"{off:.2g} %", remark]), "|", flush=True)
    print("in the median", ", ".join(f"{median(one):.1f}" for one in zip(*gains, strict=True)))


if __name__ == "__main__":
    main()
