"""Lines of fractures in a file: CSV with the ends of each, or GeoJSON (FRACTURES)."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.ops.cuts.block_division import Reals

COLUMNS = ("x1", "y1", "x2", "y2")
LARGEST = 100_000_000  # bytes


class Fractures(NamedTuple):
    """Polylines, each (k, 2), and the number of the joint of each, 0 if the file gives none."""

    lines: list[Reals]
    joints: list[int]


def read_fractures(path: Path) -> Fractures:
    """The fractures in a file: GeoJSON if its name ends in json, else CSV with the columns x1, y1, x2, y2.

    CSV may have a column joint, and GeoJSON a property joint. Error 28 with the line or feature for a file
    that is neither, OSError if it cannot be read.
    """
    if path.stat().st_size > LARGEST:
        raise UdecError(28, f"{path} has more than {LARGEST:,} bytes", parameter="path")
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    found = [*(_geojson(text, path) if path.suffix.lower().endswith("json") else _csv(text, path))]
    return Fractures([line for line, _ in found], [joint for _, joint in found])


def _wrong(path: Path, where: str, detail: str) -> UdecError:
    advice = "CSV has the columns x1,y1,x2,y2 and perhaps joint; GeoJSON has LineStrings or Polygons"
    return UdecError(28, f"{path}, {where}: {detail}", advice, parameter="path")


def _csv(text: str, path: Path) -> Iterator[tuple[Reals, int]]:
    rows = csv.reader(text.splitlines())
    names = [name.strip().lower() for name in next(rows, [])]
    if any(name not in names for name in COLUMNS):
        raise _wrong(path, "line 1", f"the columns are {', '.join(names) or 'missing'}")
    columns = [names.index(name) for name in COLUMNS]
    joint = names.index("joint") if "joint" in names else None
    for row in rows:
        if not "".join(row).strip():
            continue
        where = f"line {rows.line_num}"
        try:
            ends = np.array([float(row[k]) for k in columns]).reshape(2, 2)
            number = int(row[joint]) if joint is not None and row[joint].strip() else 0
        except (ValueError, IndexError):
            raise _wrong(path, where, f"{','.join(row)[:60]!r} are not the numbers of a line") from None
        yield _checked(ends, path, where), number


def _geojson(text: str, path: Path) -> Iterator[tuple[Reals, int]]:
    try:
        whole = json.loads(text)
    except ValueError as error:
        raise _wrong(path, "GeoJSON", str(error)) from None
    features = whole.get("features", [whole]) if isinstance(whole, dict) else []
    for k, feature in enumerate(features):
        where = f"feature {k + 1}"
        if not isinstance(feature, dict):
            raise _wrong(path, where, "it is no object")
        shape = feature.get("geometry", feature)
        joint = (feature.get("properties") or {}).get("joint", 0)
        if not isinstance(shape, dict) or not isinstance(joint, int):
            raise _wrong(path, where, "it has no geometry, or a joint that is no integer")
        for points in _lines(shape):
            try:
                line = np.array([[float(x), float(y)] for x, y, *_ in points])
            except (TypeError, ValueError):
                raise _wrong(path, where, "its coordinates are not points") from None
            yield _checked(line, path, where), joint


def _lines(shape: dict[str, Any]) -> list[Any]:
    """The lists of points of a geometry; none for points and other things."""
    points: Any = shape.get("coordinates", [])
    kind = shape.get("type")
    if kind == "LineString":
        return [points]
    if kind in ("MultiLineString", "Polygon"):
        return list(points)
    if kind == "MultiPolygon":
        return [ring for polygon in points for ring in polygon]
    return []


def _checked(line: Reals, path: Path, where: str) -> Reals:
    """The line; error 28 unless it has two different points, all finite."""
    if len(line) < 2 or not np.isfinite(line).all() or not np.ptp(line, axis=0).any():
        raise _wrong(path, where, "a line has two different points with finite coordinates")
    return line
