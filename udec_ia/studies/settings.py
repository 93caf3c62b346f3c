"""Settings of a deck: what a run of it is made with, and how many cycles that needs.

With another time-step each CYCLE gets the cycles of the same time. What whole cycles leave of it, half a step
at most, goes to the next CYCLE. Of the fractions up to FIT below the one that is asked for, the one that
leaves least is used, the greatest of equals.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.studies.survey_run import Segment

FIT = 0.06  # the greatest share by which a time-step may be smaller than asked for
TRIED = 60  # fractions that are tried at most
SAME_FRACTION = 1e-5  # share: what reals of 32 bits and ten digits of a deck leave
SAME = 1e-9  # of the time: a difference that does not count
BEYOND = 1.4  # of the safe bound, which is 0.7 of the true one or more: nothing is stable above


@dataclass(frozen=True)
class Setting:
    """What a run is made with.

    build: word scheme. step: times the time-step of the deck. safe: fraction of the safe bound instead, 0 for
    none. ratio: times the ratio of SOLVE. static: SOLVE ... STATIC. rounding, edge, stiffness: times the
    lengths of ROUND and of GENERATE ... EDGE, and KN and KS. contact: times KN, KS and the cohesions, which
    are properties of one contact, instead. types: "" as they are, or "rigid" or "sdef" for all blocks.
    """

    build: str = DEFAULT_SCHEME
    step: float = 1.0
    safe: float = 0.0
    ratio: float = 1.0
    static: bool = False
    rounding: float = 1.0
    edge: float = 1.0
    stiffness: float = 1.0
    contact: float = 1.0
    types: str = ""

    @property
    def name(self) -> str:
        """Its name, and that of its folder."""
        parts = [self.build]
        if self.safe:
            parts.append(f"safe={self.safe:.3g}")
        elif not self.static:
            parts.append(f"step={self.step:.4g}")
        times = ("ratio", "rounding", "edge", "stiffness", "contact")
        parts += [f"{name}={getattr(self, name):.3g}" for name in times if getattr(self, name) != 1]
        return ",".join([*parts, *["static"] * self.static, *[self.types] * bool(self.types)])

    def step_of(self, one: Segment) -> float:
        """The time-step (s) that it makes for a CYCLE or SOLVE of the deck."""
        if one.static:
            return one.step
        return self.safe * one.bound if self.safe else self.step * one.step


class Numbers(NamedTuple):
    """What a setting puts into the lines that count cycles.

    fit: times the fraction that is asked for, a little below 1. cycles: of each CYCLE and SOLVE, in order;
    None as they are. longer: of each of these, time-step of the deck over the new one.
    """

    fit: float = 1.0
    cycles: tuple[int | None, ...] = ()
    longer: tuple[float, ...] = ()


class Fraction(NamedTuple):
    """The parameters of FRACTION. words: " SAFE" or " SCALED", "" for a fraction of the estimate."""

    value: float
    words: str = ""


def count_cycles(survey: Sequence[Segment], setting: Setting) -> Numbers:
    """What `setting` puts into the lines that count cycles. survey: of the deck as it is, with bounds."""
    if setting.static:
        return Numbers(1.0, (None,) * len(survey), (1.0,) * len(survey))
    timed = [one for one in survey if not one.solve and one.asked > 0]
    fits, total = [1.0], sum(one.asked * one.step for one in timed)
    if timed:
        longest = max(timed, key=lambda one: one.asked * one.step)
        ideal = longest.asked * longest.step / setting.step_of(longest)
        first = max(math.ceil(ideal * (1 - SAME)), 1)
        counts = range(first, max(int(ideal / (1 - FIT)), first) + 1)
        fits = [min(1.0, ideal / count) for count in counts[:TRIED]]
    steps = [[setting.step_of(one) * fit for one in survey] for fit in fits]
    left = [max(map(abs, cycles_for(survey, some)[1]), default=0.0) for some in steps]
    best = next(k for k, one in enumerate(left) if one <= min(left) + SAME * total)
    longer = tuple(one.step / step for one, step in zip(survey, steps[best], strict=True))
    return Numbers(fits[best], cycles_for(survey, steps[best])[0], longer)


def cycles_for(
    survey: Sequence[Segment], steps: Sequence[float]
) -> tuple[tuple[int | None, ...], list[float]]:
    """Cycles of each CYCLE, None for SOLVE, for its time in the deck; and the time left after each (s)."""
    left, cycles, rests = 0.0, list[int | None](), list[float]()
    for one, step in zip(survey, steps, strict=True):
        if one.solve:
            left = 0.0
            cycles.append(None)
            continue
        n = max(1, round((one.asked * one.step + left) / step)) if one.asked else 0
        left += one.asked * one.step - n * step
        cycles.append(n)
        rests.append(left)
    return tuple(cycles), rests


def expected_cycles(survey: Sequence[Segment], numbers: Numbers, setting: Setting) -> float:
    """Cycles of all CYCLEs and SOLVEs; a SOLVE takes about a third more for each decade of its ratio."""
    closer = 1 + max(-math.log10(setting.ratio), 0.0) / 3
    counts = zip(survey, numbers.cycles, numbers.longer, strict=True)
    return sum(one.done * longer * closer if n is None else n for one, n, longer in counts)


def has_its_fraction(
    survey: Sequence[Segment], found: Sequence[Segment], setting: Setting, numbers: Numbers
) -> bool:
    """True if all CYCLEs and SOLVEs of a run have the fraction of its setting, which no PATCH has changed."""
    for own, one in zip(survey, found, strict=False):
        wanted = (setting.safe or own.fraction * setting.step) * numbers.fit
        same = math.isclose(one.fraction, wanted, rel_tol=SAME_FRACTION)
        same = same and one.safe == (own.safe or setting.safe > 0)
        if not (same or own.static or setting.static):
            return False
    return True


def cycled_time(found: Sequence[Segment], end: float) -> float:
    """Time of the model in all CYCLEs of a run that ended at `end` (s); that in SOLVEs has no meaning."""
    ends = [*(one.began for one in found[1:]), end]
    return sum(stop - one.began for one, stop in zip(found, ends, strict=False) if not one.solve)


def rounded(step: float) -> float:
    """A step as it is written: no two of one name differ in their last digits."""
    return float(f"{step:.4g}")


def share_of_bound(survey: Sequence[Segment], setting: Setting) -> float:
    """The greatest share of the safe bound that a time-step of `setting` has; 0 if nothing bounds it."""
    shares = [setting.step_of(one) / one.bound for one in survey if one.bound > 0 and not one.static]
    return max(shares, default=0.0)
