"""Random patterns of cuts of a random convex block, for models of every word scheme."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

from udec_ia import Model, UdecError

COMMANDS = ("jset", "traces", "voronoi", "tunnel", "polyline", "arc")


def random_block(rng: np.random.Generator) -> Any:
    """A convex polygon of 3 to 8 corners, some 10 across, as a shapely polygon."""
    while True:
        angle = np.sort(rng.uniform(0, 2 * np.pi, rng.integers(3, 9)))
        radius = rng.uniform(4, 6)
        points = np.column_stack([np.cos(angle), np.sin(angle)]) * radius + rng.uniform(-20, 20, 2)
        hull = shapely.MultiPoint(points).convex_hull
        if hull.geom_type == "Polygon" and hull.area > 20:
            return hull


def model_of(polygon: Any, build: str = "i32r64") -> Model:
    """One rigid block with that outline."""
    m = Model(build=build)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    outline = shapely.get_coordinates(shapely.orient_polygons(polygon, exterior_cw=True).exterior)[:-1]
    m.block(*outline.ravel().tolist())
    return m


def cut_somehow(m: Model, rng: np.random.Generator, polygon: Any) -> str:
    """Cut by one random command. Returns its name."""
    x, y = polygon.centroid.coords[0]
    name = str(rng.choice(COMMANDS))
    angle = float(rng.choice([0, 30, 45, 90, rng.uniform(0, 180)]))
    words: dict[str, Any] = {"glued": True} if rng.random() < 0.2 else {}
    if rng.random() < 0.3:
        words["keep"] = True
    if name == "jset":
        spacing = float(rng.uniform(0.8, 3))
        m.jset((angle, 2.0), spacing=(spacing, 0.2), seed=int(rng.integers(100)), **words)
    elif name == "traces":
        limits = (x - 3, x + 3, y - 2, y + 2) if rng.random() < 0.5 else None
        trace, gap = float(rng.uniform(1, 5)), float(rng.uniform(0, 1))
        m.jset(angle, spacing=1.0, trace=(trace, 0.5), gap=gap, origin=(x, y), within=limits, **words)
    elif name == "voronoi":
        limits = (x - 2, x + 2, y - 2, y + 2) if rng.random() < 0.5 else None
        m.voronoi(float(rng.uniform(0.6, 1.5)), seed=int(rng.integers(100)), within=limits, **words)
    elif name == "tunnel":
        m.tunnel(x + rng.uniform(-2, 2), y + rng.uniform(-2, 2), float(rng.uniform(0.5, 3)), 12, **words)
    elif name == "arc":
        m.arc(x, y, x + 2.5, y, angle + 90, 9, **words)
    else:
        points = np.array([x, y]) + rng.uniform(-7, 7, (int(rng.integers(2, 6)), 2))
        m.polyline(*points.ravel().tolist(), **words)
    return name


def random_rock(seed: int, build: str = "i32r64") -> tuple[Model, Any, list[str]]:
    """A model with one to four random cuts, the outline of its block, and what was done.

    Of commands that are refused, "14" or "27" was done.
    """
    rng = np.random.default_rng(seed)
    polygon = random_block(rng)
    m = model_of(polygon, build)
    done = []
    for _ in range(int(rng.integers(1, 5))):
        try:
            done.append(cut_somehow(m, rng, polygon))
        except UdecError as error:
            if error.number not in (14, 27):
                raise
            done.append(str(error.number))
    return m, polygon, done


def polygons(m: Model) -> list[Any]:
    """All blocks as shapely polygons."""
    corners = m.table("corner")
    rows = {int(one["address"]): one for one in corners}
    found = []
    for ib in m.table("block"):
        points, ip = [], int(ib["KP"])
        while not points or ip != int(ib["KP"]):
            points.append((float(rows[ip]["KXP"]), float(rows[ip]["KYP"])))
            ip = int(rows[ip]["KR"])
        found.append(shapely.Polygon(points))
    return found
