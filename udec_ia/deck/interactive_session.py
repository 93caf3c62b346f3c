"""Commands typed at a terminal: a prompt, a history, completion, and errors that do not end the session.

A command is executed when its line ends. A line that ends with `+` is continued behind a prompt `+`. A
command with a list, such as BLOCK or GENERATE, is executed at an empty line or at the next command, as in a
deck. A `?` at the end of a line explains its command, and the tab key completes words.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, TextIO

from platformdirs import user_state_dir

from udec_ia.deck.command_forms import Command, match
from udec_ia.deck.command_help import explain, summary
from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import CONTINUATION, WORD, Reader, Statement, without_comment
from udec_ia.deck.deck_variables import Values
from udec_ia.deck.line_completion import DELIMITERS, completions
from udec_ia.errors import UdecError
from udec_ia.interrupt_signals import Terminated, dealt_with

PROMPT = "> "
MORE = f"{CONTINUATION} "
GREETING = (
    "Type START to begin, HELP or ? for the commands, STOP to leave. A line that ends with + is continued."
)
NUMERIC = "+-.0123456789"  # what a number begins with
HISTORY_LENGTH = 1000


def converse(
    model: Any, out: TextIO, ask: Callable[[str], str] = input, values: Values | None = None
) -> None:
    """Execute typed commands on `model`, a Model, until STOP, END or the end of input.

    ask: shows a prompt and returns a line. values: of variables. Raises UdecError if STOP itself fails, and
    Terminated after the state has been saved.
    """
    monitor, typed = Monitor(model, out, echo=False, values=values), Typed()
    complete: list[Statement] = []
    over = False
    print(GREETING, file=out)
    while not monitor.ended and (complete or not over):
        try:
            if complete:
                monitor.execute(monitor.variables.fill(complete.pop(0)))
            else:
                line = ask(typed.prompt)
                asked = question(line)
                if asked is None:
                    complete = typed.read(line)
                else:
                    print(asked, file=out)
        except UdecError as error:
            if monitor.ended:
                raise
            print(error, file=out)
        except Terminated:
            raise Terminated(monitor.rescue()) from None
        except KeyboardInterrupt as error:
            dealt_with(error)  # else it would end the next command
            typed.flush()
            complete = []
            print("\ninterrupted", file=out)
        except EOFError:
            over = True
            complete = typed.flush()
            print(file=out)
    monitor.stop()


def question(line: str) -> str | None:
    """The answer to a line that ends with `?`: what its command does, or all forms; None for other lines.

    Raises UdecError 2 if there is no such command.
    """
    text = without_comment(line).strip()
    if not text.endswith("?"):
        return None
    word = WORD.search(text.removesuffix("?"))
    return summary() if word is None else explain(word.group())


class Typed:
    """Joins typed lines to statements.

    command: the pending command. asked: its last line ended with `+`, so that any line continues it.
    """

    def __init__(self) -> None:
        self.reader = Reader("terminal")
        self.command: Command | None = None
        self.asked = False

    @property
    def prompt(self) -> str:
        """The prompt for the next line."""
        return PROMPT if self.reader.pending is None else MORE

    def read(self, line: str) -> list[Statement]:
        """The commands that `line` completes, in order."""
        word = WORD.search(without_comment(line))
        if word is None:
            self.reader.feed(line)
            return [] if WORD.search(line) else self.flush()
        marked = line.lstrip().startswith(CONTINUATION)
        if self.reader.pending is None or not (marked or self.asked or self._continued_by(word.group())):
            self.command = match(COMMANDS, word.group())
        elif not marked:
            line = MORE + line.lstrip()
        self.asked = self._asks(line)
        if self.asked:
            line = without_comment(line).rstrip().removesuffix(CONTINUATION).rstrip()
        before = self.reader.feed(line)
        complete = [] if before is None else [before]
        if self.asked or (self.command is not None and self.command.extends):
            return complete
        return complete + self.flush()

    def flush(self) -> list[Statement]:
        """The pending command, if any: no line will continue it."""
        self.asked = False
        last = self.reader.flush()
        return [] if last is None else [last]

    def _continued_by(self, word: str) -> bool:
        """True if a line that begins with `word` continues the pending command."""
        if self.command is None or match(COMMANDS, word) is not None:
            return False
        return word[0] in NUMERIC or match(self.command.words, word) is not None

    def _asks(self, line: str) -> bool:
        """True if `line` ends with a `+` that is not part of a file name or another text."""
        if self.command is not None and self.command.text:
            return False
        text = without_comment(line).strip()
        return text.endswith(CONTINUATION) and text != CONTINUATION


def history_file() -> Path:
    """The file with the lines typed in earlier sessions."""
    return Path(user_state_dir("udec_ia", appauthor=False)) / "history"


@contextmanager
def history(path: Path, model: Any = None) -> Iterator[None]:
    """Let arrow keys bring back earlier lines and the tab key complete words, if Python has readline.

    model: whose groups are completed.
    """
    try:
        import readline
    except ImportError:
        yield
        return
    with suppress(OSError):
        readline.read_history_file(path)
    readline.set_history_length(HISTORY_LENGTH)
    readline.set_completer_delims(DELIMITERS)
    readline.set_completer(_Completer(model, readline))
    of_libedit = "libedit" in (readline.__doc__ or "")
    readline.parse_and_bind("bind ^I rl_complete" if of_libedit else "tab: complete")
    try:
        yield
    finally:
        readline.set_completer(None)
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            readline.write_history_file(path)


class _Completer:
    """What readline asks for the word at the cursor: one completion after the other, then None."""

    def __init__(self, model: Any, readline: Any) -> None:
        self.model, self.readline = model, readline
        self.found: list[str] = []

    def __call__(self, typed: str, number: int) -> str | None:
        if number == 0:
            before = self.readline.get_line_buffer()[: self.readline.get_begidx()]
            self.found = completions(self.model, before, typed)
        return self.found[number] if number < len(self.found) else None
