"""What a run will cost: seconds of preparing, and for each CYCLE its cycles times seconds a cycle.

Seconds a cycle are those of a rehearsal, or better of the survey, of the same word scheme or of another one
times the ratio that both have had in rehearsals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from udec_ia.study.runs import Result
from udec_ia.trade.levers import Numbers, Setting
from udec_ia.trade.steps import to_rest
from udec_ia.trade.surveyed import Segment

GAINS = {
    False: 3.5,
    True: 2.1,
}  # medians of STATIC over the best damping, without and with SAFE (docs/rest.md)


@dataclass(frozen=True)
class Rates:
    """apart: seconds beside cycles. each: seconds a cycle, of each CYCLE and SOLVE."""

    apart: float
    each: tuple[float, ...]

    def seconds(self, cycles: Sequence[float]) -> float:
        """Of a run with so many cycles in each CYCLE and SOLVE."""
        return self.apart + sum(n * rate for n, rate in zip(cycles, self.each, strict=False))


def rates(result: Result, survey: Sequence[Segment]) -> Rates:
    """What a run has shown."""
    spent = sum(one.seconds for one in survey)
    each = tuple(one.seconds / max(one.done, 1) for one in survey)
    return Rates(max(result.seconds - spent, 0.0), each)


def ratio(rehearsed: Rates, of: Rates) -> float:
    """Seconds a cycle of one word scheme over those of another one, as a mean over all CYCLEs."""
    both = [(a, b) for a, b in zip(rehearsed.each, of.each, strict=False) if a > 0 and b > 0]
    return sum(a for a, _ in both) / sum(b for _, b in both) if both else 1.0


def scaled(one: Rates, factor: float) -> Rates:
    """The same with all cycles `factor` times as dear."""
    return Rates(one.apart, tuple(rate * factor for rate in one.each))


def cycles_of(survey: Sequence[Segment], numbers: Numbers, setting: Setting) -> list[float]:
    """Cycles of each CYCLE and SOLVE, the latter as far as can be known."""
    found: list[float] = []
    for one, n, longer in zip(survey, numbers.cycles, numbers.longer, strict=True):
        cycles = to_rest(one, longer, setting) if n is None else float(n)
        found.append(cycles / _gain(one) if setting.static and one.solve and not one.static else cycles)
    return found


def _gain(one: Segment) -> float:
    """How many times fewer cycles SOLVE ... STATIC is expected to take."""
    return GAINS[one.safe]
