"""The Python face of the program: one Model, with a method for every command of the deck language.

A Model owns one main array. Every method below does what the command of the same name does, takes the
numbers that the command takes, and raises UdecError with the number that the command would print.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from udec_ia.heap.accessors import Memory
from udec_ia.heap.array import MainArray
from udec_ia.heap.words import DEFAULT_SCHEME, scheme


class Model:
    """A block system and everything that was done to it.

    build: word scheme, "i16r32", "i32r32", "i16r64", "i32r64" or "i64r64".
    mtop: size of IA() in words, fixed as in 1980; None lets the array grow as needed.
    out: folder for restart files and plots; made when the first file is written.
    """

    def __init__(self, build: str = DEFAULT_SCHEME, mtop: int | None = None, out: str | Path = ".") -> None:
        self.array = MainArray(scheme(build), mtop)
        self.mtop = mtop
        self.out = Path(out)

    @property
    def h(self) -> Memory:
        """The memory that the compiled routines work on (changes identity when the array grows)."""
        return self.array.h
