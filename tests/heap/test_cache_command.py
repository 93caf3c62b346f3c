"""The cache of machine code: what `udec cache` does, and that two processes do not compile the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.compiling.build_choice import CHECKED, DISABLED
from udec_ia.compiling.code_cache import CodeFile
from udec_ia.compiling.second_compiler import compile_kernels, find_kernels
from udec_ia.kernels.geometry.block_shape import geo, makeb

pytestmark = pytest.mark.skipif(DISABLED or CHECKED, reason="nothing is compiled, or in another way")


def test_kernels_that_python_calls_are_found_without_compiling(tmp_path: Path) -> None:
    m = Model("i16r64", out=tmp_path)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    ib = int(m.table("block")["address"][0])
    calls = find_kernels(lambda: makeb(m.h, ib, np.float64(2000.0)))
    assert [kernel.py_func.__name__ for kernel, _ in calls] == ["makeb"]  # and not what it calls
    assert geo not in [kernel for kernel, _ in calls]
    assert m.table("block")["KBM"][0] == 2000.0
    compile_kernels(calls)
    assert compile_kernels(calls) == 0


def test_a_kernel_that_another_process_compiles_is_not_needed(tmp_path: Path) -> None:
    kernel = makeb.dispatcher
    file = CodeFile(str(tmp_path), "makeb", None)
    cache = kernel._cache
    before, cache._cache_file = cache._cache_file, file
    try:
        types: Any = next(iter(kernel.overloads))
        assert cache.is_needed(types, kernel.targetctx)
        lock = file.lock(cache._index_key(types, kernel.targetctx.codegen()))
        with lock:
            assert not cache.is_needed(types, kernel.targetctx)
        assert cache.is_needed(types, kernel.targetctx)
    finally:
        cache._cache_file = before


def test_size_and_clear(tmp_path: Path) -> None:
    folder = tmp_path / "0123-numba1.2.3" / "map"
    folder.mkdir(parents=True)
    (folder / "a.nbc").write_bytes(bytes(3_000_000))
    (tmp_path / "mine.txt").write_text("stays")
    env = {**os.environ, "UDEC_CACHE": str(tmp_path)}

    def udec(*words: str) -> str:
        command = [sys.executable, "-m", "udec_ia", "cache", *words]
        return subprocess.run(command, env=env, check=True, capture_output=True, text=True).stdout

    assert udec("size").splitlines()[2].split() == ["0123-numba1.2.3", "1", "3"]
    assert "1 folder" in udec("clear")
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_a_damaged_file_counts_as_missing(tmp_path: Path) -> None:
    file, key = CodeFile(str(tmp_path), "makeb", None), ("types", 1)
    file.save(key, b"machine code" * 100)
    assert file.load(key) == b"machine code" * 100
    (path,) = tmp_path.iterdir()
    content = path.read_bytes()
    middle = len(content) // 2
    for damaged in (b"", content[:middle], content[:middle] + b"?" + content[middle + 1 :], bytes(50)):
        path.write_bytes(damaged)
        assert file.load(key) is None


ONE_KERNEL = """
import numpy as np
from udec_ia import Model
from udec_ia.kernels.geometry.block_shape import makeb

m = Model()
m.block(0, 0, 0, 1, 1, 1, 1, 0)
makeb.dispatcher(m.h, int(m.table("block")["address"][0]), np.float64(2000.0))
print(m.table("block")["KBM"][0])
"""


@pytest.mark.parametrize("place", ["/dev/null/nowhere", "file"])
def test_a_folder_that_cannot_be_written_is_reported_once(place: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    env = {**os.environ, "UDEC_CACHE": str(tmp_path / place), "UDEC_AHEAD": "0"}
    done = subprocess.run(
        [sys.executable, "-c", ONE_KERNEL], env=env, capture_output=True, text=True, check=True, timeout=300
    )
    assert done.stdout == "2000.0\n"
    assert done.stderr.count("UDEC_CACHE") == 1
    if place == "file":
        refused = subprocess.run(
            [sys.executable, "-m", "udec_ia", "cache", "size"], env=env, capture_output=True, text=True
        )
        assert refused.returncode == 1
        assert "is no folder" in refused.stderr


def test_an_empty_variable_is_none() -> None:
    code = "from udec_ia.compiling.cache_folder import cache_home; print(cache_home().is_absolute())"
    env = {**os.environ, "UDEC_CACHE": ""}
    assert (
        subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, check=True).stdout
        == b"True\n"
    )
