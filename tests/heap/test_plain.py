"""Without our own linking of kernels, and on a numba on which it was not tried, all goes on the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from numba.core import config

from udec_ia.heap import plain

ROOT = Path(__file__).parents[2]
RUN = """
import logging, sys
from hashlib import sha256
logging.basicConfig(level=logging.WARNING, stream=sys.stdout, format="%(message)s")
from udec_ia import Model
from udec_ia.heap.apart import entry
from udec_ia.heap.jit import apart
from udec_ia.kernels.drive import passes

@apart
def nothing_there(h, domain):
    "The update of domains, which takes two thirds of the time to compile: a lone block finds nothing."
    return True

passes.updating = lambda h: entry(nothing_there, h, 0)
m = Model()
m.block(0, 0, 0, 1, 1, 1, 1, 0)
m.property(1, density=2000, kn=1e8, ks=1e8)
m.gravity(0, -10)
m.rset(0.5, int(m.table("block")["address"][0]), 7)
m.cycle(3)
print(sha256(m.array.h.ia.tobytes() + m.array.h.cr.tobytes()).hexdigest(), m.check())
"""


def run(tmp_path: Path, **more: str) -> list[str]:
    """The lines that RUN prints."""
    env = {**os.environ, "PYTHONPATH": str(ROOT), **more}
    script = tmp_path / "run.py"
    script.write_text(RUN)
    done = subprocess.run(
        [sys.executable, str(script)], env=env, cwd=tmp_path, check=True, stdout=subprocess.PIPE
    )
    return done.stdout.decode().splitlines()


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_the_same_words_without_linking(tmp_path: Path) -> None:
    """Commands and cycles. Who waits is told once, and the second time nothing is compiled."""
    linked = run(tmp_path)[-1]
    place = {"UDEC_LINK": "plain", "UDEC_CACHE": str(tmp_path / "cache")}
    first, again = run(tmp_path, **place), run(tmp_path, **place)
    assert first[-1] == again[-1] == linked
    assert first[:-1] == ["compiling once for this machine, up to a minute ..."]
    assert again[:-1] == []
    (folder,) = (tmp_path / "cache").iterdir()
    assert folder.name.removesuffix("-checked").endswith("-plain")


@pytest.mark.parametrize(
    ("release", "is_wanted"),
    [("0.60.0", True), ("0.61.0", False), ("0.68.1", False), ("0.69.0dev0", True), ("1.0.0", True)],
)
def test_a_release_that_was_not_tried_is_not_built_upon(
    release: str, is_wanted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("UDEC_LINK", raising=False)
    monkeypatch.setattr(numba, "__version__", release)
    assert plain.wanted() == is_wanted
    monkeypatch.setenv("UDEC_LINK", "plain")
    assert plain.wanted()
