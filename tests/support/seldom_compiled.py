"""Runs in word schemes in which no other test compiles the same kernels: as Python, to the same bits."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from udec_ia.compiling.interpreted_kernels import interpreted

COMPILED = ("i32r32", "i32r64")  # kernels of joints, structures and laws; tools/compile_for_tests.py


@contextmanager
def compiled_if_usual(build: str) -> Iterator[None]:
    """Within, kernels are compiled if other tests need them in this scheme too, and else run as Python."""
    if build in COMPILED:
        yield
        return
    with interpreted():
        yield
