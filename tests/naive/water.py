"""Water by hand: networks by Kirchhoff's laws, a joint that closes, a chain of reservoirs, a polygon."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import numpy as np


def kirchhoff(
    pipes: Iterable[tuple[Hashable, Hashable, float]], given: Mapping[Hashable, float]
) -> dict[Hashable, float]:
    """Potentials of all nodes. pipes: two nodes and the flow by difference. given: known potentials."""
    pipes = list(pipes)
    nodes = [node for node in dict.fromkeys(n for one in pipes for n in one[:2]) if node not in given]
    place = {node: k for k, node in enumerate(nodes)}
    matrix, right = np.zeros((len(nodes), len(nodes))), np.zeros(len(nodes))
    for a, b, k in pipes:
        for here, there in ((a, b), (b, a)):
            if here in place:
                matrix[place[here], place[here]] += k
                if there in place:
                    matrix[place[here], place[there]] -= k
                else:
                    right[place[here]] += k * given[there]
    return dict(zip(nodes, np.linalg.solve(matrix, right), strict=True)) | dict(given)


def cubic(aperture: float, length: float, viscosity: float) -> float:
    """Flow along a joint by difference of pressure, m2/(Pa.s)."""
    return aperture**3 / (12 * viscosity * length)


def pressure_of_closing(kw: float, aperture: float, closure: float) -> float:
    """Pressure in a joint that closes undrained from no pressure: the water keeps its amount."""
    return kw * closure / (aperture - closure)


def diffuse(p: np.ndarray, k: float, capacity: float, dt: float, steps: int, ends: Any) -> np.ndarray:
    """Pressures in a chain of reservoirs after steps of flow. ends: pressures beyond it, None for closed."""
    p = p.copy()
    for _ in range(steps):
        flow = np.zeros(len(p) + 1)  # to the right, between reservoirs and at the ends
        flow[1:-1] = k * (p[:-1] - p[1:])
        if ends[0] is not None:
            flow[0] = 2 * k * (ends[0] - p[0])
        if ends[1] is not None:
            flow[-1] = 2 * k * (p[-1] - ends[1])
        p += dt / capacity * (flow[:-1] - flow[1:])
    return p


def area(corners: Iterable[tuple[float, float]]) -> float:
    """Area inside a polygon."""
    x, y = np.array(list(corners)).T
    return abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))) / 2
