"""Grazes: two bodies with faces of slight bends slide over one another, straight, blunt and in notches.

Both are cut from one block with a slit. Every bend of a face is convex or concave by 1e-4 to 0.15 radians,
so the circles of its corners are far greater than the rounding length, and their centres far away. Played on
a WatchedModel while it is drawn; lengths are drawn in edges, speeds in rounding lengths a step. The
checker looks after every cycle: a contact that is missing for one cycle only is what such corners do.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from support.random_corner_bends import Frame
from support.random_impacts import drive, edges, near
from support.watched_model import WatchedModel
from udec_ia.heap.accessors import HEAD, iget
from udec_ia.layout.offsets import MFDEF

Rng = np.random.Generator
Vector = Any  # array of two

LONG, THICK = 4.0, 1.0  # a body
WEB = 0.5  # width of what joins them before the cut
CYCLES = 60
APART = 1e3  # a block farther away than this has nothing to do with the other


def _face(rng: Rng, slope: float) -> Any:
    """Points (n, 2) of a face from (0, 0) to (LONG, ...), each bent by up to about `slope`."""
    n = int(rng.integers(1, 4))
    x = np.sort(rng.uniform(0.15, 0.85, n)) * LONG
    x = np.concatenate(([0.0], x, [LONG]))
    y = np.concatenate(([0.0], rng.normal(0, slope, n + 1) * np.diff(x)))
    return np.stack([x, np.cumsum(y) if rng.random() < 0.5 else y], axis=1)


def _slit(rng: Rng) -> tuple[Any, Any]:
    """Two faces, the upper above the lower by a small gap at the nearest place."""
    slope = 10.0 ** rng.uniform(-4, -0.8)
    lower, upper = _face(rng, slope), _face(rng, slope)
    x = np.concatenate([lower[:, 0], upper[:, 0]])
    close = (np.interp(x, *lower.T) - np.interp(x, *upper.T)).max()
    upper[:, 1] += close + 10.0 ** rng.uniform(-3, -1.5)
    return lower, upper


def _cut(stage: WatchedModel, rng: Rng, frame: Frame) -> bool:
    """Two bodies with a slit between them, rounded; False if they cannot be made."""
    lower, upper = _slit(rng)
    floor, top = lower[:, 1].min() - THICK, upper[:, 1].max() + THICK
    ring = [(-WEB, floor), (-WEB, top), (0.0, top), (LONG, top), *upper[::-1], (-WEB / 2, upper[0, 1])]
    ring += [(-WEB / 2, lower[0, 1]), *lower, (LONG, floor), (0.0, floor)]
    if stage.do("block", *frame.place(*ring)) is None:
        return False
    stage.do("split", *frame.place((0.0, floor - 1), (0.0, top + 1)))
    web = min(stage.bodies(), key=lambda ib: float(frame.own(stage.centroid(ib))[0]))
    if stage.do("delete", *near(stage, web)) is None or len(stage.bodies()) != 2:
        return False
    shortest = min(edges(body.corners).min() for body in stage.bodies().values())
    return stage.do("round", float(shortest * 10.0 ** rng.uniform(-2, np.log10(0.45)))) is not None


def _soften(stage: WatchedModel, rng: Rng, *blocks: int) -> None:
    """Make a body deformable, or both: its face bends further, then."""
    for ib in blocks:
        drawn = rng.random()
        if drawn < 0.35:
            stage.do("generate", *near(stage, ib), "automatic", edge=float(rng.uniform(0.4, 1.5) * LONG))
        elif drawn < 0.45:
            stage.do("change", *near(stage, ib), type="sdef")


def graze(stage: WatchedModel, rng: Rng) -> None:
    """Draw a graze and play it. Raises Wrong or Over."""
    frame, stiff = Frame(rng), 10.0 ** rng.uniform(7, 9)
    friction = float(rng.choice([0.0, 0.5]))
    stage.do(
        "property", 1, density=2000.0, kn=stiff, ks=stiff, friction=friction, bulk=stiff * 20, g=stiff * 12
    )
    if not _cut(stage, rng, frame):
        return
    lower, upper = sorted(stage.bodies(), key=lambda ib: float(frame.own(stage.centroid(ib))[1]))
    _soften(stage, rng, lower, upper)
    stage.do("fix", *near(stage, lower))
    stage.do("cycle", 0)
    if stage.errors or stage.step <= 0.0:
        return
    soft = iget(stage.model.h, upper, HEAD) == MFDEF
    driven, left = soft or rng.random() < 0.5, CYCLES
    while left > 0:
        n = int(min(left, rng.integers(1, 25)))
        left -= n
        aside = float(rng.choice([-1, 1]) * 10.0 ** rng.uniform(-2, 0))
        down = float(rng.choice([-1, -1, -1, 1]) * 10.0 ** rng.uniform(-4, -1))
        x, y = (float(v) for v in frame.turn @ (aside, down) * stage.d / stage.step)
        if driven:
            drive(stage, upper, xvel=x, yvel=y)
        else:
            stage.throw(upper, x, y, float(rng.normal(0, 0.1) * np.hypot(x, y) / LONG))
        for _ in range(n):
            stage.cycle(1)
            stage.check()
        if np.hypot(*(stage.centroid(upper) - stage.centroid(lower))) > APART:
            return
