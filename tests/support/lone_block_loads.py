"""A block of any type, alone, for boundary conditions, and what tractions add up to around its outline."""

from __future__ import annotations

from itertools import pairwise
from math import sqrt
from typing import Any

import numpy as np

from support.mechanics_scenes import model
from udec_ia import Model
from udec_ia.studies.verification_tools import fan

RHO, K, G, D = 2000.0, 2e8, 1e8, 0.05
CP, CS = sqrt((K + 4 * G / 3) / RHO), sqrt(G / RHO)
TYPES = ("rigid", "sdef", "zoned")
EVERYWHERE = (-100.0, 100.0, -100.0, 100.0)
SKEW = [(0.0, 0.0), (-0.3, 1.5), (1.0, 2.2), (2.5, 1.4), (1.8, -0.4)]


def lone(kind: str, ring: list[tuple[float, float]]) -> Model:
    """A block of `kind` without gravity or damping, alone."""
    m = model(*ring, d=D, gravity=(0.0, 0.0), density=RHO)
    m.property(1, bulk=K, g=G)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    elif kind == "zoned":
        fan(m, 0, 0, edge_points=1)
    return m


def tractions(
    ring: list[tuple[float, float]], stress: Any, xgrad: Any, ygrad: Any, edges: int | None = None
) -> tuple[Any, Any]:
    """Resultant and moment about the origin of the tractions all around a clockwise outline.

    edges: number of edges that count, or all of them.

    By three points of Gauss on each edge, which are exact for any polynomial of the fifth degree.
    """
    nodes, weights = np.polynomial.legendre.leggauss(3)
    force, moment = np.zeros(2), 0.0
    for (ax, ay), (bx, by) in [*pairwise([*ring, ring[0]])][:edges]:
        normal = np.array((-(by - ay), bx - ax))  # outwards, times the length
        for s, w in zip((1 + nodes) / 2, weights / 2, strict=True):
            x, y = ax + s * (bx - ax), ay + s * (by - ay)
            s11, s12, s22 = np.array(stress) + x * np.array(xgrad) + y * np.array(ygrad)
            t = w * np.array([[s11, s12], [s12, s22]]) @ normal
            force += t
            moment += x * t[1] - y * t[0]
    return force, moment
