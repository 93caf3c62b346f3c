"""How many digits of each quantity a deck determines, and what takes the others: chaos, rounding, or the
step.

Noise of the last place is passed on. As long as it is small it grows in proportion: it costs as many digits
in words of any length, and longer words have all the more left: that is rounding. If 64-bit reals have less
than half of the digits more that they should have, the spread is not set by the words, but by how far
results can be apart at all: that is chaos. What changes with half the step by more than the spread is the
error of the step.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from udec_ia.counting import counted
from udec_ia.deck.deck_variables import Values
from udec_ia.heap.word_scheme import scheme
from udec_ia.study.many import run_all
from udec_ia.study.progress import Told
from udec_ia.study.runs import ENDED, Result
from udec_ia.trade.deck import Deck
from udec_ia.trade.levers import Setting
from udec_ia.trade.noise import KICKS, Noisy
from udec_ia.trade.shop import Options, Shop
from udec_ia.trade.significant import FEWEST, Digits, digits

ENSEMBLE = 16
KICK = 4e-4  # seconds, about
SHARE = 0.5  # of the digits that longer words have more, which rounding leaves and chaos does not
COLUMNS = (
    "quantity",
    "value",
    "digits",
    "at least",
    "32-bit digits",
    "32-bit at least",
    "step",
    "what limits it",
)


@dataclass
class Ensemble:
    """What --digits has found. results: by word scheme. half: with half the step. said: sentences."""

    shop: Shop
    names: list[str] = field(default_factory=list)
    plain: Result | None = None
    half: Result | None = None
    results: dict[str, list[Result]] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)

    @property
    def narrow(self) -> str:
        """The word scheme with shorter reals, "" if it cannot run the deck."""
        return next(iter([*self.results][1:]), "")

    def digits(self, build: str, name: str) -> Digits | None:
        """Of one quantity."""
        values = [one.quantities[name] for one in self.results[build] if one.status == ENDED]
        return digits(values, _bits(build))

    def step(self, name: str) -> float:
        """Digits that a run with half the step shares, NaN if there is none."""
        if self.plain is None or self.half is None:
            return math.nan
        a, b = self.plain.quantities[name], self.half.quantities[name]
        return math.inf if a == b else -math.log10(abs(a - b) / abs(b)) if b else 0.0

    def rows(self) -> list[tuple[object, ...]]:
        """A line for each quantity."""
        found: list[tuple[object, ...]] = []
        for name in self.names:
            one = self.digits(next(iter(self.results)), name)
            two = self.digits(self.narrow, name) if self.narrow else None
            parts = [getattr(a, part) if a else math.nan for a in (one, two) for part in ("digits", "lower")]
            step = min(self.step(name), one.full) if one else math.nan  # equal numbers share all digits
            cells = [_shown(number) for number in (*parts, step)]
            found.append((name, one.mean if one else "", *cells, verdict(one, two, step, self.narrow)))
        return found


def _shown(digits: float) -> float | str:
    return "" if math.isnan(digits) else round(digits, 1)


def verdict(wide: Digits | None, narrow: Digits | None, step: float, short: str) -> str:
    """What limits a quantity. short: the word scheme with shorter reals, "" if there is none."""
    if wide is None:
        return "too few runs have ended: see log.txt in their folders"
    if narrow is None:
        runs = f"too few runs of {short} have ended" if short else "no run has shorter reals"
        sooner = "the time-step; " if step < wide.lower else ""
        lost = f"noise takes {max(wide.full - wide.digits, 0):.1f} digits"
        return f"{sooner}{lost}; whether that is rounding or chaos is not known, as {runs}"
    more, gained = wide.full - narrow.full, max(wide.digits - narrow.digits, 0.0)
    if gained < SHARE * more:
        sooner = "; the time-step takes more" if step < wide.lower else ""
        return f"chaos: of the {more:.1f} digits more in longer words {gained:.1f} are left{sooner}"
    lost = f"rounding takes {max(wide.full - wide.digits, 0):.1f} digits"
    if step < wide.lower:
        return f"the time-step; {lost}"
    return lost


def measure(
    text: str,
    name: str,
    values: Values | None,
    folder: Path,
    options: Options,
    runs: int,
    where: Path | None = None,
) -> Ensemble:
    """Run the ensembles. runs: of each word scheme. Else as trade.trade."""
    deck = Deck(text, name, values, where)
    shop = Shop(deck, options, folder)
    found = Ensemble(shop)
    shop.rehearse()
    found.plain = shop.look()
    if found.plain.status != ENDED or not shop.survey:
        found.said.append(f"the deck as it is gives no digits: {found.plain.message or 'it has no CYCLE'}")
        return found
    found.names = [*found.plain.quantities][1:]
    row = shop.row(Setting(shop.wide, 0.5))
    shop.do([row])
    if row.why:
        found.said.append(f"no digits of the step: {row.why}")
    elif not deck.is_stepped:
        found.said.append("no digits of the step: SOLVE ... STATIC has one of its own, which FRACTION leaves")
    elif row.ran:
        found.half = row.result
    cycles = sum(one.done for one in shop.survey)
    seconds = found.plain.seconds + KICK * min(cycles, KICKS)
    runs = max(FEWEST, min(runs, int(shop.left * (options.jobs or 1) / (2 * seconds))))
    options.tell(f"{runs} runs of {seconds:.3g} s in each of {' and '.join(shop.builds[:2])}")
    for build in shop.builds[:2]:
        found.results[build] = perturbed(shop, build, cycles, range(1, runs + 1))
    every = max(1, cycles // KICKS)
    kicks = "noise every " + ("cycle" if every == 1 else f"{every} cycles")
    found.said += shop.said
    found.said.append(
        f"{runs} runs in each word scheme, {counted(cycles, 'cycle')}, {kicks}; "
        "confidence and probability 95 %"
    )
    return found


def perturbed(
    shop: Shop, build: str, cycles: int, seeds: range, fields: tuple[str, ...] = (), label: str = "noise"
) -> list[Result]:
    """Perturbed runs of the deck as it is."""
    text = shop.deck.written(Setting(build))
    asked, laws = shop.options.quantities, shop.options.constitutive
    runs = [
        Noisy(
            f"{build},{label}={seed}",
            text,
            shop.deck.name,
            quantities=("end of time = time", *asked),
            build=build,
            constitutive=laws,
            seed=seed,
            fields=fields,
            cycles=cycles,
        )
        for seed in seeds
    ]
    told = Told(shop.options.stream, len(runs))
    try:
        return run_all(runs, shop.folder, jobs=shop.options.jobs, timed=True, told=told)
    finally:
        told.close()


def _bits(build: str) -> int:
    """Bits of the fraction of a real."""
    return int(np.finfo(scheme(build).real_type).nmant)
