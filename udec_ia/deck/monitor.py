"""The monitor: takes the commands of a deck one after the other and has a model obey them (MON, III-3).

It echoes every line behind a `>`, hands the call to the method of Model that has the command's name, and
writes what that method returns. What goes wrong becomes a numbered error with its place in the deck;
in a run the state is then saved, so that nothing that was computed is lost.
"""

from __future__ import annotations

import io
import os
import re
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from offsets.generated import NBLK
from udec_ia.deck.advice import at
from udec_ia.deck.language import COMMANDS, match
from udec_ia.deck.parser import NUMBER, Call, parse
from udec_ia.deck.reader import WORD, Statement, statements
from udec_ia.errors import UdecError

if TYPE_CHECKING:
    from udec_ia.model import Model

DAMAGED = 20  # after this error the main array is not worth saving: RESTART would refuse it
FILE_NAME = re.compile(r".*\S\.[A-Za-z]\w*")
COUNTED = {  # what a command that returns a number has done
    "split": "block cut off",
    "delete": "block deleted",
    "fix": "block fixed",
    "free": "block set free",
    "change": "block changed",
    "insitu": "block stressed",
    "boundary": "condition in the range",
}
NONE = {"split": "no block cut", "boundary": "no condition in range"}
RESCUE = "rescue.h5"  # restart file of a run that was cut short, in the folder for files


class Monitor:
    """Obeys statements on `model` and writes to `out`.

    echo: False where the user sees what he types. ended: True after STOP or END.
    """

    def __init__(self, model: Model, out: TextIO, *, echo: bool = True) -> None:
        self.model = model
        self.out = out
        self.echo = echo
        self.ended = False
        self._stopped = False

    def run(self, lines: Iterable[str], file: str) -> None:
        """Obey the deck `lines`, which errors call `file`, up to STOP, END or the last line.

        Raises UdecError at the first error, and KeyboardInterrupt, after the state has been saved. The
        restart file is named by UdecError.saved, and by the argument of KeyboardInterrupt.
        """
        try:
            for statement in statements(lines, file):
                self.obey(statement)
                if self.ended:
                    return
        except UdecError as error:
            error.saved = self._rescue(sound=error.number != DAMAGED)
            raise
        except KeyboardInterrupt:
            raise KeyboardInterrupt(self._rescue()) from None

    def obey(self, statement: Statement) -> None:
        """Echo and obey one statement. Raises UdecError with its place."""
        if self.echo:
            for line in statement.lines:
                self._write(f"> {line.shown}".rstrip())
        if not statement.tokens:
            return
        call = parse(statement)
        name = call.command.name
        if not (call.command.opens or self.model.started):
            raise at(UdecError(3, f"this is {name.upper()}"), call.head)
        try:
            result = self._carry_out(call)
        except UdecError as error:
            raise at(error, call.place_of(error)) from error.__cause__
        except BrokenPipeError:
            raise
        except OSError as error:
            refused = UdecError(31, f"{error.strerror or error}: {error.filename or name}")
            raise at(refused, call.place_of(refused)) from error
        if name in COUNTED and isinstance(result, int):
            self._write(counted(name, result, self.model))
        self._show(result)
        self.model.deck_log += [
            line.shown for line in dict.fromkeys(token.line for token in statement.tokens)
        ]

    def stop(self) -> None:
        """End the run, as STOP does, if a run was started and has not been ended.

        What cannot be written is told, and the summary written all the same, before the error is raised.
        """
        if not self.model.started or self._stopped:
            return
        self._stopped = True
        try:
            last = self.model.stop()
        except BaseException as failure:
            self._write(f"not all pictures were written: {str(failure) or 'interrupted'}")
            self._show(self.model.summary())
            raise
        self._show(last)

    def _carry_out(self, call: Call) -> object:
        """Obey `call`; what is returned is to be shown."""
        name = call.command.name
        if name in ("stop", "end"):
            self.ended = True
            if name == "stop":
                self.stop()
            return None
        named = dict(call.named)
        if "path" in named:  # files named in a deck are in the folder for files
            named["path"] = self.model.out / named["path"]
        model = self.model
        before = model.tell, model.inform, model.explain_step
        model.explain_step = True
        model.tell = model.inform = lambda text: self._write(f" {name.upper()}: {text}")
        try:
            return getattr(model, name)(*call.positional, **named)
        finally:
            model.tell, model.inform, model.explain_step = before

    def _show(self, result: object) -> None:
        """Write what a command returned: text, names of files, or what has a text; numbers are for Python."""
        if isinstance(result, Path):
            self._write(f"written: {result}")
        elif isinstance(result, list):
            for one in result:
                self._show(one)
        elif result is not None and not isinstance(result, int):
            self._write(str(result))

    def _write(self, text: str) -> None:
        self.out.write(text + "\n")
        self.out.flush()

    def _rescue(self, *, sound: bool = True) -> str | None:
        """Save the state if it is sound, and end the run. Returns the name of the restart file.

        A failure here must not hide what has gone wrong before.
        """
        if not self.model.started:
            return None
        saved = None
        if sound:
            try:
                saved = str(self.model.save((self.model.out / RESCUE).absolute()))
            except Exception as failure:
                self._write(f"the state could not be saved: {failure}")
        with suppress(Exception):  # stop has told it
            self.stop()
        return saved


def run_deck(model: Model, deck: str | Path, out: TextIO) -> Monitor:
    """Obey a whole deck on `model` and return the monitor that did.

    deck: the path of a deck, or its text; a str is a path if there is a file of that name, or if it looks
    like one. Raises UdecError, and OSError if the file cannot be read.
    """
    monitor = Monitor(model, out)
    if isinstance(deck, Path) or os.path.isfile(deck) or _names_a_file(deck):
        with open(deck, encoding="utf-8-sig", errors="replace") as lines:
            monitor.run(lines, str(deck))
    else:
        monitor.run(io.StringIO(deck, newline=None), "text")
    return monitor


def _names_a_file(text: str) -> bool:
    """True if `text` is one line that begins with no command and ends like the name of a file: in `.dat`."""
    if FILE_NAME.fullmatch(text) is None or match(COMMANDS, text.split()[0]):
        return False
    return NUMBER.fullmatch(WORD.findall(text)[-1]) is None


def counted(name: str, n: int, model: Model) -> str:
    """One line on what the command `name`, which returned `n`, has done."""
    if n == 0:
        return f" {name.upper()}: {NONE.get(name, 'no block in range')}"
    now = f", {model.h.ci[NBLK]} blocks now" if name in ("split", "delete") else ""
    what, _, done = COUNTED[name].partition(" ")
    return f" {name.upper()}: {n} {what}{'s' if n > 1 else ''} {done}{now}"
