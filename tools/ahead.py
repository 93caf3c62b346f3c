"""Compile what the tests need, in all word schemes, before they begin: each routine once, some at a time.

    python tools/ahead.py 2

Two processes of the tests would both compile whatever they come to. Here a process takes a scheme and plays a
few of the random scenes of the tests; what it has compiled is kept where the tests look for it.
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import sys
from pathlib import Path
from time import monotonic

ROOT = Path(__file__).parent.parent
RIGID, SOFT = (0, 1, 2), (3, 24, 40)  # scenes of tests/scenes.py, and of tests/soft_scenes.py


def compile_for(build: str) -> str:
    """Play the scenes with the words of `build`; returns it."""
    sys.path.insert(0, str(ROOT / "tests"))
    logging.disable(logging.CRITICAL)
    import scenes
    import soft_scenes

    from udec_ia import Model

    for module, seeds in ((scenes, RIGID), (soft_scenes, SOFT)):
        for seed in seeds:
            module.play(seed, Model(build), cycles=(2, 8))
    return build


def main() -> None:
    """Compile for all schemes in as many processes as the first argument says."""
    os.environ.setdefault("UDEC_CACHE", str(ROOT / ".udec_cache"))  # where tests/conftest.py has it
    from udec_ia.heap.words import ALL_SCHEMES

    start = monotonic()
    with multiprocessing.get_context("spawn").Pool(int(sys.argv[1]), maxtasksperchild=1) as pool:
        for build in pool.imap_unordered(compile_for, ALL_SCHEMES):
            print(f"{build} is ready after {monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
