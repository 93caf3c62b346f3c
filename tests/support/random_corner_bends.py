"""Random bends: nearly straight corners of deformable blocks are bent through the straight line and back.

Two blocks meet at a corner of each that turns by a few degrees, or one of them has a straight edge there.
Every corner is driven: the upper block moves as one, the lower block's nearly straight corner goes up and
down. So corners lose their arcs and get them again while others touch them. Played on a WatchedModel while
it is drawn; lengths are drawn in edges, speeds in rounding lengths a step.
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np

from support.random_impacts import drive
from support.watched_model import WatchedModel

Rng = np.random.Generator
Vector = Any  # array of two

WIDE, HIGH = 2.0, 1.0  # half the box


class Frame:
    """Where the scene's own coordinates lie: turned, and shifted."""

    def __init__(self, rng: Rng) -> None:
        angle = float(rng.choice([0.0, pi / 2, pi])) if rng.random() < 0.5 else float(rng.uniform(0, 2 * pi))
        self.turn = np.array([[cos(angle), -sin(angle)], [sin(angle), cos(angle)]])
        self.shift = rng.uniform(-3, 3, 2)

    def place(self, *points: tuple[float, float]) -> list[float]:
        """Points as numbers of a command."""
        return [float(v) for point in points for v in self.turn @ point + self.shift]

    def own(self, point: Vector) -> Vector:
        """A point in the scene's own coordinates."""
        return (point - self.shift) @ self.turn


def _around(point: Vector, reach: float) -> list[float]:
    """The range around a point."""
    x, y = (float(v) for v in point)
    return [x - reach, x + reach, y - reach, y + reach]


def _cut(stage: WatchedModel, rng: Rng, frame: Frame) -> None:
    """A box, cut across so that thin wedges left and right of a point can be taken away; two blocks stay."""
    stage.do("block", *frame.place((-WIDE, -HIGH), (-WIDE, HIGH), (WIDE, HIGH), (WIDE, -HIGH)))
    middle, rise, fall = float(rng.uniform(-0.5, 0.5)), *(float(s) for s in rng.uniform(0.01, 0.06, 2))
    left, right = -WIDE - middle, WIDE - middle  # from the point to both sides
    flat = rng.random() < 0.3  # the upper block has a straight edge there
    if flat:
        lines = [(left, 0.0, right, 0.0), (left, rise * left, 0.0, 0.0), (0.0, 0.0, right, -fall * right)]
        wedges = [(left, rise * left), (right, -fall * right)]
    else:
        lines = [(left, rise * left, right, rise * right), (left, -fall * left, right, -fall * right)]
        wedges = [(left, (rise - fall) * left), (right, (rise - fall) * right)]
    for x1, y1, x2, y2 in lines:
        dx, dy = 0.001 * (x2 - x1), 0.001 * (y2 - y1)
        stage.do("split", *frame.place((middle + x1 - dx, y1 - dy), (middle + x2 + dx, y2 + dy)))
    for x, y in wedges:
        stage.do("delete", *_around(frame.place((middle + 2 * x / 3, y / 3)), 0.01))


def bend(stage: WatchedModel, rng: Rng) -> None:
    """Draw a bend and play it. Raises Wrong or Over."""
    frame, stiff = Frame(rng), 10.0 ** rng.uniform(7, 9)
    stage.do("property", 1, density=2000.0, kn=stiff, ks=stiff, friction=0.5, bulk=stiff * 20, g=stiff * 12)
    _cut(stage, rng, frame)
    stage.do("round", float(10.0 ** rng.uniform(-2, -0.7)))
    outline = {ib: body.corners for ib, body in stage.bodies().items()}
    if len(outline) != 2 or not stage.d:
        return
    lower, upper = sorted(outline, key=lambda ib: float(frame.own(stage.centroid(ib))[1]))
    for ib in (lower, upper)[: 1 + int(rng.random() < 0.3)]:
        stage.do("generate", *_around(stage.centroid(ib), 0.01), "automatic", edge=2.5 * WIDE)
    stage.do("cycle", 0)
    apex = int((frame.own(outline[lower]) - (0, HIGH))[:, 1].argmax())
    for _ in range(int(rng.integers(3, 12))):
        lift = float(rng.choice([-1, 1]) * 10.0 ** rng.uniform(-2.5, -0.2))
        follow = lift + float(rng.normal() * 10.0 ** rng.uniform(-3.5, -1))
        aside = float(rng.normal() * 10.0 ** rng.uniform(-3, -0.5))
        ring, step = stage.bodies()[lower].corners, stage.d / stage.step
        x, y = (float(v) for v in frame.turn @ (0.0, lift) * step)
        for k, corner in enumerate(ring):
            moves = k == apex
            reach = 0.1 * stage.d
            stage.do("boundary", *_around(corner, reach), xvel=moves * x, yvel=moves * y)
        x, y = (float(v) for v in frame.turn @ (aside, follow) * step)
        drive(stage, upper, xvel=x, yvel=y)
        stage.cycle(int(rng.integers(1, 30)))
        stage.check()
