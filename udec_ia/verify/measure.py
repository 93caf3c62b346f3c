"""What problems measure alike: a block, times and velocities, the period of a vibration."""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.layout import offsets as g
from udec_ia.model import Model


def block(m: Model, x: float, y: float) -> Any:
    """The row of the block whose centroid is nearest to (x, y)."""
    blocks = m.table("block")
    return blocks[((blocks["KX"] - x) ** 2 + (blocks["KY"] - y) ** 2).argmin()]


def row(m: Model, kind: str, address: int) -> Any:
    """The row of the group of `kind` at `address`."""
    rows = m.table(kind)
    return rows[(rows["address"] == address).argmax()]


def push(m: Model, address: int, **velocity: float) -> None:
    """Give a block velocities: KXD, KYD (m/s), KTD (rad/s)."""
    m.patch(", ".join(f"block@{address}.{name} = {float(value)!r}" for name, value in velocity.items()))


def step(m: Model) -> float:
    """The time-step of the last CYCLE, s."""
    return float(m.h.cr[g.TDEL])


def now(m: Model) -> float:
    """Time since the first cycle, s."""
    return float(m.h.cd[g.TIME])


def cycle_for(m: Model, seconds: float) -> None:
    """Cycle for a time, with the time-step of the last CYCLE."""
    m.cycle(max(1, round(seconds / step(m))))


def crossings(t: Any, v: Any) -> Any:
    """Times at which a vibration passes zero."""
    t, v = np.asarray(t), np.asarray(v)
    i = np.flatnonzero(np.sign(v[1:]) != np.sign(v[:-1]))
    return t[i] - v[i] * (t[i + 1] - t[i]) / (v[i + 1] - v[i])


def period(t: Any, v: Any) -> float:
    """Of a vibration about zero, from all its crossings."""
    times = crossings(t, v)
    return 2 * float(times[-1] - times[0]) / (len(times) - 1)


def straight_line(t: Any, v: Any) -> tuple[float, float]:
    """Slope of the straight line through velocities, and what all that is left beside the line can add to it.

    Numbers of at most A, whatever their order, tilt the line that fits them best over a time T by 3 A/T.
    """
    t, v = np.asarray(t), np.asarray(v)
    line = np.polyfit(t, v, 1)
    return float(line[0]), 3 * float(np.abs(v - np.polyval(line, t)).max() / (t[-1] - t[0]))
