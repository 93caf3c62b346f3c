"""Looks into a restart file load nothing that they do not use: to load numba takes longer than a look."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from support.random_scenes import play

from udec_ia import Model

ROOT = Path(__file__).parents[2]
LOOKS = """
import sys
from udec_ia.cli import main
for line in ("info a.h5", "dump a.h5", "what a.h5 1", "check a.h5", "diff a.h5 a.h5", "map a.h5",
             "convert a.h5 b.h5 --build i64r64", "renumber a.h5 c.h5", "patch a.h5 d.h5 FRAC=0.05"):
    assert main(line.split()) == 0, line
    assert not {"numba", "llvmlite", "matplotlib"} & {*sys.modules}, line
"""


def test_no_look_loads_what_compiles_or_draws(tmp_path: Path) -> None:
    play(1, Model(out=tmp_path), cycles=(2, 3)).model.save(tmp_path / "a.h5")
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", LOOKS], env=env, cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
