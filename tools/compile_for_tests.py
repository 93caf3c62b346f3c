"""Compile what the tests need, in all word schemes, before they begin: each routine once, some at a time.

    python tools/compile_for_tests.py 2

Two processes of the tests would both compile whatever they come to. Here a process takes a scheme and plays a
few of the random scenes of the tests; what it has compiled is kept where the tests look for it.
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import sys
from contextlib import chdir, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic

ROOT = Path(__file__).resolve().parent.parent
RIGID, SOFT, JOINTS, WATER = (0, 1, 2), (3, 24, 40), 45, range(4)  # random scenes of tests/support
STRUCTURES, CRACKS = 1, 5
OFTEN_USED = ("i32r32", "i32r64")  # in which the tests have joint laws and joint materials
LONGEST_FIRST = ("i32r64", "i64r64", "i32r32", "i16r32", "i16r64")  # so that none is left alone at the end
OUTLINES_IN, OF_A_WIDTH = "i32r64", ("i16r32", "i64r64")  # outlines are alike in all, lists by integers


def compile_for(build: str) -> str:
    """Play the scenes with the words of `build`, in a folder for their files; returns it."""
    with TemporaryDirectory() as folder, chdir(folder):
        _play(build)
    return build


def _play(build: str) -> None:
    sys.path.insert(0, str(ROOT / "tests"))
    logging.disable(logging.CRITICAL)
    from support import random_crack_scenes as crack_scenes
    from support import random_deformable_scenes as soft_scenes
    from support import random_joint_scenes as joint_scenes
    from support import random_scenes as scenes
    from support import random_structure_scenes as structure_scenes
    from support import random_water_scenes as water_scenes
    from support.mechanics_scenes import on_base

    from udec_ia import Model, UdecError
    from udec_ia.checker import check_links
    from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall

    InterpretWhenSmall.always_compiled = True
    rigid = [scenes.play(seed, Model(build), cycles=(2, 8)).model for seed in RIGID]
    soft = [soft_scenes.play(seed, Model(build), cycles=(2, 8)).model for seed in SOFT]
    for model in rigid[-1], soft[-1]:
        if build == OUTLINES_IN:
            model.check()
        elif build in OF_A_WIDTH:
            check_links(model.array)
    if build == OUTLINES_IN:  # as most tests of structures, cracks and water
        structure_scenes.play(STRUCTURES, Model(build), cycles=(2, 8))
        crack_scenes.play(CRACKS, Model(build), cycles=(2, 8))
        for seed in WATER:
            water_scenes.play_briefly(seed, lambda scene: scene.model.check())
    if build in OFTEN_USED:
        joint_scenes.play(JOINTS, Model(build), cycles=(2, 8))
        model = on_base(2.0, 1.0, 0.1, 12.0, law="joint-dilation", build=build)
        model.cycle(1)
        model.property(1, bulk=1e9, g=1e9)
        model.change(-99, 99, -99, 99, type="sdef")
        model.cycle(1)
    for model in rigid[-1], soft[-1]:
        with suppress(UdecError):  # a scene may have ended in one
            model.energy("on")
            for quantity in "unbalanced", "kinetic", "ratio":
                model.history(1, quantity)
            model.solve(1e-12, limit=20)
            model.solve(1e-12, limit=20, static=True)


def main() -> None:
    """Compile for all schemes in as many processes as the first argument says."""
    os.environ.setdefault("UDEC_CACHE", str(ROOT / ".udec_cache"))  # where tests/conftest.py has it
    start = monotonic()
    with multiprocessing.get_context("spawn").Pool(int(sys.argv[1]), maxtasksperchild=1) as pool:
        for build in pool.imap_unordered(compile_for, LONGEST_FIRST):
            print(f"{build} is ready after {monotonic() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
