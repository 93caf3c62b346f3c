"""How long a user waits for the compiler: the first run of each feature, and the same run a second time.

    python tools/bench.py first

The first line begins with nothing compiled; the others with what the first one has left, so that they show
what a deck compiles that takes up one thing more. Times are processor time of the whole process.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[2]
SCENE = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E8 G=5E7
ROUND 0.1
BLOCK {block} 0,0 0,2 2,2 2,0
SPLIT -1,1 3,1
FIX 0,2 0,1
GRAVITY 0 -10
DAMPING 0.5 10 MASS
{change}
{run}
STOP
"""
CYCLE = "CYCLE 20"
GENERATE = "GENERATE 0,2 1,2 AUTOMATIC EDGE 0.5"
FEATURES = {  # option of the block, command before the run, the run
    "rigid blocks": ("", "", CYCLE),
    "simply-deformable blocks": ("", "CHANGE 0,2 1,2 SDEF", CYCLE),
    "fully-deformable blocks": ("", GENERATE, CYCLE),
    "a law for joints": ("CONS=2", "", CYCLE),
    "SOLVE": ("", "", "SOLVE 0.01"),
    "HISTORY": ("", "HISTORY 10 UNBALANCED", CYCLE),
    "ENERGY": ("", "ENERGY ON", CYCLE),
}


def seconds(deck: str, cache: Path, folder: Path) -> float:
    """Processor time of `udec run` with the text `deck`, in s."""
    path = folder / "first.dat"
    path.write_text(deck)
    command = [sys.executable, "-m", "udec_ia", "run", str(path), "--out", str(folder)]
    env = {**os.environ, "UDEC_CACHE": str(cache), "UDEC_AHEAD": "0"}
    before = os.times()
    subprocess.run(
        [*command, "--constitutive", "joint-dilation"], cwd=ROOT, env=env, check=True, capture_output=True
    )
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def main() -> None:
    """Run all decks, each on the cache that the first one has left."""
    print("| a deck with | first run, s | again, s |\n|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for number, (feature, (block, change, run)) in enumerate(FEATURES.items()):
            cache = folder / str(number)
            if number:
                shutil.copytree(folder / "0", cache)
            deck = SCENE.format(block=block, change=change, run=run)
            first, again = seconds(deck, cache, folder), seconds(deck, cache, folder)
            print(f"| {feature} | {first:.1f} | {again:.1f} |", flush=True)
