"""Where blocks were on the way of a SOLVE, and what its last two quarters tell of how they move.

On the way the places of all blocks are noted, evenly spread and KEPT times at most. The last two quarters of
them are compared. With d the displacements in a quarter, d' those in the one before, sums over blocks
weighted with their masses,

    share     of the kinetic energy in displacement, (sum m d d/2)/T T over it: 1 for what moves one way
    steady    (sum m d d')/sqrt(sum m d d  sum m d' d'): 1 for what goes on in the same direction
    growth    sqrt(sum m d d/sum m d' d'): above 1 for what moves ever faster

and `fall`, the energy that swings over that of the quarter before. It is twice the kinetic energy in the
mean, and was more by what all energies have lost since: kinetic, strain and that of gravity, without the work
of loads. So it is damping and friction that tell, and not when a swing happened to be looked at.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.kernels.energy.stored import liveliest
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft_in
from udec_ia.ops.run.runaway import stock

FIRST, KEPT = 20, 16  # cycles between the first looks; looks that are kept
ENOUGH = 8  # looks, without which nothing is said of what goes on


class Look(NamedTuple):
    """cycle; x, y: centroids of all blocks; moving: kinetic energy; energy: all of it, less work; J/m."""

    cycle: int
    x: Any
    y: Any
    moving: float
    energy: float


class Motion(NamedTuple):
    """The last two quarters of what was noted; see above. by: how far each block has moved in the last."""

    cycles: int
    by: Any
    share: float
    steady: float
    growth: float
    fall: float  # energy that swings over that of the quarter before
    now: Any  # what each block would move by in as many cycles with its present velocity


class Noted:
    """Notes the way of one SOLVE."""

    def __init__(self) -> None:
        self.looks: list[Look] = []
        self.every = FIRST
        self._blocks: Any = np.zeros(0, np.int64)

    def begin(self, array: MainArray) -> None:
        """The state before the first cycle, blocks being where they will stay."""
        self._blocks = addresses(array.h, int(array.h.ci[g.IBPNT]), g.KB)
        self.looks, self.every = [], FIRST
        self.note(array)

    def ahead(self, h: Memory) -> int:
        """Cycles until the next look."""
        return self.every - (int(h.ci[g.MCTOT]) - self.looks[0].cycle) % self.every

    def note(self, array: MainArray) -> None:
        """Look, if it is time to."""
        h = array.h
        cycle = int(h.ci[g.MCTOT])
        if self.looks and (cycle == self.looks[-1].cycle or self.ahead(h) != self.every):
            return
        x, y = self._seen(h)
        moving = float(liveliest(h, soft_in(h))[0])
        now = stock(h)
        self.looks.append(Look(cycle, x, y, moving, now.stored + now.potential - float(h.cd[g.WDRIVE])))
        if len(self.looks) > KEPT:
            self.looks, self.every = self.looks[::2], 2 * self.every

    def _seen(self, h: Memory) -> tuple[Any, Any]:
        """Where all blocks are."""
        x, y = (np.asarray(getr(h, self._blocks, k), np.float64) for k in (g.KX, g.KY))
        return x, y

    def motion(self, h: Memory) -> Motion | None:
        """The last two quarters; None if there are too few looks."""
        n = len(self.looks) - 1
        if n < ENOUGH:
            return None
        q = n // 4
        a, b, c = (self.looks[k] for k in (n - 2 * q, n - q, n))
        free = integers(h, self._blocks, g.KBFIX) != g.FIXED
        m = np.where(free, np.asarray(getr(h, self._blocks, g.KBM), np.float64), 0.0)
        (dx, dy), (ex, ey) = ((two.x - one.x, two.y - one.y) for one, two in ((b, c), (a, b)))
        now, before, both = (float((m * s).sum()) for s in (dx**2 + dy**2, ex**2 + ey**2, dx * ex + dy * ey))
        energy = float(np.mean([one.moving for one in self.looks[n + 1 - q :]]))
        lost = max(b.energy - c.energy, 0.0)
        time = (c.cycle - b.cycle) * float(h.cr[g.TDEL])
        vx, vy = (np.asarray(getr(h, self._blocks, k), np.float64) for k in (g.KXD, g.KYD))
        return Motion(
            c.cycle - b.cycle,
            np.where(free, np.hypot(dx, dy), 0.0),
            now / time**2 / 2 / energy if energy > 0 else 0.0,
            both / math.sqrt(now * before) if now * before > 0 else 0.0,
            math.sqrt(now / before) if before > 0 else math.inf,
            2 * energy / (2 * energy + lost) if energy > 0 else 1.0,
            np.hypot(vx, vy) * time,
        )
