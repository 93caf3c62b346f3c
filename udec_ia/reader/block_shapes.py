"""Shapes of blocks: shortest edges, smallest areas, sharpest angles, and what they cost (GEOMETRY)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.reader.group_tables import table

LISTED = 5  # of each kind


class Shape(NamedTuple):
    """An edge (m), a block (m2) or an angle (degrees), at a place, and the block that it belongs to."""

    value: float
    x: float
    y: float
    block: int


class Shapes(NamedTuple):
    """The shortest edges, the smallest blocks, the sharpest angles, and medians of edges and areas."""

    edges: list[Shape]
    areas: list[Shape]
    angles: list[Shape]
    median_edge: float
    median_area: float

    @property
    def short(self) -> str:
        """One line: the worst of each kind."""
        edge, area, angle = self.edges[0], self.areas[0], self.angles[0]
        parts = (
            f"shortest edge {edge.value:.4g} m at ({edge.x:.4g}, {edge.y:.4g})",
            f"smallest block {area.value:.4g} m2 at ({area.x:.4g}, {area.y:.4g})",
            f"sharpest angle {angle.value:.3g} degrees at ({angle.x:.4g}, {angle.y:.4g})",
        )
        return ", ".join(parts)

    def __str__(self) -> str:
        lines = []
        for title, unit, found in (
            ("Shortest edges", "m", self.edges),
            ("Smallest blocks", "m2", self.areas),
            ("Sharpest angles", "degrees", self.angles),
        ):
            lines.append(title)
            for one in found:
                lines.append(f"{one.value:12.6g} {unit:8} block@{one.block} at ({one.x:.6g}, {one.y:.6g})")
        slower = np.sqrt(self.median_area / self.areas[0].value)
        half, usual = self.edges[0].value / 2, self.median_edge / 2
        lines += [
            f"ROUND can be {half:.4g} m at most, half the shortest edge; half the median is {usual:.4g} m",
            f"the smallest block makes the time-step about {slower:.3g} times shorter than a median one, as "
            "the root of areas; TIDY a merges small blocks with others, DELETE AREA < a removes them",
        ]
        return "\n".join(lines)


def block_shapes(array: MainArray) -> Shapes | None:
    """The shapes of all blocks; None if there are none."""
    corners = table(array, "corner")
    if not len(corners):
        return None
    order = np.argsort(corners["address"])
    before = order[np.searchsorted(corners["address"], corners["KR"], sorter=order)]
    place = np.stack([corners["KXP"], corners["KYP"]], axis=1).astype(np.float64)
    along = place - place[before]  # the edge that ends at each corner
    after = np.empty_like(before)
    after[before] = np.arange(len(before))
    length = np.hypot(*along.T)
    middle = place - along / 2
    host = corners["KNB"]
    edges = _lowest(length, middle, host)
    inward, outward = -along, along[after]
    cosine = (inward * outward).sum(axis=1) / (length * length[after])
    cross = inward[:, 0] * outward[:, 1] - inward[:, 1] * outward[:, 0]
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    angles = _lowest(np.where(cross > 0, angle, 360 - angle), place, host)
    twice = place[:, 0] * place[before, 1] - place[before, 0] * place[:, 1]
    blocks = table(array, "block")
    row = np.argsort(blocks["address"])
    number = row[np.searchsorted(blocks["address"], host, sorter=row)]
    area = np.abs(np.bincount(number, twice, len(blocks))) / 2
    centres = np.stack([blocks["KX"], blocks["KY"]], axis=1).astype(np.float64)
    areas = _lowest(area, centres, blocks["address"])
    return Shapes(edges, areas, angles, float(np.median(length)), float(np.median(area)))


def _lowest(values: Any, places: Any, blocks: Any) -> list[Shape]:
    """The least values, in order."""
    worst = np.argsort(values, kind="stable")[:LISTED].tolist()
    return [Shape(float(values[k]), float(places[k, 0]), float(places[k, 1]), int(blocks[k])) for k in worst]
