"""What each part of the compilation of kernels gains: the same command with it and without it.

    python tools/bench.py gains
    python tools/bench.py gains linking --turns 1

Each line is a command that runs with one part left out, against the same command with all of them. Cold runs
begin with nothing compiled. Times are user CPU times of whole processes, as medians. docs/compiling.md
describes the parts.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

ROOT = Path(__file__).parents[2]
BALL = ["run", str(ROOT / "examples" / "ball-rolling.dat"), "--out", "out"]
COLD, WARM, CHECK = "cold run of the ball", "warm run of the ball", "check of a small file"
CYCLES = "600 cycles of 160,000 blocks"
START = "import sys\nfrom udec_ia.cli import main\n{change}\nsys.exit(main(sys.argv[1:]))\n"
SLAB = """
from udec_ia import Model
m, n = Model(), {n}
m.property(1, density=2000, kn=1e11, ks=1e11, friction=0.5)
m.gravity(0, -10)
m.damping(0.5, 10, "mass")
m.block(0, 0, 0, n, n, n, n, 0)
for i in range(1, n):
    m.split(-1, i, n + 1, i)
for i in range(1, n):
    m.split(i, -1, i, n + 1)
m.fix(-1, n, 0, 1)
m.save("slab.h5")
"""
SLABS = {CHECK: 4, CYCLES: 400}  # blocks along a side
COMMANDS = {
    COLD: BALL,
    WARM: BALL,
    CHECK: ["check", "slab.h5"],
    CYCLES: ["run", "cycles.dat"],
}
PARTS = {  # of each: the command, what leaves it out, and the environment that does
    "linking": (COLD, "", {"UDEC_LINK": "plain"}),
    "no search for closures": (
        COLD,
        "from udec_ia.compiling import kernel_linking\nkernel_linking.NOT_IN_KERNELS = ()",
        {},
    ),
    "cached signatures": (
        COLD,
        "from udec_ia.compiling import kernel_linking as k\nk._CachedSignatures = lambda context: context",
        {},
    ),
    "rare collections": (
        COLD,
        "from udec_ia.compiling import compile_duration\ncompile_duration.RARELY = 10",
        {},
    ),
    "outlined calls": (
        COLD,
        "from udec_ia.compiling import non_inlined_calls as o\nfrom udec_ia.kernels.drive import cycle\n"
        "cycle.entry_if = lambda wanted, kernel, *args: o.entry(kernel, *args)",
        {},
    ),
    "code cache": (
        WARM,
        "import shutil, os\nshutil.rmtree(os.environ['UDEC_CACHE'], ignore_errors=True)",
        {},
    ),
    "cache without compiler": (
        WARM,
        "from numba.core.caching import FunctionCache\nfrom udec_ia.compiling import code_cache\n"
        "code_cache._Cache.load_overload = FunctionCache.load_overload",
        {},
    ),
    "interpreting when small": (
        CHECK,
        "from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall\n"
        "InterpretWhenSmall.always_compiled = True",
        {},
    ),
    "prefetch": (
        CYCLES,
        "from udec_ia.compiling import kernel_memory as k\nfrom udec_ia.compiling.build_choice import *\n"
        "def fetch(h, iad, nv, beyond=0):\n    pass\n"
        "k.fetch = numba_form(JITABLE)(fetch)",
        {},
    ),
    "numba loaded when needed": (CHECK, "from udec_ia.compiling.build_choice import load\nload()", {}),
}


def seconds(command: list[str], change: str, env: dict[str, str], folder: Path) -> float:
    """User CPU time in s of `udec` with the arguments `command`, after the lines `change`."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(
        [sys.executable, "-c", START.format(change=change), *command],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), **env},
        check=True,
        capture_output=True,
    )
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def measure(name: str, parts: list[str], turns: int, folder: Path) -> dict[str, float]:
    """Median times in s of the command `name`: with all parts (""), and without each of `parts`."""
    if name in SLABS:
        seconds([], f"exec({SLAB.format(n=SLABS[name])!r})", {}, folder)
        (folder / "cycles.dat").write_text("RESTART slab.h5 UNCHECKED\nCYCLE 600\n")
    times: dict[str, list[float]] = {part: [] for part in ("", *parts)}
    for turn in range(turns + (name != COLD)):  # the first turn of a warm command compiles
        for part, of_part in times.items():
            cache = folder / f"cache {part}"
            if name == COLD:
                shutil.rmtree(cache, ignore_errors=True)
            _, change, env = PARTS[part] if part else ("", "", {})
            time = seconds(
                COMMANDS[name], change, {"UDEC_CACHE": str(cache), "UDEC_AHEAD": "0", **env}, folder
            )
            if name == COLD or turn:
                of_part.append(time)
    return {part: median(of_part) for part, of_part in times.items()}


def main() -> None:
    """Print a line for each part."""
    parser = argparse.ArgumentParser(prog="bench.py gains", description="What each part of compiling gains.")
    parser.add_argument("parts", nargs="*", help=f"by default all of: {', '.join(PARTS)}")
    parser.add_argument("--turns", type=int, default=3)
    args = parser.parse_args()
    print("| part | command | without it, s | with it, s | gain, s |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in COMMANDS:
            parts = [part for part in args.parts or PARTS if PARTS[part][0] == name]
            times = measure(name, parts, args.turns, Path(folder)) if parts else {}
            for part in parts:
                without, with_it = times[part], times[""]
                print(
                    f"| {part} | {name} | {without:.2f} | {with_it:.2f} | {without - with_it:.2f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
