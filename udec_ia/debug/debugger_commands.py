"""Commands of the debugger: running forwards and back, breaks and watches, and reading words.

Each command prints lines and may show another event. `step`, `continue` and `goto` continue the run if they
lead beyond its present end. Names of words are those of place_grammar.py, and expressions of them those of
group_conditions.py.
"""

from __future__ import annotations

import cmd
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from udec_ia.checker import check
from udec_ia.debug import word_history
from udec_ia.debug.cycle_snapshots import UnreachableEvent
from udec_ia.debug.debugged_run import Debugger, LeaveDebugger, ResumeRun
from udec_ia.debug.recording import write_recording
from udec_ia.debug.stop_conditions import (
    COMPARED,
    ContactChange,
    ExpressionChange,
    GroupCondition,
    StopCondition,
    UnsoundState,
    WordChange,
    format_number,
)
from udec_ia.errors import UdecError
from udec_ia.heap_tools.heap_dump import ALONE, common, dump
from udec_ia.heap_tools.heap_lookup import walk, what, who
from udec_ia.heap_tools.heap_search import find
from udec_ia.heap_tools.memory_use import heap_map, junk
from udec_ia.heap_tools.patch_words import patch
from udec_ia.heap_tools.pointer_graph import graph, telescope
from udec_ia.layout import offsets as g
from udec_ia.output.history_graph import draw_changes
from udec_ia.printable_text import folded
from udec_ia.reader.group_conditions import evaluate
from udec_ia.reader.place_grammar import PlaceError, PlaceName, address_of, find_number, read_place
from udec_ia.reader.printed_listing import Listing

INSIDE = ("pass", "group", "write")
LISTED = 5  # lines of the deck before and after


class DebuggerCommands(cmd.Cmd):
    """The commands. debugger: the run. deck, name, values: lines, file and variables of the deck."""

    debugger: Debugger
    deck: Sequence[str]
    name: str
    values: Mapping[str, Any]

    def say(self, text: str) -> None:
        """Print a line, or as many as it takes up."""
        self.stdout.write(folded(text) + "\n")

    def say_all(self, lines: Iterator[str]) -> None:
        """Print lines."""
        for line in lines:
            self.say(line)

    # ---- running

    def do_continue(self, _: str) -> bool:
        """continue: run on, to the next break or watch, or to the end."""
        return self._forward(None)

    def do_step(self, text: str) -> bool:
        """step [N], step cycle: go on by N events: cycles, or commands of the deck.

        step pass | group | write: go on within the next cycle, which must have been run before.
        """
        if text in INSIDE:
            self.debugger.within(text, 1)
            self._say_place()
            return False
        return self._forward(_count("" if text == "cycle" else text))

    def do_goto(self, text: str) -> bool:
        """goto CYCLE | goto line N | goto now: go to after a cycle, before a line, or to where the run is."""
        debugger, timeline = self.debugger, self.debugger.timeline
        if text == "now":
            debugger.show(timeline.now)
        elif text.startswith("line"):
            if not text[4:].strip():
                raise ValueError("give the number of a line of the deck, as in goto line 12")
            number = _count(text[4:])
            past = [one for one in timeline.spans if one.line >= number]
            if not past:
                debugger.show(timeline.now)
                debugger.goal_line = number
                return not self._is_over()
            debugger.show(past[0].first)
        else:
            cycle = _count(text)
            try:
                debugger.show(timeline.event_of(cycle))
            except UnreachableEvent:
                if cycle <= int(debugger.model.array.h.ci[g.MCTOT]):
                    raise
                debugger.show(timeline.now)
                debugger.goal_cycle = cycle
                return not self._is_over()
        self._say_place()
        return False

    def do_reverse_step(self, text: str) -> None:
        """reverse-step [N]: go back N events. reverse-step pass | group | write: back within a cycle."""
        if text in INSIDE:
            self.debugger.within(text, -1)
        elif self.debugger.trace is not None:
            self.debugger.show(self.debugger.event)
        else:
            self.debugger.back(_count(text))
        self._say_place()

    def do_reverse_continue(self, text: str) -> None:
        """reverse-continue [NAME]: back to the last break or watch, or to the last change of a word.

        NAME may be an expression, as for watch.
        """
        debugger = self.debugger
        conditions = [self._watched(text)] if text else [*debugger.conditions.values()]
        hit = debugger.back_to(conditions)
        self.say(hit or f"{conditions[0].text if text else 'no break or watch'}: not hit before")
        self._say_place()

    def do_resume(self, _: str) -> bool:
        """resume: let the run go on from here; everything later is forgotten."""
        self._require_run()
        if self.debugger.trace is not None:
            raise ValueError("a run can only continue between two cycles: step or reverse-step first")
        raise ResumeRun(self.debugger.event)

    def do_patch(self, text: str) -> bool:
        """patch NAME = VALUE, ...: give words other values, as PATCH does in a deck."""
        self._require_run()
        debugger = self.debugger
        if debugger.in_past:
            raise ValueError("the past cannot be changed: goto now, or resume from here")
        if not debugger.timeline.spans:
            raise ValueError("the deck has not begun: step first")
        try:
            patch(debugger.timeline.at(debugger.event), text)  # on a copy: an error changes nothing
        except UdecError as error:
            raise ValueError(str(error)) from None
        raise ResumeRun(debugger.event, f"PATCH {text}")

    def _require_run(self) -> None:
        """ValueError in a recording."""
        if self.debugger.recorded:
            raise ValueError("a recording can be looked at, not continued: run its deck, which list shows")

    def do_record(self, text: str) -> None:
        """record FILE: write the run so far to a file, for `udec debug --replay FILE` anywhere."""
        timeline, model = self.debugger.timeline, self.debugger.model
        if not text.strip():
            raise ValueError("give the name of a file, as in record run.udecrec")
        path = write_recording(
            timeline, text.strip(), self.name, self.deck, self.values, model.array.scheme.name
        )
        self.say(f"written: {path}, events {timeline.earliest} to {timeline.now}")

    def do_quit(self, _: str) -> bool:
        """quit: leave the run where it is."""
        raise LeaveDebugger

    def _forward(self, events: int | None) -> bool:
        runs, hits = self.debugger.forward(events)
        if runs and self._is_over():
            return False
        if not runs:
            for line in hits:
                self.say(line)
            self._say_place()
        return runs

    def _is_over(self) -> bool:
        if self.debugger.ended:
            self.debugger.goal = self.debugger.goal_cycle = self.debugger.goal_line = None
            self.say(f"{self.debugger.ended}: go back, or quit")
        return bool(self.debugger.ended)

    def _say_place(self) -> None:
        self.say(self.debugger.place())
        trace = self.debugger.trace
        one = trace.here() if trace else None
        if one is not None:
            call = word_history.describe_call(self.debugger.timeline, self.debugger.event + 1, one)
            self.say(f"next: {call}, {one.place}")

    # ---- stopping

    def do_break(self, text: str) -> None:
        """break made | broken | recoded: stop at such contacts. break KIND where CONDITION: if it holds.

        break unsound: stop when check finds something, after every cycle and command; this takes time.
        """
        if text in ("made", "broken", "recoded"):
            self._add(ContactChange(text))
        elif text == "unsound":
            self._add(UnsoundState())
        elif " where " in text:
            self._add(GroupCondition(text))
        else:
            raise ValueError(
                "break made, broken, recoded or unsound, or a condition: break contact where KCN > 0.1"
            )

    def do_watch(self, text: str) -> None:
        """watch NAME [> | < | >= | <= | == NUMBER]: stop when a word changes, or a comparison becomes true.

        watch EXPRESSION: stop when its value changes, as in watch block@88.KXD - block@88.KP.KXDP. Pointers
        of a path are followed anew each time.
        """
        self._add(self._watched(text))

    def _watched(self, text: str) -> StopCondition:
        """The stop condition of a word, a comparison of one with a number, or an expression."""
        text = text.removesuffix("if changed").replace(" if ", " ").strip()
        name, *rest = text.split(maxsplit=2) or [""]
        place = _read(name)
        compared = len(rest) == 2 and rest[0] in COMPARED and _is_real(rest[1])
        if place and not place.path and (not rest or compared):
            word = find_number(self.debugger.atlas, name)
            return WordChange(word, rest[0], float(rest[1])) if rest else WordChange(word)
        evaluate(self.debugger.atlas, text)
        return ExpressionChange(text)

    def do_delete(self, text: str) -> None:
        """delete [N]: remove break or watch N, or all of them."""
        if text and _count(text) not in self.debugger.conditions:
            raise ValueError(f"there is no break or watch {text}: info lists them")
        for n in [_count(text)] if text else [*self.debugger.conditions]:
            del self.debugger.conditions[n]

    def do_info(self, _: str) -> None:
        """info: the deck and values of its variables, breaks and watches, and how far you can go back."""
        values = ", ".join(f"{name}={value}" for name, value in self.values.items())
        self.say(f"deck {self.name}{', with ' if values else ''}{values}")
        for n, condition in self.debugger.conditions.items():
            self.say(f"{n}: {condition.text}")
        timeline = self.debugger.timeline
        size = sum(one.size for one in timeline.copies.values())
        self.say(
            f"the run has come to event {timeline.now}; you can go back to event {timeline.earliest} "
            f"(copies: {len(timeline.copies)}, {size / 2**20:.1f} MB)"
        )

    def _add(self, condition: StopCondition) -> None:
        self.say(f"{self.debugger.add(condition)}: {condition.text}")

    # ---- reading words and their history

    def do_where(self, _: str) -> None:
        """where: the place that is shown."""
        self._say_place()

    def do_list(self, _: str) -> None:
        """list: the deck around the present line."""
        span, _cycles = self.debugger.timeline.place(self.debugger.event)
        at = span.line if span else 0
        for number in range(max(at - LISTED, 1), min(at + LISTED, len(self.deck)) + 1):
            line = self.deck[number - 1].rstrip()
            self.stdout.write(f"{'->' if number == at else '  '} {number:4} {line}\n")

    def do_print(self, text: str) -> None:
        """print NAME ...: values of words: block@88.KXD, zone@9.KZG(2), block@88.KP.KXP, FRAC, 412.

        print EXPRESSION: its value, as in print block@88.KXD * 2.
        """
        if not text or not all(map(_read, text.split())):
            self.say(f"{text} = {format_number(evaluate(self.debugger.atlas, text))}")
            return
        for name in text.split():
            word = find_number(self.debugger.atlas, name)
            path = f"{name} is " if read_place(name).path else ""
            value = format_number(word.value(self.debugger.array.h))
            self.say(f"{path}{word.name} = {value} {word.unit}".rstrip())

    def do_wrote(self, text: str) -> None:
        """wrote NAME: what has given a word its value: cycle, pass, routine, line."""
        self._explain(word_history.explain_write, text)

    def do_writes(self, text: str) -> None:
        """writes NAME [PICTURE]: all changes of a word in the run so far, also drawn (.png or .svg)."""
        name, _, picture = text.strip().partition(" ")
        debugger, word = self.debugger, find_number(self.debugger.atlas, name)
        found = word_history.changes(debugger.timeline, debugger.event, word)
        self.say_all(word_history.explain_changes(debugger.timeline, word, found))
        if picture:
            end = debugger.timeline.at(debugger.event).h
            rows = [one[1:] for one in found] + [
                (int(end.ci[g.MCTOT]), float(end.cd[g.TIME]), found[-1].value)
            ]
            self.say(f"drawn: {draw_changes(rows, word.name, word.unit, picture.strip())}")

    def do_why(self, text: str) -> None:
        """why NAME: what the value of a word was computed from."""
        self._explain(word_history.explain_value, text)

    def do_born(self, text: str) -> None:
        """born PLACE: how the group at block@88 or 412 came to be, and what stood there before."""
        self.say_all(
            word_history.explain_birth(
                self.debugger.timeline, self.debugger.event, address_of(self.debugger.atlas, text)
            )
        )

    def _explain(self, answer: Any, text: str) -> None:
        word = find_number(self.debugger.atlas, text)
        timeline, event = self.debugger.timeline, self.debugger.event
        trace = self.debugger.trace
        here = [] if trace is None else [*word_history.explain_write_within(timeline, event, trace, word)]
        self.say_all(iter(here) if here else answer(timeline, event, word))

    # ---- reading the array, as `udec what`, `udec who` ... read a file

    def do_what(self, text: str) -> None:
        """what PLACE: what a word is, and its group."""
        self._look(what, text)

    def do_who(self, text: str) -> None:
        """who PLACE: all words that point there."""
        self._look(who, text)

    def do_walk(self, text: str) -> None:
        """walk LIST [PLACE]: along a list."""
        self._look(walk, text)

    def do_find(self, text: str) -> None:
        """find KIND where CONDITION: groups for which it is true."""
        self.stdout.write(find(self.debugger.atlas, text).as_text())

    def do_dump(self, text: str) -> None:
        """dump [PLACE[-LAST|/COUNT] | common]: words with their fields; all words if nothing is given."""
        atlas = self.debugger.atlas
        found = common(atlas) if text == ALONE else dump(atlas, text or None)
        self.stdout.writelines(f"{line.text}\n" for line in found.lines())

    def do_map(self, _: str) -> None:
        """map: the memory, a letter for each kind of group."""
        self._look(heap_map, "")

    def do_graph(self, text: str) -> None:
        """graph PLACE [DEPTH]: the pointers around a group."""
        self._look(graph, text)

    def do_telescope(self, text: str) -> None:
        """telescope PLACE [LEVELS]: the pointers of a group, followed some levels deep."""
        self._look(telescope, text)

    def do_junk(self, _: str) -> None:
        """junk: how full the memory is."""
        self._look(junk, "")

    def do_check(self, _: str) -> None:
        """check: all violations of the invariants."""
        found = check(self.debugger.array)
        self.stdout.writelines(f"{line}\n" for line in (map(str, found) if found else ("sound",)))

    def _look(self, look: Callable[..., Listing], text: str) -> None:
        given: list[Any] = [int(word) if word.isdecimal() else word for word in text.split()]
        try:
            listing = look(self.debugger.atlas, *given)
        except TypeError:
            raise ValueError(f"{self.lastcmd.split()[0]} takes other arguments: see help") from None
        self.stdout.write(listing.as_text())


def _read(text: str) -> PlaceName | None:
    """The place that `text` names; None for an expression."""
    try:
        return read_place(text)
    except PlaceError:
        return None


def _is_real(text: str) -> bool:
    """True if it is a number."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _count(text: str) -> int:
    """A number that was typed; 1 if nothing was."""
    if not text.strip():
        return 1
    if not text.strip().isdecimal():
        raise ValueError(f"{text.strip()} is not a number: give an integer, 0 or more")
    return int(text)
