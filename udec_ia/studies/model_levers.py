"""Levers of the model: rounding length, size of zones, joint stiffness, types of blocks.

Another value is another model, so its only reference is its own refinement. Where three values converge, the
table shows how far the deck is from what they tend to. Types of blocks are compared with those of the deck.
Time-steps follow from the model: a run of one cycle for each CYCLE measures them, and CYCLEs get the cycles
of the same time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from udec_ia.layout.offsets import VIRTUAL
from udec_ia.studies.extrapolation import Extrapolation, extrapolate
from udec_ia.studies.setting_runner import SettingRunner
from udec_ia.studies.settings import Numbers, Setting, cycles_for
from udec_ia.studies.study_run import ENDED, RunResult
from udec_ia.studies.survey_run import Segment


class Lever(NamedTuple):
    """values: of `part` of a setting, that of the deck first. commands, words: what it changes in it."""

    part: str
    values: tuple[Any, ...]
    commands: tuple[str, ...]
    words: tuple[str, ...]


LEVERS = {
    "round": Lever("rounding", (1.0, 0.5, 0.25), ("round",), ()),
    "zones": Lever("edge", (1.0, 0.5, 0.25), ("generate",), ("edge",)),
    "stiffness": Lever("stiffness", (1.0, 2.0, 4.0), ("property", "jproperty"), ("kn", "ks")),
    "types": Lever("types", ("", "rigid", "sdef"), ("property",), ("bulk", "g")),
}
ALL, CLOSED = "all contacts", "closed contacts"
CONTACTS = (f"{ALL} = count contact where KCCOD != {VIRTUAL}", f"{CLOSED} = count contact where KCFN > 0")
COLUMNS = ("lever", "times", "quantity", "value", "off its limit", "contacts", "closed", "seconds", "what")


def vary_lever(runner: SettingRunner, lever: str) -> tuple[list[str], list[tuple[object, ...]]]:
    """Notes, and a line for each value of a lever and each quantity. runner: it has run its own deck."""
    part, values, commands, words = LEVERS[lever]
    calls = runner.deck.calls(*commands)
    if not any(not words or any(call.named.get(word) for word in words) for call in calls):
        why = "the deck has no line that this lever changes"
        return [], [(lever, math.nan, "", *(math.nan,) * 5, why)]
    notes = list[str]()
    own = [Setting(runner.wide, **{part: value}) for value in values]
    if lever == "zones":
        own, notes = _keep_stiffness(own, [result.quantities[ALL] for result in _rehearse(runner, own)])
    _rehearse(runner, own)
    numbers = [_same_time(runner.survey, runner.segments(f"rehearsal,{one.name}")) for one in own]
    asked = (*runner.options.quantities, *CONTACTS)
    runs = [
        runner.run(one, put, quantities=asked, name=f"model,{one.name}")
        for one, put in zip(own, numbers, strict=True)
    ]
    results = runner.results(runs)
    names = [*results[0].quantities][: -len(CONTACTS)]
    return notes, [row for name in names for row in _rows(lever, own, results, name)]


def _rehearse(runner: SettingRunner, settings: Sequence[Setting]) -> list[RunResult]:
    """Runs with one cycle for each CYCLE and SOLVE."""
    runs = [
        runner.run(one, name=f"rehearsal,{one.name}", quantities=CONTACTS, rehearsal=True) for one in settings
    ]
    return runner.results(runs)


def _keep_stiffness(own: Sequence[Setting], counts: Sequence[float]) -> tuple[list[Setting], list[str]]:
    """The same with KN, KS and the cohesions divided by the growth of the number of contacts; and a note."""
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
    found = Extrapolation(values[0], 0.0) if lever == "types" else extrapolate(values)
    is_known = usable[0] if lever == "types" else all(usable)
    greatest = max(map(abs, values))
    rows: list[tuple[object, ...]] = []
    for k, (setting, result, value) in enumerate(zip(own, results, values, strict=True)):
        off, what = math.nan, "no limit"
        if not usable[k]:
            what = result.message or result.status
        elif is_known and lever == "types":
            off, what = found.error_of(value), f"{setting.types} beside the deck" if k else "as it is"
        elif is_known and found.is_zero:
            off = abs(value - found.value) / greatest
            what = f"tends to 0, known to within {found.error:.1e}: shares of the greatest value"
        elif is_known and math.isfinite(found.value):
            order = f"order {found.order:.2f}" if math.isfinite(found.order) else "no order"
            off, what = found.error_of(value), f"limit known to within {found.share:.1e}, {order}"
        contacts = [result.quantities[one] for one in (ALL, CLOSED)]
        times = getattr(setting, LEVERS[lever].part)
        rows.append((lever, times, name, value, off, *contacts, result.seconds, what))
    return rows
