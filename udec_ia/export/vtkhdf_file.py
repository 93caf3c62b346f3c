"""VTKHDF files, which ParaView and pyvista open: one or several states as a series in time.

A file is a MultiBlockDataSet with one PolyData for each part (scene_parts.py). Each state is
appended to the data sets of its part; `Steps` says where it begins. Source: VTKHDF format specification 2.3,
docs.vtk.org.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any, BinaryIO

import h5py
import numpy as np

from udec_ia.export.scene_parts import Part

VERSION = (2, 3)
KINDS = ("Vertices", "Lines", "Polygons", "Strips")  # of cells, in the order of the specification
NO_CELLS = np.zeros(1, np.int64), np.zeros(0, np.int64)
SMALL_CHUNK, CHUNK = 16, 4096  # rows of a data set that are stored together: the least, the most
GENERATOR = {"Generator": "udec_ia"}  # an attribute that VTK leaves out


class VtkhdfFile:
    """A file that is being written; `add` appends a state."""

    def __init__(self, file: h5py.File) -> None:
        self.root = file.create_group("VTKHDF", track_order=True)
        _begin(self.root, "MultiBlockDataSet")
        self.root.attrs.update(GENERATOR)
        self.assembly = self.root.create_group("Assembly", track_order=True)

    def add(self, time: float, parts: Iterable[Part]) -> None:
        """Append the parts of a state at that time (s)."""
        for part in parts:
            if part.name not in self.root:
                group = self.root.create_group(part.name, track_order=True)
                _begin(group, "PolyData")
                group.create_group("Steps").attrs["NSteps"] = 0
                self.assembly[part.name] = h5py.SoftLink(f"/VTKHDF/{part.name}")
            _append_state(self.root[part.name], time, part)


def write_vtkhdf(content: BinaryIO, states: Iterable[tuple[float, list[Part]]]) -> None:
    """Write states, which are times (s) and parts."""
    with h5py.File(content, "w") as file:
        out = VtkhdfFile(file)
        for time, parts in states:
            out.add(time, parts)


def is_ours(path: Path) -> bool:
    """True if the file was written here."""
    try:
        with h5py.File(path) as file:
            return bool(GENERATOR.items() <= dict(file["VTKHDF"].attrs).items())
    except (OSError, KeyError):
        return False


def _begin(group: Any, kind: str) -> None:
    group.attrs["Version"] = VERSION
    group.attrs.create("Type", kind.encode("ascii"), dtype=h5py.string_dtype("ascii", len(kind)))


def _append(group: Any, name: str, values: Any) -> int:
    """Append rows to a data set, which is made if it is new; returns how many it had."""
    values = np.asarray(values)
    if values.dtype == bool:
        values = values.astype(np.uint8)
    if name not in group:
        row, many = values.shape[1:], min(max(len(values), SMALL_CHUNK), CHUNK)
        group.create_dataset(name, (0, *row), values.dtype, maxshape=(None, *row), chunks=(many, *row))
    rows = group[name]
    before = len(rows)
    rows.resize(before + len(values), axis=0)
    rows[before:] = values
    return before


def _append_columns(group: Any, begins: Any, columns: dict[str, Any]) -> None:
    """Append the columns of a state. Where a state of the series has no such column it is nan, or 0."""
    known = next(iter(columns))  # which all states have
    before, many = len(group[known]) if known in group else 0, len(columns[known])
    for name in columns:
        if name not in group:
            _append(group, name, _missing(before, np.asarray(columns[name])))
            if known in begins:
                begins.copy(known, name)
    for name in dict.fromkeys((*group, *columns)):
        values = columns[name] if name in columns else _missing(many, group[name])
        _append(begins, name, [_append(group, name, values)])


def _missing(rows: int, like: Any) -> Any:
    """A column of values that a state does not have: nan, or 0 of integers."""
    value = np.nan if like.dtype.kind == "f" else 0
    return np.full((rows, *like.shape[1:]), value, like.dtype)


def _append_state(group: Any, time: float, part: Part) -> None:
    """Append the part of a state, and where it begins in each data set."""
    steps = group["Steps"]
    place = np.column_stack([part.place, np.zeros(len(part.place))])
    _append(steps, "PartOffsets", [_append(group, "NumberOfPoints", [len(place)])])
    _append(steps, "NumberOfParts", [1])
    _append(steps, "PointOffsets", [_append(group, "Points", place)])
    cells, ids = [], []
    for kind in KINDS:
        ends, corners = (
            (part.ends, part.corners) if kind == part.kind else (np.zeros(1, int), np.zeros(0, int))
        )
        topology = group.require_group(kind)
        _append(topology, "NumberOfCells", [len(ends) - 1])
        _append(topology, "NumberOfConnectivityIds", [len(corners)])
        first = _append(topology, "Offsets", ends)
        cells.append(first - int(steps.attrs["NSteps"]))  # there is one offset more than cells in each step
        ids.append(_append(topology, "Connectivity", corners))
    _append(steps, "CellOffsets", [cells])
    _append(steps, "ConnectivityIdOffsets", [ids])
    for kind, columns in (("CellData", part.columns), ("PointData", part.point_columns)):
        if columns:
            _append_columns(group.require_group(kind), steps.require_group(f"{kind}Offsets"), columns)
    _append(steps, "Values", [float(time)])
    steps.attrs["NSteps"] += 1
