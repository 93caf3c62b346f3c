"""One wall at lengths from 1e-6 to 1e9 m, and at offsets from the origin: is it the same wall?

    python docs/studies/length_and_mass_scales.py

Lengths: all lengths of a wall of 4 x 3 squares times 2^k, and gravity so that overlaps grow with them: every
real is then a power of two times what it was, and forces over the weight of a block are the same to the last
bit. Offsets: the wall at (a, a); its forces against those at the origin, in 64- and in 32-bit reals. Offsets
whose last digit is not small against the rounding length are refused (error 28).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT)]

from udec_ia import Model, UdecError

EXPONENTS = (-20, -10, 0, 10, 20, 30)
OFFSETS = (0.0, 1e3, 1e6, 1e9)
CYCLES = 2000


def forces(size: float, at: float = 0.0, build: str = "i32r64") -> np.ndarray:
    """Normal forces over the weight of a square, in the order of the contact list, after CYCLES cycles."""
    m = Model(build, out="/tmp")
    m.tell = m.inform = lambda _: None
    n, k = 4, 3
    m.property(1, density=2048, kn=2.0**30, ks=2.0**29, friction=0.5)
    m.gravity(0, -8 / size)  # so that overlaps are the same parts of the lengths
    m.round(size / 8)
    x, y = at + n * size, at + k * size
    m.block(at, at, at, y, x, y, x, at)
    for j in range(1, k):
        m.split(at - size, at + j * size, x + size, at + j * size)
    for i in range(1, n):
        m.split(at + i * size, at - size, at + i * size, y + size)
    m.fix(at - size, x + size, at, at + size)
    m.damping(local=0.8)
    m.cycle(CYCLES)
    return m.table("contact")["KCFN"].astype(float) / (2048 * 8 * size)


def main() -> None:
    """Print both tables."""
    right = forces(1.0)
    print("| length of an edge, m | forces |\n|---|---|")
    for k in EXPONENTS:
        found = forces(2.0**k)
        same = "the same bits" if np.array_equal(found, right) else f"{np.abs(found / right - 1).max():.1e}"
        print(f"| 2^{k} = {2.0**k:.3g} | {same} |", flush=True)
    print("\n| offset over edge | 64-bit reals | 32-bit reals |\n|---|---|---|")
    for at in OFFSETS:
        cells = []
        for build in ("i32r64", "i32r32"):
            try:
                found = forces(1.0, at, build)
                cells.append(f"{np.abs(found - right).max() / right.max():.1e}")
            except UdecError as error:
                cells.append(f"refused (error {error.number})")
        print(f"| {at:g} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
