"""The price list in words: sentences, a table, and the lines to change."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from udec_ia.trade.judge import Row, pareto, within
from udec_ia.trade.levers import Setting
from udec_ia.trade.limit import Limit
from udec_ia.trade.trade import Price

NEAR = 0.1  # of the tolerance: share of the time that does not count
COLUMNS = ("setting", "error", "seconds", "predicted", "measured", "MB", "cycles", "what")


def table(price: Price) -> list[tuple[object, ...]]:
    """A line for each setting, the cheapest first; the dropped and the failed ones last."""
    front = {id(row) for row in pareto(price.rows)}

    def what(row: Row) -> str:
        if row.result is None:
            return "not run: beyond the budget"
        if not row.ran:
            return f"{row.result.status}: {row.result.message}"
        found = ["recommended"] if row is price.best else []
        found += ["Pareto set"] if id(row) in front else []
        found += ["within tolerance"] if within(row, price.margins, price.tolerance) else []
        return ", ".join(found)

    rows = sorted(price.rows, key=lambda row: (row.cost, row.predicted))
    return [
        (
            row.setting.name,
            row.error,
            row.cost,
            row.predicted,
            row.result.seconds if row.result else math.nan,
            row.memory / 1e6 if row.result else math.nan,
            row.result.cycles if row.result else 0,
            what(row),
        )
        for row in rows
    ]


def shown(price: Price) -> list[tuple[object, ...]]:
    """The same to be read: nothing where no run has come to an end."""
    return [
        tuple("" if isinstance(cell, float) and not math.isfinite(cell) else cell for cell in row)
        for row in table(price)
    ]


def sentences(price: Price) -> list[str]:
    """What there is to say, the recommendation last."""
    if not price.rows:
        return price.said
    found = [*_of_limits(price), *_of_times(price), *_of_partings(price), *price.said]
    return found + _of_best(price)


def _of_limits(price: Price) -> Iterator[str]:
    for name, one in price.limits.items():
        if one is None:
            yield f"{name}: no value, see log.txt in {price.path(price.levels[-1])}"
        elif name in price.known:
            order = "" if price.deck.has("solve") else _order(one)  # whose ratio is made smaller as well
            yield f"{name}: {one.value:.7g}, known to within {one.share:.1e} of it{order}"
        else:
            known = [row.result.quantities[name] for row in price.rows if row.result and row.ran]
            yield (
                f"{name}: does not converge at these steps, {one.value:.5g} is known to within "
                f"{one.share:.1e} of it only; not compared; {len(known)} runs give {min(known):.5g} to "
                f"{max(known):.5g}, the mean is {sum(known) / len(known):.5g}"
            )


def _order(one: Limit) -> str:
    return "" if math.isnan(one.order) else f"; its error grows with the power {one.order:.2f} of the step"


def _of_times(price: Price) -> Iterator[str]:
    """Settings that do not end when the deck does, for want of a whole cycle or as their steps came out."""
    ends = [row.result.time for row in price.levels if row.result]
    if not ends or price.deck.has("solve"):
        return
    off = [
        f"{row.setting.name} by {row.result.time - ends[0]:.2g} s"
        for row in price.rows
        if row.result and row.ran and abs(row.result.time - ends[0]) > NEAR * price.tolerance * abs(ends[0])
    ]
    if off:
        yield f"end earlier or later than the deck: {', '.join(off)}"


def _of_partings(price: Price) -> Iterator[str]:
    """Where the finest runs part."""
    found = price.parted
    if found is not None:
        one, two = (row.setting.name for row in price.levels[-2:])
        yield (
            f"{one} and {two} part at {found.time:.4g} s: "
            f"from then on the block that was at ({found.x:.4g}, {found.y:.4g}) goes another way; "
            f"at the end the two are {found.apart:.3g} m apart, the greatest way is {found.moved:.3g} m"
        )


def _of_best(price: Price) -> list[str]:
    if not price.known:
        return [
            "no recommendation: no quantity converges, so there is nothing to measure settings against; "
            "ask for another --quantity, or see what --digits says"
        ]
    row = price.best
    if row is None:
        nearest = min(price.rows, key=lambda row: row.error)
        return [
            f"no setting that was run keeps to {price.tolerance:g}: the least error is {nearest.error:.2e}, "
            f"of {nearest.setting.name}; give a greater --budget or --tolerance"
        ]
    own = next(one for one in price.levels if one.setting.step == 1)
    gain = own.cost / row.cost if row.cost else 1.0
    known = max(price.margins[name] for name in row.errors)
    said = [
        f"recommended for {price.tolerance:g}: {row.setting.name}, error {row.error:.2e} "
        f"(known to within {known:.1e}), {row.cost:.3g} s: {gain:.2f} times as fast as the deck as it is"
    ]
    return said + [f"  {line}" for line in changes(price, row)]


def changes(price: Price, row: Row) -> list[str]:
    """What to change in the deck and on the command line for a setting."""
    fraction = price.fraction
    before = price.deck.written(Setting(row.setting.build), None, fraction).splitlines()
    numbers = replace(row.numbers, limits=())  # a SOLVE may take as long as it does
    after = price.deck.written(row.setting, numbers, fraction).splitlines()
    own = price.deck.text.splitlines()
    found, number = [f"--build {row.setting.build}"], 0
    for old, new in zip(before, after, strict=True):
        inserted = number >= len(own) or (old.startswith("FRACTION") and "FRAC" not in own[number].upper())
        number += not inserted
        if inserted:
            found.append(f"after line {number}: {new}")
        elif old != new:
            found.append(f"line {number}: {own[number - 1].strip()} -> {new}")
    return found


def half_step(price: Price) -> list[str]:
    """The check of report 4.6: the same run with half the time-step and twice the cycles."""
    one, half = (row.result.quantities for row in price.levels[:2] if row.result)
    found = []
    for name in price.limits:
        a, b = one[name], half[name]
        off = abs(a - b) / abs(b) if b else (0.0 if a == b else math.inf)
        differs = off > price.tolerance
        found.append(
            f"{name}: {a:.7g}, with half the step {b:.7g}, off by {off:.1e}"
            f"{' of it: THE TIME-STEP IS TOO LARGE, take a smaller FRACTION' if differs else ''}"
        )
    return found
