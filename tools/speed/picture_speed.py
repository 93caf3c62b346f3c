"""How long pictures take: those of the ball, and of a slab with many blocks.

    python tools/bench.py pictures [--blocks 50000]

The ball is examples/ball-rolling.dat, run with its PLOTs and without in turns; the difference is the time of
its pictures, with the import of matplotlib. Of the slab each picture is drawn and written as PNG and SVG. Its
blocks are simply-deformable, and have moved. Compilation does not count.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

from speed.cycle_speed import FAR, ROOT, slab

BALL = ROOT / "examples" / "ball-rolling.dat"
TURNS = 5
WORDS = ("", "CONTACTS", "VELOCITIES", "DISPLACEMENTS", "STRESSES", "S22", "MOVEMENT", "SLIP", "SAFETY")


def bench_ball() -> None:
    """The pictures of the ball from the command line."""
    print("| ball-rolling.dat | s of wall time | s of processor time |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        bare = Path(folder) / "ball.dat"
        bare.write_text("".join(line for line in BALL.open() if not line.startswith("PLOT")))
        taken: dict[Path, list[tuple[float, float]]] = {BALL: [], bare: []}
        for turn in range(TURNS + 1):
            for deck, times in taken.items():
                start, before = perf_counter(), os.times()
                command = [sys.executable, "-m", "udec_ia", "run", str(deck), "--out", folder]
                subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
                wall, after = perf_counter() - start, os.times()
                cpu = after.children_user - before.children_user
                times += [(wall, cpu + after.children_system - before.children_system)] * (turn > 0)
        for name, deck in (("with pictures", BALL), ("without", bare)):
            print(
                f"| {name} | {' | '.join(f'{median(one):.2f}' for one in zip(*taken[deck], strict=True))} |"
            )


def bench_slab(blocks: int) -> None:
    """Pictures of a slab."""
    print("\n| PLOT | blocks | s of processor time |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for n in (100, blocks):  # the first compiles
            model = slab(n)
            model.session.out, model.tell, model.inform = Path(folder), lambda _: None, lambda _: None
            model.property(1, bulk=1e9, g=6e8)
            model.fix(-FAR, FAR, 0, 1)
            model.change(-FAR, FAR, -FAR, FAR, type="sdef")
            model.reset("displacements")
            model.cycle(5)
            for word in WORDS:
                start = process_time()
                model.run(f"PLOT 0 {word}\n")
                took = process_time() - start
                if n == blocks:
                    print(f"| {word} | {len(model.table('block'))} | {took:.1f} |", flush=True)


def main() -> None:
    """Run both."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--blocks", type=int, default=50_000)
    args = parser.parse_args()
    bench_ball()
    bench_slab(args.blocks)
