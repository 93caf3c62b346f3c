"""The values that a variable takes in a study: ranges, lists, and the grid of several variables.

    0.3:0.9:7          seven values from 0.3 to 0.9 in equal steps
    1e6:1e9:4:log      four values, each the same number of times the one before
    0.1,0.2,0.5        these; they may be words, too

The steps of a range are worked out in fractions and rounded once, so 0.3:0.9:7 has 0.4 in it, and not
0.39999999999999997. A range of integers that has only integers in it gives integers.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from fractions import Fraction
from itertools import product
from typing import Any

from udec_ia.deck.deck_variables import NAME, Value, spelt
from udec_ia.errors import UdecError

DIGITS = 12  # of the values of a logarithmic range between its ends
LONGEST = 1_000_000  # values of a range
FORM = "a range is first:last:number, as in 0.3:0.9:7, or first:last:number:log; a list has commas"
GREATEST = int(sys.float_info.max)
Given = Value | Iterable[Value]


def values_of(name: str, given: Given) -> list[Value]:
    """The values of the variable `name`: one, several, or a text as above. ValueError for others."""
    if not (isinstance(name, str) and NAME.fullmatch(name)):
        raise ValueError(f"{name!r} is not the name of a variable: use a letter, then letters, digits and _")
    found: list[Value]
    if isinstance(given, str):
        texts = [part.strip() for part in given.split(",")]
        found = _range(name, given) if ":" in given else [_read(text) for text in texts]
    else:
        several = given if isinstance(given, Iterable) else [given]
        found = [one.item() if hasattr(one, "item") else one for one in several]
    if any(isinstance(one, int) and abs(one) > GREATEST for one in found):
        raise ValueError(f"{name} cannot be greater than {float(GREATEST):.2g}, which no real number is")
    try:
        spellings = [spelt(name, value) for value in found]
    except UdecError as error:
        raise ValueError(f"{error.detail}: {error.advice}") from error
    if not found:
        raise ValueError(f"{name} has no value")
    seen: set[Value] = set()
    for value, spelling in zip(found, spellings, strict=True):
        if value in seen or spelling in seen:  # 1000000 and 1e6 are one
            raise ValueError(f"{name} has the value {spelling} twice")
        seen |= {value, spelling}
    return found


def grid(values: Mapping[str, Given]) -> list[dict[str, Value]]:
    """All combinations of the values of several variables, the last of which changes first."""
    columns = [values_of(name, given) for name, given in values.items()]
    names = [name.upper() for name in values]
    if len({*names}) < len(names):
        raise ValueError(f"a variable is given twice: {', '.join(names)}")
    return [dict(zip(names, row, strict=True)) for row in product(*columns)]


def _range(name: str, text: str) -> list[Value]:
    first, *others = (part.strip() for part in text.split(":"))
    how = others.pop() if len(others) == 3 else ""
    try:
        last, number = others
        a, b, n = Fraction(first), Fraction(last), int(number)
        float(a), float(b)
    except (ValueError, OverflowError):
        raise ValueError(f"{name}={text}: {FORM}") from None
    if how not in ("", "log"):
        raise ValueError(f"{name}={text}: {how!r} is not a kind of range (log is one); {FORM}")
    if not 2 <= n <= LONGEST:
        raise ValueError(f"{name}={text}: a range has 2 to {LONGEST} values, not {n}")
    if how == "log":
        return _logarithmic(name, text, float(a), float(b), n)
    steps = [a + (b - a) * k / (n - 1) for k in range(n)]
    whole = all(isinstance(_read(end), int) for end in (first, last)) and all(
        s.denominator == 1 for s in steps
    )
    return [int(step) if whole else float(step) for step in steps]


def _logarithmic(name: str, text: str, a: float, b: float, n: int) -> list[Value]:
    if not (a > 0 and b > 0):
        raise ValueError(f"{name}={text}: a logarithmic range begins and ends above 0")
    inner = [float(f"{a * (b / a) ** (k / (n - 1)):.{DIGITS}g}") for k in range(1, n - 1)]
    return [a, *inner, b]


def _read(text: str) -> Any:
    """A number as such, anything else as it is."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
