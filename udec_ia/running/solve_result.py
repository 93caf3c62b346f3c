"""The result of a SOLVE, as it is reported."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.unbalanced_force import (
    at_rest,
    at_rest_in_mean,
    force_ratios,
    motion_ratio,
    unbalanced,
)
from udec_ia.kernels.energy.stored_energy import liveliest
from udec_ia.ops.common.deformable_scene import soft_or_loaded_in
from udec_ia.printable_text import counted
from udec_ia.remark_key import Remark
from udec_ia.running.group_names import name_of

MAX, MEAN = "max", "mean"  # what SOLVE judges by: the greatest unbalanced force, or the mean of all


def criterion_of(word: str) -> str:
    """MAX or MEAN, in any case of letters. Error 10 for anything else."""
    if not isinstance(word, str) or word.lower() not in (MAX, MEAN):
        raise UdecError(10, f"SOLVE ... {word}", "MEAN or MAX", parameter="criterion")
    return word.lower()


class Solution(NamedTuple):
    """How a SOLVE ended.

    wanted: force ratio asked for; criterion: of which of the two, "max" or "mean". largest, mean: greatest
    and mean unbalanced force over the mean of what is carried, at the end. cycles: how many it took. worst:
    what is farthest from balance, "" if nothing is out of it. motion: kinetic over strain energy at the end;
    liveliest: what has most of the kinetic energy, "" if nothing moves. remarks: what the diagnosis has
    found, each with a key (advice.rest_diagnosis). fallen: addresses of the blocks that have fallen.
    """

    reached: bool
    wanted: float
    largest: float
    cycles: int
    worst: str
    motion: float
    liveliest: str
    criterion: str = MAX
    mean: float = 0.0
    remarks: tuple[Remark, ...] = ()
    fallen: tuple[int, ...] = ()

    def __bool__(self) -> bool:
        return self.reached

    @property
    def ratio(self) -> float:
        """The force ratio that was asked for, at the end."""
        return self.mean if self.criterion == MEAN else self.largest

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of the remarks."""
        return tuple(one.key for one in self.remarks)

    def __str__(self) -> str:
        return "; ".join([self._ending, *self.remarks])

    @property
    def _ending(self) -> str:
        name = "mean force ratio" if self.criterion == MEAN else "force ratio"
        ratio = f"{self.ratio:.3g}" if np.isfinite(self.ratio) else "without bound, as no force is carried,"
        cycles = counted(self.cycles, "cycle")
        if self.reached:
            greatest = f", the largest {self.largest:.3g}" if self.criterion == MEAN else ""
            return f"{name} {self.wanted:g} reached: it is {ratio}{greatest} after {cycles}"
        found = f"{name} {self.wanted:g} NOT REACHED: it is {ratio} after {cycles}"
        if self.ratio > self.wanted:
            return f"{found}, most out of balance is {self.worst}{self._in_mean}{self._advice}"
        if self.motion > self.wanted:
            motion = (
                f"is {self.motion:.3g}"
                if np.isfinite(self.motion)
                else "has no bound, nothing being strained"
            )
            return (
                f"{found}, but there is no rest: kinetic over strain energy {motion}, and {self.liveliest} "
                "has most of it"
            )
        return f"{found}, and at least one cycle must show it"

    @property
    def _in_mean(self) -> str:
        """That only few things are out of balance, if so."""
        if self.criterion == MEAN or not self.mean <= self.wanted < self.largest:
            return ""
        return f" (the mean ratio is {self.mean:.3g}: SOLVE {self.wanted:g} MEAN would accept this state)"

    @property
    def _advice(self) -> str:
        """What else to look at: strains that only DAMPING ... INTERNAL brings to rest."""
        return "; see DAMPING ... INTERNAL" if "strain" in self.worst else ""

    @property
    def short(self) -> str:
        """The same for the last line of a run; "" for rest without a blemish."""
        asked = f"SOLVE {self.wanted:g}" + (" MEAN" if self.criterion == MEAN else "")
        found = []
        if not self.reached:
            moves = self.ratio <= self.wanted < self.motion
            found.append(f"kinetic over strain energy {self.motion:.3g}" if moves else f"{self.ratio:.3g}")
        if self.fallen:
            found.append(f"{counted(len(self.fallen), 'block')} fallen")
        if "joints-slipped" in self.keys:
            found.append("joints slipped")
        if not self.reached:
            return f"{asked} NOT REACHED ({', '.join(found)})"
        return f"{asked} reached, but: {', '.join(found)}" if found else ""


def solution_of(array: MainArray, wanted: float, criterion: str, cycles: int) -> Solution:
    """How a SOLVE ended that has taken `cycles` cycles, from the state that it left."""
    h, kinds, mean = array.h, soft_or_loaded_in(array.h), criterion == MEAN
    reached = cycles > 0 and bool((at_rest_in_mean if mean else at_rest)(h, float(wanted)))
    largest, average = map(float, force_ratios(h, kinds))
    worst, lively = (
        name_of(h, int(at)) if at else "" for at in (unbalanced(h, kinds)[1], liveliest(h, kinds)[2])
    )
    motion = float(motion_ratio(h, kinds))
    return Solution(reached, wanted, largest, cycles, worst, motion, lively, criterion, average)


def in_short(solutions: Sequence[Solution]) -> list[str]:
    """What SOLVEs have to report in a few words, each once, with how often it has been so."""
    texts = Counter(one.short for one in worth_reporting(solutions))
    return [text + (f", {times} times" if times > 1 else "") for text, times in texts.items()]


def worth_reporting(solutions: Sequence[Solution]) -> list[Solution]:
    """Those that came to their limit, but for one before a SOLVE that asked for as much: that one reports.

    And those that reached their ratio with something to report.
    """
    return [
        one
        for i, one in enumerate(solutions)
        if (one and one.short)
        or (
            not one
            and all(
                later.wanted > one.wanted or later.criterion != one.criterion for later in solutions[i + 1 :]
            )
        )
    ]
