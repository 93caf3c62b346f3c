"""What a rigid scene costs now and what it cost at an older commit: time, memory, and time to compile.

    python tools/since.py 757eec3

The commit is checked out beside this one. Both run the same slab of rigid blocks, at rest and moving so fast
that the domain pass runs in every cycle: two processes take turns of half a second, and the ratio is the
median of those of the turns, so that what else the machine does falls on both. Several pairs of processes do
so, for where a process has its memory matters, too. And each runs the ball with nothing compiled, by turns,
without its pictures: how often these are written has changed, and is no matter of compiling.
Printed are processor times, as medians, and words of IA() a block.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

ROOT = Path(__file__).parent.parent
PAIRS = 4  # of processes
BALLS = 5  # of each tree, by turns
TURNS = 9  # of each process, in each of the two states
SLAB = """
import json
import sys
from time import process_time
try:
    from udec_ia.layout.offsets import HTOL, KXD, MFREE, NBLK, NCON, TDEL
except ImportError:  # the older commit may have them elsewhere
    from offsets.generated import HTOL, KXD, MFREE, NBLK, NCON, TDEL
from udec_ia import Model
from udec_ia.heap.accessors import putr

def turns(name, cycles):
    for line in sys.stdin:
        if line == "next\\n":
            return
        start = process_time()
        m.cycle(cycles)
        ns = (process_time() - start) * 1e9 / cycles / int(m.h.ci[NCON])
        print(json.dumps([name, ns]), flush=True)

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
print(json.dumps(["words of IA() a block", (int(m.h.ci[MFREE]) - 1) / int(m.h.ci[NBLK])]), flush=True)
turns("at rest, ns a contact and cycle", 200)
m.damping(0, 1)
m.free(-1, n + 1, -1, n + 1)
for ib in m.table("block")["address"]:
    putr(m.h, int(ib), KXD, float(2 * m.h.cr[HTOL] / m.h.cr[TDEL]))
m.cycle(2)
turns("thrown, ns a contact and cycle", 200)
"""
BALL = "the ball with nothing compiled, s"


def start(tree: Path, cache: Path, *arguments: str) -> subprocess.Popen[str]:
    """Start Python with the package in `tree`."""
    env = {**os.environ, "PYTHONPATH": str(tree), "UDEC_CACHE": str(cache), "UDEC_AHEAD": "0"}
    pipe = subprocess.PIPE
    return subprocess.Popen(
        [sys.executable, *arguments], cwd=tree, env=env, stdin=pipe, stdout=pipe, text=True
    )


def first_ball(tree: Path, cache: Path) -> float:
    """Processor time in s of the ball with nothing compiled, which leaves its kernels in `cache`."""
    cache.mkdir()
    deck, lines = cache / "ball.dat", (ROOT / "examples" / "ball-rolling.dat").read_text().splitlines()
    deck.write_text("\n".join(line for line in lines if not line.startswith("PLOT")) + "\n")
    before = os.times()
    ball = start(tree, cache, "-m", "udec_ia", "run", str(deck), "--out", str(cache / "ball"))
    ball.communicate()
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def ask(slab: subprocess.Popen[str], what: str) -> tuple[str, float]:
    """The next figure of a process with a slab, by name, once it has been told `what`."""
    assert slab.stdin is not None
    assert slab.stdout is not None
    slab.stdin.write(what)
    slab.stdin.flush()
    name, value = json.loads(slab.stdout.readline())
    return name, value


def run_pair(trees: dict[Path, Path], found: dict[str, list[tuple[float, float]]]) -> None:
    """Add to `found` the figures of one process of each of the two trees."""
    slabs = [start(tree, cache, "-c", SLAB) for tree, cache in trees.items()]
    for what in ("", *(["turn\n"] * TURNS), *(["next\nturn\n"] + ["turn\n"] * (TURNS - 1))):
        (name, old), (_, new) = [ask(slab, what) for slab in slabs]
        found.setdefault(name, []).append((old, new))
    for slab in slabs:
        slab.communicate("next\n")


def compare(before: Path, caches: Path) -> dict[str, list[tuple[float, float]]]:
    """The figures of the tree `before` and of this one, by name."""
    balls = []
    for k in range(BALLS):
        trees = {before: caches / f"before-{k}", ROOT: caches / f"now-{k}"}
        old, new = (first_ball(tree, cache) for tree, cache in trees.items())
        balls.append((old, new))
    run_pair(trees, {})  # compiles what the slab needs beside
    found = {BALL: balls}
    for _ in range(PAIRS):
        run_pair(trees, found)
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
    for name, turns in found.items():
        old, new, ratio = (median(values) for values in zip(*((a, b, b / a) for a, b in turns), strict=True))
        print(f"| {name} | {old:.1f} | {new:.1f} | {ratio:.3f} |")


if __name__ == "__main__":
    main()
