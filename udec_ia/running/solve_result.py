"""The result of a SOLVE, as it is reported."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.unbalanced_force import (
    at_rest,
    at_rest_in_mean,
    force_ratios,
    motion_ratio,
    unbalanced_force,
)
from udec_ia.kernels.energy.stored_energy import greatest_motion
from udec_ia.ops.common.kernel_arguments import soft_or_loaded_in
from udec_ia.printable_text import counted
from udec_ia.remark import Remark
from udec_ia.running.group_names import name_of

MAX, MEAN = "max", "mean"  # criterion of SOLVE: the greatest unbalanced force, or the mean of all
SLIPPED = "joints slipped"  # in the last line of a run whose result depends on the loading path
IN_SHORT = {"joints-slipped": SLIPPED, "water-flows": "water flows", "function-goes-on": "a FUNCTION goes on"}


def criterion_of(word: str) -> str:
    """MAX or MEAN, in any case of letters. Error 10 for anything else."""
    if not isinstance(word, str) or word.lower() not in (MAX, MEAN):
        raise UdecError(10, f"SOLVE ... {word}", "MEAN or MAX", parameter="criterion")
    return word.lower()


@dataclass(frozen=True, repr=False)
class Solution:
    """How a SOLVE ended; true if it has reached rest.

    wanted: the given force ratio; criterion: "max" or "mean". largest, mean: greatest and mean unbalanced
    force over the mean force carried. worst: name of the group with the largest, or "". motion: kinetic over
    strain energy; greatest_energy: name of the group with most kinetic energy, or "". remarks: with keys
    (advice.rest_diagnosis). fallen: addresses of the blocks that have fallen.
    """

    reached: bool
    wanted: float
    largest: float
    cycles: int
    worst: str
    motion: float
    greatest_energy: str
    criterion: str = MAX
    mean: float = 0.0
    remarks: tuple[Remark, ...] = ()
    fallen: tuple[int, ...] = ()

    def __bool__(self) -> bool:
        return self.reached

    @property
    def ratio(self) -> float:
        """The force ratio of the criterion."""
        return self.mean if self.criterion == MEAN else self.largest

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of the remarks."""
        return tuple(one.key for one in self.remarks)

    def __str__(self) -> str:
        return "; ".join([self._ending, *self.remarks])

    def __repr__(self) -> str:
        return f"<Solution: {self}>"

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
            found += f", most out of balance is {self.worst}"
            if self.criterion == MAX and self.mean <= self.wanted:
                found += f" (mean ratio {self.mean:.3g}: SOLVE {self.wanted:g} MEAN would accept this state)"
            return found + ("; see DAMPING ... INTERNAL" if "strain" in self.worst else "")
        if self.motion > self.wanted:
            return (
                f"{found}, but there is no rest: kinetic over strain energy is {self.motion:.3g}, and "
                f"{self.greatest_energy} has most of it"
            )
        return f"{found}: run at least one cycle"

    @property
    def short(self) -> str:
        """The same for the last line of a run; "" for rest without remarks."""
        asked = f"SOLVE {self.wanted:g}" + (" MEAN" if self.criterion == MEAN else "")
        found = []
        if not self.reached:
            moves = self.ratio <= self.wanted < self.motion
            found.append(f"kinetic over strain energy {self.motion:.3g}" if moves else f"{self.ratio:.3g}")
        if self.fallen:
            found.append(f"{counted(len(self.fallen), 'block')} fallen")
        found += [text for key, text in IN_SHORT.items() if key in self.keys]
        if not self.reached:
            return f"{asked} NOT REACHED ({', '.join(found)})"
        return f"{asked} reached, but: {', '.join(found)}" if found else ""


def solution_of(array: MainArray, wanted: float, criterion: str, cycles: int) -> Solution:
    """The result of a SOLVE of `cycles` cycles, from the state at its end."""
    h, kinds, mean = array.h, soft_or_loaded_in(array.h), criterion == MEAN
    reached = cycles > 0 and bool((at_rest_in_mean if mean else at_rest)(h, float(wanted)))
    largest, average = map(float, force_ratios(h, kinds))
    groups = unbalanced_force(h, kinds)[1], greatest_motion(h, kinds)[2]
    worst, greatest_energy = (name_of(h, int(at)) if at else "" for at in groups)
    motion = float(motion_ratio(h, kinds))
    return Solution(reached, wanted, largest, cycles, worst, motion, greatest_energy, criterion, average)


def in_short(solutions: Sequence[Solution]) -> list[str]:
    """The short reports of SOLVEs, each once with its count."""
    texts = Counter(one.short for one in worth_reporting(solutions))
    return [text + (f", {times} times" if times > 1 else "") for text, times in texts.items()]


def worth_reporting(solutions: Sequence[Solution]) -> list[Solution]:
    """Solutions with a short report, except one not reached before a SOLVE for the same ratio or less."""

    def is_repeated(i: int, one: Solution) -> bool:
        later = solutions[i + 1 :]
        return any(two.wanted <= one.wanted and two.criterion == one.criterion for two in later)

    return [one for i, one in enumerate(solutions) if one.short and (one.reached or not is_repeated(i, one))]
