"""SPROPERTY, BOLT, CABLE, BEAM and REMOVE (report section 5, structural connection).

A cable or beam is a line of nodes with elements between them. A node in or on a block is joined to it, along
the halves of its elements that are in blocks. Its mass is half of the elements beside it, its moment of
inertia that of these halves as rods.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, getr, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.structures.attached_points import block_at, zone_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.commands.fill_space import outline_of_space
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.attached_structures import attach, drop_elements, number_of_structures
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import NMAT, check_real_range, finite, not_negative, whole
from udec_ia.reader.group_ranges import Range, holds

SEGMENTS_LIMIT = 1000
SPROPERTIES = {one.argument: getattr(g, one.array) for one in read_table().structural_properties}


def structural_number(smaterial: int) -> int:
    """`smaterial` if it is the number of a structural material, else error 4."""
    if not 1 <= whole(smaterial=smaterial) <= NMAT:
        advice = f"structural materials run from 1 to {NMAT}"
        raise UdecError(4, f"{smaterial}", advice, parameter="smaterial")
    return smaterial


def set_structural_property(array: MainArray, smaterial: int, **values: float | None) -> None:
    """SPROPERTY: properties of a structural material; those not given stay.

    Forces in structures stay as they are. Error 4 or 28, and nothing is changed.
    """
    i = structural_number(smaterial) - 1
    given = {name: value for name, value in values.items() if value is not None}
    not_negative(array, **given)
    for name, value in given.items():
        array.h.cr[SPROPERTIES[name] + i] = value


def make_bolt(
    array: MainArray, x1: float, y1: float, x2: float, y2: float, smaterial: int, pretension: float
) -> int:
    """BOLT: a bolt between the blocks at two points. Returns its address.

    Error 4, 26 without a block or a stiffness, or 28; nothing is changed then.
    """
    finite(array, x1=x1, y1=y1, x2=x2, y2=y2)
    not_negative(array, pretension=pretension)
    i, h = structural_number(smaterial) - 1, array.h
    length = math.hypot(x2 - x1, y2 - y1)
    if not length > float(h.cr[g.FTOL]):
        raise UdecError(28, f"the bolt is {length:g} m long", "give two points apart", parameter="x2")
    if not (h.cr[g.STKN + i] > 0 or h.cr[g.STYM + i] * h.cr[g.STAREA + i] > 0):
        advice = f"first SPROPERTY SMATERIAL={smaterial} YOUNG=... AREA=..., or KN=..."
        raise UdecError(26, f"structural material {smaterial} is not stiff", advice, parameter="smaterial")
    check_real_range(array, "the length of the bolt", [length])
    ends = [held_point(array, x1, y1, "x1"), held_point(array, x2, y2, "x2")]
    require(array, size_of(h, g.NVBT))
    h = array.h
    ia = int(find(h, g.NVBT))
    numbers = (HEAD, g.MBLT), (g.KA, int(h.ci[g.IBTPNT])), (g.KAMAT, smaterial)
    for k, number in numbers:
        puti(h, ia, k, number)
    for (ib, iz), to_block, to_zone in zip(ends, (g.KAB1, g.KAB2), (g.KAZ1, g.KAZ2), strict=True):
        puti(h, ia, to_block, ib)
        puti(h, ia, to_zone, iz)
    reals = (g.KAX1, x1), (g.KAY1, y1), (g.KAX2, x2), (g.KAY2, y2), (g.KALEN, length), (g.KAFN, pretension)
    for k, value in reals:
        putr(h, ia, k, value)
    h.ci[g.IBTPNT] = ia
    renew_forces(array)
    return ia


def held_point(array: MainArray, x: float, y: float, parameter: str) -> tuple[int, int]:
    """Block and zone that hold a point; the zone is 0 in a block without zones. Error 26 if none does."""
    ib, iz = _held(array, x, y)
    if not ib:
        advice = "PRINT BLOCKS shows them"
        raise UdecError(26, f"there is no block at ({x:g}, {y:g})", advice, parameter=parameter)
    return ib, iz


def _held(array: MainArray, x: float, y: float) -> tuple[int, int]:
    """The same; 0 and 0 outside all blocks."""
    h = array.h
    x, y = float(h.cr.dtype.type(x)), float(h.cr.dtype.type(y))
    ib = int(block_at(h, x, y, 0))
    return ib, int(zone_at(h, ib, x, y)) if ib else 0


# ---- CABLE and BEAM


class Line(NamedTuple):
    """A cable or beam to be made. points: of its nodes, (n, 2) in m; closed: the last is joined to the first.

    kind: of KMKIND. side: of KNSIDE.
    """

    points: Any
    closed: bool
    kind: int
    side: int


def straight_line(array: MainArray, ends: Any, segments: int, kind: int) -> Line:
    """A line of so many elements between two points. Error 10 or 28."""
    x1, y1, x2, y2 = ends
    finite(array, x1=x1, y1=y1, x2=x2, y2=y2)
    part = np.linspace(0.0, 1.0, _segments(segments) + 1)[:, None]
    points = np.array([x1, y1]) * (1 - part) + np.array([x2, y2]) * part
    return Line(points, False, kind, g.EMBEDDED)


def lining(array: MainArray, around: tuple[float, float], within: Range | None, segments: int) -> Line:
    """A line along the walls of the space around a point, so many elements to an edge; within: nodes there.

    Of several parts of the walls in the range the longest one is lined. Error 10, 18, 24 or 28.
    """
    corners = np.array(outline_of_space(array, *around))
    part = np.arange(_segments(segments))[:, None] / segments
    after = np.roll(corners, -1, axis=0)
    edges = [one * (1 - part) + two * part for one, two in zip(corners, after, strict=True)]
    points = np.concatenate(edges)
    if within is None:
        return Line(points, True, g.OF_BEAM, g.ROCK_ON_LEFT)
    blocks = np.array([_held(array, *one)[0] for one in points.tolist()])
    inside = holds(array, within, *points.T, blocks)
    if inside.all():
        return Line(points, True, g.OF_BEAM, g.ROCK_ON_LEFT)
    first = int(np.argmin(inside))  # outside, so that no part goes over the end
    order = np.roll(np.arange(len(points)), -first)
    parts = np.split(order, np.flatnonzero(np.diff(inside[order].astype(int))) + 1)
    lengths = np.hypot(*(np.roll(points, -1, axis=0) - points).T)  # from each node to the next
    found = [one for one in parts if inside[one[0]]]
    longest: Any = max(found, key=lambda one: float(lengths[one[:-1]].sum()), default=[])
    if len(longest) < 2:
        advice = "give a range with two nodes, or more SEGMENTS"
        raise UdecError(24, "less than two nodes of the lining are in the range", advice, parameter="within")
    return Line(points[longest], False, g.OF_BEAM, g.ROCK_ON_LEFT)


def _segments(segments: int) -> int:
    if not 1 <= whole(segments=segments) <= SEGMENTS_LIMIT:
        raise UdecError(28, f"{segments}", f"SEGMENTS is 1 to {SEGMENTS_LIMIT}", parameter="segments")
    return segments


def make_line(array: MainArray, line: Line, smaterial: int, pretension: float) -> int:
    """Make a cable or beam. Returns its number of elements. Error 4, 26 or 28, and nothing is changed."""
    not_negative(array, pretension=pretension)
    n = len(line.points)
    ends = np.arange(n if line.closed else n - 1)
    lengths = np.hypot(*(line.points[(ends + 1) % n] - line.points[ends]).T)
    held = [_held(array, x, y) for x, y in line.points.tolist()]
    _check_line(array, line, smaterial, lengths, held)
    require(array, size_of(array.h, g.NVND) * n + size_of(array.h, g.NVEL) * len(ends))
    h, i = array.h, smaterial - 1
    share = np.zeros(n)  # half of the lengths of the elements beside a node
    joined = np.zeros(n)  # the same, of halves in blocks
    inertia = np.zeros(n)  # of the halves, as rods, about the node, over mass by length
    for here, there in ((ends, (ends + 1) % n), ((ends + 1) % n, ends)):
        middles = line.points[here] * 0.75 + line.points[there] * 0.25
        np.add.at(share, here, lengths / 2)
        np.add.at(joined, here, lengths / 2 * [_held(array, *one)[0] > 0 for one in middles.tolist()])
        np.add.at(inertia, here, (lengths / 2) ** 3 / 3)
    joined = np.where(joined > 0, joined, share)  # else a strut that ends at a wall
    mass = float(h.cr[g.STDENS + i]) * float(h.cr[g.STAREA + i])
    nodes = [int(find(h, g.NVND)) for _ in range(n)]
    for k, (node, (x, y), (ib, iz)) in enumerate(zip(nodes, line.points.tolist(), held, strict=True)):
        following = nodes[k + 1] if k + 1 < n else int(h.ci[g.INDPNT])
        integers = (HEAD, g.MNOD), (g.KN, following), (g.KNBL, ib), (g.KNZN, iz), (g.KNMAT, smaterial)
        for word, number in (*integers, (g.KNSIDE, line.side)):
            puti(h, node, word, number)
        reals = (
            (g.KNX, x),
            (g.KNY, y),
            (g.KNAX, x),
            (g.KNAY, y),
            (g.KNLEN, joined[k]),
            (g.KNM, mass * share[k]),
        )
        for word, value in (*reals, (g.KNI, mass * inertia[k]), (g.KNSM, 1.0), (g.KNSI, 1.0)):
            putr(h, node, word, value)
    elements = [int(find(h, g.NVEL)) for _ in ends]
    for k, im in enumerate(elements):
        following = elements[k + 1] if k + 1 < len(elements) else int(h.ci[g.IELPNT])
        links = (HEAD, g.MELM), (g.KM, following), (g.KMN1, nodes[k]), (g.KMN2, nodes[(k + 1) % n])
        for word, number in (*links, (g.KMMAT, smaterial), (g.KMKIND, line.kind)):
            puti(h, im, word, number)
        putr(h, im, g.KMLEN, lengths[k])
        putr(h, im, g.KMFN, pretension)
    h.ci[g.INDPNT], h.ci[g.IELPNT] = nodes[0], elements[0]
    renew_forces(array)
    return len(elements)


def _check_line(array: MainArray, line: Line, smaterial: int, lengths: Any, held: list[Any]) -> None:
    """Error 4, 26 or 28 unless the material has what a cable or beam needs, and the line has a length."""
    h, i = array.h, structural_number(smaterial) - 1
    if not lengths.min() > float(h.cr[g.FTOL]):
        raise UdecError(28, f"an element is {lengths.min():g} m long", "give fewer SEGMENTS", parameter="x2")
    check_real_range(array, "the length of an element", lengths.tolist())
    needed = {"YOUNG": g.STYM, "AREA": g.STAREA, "DENSITY": g.STDENS}
    if line.kind == g.OF_BEAM:
        needed["INERTIA"] = g.STI
    if any(ib for ib, _ in held):
        needed["KS"] = g.STKS
    if missing := [name for name, k in needed.items() if not h.cr[k + i] > 0]:
        names = " and ".join(missing)
        advice = f"first SPROPERTY SMATERIAL={smaterial} {' '.join(f'{name}=...' for name in missing)}"
        raise UdecError(26, f"structural material {smaterial} has no {names}", advice, parameter="smaterial")
    if not any(ib for ib, _ in held):
        advice = "give points in or on blocks"
        raise UdecError(26, "no node of the line is in a block", advice, parameter="x1")


# ---- REMOVE


def remove_structures(array: MainArray, where: Range, kinds: Collection[str]) -> int:
    """REMOVE: bolts, and elements of cables and beams, with their middles in the range. Returns their number.

    kinds: "bolts", "cables" and "beams". Nodes that keep an element keep their length and mass.
    """
    h = array.h
    bolts, elements = list_of(h, "bolt"), list_of(h, "element")
    one, two = (integers(h, elements, k) for k in (g.KMN1, g.KMN2))
    middle = [(getr(h, one, k) + getr(h, two, k)) / 2 for k in (g.KNX, g.KNY)]
    chosen = holds(array, where, *middle, integers(h, one, g.KNBL), integers(h, two, g.KNBL))
    codes = [code for kind, code in (("cables", g.OF_CABLE), ("beams", g.OF_BEAM)) if kind in kinds]
    elements = elements[chosen & np.isin(integers(h, elements, g.KMKIND), codes)]
    middle = [(getr(h, bolts, a) + getr(h, bolts, b)) / 2 for a, b in ((g.KAX1, g.KAX2), (g.KAY1, g.KAY2))]
    chosen = holds(array, where, *middle, integers(h, bolts, g.KAB1), integers(h, bolts, g.KAB2))
    bolts = bolts[chosen & ("bolts" in kinds)]
    drop(h, "bolt", bolts.tolist())
    drop_elements(h, elements)
    renew_forces(array)
    return len(bolts) + len(elements)


# ---- after other commands


def update_structures(array: MainArray, before: int) -> int:
    """After a command that may have changed blocks: points belong to what is there now.

    before: number of bolts and elements before it. Returns how many of these have been given back.
    """
    if attach(array.h) or array.h.ci[g.MCTOT] == 0:  # until then commands do not sum forces
        renew_forces(array)
    return max(before - number_of_structures(array.h), 0)
