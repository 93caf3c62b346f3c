"""Without our own linking of kernels, and on a numba on which it was not tried, all goes on the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest
from numba.core import config

from udec_ia.compiling import build_choice

ROOT = Path(__file__).parents[2]
ALONE = ROOT / "tests" / "support" / "lone_block_script.py"


def run(tmp_path: Path, **more: str) -> list[str]:
    """The lines that tests/support/lone_block_script.py prints."""
    env = {**os.environ, "PYTHONPATH": str(ROOT), **more}
    python = [sys.executable, str(ALONE)]
    done = subprocess.run(python, env=env, cwd=tmp_path, check=True, stdout=subprocess.PIPE)
    return done.stdout.decode().splitlines()


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_the_same_words_without_linking(tmp_path: Path) -> None:
    """Commands, and cycles without the update of domains. Who waits is told; nothing is compiled twice."""
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
    assert build_choice.plain_wanted() == is_wanted
    monkeypatch.setenv("UDEC_LINK", "plain")
    assert build_choice.plain_wanted()
