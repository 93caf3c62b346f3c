"""Limits of numbers: the array limits of Appendix III-2 and the widths of the word scheme.

Numbers are passed by their names in HELP and in Python. So an error names the number and has its place.
"""

from __future__ import annotations

import operator
from collections.abc import Iterable
from numbers import Real
from typing import Any, SupportsIndex

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.field_table import read_table
from udec_ia.printable_text import counted

NMAT = next(field.count for field in read_table().common if field.name == "AKN")
NCONS = next(
    field.allowed[0][1] or 0 for field in read_table().group("block").fields if field.name == "KCONS"
)
LARGEST = 2**63 - 1  # integer of the common block

# Least length of an edge and of a rounding length in last digits of a coordinate. Without ROUND the rounding
# length is at least a twentieth of an edge. FTOL, a twentieth of that and the least length that decides about
# a contact, is then 25 digits, as is the radius of a corner of 6 degrees; of the sharpest corner of SPLIT,
# 2.5.
EDGE_DIGITS = 1e4
ROUNDING_DIGITS = EDGE_DIGITS / 20


class AfterChangesError(UdecError):
    """An error that a command finds after it has changed words: all of it is undone."""


def material_number(n: int) -> int:
    """`n` if it is a material number, else error 4."""
    if not 1 <= whole(material=n) <= NMAT:
        raise UdecError(4, f"{n}", f"material numbers run from 1 to {NMAT}", parameter="material")
    return n


def constitutive_number(n: int) -> int:
    """`n` if it is a constitutive number, else error 9."""
    if not 1 <= whole(constitutive=n) <= NCONS:
        raise UdecError(9, f"{n}", f"constitutive numbers run from 1 to {NCONS}", parameter="constitutive")
    return n


def whole(**number: SupportsIndex) -> int:
    """The only number given. Error 10 unless it is an integer, 28 if it is too large."""
    ((name, value),) = number.items()
    try:
        integer = operator.index(value)
    except TypeError:
        detail = f"{value!r} is not an integer"
        raise UdecError(10, detail, f"{name} must be an integer", parameter=name) from None
    if abs(integer) > LARGEST:
        raise UdecError(28, f"{name} is {integer}", f"the largest integer is {LARGEST}", parameter=name)
    return integer


def real(**number: Any) -> Any:
    """The only number given. Error 10 unless it is a number."""
    ((name, value),) = number.items()
    if not isinstance(value, Real):
        raise UdecError(10, f"{value!r} is not a number", f"{name} takes numbers", parameter=name)
    return value


def reals(n: int, **row: Any) -> Any:
    """The only row given. Error 26 if it has fewer than `n` numbers, 10 if it is no row of `n` numbers."""
    ((name, value),) = row.items()
    numbers = _items(name, value, f"{n} numbers")
    if len(numbers) != n:
        detail = f"{name} has {counted(len(numbers), 'number')} in {value!r}"
        raise UdecError(26 if len(numbers) < n else 10, detail, f"{name} takes {n} numbers", parameter=name)
    return tuple(real(**{name: one}) for one in numbers)


def rows(n: int, **table: Any) -> list[Any]:
    """The only list given, of rows of `n` numbers; empty for None. Errors as `reals`."""
    ((name, value),) = table.items()
    return [reals(n, **{name: row}) for row in _items(name, () if value is None else value, "a list")]


def _items(name: str, value: Any, what: str) -> list[Any]:
    """The items of `value`; error 10 if it has none."""
    try:
        return list(value)
    except TypeError:
        raise UdecError(10, f"{value!r} is not {what}", f"{name} takes {what}", parameter=name) from None


def finite(array: MainArray, **numbers: float) -> None:
    """Error 28 unless all numbers are finite reals of the word scheme."""
    largest = float(np.finfo(array.scheme.real_type).max)
    for name, value in numbers.items():
        if not abs(real(**{name: value})) <= largest:
            advice = f"{array.scheme.real_bits}-bit reals store numbers up to {largest:.2g}"
            raise UdecError(28, f"{name} is {value:g}", advice, parameter=name)


def check_real_range(array: MainArray, what: str, values: Iterable[float], bits: int | None = None) -> None:
    """Error 28 unless reals of so many bits can hold all calculated values; default: of the word scheme."""
    bits = bits or array.scheme.real_bits
    largest = float(np.finfo(f"f{bits // 8}").max)
    if not all(abs(value) <= largest for value in values):
        detail = f"{what} would be greater than {bits}-bit reals can hold"
        raise UdecError(28, detail, f"they end at {largest:.2g}")


def check_mass_range(array: MainArray, density: float, radius: float) -> None:
    """Error 28 unless the reals can hold mass and moment of inertia of a square of side 2 `radius`."""
    mass = density * 4 * radius * radius
    what = f"mass or moment of inertia at a density of {density:g}"
    check_real_range(array, what, [mass, mass * radius * radius])


def not_negative(array: MainArray, **numbers: float) -> None:
    """Error 28 unless all numbers are finite and not negative."""
    finite(array, **numbers)
    for name, value in numbers.items():
        if value < 0:
            raise UdecError(28, f"{name} is {value:g}", f"{name} must not be negative", parameter=name)


def positive(array: MainArray, **numbers: float) -> None:
    """Error 28 unless all numbers are finite and positive."""
    finite(array, **numbers)
    for name, value in numbers.items():
        if value <= 0:
            raise UdecError(28, f"{name} is {value:g}", f"{name} must be positive", parameter=name)


def last_digit(array: MainArray, size: float) -> float:
    """The resolution of coordinates where |x| + |y| is up to `size`."""
    return float(np.finfo(array.scheme.real_type).eps) * size


def check_resolution(
    array: MainArray, parameter: str, what: str, length: float, digits: float, size: float
) -> None:
    """Error 28 at `parameter` if `length` is less than so many last digits where |x| + |y| is `size`."""
    digit = last_digit(array, size)
    if length < digits * digit:
        detail = f"{what} {length:g} long, where {array.scheme.real_bits}-bit reals resolve {digit:g}"
        advice = f"it must be at least {digits * digit:g}: move the origin nearer, or use 64-bit reals"
        raise UdecError(28, detail, advice, parameter=parameter)
