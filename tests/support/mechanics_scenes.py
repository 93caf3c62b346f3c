"""Scenes that the tests of the mechanics share, and how to look at them.

Everything is cut from one block, as in a deck: a base that is fixed and what stands on it, or blocks that
float freely far above a fixed one (a block system needs a contact, so one block more is always left).
"""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia import Model
from udec_ia.heap.accessors import putr
from udec_ia.layout.offsets import KTD, KXD, KYD, TDEL

G = 10.0
Row = Any  # one row of Model.table


def model(
    *outline: tuple[float, float],
    d: float,
    fraction: float = 0.1,
    density: float = 1000.0,
    stiffness: tuple[float, float] = (1e8, 1e8),
    friction: float = 0.0,
    cohesion: float = 0.0,
    gravity: tuple[float, float] = (0.0, -G),
    build: str = "i32r64",
    law: Any = None,
    displacements: bool = False,
) -> Model:
    """A model of one block with the given corners (clockwise) and rounding length `d`, no damping.

    law: of constitutive number 2, which the block then has. displacements: the state has them.
    """
    m = Model(build=build, constitutive=law)
    m.start()
    m.fraction(fraction)
    m.gravity(*gravity)
    kn, ks = stiffness
    m.property(1, density=density, kn=kn, ks=ks, friction=friction, cohesion=cohesion)
    m.round(d)
    if displacements:
        m.displacements()
    m.block(*chain.from_iterable(outline), constitutive=1 if law is None else 2)
    return m


def box(x1: float, x2: float, y1: float, y2: float) -> list[tuple[float, float]]:
    """Corners of a rectangle, clockwise from the lower left one."""
    return [(x1, y1), (x1, y2), (x2, y2), (x2, y1)]


def on_base(b: float, h: float, d: float, width: float, **numbers: Any) -> Model:
    """A block of breadth `b` and height `h` on a fixed base, 1 high and `width` wide, from x = -width/2.

    The base's top is y = 0, the block's centroid is at (0, h/2).
    """
    m = model(*box(-width / 2, width / 2, -1, h), d=d, **numbers)
    m.split(-width, 0, width, 0)
    for x in (-b / 2, b / 2):
        m.split(x, -0.5, x, h + 1)
    m.delete(-width, -b / 2, 0, h)
    m.delete(b / 2, width, 0, h)
    m.fix(-width, width, -1, 0)
    return m


def standing_block(out: Path, **numbers: Any) -> Model:
    """A block of 1 by 1 at rest on a fixed base; two contacts, which carry no force yet."""
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.5, **numbers)
    m.out = out
    return m


def side_by_side(out: Path | None = None, **named: object) -> Model:
    """Two blocks side by side on a fixed base."""
    m = Model(out=out or ".", **named)  # type: ignore[arg-type]
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.gravity(0, -10)
    m.block(0, 0, 0, 3, 4, 3, 4, 0)
    m.split(-1, 1, 5, 1)
    m.split(2, 0.5, 2, 4)
    m.round(0.1)
    m.fix(0, 4, 0, 1)
    return m


def block(m: Model, x: float, y: float) -> Row:
    """The block whose centroid is nearest to (x, y)."""
    blocks = m.table("block")
    return blocks[((blocks["KX"] - x) ** 2 + (blocks["KY"] - y) ** 2).argmin()]


def at(m: Model, kind: str, address: int) -> Row:
    """The group of `kind` at `address`."""
    rows = m.table(kind)
    (row,) = rows[rows["address"] == address]
    return row


def value(m: Model, kind: str, address: int, field: str) -> float:
    """The field of one group, by the table; NaN if there is no such group."""
    rows = m.table(kind)
    (found,) = rows[field][rows["address"] == address] if address in rows["address"] else (np.nan,)
    return float(found)


def push(m: Model, address: int, xd: float = 0.0, yd: float = 0.0, td: float = 0.0) -> None:
    """Give the block at `address` a velocity."""
    which = m.array.scheme.ratio >> 1
    for offset, value in ((KXD, xd), (KYD, yd), (KTD, td)):
        m.rset(value, address, offset[which])


def step(m: Model) -> float:
    """The time-step of the last CYCLE."""
    return float(m.h.cr[TDEL])


def no_damping(m: Model) -> None:
    """Take all damping away."""
    m.damping(0.0, 1.0)


def sound(m: Model) -> None:
    """The map and its numbers are as they must be."""
    found = m.check()
    assert not found, found


def colliding(out: Path) -> Model:
    """A block that two joint sets cut into 25, each of which flies against its neighbours."""
    m = Model(out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 10, 10, 10, 10, 0)
    for k in range(1, 5):
        m.split(-1, 2 * k, 11, 2 * k + 0.3)
        m.split(2 * k, -1, 2 * k + 0.3, 11)
    m.round(0.05)
    m.cycle(0)
    for k, row in enumerate(m.table("block")):
        putr(m.array.h, int(row["address"]), KXD, float(0.3 * (-1) ** k))
    return m
