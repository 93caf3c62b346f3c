"""Momentum, forces and stresses of blocks of all three types, added up from the tables of a model.

Only numbers are read, never a sum that the program keeps for itself: momentum from masses and velocities,
forces on blocks and grid-points from the contacts and the zones, one after the other.
"""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np

Model = Any
RIGID, SIMPLY, FULLY = 1, 2, 3
ON_CORNERS, ON_EDGE_OF_TWO, ON_EDGE_OF_ONE, VIRTUAL = 1, 2, 3, 4


def by_address(rows: Any) -> dict[int, Any]:
    """Rows of a table by their addresses."""
    return {int(row["address"]): row for row in rows}


def points_of(model: Model) -> dict[int, list[Any]]:
    """Grid-points of every fully-deformable block, by the block's address."""
    points, extensions = by_address(model.table("gridpoint")), by_address(model.table("fdef"))
    found = {}
    for row in model.table("block"):
        if row["HEAD"] == FULLY:
            found[int(row["address"])] = []
            ig = int(extensions[int(row["KBEX"])]["KFG"])
            while ig:
                found[int(row["address"])].append(points[ig])
                ig = int(points[ig]["KG"])
    return found


def zones_of(model: Model) -> dict[int, list[Any]]:
    """Zones of every fully-deformable block, by the block's address."""
    zones, extensions = by_address(model.table("zone")), by_address(model.table("fdef"))
    found = {}
    for row in model.table("block"):
        if row["HEAD"] == FULLY:
            found[int(row["address"])] = []
            iz = int(extensions[int(row["KBEX"])]["KFZ"])
            while iz:
                found[int(row["address"])].append(zones[iz])
                iz = int(zones[iz]["KZ"])
    return found


def momentum(model: Model) -> tuple[Any, Any]:
    """Momentum in x and y and angular momentum about the origin, and the sizes of what is added up."""
    points, parts = points_of(model), []
    for row in model.table("block"):
        inner = points.get(int(row["address"]), [])
        for p in inner:
            x, y, m, u, v = (float(p[k]) for k in ("KXG", "KYG", "KGPM", "KXDG", "KYDG"))
            parts.append((m * u, m * v, m * (x * v - y * u)))
        if not inner:
            x, y, m, u, v = (float(row[k]) for k in ("KX", "KY", "KBM", "KXD", "KYD"))
            parts.append((m * u, m * v, m * (x * v - y * u)))
            parts.append((0.0, 0.0, float(row["KBI"]) * float(row["KTD"])))
    table = np.array(parts)
    return table.sum(axis=0), np.abs(table).sum(axis=0)


def outlines(model: Model) -> dict[int, list[Any]]:
    """Corners of every block, clockwise, by the block's address."""
    found: dict[int, list[Any]] = {}
    for corner in model.table("corner"):
        found.setdefault(int(corner["KNB"]), []).append(corner)
    return found


def area_and_moments(corners: list[tuple[float, float]]) -> tuple[float, float, float, Any]:
    """Area, centroid and second moments of area about it (2 x 2), by triangles from the first corner."""
    x0, y0 = corners[0]
    area, first, second = 0.0, np.zeros(2), np.zeros((2, 2))
    for (ax, ay), (bx, by) in pairwise(corners[1:]):
        a, b = np.array((ax - x0, ay - y0)), np.array((bx - x0, by - y0))
        size = (b[0] * a[1] - a[0] * b[1]) / 2  # clockwise outlines are positive
        area += size
        first += size * (a + b) / 3
        for u in (a, b, a + b):
            second += size * np.outer(u, u) / 12
    c = first / area
    return area, x0 + float(c[0]), y0 + float(c[1]), second - area * np.outer(c, c)


def contact_forces(model: Model) -> list[tuple[Any, Any, Any]]:
    """(contact, place, force on its second block) for every contact that carries a force."""
    corners, found = by_address(model.table("corner")), []
    for row in model.table("contact"):
        if row["KCCOD"] == VIRTUAL or row["KCFN"] == 0:
            continue
        one, two = corners[int(row["KCP1"])], corners[int(row["KCP2"])]
        if row["KCCOD"] == ON_CORNERS:
            n = np.array((two["KXCP"] - one["KXCP"], two["KYCP"] - one["KYCP"]), float)
        else:
            end = two if row["KCCOD"] == ON_EDGE_OF_TWO else one
            start = corners[int(end["KR"])]
            tx, ty = float(end["KXP"] - start["KXP"]), float(end["KYP"] - start["KYP"])
            n = np.array((-ty, tx)) if end is one else np.array((ty, -tx))
        n /= hypot(*n)
        force = row["KCFN"] * n + row["KCFS"] * np.array((n[1], -n[0]))
        found.append((row, np.array((row["KXC"], row["KYC"]), float), force))
    return found


def block_forces(model: Model) -> dict[int, Any]:
    """Force and moment about the centroid that the contacts exert on each block: x, y, moment."""
    blocks = by_address(model.table("block"))
    found = {ib: np.zeros(3) for ib in blocks}
    for row, place, force in contact_forces(model):
        for ib, f in ((int(row["KB1"]), -force), (int(row["KB2"]), force)):
            rx, ry = place[0] - blocks[ib]["KX"], place[1] - blocks[ib]["KY"]
            found[ib] += (f[0], f[1], rx * f[1] - ry * f[0])
    return found


def applied_stress(model: Model, ib: int) -> Any:
    """Sum of force times place about the centroid of block `ib` over its contacts (2 x 2), and its area."""
    block = by_address(model.table("block"))[ib]
    total = np.zeros((2, 2))
    for row, place, force in contact_forces(model):
        for here, f in ((int(row["KB1"]), -force), (int(row["KB2"]), force)):
            if here == ib:
                total += np.outer(f, place - (float(block["KX"]), float(block["KY"])))
    ring = [(float(c["KXP"]), float(c["KYP"])) for c in outlines(model)[ib]]
    return total, area_and_moments(ring)[0]


def mean_stress(model: Model, ib: int) -> Any:
    """Mean internal stress 11, 12, 22 of deformable block `ib`, by area."""
    block = by_address(model.table("block"))[ib]
    if block["HEAD"] == SIMPLY:
        row = by_address(model.table("sdef"))[int(block["KBEX"])]
        return np.array([row["KS111"], (row["KS112"] + row["KS121"]) / 2, row["KS122"]], float)
    zones, points = zones_of(model)[ib], by_address(model.table("gridpoint"))
    if not zones:
        row = by_address(model.table("fdef"))[int(block["KBEX"])]
        return np.array([row["KFS11"], row["KFS12"], row["KFS22"]], float)
    total, size = np.zeros(3), 0.0
    for zone in zones:
        area = zone_area(points, zone)
        total += area * np.array([zone["KZS11"], zone["KZS12"], zone["KZS22"]], float)
        size += area
    return total / size


def zone_area(points: dict[int, Any], zone: Any) -> float:
    """Area of a zone, whose grid-points run clockwise."""
    a, b, c = (points[int(ig)] for ig in zone["KZG"])
    ux, uy = float(b["KXG"] - a["KXG"]), float(b["KYG"] - a["KYG"])
    vx, vy = float(c["KXG"] - a["KXG"]), float(c["KYG"] - a["KYG"])
    return (vx * uy - vy * ux) / 2


def zone_forces(model: Model) -> dict[int, Any]:
    """Forces of the stresses in the zones on the grid-points, by address: half of each side's traction."""
    points = by_address(model.table("gridpoint"))
    found = {ig: np.zeros(2) for ig in points}
    for zone in model.table("zone"):
        stress = np.array([[zone["KZS11"], zone["KZS12"]], [zone["KZS12"], zone["KZS22"]]], float)
        ring = [int(ig) for ig in zone["KZG"]]
        for one, two in zip(ring, [*ring[1:], ring[0]], strict=True):
            tx, ty = (float(points[two][k] - points[one][k]) for k in ("KXG", "KYG"))
            outwards = np.array((-ty, tx))  # of a clockwise side, times its length
            for ig in (one, two):
                found[ig] -= stress @ outwards / 2
    return found
