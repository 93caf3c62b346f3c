"""How a SOLVE ended, as it is said."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from udec_ia.counting import counted
from udec_ia.errors import UdecError

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
    liveliest: what has most of the kinetic energy, "" if nothing moves. state: what goes on, one of
    ops.run.unrest.STATES, "" for rest and where nothing can be told; why: that in a sentence, with places
    and cure.
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
    state: str = ""
    why: str = ""

    def __bool__(self) -> bool:
        return self.reached

    @property
    def ratio(self) -> float:
        """The force ratio that was asked for, at the end."""
        return self.mean if self.criterion == MEAN else self.largest

    @property
    def _name(self) -> str:
        return "mean force ratio" if self.criterion == MEAN else "force ratio"

    def __str__(self) -> str:
        return f"{self._ending}; {self.why}" if self.why else self._ending

    @property
    def _ending(self) -> str:
        ratio = f"{self.ratio:.3g}" if np.isfinite(self.ratio) else "without bound, as no force is carried,"
        cycles = counted(self.cycles, "cycle")
        if self.reached:
            greatest = f", the largest {self.largest:.3g}" if self.criterion == MEAN else ""
            return f"{self._name} {self.wanted:g} reached: it is {ratio}{greatest} after {cycles}"
        found = f"{self._name} {self.wanted:g} NOT REACHED: it is {ratio} after {cycles}"
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
        return f" (the mean ratio is {self.mean:.3g}: SOLVE {self.wanted:g} MEAN is content with that)"

    @property
    def _advice(self) -> str:
        """What else to look at: strains that only DAMPING ... INTERNAL brings to rest."""
        return "; see DAMPING ... INTERNAL" if "strain" in self.worst else ""

    @property
    def short(self) -> str:
        """The same for the last line of a run; "" for rest without a blemish."""
        asked = f"SOLVE {self.wanted:g}" + (" MEAN" if self.criterion == MEAN else "")
        if not self.reached:
            return f"{asked} NOT REACHED ({self.ratio:.3g}{f', {self.state}' if self.state else ''})"
        return f"{asked} reached, but: {self.state}" if self.state else ""


def in_short(solutions: Sequence[Solution]) -> list[str]:
    """What there is to be said of SOLVEs in a few words, each once, with how often it has been so."""
    texts = Counter(one.short for one in worth_telling(solutions))
    return [text + (f", {times} times" if times > 1 else "") for text, times in texts.items()]


def worth_telling(solutions: Sequence[Solution]) -> list[Solution]:
    """Those that came to their limit, but for one before a SOLVE that asked for as much: that one tells.

    And those that reached their ratio with something to be said of it.
    """
    return [
        one
        for i, one in enumerate(solutions)
        if (one and one.state)
        or (
            not one
            and all(
                later.wanted > one.wanted or later.criterion != one.criterion for later in solutions[i + 1 :]
            )
        )
    ]
