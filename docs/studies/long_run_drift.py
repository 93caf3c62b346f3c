"""What drifts in ten million cycles: TIME, energy, angular momentum, shape, and the place of contacts.

    python docs/studies/long_run_drift.py [--cycles 10000000] [--builds i32r64 ...]

Two scenes without damping. In the one, a block swings up and down on a fixed one, by a tenth of its overlap:
TIME against the number of cycles times the time-step, exactly; the mean energy of motion, joint and height in
the last 10,000 cycles against that in the first; how far its contacts have moved along the joint. In the
other, a block turns freely, without weight, by 1e-3 rad in a cycle: its angular momentum, and its diagonal.
"""

from __future__ import annotations

import argparse
import sys
from fractions import Fraction
from pathlib import Path
from time import process_time

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT)]

from udec_ia import Model
from udec_ia.heap.accessors import getr, putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g

LOOKS, EVERY = 100, 100  # looks at the energy, and cycles between two of them


def two(build: str, gravity: float) -> tuple[Model, int]:
    """A block of 1 x 1 m on or above a fixed one, and its address."""
    m = Model(build, out="/tmp")
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.round(0.05)
    m.gravity(0, -gravity)
    m.block(0, -1, 0, 5, 1, 5, 1, -1)
    m.split(-1, 0, 2, 0)
    if gravity:
        m.split(-1, 1, 2, 1)
        m.delete(0, 1, 1, 5)
    else:  # what is between is taken out, so that it turns freely
        m.split(-1, 4, 2, 4)
        m.delete(0, 1, 0, 4)
    m.fix(0, 1, -1, 0)
    m.cycle(0)
    (free,) = (int(row["address"]) for row in m.table("block") if row["KBFIX"] == 0)
    return m, free


def energy(m: Model, ib: int, weight: float) -> float:
    """Of block `ib`: of motion, between two half steps, of its joints, and of its height, in J/m."""
    h = m.array.h
    fn = m.table("contact")["KCFN"].astype(float)
    overlap = fn / 1e8
    mass, yd, force = (float(getr(h, ib, k)) for k in (g.KBM, g.KYD, g.KBFY))
    here = yd + (force / mass - 10) * float(h.cr[g.TDEL]) / 2
    return mass * here**2 / 2 + float((fn * overlap / 2).sum()) - weight * float(overlap.mean())


def swinging(build: str, cycles: int) -> list[float]:
    """Errors of TIME and of the energy, and the way of contacts over the edge's length."""
    m, ib = two(build, 10.0)
    weight = 2e4
    m.damping(0.9, 10, "mass")
    m.solve(1e-6, limit=20_000)
    m.damping(0, 10, "mass")
    h, begun, first = m.array.h, int(m.h.ci[g.MCTOT]), float(m.h.cd[g.TIME])
    places = m.table("contact")["KXC"].astype(float)
    putr(h, ib, g.KYD, 0.1 * weight / 2e8 * (2e8 / 2000) ** 0.5)

    def look() -> float:
        found = []
        for _ in range(LOOKS):
            m.cycle(EVERY)
            found.append(energy(m, ib, weight))
        return float(np.mean(found)) - rest

    rest = -(weight**2) / 2 / 2e8  # strain and height of the block at rest
    before = look()
    m.cycle(cycles - 2 * LOOKS * EVERY)
    after = look()
    done = int(m.h.ci[g.MCTOT]) - begun
    exact = Fraction(first) + done * Fraction(float(m.h.cr[g.TDEL]))
    moved = np.abs(m.table("contact")["KXC"].astype(float) - places).max()
    return [abs(float(Fraction(float(m.h.cd[g.TIME])) / exact - 1)), after / before - 1, float(moved)]


def turning(build: str, cycles: int) -> list[float]:
    """Errors of angular momentum and of the diagonal."""
    m, ib = two(build, 0.0)
    h = m.array.h
    putr(h, ib, g.KTD, 1e-3 / float(h.cr[g.TDEL]))
    corners = [int(row["address"]) for row in m.table("corner") if row["KNB"] == ib]

    def state() -> tuple[float, float]:
        x, y = (np.array([float(getr(m.array.h, ip, k)) for ip in corners]) for k in (g.KXP, g.KYP))
        return float(getr(m.array.h, ib, g.KBI)) * float(getr(m.array.h, ib, g.KTD)), float(
            np.hypot(x[:, None] - x, y[:, None] - y).max()
        )

    before = state()
    m.cycle(cycles)
    return [after / one - 1 for one, after in zip(before, state(), strict=True)]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cycles", type=int, default=10_000_000)
    parser.add_argument("--builds", nargs="+", choices=list(ALL_SCHEMES), default=list(ALL_SCHEMES))
    given = parser.parse_args()
    print("| scheme | TIME | energy | contacts, m | angular momentum | diagonal |\n|---|---|---|---|---|---|")
    for build in given.builds:
        start = process_time()
        cells = [*swinging(build, given.cycles), *turning(build, given.cycles)]
        print(f"| {build} | {' | '.join(f'{one:.1e}' for one in cells)} |", flush=True)
        print(f"{build}: {process_time() - start:.0f} s", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
