"""The diagnosis of a SOLVE at its end: which blocks have fallen, which moved most, what damps, what slipped.

While SOLVE runs, a record is kept of where the blocks are and whether they have contacts, at some ten to
twenty cycles, evenly spread.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from udec_ia.advice.damping_report import what_damps
from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of
from udec_ia.kernels.energy.stored_energy import strain_of_blocks, strain_of_contacts
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft_in
from udec_ia.printable_text import counted
from udec_ia.remark_key import Remark
from udec_ia.running.cycle_observer import Observer, between_cycles
from udec_ia.running.group_names import contact_name
from udec_ia.running.solve_result import Solution

FIRST, KEPT = 20, 16  # cycles between the first looks; looks that are kept
FALLEN = 0.1  # of its size: a block that moved by more has fallen. Its size is twice its greatest radius
MOVED = 0.1  # of the greatest displacement: blocks that moved by more are counted
NAMED = 3  # blocks that are named
SLIPPED = 0.0015  # of the strain energy: work of friction, and shear that contacts lost as they opened, from
# which on the loading path matters. Slip of a hundredth of the elastic shear takes a fiftieth of the energy
# of shear, which may be a tenth of all (docs/studies)
ROUNDED = 1e-3  # of the largest elastic shear: less than that is no slip


class Look(NamedTuple):
    """Where the centroids of all blocks were in a cycle."""

    cycle: int
    x: Any
    y: Any


class DisplacementRecord:
    """Where blocks were during a SOLVE. blocks: their addresses. lost: which of them lost all contacts."""

    def __init__(self, array: MainArray) -> None:
        self.blocks: Any = addresses(array.h, int(array.h.ci[g.IBPNT]), g.KB)
        self.looks: list[Look] = []
        self.every = FIRST
        self._touched = np.zeros(len(self.blocks), bool)
        self.lost = np.zeros(len(self.blocks), bool)
        self.add(array.h)

    def cycles_ahead(self, h: Memory) -> int:
        """Cycles until the next look."""
        return self.every - (int(h.ci[g.MCTOT]) - self.looks[0].cycle) % self.every

    def add_if_due(self, h: Memory) -> None:
        """Add a look if it is time for one."""
        if self.cycles_ahead(h) == self.every and int(h.ci[g.MCTOT]) != self.looks[-1].cycle:
            self.add(h)
            if len(self.looks) > KEPT:
                self.looks, self.every = self.looks[::2], 2 * self.every

    def add(self, h: Memory) -> None:
        """Add a look."""
        x, y = self.places(h)
        self.looks.append(Look(int(h.ci[g.MCTOT]), x, y))
        touched = np.isin(self.blocks, _touched(h))
        self.lost |= self._touched & ~touched
        self._touched |= touched

    def places(self, h: Memory) -> tuple[Any, Any]:
        """Where all blocks are."""
        x, y = (np.asarray(getr(h, self.blocks, k), np.float64) for k in (g.KX, g.KY))
        return x, y

    def displacements(self, h: Memory, since: Look) -> Any:
        """How far each block has moved since a look, 0 for fixed blocks."""
        x, y = self.places(h)
        free = integers(h, self.blocks, g.KBFIX) != g.FIXED
        return np.where(free, np.hypot(x - since.x, y - since.y), 0.0)


class RestDiagnosis(Observer):
    """Observes one SOLVE. rested: work of friction until the model was at rest last, in J/m."""

    def __init__(self, rested: float) -> None:
        self.rested = rested
        self.record: DisplacementRecord | None = None

    def begin(self, array: MainArray, solves: bool) -> None:
        """See Observer."""
        self.record = DisplacementRecord(array)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See Observer."""
        return n if self.record is None else min(n, self.record.cycles_ahead(array.h))

    def look(self, array: MainArray, cycles: int) -> None:
        """See Observer."""
        if self.record is not None and between_cycles(array.h):
            self.record.add_if_due(array.h)

    def end(self, array: MainArray) -> None:
        """See Observer."""
        if self.record is not None and between_cycles(array.h):
            self.record.add(array.h)

    def complete(self, array: MainArray, solution: Solution) -> Solution:
        """`solution` with what there is to remark, and the addresses of the blocks that have fallen."""
        h, record = array.h, self.record
        if record is None:
            return solution
        remarks = []
        way, size = (
            record.displacements(h, record.looks[0]),
            2 * np.asarray(getr(h, record.blocks, g.KBRO), float),
        )
        fallen = (way > 0) & ((way > FALLEN * size) | record.lost)
        if fallen.any():
            named = _names(h, record.blocks, np.where(fallen, way, -1.0), int(fallen.sum()))
            text = (
                f"{_have(int(fallen.sum()))} fallen, {named}: each has moved by more than {FALLEN:.0%} of "
                "its size, or has lost all its contacts on the way"
            )
            remarks.append(Remark("blocks-fallen", text))
        if not solution.reached:
            remarks += _moved(h, record)
            if not what_damps(h):
                remarks.append(Remark("no-damping", "nothing damps: DAMPING LOCAL 0.8 damps all frequencies"))
        else:
            remarks += self._slipped(h)
        return solution._replace(remarks=tuple(remarks), fallen=tuple(record.blocks[fallen].tolist()))

    def _slipped(self, h: Memory) -> list[Remark]:
        """A remark if friction and opening contacts have taken much since the last rest."""
        taken = float(h.cd[g.WFRIC]) - self.rested
        stored = float(strain_of_contacts(h)) + float(strain_of_blocks(h, soft_in(h)))
        if taken <= SLIPPED * stored:
            return []
        share = taken / stored if stored else math.inf
        of = f"{share:.2%} of" if share < 1 else f"{share:.3g} times"
        text = (
            f"joints have slipped on the way{_farthest_slip(h)}, or opened and lost their shear: that "
            f"took {taken:.3g} J/m, {of} what joints and blocks hold now. The result may depend on the "
            "loading path: load in steps, and compare"
        )
        return [Remark("joints-slipped", text)]


def _moved(h: Memory, record: DisplacementRecord) -> list[Remark]:
    """A remark on the blocks that moved most in the last quarter of a SOLVE."""
    since = record.looks[-1 - max(len(record.looks) // 4, 1)] if len(record.looks) > 1 else record.looks[0]
    way = record.displacements(h, since)
    if not len(way) or not way.max() > 0:
        return []
    many, cycles = int((way > MOVED * way.max()).sum()), int(h.ci[g.MCTOT]) - since.cycle
    text = f"{_have(many)} moved most in the last {counted(cycles, 'cycle')}, "
    return [Remark("blocks-move", text + _names(h, record.blocks, way, many))]


def _have(many: int) -> str:
    return "1 block has" if many == 1 else f"{many} blocks have"


def _names(h: Memory, blocks: Any, way: Any, many: int) -> str:
    """The first few of `many` blocks that have moved most, with their places and displacements."""
    return ", ".join(
        f"block@{blocks[k]} at ({getr(h, int(blocks[k]), g.KX):.4g}, {getr(h, int(blocks[k]), g.KY):.4g}) by "
        f"{way[k]:.2g} m"
        for k in np.argsort(-way, kind="stable")[: min(many, NAMED)]
    )


def _touched(h: Memory) -> Any:
    """Addresses of blocks that have a contact, open or closed; some of them twice."""
    contacts = addresses(h, int(h.ci[g.ICPNT]), g.KC)
    contacts = contacts[integers(h, contacts, g.KCCOD) != g.VIRTUAL]
    return np.concatenate([integers(h, contacts, k) for k in (g.KB1, g.KB2)])


def _farthest_slip(h: Memory) -> str:
    """The contact that has slipped farthest since it closed: the shear that its spring does not hold.

    Only contacts of constitutive number 1 that bear a force are asked. "" if none has slipped by more than
    what its spring has rounded.
    """
    contacts = addresses(h, int(h.ci[g.ICPNT]), g.KC)
    contacts = contacts[(np.asarray(getr(h, contacts, g.KCFN)) > 0) & (integers(h, contacts, g.KCC) == 1)]
    if not len(contacts):
        return ""
    fs, slip = (np.asarray(getr(h, contacts, k), np.float64) for k in (g.KCFS, g.KCS))
    ks = joints_of(h, contacts).ks
    held = np.divide(fs, ks, out=np.zeros_like(fs), where=ks > 0)
    slip = np.abs(slip - held)
    k = int(slip.argmax())
    if slip[k] < ROUNDED * np.abs(held).max():
        return ""
    return f", {contact_name(h, int(contacts[k]))} by {slip[k]:.2g} m in all"
