"""Lines of fractures in a file: CSV with the ends of each, or GeoJSON (FRACTURES)."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.kernels.constitutive.joint_materials import JOINTS
from udec_ia.ops.cuts.block_division import Reals

COLUMNS = ("x1", "y1", "x2", "y2")
LARGEST = 100_000_000  # bytes


class Fractures(NamedTuple):
    """Polylines, each (k, 2), the number of the joint of each, 0 if the file gives none.

    ignored: number of features without lines.
    """

    lines: list[Reals]
    joints: list[int]
    ignored: int


def read_fractures(path: Path) -> Fractures:
    """The fractures in a file: GeoJSON if its name ends in json, else CSV with the columns x1, y1, x2, y2.

    CSV may have a column joint, and GeoJSON a property joint. Error 28 with the line or feature for a file
    that is neither, 4 for the number of a joint that cannot be, 29 if it cannot be read.
    """
    try:
        return _read(path)
    except OSError as error:
        raise UdecError(
            29, f"{path}: {error.strerror}", "give a CSV or GeoJSON file", parameter="path"
        ) from error


def _read(path: Path) -> Fractures:
    if path.stat().st_size > LARGEST:
        raise UdecError(28, f"{path} has more than {LARGEST:,} bytes", parameter="path")
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    found = [*(_geojson(text, path) if path.suffix.lower().endswith("json") else _csv(text, path))]
    lines = [(line, joint) for line, joint in found if line is not None]
    return Fractures([line for line, _ in lines], [joint for _, joint in lines], len(found) - len(lines))


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
            if len(row) > len(names):
                raise ValueError
            number = int(row[joint]) if joint is not None and row[joint].strip() else 0
        except (ValueError, IndexError):
            raise _wrong(path, where, f"{','.join(row)[:60]!r} are not the numbers of a line") from None
        yield _checked(ends, path, where), _joint(number, path, where)


def _joint(number: int, path: Path, where: str) -> int:
    """The number of a joint, 0 for none. Error 4."""
    if not 0 <= number < JOINTS:
        raise UdecError(4, f"{path}, {where}: joint {number}", f"joints are numbered from 1 to {JOINTS - 1}")
    return number


def _geojson(text: str, path: Path) -> Iterator[tuple[Reals | None, int]]:
    """The lines of all features; None for a feature without lines."""
    try:
        whole = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise _wrong(path, "GeoJSON", str(error)) from None
    features = whole.get("features", [whole]) if isinstance(whole, dict) else None
    if not isinstance(features, list):
        raise _wrong(path, "GeoJSON", "it has no list of features")
    for k, feature in enumerate(features):
        where = f"feature {k + 1}"
        if not isinstance(feature, dict):
            raise _wrong(path, where, "it is no object")
        shape = feature.get("geometry", feature)
        properties = feature.get("properties") or {}
        joint: Any = (properties.get("joint") or 0) if isinstance(properties, dict) else None
        is_number = isinstance(joint, int | float) and not isinstance(joint, bool)
        if not isinstance(shape, dict) or not is_number or not float(joint).is_integer():
            raise _wrong(path, where, "it has no geometry, or a joint that is no integer")
        lines = _lines(shape)
        if not lines:
            yield None, 0
        for points in lines:
            try:
                line = np.array([[float(x), float(y)] for x, y, *_ in points])
            except (TypeError, ValueError):
                raise _wrong(path, where, "its coordinates are not points") from None
            yield _checked(line, path, where), _joint(int(joint), path, where)


def _lines(shape: dict[str, Any]) -> list[Any]:
    """The lists of points of a geometry; none for points and other things."""
    points: Any = shape.get("coordinates") or []
    if not isinstance(points, list):
        return [points]
    kind = shape.get("type")
    if kind == "GeometryCollection":
        return [
            line for one in shape.get("geometries") or [] if isinstance(one, dict) for line in _lines(one)
        ]
    if kind == "LineString":
        return [points]
    if kind in ("MultiLineString", "Polygon"):
        return list(points)
    if kind == "MultiPolygon":
        return [ring for polygon in points for ring in (polygon if isinstance(polygon, list) else [polygon])]
    return []


def _checked(line: Reals, path: Path, where: str) -> Reals:
    """The line; error 28 unless it has two different points, all finite."""
    if len(line) < 2 or not np.isfinite(line).all() or not np.ptp(line, axis=0).any():
        raise _wrong(path, where, "a line has two different points with finite coordinates")
    return line
