"""Loose blocks: the cost of a cycle while they fly and while they pile up, and of a contact.

    python tools/bench.py loose --blocks 1000 10000

Flight and collisions: polygons of unit size, 1.5 apart, thrown in all directions without gravity. Piling:
the same fall into a box, from the first contacts with the floor on. The yardstick is the cycle of a packed
slab of unit squares. Times are processor time.
"""

from __future__ import annotations

import argparse
import math
from time import process_time

import numpy as np
from speed.cycle_speed import jointed

from udec_ia import Model
from udec_ia.layout.offsets import MCTOT, NMADE

PITCH, RADIUS, WALL = 1.5, 0.5, 1.0
FALL, CYCLES, FLIGHT = 10.0, 1000, 200


def polygon(rng: np.random.Generator, x: float, y: float) -> list[float]:
    """Coordinates of a polygon of 4 to 7 corners about (x, y), clockwise."""
    n = int(rng.integers(4, 8))
    angles = -2 * math.pi * (np.arange(n) + rng.uniform(-0.2, 0.2, n)) / n + rng.uniform(0, 2 * math.pi)
    return [c for t in angles for c in (x + RADIUS * math.cos(t), y + RADIUS * math.sin(t))]


def loose(blocks: int, boxed: bool) -> Model:
    """So many loose polygons in a square; boxed: above a floor between two walls."""
    rng = np.random.default_rng(1)
    side = math.ceil(math.sqrt(blocks))
    model, w = Model(), side * PITCH
    model.start()
    model.round(0.05)
    if boxed:
        model.block(-WALL, -WALL, -WALL, 0, w + WALL, 0, w + WALL, -WALL)
        model.block(-WALL, 0, -WALL, 2 * w, 0, 2 * w, 0, 0)
        model.block(w, 0, w, 2 * w, w + WALL, 2 * w, w + WALL, 0)
        model.fix(-2 * WALL, w + 2 * WALL, -2 * WALL, 2 * w + 1)
    for k in range(blocks):
        i, j = k % side, k // side
        model.block(*polygon(rng, (i + 0.5) * PITCH, (j + 0.5) * PITCH))
    model.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5)
    if boxed:
        model.gravity(0, -10)
    else:
        for k in range(blocks):
            x, y = (k % side + 0.5) * PITCH, (k // side + 0.5) * PITCH
            vx, vy, spin = rng.normal(0, FALL / 2, 3)
            model.velocity(x - RADIUS, x + RADIUS, y - RADIUS, y + RADIUS, vx, vy, spin)
    model.cycle(1)
    return model


def measure(model: Model, cycles: int) -> tuple[float, int]:
    """Processor time of so many cycles, in s, and the contacts that were made in them."""
    made, start = int(model.h.ci[NMADE]), process_time()
    model.cycle(cycles)
    return process_time() - start, int(model.h.ci[NMADE]) - made


def bench(sizes: list[int]) -> None:
    """Print a table: a row for each number of blocks, times by block and cycle in microseconds."""
    print("| blocks | packed, us | flight, us | collisions, us | piling, us | us a contact made |")
    print("|---|---|---|---|---|---|")
    for blocks in sizes:
        packed = jointed(blocks, False)
        unit = 1e6 / blocks
        slab_time = measure(packed, CYCLES)[0] / CYCLES * unit
        gas = loose(blocks, False)
        gas.cycle(10)
        flight = measure(gas, FLIGHT)[0] / FLIGHT * unit
        gas.cycle(CYCLES)
        seconds, made = measure(gas, 2 * CYCLES)
        collisions = seconds / (2 * CYCLES) * unit
        falling = loose(blocks, True)
        while falling.h.ci[MCTOT] < 10 * CYCLES and falling.h.ci[NMADE] < blocks:
            falling.cycle(CYCLES)
        piling = measure(falling, 2 * CYCLES)[0] / (2 * CYCLES) * unit
        times = f"{slab_time:.3f} | {flight:.3f} | {collisions:.3f} | {piling:.3f}"
        print(f"| {blocks} | {times} | {1e6 * seconds / max(made, 1):.0f} |", flush=True)


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(description="Measure the speed of loose blocks.")
    parser.add_argument("--blocks", type=int, nargs="+", default=[1000, 10_000])
    bench(parser.parse_args().blocks)


if __name__ == "__main__":
    main()
