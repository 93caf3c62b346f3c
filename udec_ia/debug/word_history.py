"""History of a word: who wrote it, from what its value was computed, and how its group was created.

The last event at which something changed is searched backwards, from copy to copy (cycle_snapshots.py). If it
is a cycle, it is repeated and observed (cycle_trace.py). The answer names the routine and the line. All
changes of a word over the run are found in the same way.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby, pairwise
from time import perf_counter
from typing import NamedTuple

from udec_ia.debug.cycle_snapshots import Timeline
from udec_ia.debug.cycle_trace import Access, CycleTrace
from udec_ia.debug.stop_conditions import GroupBirth, StopCondition, WordChange, format_number
from udec_ia.debug.value_sources import Source, find_sources, match_source
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.printable_text import counted
from udec_ia.reader.place_grammar import Place, number_of
from udec_ia.reader.word_map import KINDS, Atlas, called

MANY = 12  # origins of a value, and changes of a word, that are shown
SECONDS = 3.0  # after which no more cycles are observed to name who has written
RENUMBERED = "all groups were renumbered here; an earlier word at this address belongs to another group"


def find_last_hit(
    timeline: Timeline, event: int, condition: StopCondition, before: bool = False
) -> tuple[int, str]:
    """The last event at which `condition` reports something, and what; 0 and "" if there is none.

    Up to `event`, or only before it. Where all groups got other addresses, the search ends.
    """
    found = 0, ""
    for a, b in timeline.backwards(event):
        for now, what, _ in _hits(timeline, a, b, condition):
            if not (before and now >= event):
                found = now, what
        if found[0]:
            return found
    return found


def _hits(
    timeline: Timeline, a: int, b: int, condition: StopCondition
) -> Iterator[tuple[int, str, MainArray]]:
    """The events after `a` and up to `b` at which `condition` reports something: what, and the state then."""
    first = timeline.at(a)
    head = int(first.h.ci[g.IBPNT])
    condition.begin(first)
    for now, array in timeline.through(a, b):
        what = condition.hit(array)
        if head != (head := int(array.h.ci[g.IBPNT])) and _prepares(timeline, now):
            what = RENUMBERED
        if what:
            yield now, what, array


class Change(NamedTuple):
    """An event at which a number has changed. cycle, time: of the model then, in s; value: from then on."""

    event: int
    cycle: int
    time: float
    value: int | float | None


def changes(timeline: Timeline, event: int, place: Place) -> list[Change]:
    """All changes of a number up to `event`, the first one first, since all groups got their addresses.

    Before them stands the number at the first event that was searched.
    """
    found: list[Change] = []
    for a, b in timeline.backwards(event):
        here, renumbered = list[Change](), False
        for now, what, array in _hits(timeline, a, b, WordChange(place)):
            if what == RENUMBERED:
                here, renumbered = [], True
            here.append(_change(now, array, place))
        found = here + found
        if renumbered:
            return found
    begin = timeline.earliest
    return [_change(begin, timeline.at(begin), place), *found]


def _change(event: int, array: MainArray, place: Place) -> Change:
    h = array.h
    return Change(event, int(h.ci[g.MCTOT]), float(h.cd[g.TIME]), place.value(h))


def explain_changes(timeline: Timeline, place: Place, found: list[Change]) -> Iterator[str]:
    """Lines on the changes of a number, the last ones with the routines and lines that have written it."""
    first, many = found[0], len(found) - 1
    begin = f"{_with_unit(first.value, place)}, {describe_event(timeline, first.event)}"
    yield f"{place.name}: {begin}, and {counted(many, 'change')} since"
    if many > MANY:
        yield f"the last {MANY}:"
    last, start = list[list[str]](), perf_counter()
    for before, one in [*pairwise(found)][: -MANY - 1 : -1]:  # the last one first, while there is time
        change = f"{format_number(before.value)} -> {_with_unit(one.value, place)}"
        if not is_cycle(timeline, one.event):
            last.append([f"  {describe_event(timeline, one.event)}: {change}"])
            continue
        last.append([f"  cycle {one.cycle}: {change}"])
        if perf_counter() - start < SECONDS:
            last[-1] += _writes(timeline, one.event, place)
    for lines in last[::-1]:
        yield from lines


def _writes(timeline: Timeline, event: int, place: Place) -> Iterator[str]:
    """Lines on all writes of a number in a cycle: the value, and what has written it."""
    trace = CycleTrace(timeline.at(event - 1), timeline.laws)
    for k in trace.writes_to(trace.state.h, place.part, place.at):
        one = trace.accesses[k]
        yield f"    {format_number(one.after.item())} in {one.place}, {describe_call(timeline, event, one)}"


def _with_unit(value: int | float | None, place: Place) -> str:
    return f"{format_number(value)} {place.unit if value is not None else ''}".rstrip()


def describe_event(timeline: Timeline, event: int) -> str:
    """The command and the cycle of an event, as text."""
    span, cycle = timeline.place(event)
    if span is None:
        return "at the beginning"
    place = f"line {span.line}: {span.text}"
    if not span.runs:
        return f"after {place}"
    if event == span.first + 1:
        return f"prepared, before cycle {cycle + 1} of {place}"
    return f"after cycle {cycle} of {place}"


def _prepares(timeline: Timeline, event: int) -> bool:
    """True if the event prepares a run. In a large model this moves groups to their final addresses."""
    span, _ = timeline.place(event)
    return span is not None and span.runs and event == span.first + 1


def is_cycle(timeline: Timeline, event: int) -> bool:
    """True if the event is a cycle, and not a command or what prepares a run."""
    span, _ = timeline.place(event)
    return span is not None and span.runs and event > span.first + 1


def explain_write(timeline: Timeline, event: int, place: Place) -> Iterator[str]:
    """Lines on the cycle, pass, routine and line that gave a number its present value."""
    now, what = find_last_hit(timeline, event, WordChange(place))
    if not what:
        value = format_number(place.value(timeline.at(event).h))
        yield f"{place.name} has been {value} since the {_first(timeline)}"
        return
    yield what
    yield describe_event(timeline, now)
    if is_cycle(timeline, now):
        trace = CycleTrace(timeline.at(now - 1), timeline.laws)
        for k in trace.writes_to(trace.state.h, place.part, place.at):
            one = trace.accesses[k]
            yield f"  {_written(one)} in {one.place}, {describe_call(timeline, now, one)}"


def explain_write_within(timeline: Timeline, event: int, trace: CycleTrace, place: Place) -> Iterator[str]:
    """Lines on the writes of a number in the cycle after `event`, up to the present write of `trace`."""
    done = trace.writes[: trace.done]
    last = done[-1] if done else -1
    for k in trace.writes_to(trace.state.h, place.part, place.at):
        if k <= last:
            one = trace.accesses[k]
            work = describe_call(timeline, event + 1, one)
            yield f"{place.name}: {_written(one)} in {one.place}, {work}, within this cycle"


def explain_birth(timeline: Timeline, event: int, address: int) -> Iterator[str]:
    """Lines on how the group at an address was created, and what was there before."""
    atlas = Atlas(timeline.at(event).h)
    span = atlas.span(address)
    if span.kind not in KINDS:
        raise ValueError(f"{address} is in no group, but in {called(atlas, span)}")
    now, what = find_last_hit(timeline, event, GroupBirth(span.kind, span.first))
    if not what:
        yield f"{span.name} has been there since the {_first(timeline)}"
        return
    if what == RENUMBERED:
        yield from (what, describe_event(timeline, now))
        return
    yield f"{what} {describe_event(timeline, now)}"
    before = Atlas(timeline.at(now - 1).h)
    if span.first < before.free:
        yield f"before that, word {span.first} was in {called(before, before.span(span.first))}"
    else:
        yield f"before that, word {span.first} had not been used"
    if is_cycle(timeline, now):
        trace = CycleTrace(timeline.at(now - 1), timeline.laws)
        for k in trace.writes_to(trace.state.h, "ia", span.first - 1)[-1:]:
            one = trace.accesses[k]
            yield f"  by {one.place}, {describe_call(timeline, now, one)}"


def explain_value(timeline: Timeline, event: int, place: Place) -> Iterator[str]:
    """Lines on the writes that gave a value, each with the numbers that it was computed from."""
    now, what = find_last_hit(timeline, event, WordChange(place))
    if not what or not is_cycle(timeline, now):
        yield from explain_write(timeline, event, place)
        return
    before = timeline.at(now - 1)
    h, trace = before.copy().h, CycleTrace(before, timeline.laws)
    yield f"{what}, {describe_event(timeline, now)}"
    for k in trace.writes_to(h, place.part, place.at):
        one = trace.accesses[k]
        yield f"{_written(one)} by {describe_call(timeline, now, one)} in {one.place}, from"
        yield from _origins(h, trace, k, place)


def _origins(h: Memory, trace: CycleTrace, number: int, place: Place) -> Iterator[str]:
    """The numbers that a write was computed from, under the statements that have read them.

    The nearest statement comes first, and under it the group at work; then what else has been read.
    """
    atlas, written = Atlas(h), trace.accesses[number].calls
    known = find_sources(written)
    found: list[tuple[tuple[int, ...], Source | None, str]] = []
    for k, one in enumerate(trace.origins(number)):
        origin = number_of(atlas, one.part, one.at)
        if one.part == "ia" or origin.name == place.name:
            continue
        source = match_source(one.calls, written, known)
        unit = f" {origin.unit}" if origin.unit else ""
        own = origin.name.partition(".")[0].endswith(f"@{one.work.group}")
        order = (0, source.steps, source.line) if source else (1,)
        found.append(
            ((*order, not own, k), source, f"{origin.name} = {format_number(one.after.item())}{unit}")
        )
    shown = sorted(found, key=lambda one: one[0])[:MANY]
    first = known.get(written[-1])
    if first and not any(source == first for _, source, _ in shown):
        yield _statement(first)
    for source, rows in groupby(shown, key=lambda one: one[1]):
        yield _statement(source) if source else "  also read by these routines"
        yield from (f"    {text}" for _, _, text in rows)
    if len(found) > MANY:
        yield f"    and {len(found) - MANY} more"


def _statement(source: Source) -> str:
    return f"  {source.text}  ({source.place})"


def _written(one: Access) -> str:
    before, after = one.before.item(), one.after.item()
    if before == after:
        return f"{format_number(after)} again"
    if isinstance(after, float):
        return f"{format_number(before)} -> {format_number(after)} ({after - before:+.6g})"
    return f"{format_number(before)} -> {format_number(after)}"


def describe_call(timeline: Timeline, event: int, one: Access) -> str:
    """The pass and the group at work, as text."""
    work = one.work
    if work.group == 0:
        return work.of
    atlas = Atlas(timeline.at(event - 1).h)
    known = 1 <= work.group < atlas.free and atlas.span(work.group).first == work.group
    name = called(atlas, atlas.span(work.group)) if known else str(work.group)
    return f"{work.of}, {work.routine} of {name}"


def _first(timeline: Timeline) -> str:
    return "beginning" if timeline.earliest == 0 else f"event {timeline.earliest}, the first that is known"
