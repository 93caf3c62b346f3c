"""Commands typed at a terminal: a prompt, a history, and errors that do not end the session.

Each command is obeyed when its line ends. Only those that take a list, BLOCK and GENERATE, ask for
more lines behind a `+`, until an empty one.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from udec_ia.deck.language import COMMANDS, match
from udec_ia.deck.monitor import Monitor
from udec_ia.deck.reader import CONTINUATION, Reader, Statement
from udec_ia.errors import UdecError

if TYPE_CHECKING:
    from udec_ia.model import Model

PROMPT = "> "
MORE = f"{CONTINUATION} "
GREETING = "Type START to begin, HELP for the commands, STOP to leave."
HISTORY_LENGTH = 1000


def converse(model: Model, out: TextIO, ask: Callable[[str], str] = input) -> None:
    """Obey what is typed until STOP, END or the end of input. ask: shows a prompt and returns a line."""
    monitor = Monitor(model, out, echo=False)
    reader = Reader("terminal")
    print(GREETING, file=out)
    while not monitor.ended:
        try:
            statement = _statement(reader, ask(PROMPT if reader.pending is None else MORE))
            if statement is not None:
                monitor.obey(statement)
        except UdecError as error:
            if monitor.ended:  # it was STOP that failed: the run has gone wrong
                raise
            print(error, file=out)
        except KeyboardInterrupt:
            reader.flush()
            print("\ninterrupted", file=out)
        except EOFError:
            print(file=out)
            break
    monitor.stop()


def _statement(reader: Reader, typed: str) -> Statement | None:
    """The command that is complete with the line `typed`, or None if lines are wanted."""
    blank = not typed.strip()
    if reader.pending is not None and not blank:
        reader.feed(MORE + typed.lstrip(MORE))
        return None
    reader.feed(typed)
    if not blank and reader.pending is not None:
        command = match(COMMANDS, reader.pending.tokens[0].text)
        if command is not None and command.extends:
            return None
    return reader.flush()


def history_file() -> Path:
    """Where the lines typed in earlier sessions are kept."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home())) / "udec_ia" / "history"
    return Path(os.environ.get("XDG_STATE_HOME", Path.home() / ".local" / "state")) / "udec_ia" / "history"


@contextmanager
def history(path: Path) -> Iterator[None]:
    """Let the arrow keys bring back earlier lines, where Python has the readline module."""
    try:
        import readline
    except ImportError:
        yield
        return
    with suppress(OSError):
        readline.read_history_file(path)
    readline.set_history_length(HISTORY_LENGTH)
    try:
        yield
    finally:
        with suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            readline.write_history_file(path)
