"""Where groups lie in the rock, and which group is nearest to a point.

A block is at its centroid, a corner where it is sharp, a contact at its contact point; a zone amid its
grid-points, a domain in the middle of the contacts around it; bolts and elements in their middle. An
extension is where its owner is, a boundary condition where its grid-point, edge or block is. A joint is where
its contact is if it has a joint material, an edge where its corner is. The outer domain, virtual contacts,
signals and their points have no position. In a damaged heap the corners of a block are those that name it as
their host.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, getr, iget, integers, size_of
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import point_of
from udec_ia.layout import offsets as g
from udec_ia.printable_text import counted
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import SIZES, reverse
from udec_ia.reader.word_map import KINDS, TABLE, Atlas, Span

POINTS = {
    "block": ("KX", "KY"),
    "corner": ("KXP", "KYP"),
    "gridpoint": ("KXG", "KYG"),
    "node": ("KNX", "KNY"),
}
ON_BLOCKS = "corner", "gridpoint", "pointdisplacement"
SAME_PLACE = 0.1  # of D: corners that face each other are nearer
OWNERS = (("block", "KBEX"), ("domain", "KDEX"))
SUBJECTS = (("block", "KUB"), ("corner", "KUP"), ("gridpoint", "KUG"))  # of a boundary condition, last counts


class Selected(NamedTuple):
    """A group, 0 for none. place: where it is, if it was chosen by a point."""

    address: int
    place: str = ""


def select_groups(array: MainArray, kind: str, field: str, address: int | None, at: Any) -> list[Selected]:
    """The groups of `kind` selected by an address or by points, one pair or several; none for the kind "".

    field: what is wanted of them, for the messages. Errors 7, 8 and 10 for what is given wrongly, 26 and 30
    if there is no such group.
    """
    if len(at) and address is not None:
        raise UdecError(10, "an address and a point", "give one of them", parameter="at")
    if not kind:
        if len(at) or address is not None:
            name = "at" if len(at) else "address"
            raise UdecError(10, f"{field} belongs to no group", "omit address and point", parameter=name)
        return [Selected(0)]
    if address is not None:
        if address not in table(array, kind)["address"]:
            detail = f"{address} is not the address of a {kind} in use"
            raise UdecError(30, detail, f"{field} belongs to a {kind}", parameter="address")
        return [Selected(address)]
    if not len(at):
        advice = "give its address, or a point near it"
        raise UdecError(7, f"{field} of which {kind}?", advice, parameter="field")
    return _nearest(array, kind, _points(array, at))


def _points(array: MainArray, at: Any) -> list[tuple[float, float]]:
    values = np.asarray(at, float).ravel().tolist()
    if len(values) % 2:
        detail = f"{counted(len(values), 'coordinate')} given"
        raise UdecError(8, detail, "a point is x and y", parameter="at")
    largest = float(np.finfo(array.scheme.real_type).max)
    for value in values:
        if not abs(value) <= largest:
            advice = f"{array.scheme.real_bits}-bit reals hold numbers up to {largest:.2g}"
            raise UdecError(28, f"at is {value:g}", advice, parameter="at")
    return list(zip(values[::2], values[1::2], strict=True))


# The commands that make the groups of a flag
MADE_BY = {"LDISP": "DISPLACEMENTS", "LJOINT": "JPROPERTY", "LWATER": "FLUID"}


def _nearest(array: MainArray, kind: str, points: Iterable[tuple[float, float]]) -> list[Selected]:
    """The groups of `kind` nearest to the points.

    Corners and grid-points of several blocks may be at one place: that of the block which the point lies in
    counts, else the first in the list.
    """
    address, place = _places(array, kind)
    if not len(address):
        if len(table(array, kind)):
            advice = (
                "PRINT JOINTS shows those with a joint material" if kind == "joint" else "give its address"
            )
            raise UdecError(26, f"no {kind} has a position", advice, parameter="field")
        command = MADE_BY.get(TABLE.group(kind).flag)
        advice = f"{command} comes before it" if command else "give HISTORY when there is one"
        raise UdecError(26, f"there is no {kind} yet", advice, parameter="field")
    nearest = [_nearest_row(array.h, kind, address, place, point) for point in points]
    return [Selected(int(address[i]), "({:.4g}, {:.4g})".format(*place[i])) for i in nearest]


def _nearest_row(h: Memory, kind: str, address: Any, place: Any, point: tuple[float, float]) -> int:
    """Row of the group nearest to a point, of those at one place the one whose block has the point in it."""
    far = np.hypot(*(place - point).T)
    if kind in ON_BLOCKS:
        for row in np.flatnonzero(far <= far.min() + SAME_PLACE * float(h.cr[g.DTOL])).tolist():
            ib = _block_at(h, kind, int(address[row]))
            if ib and _is_in_block(h, ib, point):
                return int(row)
    return int(far.argmin())


def _block_at(h: Memory, kind: str, iad: int) -> int:
    """The block of a corner, grid-point, or displacement of one; 0 for a grid-point inside a block."""
    if kind == "corner":
        return int(iget(h, iad, g.KNB))
    ip = iget(h, point_of(h, iad) if kind == "pointdisplacement" else iad, g.KCOR)
    return int(iget(h, ip, g.KNB)) if ip else 0


def _is_in_block(h: Memory, ib: int, point: tuple[float, float]) -> bool:
    """True if the point lies within the corners of block `ib`."""
    import shapely

    corners: Any = np.array([*reverse(h, ib)])
    outline = shapely.Polygon(np.column_stack([getr(h, corners, k) for k in (g.KXP, g.KYP)]))
    return bool(shapely.contains_xy(outline, *point))


def _places(array: MainArray, kind: str) -> tuple[Any, Any]:
    """Addresses of the groups of `kind` that are somewhere, and where."""
    rows = table(array, kind)
    if kind in POINTS:
        return rows["address"], np.column_stack([rows[name] for name in POINTS[kind]])
    if kind == "contact":
        rows = rows[rows["KCCOD"] != g.VIRTUAL]
        return rows["address"], np.column_stack([rows["KXC"], rows["KYC"]])
    if kind == "zone":
        return rows["address"], _middles(array, rows)
    if kind == "bolt":
        middles = [(rows[f"K{axis}1"] + rows[f"K{axis}2"]) / 2 for axis in ("AX", "AY")]
        return rows["address"], np.column_stack(middles)
    if kind == "element":
        ends = [_values_at(*_places(array, "node"), rows[name]) for name in ("KMN1", "KMN2")]
        return rows["address"], (ends[0] + ends[1]) / 2
    if kind == "domain":
        return _domains(array, rows["address"])
    if host := TABLE.group(kind).behind:
        words = size_of(array.h, SIZES[host])
        while before := TABLE.group(host).behind:
            host, words = before, words + size_of(array.h, SIZES[before])
        here, where = _places(array, host)
        behind = here + words
        used = rows["address"][rows["KCJMAT"] != 0] if kind == "joint" else rows["address"]
        found = np.isin(behind, used)
        return behind[found], where[found]
    if kind == "bound":
        return rows["address"], _subjects(array, rows)
    return _extensions(array, rows["address"])


def _values_at(addresses: Any, values: Any, wanted: Any) -> Any:
    """The values (n, ...) of the groups at `addresses` (n,), in the order of the addresses `wanted`."""
    order = np.argsort(addresses)
    return values[order[np.searchsorted(addresses, wanted, sorter=order)]]


def _middles(array: MainArray, zones: Any) -> Any:
    return _values_at(*_places(array, "gridpoint"), zones["KZG"]).mean(axis=1)


def _subjects(array: MainArray, bounds: Any) -> Any:
    found = np.empty((len(bounds), 2))
    for kind, pointer in SUBJECTS:
        has = bounds[pointer] != 0
        found[has] = _values_at(*_places(array, kind), bounds[pointer][has])
    return found


def _domains(array: MainArray, address: Any) -> tuple[Any, Any]:
    contacts = table(array, "contact")
    contacts = contacts[contacts["KCCOD"] != g.VIRTUAL]
    count, total = np.zeros(len(address)), np.zeros((len(address), 2))
    for side in ("KD1", "KD2"):
        row = _values_at(address, np.arange(len(address)), contacts[side])
        np.add.at(count, row, 1)
        np.add.at(total, row, np.column_stack([contacts["KXC"], contacts["KYC"]]))
    inner = (count > 0) & (address != array.h.ci[g.IODPNT])
    return address[inner], total[inner] / count[inner, np.newaxis]


def _extensions(array: MainArray, address: Any) -> tuple[Any, Any]:
    found, where = [], []
    for owner, pointer in OWNERS:
        owners = table(array, owner)
        hosts, place = _places(array, owner)
        extension = _values_at(owners["address"], owners[pointer], hosts)
        here = np.isin(extension, address)
        found.append(extension[here])
        where.append(place[here])
    return np.concatenate(found), np.concatenate(where)


NEIGHBOURS = ("loop", "watched")  # roles of pointers to a group that lies where a group without a block does


def places(atlas: Atlas, span: Span) -> list[str]:
    """A sentence for each block that a group belongs to; of a domain those at one of its contacts."""
    blocks = atlas.owners(span)
    if not blocks and span.kind in KINDS:
        near = [int(atlas.value(word)) for word in atlas.words(span) if word.field.role in NEIGHBOURS]
        blocks = [block for iad in near if atlas.holds("any", iad) for block in atlas.owners(atlas.span(iad))]
    head, at = [], atlas.groups["corner"]
    for block in dict.fromkeys(block for block in blocks if atlas.holds("block", block)):
        x, y = (float(getr(atlas.h, block, k)) for k in (g.KX, g.KY))
        head.append(f"block@{block}: centroid ({x:.6g}, {y:.6g}) m")
        own = at[integers(atlas.h, at, g.KNB) == block]
        if len(own):
            ends = [
                (values.min(), values.max()) for values in (getr(atlas.h, own, k) for k in (g.KXP, g.KYP))
            ]
            (x1, x2), (y1, y2) = ends
            head[-1] += f", {len(own)} corners in x {x1:.6g} to {x2:.6g} m, y {y1:.6g} to {y2:.6g} m"
    return head
