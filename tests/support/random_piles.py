"""Random assemblies that move for long: up to 60 blocks, gravity, friction, pull-outs, deletions.

A pile is drawn and played on a WatchedModel as strikes are. The extreme ones have sharp tips, small
roundings, slivers and far origins.
"""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Any

import numpy as np

from support.random_impacts import drive, edges, moved, near
from support.watched_model import WatchedModel
from udec_ia.heap.accessors import getr
from udec_ia.layout.offsets import AKN, KBM

Rng = np.random.Generator

PILES = ("long", "extreme")
MAX_BLOCKS = 60
CYCLES = 2000
STEP = 40  # cycles from one look to the next


def pile(stage: WatchedModel, kind: str, rng: Rng) -> None:
    """Draw a pile of the kind and play it. Raises Wrong or Over."""
    extreme = kind == "extreme"
    w, h = rng.uniform(4, 12, 2)
    box = [(0.0, 0.0), (0.0, h), (w, h), (w, 0.0)]
    ring, cuts = moved(box, _cuts(rng, w, h, extreme), rng, stage.build.endswith("32") or not extreme)
    stiff = 10.0 ** rng.uniform(7, 9)
    friction = float(rng.choice([0.0, 0.2, 0.5, 1.0]))
    stage.do(
        "property", 1, density=2000.0, kn=stiff, ks=stiff, friction=friction, bulk=stiff * 20, g=stiff * 12
    )
    if stage.do("block", *(number for point in ring for number in point)) is None:
        return
    for cut in cuts:
        if len(stage.bodies()) < MAX_BLOCKS / 2:
            stage.do("split", *cut)
    addresses = list(stage.bodies())
    if len(addresses) < 3:
        return
    size = float(np.ptp(np.array(ring), axis=0).max())
    shortest = min(edges(body.corners).min() for body in stage.bodies().values())
    low = 0.01 if extreme else 0.05
    if stage.do("round", float(shortest * rng.uniform(low, 0.2 if extreme else 0.45))) is None:
        return
    weight = 2000.0 * w * h * (size / max(w, h)) ** 2  # of all, with an acceleration of 1
    g = float(10.0 ** rng.uniform(-4.3, -1.7)) * stage.d * stiff / weight
    turn = rng.uniform(0, 2 * pi)
    down = np.array([cos(turn), sin(turn)])
    depths = {ib: float(stage.centroid(ib) @ down) for ib in addresses}
    lowest = sorted(addresses, key=lambda ib: -depths[ib])[: max(1, len(addresses) // 5)]
    for ib in lowest:
        stage.do("fix", *near(stage, ib))
    stage.do("gravity", float(g * down[0]), float(g * down[1]))
    if rng.random() < 0.3:
        loose = [ib for ib in addresses if ib not in lowest]
        ib = int(rng.choice(loose))
        if rng.random() < 0.5:
            stage.do("change", *near(stage, ib), type="sdef")
        else:
            edge = max(_extent(stage, ib), 2.5 * stage.d)
            stage.do("generate", *near(stage, ib), "automatic", edge=edge)
    if rng.random() < 0.5:
        stage.do("damping", float(rng.uniform(0.05, 0.5)), float(10 ** rng.uniform(0, 1.5)), "mass")
    stage.do("cycle", 0)
    if stage.step <= 0.0:
        return
    while stage.cycles < CYCLES:
        _event(stage, rng)
        stage.cycle(int(rng.integers(100, 400)), STEP)
        stage.check()


def _cuts(rng: Rng, w: float, h: float, extreme: bool) -> list[tuple[float, ...]]:
    """Joints: sets of parallel lines, single ones, and in the extreme ones that cross at a small angle."""
    found = []
    for _ in range(int(rng.integers(1, 4))):
        turn, n = rng.uniform(0, pi), int(rng.integers(1, 6))
        for t in rng.uniform(0.05, 0.95, n):
            found.append((t * w, rng.uniform(0.3, 0.7) * h, turn))
    for _ in range(int(rng.integers(0, 4))):
        found.append((rng.uniform(0, w), rng.uniform(0, h), rng.uniform(0, pi)))
    if extreme:
        for _ in range(int(rng.integers(1, 4))):
            x, y, turn = rng.uniform(0, w), rng.uniform(0, h), rng.uniform(0, pi)
            found += [(x, y, turn), (x, y, turn + radians(rng.uniform(5, 15)))]
    return [found[k] for k in rng.permutation(len(found))]


def _event(stage: WatchedModel, rng: Rng) -> Any:
    """Something happens: a block is deleted, pulled, thrown, let go, fixed or split."""
    blocks = list(stage.bodies())
    ib = int(rng.choice(blocks))
    what = int(rng.integers(8))
    s = float(10.0 ** rng.uniform(-3, 0)) * stage.d / _stopping(stage, ib)
    turn = rng.uniform(0, 2 * pi)
    vx, vy = float(s * cos(turn)), float(s * sin(turn))
    if what == 0 and len(blocks) > 3:
        stage.do("delete", *near(stage, ib))
    elif what == 1:
        drive(stage, ib, xvel=vx, yvel=vy)
    elif what == 2:
        stage.do("boundary", *_all(stage), free=True)
    elif what == 3:
        stage.do("free" if rng.random() < 0.5 else "fix", *near(stage, ib))
    elif what == 4 and len(blocks) < MAX_BLOCKS:
        (x, y), far = stage.centroid(ib), _extent(stage, ib)
        dx, dy = far * cos(turn), far * sin(turn)
        stage.do("split", float(x - dx), float(y - dy), float(x + dx), float(y + dy))
    elif what == 5:
        stage.throw(ib, vx, vy, float(rng.normal(0, 0.5) * s / _extent(stage, ib)))
    elif what == 6:
        stage.do("property", 1, friction=float(rng.uniform(0, 1)))


def _extent(stage: WatchedModel, ib: int) -> float:
    """The longer side of the box about a block."""
    return float(np.ptp(stage.bodies()[ib].corners, axis=0).max())


def _stopping(stage: WatchedModel, ib: int) -> float:
    """The time in which a contact stops a block: it goes as deep as its speed times that."""
    h = stage.model.h
    return max(float(np.sqrt(getr(h, ib, KBM) / h.cr[AKN])), stage.step)


def _all(stage: WatchedModel) -> tuple[float, float, float, float]:
    """A range about everything."""
    points = np.concatenate([body.corners for body in stage.bodies().values()])
    low, high = points.min(axis=0), points.max(axis=0)
    reach = high - low
    return (
        float(low[0] - reach[0]),
        float(high[0] + reach[0]),
        float(low[1] - reach[1]),
        float(high[1] + reach[1]),
    )
