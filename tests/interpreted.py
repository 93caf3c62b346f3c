"""A random scene, compiled and interpreted: what the main array holds at its end, as a digest."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

PRINT_STATE = """
import hashlib, importlib, sys
sys.path[:0] = sys.argv[4:]
from naive.relocate import essence
from udec_ia.model import Model
play = importlib.import_module(sys.argv[1]).play
state = essence(play(int(sys.argv[3]), Model(sys.argv[2]), cycles=(2, 4)).model.array)
digest = hashlib.sha256()
for name, value in state.items():
    digest.update(name.encode() + (value.tobytes() if hasattr(value, "tobytes") else str(value).encode()))
print(digest.hexdigest())
"""


def digests(scenes: str, build: str, seed: int) -> tuple[str, str]:
    """That of the scene `seed` of the module `scenes`, compiled and then interpreted."""
    arguments = [sys.executable, "-W", "ignore", "-c", PRINT_STATE, scenes, build, str(seed)]
    compiled, interpreted = (
        subprocess.run(
            [*arguments, str(Path(__file__).parent)],
            env=os.environ | {"NUMBA_DISABLE_JIT": disabled},
            capture_output=True,
            text=True,
            timeout=600,
            check=True,
        ).stdout
        for disabled in ("0", "1")
    )
    return compiled, interpreted
