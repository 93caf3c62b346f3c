"""Levers of the model: rounding length, size of zones, joint stiffness, types of blocks.

Another value is another model, so there is no reference for it but its own refinement: half and a quarter
of the rounding length and of the zones' edge, twice and four times the stiffness. Where the three converge,
the table says how far the deck is from the limit; else how far numbers scatter. Types of blocks have no
limit: they are set side by side. Time-steps follow from the model; a rehearsal of a few cycles tells them,
and CYCLEs get as many cycles as make the time of the deck. Smaller zones have more contacts on their joints,
each of which has KN and KS; they are made softer as well, so that the joints stay what they are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from udec_ia.layout.offsets import VIRTUAL
from udec_ia.study.runs import ENDED, Result
from udec_ia.trade.deck import Deck
from udec_ia.trade.levers import Numbers, Setting
from udec_ia.trade.limit import limit, share
from udec_ia.trade.shop import Shop
from udec_ia.trade.steps import cycles_for
from udec_ia.trade.surveyed import Segment

FACTORS = {"round": (1.0, 0.5, 0.25), "zones": (1.0, 0.5, 0.25), "stiffness": (1.0, 2.0, 4.0)}
PARTS = {"round": "rounding", "zones": "edge", "stiffness": "stiffness"}
TYPES = ("", "rigid", "sdef")
LEVERS = (*FACTORS, "types")
ALL, CLOSED = "all contacts", "closed contacts"
CONTACTS = (f"{ALL} = count contact where KCCOD != {VIRTUAL}", f"{CLOSED} = count contact where KCFN > 0")
COLUMNS = ("lever", "times", "quantity", "value", "off its limit", "contacts", "closed", "seconds", "what")
A_FEW = 1e-9  # seconds after which a rehearsal ends each CYCLE, so with its second look


def applies(deck: Deck, lever: str) -> bool:
    """True if the deck has the lines that the lever changes."""
    if lever == "round":
        return deck.has("round")
    if lever == "zones":
        return deck.has_edges()
    return deck.has_moduli() if lever == "types" else deck.has("property")


def settings(lever: str, own: Setting) -> list[Setting]:
    """The values of a lever, that of the deck first."""
    if lever == "types":
        return [replace(own, types=types) for types in TYPES]
    return [replace(own, **{PARTS[lever]: factor}) for factor in FACTORS[lever]]  # type: ignore[arg-type]


def refine(shop: Shop, lever: str) -> tuple[list[str], list[tuple[object, ...]]]:
    """What there is to say, and a line for each value and quantity. Shop: with its survey."""
    if not applies(shop.deck, lever):
        blank = (math.nan,) * 3
        why = "the deck has no line that this lever changes"
        return [], [(lever, math.nan, "", *blank, math.nan, math.nan, why)]
    own, said = settings(lever, Setting(shop.wide)), list[str]()
    if lever == "zones":
        own, said = keep_stiffness(shop, own)
    steps = [shop.rehearsal(one, A_FEW, CONTACTS)[1] for one in own]
    numbers = [_numbers(shop.survey, found) for found in steps]
    results = shop.results(
        [shop.run(one, put, f"model,{one.name}", CONTACTS) for one, put in zip(own, numbers, strict=True)]
    )
    names = [*results[0].quantities][1 : -len(CONTACTS)]
    return said, [row for name in names for row in _rows(lever, own, results, name)]


def keep_stiffness(shop: Shop, own: Sequence[Setting]) -> tuple[list[Setting], list[str]]:
    """The same with KN, KS and the cohesions divided by what the number of contacts grows by; and that said.

    There is a contact at each grid-point of an edge, and these are properties of one contact.
    """
    counts = [shop.rehearsal(one, A_FEW, CONTACTS)[0].quantities[ALL] for one in own]
    if not all(count > 0 for count in counts):  # one of them has failed, and its line will tell
        return [*own], []
    found = [
        replace(one, contact=float(f"{counts[0] / count:.4g}"))
        for one, count in zip(own, counts, strict=True)
    ]
    times = "; ".join(
        f"EDGE times {one.edge:g} has {count:.0f} contacts, and KN, KS and COHESION times {one.contact:g}"
        for one, count in zip(found, counts, strict=True)
    )
    return found, [
        "zones: a joint has a contact at each grid-point, and would be the stiffer the more there are "
        f"(docs/deformable.md); so that joints stay as they are in the mean, {times}"
    ]


def _numbers(survey: Sequence[Segment], rehearsed: Sequence[Segment]) -> Numbers:
    """CYCLEs for the time of the deck, with the time-steps of a rehearsal."""
    steps = [one.step for one in [*rehearsed, *survey[len(rehearsed) :]]]  # those of the deck if it failed
    longer = tuple(one.step / step for one, step in zip(survey, steps, strict=True))
    return Numbers(1.0, cycles_for(survey, steps)[0], longer)


def _rows(
    lever: str, own: Sequence[Setting], results: Sequence[Result], name: str
) -> list[tuple[object, ...]]:
    values = [one.quantities[name] for one in results]
    found = None if lever == "types" else limit(values)
    rows: list[tuple[object, ...]] = []
    for setting, result, value in zip(own, results, values, strict=True):
        factor = math.nan if lever == "types" else getattr(setting, PARTS[lever])
        off = found.error_of(value) if found else share(abs(value - values[0]), values[0])
        contacts = [result.quantities[one] for one in (ALL, CLOSED)]
        what = result.message if result.status != ENDED else ""
        what = what or (setting.types or "as it is" if lever == "types" else "")
        if found and not what:
            order = f"order {found.order:.2f}" if math.isfinite(found.order) else "no order"
            what = f"limit known to within {found.share:.1e}, {order}"
        rows.append((lever, factor, name, value, off, *contacts, result.seconds, what))
    return rows
