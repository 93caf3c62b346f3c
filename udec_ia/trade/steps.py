"""How many cycles each CYCLE must have with another time-step, for the same time.

What a CYCLE cannot have of its time in whole cycles, half a step at most, is left to the next one. Of the
fractions up to FIT below the one that is asked for, the one that leaves least is taken, the greatest of
equals.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from udec_ia.trade.levers import Numbers, Setting
from udec_ia.trade.surveyed import Segment

FIT = 0.06  # the greatest share by which a time-step may be smaller than it was asked for
TRIED = 60  # fractions that are tried at most
PATIENCE = 3  # times the cycles that a SOLVE is expected to take
SAME = 1e-9  # of the time: what does not count as left


def numbers(survey: Sequence[Segment], setting: Setting) -> Numbers:
    """What `setting` puts in the lines that count cycles. survey: of the deck as it is, with limits."""
    if setting.static:
        same = tuple(1.0 for _ in survey)
        return Numbers(1.0, tuple(None for _ in survey), same, _limits(survey, same, setting))
    timed = [one for one in survey if not one.solve and one.asked > 0]
    fits = [1.0]
    if timed:
        longest = max(timed, key=lambda one: one.asked * one.step)
        ideal = longest.asked * longest.step / _step(longest, setting)
        first = -int(-ideal * (1 - SAME) // 1)  # cycles, at least
        counts = range(max(first, 1), max(int(ideal / (1 - FIT)), first) + 1)
        fits = [min(1.0, ideal / count) for count in counts[:TRIED]] or fits
        total = sum(one.asked * one.step for one in timed)
    left = [max(map(abs, _cycles(survey, setting, fit)[1]), default=0.0) for fit in fits]
    best = next(k for k, one in enumerate(left) if one <= min(left) + (SAME * total if timed else 0.0))
    longer = tuple(one.step / (_step(one, setting) * fits[best]) for one in survey)
    cycles = _cycles(survey, setting, fits[best])[0]
    return Numbers(fits[best], cycles, longer, _limits(survey, longer, setting))


def _step(one: Segment, setting: Setting) -> float:
    """The time-step that a setting makes."""
    if one.static:
        return one.step
    return setting.safe * one.bound if setting.safe else setting.step * one.step


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


def _cycles(
    survey: Sequence[Segment], setting: Setting, fit: float
) -> tuple[tuple[int | None, ...], list[float]]:
    """The same for a setting."""
    return cycles_for(survey, [_step(one, setting) * fit for one in survey])


def to_rest(one: Segment, longer: float, setting: Setting) -> float:
    """Cycles that a SOLVE will take, a third more for each decade of the ratio."""
    return one.done * longer * (1 + max(-math.log10(setting.ratio), 0.0) / 3)


def _limits(survey: Sequence[Segment], longer: Sequence[float], setting: Setting) -> tuple[int | None, ...]:
    """Cycles after which each SOLVE is not expected to end any more."""
    return tuple(
        int(PATIENCE * to_rest(one, max(by, 1.0), setting)) + 1000 if one.solve else None
        for one, by in zip(survey, longer, strict=True)
    )


def longest(survey: Sequence[Segment]) -> float:
    """Times the time-step that FRACTION f SAFE and SCALED can be given, of which f is 1 at most."""
    return min((1 / one.fraction for one in survey if one.safe and not one.static), default=math.inf)


def share_of_bound(survey: Sequence[Segment], setting: Setting) -> float:
    """The greatest share of the safe bound that a time-step of `setting` has; 0 if nothing bounds it."""
    own = [one for one in survey if one.bound > 0 and not one.static]
    return max((_step(one, setting) / one.bound for one in own), default=0.0)
