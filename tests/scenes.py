"""Random scenes: a block, random joints, holes, materials, motion and all of it again while it runs.

A scene is drawn from a seed and depends on the blocks as they are (which one to delete, through which
corner to split), so it is drawn while it is played. What was done is kept twice: as steps that can be
played again on any other model, and as the lines of a deck that `udec run` accepts. Speeds, stiffnesses and
rounding lengths are drawn relative to each other, so that blocks fly, strike and slide within a few dozen
cycles and an overlap too great stays the exception.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import cos, hypot, pi, sin, sqrt
from typing import Any

import numpy as np
from naive.geometry import Outline, Point

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget, putr
from udec_ia.layout.offsets import (
    DTOL,
    IBPNT,
    KB,
    KBFIX,
    KBM,
    KBRO,
    KP,
    KR,
    KTD,
    KX,
    KXD,
    KXP,
    KY,
    KYD,
    KYP,
    NBLK,
    TDEL,
)
from udec_ia.model import Model

MAX_BLOCKS = 30
ENDS = (
    14,
    15,
    32,
)  # the cycle is completed, the map may be unsound
Numbers = tuple[float, ...]


@dataclass(frozen=True)
class Step:
    """One thing done to a model: a method of Model, or "throw" with the block's place in the block list."""

    name: str
    numbers: Numbers
    words: dict[str, Any] = field(default_factory=dict)


def blocks(model: Model) -> list[int]:
    """Addresses of the blocks, in list order."""
    h, found, ib = model.h, [], int(model.h.ci[IBPNT])
    while ib:
        found.append(ib)
        ib = iget(h, ib, KB)
    return found


def outline(model: Model, ib: int) -> Outline:
    """The corners of block `ib`, clockwise."""
    h, points, first = model.h, [], iget(model.h, ib, KP)
    ip = first
    while True:
        points.append((float(getr(h, ip, KXP)), float(getr(h, ip, KYP))))
        ip = iget(h, ip, KR)
        if ip == first:
            return points[::-1]


def lines_of(model: Model, step: Step) -> list[str]:
    """`step` as lines of a deck. A block is thrown by three RSETs."""
    numbers = " ".join(f"{number:.17g}" for number in step.numbers)
    if step.name == "throw":
        ib, which = blocks(model)[int(step.numbers[0])], model.array.scheme.ratio >> 1
        pairs = zip((KXD, KYD, KTD), step.numbers[1:], strict=True)
        return [f"RSET {value:.17g} {ib} {k[which]}" for k, value in pairs]
    if step.name == "block":
        return [f"BLOCK MATERIAL={step.words.get('material', 1)} {numbers}"]
    if step.name == "property":
        values = " ".join(f"{word.upper()}={value:.17g}" for word, value in step.words.items())
        return [f"PROPERTY MATERIAL={numbers} {values}"]
    return [" ".join([step.name.upper(), numbers, *(in_deck(*word) for word in step.words.items())])]


def in_deck(word: str, value: Any) -> str:
    """A word of a step as it stands in a deck."""
    if isinstance(value, str):
        return value.upper()
    if value is True:
        return word.upper()
    return " ".join([word.upper(), *(f"{number:.17g}" for number in np.ravel(value))])


def obey(model: Model, step: Step) -> None:
    """Do `step`. Raises UdecError."""
    if step.name == "throw":
        for k, value in zip((KXD, KYD, KTD), step.numbers[1:], strict=True):
            putr(model.h, blocks(model)[int(step.numbers[0])], k, value)
        return
    numbers = step.numbers
    if step.name in ("cycle", "property", "function"):
        numbers = (int(numbers[0]), *numbers[1:])
    getattr(model, step.name)(*numbers, **step.words)


class Scene:
    """A scene as far as it has been played.

    watch is called after every command and every cycle. errors counts the numbered errors by number.
    ended: one of the errors in ENDS has stopped the scene.
    """

    def __init__(self, model: Model, watch: Callable[[Scene], None] | None = None) -> None:
        self.model = model
        self.steps: list[Step] = []
        self.lines: list[str] = ["START"]
        self.errors: Counter[int] = Counter()
        self.ended = False
        self.watch = watch
        model.start()

    def do(self, name: str, *numbers: float, **words: Any) -> bool:
        """Do a step and note it; False if it ended in a numbered error."""
        if self.ended:
            return False
        step = Step(name, numbers, words)
        lines = lines_of(self.model, step)
        try:
            obey(self.model, step)
        except UdecError as error:
            self.errors[error.number] += 1
            self.lines += [f"* error {error.number}: {line}" for line in lines]
            return False
        self.steps.append(step)
        self.lines += lines
        if self.watch is not None:
            self.watch(self)
        return True

    def cycle(self, n: int) -> None:
        """`n` cycles, watched one by one."""
        done = 0
        while done < n and not self.ended:
            try:
                self.model.cycle(1)
            except UdecError as error:
                self.errors[error.number] += 1
                self.ended = error.number in ENDS
                done += self.ended
                break
            done += 1
            if self.watch is not None:
                self._cycled(done)
        if done:
            self._note_cycles(done)

    def _cycled(self, done: int) -> None:
        """Watch with the cycles done so far among the lines, so that a failure can be replayed."""
        assert self.watch is not None
        self.lines.append(f"CYCLE {done}")
        self.watch(self)
        self.lines.pop()

    def _note_cycles(self, done: int) -> None:
        self.steps.append(Step("cycle", (done,)))
        self.lines.append(f"CYCLE {done}")

    @property
    def deck(self) -> str:
        """The scene as a deck."""
        return "\n".join([*self.lines, "STOP", ""])


def replay(model: Model, steps: list[Step], after: Callable[[Model], Model] | None = None) -> Model:
    """Do `steps` on `model`; after each, `after` may put another model in its place. Returns the last one.

    What ended the scene, always in its last step, ends it here too, and nothing comes after it: an overlap
    may have become too great then.
    """
    model.start()
    for step in steps:
        try:
            obey(model, step)
        except UdecError as error:
            if error.number not in ENDS or step is not steps[-1]:
                raise
            break
        if after is not None:
            model = after(model)
    return model


# ---- outlines of the first block


def _rectangle(rng: np.random.Generator) -> Outline:
    w, h = rng.integers(2, 13, 2) if rng.random() < 0.5 else rng.uniform(2, 12, 2)
    return [(0, 0), (0, h), (w, h), (w, 0)]


def _convex(rng: np.random.Generator) -> Outline:
    """Points on an ellipse, at least 20 degrees apart."""
    n = int(rng.integers(3, 9))
    gaps = rng.uniform(1, 3, n)
    angles = -2 * pi * np.cumsum(gaps) / gaps.sum()
    a, b = rng.uniform(2, 6, 2)
    return [(a * cos(angle), b * sin(angle)) for angle in angles]


def _ell(rng: np.random.Generator) -> Outline:
    a, b, c, d = rng.integers(1, 6, 4)
    return [(0, 0), (0, b + d), (a, b + d), (a, b), (a + c, b), (a + c, 0)]


def _u(rng: np.random.Generator) -> Outline:
    a, b, c, f, g, k = rng.integers(1, 5, 6)
    right = a + b + c
    return [(0, 0), (0, f + g), (a, f + g), (a, f), (a + b, f), (a + b, f + k), (right, f + k), (right, 0)]


def _tee(rng: np.random.Generator) -> Outline:
    a, b, c, f, g = rng.integers(1, 5, 5)
    right = a + b + c
    return [(a, 0), (a, f), (0, f), (0, f + g), (right, f + g), (right, f), (a + b, f), (a + b, 0)]


def _comb(rng: np.random.Generator) -> Outline:
    teeth, base = int(rng.integers(2, 5)), float(rng.integers(1, 4))
    points: Outline = [(0, 0)]
    x = 0.0
    for k in range(teeth):
        high, wide, gap = rng.integers(1, 4, 3)
        points += [(x, base + high), (x + wide, base + high)]
        x += wide
        if k + 1 < teeth:
            points += [(x, base), (x + gap, base)]
            x += gap
    return [*points, (x, 0)]


OUTLINES = (_rectangle, _rectangle, _convex, _ell, _u, _tee, _comb)


def random_outline(rng: np.random.Generator) -> Outline:
    """A random outline, turned by any angle or none, and perhaps far from the origin."""
    points = OUTLINES[int(rng.integers(len(OUTLINES)))](rng)
    if rng.random() < 0.3:
        angle = rng.uniform(0, 2 * pi)
        points = [(cos(angle) * x - sin(angle) * y, sin(angle) * x + cos(angle) * y) for x, y in points]
    dx, dy = rng.choice([0.0, -5.0, 100.0], 2) if rng.random() < 0.5 else (0.0, 0.0)
    return [(float(x + dx), float(y + dy)) for x, y in points]


# ---- the scene's actions: each draws what it needs and does it


def _box(scene: Scene) -> tuple[Point, Point]:
    points = [point for ib in blocks(scene.model) for point in outline(scene.model, ib)]
    xs, ys = zip(*points, strict=True)
    return (min(xs), min(ys)), (max(xs), max(ys))


def _centroid(scene: Scene, ib: int) -> Point:
    return float(getr(scene.model.h, ib, KX)), float(getr(scene.model.h, ib, KY))


def _line(scene: Scene, p: Point, q: Point, before: float = 1.0, after: float = 1.0) -> bool:
    """SPLIT from p to q, lengthened at both ends by parts of the size of the scene."""
    if scene.model.h.ci[NBLK] >= MAX_BLOCKS or p == q:
        return False
    low, high = _box(scene)
    size = hypot(high[0] - low[0], high[1] - low[1])
    z = hypot(q[0] - p[0], q[1] - p[1])
    c, s = (q[0] - p[0]) / z * size, (q[1] - p[1]) / z * size
    return scene.do("split", p[0] - before * c, p[1] - before * s, q[0] + after * c, q[1] + after * s)


def _point(scene: Scene, rng: np.random.Generator) -> Point:
    low, high = _box(scene)
    x, y = float(rng.uniform(low[0], high[0])), float(rng.uniform(low[1], high[1]))
    return (x, y) if rng.random() < 0.6 else (round(x * 2) / 2, round(y * 2) / 2)


def _corner(scene: Scene, rng: np.random.Generator) -> Point:
    points = outline(scene.model, int(rng.choice(blocks(scene.model))))
    return points[int(rng.integers(len(points)))]


def split_across(scene: Scene, rng: np.random.Generator) -> None:
    """A line through two random points, right across."""
    _line(scene, _point(scene, rng), _point(scene, rng))


def split_straight(scene: Scene, rng: np.random.Generator) -> None:
    """A level or an upright line, right across."""
    x, y = _point(scene, rng)
    _line(scene, (x, y), (x + 1, y) if rng.random() < 0.5 else (x, y + 1))


def split_partly(scene: Scene, rng: np.random.Generator) -> None:
    """A line that ends somewhere in the scene."""
    _line(scene, _point(scene, rng), _point(scene, rng), before=0.0, after=float(rng.integers(0, 2)))


def split_corners(scene: Scene, rng: np.random.Generator) -> None:
    """A line exactly through two corners, or from one to the other."""
    long = float(rng.integers(0, 2))
    _line(scene, _corner(scene, rng), _corner(scene, rng), before=long, after=long)


def split_corner(scene: Scene, rng: np.random.Generator) -> None:
    """A line through one corner."""
    _line(scene, _corner(scene, rng), _point(scene, rng))


def split_along(scene: Scene, rng: np.random.Generator) -> None:
    """A line along an edge and beyond."""
    points = outline(scene.model, int(rng.choice(blocks(scene.model))))
    k = int(rng.integers(len(points)))
    _line(scene, points[k - 1], points[k])


def split_fan(scene: Scene, rng: np.random.Generator) -> None:
    """Lines through one point."""
    x, y = _point(scene, rng) if rng.random() < 0.7 else _corner(scene, rng)
    for k in range(int(rng.integers(2, 5))):
        angle = float(rng.uniform(0, pi)) if rng.random() < 0.5 else k * pi / 4
        _line(scene, (x, y), (x + cos(angle), y + sin(angle)))


def split_parallel(scene: Scene, rng: np.random.Generator) -> None:
    """A set of parallel lines."""
    (ax, ay), (bx, by) = _box(scene)
    n, angle = int(rng.integers(2, 5)), float(rng.choice([0, pi / 2, rng.uniform(0, pi)]))
    c, s = round(cos(angle), 15), round(sin(angle), 15)
    for k in range(1, n):
        x, y = ax + (bx - ax) * k / n, ay + (by - ay) * k / n
        _line(scene, (x, y), (x + c, y + s))


def split_bricks(scene: Scene, rng: np.random.Generator) -> None:
    """A brick bond: bed joints right across, upright joints from one bed joint to the next."""
    (ax, ay), (bx, by) = _box(scene)
    courses, bricks = rng.integers(2, 5, 2)
    levels = [ay + (by - ay) * float(k) / float(courses) for k in range(courses + 1)]
    for y in levels[1:-1]:
        _line(scene, (ax, y), (bx, y))
    for k in range(courses):
        for j in range(bricks):
            x = ax + (bx - ax) * (j + 0.5 + 0.5 * (k % 2)) / float(bricks)
            if ax < x < bx:
                _line(scene, (x, levels[k]), (x, levels[k + 1]), before=0.0, after=0.0)


SPLITS = (
    split_across,
    split_straight,
    split_straight,
    split_partly,
    split_corners,
    split_corner,
    split_along,
    split_fan,
    split_parallel,
    split_bricks,
)


def split_somehow(scene: Scene, rng: np.random.Generator) -> None:
    """One of the ways to split."""
    SPLITS[int(rng.integers(len(SPLITS)))](scene, rng)


def _around(x: float, y: float, reach: float) -> Numbers:
    return x - reach, x + reach, y - reach, y + reach


def delete_one(scene: Scene, rng: np.random.Generator) -> None:
    """Delete one block (or those whose centroids are at the same place)."""
    x, y = _centroid(scene, int(rng.choice(blocks(scene.model))))
    scene.do("delete", *_around(x, y, 1e-3))


def delete_region(scene: Scene, rng: np.random.Generator) -> None:
    """Delete what has its centroid in a rectangle: a hole, a bite, or a strip that cuts the scene in two."""
    (ax, ay), (bx, by) = _box(scene)
    x, y = _point(scene, rng)
    w, h = float(rng.uniform(0.05, 0.3)) * (bx - ax), float(rng.uniform(0.05, 0.3)) * (by - ay)
    if rng.random() < 0.3:
        w, h = (bx - ax, h) if rng.random() < 0.5 else (w, by - ay)
    h_, inside = scene.model.h, 0
    for ib in blocks(scene.model):
        inside += abs(getr(h_, ib, KX) - x) < w and abs(getr(h_, ib, KY) - y) < h
    if inside and inside <= h_.ci[NBLK] // 2:
        scene.do("delete", x - w, x + w, y - h, y + h)


def fix_some(scene: Scene, rng: np.random.Generator) -> None:
    """Fix one block, or a strip."""
    (ax, ay), (bx, by) = _box(scene)
    x, y = _centroid(scene, int(rng.choice(blocks(scene.model))))
    if rng.random() < 0.6:
        scene.do("fix", *_around(x, y, 1e-3))
    else:
        scene.do("fix", ax - 1, bx + 1, ay - 1, ay + 0.3 * (by - ay))


def free_some(scene: Scene, rng: np.random.Generator) -> None:
    """Set a block free; another one stays fixed, or is fixed."""
    x, y = _centroid(scene, int(rng.choice(blocks(scene.model))))
    scene.do("free", *_around(x, y, 1e-3))
    if not any(iget(scene.model.h, ib, KBFIX) for ib in blocks(scene.model)):
        fix_some(scene, rng)


def change_some(scene: Scene, rng: np.random.Generator) -> None:
    """Another material in a strip."""
    (ax, ay), (bx, by) = _box(scene)
    y = float(rng.uniform(ay, by))
    scene.do("change", ax - 1, bx + 1, y, by + 1, material=int(rng.integers(1, 3)))


def throw_some(scene: Scene, rng: np.random.Generator) -> None:
    """Velocities for some free blocks, slow enough for the rounding length.

    A block of mass m that strikes a spring KN with v overlaps by v sqrt(m/KN), which must be less than half
    of the rounding length; and it must not move by more than a part of that in one time-step.
    """
    h = scene.model.h
    for k, ib in enumerate(blocks(scene.model)):
        if iget(h, ib, KBFIX) or rng.random() < 0.6:
            continue
        slow = min(0.3 / sqrt(float(getr(h, ib, KBM)) / STIFFNESS), 0.06 / float(h.cr[TDEL]))
        v = float(rng.uniform(0, 1) * h.cr[DTOL] * slow)
        angle, spin = float(rng.uniform(0, 2 * pi)), float(rng.normal(0, 0.3))
        scene.do("throw", k, v * cos(angle), v * sin(angle), v * spin / float(getr(h, ib, KBRO)))


def pull(scene: Scene, rng: np.random.Generator) -> None:
    """Gravity in any direction, along an axis or none."""
    g = float(rng.choice([0.0, 10.0, 30.0]))
    angle = float(rng.choice([-pi / 2, rng.uniform(0, 2 * pi)]))
    scene.do("gravity", round(g * cos(angle), 12), g * sin(angle))


def damp(scene: Scene, rng: np.random.Generator) -> None:
    """Damping of any kind, or none."""
    kind = rng.choice(["none", "both", "mass", "stiffness", "internal"])
    words = {} if kind in ("none", "both") else {"only": str(kind)}
    fraction = 0.0 if kind == "none" else float(rng.uniform(0.01, 0.1))
    scene.do("damping", fraction, float(rng.uniform(10, 100)), **words)


STIFFNESS = 1e8  # order of all joint stiffnesses


def materials(scene: Scene, rng: np.random.Generator) -> None:
    """Properties of materials 1 and 2, and a fraction of the critical time-step."""
    for n in (1, 2):
        kn, ks = (float(STIFFNESS * rng.choice([1.0, rng.uniform(1, 5)])) for _ in range(2))
        values = {"density": float(rng.uniform(500, 3000)), "kn": kn, "ks": ks}
        values["friction"] = float(rng.choice([0.0, 0.5, rng.uniform(0, 2)]))
        values["cohesion"] = float(rng.choice([0.0, 1e4]))
        scene.do("property", n, **values)
    scene.do("fraction", float(rng.choice([0.03, 0.1, 0.1, 0.2])))


def round_some(scene: Scene, rng: np.random.Generator, most: float = 0.5) -> None:
    """A rounding length that fits, from sharp corners to `most` of the shortest edge."""
    shortest = min(
        hypot(p[0] - q[0], p[1] - q[1])
        for ib in blocks(scene.model)
        for ring in (outline(scene.model, ib),)
        for p, q in zip(ring, [ring[-1], *ring[:-1]], strict=True)
    )
    scene.do("round", shortest * min(float(rng.choice([0.03, 0.1, 0.2, 0.35, 0.5])), most) * (1 - 1e-9))


LATER = (
    *(split_somehow, split_somehow, delete_one, delete_one, delete_region, fix_some, free_some, change_some),
    *(throw_some, throw_some, throw_some, pull, damp),
)


def play(
    seed: int,
    model: Model | None = None,
    watch: Callable[[Scene], None] | None = None,
    cycles: tuple[int, int] = (10, 60),
) -> Scene:
    """The scene of `seed`, played on `model` with runs of `cycles` (from, to) cycles each."""
    rng = np.random.default_rng(seed)
    scene = Scene(Model() if model is None else model, watch)
    materials(scene, rng)
    material = int(rng.integers(1, 3))
    for _ in range(20):
        corners = random_outline(rng)
        if scene.do("block", *(number for point in corners for number in point), material=material):
            break
    if rng.random() < 0.15:
        round_some(scene, rng)
    while scene.model.h.ci[NBLK] < 2 or rng.random() < 0.75:
        split_somehow(scene, rng)
        if len(scene.lines) > 150:
            break
    for _ in range(int(rng.integers(0, 3))):
        (delete_one if rng.random() < 0.5 else delete_region)(scene, rng)
    if rng.random() < 0.6:
        round_some(scene, rng)
    fix_some(scene, rng)
    pull(scene, rng)
    if rng.random() < 0.5:
        damp(scene, rng)
    return carry_on(scene, rng, LATER, 2, cycles)


def carry_on(
    scene: Scene,
    rng: np.random.Generator,
    later: Sequence[Callable[[Scene, np.random.Generator], Any]],
    most: int,
    cycles: tuple[int, int],
) -> Scene:
    """Runs of `cycles` (from, to) cycles, with one to `most` of the commands `later` before each."""
    scene.cycle(1)
    for _ in range(int(rng.integers(2, 6))):
        if scene.ended:
            break
        for _ in range(int(rng.integers(1, most + 1))):
            later[int(rng.integers(len(later)))](scene, rng)
        scene.cycle(int(rng.integers(cycles[0], cycles[1] + 1)))
    return scene
