"""The diagnosis of a SOLVE at its end: blocks that fell or moved most, slip, functions that go on.

While SOLVE runs, a record of displacements is kept (running/displacement_record.py).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from udec_ia.advice.damping_report import what_damps
from udec_ia.advice.water_report import check_balance
from udec_ia.heap.accessors import Memory, getr, iget, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_stresses import joints_of
from udec_ia.kernels.energy.stored_energy import strain_energy
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.function_command import USERS
from udec_ia.ops.common.kernel_arguments import soft
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.printable_text import counted
from udec_ia.reader.list_walks import chain
from udec_ia.remark import Remark
from udec_ia.running.cycle_observer import Observer, between_cycles
from udec_ia.running.displacement_record import FALLEN, DisplacementRecord
from udec_ia.running.group_names import contact_name
from udec_ia.running.solve_result import Solution

MOVED = 0.1  # displacement over the greatest one, from which on blocks are counted
NAMED = 3  # blocks that are named
# Work of friction and of contacts that opened over the strain energy, from which on the loading path matters.
# Slip of a hundredth of the elastic shear takes a fiftieth of the energy of shear, which may be a tenth of
# all (docs/studies).
SLIPPED = 0.0015
ROUNDED = 1e-3  # least slip that is reported over the largest elastic shear


class RestDiagnosis(Observer):
    """Observes one SOLVE. rested: work of friction until the last state of rest, in J/m."""

    def __init__(self, rested: float) -> None:
        self.rested = rested
        self.record: DisplacementRecord | None = None

    def begin(self, array: MainArray, solves: bool) -> None:
        """Begin the record of displacements."""
        self.record = DisplacementRecord(array)

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """Cycles until the next displacements are recorded."""
        return n if self.record is None else min(n, self.record.cycles_ahead(array.h))

    def look(self, array: MainArray, cycles: int) -> None:
        """Record the displacements when they are due."""
        if self.record is not None and between_cycles(array.h):
            self.record.add_if_due(array.h)

    def end(self, array: MainArray) -> None:
        """Record the displacements at the end."""
        if self.record is not None and between_cycles(array.h):
            self.record.add(array.h)

    def complete(self, array: MainArray, solution: Solution) -> Solution:
        """`solution` with its remarks and the addresses of the blocks that have fallen."""
        h, record = array.h, self.record
        if record is None:
            return solution
        remarks = []
        moved = record.displacements(h, record.looks[0])
        size = 2 * np.asarray(getr(h, record.blocks, g.KBRO), float)
        fallen = (moved > 0) & ((moved > FALLEN * size) | record.lost)
        if solution.reached:
            fallen |= record.unsupported(h)
        if many := int(fallen.sum()):
            text = (
                f"{_have(many)} fallen, {_names(h, record.blocks, np.where(fallen, moved, -1.0), many)}: "
                f"each has moved by more than {FALLEN:.0%} of its size, has lost all its contacts, or has "
                "weight and no contact that carries a force"
            )
            remarks.append(Remark("blocks-fallen", text))
        if solution.reached:
            remarks += self._slipped(h)
            remarks += check_balance(array, solution.wanted)
            remarks += _changing_functions(h)
        else:
            remarks += _greatest_displacements(h, record)
            if not what_damps(h):
                remarks.append(Remark("no-damping", "nothing damps: DAMPING LOCAL 0.8 damps all frequencies"))
        return replace(solution, remarks=tuple(remarks), fallen=tuple(record.blocks[fallen].tolist()))

    def _slipped(self, h: Memory) -> list[Remark]:
        """A remark if friction and opening contacts have taken much energy since the last state of rest."""
        taken = float(h.cd[g.WFRIC]) - self.rested
        stored = float(strain_energy(h, soft(h)))
        if taken <= SLIPPED * stored:
            return []
        share = taken / stored if stored else math.inf
        of = f"{share:.2%} of" if share < 1 else f"{share:.3g} times"
        text = (
            f"joints have slipped on the way{_farthest_slip(h)}, or opened and lost their shear: that "
            f"took {taken:.3g} J/m, {of} the strain energy. The result may depend on the loading path: "
            "load in steps, and compare"
        )
        return [Remark("joints-slipped", text)]


def _greatest_displacements(h: Memory, record: DisplacementRecord) -> list[Remark]:
    """A remark on the blocks that moved most in the last quarter of a SOLVE."""
    since = record.looks[-1 - max(len(record.looks) // 4, 1)] if len(record.looks) > 1 else record.looks[0]
    moved = record.displacements(h, since)
    if not len(moved) or not moved.max() > 0:
        return []
    many, cycles = int((moved > MOVED * moved.max()).sum()), int(h.ci[g.MCTOT]) - since.cycle
    text = f"{_have(many)} moved most in the last {counted(cycles, 'cycle')}, "
    return [Remark("blocks-move", text + _names(h, record.blocks, moved, many))]


def _changing_functions(h: Memory) -> list[Remark]:
    """Remarks on the functions whose factors will change, for what follows them."""
    followed = np.concatenate([integers(h, list_of(h, kind), getattr(g, field)) for kind, field in USERS])
    signals, remarks, time = list_of(h, "signal"), [], float(h.cd[g.TIME])
    for isg in signals[np.isin(signals, followed)].tolist():
        at = chain(h, iget(h, isg, g.KTP), g.KTPN)
        points = [(float(getr(h, it, g.KTPT)), float(getr(h, it, g.KTPF))) for it in at]
        now = float(getr(h, isg, g.KTNOW))
        if any(t > time and f != now for t, f in points):
            (ends, last), number = points[-1], iget(h, isg, g.KTNUM)
            text = (
                f"FUNCTION {number} goes on until {ends:.4g} s: at {time:.4g} s its factor is {now:.4g}, and "
                f"{last:.4g} at the end. CYCLE TIME {ends - time:.4g} and then SOLVE lead to its last value"
            )
            remarks.append(Remark("function-goes-on", text))
    return remarks


def _have(many: int) -> str:
    return "1 block has" if many == 1 else f"{many} blocks have"


def _names(h: Memory, blocks: Any, moved: Any, many: int) -> str:
    """The first few of the `many` blocks that have moved most, with their places and displacements."""
    return ", ".join(
        f"block@{blocks[k]} at ({getr(h, int(blocks[k]), g.KX):.4g}, {getr(h, int(blocks[k]), g.KY):.4g}) by "
        f"{moved[k]:.2g} m"
        for k in np.argsort(-moved, kind="stable")[: min(many, NAMED)]
    )


def _farthest_slip(h: Memory) -> str:
    """The closed contact of constitutive number 1 that has slipped farthest; "" without measurable slip.

    Slip is shear displacement that the spring does not hold, since the contact closed.
    """
    contacts = list_of(h, "contact")
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
