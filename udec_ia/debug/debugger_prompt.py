"""The prompt of the debugger: commands are typed, or read from a file, while a run is stopped."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from threading import current_thread, main_thread
from typing import Any, TextIO, cast

from udec_ia.debug.cycle_snapshots import UnreachableEvent
from udec_ia.debug.debugged_run import Debugger, LeaveDebugger
from udec_ia.debug.debugger_commands import DebuggerCommands
from udec_ia.debug.recording import Recording
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.deck_variables import Values, Variables
from udec_ia.deck.lines_and_calls import NO_DECK, RESTART_FILE
from udec_ia.errors import UdecError
from udec_ia.interrupt_signals import allow_signals, dealt_with, defer_signals
from udec_ia.layout import offsets as g
from udec_ia.printable_text import visible
from udec_ia.reader.field_reading import FIELDS
from udec_ia.reader.word_map import TABLE, choices

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


class PrintableOutput:
    """Writes to `out` with escape sequences made visible: a terminal would obey them."""

    def __init__(self, out: TextIO) -> None:
        self.out = out

    def write(self, text: str) -> int:
        """Write `text`. Tabs become spaces."""
        return self.out.write(visible(text.expandtabs()))

    def writelines(self, lines: Iterable[str]) -> None:
        """Write each of `lines`, which end in line feeds."""
        for line in lines:
            self.write(line)

    def flush(self) -> None:
        """Flush `out`."""
        self.out.flush()


class Console(DebuggerCommands):
    """Asks for commands while a run is stopped. script: commands that come first. ends: quit after them.

    deck, name, values: lines, file and variables of the deck.
    """

    doc_header = "commands (help COMMAND describes one; names may be abbreviated):"

    def __init__(
        self,
        model: Any,
        out: TextIO,
        deck: Sequence[str] = (),
        script: Sequence[str] = (),
        ends: bool = False,
        name: str = "deck",
        values: Values | None = None,
    ) -> None:
        super().__init__(stdout=cast(TextIO, PrintableOutput(out)))
        self.debugger = Debugger(model, out, self.ask)
        self.deck, self.ends, self.name, self.values = deck, ends, name, dict(values or {})
        self.cmdqueue = [*script]
        self.asking = False

    def talk(self, run: Callable[[], None]) -> None:
        """Do `run`, in which the debugger stops, until it ends or the debugger is left."""
        here = current_thread() is main_thread()
        former = signal.signal(signal.SIGINT, self.interrupt) if here else None
        try:
            with suppress(LeaveDebugger), defer_signals():
                run()
        finally:
            if here:
                signal.signal(signal.SIGINT, former)

    def ask(self, reasons: Sequence[str]) -> None:
        """The run has stopped: execute commands until one continues it."""
        for line in reasons:
            self.say(line)
        self.say(self.debugger.place())
        with allow_signals():
            self._ask()

    def _ask(self) -> None:
        while True:
            if not self.cmdqueue and self.ends:
                raise LeaveDebugger
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
        """Ctrl-C: ends what is being typed or printed, and stops a run; the second one ends a command."""
        if self.asking or self.debugger.interrupted:
            raise KeyboardInterrupt
        self.debugger.interrupted = True

    def _cycle(self) -> str:
        return f"{int(self.debugger.array.h.ci[g.MCTOT])}{'' if not self.debugger.in_past else ' past'}"

    def precmd(self, line: str) -> str:
        """Echo a line of a script; complete an abbreviated command; - in its name is _."""
        if self.ends:
            self.say(f"{self.prompt}{line}")
        head, _, rest = line.strip().partition(" ")
        head = ALIASES.get(head, head.replace("-", "_"))
        known = [name[3:] for name in self.get_names() if name.startswith("do_")]
        begun = [name for name in known if name.startswith(head)] if head and head not in known else []
        return f"{begun[0] if len(begun) == 1 else head} {rest}".strip()

    def do_help(self, arg: str) -> None:
        """help [COMMAND]: the commands, or what one of them does; abbreviations are accepted."""
        super().do_help(ALIASES.get(arg, arg.replace("-", "_")))

    def onecmd(self, line: str) -> bool:
        """Execute one line, or print what is wrong with it."""
        try:
            return bool(super().onecmd(line))
        except (ValueError, IndexError, UnreachableEvent, UdecError) as error:
            self.say(str(error))
            return False

    def postcmd(self, stop: bool, line: str) -> bool:
        """Show the cycle in the prompt; leave when the script has ended."""
        self.prompt = f"({self._cycle()}) "
        if not stop and not self.cmdqueue and self.ends:
            raise LeaveDebugger
        return stop

    def emptyline(self) -> bool:
        """An empty line does nothing."""
        return False

    def default(self, line: str) -> None:
        """A command that is not known."""
        if line == "EOF":
            raise LeaveDebugger
        self.say(f"no command {line.split()[0]}: help lists them")

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
            first, *steps = head.split(".")
            kinds: tuple[str, ...] = (first.partition("@")[0],)
            for step in steps:  # of a path: what the pointer before leads to
                kinds = choices(str(FIELDS[step.upper()].target)) if step.upper() in FIELDS else ()
            fields = [one.name for group in TABLE.groups if group.name in kinds for one in group.fields]
            names = [f"{head}.{name}" for name in fields]
            whole = f"{head}.{begun.upper()}"
        else:
            names, whole = [f"{kind}@{iad}" for kind in groups for iad in groups[kind].tolist()], word
        known = len(word) - len(text)  # readline passes only what follows a character such as @
        return [name[known:] for name in names if name.startswith(whole)]


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
    console = Console(model, out, lines, script or (), script is not None, name, values)
    console.debugger.goal = 0
    console.talk(lambda: console.debugger.run(list(variables.filled(statements(lines, name)))))


def replay(model: Any, recording: Recording, out: TextIO, script: Sequence[str] | None = None) -> None:
    """Show a recording under the debugger. model: a new one with its word scheme and its laws, else error 9.

    script: as of `debug`.
    """
    timeline = recording.timeline(model.session.laws)
    name, values = recording.name, recording.values
    console = Console(model, out, recording.deck, script or (), script is not None, name, values)
    console.talk(lambda: console.debugger.replay(timeline))
