"""States are written to a file in the format that its name ends with.

    .vtkhdf   all states as a series in time, for ParaView and pyvista (vtkhdf_file.py)
    .csv      a table for each part: NAME-blocks.csv, NAME-gridpoints.csv, NAME-contacts.csv ...; those of
              empty parts are written only in place of former ones
    .geojson  the last state as polygons, lines and points with their properties
    .svg      the last state as a drawing (svg_file.py)

A file is written in one step, and replaces only one that export has written.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable, Iterator
from itertools import chain, pairwise
from math import inf, isfinite
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia.checker import check_links, in_short
from udec_ia.errors import UdecError
from udec_ia.export.scene_parts import LINES, POINTS, Part, scene_parts
from udec_ia.export.svg_file import SVG_MARK, svg_text
from udec_ia.export.vtkhdf_file import is_ours, write_vtkhdf
from udec_ia.file_replacement import Judge, put_in_place
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g

State = tuple[float, list[Part]]
GENERATOR = {"generator": "udec_ia"}  # a member that GeoJSON readers leave out
NOT_OURS = "was not written by export"
SAME_COLUMNS = 4  # with which a table of ours begins


def export(path: str | Path, arrays: Iterable[MainArray]) -> list[Path]:
    """Write states for another program.

    Parameters
    ----------
    path
        Its ending, .vtkhdf, .csv, .geojson or .svg, is the format.
    arrays
        The states, as `Model.array`, in the order of their times.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    UdecError
        10 for a name that ends with no format, or times of .vtkhdf that decrease, 20 for a damaged state, 26
        without a state, 31 if a file cannot be written, or would replace one that export has not written.

    Examples
    --------
    >>> [file.name for file in export("blocks.vtkhdf", [m.array])]
    ['blocks.vtkhdf']
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise UdecError(10, f"{path.name} ends with no format", f"choose one of {', '.join(FORMATS)}")
    states = map(_state, arrays)
    first = next(states, None)
    if first is None:
        raise UdecError(26, "there is no state to export", "give one or more")
    return FORMATS[path.suffix.lower()](path, chain([first], states))


def _state(array: MainArray) -> State:
    """Time and parts of a state. Error 20 if its links are damaged."""
    if broken := check_links(array):
        raise UdecError(20, in_short(broken), "CHECK lists all that is wrong")
    return float(array.h.cd[g.TIME]), scene_parts(array)


def _written_with(mark: bytes) -> Judge:
    """Judge of an existing file, which may be replaced if `mark` is near its beginning."""
    return lambda front, _: "" if mark in front else NOT_OURS


def _write_vtkhdf(path: Path, states: Iterator[State]) -> list[Path]:
    content = io.BytesIO()
    write_vtkhdf(content, _in_order(states))
    put_in_place(path, content.getbuffer(), lambda *_: "" if is_ours(path) else NOT_OURS)
    return [path]


def _in_order(states: Iterator[State]) -> Iterator[State]:
    """The states. Error 10 if a time is before that of the last state."""
    last = -inf
    for time, parts in states:
        if time < last:
            detail = f"a state at {time:g} s follows one at {last:g} s"
            raise UdecError(
                10, detail, "give the states in the order of their times; after RESET TIME begin a file"
            )
        last = time
        yield time, parts


def _flat(columns: dict[str, Any]) -> dict[str, list[Any]]:
    """Columns of single numbers: those of vectors get a number behind their name."""
    found: dict[str, list[Any]] = {}
    for name, values in columns.items():
        rows = values.reshape(len(values), -1) if len(values) else np.zeros((0, 1))
        names = [name] if rows.shape[1] == 1 else [f"{name}_{k + 1}" for k in range(rows.shape[1])]
        found.update(zip(names, rows.T.tolist(), strict=True))
    return found


def _write_csv(path: Path, states: Iterator[State]) -> list[Path]:
    names: dict[str, dict[str, None]] = {}
    tables: dict[str, list[dict[str, Any]]] = {}
    for time, parts in states:
        for part in parts:
            of_points = {"gridpoints": part.point_columns} if part.point_columns else {}
            for name, columns in {part.name: part.columns, **of_points}.items():
                flat = _flat(columns)
                flat = {"time": [time] * len(next(iter(flat.values()))), **flat}
                names.setdefault(name, {}).update(dict.fromkeys(flat))
                tables.setdefault(name, []).extend(
                    dict(zip(flat, row, strict=True)) for row in zip(*flat.values(), strict=True)
                )
    files = []
    for name, rows in tables.items():
        file = path.with_name(f"{path.stem}-{name}{path.suffix}")
        if rows or file.exists():
            text = io.StringIO()
            writer = csv.DictWriter(text, list(names[name]))
            writer.writeheader()
            writer.writerows(rows)
            mark = ",".join([*names[name]][:SAME_COLUMNS]).encode()
            put_in_place(file, text.getvalue().encode(), _written_with(mark))
            files.append(file)
    return files


def _geometry(part: Part, k: int) -> dict[str, Any]:
    """The cell `k` as a geometry of GeoJSON; outlines are closed, and anticlockwise."""
    points = part.place[part.corners[part.ends[k] : part.ends[k + 1]]].tolist()
    if part.kind == POINTS:
        return {"type": "Point", "coordinates": points[0]}
    if part.kind == LINES:
        return {"type": "LineString", "coordinates": points}
    ring = points + points[:1]
    twice = sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(ring))
    return {"type": "Polygon", "coordinates": [ring if twice > 0 else ring[::-1]]}


def _write_geojson(path: Path, states: Iterator[State]) -> list[Path]:
    features = []
    *_, (time, parts) = states
    for part in parts:
        columns = _flat(part.columns)
        for k in range(len(part.ends) - 1):
            known = {name: values[k] for name, values in columns.items() if isfinite(values[k])}
            properties = {"part": part.name, "time": time, **known}
            features.append({"type": "Feature", "geometry": _geometry(part, k), "properties": properties})
    text = json.dumps({**GENERATOR, "type": "FeatureCollection", "features": features})
    put_in_place(path, text.encode(), _written_with(json.dumps(GENERATOR)[:-1].encode()))
    return [path]


def _write_svg(path: Path, states: Iterator[State]) -> list[Path]:
    *_, (_, parts) = states
    put_in_place(path, svg_text(parts).encode(), _written_with(SVG_MARK.encode()))
    return [path]


FORMATS: dict[str, Callable[[Path, Iterator[State]], list[Path]]] = {
    ".vtkhdf": _write_vtkhdf,
    ".csv": _write_csv,
    ".geojson": _write_geojson,
    ".svg": _write_svg,
}
