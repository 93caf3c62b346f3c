"""The price list of a deck: rehearsal, survey, reference, settings, recommendation (see the package)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from udec_ia.counting import counted
from udec_ia.deck.deck_variables import Values
from udec_ia.study.many import RUNS
from udec_ia.study.runs import ENDED
from udec_ia.trade import candidates
from udec_ia.trade.deck import Deck
from udec_ia.trade.judge import Row, judge, margin, recommended, tells
from udec_ia.trade.levers import Fraction, Setting
from udec_ia.trade.limit import Limit, limit, shrinks
from udec_ia.trade.parting import Parting, parting
from udec_ia.trade.sampling import samples
from udec_ia.trade.shop import SURVEYED, Options, Shop

WANTED = 0.1  # of the tolerance: the error of the reference that it is refined for
LEVELS, FINEST = 2, 6  # halvings of the reference: at first, and at most
REST_ORDER = (
    12.0  # order with which values may converge where rest is sought more closely from level to level
)


@dataclass
class Price:
    """The price list. rows: of all settings. limits: of the quantities, None without one.

    known: quantities that can be compared. levels: rows of the reference, the step halved from one to the
    next. best: what to take. fraction: that the deck begins with, None if that does not matter. parted: where
    the finest runs part. solved: what SOLVE says in the deck as it is, "" for rest without a blemish. said:
    sentences.
    """

    deck: Deck
    tolerance: float
    folder: Path
    rows: list[Row] = field(default_factory=list)
    levels: list[Row] = field(default_factory=list)
    limits: dict[str, Limit | None] = field(default_factory=dict)
    known: list[str] = field(default_factory=list)
    best: Row | None = None
    fraction: Fraction | None = None
    parted: Parting | None = None
    solved: str = ""
    sampled: dict[str, int] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)

    @property
    def margins(self) -> dict[str, float]:
        """See judge.margin."""
        return margin(self.limits, self.known)

    @property
    def astray(self) -> str:
        """Why there is nothing to compare with, if no run with half the step is one of the deck; else ""."""
        if len(self.levels) > 1:
            return ""
        return next((row.why for row in self.rows if row.ran and row.why), "")

    def path(self, row: Row) -> Path:
        """The folder of a run."""
        return self.folder / RUNS / row.setting.name


def trade(
    text: str, name: str, values: Values | None, folder: Path, options: Options, where: Path | None = None
) -> Price:
    """The price list of the deck `text`. name: of its file. where: its folder. folder: for what is written.

    Raises UdecError for what is wrong with the deck, and if nothing can be written.
    """
    deck = Deck(text, name, values, where)
    price = Price(deck, options.tolerance, folder)
    shop = Shop(deck, options, folder)
    shop.rehearse()
    ahead = shop.rehearsed()
    options.tell(f"the deck as it is will take about {ahead:.3g} s, by a rehearsal of it")
    if ahead > options.budget:
        price.said.append(
            f"the deck as it is takes {ahead:.3g} s, more than the budget of {options.budget:g} s: "
            "give a greater --budget"
        )
        return price
    result = shop.look()
    if result.status != ENDED or not shop.survey:
        reason = result.message or "it has no CYCLE and no SOLVE"
        price.said.append(f"the deck as it is gives nothing to compare: {reason}")
        return price
    shop.left -= result.seconds
    price.fraction, price.solved = shop.fraction, result.message
    price.sampled = samples(options.quantities, folder / RUNS / SURVEYED)
    cycles = counted(sum(one.done for one in shop.survey), "cycle")
    options.tell(f"it has taken {result.seconds:.3g} s for {cycles}")
    if options.half_step:
        price.rows += (rows := [shop.row(Setting(shop.wide, step)) for step in (1.0, 0.5)])
        shop.do(rows)
        price.levels = [row for row in rows if row.compared]
        price.limits = dict.fromkeys(_names(price))
        return price
    _reference(price, shop)
    if len(price.levels) > 1:
        _settings(price, shop)
    price.said += [*shop.said, *_dropped(price)]
    return price


def _names(price: Price) -> list[str]:
    """Names of the quantities."""
    return [*price.levels[0].result.quantities][1:] if price.levels and price.levels[0].result else []


def _reference(price: Price, shop: Shop) -> None:
    """Halve the step until the limits are known well enough, or the budget ends, or nothing converges."""
    own, deck = Setting(shop.wide), price.deck
    highest = REST_ORDER if deck.has("solve") else 3.0
    wanted = [shop.row(candidates.level(own, k, deck)) for k in range(LEVELS + 1)]
    while True:
        shop.options.tell(f"reference: {', '.join(row.setting.name for row in wanted)}")
        price.rows += wanted
        if shop.do(wanted):
            shop.options.tell("the budget does not allow a finer reference")
        price.levels += [row for row in wanted if row.compared]
        price.parted = _parted(price)
        names = _names(price)
        values = {name: [row.result.quantities[name] for row in price.levels if row.result] for name in names}
        price.limits = {name: limit(found, highest) for name, found in values.items()}
        price.known = judge(price.rows, price.limits, price.tolerance, price.parted is not None)
        unknown = [
            name
            for name, one in price.limits.items()
            if one and one.share > WANTED * price.tolerance and shrinks(values[name])
        ]
        k = len(price.levels)
        if not unknown or k > FINEST or any(not row.compared for row in wanted):
            return
        wanted = [shop.row(candidates.level(own, k, deck))]
        if shop.price(wanted) > shop.left / 2:
            return


def _parted(price: Price) -> Parting | None:
    """Where the two finest runs of the reference part by more than the tolerance, None if they do not."""
    if len(price.levels) < 2:
        return None
    one, two = (price.path(row) for row in price.levels[-2:])
    return parting(one, two, price.tolerance)


def _settings(price: Price, shop: Shop) -> None:
    """Run what may be cheaper than the reference, and choose."""
    done = {row.setting for row in price.rows}
    longer = candidates.longer(price.deck, shop.survey, shop.builds)
    _try(price, shop, [one for one in longer if one not in done])
    if tells(price.limits, price.known) and (price.best is None or price.best.setting.step < 1):
        steps = [row.setting.step for row in price.levels]
        finest = price.best.setting.step if price.best else min(steps, default=1.0)
        done = {row.setting for row in price.rows}
        finer = candidates.shorter(price.deck, shop.builds, finest)
        _try(
            price, shop, [one for one in [*finer, *candidates.tighter(price.deck, finer)] if one not in done]
        )


def _try(price: Price, shop: Shop, settings: Iterable[Setting]) -> None:
    rows = [shop.row(one) for one in settings]
    seconds = shop.price(rows)
    many = counted(len(rows), "setting")
    shop.options.tell(f"{many} to run, about {seconds:.3g} s; {shop.left:.3g} s of the budget are left")
    price.rows += rows
    shop.do(rows)
    price.known = judge(price.rows, price.limits, price.tolerance, price.parted is not None)
    if tells(price.limits, price.known):
        price.best = recommended(price.rows, price.margins, price.tolerance)


def _dropped(price: Price) -> list[str]:
    names = [row.setting.name for row in price.rows if row.result is None and not row.why]
    return [f"not run, as they go beyond the budget: {', '.join(names)}"] if names else []
