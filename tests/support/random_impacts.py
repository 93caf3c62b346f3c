"""Random impacts: two bodies cut from one block, or a few, are driven or thrown at each other.

A strike is drawn from a generator and played on a WatchedModel while it is drawn. Lengths are drawn in edges,
speeds in rounding lengths a step (up to FAST along each axis): so every size, time-step and word scheme gives
impacts of the same kinds.
"""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, radians, sin
from typing import Any

import numpy as np

from support.watched_model import WatchedModel
from udec_ia.heap.accessors import HEAD, getr, iget
from udec_ia.layout.offsets import KBEX, KFG, KG, KXG, KYG, MFDEF

Rng = np.random.Generator
Outline = list[tuple[float, float]]
Vector = Any  # array of two

FAST = 3.0  # rounding lengths a step along an axis
TYPES = ("rigid", "sdef", "fdef")


# ---- bodies


def acute(rng: Rng) -> tuple[Outline, list[tuple[float, ...]]]:
    """A box and two cuts that cross at 5 to 60 degrees, or one that leaves a sharp end."""
    w, h = rng.uniform(2, 6, 2)
    box = [(0.0, 0.0), (0.0, h), (w, h), (w, 0.0)]
    x, y = rng.uniform(0.2, 0.8, 2) * (w, h)
    turn, angle = rng.uniform(0, pi), radians(rng.uniform(5, 60))
    cuts = [(x, y, turn), (x, y, turn + angle)]
    return box, cuts if rng.random() < 0.7 else cuts[:1]


def right(rng: Rng) -> tuple[Outline, list[tuple[float, ...]]]:
    """A box and one or two cuts along its sides."""
    w, h = rng.uniform(2, 6, 2)
    box = [(0.0, 0.0), (0.0, h), (w, h), (w, 0.0)]
    x, y = rng.uniform(0.2, 0.8, 2) * (w, h)
    cuts = [(x, y, 0.0), (x, y, pi / 2)]
    return box, cuts if rng.random() < 0.5 else [cuts[int(rng.integers(2))]]


def obtuse(rng: Rng) -> tuple[Outline, list[tuple[float, ...]]]:
    """A polygon of 5 to 9 corners and a cut somewhere through it."""
    n = int(rng.integers(5, 10))
    angles = -(np.arange(n) + rng.uniform(-0.2, 0.2, n)) * 2 * pi / n
    a, b = rng.uniform(1.5, 3, 2)
    ring = [(float(a * cos(t)), float(b * sin(t))) for t in angles]
    x, y = rng.uniform(-0.4, 0.4, 2) * (a, b)
    return ring, [(x, y, rng.uniform(0, pi))]


def concave(rng: Rng) -> tuple[Outline, list[tuple[float, ...]]]:
    """An L, a U or an arrow head, and a cut."""
    a, b, c, f, g = rng.uniform(0.8, 3, 5)
    ell = [(0, 0), (0, b + f), (a, b + f), (a, b), (a + c, b), (a + c, 0)]
    slope = rng.uniform(-0.3, 0.3) * a
    u = [(0, 0), (0, f + b), (a, f + b), (a + slope / 2, f), (a + c, f), (a + c, f + g), (a + c + a, f + g)]
    u.append((2 * a + c, 0))
    head = [(-a - b, -c), (0, f + g), (a + g, -c), (0.2 * b, -c + rng.uniform(0.2, 0.9) * (c + f))]
    ring = [(ell, u, head)[int(rng.integers(3))]][0]
    x = rng.uniform(0.1, 0.9) * max(p[0] for p in ring)
    y = rng.uniform(0.1, 0.9) * max(p[1] for p in ring)
    turn = rng.uniform(0, pi) if rng.random() < 0.6 else (0.0, pi / 2)[int(rng.integers(2))]
    return [(float(p), float(q)) for p, q in ring], [(x, y, turn)]


def needles(rng: Rng) -> tuple[Outline, list[tuple[float, ...]]]:
    """Two cuts that cross at 5 to 20 degrees: tip against tip."""
    w, h = rng.uniform(3, 6, 2)
    box = [(0.0, 0.0), (0.0, h), (w, h), (w, 0.0)]
    x, y = rng.uniform(0.35, 0.65, 2) * (w, h)
    turn, angle = rng.uniform(0, pi), radians(rng.uniform(5, 20))
    return box, [(x, y, turn), (x, y, turn + angle)]


SHAPES: dict[str, Callable[[Rng], tuple[Outline, list[tuple[float, ...]]]]] = {
    "acute": acute,
    "right": right,
    "obtuse": obtuse,
    "concave": concave,
    "needles": needles,
}


def moved(ring: Outline, cuts: list[tuple[float, ...]], rng: Rng, narrow: bool) -> tuple[Outline, list[Any]]:
    """The outline and the ends of its cuts, turned, scaled and shifted, perhaps far from the origin.

    Often the first cut lies at 45 degrees: a step across it is longer than along any axis.
    """
    angle = (0.0, rng.uniform(0, 2 * pi), pi / 4 - cuts[0][2])[int(rng.choice(3, p=(0.3, 0.35, 0.35)))]
    size = 10.0 ** rng.uniform(-2, 2) if rng.random() < 0.3 else 1.0
    shift = rng.uniform(-3, 3, 2)
    if rng.random() < 0.25:
        shift *= 10.0 ** rng.uniform(1, 1.7 if narrow else 4)
    c, s = cos(angle), sin(angle)

    def place(x: float, y: float) -> tuple[float, float]:
        return float(size * (c * x - s * y + shift[0])), float(size * (s * x + c * y + shift[1]))

    ends = []
    for x, y, turn in cuts:
        dx, dy = 20 * cos(turn), 20 * sin(turn)
        ends.append((*place(x - dx, y - dy), *place(x + dx, y + dy)))
    return [place(x, y) for x, y in ring], ends


# ---- a strike


def strike(stage: WatchedModel, kind: str, rng: Rng, types: bool = True) -> None:
    """Draw a strike of the kind and play it; with `types`, blocks may deform. Raises Wrong or Over."""
    ring, cuts = moved(*SHAPES[kind](rng), rng, stage.build.endswith("32"))
    stiff = 10.0 ** rng.uniform(7, 9)
    stage.do(
        "property",
        1,
        density=2000.0,
        kn=stiff,
        ks=stiff,
        friction=float(rng.choice([0.0, 0.5, 1.0])),
        bulk=stiff * 20,
        g=stiff * 12,
    )
    if stage.do("block", *(number for point in ring for number in point)) is None:
        return
    for cut in cuts:
        stage.do("split", *cut)
    keep = 2 if kind == "needles" or rng.random() < 0.8 else 3
    pieces = list(stage.bodies())
    while len(pieces) > keep:
        gone = _needle_sides(stage, pieces) if kind == "needles" else int(rng.choice(pieces))
        if stage.do("delete", *near(stage, gone)) is None:
            break
        pieces = list(stage.bodies())
    if len(pieces) < 2:
        return
    shortest = min(edges(body.corners).min() for body in stage.bodies().values())
    if stage.do("round", float(shortest * 10.0 ** rng.uniform(-2, np.log10(0.49)))) is None:
        return
    mover, target = (int(ib) for ib in rng.permutation(pieces)[:2])
    if rng.random() < 0.8:
        for ib in pieces:
            if ib != mover:
                stage.do("fix", *near(stage, ib))
    if types and rng.random() < 0.4:
        _soften(stage, rng, mover, target)
    if rng.random() < 0.2:
        g = 10.0 ** rng.uniform(-1, 1)
        stage.do("gravity", float(rng.uniform(-g, g)), float(-g))
    stage.do("cycle", 0)
    if stage.errors or stage.step <= 0.0:
        return
    if kind == "needles" or rng.random() < 0.65:
        _near_strike(stage, kind, rng, mover, target)
    else:
        _aimed_strike(stage, rng, mover, target)
    stage.check()


def _needle_sides(stage: WatchedModel, pieces: list[int]) -> int:
    """The piece with the bluntest sharpest corner."""
    return max(pieces, key=lambda ib: sharpest(stage.bodies()[ib].corners))


def _soften(stage: WatchedModel, rng: Rng, *blocks: int) -> None:
    """Make some of the blocks deformable."""
    for ib in blocks:
        kind = str(rng.choice(TYPES))
        if kind == "sdef":
            stage.do("change", *near(stage, ib), type="sdef")
        elif kind == "fdef":
            corners = stage.bodies()[ib].corners
            size = float(np.ptp(corners, axis=0).max() * rng.uniform(0.3, 1.5))
            stage.do("generate", *near(stage, ib), "automatic", edge=max(size, 2.5 * stage.d))


def edges(corners: Any) -> Any:
    """Lengths of the edges."""
    return np.hypot(*(np.roll(corners, -1, axis=0) - corners).T)


def sharpest(corners: Any) -> float:
    """The least angle between two edges."""
    u, v = np.roll(corners, 1, axis=0) - corners, np.roll(corners, -1, axis=0) - corners
    return float(np.arctan2(np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), (u * v).sum(axis=1)).min())


def near(stage: WatchedModel, ib: int) -> tuple[float, float, float, float]:
    """A small range about the centroid of a block."""
    (x, y), size = stage.centroid(ib), 1e-3 * float(np.ptp(stage.bodies()[ib].corners, axis=0).max())
    size += 1e-6 * max(abs(x), abs(y))
    return float(x - size), float(x + size), float(y - size), float(y + size)


def drive(stage: WatchedModel, ib: int, rng: Rng | None = None, **words: Any) -> None:
    """BOUNDARY for one block: at its centroid, or at all grid-points of a fully-deformable one."""
    h = stage.model.h
    if iget(h, ib, HEAD) != MFDEF:
        stage.do("boundary", *near(stage, ib), **words)
        return
    ig, size = iget(h, iget(h, ib, KBEX), KFG), 1e-3 * float(edges(stage.bodies()[ib].corners).min())
    while ig:
        h = stage.model.h
        x, y = float(getr(h, ig, KXG)), float(getr(h, ig, KYG))
        stage.do("boundary", x - size, x + size, y - size, y + size, **words)
        ig = iget(stage.model.h, ig, KG)


def speed(rng: Rng) -> float:
    """A speed in rounding lengths a step: any, or one at which a step is about as long as contacts reach."""
    if rng.random() < 0.5:
        return float(rng.uniform(0.2, 1.2))
    return float(10.0 ** rng.uniform(-2, np.log10(FAST)))


def slow(rng: Rng) -> float:
    """A speed at which domains are updated every few dozen cycles only."""
    return float(10.0 ** rng.uniform(-3, -1))


def constant(rng: Rng, direction: Vector, cycles: int) -> list[tuple[int, Vector]]:
    """One velocity all along."""
    return [(cycles, direction * speed(rng))]


def rising(rng: Rng, direction: Vector, cycles: int) -> list[tuple[int, Vector]]:
    """Faster and faster."""
    s, factor, every = slow(rng), rng.uniform(1.05, 2), int(rng.integers(1, 6))
    return [(every, direction * min(s * factor**k, FAST)) for k in range(cycles // every)]


def slow_then_fast(rng: Rng, direction: Vector, cycles: int) -> list[tuple[int, Vector]]:
    """Some slow velocities, and then fast ones."""
    found = [(int(rng.integers(1, 40)), direction * slow(rng)) for _ in range(int(rng.integers(1, 4)))]
    quick = [(int(rng.integers(1, 4)), direction * speed(rng)) for _ in range(int(rng.integers(0, 4)))]
    return [*found, *quick, (cycles // 2, direction * speed(rng))]


def commanded(rng: Rng, direction: Vector, cycles: int) -> list[tuple[int, Vector]]:
    """Another speed every now and then, and another way, even back."""
    found = []
    while cycles > 0:
        n = int(min(cycles, rng.integers(1, 20)))
        found.append((n, direction * (speed(rng) if rng.random() < 0.6 else slow(rng))))
        cycles -= n
        if rng.random() < 0.3:
            direction = turned(direction, rng.normal(0, 0.5))
        if rng.random() < 0.15:
            direction = -direction
    return found


WAYS = (constant, rising, slow_then_fast, slow_then_fast, commanded)


def turned(v: Vector, angle: float) -> Vector:
    """The vector turned by an angle."""
    c, s = cos(angle), sin(angle)
    return np.array([c * v[0] - s * v[1], s * v[0] + c * v[1]])


def clipped(v: Vector) -> Vector:
    """Not more than FAST along each axis."""
    return v * min(1.0, FAST / max(float(np.abs(v).max()), 1e-12))


def _way(rng: Rng, direction: Vector, cycles: int) -> list[tuple[int, Vector]]:
    """How a block comes: cycles and the velocity in them, in rounding lengths a step."""
    return WAYS[int(rng.integers(len(WAYS)))](rng, direction, cycles)


def _run(stage: WatchedModel, rng: Rng, mover: int, way: list[tuple[int, Vector]]) -> None:
    """Drive the mover along its way; it may be let go, stopped or thrown in between."""
    free = rng.random() < 0.35
    release = int(rng.integers(len(way))) if free else len(way)
    soft = iget(stage.model.h, mover, HEAD) == MFDEF
    for k, (n, velocity) in enumerate(way):
        vx, vy = (float(v) for v in clipped(velocity) * stage.d / stage.step)
        if k > release:
            break
        if rng.random() < 0.05:
            stage.do("fix", *near(stage, mover))
            stage.cycle(int(rng.integers(1, 4)))
            stage.do("free", *near(stage, mover))
        if k == release and not soft and rng.random() < 0.4:
            drive(stage, mover, free=True)
            size = float(np.ptp(stage.bodies()[mover].corners, axis=0).max())
            spin = rng.uniform(-1, 1) * hypot(vx, vy) / size
            stage.throw(mover, vx, vy, float(spin))
            n = max(n, 60)
        elif rng.random() < 0.1:
            drive(stage, mover, **({"xvel": vx} if abs(vx) > abs(vy) else {"yvel": vy}))
        else:
            drive(stage, mover, xvel=vx, yvel=vy)
        if k == release:
            stage.cycle(1)
            drive(stage, mover, free=True)
            n = max(n, 60)
        stage.cycle(n)


def _near_strike(stage: WatchedModel, kind: str, rng: Rng, mover: int, target: int) -> None:
    """Away from the target by a few rounding lengths, and back."""
    tips = kind == "needles"
    away = stage.centroid(mover) - stage.centroid(target) if tips else _outwards(stage, mover, target)
    away = turned(away / np.hypot(*away), rng.normal(0, 0.1 if tips else 0.5) if rng.random() < 0.3 else 0.0)
    gap, s = float(10.0 ** rng.uniform(-0.5, 0.5)), float(10.0 ** rng.uniform(-2.3, 0))
    n = min(100, max(1, round(gap / s)))
    _go(stage, mover, away * gap / n, n)
    if tips:  # not quite tip on tip
        _go(stage, mover, turned(away, pi / 2) * rng.normal(0, 0.3), 1)
    back = turned(-away, rng.normal(0, 0.1 if tips else 0.6) if rng.random() < 0.4 else 0.0)
    way = _pounce(rng, back, gap) if rng.random() < 0.7 else _way(rng, back, int(rng.integers(40, 160)))
    _run(stage, rng, mover, way)


def _pounce(rng: Rng, direction: Vector, gap: float) -> list[tuple[int, Vector]]:
    """Slowly for a part of the gap, then one long step or a few, then slowly again."""
    left, n = (
        gap * rng.uniform(0, 1) if rng.random() < 0.5 else rng.uniform(0, 0.5),
        int(rng.integers(10, 60)),
    )
    axis = direction / np.abs(direction).max()
    jumps = 1 if rng.random() < 0.6 else int(rng.integers(1, 5))
    steps = [(1, axis * rng.uniform(0.3, 0.9)) for _ in range(jumps)]
    return [(n, direction * max(gap - left, 0.0) / n), *steps, (40, direction * slow(rng))]


def _go(stage: WatchedModel, mover: int, step: Vector, cycles: int) -> None:
    """Drive the mover by `step`, in rounding lengths, in each of some cycles."""
    vx, vy = (float(v) for v in clipped(step) * stage.d / stage.step)
    drive(stage, mover, xvel=vx, yvel=vy)
    stage.cycle(cycles)


def _outwards(stage: WatchedModel, mover: int, target: int) -> Vector:
    """The normal of an edge of the target that looks towards the mover's centroid best."""
    ring, to = stage.bodies()[target].corners, stage.centroid(mover)
    along = np.roll(ring, -1, axis=0) - ring
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / edges(ring)[:, None]
    seen = ((to - ring) * normal).sum(axis=1)
    return normal[int(seen.argmax())]


def _aimed_strike(stage: WatchedModel, rng: Rng, mover: int, target: int) -> None:
    """Away, aside, and then with a corner or an edge towards a corner or an edge of the target."""
    bodies = stage.bodies()
    size = float(np.ptp(bodies[target].corners, axis=0).max())
    away = _outwards(stage, mover, target)
    far = min(rng.uniform(0.05, 0.5) * size / stage.d, 60.0)
    s = min(float(rng.uniform(0.3, 2.0)), far)
    for way in (away, turned(away, pi / 2 * float(rng.choice([-1, 1])))):
        _go(stage, mover, way * s, max(1, round(far / s * rng.uniform(0.3, 1.0))))
    bodies = stage.bodies()
    one, two = (_point(rng, bodies[ib].corners) for ib in (mover, target))
    reach = two - one
    length = float(np.hypot(*reach))
    direction = reach / length if length > 0 else away  # two corners can lie in one place
    rest = length / stage.d - float(10.0 ** rng.uniform(-0.3, 1))
    if rest > 0:  # most of the way at one speed
        quick = min(max(rest / 80, speed(rng)), FAST)
        _go(stage, mover, direction * quick, min(120, max(1, int(rest / quick))))
    _run(stage, rng, mover, _way(rng, direction, int(rng.integers(20, 100))))


def _point(rng: Rng, ring: Any) -> Vector:
    """A corner, or a point of an edge."""
    k = int(rng.integers(len(ring)))
    t = rng.uniform(0.1, 0.9) if rng.random() < 0.4 else 0.0
    return ring[k] + t * (ring[(k + 1) % len(ring)] - ring[k])
