"""States are written to a file in the format that its name ends with.

    .vtkhdf   all states as a series in time, for ParaView and pyvista (vtkhdf_file.py)
    .csv      a table for each part that is not empty: NAME-blocks.csv, NAME-contacts.csv ...
    .geojson  the last state as polygons, lines and points with their properties
    .svg      the last state as a drawing (svg_file.py)

A file is written in one step, and replaces only one of its own kind.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.export.scene_parts import LINES, POINTS, Part, scene_parts
from udec_ia.export.svg_file import svg_text
from udec_ia.export.vtkhdf_file import write_vtkhdf
from udec_ia.file_replacement import put_in_place
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g

State = tuple[float, list[Part]]


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
        10 for a name that ends with no format, 31 if a file cannot be written, or would replace another kind
        of file.

    Examples
    --------
    >>> [file.name for file in export("blocks.vtkhdf", [m.array])]
    ['blocks.vtkhdf']
    """
    path = Path(path)
    if path.suffix.lower() not in FORMATS:
        raise UdecError(10, f"{path.name} ends with no format", f"choose one of {', '.join(FORMATS)}")
    states = ((float(array.h.cd[g.TIME]), scene_parts(array)) for array in arrays)
    return FORMATS[path.suffix.lower()](path, states)


def _write_vtkhdf(path: Path, states: Iterator[State]) -> list[Path]:
    content = io.BytesIO()
    write_vtkhdf(content, states)
    put_in_place(path, content.getbuffer())
    return [path]


def _flat(columns: dict[str, Any]) -> dict[str, list[Any]]:
    """Columns of single numbers: those of vectors get a number behind their name."""
    found: dict[str, list[Any]] = {}
    for name, values in columns.items():
        rows = values.reshape(len(values), -1) if len(values) else np.zeros((0, 1))
        names = [name] if rows.shape[1] == 1 else [f"{name}_{k + 1}" for k in range(rows.shape[1])]
        found.update(zip(names, rows.T.tolist(), strict=True))
    return found


def _write_csv(path: Path, states: Iterator[State]) -> list[Path]:
    tables: dict[str, list[dict[str, Any]]] = {}
    for time, parts in states:
        for part in parts:
            columns = _flat(part.columns)
            if len(part.ends) > 1:
                columns = {"time": [time] * (len(part.ends) - 1), **columns}
                rows = tables.setdefault(part.name, [])
                rows += [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    files = []
    for name, rows in tables.items():
        file = path.with_name(f"{path.stem}-{name}{path.suffix}")
        text = io.StringIO()
        writer = csv.DictWriter(text, list(dict.fromkeys(key for row in rows for key in row)))
        writer.writeheader()
        writer.writerows(rows)
        put_in_place(file, text.getvalue().encode())
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
            known = {name: values[k] for name, values in columns.items() if values[k] == values[k]}
            properties = {"part": part.name, "time": time, **known}
            features.append({"type": "Feature", "geometry": _geometry(part, k), "properties": properties})
    put_in_place(path, json.dumps({"type": "FeatureCollection", "features": features}).encode())
    return [path]


def _write_svg(path: Path, states: Iterator[State]) -> list[Path]:
    *_, (_, parts) = states
    put_in_place(path, svg_text(parts).encode())
    return [path]


FORMATS: dict[str, Callable[[Path, Iterator[State]], list[Path]]] = {
    ".vtkhdf": _write_vtkhdf,
    ".csv": _write_csv,
    ".geojson": _write_geojson,
    ".svg": _write_svg,
}
