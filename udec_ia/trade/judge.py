"""What settings are worth: their errors against the reference, the Pareto set, and the one to take."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from udec_ia.heap.word_scheme import scheme
from udec_ia.study.runs import ENDED, Result
from udec_ia.trade.levers import Numbers, Setting
from udec_ia.trade.limit import Limit

SPREAD = 0.5  # of the tolerance: what the error of a reference may be
SCATTER = 0.2, 0.02  # share, and seconds, by which two times have to differ before one is the shorter


@dataclass
class Row:
    """A setting, and what came of it.

    predicted: seconds. result: None for what was dropped. cost: seconds by the rates of the survey and the
    cycles that it took. errors: share of the reference, by quantity. why: it was dropped, or is not compared
    though it ran; "" if the budget has dropped it, or nothing has.
    """

    setting: Setting
    numbers: Numbers
    predicted: float
    result: Result | None = None
    cost: float = math.inf
    errors: dict[str, float] = field(default_factory=dict)
    why: str = ""

    @property
    def ran(self) -> bool:
        """True if it came to its end."""
        return self.result is not None and self.result.status == ENDED

    @property
    def compared(self) -> bool:
        """True if it came to its end, and is a run of the deck."""
        return self.ran and not self.why

    @property
    def error(self) -> float:
        """The greatest of its errors."""
        return max(self.errors.values(), default=math.inf) if self.compared else math.inf

    @property
    def memory(self) -> int:
        """Bytes of IA() in use."""
        bits = scheme(self.setting.build).int_bits
        return self.result.words * bits // 8 if self.result else 0


def judge(
    rows: Sequence[Row], limits: Mapping[str, Limit | None], tolerance: float, parted: bool
) -> list[str]:
    """Enter the errors of all rows. Returns the names of the quantities that can be compared.

    If these tell nothing of the step, there are no errors.

    parted: the finest runs have parted for good. Then two numbers may still be near each other by chance, and
    only those that converge with an order, or are the same, are compared.
    """
    known = [
        name
        for name, one in limits.items()
        if one
        and one.share <= SPREAD * tolerance
        and (not parted or math.isfinite(one.order) or one.error == 0)
    ]
    choosing = known if tells(limits, known) else []
    for row in rows:
        if row.result is not None and not row.why:
            found = row.result.quantities
            row.errors = {name: limits[name].error_of(found[name]) for name in choosing}  # type: ignore[union-attr]
    return known


def tells(limits: Mapping[str, Limit | None], known: Sequence[str]) -> bool:
    """True if the known quantities are enough to choose a setting by.

    One that is the same number at all steps, 0 above all, tells nothing of the step.
    """
    return any((one := limits[name]) is not None and one.error > 0 for name in known)


def margin(limits: Mapping[str, Limit | None], known: Sequence[str]) -> dict[str, float]:
    """By how much a measured error may be wrong: the error of the reference."""
    return {name: one.share for name in known if (one := limits[name])}


def within(row: Row, margins: Mapping[str, float], tolerance: float) -> bool:
    """True if all errors, with what they may be wrong by, are within the tolerance."""
    if not row.compared or not row.errors:
        return False
    return all(error + margins[name] <= tolerance for name, error in row.errors.items())


def recommended(rows: Sequence[Row], margins: Mapping[str, float], tolerance: float) -> Row | None:
    """The cheapest setting within the tolerance; of equals the one that needs less memory.

    With 32-bit reals only where they are faster by more than times scatter: they lose more in another deck.
    """
    fit = [row for row in rows if within(row, margins, tolerance)]
    wide = [row for row in fit if scheme(row.setting.build).real_bits == 64]
    best, safe = (min(some, key=lambda row: (row.cost, row.memory), default=None) for some in (fit, wide))
    if best is None or safe is None:
        return best
    share, seconds = SCATTER
    return best if safe.cost - best.cost > max(share * safe.cost, seconds) else safe


def pareto(rows: Sequence[Row]) -> list[Row]:
    """Rows to which no other is better in error, time and memory, or as good in all and better in one."""

    def marks(row: Row) -> tuple[float, float, float]:
        return row.error, row.cost, row.memory

    def beats(a: tuple[float, ...], b: tuple[float, ...]) -> bool:
        return a != b and all(x <= y for x, y in zip(a, b, strict=True))

    ran = [row for row in rows if math.isfinite(row.error)]
    return [row for row in ran if not any(beats(marks(other), marks(row)) for other in ran)]
