"""One cycle under the magnifying glass, and what it answers, against the states before and after it."""

from __future__ import annotations

import io
import re
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.debugger_decks import PILE

from udec_ia import Model
from udec_ia.debug.cycle_snapshots import UnreachableEvent
from udec_ia.debug.cycle_trace import CycleTrace
from udec_ia.debug.debugged_run import Debugger
from udec_ia.debug.value_sources import find_sources, match_source
from udec_ia.debug.word_history import (
    RENUMBERED,
    changes,
    explain_birth,
    explain_changes,
    explain_value,
    explain_write,
    explain_write_within,
)
from udec_ia.deck.deck_statements import statements
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table
from udec_ia.reader.place_grammar import find_number, number_of
from udec_ia.reader.word_map import KINDS, Atlas
from udec_ia.running.cycle_replay import Replay


@pytest.fixture(scope="module")
def debugger(tmp_path_factory: pytest.TempPathFactory) -> Debugger:
    """The deck, run to its end."""
    made = Debugger(Model(out=tmp_path_factory.mktemp("debug")), io.StringIO(), lambda told: None)
    made.run(list(statements(PILE.splitlines(), "pile")))
    return made


@pytest.fixture
def trace(debugger: Debugger) -> CycleTrace:
    """Cycle 90."""
    return CycleTrace(debugger.timeline.at(debugger.timeline.event_of(89)), debugger.timeline.laws)


def used(array: Any) -> Any:
    return array.h.ia[: int(array.h.ci[g.MFREE]) - 1]


def test_a_trace_leads_from_one_state_to_the_next(debugger: Debugger, trace: CycleTrace) -> None:
    before, after = (debugger.timeline.at(debugger.timeline.event_of(cycle)) for cycle in (89, 90))
    assert np.array_equal(used(trace.state), used(after))
    trace.go(0)
    assert np.array_equal(used(trace.state), used(before))
    trace.go(len(trace.writes) // 2)
    middle = used(trace.state).copy()
    trace.go(len(trace.writes))
    assert np.array_equal(used(trace.state), used(after))
    trace.go(len(trace.writes) // 2)
    assert np.array_equal(used(trace.state), middle)


def test_within_a_cycle_its_own_writes_come_first(debugger: Debugger, trace: CycleTrace) -> None:
    event = debugger.timeline.event_of(89)
    done = len(trace.writes) // 2
    trace.go(done)
    last = trace.accesses[trace.writes[done - 1]]
    last_place = number_of(Atlas(trace.state.h), last.part, last.at)
    lines = list(explain_write_within(debugger.timeline, event, trace, last_place))
    assert lines
    assert all(line.startswith(f"{last_place.name}: ") for line in lines)
    assert last.place in lines[-1]
    trace.go(0)
    assert list(explain_write_within(debugger.timeline, event, trace, last_place)) == []


def test_passes_and_groups_come_in_their_order(trace: CycleTrace) -> None:
    trace.go(0)
    passes, groups = [], []
    while (one := trace.here()) is not None:
        passes.append(one.work.of)
        trace.go(trace.next_stop("pass", 1))
    assert [name for name in passes if name != "run_cycles"] == ["move_blocks", "accumulate", "ford_all"]
    trace.go(0)
    while (one := trace.here()) is not None and one.work.of == "move_blocks":
        groups.append(one.work.group)
        trace.go(trace.next_stop("group", 1))
    blocks = Atlas(trace.state.h).groups["block"].tolist()
    assert sorted({*groups}) == blocks
    trace.go(len(trace.writes))
    back = 0
    while trace.done > 0:
        trace.go(trace.next_stop("pass", -1))
        back += 1
    assert back == len(passes)


def test_who_wrote_a_word(debugger: Debugger) -> None:
    """The last write has the value, and the line of the file does it."""
    timeline = debugger.timeline
    event = timeline.event_of(90)
    atlas = Atlas(timeline.at(event).h)
    for block in atlas.groups["block"].tolist():
        word = find_number(atlas, f"block@{block}.KYD")
        told = "\n".join(explain_write(timeline, event, word))
        if find_number(atlas, f"block@{block}.KBFIX").value(atlas.h):
            continue
        found = re.search(r"-> (\S+) .* in (\w+) \((\w+\.py):(\d+)\), move_blocks, \w+ of block@(\d+)", told)
        assert found, told
        assert float(found[1]) == word.value(timeline.at(event).h)
        source = next(Path(__file__).parents[2].glob(f"udec_ia/kernels/*/{found[3]}"))
        assert "KYD" in source.read_text().splitlines()[int(found[4]) - 1]
        assert int(found[5]) == block


def test_who_wrote_what_no_cycle_has_written(debugger: Debugger) -> None:
    timeline = debugger.timeline
    atlas = debugger.atlas
    fixed = next(
        ib for ib in atlas.groups["block"].tolist() if find_number(atlas, f"block@{ib}.KBFIX").value(atlas.h)
    )
    assert "FIX 0,4 0,1" in "\n".join(
        explain_write(timeline, timeline.now, find_number(atlas, f"block@{fixed}.KBFIX"))
    )
    assert "PROPERTY" in "\n".join(explain_write(timeline, timeline.now, find_number(atlas, "AKN(1)")))


def test_why_a_force_sum_is_what_it_is(debugger: Debugger) -> None:
    """The contributions add up to the sum, each of a contact of the block; it begins with 0."""
    timeline = debugger.timeline
    event = timeline.event_of(90)
    h = timeline.at(event).h
    atlas, summed = Atlas(h), 0
    for block in atlas.groups["block"].tolist():
        word = find_number(atlas, f"block@{block}.KBFY")
        lines = list(explain_value(timeline, event, word))
        steps = [
            (float(found[1]), float(found[2]), found[3])
            for line in lines
            if (found := re.match(r"(\S+) -> (\S+) \(\S+\) by (.*) in", line))
        ]
        if len(steps) < 2:
            continue
        summed += 1
        assert steps[0][1] == 0
        assert all(a[1] == b[0] for a, b in pairwise(steps))
        assert steps[-1][1] == getr(h, block, g.KBFY)
        assert all(f"block@{block}" in who and "ford_all" in who for _, _, who in steps[1:])
        assert any("contact@" in line and ".KCFN" in line for line in lines)
    assert summed > 2


def test_how_groups_came_to_be(debugger: Debugger) -> None:
    """Against the kinds of the words at every event."""
    timeline = debugger.timeline
    atlases = [Atlas(timeline.at(event).h) for event in range(timeline.now + 1)]
    last = atlases[-1]
    made_in_cycles = 0
    for kind in KINDS:
        for iad in last.groups[kind].tolist()[:6]:
            there = [iad in one.groups[kind] for one in atlases]
            event = max(k for k in range(1, len(there)) if there[k] and not there[k - 1])
            lines = list(explain_birth(timeline, timeline.now, iad))
            span, cycle = timeline.place(event)
            assert lines[0].startswith(f"{kind}@{iad} is made after")
            assert (f"cycle {cycle} of" in lines[0]) == span.runs
            assert span.text in lines[0]
            if span.runs:
                made_in_cycles += 1
                assert re.search(r"by \w+ \(\w+\.py:\d+\)", lines[-1])
    assert made_in_cycles > 0
    with pytest.raises(ValueError, match="is in no group"):
        list(explain_birth(timeline, timeline.now, int(debugger.array.h.ci[g.MFREE]) + 1))


def test_every_number_of_the_memory_has_a_name(debugger: Debugger) -> None:
    atlas = debugger.atlas
    for part in ("ci", "cr", "cd"):
        for index in range(len(getattr(atlas.h, part))):
            one = number_of(atlas, part, index)
            assert find_number(atlas, one.name) == one
    for kind in KINDS:
        for iad in atlas.groups[kind].tolist()[:2]:
            for word in atlas.words(atlas.span(iad)):
                one = find_number(atlas, f"{kind}@{iad}.{word.name}")
                assert one.value(atlas.h) == atlas.value(word)
                assert find_number(atlas, str(word.first)) == one


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("block@1.NOFIELD", "is not a field of a block"),
        ("bricks@1.KX", "is not a kind of group"),
        ("block@3.KX", "no block at 3"),
        ("zone@1.KZG(9)", "no zone at 1"),
        ("NONE", "is not a variable of the common block"),
        ("block@1", "is a whole group"),
        ("0", "addresses 1 to"),
        ("99999999", "addresses 1 to"),
        ("FRAC(2)", "1 element"),
        ("", "names no place"),
    ],
)
def test_names_that_mean_nothing(name: str, says: str, debugger: Debugger) -> None:
    with pytest.raises((ValueError, IndexError), match=says):
        find_number(debugger.atlas, name)


def test_where_groups_got_other_addresses_the_search_is_over(tmp_path: Path) -> None:
    """In a large model, when its first run is prepared."""
    n = 24
    cuts = [line for k in range(1, n) for line in (f"SPLIT -1,{k} {n + 1},{k}", f"SPLIT {k},-1 {k},{n + 1}")]
    outline = f"BLOCK 0,0 0,{n} {n},{n} {n},0"
    deck = ["START", "PROP MAT=1 DENS=2000 KN=1E8 KS=1E8", outline, *cuts, "GRAVITY 0 -10", "CYCLE 3"]
    debugger = Debugger(Model(out=tmp_path), io.StringIO(), lambda told: None)
    debugger.run(list(statements(deck, "wall")))
    timeline, atlas = debugger.timeline, debugger.atlas
    iad = int(atlas.groups["block"][-1])
    assert next(iter(explain_birth(timeline, timeline.now, iad))) == RENUMBERED
    assert (
        next(iter(explain_write(timeline, timeline.now, find_number(atlas, f"block@{iad}.KMAT"))))
        == RENUMBERED
    )
    assert "KYD: " in next(
        iter(explain_write(timeline, timeline.now, find_number(atlas, f"block@{iad}.KYD")))
    )


def test_all_changes_of_a_word(debugger: Debugger) -> None:
    """They are those of the states one after the other."""
    timeline = debugger.timeline
    event = timeline.event_of(130)
    atlas = Atlas(timeline.at(event).h)
    blocks = atlas.groups["block"].tolist()
    for name in (f"block@{blocks[-1]}.KYD", f"block@{blocks[0]}.KBFIX", "TDEL"):
        place = find_number(atlas, name)
        expected, before = [], None
        for now in range(timeline.earliest, event + 1):
            try:
                h = timeline.at(now).h
            except UnreachableEvent:
                continue
            value = place.value(h)
            if value != before or not expected:
                expected.append((now, int(h.ci[g.MCTOT]), float(h.cd[g.TIME]), value))
            before = value
        found = changes(timeline, event, place)
        assert [tuple(one) for one in found] == expected
        lines = list(explain_changes(timeline, place, found))
        assert lines[0].endswith(f"{len(found) - 1} change{'s' * (len(found) != 2)} since")
        assert len([line for line in lines if "->" in line]) == min(len(found) - 1, 12)


def test_what_a_value_depends_on_is_among_its_sources(debugger: Debugger) -> None:
    """Each number that is read is made a little greater: if the value changes, it has a source."""
    timeline = debugger.timeline
    before = timeline.at(timeline.event_of(89))
    trace, atlas = CycleTrace(before.copy(), timeline.laws), Atlas(before.h)
    contacts = table(before, "contact")
    contact = int(contacts["address"][contacts["KCFN"].argmax()])
    moving = int(table(before, "block")["address"][0])
    for name in (f"block@{moving}.KYD", f"contact@{contact}.KCFN"):
        place = find_number(atlas, name)
        number = trace.writes_to(before.h, place.part, place.at)[-1]
        known = find_sources(trace.accesses[number].calls)
        matters, counted = 0, 0
        for one in trace.origins(number):
            source = match_source(one.calls, trace.accesses[number].calls, known)
            origin = number_of(atlas, one.part, one.at)
            if one.part not in ("ra", "cr") or origin.name == name or not one.after:
                continue
            other = before.copy()
            getattr(other.h, one.part)[one.at] *= 1 + 1e-4
            with suppress(UdecError):
                Replay(other, timeline.laws).step()
            changed = place.value(other.h) != trace.accesses[number].after
            written = any(two.written and two[1:3] == one[1:3] for two in trace.accesses[:number])
            assert source is not None or not changed or written, origin.name
            matters, counted = matters + changed, counted + (source is not None)
        assert matters > 2
        assert counted > 2


def test_the_nearest_statement_comes_first(debugger: Debugger) -> None:
    timeline = debugger.timeline
    event = timeline.event_of(90)
    atlas = Atlas(timeline.at(event).h)
    block = int(atlas.groups["block"][-1])
    lines = list(explain_value(timeline, event, find_number(atlas, f"block@{block}.KYD")))
    assert re.search(r"putr\(h, ib, g.KYD, \w+\)  \(motion.py:\d+\)", lines[2])
    place = next(line for line in lines[3:] if line.endswith(")"))
    file, number = re.search(r"\((\w+.py):(\d+)\)", place).groups()  # type: ignore[union-attr]
    source = next(Path(__file__).parents[2].glob(f"udec_ia/kernels/*/{file}")).read_text()
    assert place.strip().startswith(source.splitlines()[int(number) - 1].strip())
    below = lines[lines.index(place) + 1 :]
    assert below[0].startswith(f"    block@{block}.")
    assert any("GRAVY" in line for line in below)
