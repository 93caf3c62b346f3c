"""What numbers may be: the array limits of Appendix III-2 and the widths of the word scheme."""

from __future__ import annotations

import math

from offsets import read_table
from udec_ia.errors import UdecError

NMAT = next(field.count for field in read_table().common if field.name == "AKN")
NCONS = 5


def material_number(n: int) -> int:
    """`n` if it is a material number, else error 4."""
    if not 1 <= n <= NMAT:
        raise UdecError(4, f"{n}", f"material numbers run from 1 to {NMAT}")
    return n


def constitutive_number(n: int) -> int:
    """`n` if it is a constitutive number, else error 9."""
    if not 1 <= n <= NCONS:
        raise UdecError(9, f"{n}", f"constitutive numbers run from 1 to {NCONS}")
    return n


def finite(*values: float) -> None:
    """Error 28 unless all values are finite numbers."""
    for value in values:
        if not math.isfinite(value):
            raise UdecError(28, f"{value} is not a finite number")


def not_negative(name: str, value: float) -> float:
    """`value` if it is finite and not negative, else error 28."""
    finite(value)
    if value < 0:
        raise UdecError(28, f"{name} must not be negative, it is {value:g}")
    return value
