"""Random commands of loading on blocks of all types: the invariants hold after each, and files continue."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

Rng = np.random.Generator


def wall(rng: Rng, out: Path) -> Model:
    """Six blocks of all types, the lower ones fixed, with a function and gravity."""
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 3, 6, 3, 6, 0)
    m.split(-1, 1, 7, 1)
    m.split(-1, 2, 7, 2)
    m.split(3, 0.5, 3, 3.5)
    m.round(0.05)
    m.fix(0, 6, 0, 1)
    for x in (1.5, 4.5):
        for y in (1.5, 2.5):
            kind = str(rng.choice(["rigid", "sdef", "zoned"]))
            if kind == "sdef":
                m.change(x - 1, x + 1, y - 0.4, y + 0.4, kind)
            elif kind == "zoned":
                m.generate(x - 1, x + 1, y - 0.4, y + 0.4, "automatic", edge=1.5)
    m.function(1, 0.0, 1.0, 0.05, 0.8, 0.1, 1.1)
    m.gravity(0.0, -10.0)
    m.damping(local=0.5)
    return m


def somewhere(rng: Rng) -> tuple[float, float, float, float]:
    x, y = rng.uniform(0, 6), rng.uniform(0, 3)
    w, h = rng.uniform(0.3, 4), rng.uniform(0.3, 2)
    return x - w, x + w, y - h, y + h


def drive(m: Model, rng: Rng) -> None:
    given = {name: float(rng.normal(0, 0.005)) for name in ("xvel", "yvel", "rotation") if rng.random() < 0.6}
    if rng.random() < 0.3:
        given["function"] = 1
    m.boundary(*somewhere(rng), **given)  # type: ignore[arg-type]


def follow(m: Model, rng: Rng) -> None:
    if rng.random() < 0.5:
        m.gravity(0.0, -10.0, function=1 if rng.random() < 0.7 else None)
    else:
        m.property(1, friction=0.5, cohesion=1e3, function=1 if rng.random() < 0.7 else None)


def record(m: Model, rng: Rng) -> None:
    m.history(1, str(rng.choice(["xreaction", "yreaction", "mreaction"])), within=somewhere(rng))


COMMANDS: tuple[Callable[[Model, Rng], object], ...] = (
    *(drive, drive, drive, follow, follow, record),
    lambda m, rng: m.boundary(*somewhere(rng), free=True),
    lambda m, rng: m.fix(*somewhere(rng)),
    lambda m, rng: m.free(*somewhere(rng)),
    lambda m, rng: m.function(1, 0.0, 1.0, 0.02, float(rng.uniform(0.5, 1.5))),
    lambda m, rng: m.change(*somewhere(rng), type=str(rng.choice(["rigid", "sdef"]))),
    lambda m, rng: m.delete(*somewhere(rng)),
    lambda m, rng: m.split(*rng.uniform(-1, 7, 4).tolist()),
    lambda m, rng: m.reset(str(rng.choice(["slip", "time"]))),
    lambda m, rng: m.cycle(time=float(rng.uniform(0, 0.02))),
    lambda m, rng: m.cycle(int(rng.integers(0, 8))),
)


@pytest.mark.parametrize("seed", range(12))
def test_the_invariants_hold(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    m = wall(rng, tmp_path)
    for step in range(25):
        command = COMMANDS[int(rng.integers(len(COMMANDS)))]
        before = [part.tobytes() for part in m.array.h[:4]]
        refused = 0
        try:
            command(m, rng)
        except UdecError as error:
            refused = error.number
        if refused in (15, 32):
            return  # a run has ended: what pushes blocks together goes on
        after = [part.tobytes() for part in m.array.h[:4]]
        assert not refused or len(before[0]) < len(after[0]) or before[0] == after[0], (seed, step, refused)
        assert m.check() == [], (seed, step)
        rows = m.reactions()
        assert np.isfinite([rows[name] for name in ("fx", "fy", "moment")]).all()
    other = Model.restore(m.save(tmp_path / "one.h5"), out=tmp_path / "other")
    for one in (m, other):
        try:
            one.cycle(5)
        except UdecError:
            assert one is m
            return
    used = int(m.h.ci[g.MFREE]) - 1
    assert m.h.ia[:used].tobytes() == other.h.ia[:used].tobytes()
