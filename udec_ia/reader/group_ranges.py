"""Ranges of commands: a rectangle as in 1980, or shapes, materials, joints, sizes and conditions (RANGE).

A range in words has parts, all of which must hold; NOT before a part means that it must not. What lies on
the limit of a shape is outside it. Shapes look at the place of a group: the centroid of a block, a
grid-point, both ends of an edge, a contact, the middle of a domain. JMATERIAL and JOINT look at the contact,
where contacts are selected; OUTSIDE at the outline of all blocks together. The other parts look at the block
of a group, or at one of its two blocks.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_materials import joint_numbers
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.reader.block_groups import groups_of_blocks
from udec_ia.reader.group_conditions import satisfying
from udec_ia.reader.group_tables import table
from udec_ia.reader.word_map import Atlas

Rectangle = tuple[float, float, float, float]  # x1, x2, y1, y2
PARTS = {  # keyword: its numbers, or None for points in any number
    "CIRCLE": "x y r",
    "ANNULUS": "x y r1 r2",
    "POLYGON": None,
    "ABOVE": "x1 y1 x2 y2",
    "BELOW": "x1 y1 x2 y2",
    "MATERIAL": "n",
    "JMATERIAL": "n",
    "JOINT": "n",
    "OUTSIDE": "",
    "AREA": "a",
    "GROUP": "name",
    "ALL": "",
    "WHERE": "condition",
}


class Part(NamedTuple):
    """One part of a range: a keyword of PARTS, or RECTANGLE, with its numbers, its condition or its name."""

    keyword: str
    numbers: tuple[float, ...] = ()
    condition: str = ""
    negated: bool = False


class Selection(NamedTuple):
    """A range in words: its parts, and the text that it was read from."""

    parts: tuple[Part, ...]
    text: str


Range = Rectangle | Selection
EVERYWHERE: Rectangle = (-np.inf, np.inf, -np.inf, np.inf)


def range_of(x1: float | str, x2: float | None, y1: float | None, y2: float | None) -> Range:
    """The range of a command: four limits, or words in place of the first. Error 7 or 10."""
    if isinstance(x1, str):
        if (x2, y1, y2) != (None, None, None):
            detail, advice = f"numbers behind {x1!r}", "give other values by their names, as p=1e5"
            raise UdecError(10, detail, advice, parameter="x2")
        return read_range(x1)
    for name, limit in (("x2", x2), ("y1", y1), ("y2", y2)):
        if limit is None:
            raise UdecError(7, name, "a range is x1 x2 y1 y2, or words", parameter="x1")
    return x1, x2, y1, y2  # type: ignore[return-value]


def limits_of_scene(where: float | str) -> Rectangle | None:
    """The limits x1 x2 y1 y2 of `OUTSIDE x1 x2 y1 y2`, as DELETE has it; None for any other range."""
    words = _apart(where).split() if isinstance(where, str) else []
    if len(words) != 5 or words[0].upper() != "OUTSIDE":
        return None
    try:
        x1, x2, y1, y2 = map(float, words[1:])
    except ValueError:
        return None
    return x1, x2, y1, y2


def _wrong(detail: str, advice: str = "") -> UdecError:
    return UdecError(10, detail, advice or "parts of a range are RANGE, " + ", ".join(PARTS), parameter="x1")


def read_range(text: str) -> Selection:
    """A range in words, as in `CIRCLE 5 5 2 NOT MATERIAL 3`. Error 10 for what is none."""
    words = _apart(text).split()
    if found := re.search(r"\bWHERE\b", text, re.IGNORECASE):
        words = [*_apart(text[: found.start()]).split(), "WHERE", text[found.end() :].strip()]
    parts, negated, k = [], False, 0
    while k < len(words):
        word = words[k].upper()
        if word == "NOT":
            negated, k = not negated, k + 1
            continue
        if word == "RANGE":
            k += 1
            continue
        part, k = _read_part(words, k, negated)
        parts.append(part)
        negated = False
    if not parts or negated:
        raise _wrong(f"{text!r} ends too early" if text else "the range is empty")
    return Selection(tuple(parts), text)


def _apart(text: str) -> str:
    """The text with blanks for separators, and around `<`."""
    return text.translate({ord(one): " " for one in ",()="}).replace("<", " < ")


def _read_part(words: list[str], k: int, negated: bool) -> tuple[Part, int]:
    """The part that begins with word `k`, and the number of the word after it."""
    word = words[k].upper()
    if word == "WHERE":
        return Part(word, (), words[k + 1], negated), len(words)
    if word == "GROUP":
        if k + 1 == len(words):
            raise _wrong("GROUP without a name", "the form is: GROUP name")
        return Part(word, (), words[k + 1], negated), k + 2
    first = k + 1 if word in PARTS else k
    if first < len(words) and words[first] == "<" and word == "AREA":
        first += 1
    numbers = []
    for text in words[first:]:
        try:
            numbers.append(float(text))
        except ValueError:
            break
    if word not in PARTS:
        if not numbers:
            raise _wrong(f"{words[k]!r} is no part of a range")
        word, names = "RECTANGLE", "x1 x2 y1 y2"
    else:
        names = PARTS[word] or ""
    wanted = len(names.split())
    if word == "POLYGON":
        if len(numbers) < 6 or len(numbers) % 2:
            raise _wrong(
                f"POLYGON has {len(numbers)} numbers", "a polygon has x and y of three points or more"
            )
    elif len(numbers) != wanted:
        raise _wrong(f"{word} has {len(numbers)} numbers", f"the form is: {word} {names}")
    if not np.isfinite(numbers).all():
        raise UdecError(28, f"{word} {' '.join(map(str, numbers))}", "give finite numbers", parameter="x1")
    if why := _why_empty(word, numbers):
        raise UdecError(28, f"{word} {' '.join(f'{one:g}' for one in numbers)}", why, parameter="x1")
    return Part(word, tuple(numbers), "", negated), first + len(numbers)


def _why_empty(word: str, numbers: list[float]) -> str:
    """Why a part cannot select anything; "" if it can."""
    if word == "CIRCLE" and not numbers[2] > 0:
        return "give a radius above 0"
    if word == "ANNULUS" and not 0 <= numbers[2] < numbers[3]:
        return "the first radius is the smaller one"
    if word in ("ABOVE", "BELOW") and numbers[0] == numbers[2]:
        return "the two points of the line have different x"
    return ""


def in_shape(part: Part, x: Any, y: Any) -> Any:
    """True for each point inside the shape of a part."""
    n = part.numbers
    if part.keyword == "RECTANGLE":
        return (n[0] < x) & (x < n[1]) & (n[2] < y) & (y < n[3])
    if part.keyword in ("CIRCLE", "ANNULUS"):
        r = np.hypot(x - n[0], y - n[1])
        return r < n[2] if part.keyword == "CIRCLE" else (n[2] < r) & (r < n[3])
    if part.keyword == "POLYGON":
        return _in_polygon(np.reshape(n, (-1, 2)), x, y)
    if part.keyword == "ALL":
        return np.ones(np.shape(x), bool)
    x1, y1, x2, y2 = n if n[0] <= n[2] else (*n[2:], *n[:2])
    height = (x2 - x1) * (y - y1) - (y2 - y1) * (x - x1)
    return height > 0 if part.keyword == "ABOVE" else height < 0


def _in_polygon(corners: Any, x: Any, y: Any) -> Any:
    """True for points around which the polygon runs: a ray to the right crosses it an odd number of times."""
    inside = np.zeros(np.shape(x), bool)
    for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        crosses = (ay > y) != (by > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            inside ^= crosses & (x < ax + (bx - ax) * (y - ay) / (by - ay))
    return inside


SHAPES = ("RECTANGLE", "CIRCLE", "ANNULUS", "POLYGON", "ABOVE", "BELOW", "ALL")


def blocks_of_part(array: MainArray, part: Part) -> Any:
    """Addresses of the blocks for which a part that is no shape holds."""
    h, blocks = array.h, table(array, "block")
    address, value = blocks["address"], part.numbers[0] if part.numbers else 0.0
    if part.keyword == "MATERIAL":
        return address[blocks["KMAT"] == value]
    if part.keyword == "AREA":
        return address[_areas(array, blocks) < value]
    if part.keyword == "GROUP":
        known = groups_of_blocks(h)
        if part.condition.upper() not in known:
            advice = f"there are {', '.join(known)}" if known else "GROUP name range makes one"
            raise UdecError(10, f"there is no group {part.condition}", advice, parameter="x1")
        return known[part.condition.upper()]
    if part.keyword == "WHERE":
        try:
            return satisfying(Atlas(h), f"block where {part.condition}").at
        except ValueError as error:
            detail = " ".join(str(error).split())
            raise UdecError(10, detail, "a condition is one on blocks", parameter="x1") from error
    at = _contacts_of(array, part)
    return np.unique(np.concatenate([integers(h, at, k) for k in (g.KB1, g.KB2)]))


def _contacts_of(array: MainArray, part: Part) -> Any:
    """Addresses of the contacts with that joint material, or on that joint."""
    h, contacts = array.h, table(array, "contact")
    joints = joints_at(h, contacts["address"])
    if part.keyword == "JMATERIAL":
        has = joints != 0
        mat = np.where(has, integers(h, np.where(has, joints, 1), g.KCJMAT), 0)
        return contacts["address"][has & (mat == part.numbers[0])]
    numbers = [joint_numbers(h, ic)[0] if h.ci[g.LJOINT] else 0 for ic in contacts["address"].tolist()]
    on = (np.array(numbers, np.int64) == part.numbers[0]) & (contacts["KCCOD"] != g.VIRTUAL)
    return contacts["address"][on]


def _areas(array: MainArray, blocks: Any) -> Any:
    """Area of each block, from its corners."""
    corners = table(array, "corner")
    order = np.argsort(corners["address"])
    before = order[np.searchsorted(corners["address"], corners["KR"], sorter=order)]
    x, y = corners["KXP"].astype(np.float64), corners["KYP"].astype(np.float64)
    twice = x * y[before] - x[before] * y
    host = np.argsort(blocks["address"])
    row = host[np.searchsorted(blocks["address"], corners["KNB"], sorter=host)]
    return np.abs(np.bincount(row, twice, len(blocks))) / 2


def holds(
    array: MainArray,
    where: Range,
    x: Any,
    y: Any,
    *blocks: Any,
    contacts: Any = None,
    outside: Callable[[], Any] | None = None,
) -> Any:
    """True for each group that the range selects.

    x, y: places of the groups. blocks: addresses of the block of each, or of both its blocks. contacts: their
    addresses, if the groups are contacts. outside: finds which of the groups are outside.
    """
    if not isinstance(where, Selection):
        where = Selection((Part("RECTANGLE", tuple(map(float, where))),), "")
    inside = np.ones(np.shape(x), bool)
    for part in where.parts:
        if part.keyword in SHAPES:
            true = in_shape(part, x, y)
        elif part.keyword == "OUTSIDE":
            if outside is None:
                raise _wrong("OUTSIDE is about blocks, grid-points and edges", "here a range has no OUTSIDE")
            true = outside()
        elif contacts is not None and part.keyword in ("JMATERIAL", "JOINT"):
            true = np.isin(contacts, _contacts_of(array, part))
        elif not blocks:
            raise _wrong(f"{part.keyword} is about blocks", "here a range has shapes only")
        else:
            selected = blocks_of_part(array, part)
            true = np.logical_or.reduce([np.isin(one, selected) for one in blocks])
        inside &= true != part.negated
    return inside
