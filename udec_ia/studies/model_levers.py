"""Levers of the model: rounding length, size of zones, joint stiffness.

Another value is another model, so its only reference is its own refinement: half and a quarter of the
rounding length and of the zones' edge, twice and four times the stiffness. Where the three converge, the
table shows how far the deck is from what they tend to. Time-steps
follow from the model: a run of one cycle for each CYCLE measures them, and CYCLEs get the cycles of the same
time. Smaller zones have more contacts on their joints, each with KN and KS; these are reduced by as much, so
that the joints stay as stiff as they are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from udec_ia.layout.offsets import VIRTUAL
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.extrapolation import extrapolate
from udec_ia.studies.setting_runner import SettingRunner
from udec_ia.studies.settings import Numbers, Setting, cycles_for
from udec_ia.studies.study_run import ENDED, RunResult
from udec_ia.studies.survey_run import Segment

FACTORS = {"round": (1.0, 0.5, 0.25), "zones": (1.0, 0.5, 0.25), "stiffness": (1.0, 2.0, 4.0)}
PARTS = {"round": "rounding", "zones": "edge", "stiffness": "stiffness"}
ALL, CLOSED = "all contacts", "closed contacts"
CONTACTS = (f"{ALL} = count contact where KCCOD != {VIRTUAL}", f"{CLOSED} = count contact where KCFN > 0")
COLUMNS = ("lever", "times", "quantity", "value", "off its limit", "contacts", "closed", "seconds", "what")


def vary_lever(runner: SettingRunner, lever: str) -> tuple[list[str], list[tuple[object, ...]]]:
    """Notes, and a line for each value of a lever and each quantity. runner: it has run its own deck."""
    if not _applies(runner.deck, lever):
        why = "the deck has no line that this lever changes"
        return [], [(lever, math.nan, "", *(math.nan,) * 5, why)]
    notes = list[str]()
    own = [Setting(runner.wide, **{PARTS[lever]: factor}) for factor in FACTORS[lever]]  # type: ignore[arg-type]
    if lever == "zones":
        own, notes = _keep_stiffness(own, [result.quantities[ALL] for result in _rehearse(runner, own)])
    _rehearse(runner, own)
    numbers = [_same_time(runner.survey, runner.segments(f"rehearsal,{one.name}")) for one in own]
    results = runner.results(
        [
            runner.run(one, put, CONTACTS, name=f"model,{one.name}")
            for one, put in zip(own, numbers, strict=True)
        ]
    )
    names = [*results[0].quantities][1 : -len(CONTACTS)]
    return notes, [row for name in names for row in _rows(lever, own, results, name)]


def _rehearse(runner: SettingRunner, settings: Sequence[Setting]) -> list[RunResult]:
    """Runs with one cycle for each CYCLE and SOLVE."""
    runs = [runner.run(one, None, CONTACTS, name=f"rehearsal,{one.name}", rehearsal=True) for one in settings]
    return runner.results(runs)


def _applies(deck: Deck, lever: str) -> bool:
    """True if the deck has the lines that the lever changes."""
    if lever == "round":
        return deck.has("round")
    if lever == "zones":
        return any(call.named.get("edge") is not None for call in deck.calls("generate"))
    return deck.has("property")


def _keep_stiffness(own: Sequence[Setting], counts: Sequence[float]) -> tuple[list[Setting], list[str]]:
    """The same with KN, KS and the cohesions divided by the growth of the number of contacts; and a note.

    There is a contact at each grid-point of an edge, and these are properties of one contact.
    """
    if not all(count > 0 for count in counts):  # one of them has failed, as its line shows
        return [*own], []
    found = [
        replace(one, contact=float(f"{counts[0] / count:.4g}"))
        for one, count in zip(own, counts, strict=True)
    ]
    times = "; ".join(
        f"EDGE times {one.edge:g} has {count:.0f} contacts, and KN, KS and COHESION times {one.contact:g}"
        for one, count in zip(found, counts, strict=True)
    )
    return found, [f"zones: joints stay as stiff as they are in the mean: {times}"]


def _same_time(survey: Sequence[Segment], rehearsed: Sequence[Segment]) -> Numbers:
    """CYCLEs for the time of the deck, with the time-steps of a rehearsal."""
    steps = [one.step for one in [*rehearsed, *survey[len(rehearsed) :]]]  # those of the deck if it failed
    longer = tuple(one.step / step for one, step in zip(survey, steps, strict=True))
    return Numbers(1.0, cycles_for(survey, steps)[0], longer)


def _rows(
    lever: str, own: Sequence[Setting], results: Sequence[RunResult], name: str
) -> list[tuple[object, ...]]:
    """The lines of one quantity. A run that did not come to rest counts for nothing."""
    usable = [one.status == ENDED and one.at_rest for one in results]
    values = [one.quantities[name] for one in results]
    found = extrapolate(values) if all(usable) else None
    greatest = max(map(abs, values))
    rows: list[tuple[object, ...]] = []
    for k, (setting, result, value) in enumerate(zip(own, results, values, strict=True)):
        off, what = math.nan, "no limit"
        if not usable[k]:
            what = result.message or result.status
        elif found and found.is_zero:
            off = abs(value - found.value) / greatest
            what = f"tends to 0, known to within {found.error:.1e}: shares of the greatest value"
        elif found:
            order = f"order {found.order:.2f}" if math.isfinite(found.order) else "no order"
            off, what = found.error_of(value), f"limit known to within {found.share:.1e}, {order}"
        contacts = [result.quantities[one] for one in (ALL, CLOSED)]
        rows.append(
            (lever, getattr(setting, PARTS[lever]), name, value, off, *contacts, result.seconds, what)
        )
    return rows
