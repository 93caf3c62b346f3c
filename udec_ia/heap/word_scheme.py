"""Word schemes: how wide an integer and a real of IA() are (report 3.5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.layout.field_table import SCHEMES


@dataclass(frozen=True)
class Scheme:
    """One pair of word widths. `ratio` is the number of integers in the space of one real."""

    name: str
    int_bits: int
    real_bits: int

    @property
    def ratio(self) -> int:
        return self.real_bits // self.int_bits

    @property
    def int_type(self) -> np.dtype[Any]:
        return np.dtype(f"i{self.int_bits // 8}")

    @property
    def real_type(self) -> np.dtype[Any]:
        return np.dtype(f"f{self.real_bits // 8}")

    @property
    def top_address(self) -> int:
        """The largest address that an integer of the scheme can hold, hence the longest heap."""
        return 2 ** (self.int_bits - 1) - 1


ALL_SCHEMES = {name: Scheme(name, *bits) for name, bits in SCHEMES.items()}
DEFAULT_SCHEME = "i32r64"


def scheme(name: str) -> Scheme:
    """The scheme called `name`; ValueError that lists the names if there is none."""
    if name not in ALL_SCHEMES:
        raise ValueError(f"unknown word scheme {name!r}: choose one of {', '.join(ALL_SCHEMES)}")
    return ALL_SCHEMES[name]
