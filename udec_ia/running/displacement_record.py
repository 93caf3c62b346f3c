"""Where blocks are during a run, at up to 17 evenly spaced looks, the first of which are 20 cycles apart."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.attached_structures import held_blocks
from udec_ia.ops.common.listed_groups import list_of

FIRST, LOOKS = 20, 16  # cycles between the first looks; greatest number of looks
FALLEN = 0.1  # displacement of a fallen block over its size, which is twice its greatest radius


class Look(NamedTuple):
    """The centroids of all blocks after a cycle."""

    cycle: int
    x: Any
    y: Any


class DisplacementRecord:
    """Where blocks were during a SOLVE. blocks: their addresses. lost: which of them nothing holds now."""

    def __init__(self, array: MainArray) -> None:
        self.blocks: Any = list_of(array.h, "block")
        self.looks: list[Look] = []
        self.every = FIRST
        self._touched = np.zeros(len(self.blocks), bool)
        self.lost = np.zeros(len(self.blocks), bool)
        self.add(array.h)

    def cycles_ahead(self, h: Memory) -> int:
        """Cycles until the next look."""
        return self.every - (int(h.ci[g.MCTOT]) - self.looks[0].cycle) % self.every

    def add_if_due(self, h: Memory) -> None:
        """Add a look if it is due; of too many, keep every second one."""
        if self.cycles_ahead(h) == self.every and int(h.ci[g.MCTOT]) != self.looks[-1].cycle:
            self.add(h)
            if len(self.looks) > LOOKS:
                self.looks, self.every = self.looks[::2], 2 * self.every

    def add(self, h: Memory) -> None:
        """Add a look."""
        self.looks.append(Look(int(h.ci[g.MCTOT]), *self._centroids(h)))
        contacts = list_of(h, "contact")
        contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
        touched = np.isin(self.blocks, [integers(h, contacts, k) for k in (g.KB1, g.KB2)])
        touched |= np.isin(self.blocks, held_blocks(h))
        self.lost |= self._touched & ~touched
        self._touched |= touched

    def displacements(self, h: Memory, since: Look) -> Any:
        """Displacement of each block since a look, 0 for fixed blocks."""
        x, y = self._centroids(h)
        free = integers(h, self.blocks, g.KBFIX) != g.FIXED
        return np.where(free, np.hypot(x - since.x, y - since.y), 0.0)

    def unsupported(self, h: Memory) -> Any:
        """True for each free block with weight, no contact or structure with a force, and no condition."""
        contacts, conditions = list_of(h, "contact"), list_of(h, "bound")
        contacts = contacts[np.asarray(getr(h, contacts, g.KCFN)) != 0]
        hosts = [integers(h, contacts, k) for k in (g.KB1, g.KB2)] + [integers(h, conditions, g.KUB)]
        hosts.append(held_blocks(h))
        free = integers(h, self.blocks, g.KBFIX) == 0
        return free & ~np.isin(self.blocks, np.concatenate(hosts)) & bool(h.cr[g.GRAVX] or h.cr[g.GRAVY])

    def _centroids(self, h: Memory) -> Any:
        return [np.asarray(getr(h, self.blocks, k), np.float64) for k in (g.KX, g.KY)]
