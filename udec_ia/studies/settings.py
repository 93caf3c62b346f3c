"""Settings of a deck: what a run of it is made with, how many cycles that needs, and which are tried.

CYCLE counts cycles, but results belong to times. With another time-step each CYCLE gets the cycles of the
same time. What whole cycles leave of it, half a step at most, goes to the next CYCLE. Of the fractions up to
FIT below the one that is asked for, the one that leaves least is used, the greatest of equals.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.studies.survey_run import Segment

FIT = 0.06  # the greatest share by which a time-step may be smaller than asked for
TRIED = 60  # fractions that are tried at most
ALLOWED = 3  # times the expected cycles of a SOLVE, after which it ends
SAME_FRACTION = 1e-5  # share: what reals of 32 bits and ten digits of a deck leave
TIME_OFF = 0.05  # share of the time of all CYCLEs by which a run may be off, as cycles are whole
SAME = 1e-9  # of the time: a difference that does not count
STATIC_GAIN = {False: 3.5, True: 2.1}  # medians over the best damping, without and with SAFE (docs/rest.md)
RUNG = 2**0.5  # of the ladder of time-steps: the cheapest on it is so to within that factor
LONGEST = 16.0  # times the step of the deck
BEYOND = 1.4  # of the safe bound, which is 0.7 of the true one or more: nothing is stable above
SAFE = (0.9, 0.5)
TIGHTER = 0.1  # ratio of SOLVE, from one level of the reference to the next


@dataclass(frozen=True)
class Setting:
    """What a run is made with.

    build: word scheme. step: times the time-step of the deck. safe: fraction of the safe bound instead, 0 for
    none. ratio: times the ratio of SOLVE. static: SOLVE ... STATIC. rounding, edge, stiffness: times the
    lengths of ROUND and of GENERATE ... EDGE, and KN and KS. contact: times KN, KS and the cohesions, which
    are properties of one contact, instead. types: "" as they are, "rigid" or "sdef".
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
        times = {
            "ratio": self.ratio,
            "round": self.rounding,
            "edge": self.edge,
            "stiffness": self.stiffness,
            "contact": self.contact,
        }
        parts += [f"{what}={factor:.3g}" for what, factor in times.items() if factor != 1]
        parts += ["static"] if self.static else []
        parts += [self.types] if self.types else []
        return ",".join(parts)

    def step_of(self, one: Segment) -> float:
        """The time-step (s) that it makes for a CYCLE or SOLVE of the deck."""
        if one.static:
            return one.step
        return self.safe * one.bound if self.safe else self.step * one.step


@dataclass(frozen=True)
class Numbers:
    """What a setting puts into the lines that count cycles.

    fit: times the fraction that is asked for, a little below 1. cycles: of each CYCLE and SOLVE, in order;
    None as they are. longer: of each of these, time-step of the deck over the new one. limits: cycles after
    which each SOLVE ends; None as it is.
    """

    fit: float = 1.0
    cycles: tuple[int | None, ...] = ()
    longer: tuple[float, ...] = ()
    limits: tuple[int | None, ...] = ()


class Fraction(NamedTuple):
    """The parameters of FRACTION. words: " SAFE" or " SCALED", "" for a fraction of the estimate."""

    value: float
    words: str = ""


# ---- numbers of cycles


def count_cycles(survey: Sequence[Segment], setting: Setting) -> Numbers:
    """What `setting` puts into the lines that count cycles. survey: of the deck as it is, with bounds."""
    if setting.static:
        same = tuple(1.0 for _ in survey)
        return Numbers(1.0, tuple(None for _ in survey), same, _limits(survey, same, setting))
    timed = [one for one in survey if not one.solve and one.asked > 0]
    fits, total = [1.0], sum(one.asked * one.step for one in timed)
    if timed:
        longest = max(timed, key=lambda one: one.asked * one.step)
        ideal = longest.asked * longest.step / setting.step_of(longest)
        first = -int(-ideal * (1 - SAME) // 1)  # cycles, at least
        counts = range(max(first, 1), max(int(ideal / (1 - FIT)), first) + 1)
        fits = [min(1.0, ideal / count) for count in counts[:TRIED]] or fits
    steps = [[setting.step_of(one) * fit for one in survey] for fit in fits]
    left = [max(map(abs, cycles_for(survey, some)[1]), default=0.0) for some in steps]
    best = next(k for k, one in enumerate(left) if one <= min(left) + SAME * total)
    longer = tuple(one.step / step for one, step in zip(survey, steps[best], strict=True))
    cycles = cycles_for(survey, steps[best])[0]
    return Numbers(fits[best], cycles, longer, _limits(survey, longer, setting))


def cycles_for(
    survey: Sequence[Segment], steps: Sequence[float]
) -> tuple[tuple[int | None, ...], list[float]]:
    """Cycles of each CYCLE, None for SOLVE, for the time that it has in the deck, with other time-steps (s).

    And the time that is left after each of them (s).
    """
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


def expected_cycles(survey: Sequence[Segment], numbers: Numbers, setting: Setting) -> list[float]:
    """Cycles of each CYCLE and SOLVE, the latter as far as can be known."""
    found: list[float] = []
    for one, n, longer in zip(survey, numbers.cycles, numbers.longer, strict=True):
        cycles = _to_rest(one, longer, setting) if n is None else float(n)
        gains = setting.static and one.solve and not one.static
        found.append(cycles / STATIC_GAIN[one.safe] if gains else cycles)
    return found


def _to_rest(one: Segment, longer: float, setting: Setting) -> float:
    """Cycles that a SOLVE is expected to take, a third more for each decade of the ratio."""
    return one.done * longer * (1 + max(-math.log10(setting.ratio), 0.0) / 3)


def _limits(survey: Sequence[Segment], longer: Sequence[float], setting: Setting) -> tuple[int | None, ...]:
    """Cycles after which each SOLVE is not expected to end any more."""
    return tuple(
        int(ALLOWED * _to_rest(one, max(by, 1.0), setting)) + 1000 if one.solve else None
        for one, by in zip(survey, longer, strict=True)
    )


def check_time_step(
    survey: Sequence[Segment], found: Sequence[Segment], setting: Setting, numbers: Numbers
) -> int:
    """The first CYCLE or SOLVE of a run whose fraction is not that of its setting, from 0; -1 for none.

    A deck can set its time-step past FRACTION, by PATCH or RSET of the word FRAC or by a second START. Then a
    setting that changes FRACTION has no effect, and its run cannot be compared.
    """
    for k, (own, one) in enumerate(zip(survey, found, strict=False)):
        if own.static or setting.static:
            continue
        wanted = (setting.safe or own.fraction * setting.step) * numbers.fit
        safe = own.safe or bool(setting.safe)
        if one.safe != safe or not math.isclose(one.fraction, wanted, rel_tol=SAME_FRACTION):
            return k
    return -1


def cycled_time(found: Sequence[Segment], end: float) -> float:
    """Time of the model in all CYCLEs of a run that ended at `end` (s); that in SOLVEs has no meaning."""
    ends = [*(one.began for one in found[1:]), end]
    return sum(stop - one.began for one, stop in zip(found, ends, strict=False) if not one.solve)


def is_other_time(time: float, own: float) -> bool:
    """True if the time in CYCLEs is not that of the deck."""
    return abs(time - own) > TIME_OFF * abs(own)


# ---- settings to be tried


def reference_setting(setting: Setting, k: int, stepped: bool, solves: bool) -> Setting:
    """The reference after `k` halvings. stepped: FRACTION matters; solves: there is a SOLVE."""
    ratio = TIGHTER**k if solves else 1.0
    return replace(setting, step=2.0**-k if stepped else 1.0, ratio=float(f"{ratio:.6g}"))


def longer_steps(
    survey: Sequence[Segment], builds: Sequence[str], stepped: bool, solves: bool, rests: bool
) -> list[Setting]:
    """Steps of the deck and above, as far as they can be stable, and what else is cheaper.

    rests: the deck seeks nothing but rest, so SOLVE ... STATIC is one of them.
    """
    if not stepped:
        return _with_tighter([Setting(build) for build in builds], solves)
    found: list[Setting] = []
    largest = min((1 / one.fraction for one in survey if one.safe and not one.static), default=math.inf)
    for build in builds:
        step = 1.0
        while step <= min(LONGEST * 1.01, largest):
            one = Setting(build, rounded(step))
            if step == 1 or share_of_bound(survey, one) <= BEYOND:
                found.append(one)
            step *= RUNG
        if any(0 < one.bound < math.inf for one in survey):
            found += [Setting(build, safe=safe) for safe in SAFE]
        if rests:
            found.append(Setting(build, static=True))
    return _with_tighter(found, solves)


def shorter_steps(builds: Sequence[str], finest: float, stepped: bool, solves: bool) -> list[Setting]:
    """Steps below that of the deck, down to `finest`, if they matter to it."""
    found: list[Setting] = []
    step = 1 / RUNG
    while stepped and step > finest * 0.99:
        found += [Setting(build, rounded(step)) for build in builds]
        step /= RUNG
    return _with_tighter(found, solves)


def _with_tighter(settings: list[Setting], solves: bool) -> list[Setting]:
    """These settings, and with a SOLVE the same closer to rest."""
    return settings + [replace(one, ratio=one.ratio * TIGHTER) for one in settings if solves]


def rounded(step: float) -> float:
    """A step as it is written: no two of one name differ in their last digits."""
    return float(f"{step:.4g}")


def share_of_bound(survey: Sequence[Segment], setting: Setting) -> float:
    """The greatest share of the safe bound that a time-step of `setting` has; 0 if nothing bounds it."""
    own = [one for one in survey if one.bound > 0 and not one.static]
    return max((setting.step_of(one) / one.bound for one in own), default=0.0)
