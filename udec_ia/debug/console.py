"""The debugger's commands, typed at a prompt or taken from a file.

Each command prints lines and moves the place that one looks at; `step`, `continue` and `goto` let the run go
on when they lead beyond what has been run. Names of words are those of places.py.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator, Sequence
from contextlib import suppress
from threading import current_thread, main_thread
from typing import Any, TextIO

from udec_ia.debug import answers
from udec_ia.debug.looks import Looks
from udec_ia.debug.probes import COMPARED, Changed, Contacts, Probe, Where, shown
from udec_ia.debug.session import Debugger, Leave, Resume
from udec_ia.debug.timeline import Gone
from udec_ia.deck.parser import NO_DECK, RESTART_FILE
from udec_ia.deck.reader import statements
from udec_ia.deck.variables import Values, Variables
from udec_ia.errors import UdecError
from udec_ia.heap_tools.patch_words import patch
from udec_ia.layout import offsets as g
from udec_ia.printable import folded
from udec_ia.reader.atlas import TABLE
from udec_ia.reader.places import address_of, find_number
from udec_ia.signals import dealt_with, hold, passing

INSIDE = ("pass", "group", "write")
LISTED = 5  # lines of the deck before and after
ALIASES = {
    "c": "continue",
    "s": "step",
    "rs": "reverse_step",
    "rc": "reverse_continue",
    "p": "print",
    "q": "quit",
    "b": "break",
    "l": "list",
    "w": "where",
}


class Console(Looks):
    """Asks for commands while a run stands. script: lines that are taken first. ends: quit after them.

    deck: the lines of the deck, for `list`.
    """

    doc_header = "commands (help COMMAND tells more; names may be abbreviated):"

    def __init__(
        self,
        model: Any,
        out: TextIO,
        deck: Sequence[str] = (),
        script: Sequence[str] = (),
        ends: bool = False,
    ) -> None:
        super().__init__(stdout=out)
        self.debugger = Debugger(model, out, self.ask)
        self.deck, self.ends = deck, ends
        self.cmdqueue = [*script]
        self.asking = False

    # ---- the prompt

    def ask(self, told: Sequence[str]) -> None:
        """The run has stopped: obey what is typed until it is to go on."""
        for line in told:
            self.say(line)
        self.say(self.debugger.place())
        with passing():
            self._ask()

    def _ask(self) -> None:
        while True:
            if not self.cmdqueue and self.ends:
                raise Leave
            self.prompt, self.asking = f"({self._cycle()}) ", True
            try:
                self.cmdloop()
                return
            except KeyboardInterrupt as error:
                dealt_with(error)  # it has ended the line that was typed, and no more
                self.say("")
            finally:
                self.asking = False

    def interrupt(self, number: int, frame: Any) -> None:
        """Ctrl-C: ends what is being typed or told, and stops a run; the second one ends a command."""
        if self.asking or self.debugger.interrupted:
            raise KeyboardInterrupt
        self.debugger.interrupted = True

    def _cycle(self) -> str:
        return f"{int(self.debugger.array.h.ci[g.MCTOT])}{'' if not self.debugger.in_past else ' past'}"

    def say(self, text: str) -> None:
        """Print a line, or as many as it takes up."""
        self.stdout.write(folded(text) + "\n")

    def tell(self, lines: Iterator[str]) -> None:
        """Print lines."""
        for line in lines:
            self.say(line)

    def precmd(self, line: str) -> str:
        """Echo what a script says; complete a command that is cut short; - in its name is _."""
        if self.ends:
            self.say(f"{self.prompt}{line}")
        head, _, rest = line.strip().partition(" ")
        head = ALIASES.get(head, head.replace("-", "_"))
        known = [name[3:] for name in self.get_names() if name.startswith("do_")]
        begun = [name for name in known if name.startswith(head)] if head and head not in known else []
        return f"{begun[0] if len(begun) == 1 else head} {rest}".strip()

    def do_help(self, arg: str) -> None:
        """help [COMMAND]: the commands, or what one of them does; short names do, too."""
        super().do_help(ALIASES.get(arg, arg.replace("-", "_")))

    def onecmd(self, line: str) -> bool:
        """Obey one line; what is wrong with it is told."""
        try:
            return bool(super().onecmd(line))
        except (ValueError, IndexError, Gone) as error:
            self.say(str(error))
            return False

    def postcmd(self, stop: bool, line: str) -> bool:
        """The prompt says where one is."""
        self.prompt = f"({self._cycle()}) "
        if not stop and not self.cmdqueue and self.ends:
            raise Leave
        return stop

    def emptyline(self) -> bool:
        """An empty line does nothing."""
        return False

    def default(self, line: str) -> None:
        """A command that is not known."""
        if line == "EOF":
            raise Leave
        self.say(f"no command {line.split()[0]}: help lists them")

    # ---- running

    def do_continue(self, _: str) -> bool:
        """continue: run on, to the next break or watch, or to the end."""
        return self._forward(None)

    def do_step(self, text: str) -> bool:
        """step [N], step cycle: go on by N events: cycles, or commands of the deck.

        step pass | group | write: go on within the next cycle, which must have been run before.
        """
        if text in INSIDE:
            if self.debugger.event == self.debugger.timeline.now and self.debugger.trace is None:
                raise ValueError(
                    "the next cycle has not been run yet: step over it, then reverse-step into it"
                )
            self.debugger.within(text, 1)
            self._here()
            return False
        return self._forward(_count("" if text == "cycle" else text))

    def do_goto(self, text: str) -> bool:
        """goto CYCLE | goto line N | goto now: go to after a cycle, before a line, or to where the run is."""
        debugger, timeline = self.debugger, self.debugger.timeline
        if text == "now":
            debugger.show(timeline.now)
        elif text.startswith("line"):
            number = _count(text[4:])
            past = [one for one in timeline.stretches if one.line >= number]
            if not past:
                debugger.show(timeline.now)
                debugger.goal_line = number
                return not self._is_over()
            debugger.show(past[0].first)
        else:
            cycle = _count(text)
            try:
                debugger.show(timeline.event_of(cycle))
            except Gone:
                if cycle <= int(debugger.model.array.h.ci[g.MCTOT]):
                    raise
                debugger.show(timeline.now)
                debugger.goal_cycle = cycle
                return not self._is_over()
        self._here()
        return False

    def do_reverse_step(self, text: str) -> None:
        """reverse-step [N]: go back N events. reverse-step pass | group | write: back within a cycle."""
        if text in INSIDE:
            self.debugger.within(text, -1)
        elif self.debugger.trace is not None:
            self.debugger.show(self.debugger.event)
        else:
            self.debugger.back(_count(text))
        self._here()

    def do_reverse_continue(self, text: str) -> None:
        """reverse-continue [NAME]: back to the last break or watch, or to the last change of a word."""
        debugger = self.debugger
        probes: list[Probe] = [*debugger.probes.values()]
        if text:
            probes = [Changed(find_number(debugger.atlas, text))]
        told = debugger.back_to(probes)
        self.say(told or (f"{text} has not changed before" if text else "no break or watch was hit before"))
        self._here()

    def do_resume(self, _: str) -> bool:
        """resume: let the run go on from here; everything later is forgotten."""
        if self.debugger.trace is not None:
            raise ValueError("a run can only continue between two cycles: step or reverse-step first")
        raise Resume(self.debugger.event)

    def do_patch(self, text: str) -> bool:
        """patch NAME = VALUE, ...: give words other values, as PATCH does in a deck."""
        debugger = self.debugger
        if debugger.in_past:
            raise ValueError("the past cannot be changed: goto now, or resume from here")
        if not debugger.timeline.stretches:
            raise ValueError("the deck has not begun: step first")
        try:
            patch(debugger.timeline.at(debugger.event), text)  # of what is wrong with it nothing is to happen
        except UdecError as error:
            raise ValueError(str(error)) from None
        raise Resume(debugger.event, f"PATCH {text}")

    def do_quit(self, _: str) -> bool:
        """quit: leave the run where it is."""
        raise Leave

    def _forward(self, events: int | None) -> bool:
        runs, told = self.debugger.forward(events)
        if runs and self._is_over():
            return False
        if not runs:
            for line in told:
                self.say(line)
            self._here()
        return runs

    def _is_over(self) -> bool:
        if self.debugger.ended:
            self.debugger.goal = self.debugger.goal_cycle = self.debugger.goal_line = None
            self.say(f"{self.debugger.ended}: go back, or quit")
        return bool(self.debugger.ended)

    def _here(self) -> None:
        self.say(self.debugger.place())
        trace = self.debugger.trace
        one = trace.here() if trace else None
        if one is not None:
            self.say(
                f"next: {answers.work_of(self.debugger.timeline, self.debugger.event + 1, one)}, {one.place}"
            )

    # ---- stopping

    def do_break(self, text: str) -> None:
        """break made | broken | recoded: stop at such contacts. break KIND where CONDITION: if it holds."""
        if text in ("made", "broken", "recoded"):
            self._add(Contacts(text))
        elif " where " in text:
            self._add(Where(text))
        else:
            raise ValueError(
                "break made, broken or recoded, or a condition, as in: break contact where KCN > 0.1"
            )

    def do_watch(self, text: str) -> None:
        """watch NAME [> | < | >= | <= | == NUMBER]: stop when a word changes, or a comparison holds."""
        words = text.removesuffix("if changed").replace(" if ", " ").split()
        if len(words) not in (1, 3) or (len(words) == 3 and words[1] not in COMPARED):
            raise ValueError("give a word, or a comparison: watch block@88.KXD, or watch block@88.KXD > 0.1")
        word = find_number(self.debugger.atlas, words[0])
        self._add(Changed(word, words[1], float(words[2])) if words[1:] else Changed(word))

    def do_delete(self, text: str) -> None:
        """delete [N]: remove break or watch N, or all of them."""
        if text and _count(text) not in self.debugger.probes:
            raise ValueError(f"there is no break or watch {text}: info lists them")
        for n in [_count(text)] if text else [*self.debugger.probes]:
            del self.debugger.probes[n]

    def do_info(self, _: str) -> None:
        """info: breaks and watches, and how far you can go back."""
        for n, probe in self.debugger.probes.items():
            self.say(f"{n}: {probe.text}")
        timeline = self.debugger.timeline
        size = sum(one.size for one in timeline.copies.values())
        self.say(
            f"the run has come to event {timeline.now}; you can go back to event {timeline.earliest} "
            f"(copies: {len(timeline.copies)}, {size / 2**20:.1f} MB)"
        )

    def _add(self, probe: Probe) -> None:
        self.say(f"{self.debugger.add(probe)}: {probe.text}")

    # ---- looking

    def do_where(self, _: str) -> None:
        """where: the place that is shown."""
        self._here()

    def do_list(self, _: str) -> None:
        """list: the deck around the present line."""
        stretch, _cycles = self.debugger.timeline.place(self.debugger.event)
        at = stretch.line if stretch else 0
        for number in range(max(at - LISTED, 1), min(at + LISTED, len(self.deck)) + 1):
            line = self.deck[number - 1].rstrip()
            self.stdout.write(f"{'->' if number == at else '  '} {number:4} {line}\n")

    def do_print(self, text: str) -> None:
        """print NAME ...: values of words: block@88.KXD, zone@9.KZG(2), FRAC, 412."""
        for name in text.split():
            word = find_number(self.debugger.atlas, name)
            self.say(f"{word.name} = {shown(word.value(self.debugger.array.h))} {word.unit}".rstrip())

    def do_wrote(self, text: str) -> None:
        """wrote NAME: what has given a word its value: cycle, pass, routine, line."""
        self._of_the_past(answers.wrote, text)

    def do_why(self, text: str) -> None:
        """why NAME: what the value of a word was computed from."""
        self._of_the_past(answers.why, text)

    def do_born(self, text: str) -> None:
        """born PLACE: how the group at block@88 or 412 came to be, and what stood there before."""
        address = address_of(self.debugger.atlas, text)
        self.tell(answers.born(self.debugger.timeline, self.debugger.event, address))

    def _of_the_past(self, answer: Any, text: str) -> None:
        word = find_number(self.debugger.atlas, text)
        timeline, event = self.debugger.timeline, self.debugger.event
        trace = self.debugger.trace
        here = [] if trace is None else [*answers.wrote_within(timeline, event, trace, word)]
        self.tell(iter(here) if here else answer(timeline, event, word))

    # ---- completion

    def completenames(self, text: str, *_: Any) -> list[str]:
        """Commands that begin so."""
        names = [name[3:].replace("_", "-") for name in self.get_names() if name.startswith("do_")]
        return [name for name in names if name.startswith(text)]

    def completedefault(self, text: str, line: str, begin: int, end: int) -> list[str]:
        """Groups by name, and their fields after a dot."""
        groups = self.debugger.atlas.groups
        word = line[:end].split(" ")[-1]
        head, dot, begun = word.rpartition(".")
        if dot:
            kind = head.partition("@")[0]
            fields = [one.name for group in TABLE.groups if group.name == kind for one in group.fields]
            names = [f"{head}.{name}" for name in fields]
            whole = f"{head}.{begun.upper()}"
        else:
            names, whole = [f"{kind}@{iad}" for kind in groups for iad in groups[kind].tolist()], word
        known = len(word) - len(text)  # what stands before a character such as @ is not asked for
        return [name[known:] for name in names if name.startswith(whole)]


def _count(text: str) -> int:
    """A number that was typed; 1 if nothing was."""
    if not text.strip():
        return 1
    if not text.strip().isdecimal():
        raise ValueError(f"{text.strip()} is not a number: give an integer, 0 or more")
    return int(text)


def debug(
    model: Any,
    deck: str,
    out: TextIO,
    script: Sequence[str] | None = None,
    name: str = "deck",
    values: Values | None = None,
) -> None:
    """Run the text of a deck on `model` under the debugger, which stops before the first command.

    script: commands of the debugger, after which it ends; None asks for them. values: of the variables of the
    deck. Raises the UdecError that ends the deck, after stopping there, and 2 for a restart file.
    """
    if deck.startswith(" ".join(RESTART_FILE)):  # in whose words one would look for variables first
        raise UdecError(2, f"{name} is no deck", NO_DECK)
    lines, variables = deck.splitlines(), Variables(values)
    variables.check(lines, name)
    console = Console(model, out, lines, script or (), ends=script is not None)
    console.debugger.goal = 0
    here = current_thread() is main_thread()
    former = signal.signal(signal.SIGINT, console.interrupt) if here else None
    try:
        with suppress(Leave), hold():
            console.debugger.run(list(variables.filled(statements(lines, name))))
    finally:
        if here:
            signal.signal(signal.SIGINT, former)
