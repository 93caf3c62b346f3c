"""What a rigid scene costs now and what it cost at an older commit: time, memory, and time to compile.

    python tools/since.py 757eec3

The commit is checked out beside this one. Both run the same slab of rigid blocks, at rest and moving so fast
that the domain pass runs in every cycle, in processes that take turns; and each runs the ball once with
nothing compiled. Printed are processor times, as medians, and words of IA() a block.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from typing import Any

ROOT = Path(__file__).parent.parent
TURNS = 5
SLAB = """
import json
from time import process_time
try:
    from udec_ia.layout.offsets import HTOL, KXD, MFREE, NBLK, NCON, TDEL
except ImportError:  # the older commit may have them elsewhere
    from offsets.generated import HTOL, KXD, MFREE, NBLK, NCON, TDEL
from udec_ia import Model
from udec_ia.heap.accessors import putr

def seconds(cycles):
    start = process_time()
    m.cycle(cycles)
    return (process_time() - start) * 1e9 / cycles / int(m.h.ci[NCON])

m, n = Model(), 100
m.start()
m.property(1, density=2000, kn=1e11, ks=1e11, friction=0.5)
m.gravity(0, -10)
m.damping(0.5, 10, "mass")
m.block(0, 0, 0, n, n, n, n, 0)
for i in range(1, n):
    m.split(-1, i, n + 1, i)
for i in range(1, n):
    m.split(i, -1, i, n + 1)
m.fix(-1, n, 0, 1)
m.cycle(200)
found = {"words of IA() a block": (int(m.h.ci[MFREE]) - 1) / int(m.h.ci[NBLK])}
found["at rest, ns a contact and cycle"] = seconds(200)
m.damping(0, 1)
m.free(-1, n + 1, -1, n + 1)
for ib in m.table("block")["address"]:
    putr(m.h, int(ib), KXD, float(2 * m.h.cr[HTOL] / m.h.cr[TDEL]))
m.cycle(2)
found["thrown, ns a contact and cycle"] = seconds(100)
print(json.dumps(found))
"""


def run(tree: Path, cache: Path, *arguments: str) -> str:
    """Run Python with the package in `tree`; returns what it printed."""
    env = {**os.environ, "PYTHONPATH": str(tree), "UDEC_CACHE": str(cache)}
    return subprocess.run(
        [sys.executable, *arguments], cwd=tree, env=env, check=True, stdout=subprocess.PIPE, text=True
    ).stdout


def first_ball(tree: Path, cache: Path) -> float:
    """Processor time in s of the ball with nothing compiled, which leaves its kernels in `cache`."""
    before = os.times()
    run(tree, cache, "-m", "udec_ia", "run", "examples/ball-rolling.dat", "--out", str(cache / "ball"))
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def compare(before: Path, caches: Path) -> dict[str, list[float]]:
    """The figures of the tree `before` and of this one, by name."""
    trees = {before: caches / "before", ROOT: caches / "now"}
    found: dict[str, list[float]] = {"the ball with nothing compiled, s": []}
    for tree, cache in trees.items():
        found["the ball with nothing compiled, s"].append(first_ball(tree, cache))
        run(tree, cache, "-c", SLAB)
    turns: dict[Path, list[Any]] = {tree: [] for tree in trees}
    for _ in range(TURNS):
        for tree, cache in trees.items():
            turns[tree].append(json.loads(run(tree, cache, "-c", SLAB)))
    for name in turns[ROOT][0]:
        found[name] = [median(turn[name] for turn in turns[tree]) for tree in trees]
    return found


def main() -> None:
    """Print one line for each figure."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        before = Path(folder) / "before"
        git = ["git", "-C", str(ROOT), "worktree"]
        subprocess.run([*git, "add", "--quiet", "--detach", str(before), sys.argv[1]], check=True)
        try:
            found = compare(before, Path(folder))
        finally:
            subprocess.run([*git, "remove", "--force", str(before)], check=True)
    print(f"| a rigid slab of 10,000 blocks | {sys.argv[1]} | now | ratio |\n|---|---|---|---|")
    for name, (old, new) in found.items():
        print(f"| {name} | {old:.1f} | {new:.1f} | {new / old:.2f} |")


if __name__ == "__main__":
    main()
