"""Machine code on disk: what is found for given types is what was compiled for them, or nothing."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba.core import config

from udec_ia.compiling.code_cache import CodeFile
from udec_ia.compiling.kernel_decorators import kernel

ROOT = Path(__file__).parents[2]
SIGNATURES = [("int32", "float64"), ("int64", "float64")]


def code_file(folder: Path) -> CodeFile:
    return CodeFile(str(folder), "twice-1.py311", None)


def test_what_is_kept_is_found_by_its_types(tmp_path: Path) -> None:
    """Two processes that know nothing of one another keep code for different types."""
    one, two = code_file(tmp_path), code_file(tmp_path)
    assert one.load(SIGNATURES[0]) is None
    one.save(SIGNATURES[0], b"narrow")
    two.save(SIGNATURES[1], b"wide")
    for reader in (one, two, code_file(tmp_path)):
        assert [reader.load(key) for key in SIGNATURES] == [b"narrow", b"wide"]
    two.save(SIGNATURES[0], b"narrow again")
    assert one.load(SIGNATURES[0]) == b"narrow again"


def test_code_for_other_types_is_not_taken(tmp_path: Path) -> None:
    """Even if its file should have the name of ours."""
    cache = code_file(tmp_path)
    for key in SIGNATURES:
        cache.save(key, key)
    names = sorted(tmp_path.iterdir())
    assert len(names) == 2
    shutil.copy(names[0], names[1])
    found = [cache.load(key) for key in SIGNATURES]
    assert sorted(found, key=str) == sorted([None, next(key for key in found if key)], key=str)


def thrice(x: Any) -> Any:
    return x * 3


COPY = """
import sys
sys.path.insert(0, sys.argv[1])
from udec_ia.heap.word_scheme import scheme
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.geometry.tolerances import tolset
tolset(MainArray(scheme("i32r64")).h, 0.1)
assert tolset.__wrapped__.__code__.co_filename.startswith(sys.argv[1])
print(sum(tolset.dispatcher.stats.cache_hits.values()))
"""


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_a_copy_of_the_program_in_another_folder_does_not_compile_again(tmp_path: Path) -> None:
    """The cache is named by what the sources say, not by where they stand."""
    environment = {**os.environ, "UDEC_CACHE": str(tmp_path / "cache")}
    for hits, name in enumerate(("one", "two")):
        for package in ("udec_ia", "offsets"):
            shutil.copytree(ROOT / package, tmp_path / name / package)
        command = [sys.executable, "-c", COPY, str(tmp_path / name)]
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, check=True, timeout=240
        )
        assert int(done.stdout) == hits


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_a_second_process_does_not_compile_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A kernel that was compiled before is read from its file, one for each type."""
    monkeypatch.setattr("udec_ia.compiling.cache_folder.cache_folder", lambda: tmp_path)
    for hits in (0, 1):
        compiled: Any = kernel(thrice)
        for number in (np.int32(2), np.float64(2)):
            assert compiled(number) == 6
            assert sum(compiled.dispatcher.stats.cache_hits.values()) == hits * (
                1 + isinstance(number, float)
            )
    assert len([*tmp_path.rglob("*.nbc")]) == 2


TWICE = """
import sys
from udec_ia.compiling.kernel_decorators import kernel
@kernel
def twice(x: float) -> float:
    return x + x
print(twice(2.0), "numba.np.npyimpl" in sys.modules)
"""


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_what_is_kept_runs_without_what_compiles(tmp_path: Path) -> None:
    """numba makes ready to compile, which takes a while, only where there is nothing yet."""
    environment = {**os.environ, "UDEC_CACHE": str(tmp_path / "cache"), "PYTHONPATH": str(ROOT)}
    (tmp_path / "script.py").write_text(TWICE)
    printed = [
        subprocess.run(
            [sys.executable, str(tmp_path / "script.py")],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
            timeout=120,
        ).stdout
        for _ in range(2)
    ]
    assert printed == ["4.0 True\n", "4.0 False\n"]
