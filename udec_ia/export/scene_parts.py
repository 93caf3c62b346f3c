"""What a state has to show in other programs: points, cells between them, and columns of numbers.

    blocks      polygons; their rows of the table `block`, groups, and stress where it is known
    zones       triangles between grid-points; rows of `zone` and `gridpoint`
    contacts    points; rows of `contact`, without virtual ones, with slip, opening, state, joint material
    water       points, one in each domain; pressure, saturation, volume and inflow
    structures  lines; forces of bolts and of elements of cables and beams

A column of a word has the name of the field table, and its numbers are those of the words. The others, such
as stress, velocity, displacement (with DISPLACEMENTS), slip and group, have small letters. A part without
cells has its columns as well, so that a series of states has the same parts throughout.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.reader.block_groups import groups_of_blocks
from udec_ia.reader.group_tables import table
from udec_ia.reader.joint_rows import COLUMNS as JOINT_COLUMNS
from udec_ia.reader.joint_rows import joint_rows
from udec_ia.reader.structure_rows import structure_rows
from udec_ia.reader.water_rows import DOMAINS, domain_water
from udec_ia.reader.zone_rows import has_zones, zone_rows

OF_STRUCTURES = "address", "HEAD", "force", "moment", "broken"
POINTS, LINES, POLYGONS = "Vertices", "Lines", "Polygons"  # as VTK names them


@dataclass(frozen=True, eq=False)
class Part:
    """Cells of one kind.

    place: (n, 2) coordinates of points, m. ends: (m + 1,) where the points of each cell begin in `corners`,
    which are rows of `place`. columns, point_columns: arrays (m, ...) and (n, ...) by name.
    """

    name: str
    kind: str
    place: Any
    ends: Any
    corners: Any
    columns: dict[str, Any]
    point_columns: dict[str, Any] = field(default_factory=dict)


def scene_parts(array: MainArray) -> list[Part]:
    """All parts of a state. Raises as `table` does."""
    return [blocks(array), zones(array), contacts(array), water(array), structures(array)]


def _columns(rows: Any) -> dict[str, Any]:
    """The columns of a table by name."""
    return {name: np.ascontiguousarray(rows[name]) for name in rows.dtype.names}


def _vector(rows: Any, *names: str) -> Any:
    """Two columns as vectors (n, 3)."""
    return np.stack([rows[name].astype(np.float64) for name in names] + [np.zeros(len(rows))], axis=1)


def _rows_at(addresses: Any, wanted: Any) -> Any:
    """Row of each address in `wanted` among `addresses`, all of which are there."""
    order = np.argsort(addresses)
    return order[np.searchsorted(addresses, wanted, sorter=order)]


def blocks(array: MainArray) -> Part:
    """All blocks as polygons, clockwise."""
    rows, corners = table(array, "block"), table(array, "corner")
    counts = np.bincount(_rows_at(rows["address"], corners["KNB"]), minlength=len(rows))
    columns = _columns(rows) | {"velocity": _vector(rows, "KXD", "KYD"), "stress": block_stress(array, rows)}
    columns |= _groups(array, rows) | _displacement(array, "displacement", "KBDX", "KBDY")
    if array.h.ci[g.LDISP]:
        columns["rotation"] = table(array, "displacement")["KBDT"]
    ends = np.concatenate([[0], np.cumsum(counts)])
    place = np.stack([corners["KXP"], corners["KYP"]], axis=1).astype(np.float64)
    return Part("blocks", POLYGONS, place, ends, np.arange(len(corners)), columns)


def _groups(array: MainArray, rows: Any) -> dict[str, Any]:
    """For each GROUP whether the blocks in `rows` belong to it."""
    if not array.h.ci[g.IMBPNT]:
        return {}
    return {f"group {name}": np.isin(rows["address"], at) for name, at in groups_of_blocks(array.h).items()}


def _displacement(array: MainArray, kind: str, *names: str) -> dict[str, Any]:
    """The column `displacement` (n, 3), m, of all groups of a kind; none without DISPLACEMENTS."""
    return {"displacement": _vector(table(array, kind), *names)} if array.h.ci[g.LDISP] else {}


def block_stress(array: MainArray, rows: Any) -> Any:
    """Stresses 11, 12 and 22 (n, 3) of the blocks in `rows`, Pa: the mean of zones; nan for rigid blocks."""
    found = np.full((len(rows), 3), np.nan)
    soft = table(array, "sdef")
    here = np.flatnonzero(integers(array.h, rows["address"], HEAD) == g.MSDEF)
    if len(here):
        of = _rows_at(soft["address"], rows["KBEX"][here])
        found[here] = np.stack([soft[name][of] for name in ("KS111", "KS112", "KS122")], axis=1)
    for k, ib in enumerate(rows["address"].tolist()):
        if has_zones(array.h, ib):
            inside = zone_rows(array.h, ib)
            found[k] = np.average(inside.stress, axis=0, weights=getr(array.h, inside.zones, g.KZM))
    return found


def zones(array: MainArray) -> Part:
    """All zones as triangles between their grid-points."""
    rows, points = table(array, "zone"), table(array, "gridpoint")
    columns = _columns(rows) | {"stress": np.stack([rows[n] for n in ("KZS11", "KZS12", "KZS22")], axis=1)}
    corners = _rows_at(points["address"], rows["KZG"].ravel()) if len(rows) else np.zeros(0, np.int64)
    place = np.stack([points["KXG"], points["KYG"]], axis=1).astype(np.float64)
    point_columns = _columns(points) | {"velocity": _vector(points, "KXDG", "KYDG")}
    point_columns |= _displacement(array, "pointdisplacement", "KGDX", "KGDY")
    return Part("zones", POLYGONS, place, 3 * np.arange(len(rows) + 1), corners, columns, point_columns)


def _at_points(name: str, rows: Any, x: str, y: str, columns: dict[str, Any]) -> Part:
    """A part with one point for each row."""
    place = np.stack([rows[x], rows[y]], axis=1).astype(np.float64)
    return Part(name, POINTS, place, np.arange(len(rows) + 1), np.arange(len(rows)), columns)


def contacts(array: MainArray) -> Part:
    """All contacts but virtual ones."""
    rows, joints = table(array, "contact"), joint_rows(array.h)
    rows = rows[rows["KCCOD"] != g.VIRTUAL]
    columns = _columns(rows) | {name: joints[name] for name in JOINT_COLUMNS if name != "contact"}
    at = joints_at(array.h, rows["address"])
    columns["jmaterial"] = np.where(at != 0, integers(array.h, at, g.KCJMAT), 0)
    return _at_points("contacts", rows, "KXC", "KYC", columns)


def water(array: MainArray) -> Part:
    """All domains with water; none without FLUID."""
    h = array.h
    rows = domain_water(h) if h.ci[g.LWATER] else np.zeros(0, [(n, kind) for n, (_, kind) in DOMAINS.items()])
    return _at_points("water", rows, "x", "y", _columns(rows))


def structures(array: MainArray) -> Part:
    """Bolts, and elements of cables and beams."""
    rows = structure_rows(array.h)
    columns = {name: np.ascontiguousarray(rows[name]) for name in OF_STRUCTURES}
    columns |= {f"{axis}{end + 1}": rows["line"][:, end, k] for end in (0, 1) for k, axis in enumerate("xy")}
    place = rows["line"].reshape(-1, 2)
    return Part("structures", LINES, place, 2 * np.arange(len(rows) + 1), np.arange(len(place)), columns)
