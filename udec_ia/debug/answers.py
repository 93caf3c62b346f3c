"""Who wrote this word, how did this group come to be, why does this field hold this value.

The last event at which something changed is looked for backwards, from copy to copy (timeline.py). If it is a
cycle, that is run once more, observed (tracing.py), and what it did is told with routine and line.
"""

from __future__ import annotations

from collections.abc import Iterator

from udec_ia.debug.probes import Born, Changed, Probe, shown
from udec_ia.debug.timeline import Timeline
from udec_ia.debug.tracing import Access, Trace
from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.reader.atlas import KINDS, Atlas, called
from udec_ia.reader.places import Place, number_of

MANY = 12  # origins of a value that are told
RENUMBERED = "all groups got other addresses here, in the order of the map: what was here before is another"


def last_hit(timeline: Timeline, event: int, probe: Probe, before: bool = False) -> tuple[int, str]:
    """The last event at which `probe` says that something has happened, and what; 0 and "" if there is none.

    Up to `event`, or only before it. Where all groups have got other addresses, the search is over.
    """
    found = 0, ""
    for a, b in timeline.backwards(event):
        first = timeline.at(a)
        head = int(first.h.ci[g.IBPNT])
        probe.begin(first)
        for now, array in timeline.through(a, b):
            what = probe.hit(array)
            if head != (head := int(array.h.ci[g.IBPNT])) and _prepares(timeline, now):
                what = RENUMBERED
            if what and not (before and now >= event):
                found = now, what
        if found[0]:
            return found
    return found


def where(timeline: Timeline, event: int) -> str:
    """An event in words."""
    stretch, cycle = timeline.place(event)
    if stretch is None:
        return "at the beginning"
    place = f"line {stretch.line}: {stretch.text}"
    if not stretch.runs:
        return f"after {place}"
    if event == stretch.first + 1:
        return f"prepared, before cycle {cycle + 1} of {place}"
    return f"after cycle {cycle} of {place}"


def _prepares(timeline: Timeline, event: int) -> bool:
    """True if the event is what prepares a run, which in a large model puts groups where they will stay."""
    stretch, _ = timeline.place(event)
    return stretch is not None and stretch.runs and event == stretch.first + 1


def in_cycle(timeline: Timeline, event: int) -> bool:
    """True if the event is a cycle, and not a command or what prepares a run."""
    stretch, _ = timeline.place(event)
    return stretch is not None and stretch.runs and event > stretch.first + 1


def wrote(timeline: Timeline, event: int, place: Place) -> Iterator[str]:
    """Lines on who has given a number the value that it has."""
    now, what = last_hit(timeline, event, Changed(place))
    if not what:
        yield f"{place.name} has been {shown(place.value(timeline.at(event).h))} since the {_first(timeline)}"
        return
    yield what
    yield where(timeline, now)
    if in_cycle(timeline, now):
        trace = Trace(timeline.at(now - 1), timeline.laws)
        for k in trace.writes_to(trace.state.h, place.part, place.at):
            one = trace.accesses[k]
            yield f"  {_written(one)} in {one.place}, {work_of(timeline, now, one)}"


def wrote_within(timeline: Timeline, event: int, trace: Trace, place: Place) -> Iterator[str]:
    """Lines on who has given a number its value in the cycle after `event`, up to where `trace` stands."""
    done = trace.writes[: trace.done]
    last = done[-1] if done else -1
    for k in trace.writes_to(trace.state.h, place.part, place.at):
        if k <= last:
            one = trace.accesses[k]
            work = work_of(timeline, event + 1, one)
            yield f"{place.name}: {_written(one)} in {one.place}, {work}, within this cycle"


def born(timeline: Timeline, event: int, address: int) -> Iterator[str]:
    """Lines on how the group at an address came to be, and what stood there before."""
    atlas = Atlas(timeline.at(event).h)
    span = atlas.span(address)
    if span.kind not in KINDS:
        raise ValueError(f"{address} is in no group, but in {called(atlas, span)}")
    now, what = last_hit(timeline, event, Born(span.kind, span.first))
    if not what:
        yield f"{span.name} has been there since the {_first(timeline)}"
        return
    if what == RENUMBERED:
        yield from (what, where(timeline, now))
        return
    yield f"{what} {where(timeline, now)}"
    before = Atlas(timeline.at(now - 1).h)
    if span.first < before.free:
        yield f"before that, word {span.first} was in {called(before, before.span(span.first))}"
    else:
        yield f"before that, word {span.first} had not been used"
    if in_cycle(timeline, now):
        trace = Trace(timeline.at(now - 1), timeline.laws)
        for k in trace.writes_to(trace.state.h, "ia", span.first - 1)[-1:]:
            one = trace.accesses[k]
            yield f"  by {one.place}, {work_of(timeline, now, one)}"


def why(timeline: Timeline, event: int, place: Place) -> Iterator[str]:
    """Lines on the writes that have led to a value, each with the numbers that it was made from."""
    now, what = last_hit(timeline, event, Changed(place))
    if not what or not in_cycle(timeline, now):
        yield from wrote(timeline, event, place)
        return
    before = timeline.at(now - 1)
    h, trace = before.copy().h, Trace(before, timeline.laws)
    yield f"{what}, {where(timeline, now)}"
    for k in trace.writes_to(h, place.part, place.at):
        one = trace.accesses[k]
        yield f"{_written(one)} by {work_of(timeline, now, one)} in {one.place}, from"
        yield from _origins(h, trace, k, place)


def _origins(h: Memory, trace: Trace, number: int, place: Place) -> Iterator[str]:
    """The reals that a write was made from, those of the group at work first."""
    atlas = Atlas(h)
    own: list[str] = []
    others: list[str] = []
    for one in trace.origins(number):
        source = number_of(atlas, one.part, one.at)
        if one.part == "ia" or source.name == place.name:
            continue
        unit = f" {source.unit}" if source.unit else ""
        mine = source.name.partition(".")[0].endswith(f"@{one.work.group}")
        (own if mine else others).append(f"    {source.name} = {shown(one.after.item())}{unit}")
    told = own + others
    yield from told[:MANY]
    if len(told) > MANY:
        yield f"    and {len(told) - MANY} more"


def _written(one: Access) -> str:
    before, after = one.before.item(), one.after.item()
    if before == after:
        return f"{shown(after)} again"
    if isinstance(after, float):
        return f"{shown(before)} -> {shown(after)} ({after - before:+.6g})"
    return f"{shown(before)} -> {shown(after)}"


def work_of(timeline: Timeline, event: int, one: Access) -> str:
    """The pass and the group at work."""
    work = one.work
    if work.group == 0:
        return work.of
    atlas = Atlas(timeline.at(event - 1).h)
    known = 1 <= work.group < atlas.free and atlas.span(work.group).first == work.group
    name = called(atlas, atlas.span(work.group)) if known else str(work.group)
    return f"{work.of}, {work.routine} of {name}"


def _first(timeline: Timeline) -> str:
    return "beginning" if timeline.earliest == 0 else f"event {timeline.earliest}, the first that is known"
