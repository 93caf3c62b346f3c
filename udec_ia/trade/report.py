"""The price list in words: sentences, a table, and the lines to change."""

from __future__ import annotations

import math
from collections.abc import Iterator

from udec_ia.trade.changes import changes
from udec_ia.trade.judge import Row, pareto, tells, within
from udec_ia.trade.limit import Limit
from udec_ia.trade.trade import Price

NEAR = 0.1  # of the tolerance: share of the time that does not count
UNREST = "NOT REACHED"  # how SOLVE calls it
COLUMNS = ("setting", "error", "seconds", "predicted", "measured", "MB", "cycles", "what")


def table(price: Price) -> list[tuple[object, ...]]:
    """A line for each setting, the cheapest first; the dropped and the failed ones last."""
    front = {id(row) for row in pareto(price.rows)}

    def what(row: Row) -> str:
        if not row.compared or row.result is None:
            return _what_came(row)
        found = ["recommended"] if row is price.best else []
        found += ["Pareto set"] if id(row) in front else []
        found += ["within tolerance"] if within(row, price.margins, price.tolerance) else []
        found.append(_solved(row.result.message, row.setting.ratio, price))
        return ", ".join(part for part in found if part)

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


def _solved(said: str, ratio: float, price: Price) -> str:
    """What SOLVE says of a run, if it is something else than in the deck as it is."""
    return said if UNREST in said or (ratio == 1 and said != price.solved) else ""


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
    limits = _of_limits(price) if len(price.levels) > 1 else []
    found = [*limits, *_of_times(price), *_of_partings(price), *price.said, *_of_ways(price)]
    return found + _of_best(price)


def _of_limits(price: Price) -> Iterator[str]:
    for name, one in price.limits.items():
        if one is None:
            yield f"{name}: no value, see log.txt in {price.path(price.levels[-1])}"
        elif name in price.known:
            order = "" if price.deck.has("solve") else _order(one)  # whose ratio is made smaller as well
            far = (
                f"known to within {one.share:.1e} of it{order}"
                if one.error
                else "the same at all these steps"
            )
            yield f"{name}: {one.value:.7g}, {far}"
        else:
            yield f"{name}: {_of_unknown(price, name, one)}"


def _of_unknown(price: Price, name: str, one: Limit) -> str:
    """Why a quantity is not compared, and what runs give for it."""
    found = [row.result.quantities[name] for row in price.rows if row.result and row.compared]
    if math.isfinite(one.order):
        why = (
            f"converges to {one.value:.7g}, which is known to within {one.share:.1e} of it: too little for a "
            f"tolerance of {price.tolerance:g}"
        )
    else:
        why = (
            f"does not converge at these steps, {one.value:.5g} is known to within {one.share:.1e} of it only"
        )
    every = price.sampled.get(name)
    samples = f"; its samples, every {every} cycles, may be what differs: take HISTORY 1" if every else ""
    return (
        f"{why}; not compared{samples}; {len(found)} runs give {min(found):.5g} to {max(found):.5g}, "
        f"the mean is {sum(found) / len(found):.5g}"
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
        if row.result
        and row.compared
        and abs(row.result.time - ends[0]) > NEAR * price.tolerance * abs(ends[0])
    ]
    if off:
        yield f"end earlier or later than the deck: {', '.join(off)}"


def _of_partings(price: Price) -> Iterator[str]:
    """Where the finest runs part."""
    found = price.parted
    scatters = any(one and one.error and math.isnan(one.order) for one in price.limits.values())
    if found is not None and scatters:
        one, two = (row.setting.name for row in price.levels[-2:])
        yield (
            f"{one} and {two} part at {found.time:.4g} s: "
            f"from then on the block that was at ({found.x:.4g}, {found.y:.4g}) goes another way; "
            f"at the end the two are {found.apart:.3g} m apart, the greatest way is {found.moved:.3g} m"
        )


def _of_ways(price: Price) -> Iterator[str]:
    """What SOLVE says of the state that all settings lead to, and of those that they are compared with."""
    for row in price.levels[1:] if price.known else ():
        if row.result and UNREST in row.result.message:
            yield (
                f"SOLVE says in {row.setting.name}, with which settings are compared: {row.result.message}; "
                "so errors may be as large as what is left of its motion: ask for a greater ratio"
            )
    if not price.solved or not price.known:
        return
    slipped = "joints slipped" in price.solved
    why = "joints have slipped, and where all rests may depend on the way: " if slipped else ""
    other = (
        "another way may differ by more; load in steps, and compare"
        if slipped
        else "what it says of the state itself holds for every setting"
    )
    yield (
        f"SOLVE says in the deck as it is: {price.solved}; {why}the errors here are those of the step and "
        f"the ratio on this way of loading; {other}"
    )


def _of_best(price: Price) -> list[str]:
    without = [name for name in price.limits if name not in price.known]
    if not tells(price.limits, price.known):
        return [_of_none(price, without)]
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
    holds = f"; holds for {_all(price.known)} only: {_lacking(without)}" if without else ""
    said = [
        f"recommended for {price.tolerance:g}: {row.setting.name}, error {row.error:.2e} "
        f"(known to within {known:.1e}), {row.cost:.3g} s: {gain:.2f} times as fast as the deck as it is"
        f"{holds}"
    ]
    return said + [f"  {line}" for line in changes(price, row)]


def _of_none(price: Price, without: list[str]) -> str:
    """That nothing is recommended, and why."""
    if price.astray:
        return (
            f"no recommendation: {price.astray}; so there is no run with another time-step to compare the "
            "deck with"
        )
    if len(price.levels) < 2:
        return (
            "no recommendation: no run with half the time-step has ended, so there is nothing to compare "
            "with; see the table, or give a greater --budget"
        )
    cure = "ask for another --quantity, give a greater --tolerance or --budget, or see what --digits says"
    if not without:
        return (
            f"no recommendation: {_all(price.known)} {_is(price.known)} the same at all these steps, which "
            "tells nothing of the step; ask for another --quantity"
        )
    same = (
        f"; {_all(price.known)} {_is(price.known)} the same at all of them, which tells nothing of the step"
    )
    return f"no recommendation: {_lacking(without)}{same if price.known else ''}; {cure}"


def _lacking(names: list[str]) -> str:
    have = "has" if len(names) == 1 else "have"
    return f"{_all(names)} {have} no limit that is known well enough at these steps"


def _is(names: list[str]) -> str:
    return "is" if len(names) == 1 else "are"


def _all(names: list[str]) -> str:
    return " and ".join(part for part in (", ".join(names[:-1]), *names[-1:]) if part)


def half_step(price: Price) -> list[str]:
    """The check of report 4.6: the same run with half the time-step and twice the cycles."""
    one, half = (row.result.quantities for row in price.levels[:2] if row.result)
    found = []
    for name in price.limits:
        a, b = one[name], half[name]
        off = abs(a - b) / abs(b) if b else (0.0 if a == b else math.inf)
        every = price.sampled.get(name)
        fault = (
            f"ITS SAMPLES, every {every} cycles, or the time-step are too far apart: take HISTORY 1 before a "
            "smaller FRACTION"
            if every
            else "THE TIME-STEP IS TOO LARGE, take a smaller FRACTION"
        )
        differs = f" of it: {fault}" if off > price.tolerance else ""
        found.append(f"{name}: {a:.7g}, with half the step {b:.7g}, off by {off:.1e}{differs}")
    return found


def without(price: Price) -> list[str]:
    """Why rows are not compared, a sentence for each of these."""
    return [f"{row.setting.name}: {_what_came(row)}" for row in price.rows if not row.compared]


def _what_came(row: Row) -> str:
    """What came of a row that is not compared."""
    if row.result is None:
        return f"not run: {row.why or 'beyond the budget'}"
    return f"not compared: {row.why}" if row.ran else f"{row.result.status}: {row.result.message}"
