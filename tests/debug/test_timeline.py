"""Going back: every event of a run, and the last change of any word, against a run that kept all states."""

from __future__ import annotations

import io
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.debugger_decks import PILE

from udec_ia import Model
from udec_ia.debug.cycle_snapshots import UnreachableEvent
from udec_ia.debug.debugged_run import Debugger, LeaveDebugger, ResumeRun
from udec_ia.debug.stop_conditions import ContactChange, GroupCondition, WordChange
from udec_ia.debug.word_history import find_last_hit
from udec_ia.deck.deck_statements import statements
from udec_ia.heap.accessors import iget
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import addresses
from udec_ia.reader.place_grammar import find_number
from udec_ia.reader.word_map import KINDS, TABLE, Atlas

KEPT_CYCLES = 460


def every_state(build: str, out: Path) -> list[tuple[int, Any, Any]]:
    """Cycles, IA() and time after each command and each cycle of the deck, without the debugger."""
    m, found = Model(build, out=out), []
    for line in PILE.splitlines()[:-1]:
        word, *numbers = line.split()
        for _ in range(int(numbers[0]) if word == "CYCLE" else 1):
            m.run("CYCLE 1\n" if word == "CYCLE" else line + "\n")
            h = m.array.h
            found.append((int(h.ci[g.MCTOT]), h.ia[: int(h.ci[g.MFREE]) - 1].copy(), float(h.cd[g.TIME])))
    return found


def debugged(build: str, out: Path, **options: Any) -> Debugger:
    """The deck, run to its end under a debugger that nobody talks to."""
    debugger = Debugger(Model(build, out=out), io.StringIO(), lambda told: None, **options)
    debugger.run(list(statements(PILE.splitlines(), "pile")))
    return debugger


@pytest.fixture(scope="module", params=["i32r64", "i16r32"])
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The states of every cycle, and the debugger."""
    out = tmp_path_factory.mktemp("debug")
    return every_state(request.param, out), debugged(request.param, out)


def test_every_event_can_be_gone_back_to(both: Any) -> None:
    """Bit for bit, but for what prepares a run, which a CYCLE of one cycle does as well."""
    states, debugger = both
    timeline = debugger.timeline
    known = iter(states)
    for event in range(1, timeline.now):
        span, cycle = timeline.place(event)
        array = timeline.at(event)
        assert array.h.ci[g.MCTOT] == cycle
        if span.runs and event == span.first + 1:
            continue
        cycles, words, time = next(known)
        assert (cycles, time) == (cycle, float(array.h.cd[g.TIME]))
        assert np.array_equal(array.h.ia[: int(array.h.ci[g.MFREE]) - 1], words)
    assert next(known, None) is None


def test_few_copies_do(both: Any) -> None:
    timeline = both[1].timeline
    commands = len(timeline.spans)
    assert len(timeline.copies) < commands + 20
    assert timeline.now == commands + 3 + KEPT_CYCLES - 3


def test_the_last_change_of_any_word(both: Any) -> None:
    """Of words drawn at random, from events drawn at random."""
    _, debugger = both
    timeline, rng = debugger.timeline, np.random.default_rng(5)
    arrays = [timeline.at(event).h for event in range(timeline.now + 1)]
    for _ in range(60):
        event = int(rng.integers(5, timeline.now + 1))
        atlas = Atlas(timeline.at(event).h)
        kind = str(rng.choice([kind for kind in KINDS if len(atlas.groups[kind])]))
        field = TABLE.group(kind).fields[int(rng.integers(len(TABLE.group(kind).fields)))]
        word = find_number(atlas, f"{kind}@{int(rng.choice(atlas.groups[kind]))}.{field.name}")
        values = [word.value(h) for h in arrays[: event + 1]]
        changes = [k for k in range(1, event + 1) if values[k] != values[k - 1]]
        assert find_last_hit(timeline, event, WordChange(word))[0] == max(changes, default=0), word
        assert find_last_hit(timeline, event, WordChange(word), before=True)[0] == max(
            (k for k in changes if k < event), default=0
        )


def real_contacts(array: Any) -> set[int]:
    """Addresses of the contacts that are not virtual, by the head of their list and its links."""
    h, found, ic = array.h, set(), int(array.h.ci[g.ICPNT])
    while ic:
        if iget(h, ic, g.KCCOD) != g.VIRTUAL:
            found.add(ic)
        ic = iget(h, ic, g.KC)
    return found


def test_contacts_made_and_broken(both: Any) -> None:
    """Every one of them, from the end to the beginning."""
    _, debugger = both
    timeline = debugger.timeline
    real = [real_contacts(timeline.at(event)) for event in range(timeline.now + 1)]
    broken = [k for k in range(1, timeline.now + 1) if real[k - 1] - real[k]]
    event, found = timeline.now, []
    while told := (hit := find_last_hit(timeline, event, ContactChange("broken"), before=True))[1]:
        assert told.startswith("broken: contact@")
        event = hit[0]
        found.append(event)
    assert found == broken[::-1]
    assert len(found) > 2


def test_a_contact_that_takes_over_an_address_is_another_one(tmp_path: Path) -> None:
    """In cycle 5967 of the collapse one is broken, and the next one is made where it was."""
    text = (Path(__file__).parents[2] / "examples" / "collapse.dat").read_text()
    lines = [line for line in text.splitlines() if not line.strip().upper().startswith("PLOT")]
    debugger = Debugger(Model(out=tmp_path), io.StringIO(), lambda told: None)
    debugger.run(list(statements(lines, "collapse")))
    timeline = debugger.timeline
    before, after = timeline.event_of(5966), timeline.event_of(5967)
    counts = [timeline.at(event).h.ci[[g.NMADE, g.NBROKE]] for event in (before, after)]
    assert (counts[1] - counts[0]).tolist() == [1, 1]
    for what, told in (("made", "made: contact@"), ("broken", "broken: contact@"), ("recoded", "")):
        probe = ContactChange(what)
        probe.begin(timeline.at(before))
        printed = probe.hit(timeline.at(after))
        assert printed.startswith(told)
        assert bool(printed) == bool(told)


def test_copies_keep_to_the_budget(tmp_path: Path) -> None:
    """What can be reached is as it was, and what cannot is refused."""
    whole = debugged("i32r64", tmp_path)
    size = max(copy.size for copy in whole.timeline.copies.values())
    poor = debugged("i32r64", tmp_path, budget=4 * size).timeline
    assert sum(copy.size for copy in poor.copies.values()) <= 4 * size
    reached, gone = 0, set()
    for event in range(poor.now + 1):
        try:
            h = poor.at(event).h
        except UnreachableEvent as error:
            gone.add(str(error)[-13:-3])
            continue
        reached += 1
        used = int(h.ci[g.MFREE]) - 1
        assert np.array_equal(h.ia[:used], whole.timeline.at(event).h.ia[:used])
    assert len(gone) > 0
    assert 0 < reached < poor.now


@pytest.mark.parametrize(("at", "begun", "whole"), [(20, 0, 60), (100, 60, 360), (445, 420, 40)])
def test_a_run_goes_on_from_the_past(at: int, begun: int, whole: int, tmp_path: Path) -> None:
    """To the same end, with the same histories and the same log."""
    plain = debugged("i32r64", tmp_path).model
    told: list[int] = []

    def stopped(reasons: list[str]) -> None:
        told.append(debugger.timeline.now)
        if debugger.ended and len(told) == 1:
            raise ResumeRun(debugger.timeline.event_of(at))

    debugger = Debugger(Model("i32r64", out=tmp_path), io.StringIO(), stopped)
    debugger.run(list(statements(PILE.splitlines(), "pile")))
    again = debugger.model
    assert len(told) == 3
    used = int(plain.array.h.ci[g.MFREE]) - 1
    assert np.array_equal(plain.array.h.ia[:used], again.array.h.ia[:used])
    assert np.array_equal(plain.histories()[0].numbers, again.histories()[0].numbers)
    parts = f"CYCLE {at - begun}\nCYCLE {begun + whole - at}\n"
    assert again.deck().replace(parts, f"CYCLE {whole}\n") == plain.deck()


def test_the_narrowest_words_and_the_widest(tmp_path: Path) -> None:
    for build in ("i16r32", "i64r64"):
        timeline = debugged(build, tmp_path).timeline
        middle = timeline.event_of(77)
        assert timeline.at(middle).h.ci[g.MCTOT] == 77


def test_only_the_present_timeline_counts_after_resume(tmp_path: Path) -> None:
    """Probes, and what the words are, are those of the state that the run goes on from."""
    hits: list[Any] = []
    lists: list[Any] = []

    def stopped(reasons: list[str]) -> None:
        timeline = debugger.timeline
        step = len(hits)
        hits.append([reason for reason in reasons if ": " in reason])
        if step == 0:  # before the first command
            debugger.goal_cycle = 50
        elif step == 1:
            word = find_number(debugger.atlas, "block@721.KYD")
            debugger.add(WordChange(word, "<", float(word.value(debugger.array.h) or 0) + 0.1))
            debugger.add(ContactChange("recoded"))
            debugger.add(ContactChange("made"))
            raise ResumeRun(timeline.event_of(5))
        elif step == 2:
            raise ResumeRun(timeline.now, "PATCH AMU(1) = 0.3")
        elif step == 3:
            lists.append(debugger.atlas.h)
            raise LeaveDebugger

    debugger = Debugger(Model(out=tmp_path), io.StringIO(), stopped)
    debugger.goal = 0
    with suppress(LeaveDebugger):
        debugger.run(list(statements(PILE.splitlines(), "pile")))
    assert hits[2:] == [[], []]
    assert lists[0] is debugger.model.array.h


def test_groups_at_new_addresses_are_no_new_groups(tmp_path: Path) -> None:
    """DISPLACEMENTS moves all blocks."""
    deck = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5
BLOCK 0,0 0,1 1,1 1,0
BLOCK 0,1 0,2 1,2 1,1
FIX 0,1 0,1
CYCLE 2
DISPLACEMENTS
CYCLE 20
"""
    where: list[list[int]] = []
    hits: list[list[str]] = []

    def stopped(reasons: list[str]) -> None:
        hits.append([reason for reason in reasons if ": " in reason])
        where.append(addresses(debugger.model.array, "block").tolist())
        if len(where) == 1:  # before DISPLACEMENTS
            debugger.add(GroupCondition("block where KY > -1"))
            debugger.goal_line = None

    debugger = Debugger(Model(out=tmp_path), io.StringIO(), stopped)
    debugger.goal_line = 7
    debugger.run(list(statements(deck.splitlines(), "moved")))
    assert hits[1:] == [[]]
    assert where[0] != where[-1]


def test_the_words_shown_are_those_of_the_present_timeline(tmp_path: Path) -> None:
    """The same event of two timelines, where one looks at lists in both."""
    seen: list[Any] = []

    def stopped(reasons: list[str]) -> None:
        timeline, step = debugger.timeline, len(seen)
        seen.append((timeline.now, debugger.atlas.h is debugger.array.h))
        if step == 0:
            debugger.goal_cycle = 50
        elif step == 1:
            raise ResumeRun(timeline.event_of(50))

    debugger = Debugger(Model(out=tmp_path), io.StringIO(), stopped)
    debugger.goal = 0
    debugger.run(list(statements(PILE.splitlines(), "pile")))
    assert seen[1][0] == seen[2][0]
    assert all(own for _, own in seen)


def test_probes_are_at_the_present_after_a_search_that_fails(tmp_path: Path) -> None:
    """Going back to what can no longer be reached leaves them as they were."""
    whole = debugged("i32r64", tmp_path)
    size = max(copy.size for copy in whole.timeline.copies.values())
    poor = debugged("i32r64", tmp_path, budget=4 * size)
    word = find_number(poor.atlas, "TIME")
    probe = WordChange(word)
    poor.add(probe)
    begun: list[float] = []
    begin = probe.begin
    probe.begin = lambda array: (begun.append(float(array.h.cd[g.TIME])), begin(array))[1]  # type: ignore[method-assign]
    poor.timeline.at = lambda event: (_ for _ in ()).throw(UnreachableEvent("gone"))  # type: ignore[method-assign]
    with pytest.raises(UnreachableEvent):
        poor.back_to([probe])
    assert begun[-1:] == [float(poor.model.array.h.cd[g.TIME])]
