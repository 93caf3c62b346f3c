"""The monitor: it executes the commands of a deck on a model, one after the other (MON, III-3).

It echoes every line behind a `>`, calls the method of Model that has the command's name, and prints what the
method returns. Errors get their place in the deck. A run that ends in an error saves its state first.
"""

from __future__ import annotations

import io
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

from udec_ia.deck.command_forms import RUNS, Counts, match
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import WORD, Line, Statement, at, limited, open_deck, statements, tokens
from udec_ia.deck.deck_variables import Values, Variables
from udec_ia.deck.lines_and_calls import NUMBER, Call, parse
from udec_ia.deck.udec7_words import Reading, read_line
from udec_ia.errors import DAMAGED, UdecError
from udec_ia.heap.accessors import HEAD, iget
from udec_ia.interrupt_signals import allow_signals, defer_signals, poll
from udec_ia.layout import offsets as g
from udec_ia.printable_text import counted, printable, visible
from udec_ia.reader.list_walks import groups

FILE_NAME = re.compile(r".*\S\.[A-Za-z]\w*")
RESTART_FILE = "restart.h5"  # of SAVE and RESTART without a name, in the folder for files
DEEPEST = 10  # decks that call one another
RESCUE = "rescue.h5"  # restart file of a run that ended early, in the folder for files


class Monitor:
    """Executes statements on `model`, a Model, and writes to `out`.

    echo: False at a terminal. ended: True after STOP or END. values: of variables.
    """

    def __init__(self, model: Any, out: TextIO, *, echo: bool = True, values: Values | None = None) -> None:
        self.model = model
        self.out = out
        self.echo = echo
        self.variables = Variables(values)
        self.ended = False
        self._stopped = False
        self._called = 0  # decks that are being called
        self._reads_as = False  # a line is being executed in our words, which is not read as UDEC 7 once more

    def run(self, lines: Iterable[str], file: str) -> None:
        """Execute the deck `lines`, which errors call `file`, up to STOP, END or the last line.

        An exception that ends it names the restart file of the state: UdecError in `saved`, KeyboardInterrupt
        in its argument, others in a note.
        """
        with defer_signals():  # no signal comes between what ends the run and its rescue
            try:
                for statement in self.variables.filled(statements(_awaited(lines), file)):
                    self.execute(statement)
                    if self.ended:
                        return
                    poll()
            except UdecError as error:
                error.saved = self.rescue(sound=error.number != DAMAGED)
                raise
            except KeyboardInterrupt as interrupt:
                raise type(interrupt)(self.rescue()) from None
            except BrokenPipeError:
                raise
            except BaseException as failure:
                failure.add_note(f"the results so far are saved in {self.rescue()}")
                raise

    def execute(self, statement: Statement) -> None:
        """Echo and execute one statement without variables. Raises UdecError with its place."""
        if self.echo:
            for line in statement.lines:
                self._write(f"> {line.shown}".rstrip())
        if not statement.tokens:
            return
        try:
            call = parse(statement)
        except UdecError as error:
            self._read_as_udec_7(statement, error)
            return
        name = call.command.name
        if name == "call":
            self._run_called(call)
            return
        if not (call.command.opens or self.model.session.started):
            raise at(UdecError(3, f"this is {name.upper()}"), call.head)
        try:
            result = self.model.whole(lambda: self._carry_out(call, statement))
        except MemoryError as error:
            stays = "the results so far are kept" if call.command.kind is RUNS else "nothing was changed"
            advice = f"use a smaller model, or a machine with more memory;  {stays}"
            raise at(UdecError(1, "this machine is out of memory", advice), call.head) from error
        except UdecError as error:
            raise at(error, call.place_of(error)) from error.__cause__
        except BrokenPipeError:
            raise
        except OSError as error:
            refused = UdecError(31, f"{error.strerror or error}: {error.filename or name}")
            raise at(refused, call.place_of(refused)) from error
        if call.command.counts is not None and isinstance(result, int):
            self._write(outcome(call, call.command.counts, result, self.model))
        found_nothing = isinstance(result, list) and not result
        self.show(call.command.when_empty or None if found_nothing else result)

    def _has_zones(self) -> bool:
        """True if there is a fully-deformable block."""
        h = self.model.array.h
        return any(iget(h, ib, HEAD) == g.MFDEF for ib in groups(h, "block"))

    def _read_as_udec_7(self, statement: Statement, error: UdecError) -> None:
        """Execute a line in the words of UDEC 7; `error`, perhaps with an answer, if it is none."""
        found = None if self._reads_as else read_line(statement.tokens, self._has_zones)
        if not isinstance(found, Reading):
            if found is not None:
                error.advice = found.text
            raise error
        first, remark = statement.tokens[0].line, f"; {found.remark}" if found.remark else ""
        for text in found.lines or ("a comment",):
            self._write(f" read as: {text}{remark}")
            remark = ""
        for text in found.lines:
            line = Line(first.file, first.number, text)
            echo, self.echo, self._reads_as = self.echo, False, True
            try:
                self.execute(Statement([line], tokens(line)))
            finally:
                self.echo, self._reads_as = echo, False

    def _run_called(self, call: Call) -> None:
        """CALL: execute another deck up to its end, or to RETURN, STOP or END in it."""
        path = Path(call.head.line.file).parent / str(call.named["path"])
        if self._called >= DEEPEST:
            deep = UdecError(28, f"more than {DEEPEST} decks call one another")
            raise at(deep, call.place_of(deep))
        self._called += 1
        try:
            with open_deck(path) as lines:
                for statement in self.variables.filled(statements(limited(lines, str(path)), str(path))):
                    if statement.tokens and statement.tokens[0].text.upper() == "RETURN":
                        return
                    self.execute(statement)
                    if self.ended:
                        return
                    poll()
        except OSError as error:
            refused = UdecError(29, f"{path}: {error.strerror or error}", "give the name of a deck")
            raise at(refused, call.place_of(refused)) from error
        finally:
            self._called -= 1

    def stop(self) -> None:
        """End the run, as STOP does, if it was started and has not ended.

        If pictures cannot be written, this is reported and the summary is printed before the error is raised.
        """
        if not self.model.session.started or self._stopped:
            return
        self._stopped = True
        try:
            last = self.model.stop()
        except BaseException as failure:
            self._write(f"not all pictures were written: {str(failure) or 'interrupted'}")
            self.show(self.model.summary())
            raise
        self.show(last)

    def _carry_out(self, call: Call, statement: Statement) -> object:
        """Execute `call` and log its lines. Returns what is to be shown."""
        result = self._call(call)
        lines = dict.fromkeys(token.line for token in statement.tokens)
        if call.command.name != "default":  # logged lines have values instead of variables
            self.model.session.log_lines([line.shown for line in lines])
        return result

    def _call(self, call: Call) -> object:
        name = call.command.name
        if name == "default":  # done when the variables were replaced
            return None
        if call.command.ends:
            self.ended = True
            if name == "stop":
                self.stop()
            return None
        named = dict(call.named)
        place = self.place(name, named.get("path"), call.head.line.file)
        if place is not None:
            named["path"] = place
        if "/" in str(named.get("since", "")):  # a restart file, or a stage in a file of stages
            named["since"] = str(self.place(name, str(named["since"]), call.head.line.file))
        session = self.model.session
        before = session.tell, session.inform, session.explain_step, session.logs_calls
        session.explain_step, session.logs_calls = True, False
        session.tell = lambda text: self.warn(name, text)
        session.inform = lambda text: self._write(f" {name.upper()}: {text}")
        try:
            return getattr(self.model, name)(*call.positional, **named)
        finally:
            session.tell, session.inform, session.explain_step, session.logs_calls = before

    def warn(self, command: str, text: str) -> None:
        """Write a warning of a command."""
        self._write(f" {command.upper()}: {text}")

    def place(self, command: str, name: str | None, deck: str) -> Path | None:
        """The path of the file `name`: to be read in the folder of the deck, else in that for files.

        command: for monitors that look for the files of some commands elsewhere. deck: the file of its line.
        """
        if name is None:
            return None
        if command in ("function", "fractures"):
            return Path(deck).parent / name
        folder = self.model.session.out
        # no system resolves `..` behind a folder that does not exist yet
        return folder / name if folder.exists() else Path(os.path.normpath(folder / name))

    def show(self, result: object) -> None:
        """Write what a command returned: names of files, or text; numbers are for Python only."""
        if isinstance(result, Path):
            self._write(f"written: {printable(str(result))}")
        elif isinstance(result, list):
            for one in result:
                self.show(one)
        elif result is not None and not isinstance(result, int):
            self._write(str(result))

    def _write(self, text: str) -> None:
        self.out.write(visible(text) + "\n")
        self.out.flush()

    def rescue(self, *, sound: bool = True) -> str | None:
        """Save the state, by force if it is not sound, and end the run. Returns the name of the restart file.

        The file is read again and proved. A failure here must not hide the error before it. The file is
        written even if Ctrl-C is pressed several times; then only the pictures are omitted.
        """
        if not self.model.session.started:
            return None
        saved = None
        with suppress(Exception, KeyboardInterrupt), defer_signals():
            try:
                with defer_signals(also_second=True):
                    path = self._save(sound)
                saved = self._proved(path)
            except Exception as failure:
                self._write(f"the state could not be saved: {failure}")
            self.stop()
        return saved

    def _save(self, sound: bool) -> Any:
        """Save the state as RESCUE, by force if it is not sound."""
        path = (self.model.session.out / RESCUE).absolute()
        if sound:
            try:
                return self.model.save(path)
            except UdecError as error:
                if error.number != DAMAGED:
                    raise
        return self.model.save(path, force=True)

    def _proved(self, path: Path) -> str:
        """The name of the restart file `path`; reports the first violation in it."""
        try:
            violations = self.model.check_file(path)
        except KeyboardInterrupt:
            self._write(f"{path} was written, but the check by reading it again was interrupted")
            raise
        for violation in violations[:1]:
            self._write(f"the saved state is for inspection only: {violation}")
        return str(path)


def _awaited(lines: Iterable[str]) -> Iterator[str]:
    """`lines`; waiting for one can be interrupted."""
    source = iter(lines)
    while True:
        with allow_signals():
            line = next(source, None)
        if line is None:
            return
        yield line


def run_deck(
    model: Any,
    deck: str | Path | TextIO,
    out: TextIO,
    values: Values | None = None,
    name: str = "text",
) -> Monitor:
    """Execute a whole deck on `model`, a Model. Returns the monitor.

    deck: path, text or stream; a str is a path if a file has this name, or if it looks like a file name.
    values: of its variables, by name. name: of a text or a stream, for errors. Raises UdecError, and OSError
    if the file cannot be read.
    """
    monitor = Monitor(model, out, values=values)
    if not isinstance(deck, str | Path):
        _run_whole(monitor, deck, name)
    elif isinstance(deck, Path) or os.path.isfile(deck) or names_a_file(deck):
        with open_deck(deck) as lines:
            _run_whole(monitor, lines, str(deck))
    else:
        _run_whole(monitor, io.StringIO(deck, newline=None), name)
    return monitor


def _run_whole(monitor: Monitor, lines: TextIO, file: str) -> None:
    """Have the monitor execute a deck after a check of all its variables.

    Lines of a pipe are executed as they come, without the check, unless values are given.
    """
    if lines.seekable() or monitor.variables.given:
        lines = io.StringIO("".join(limited(lines, file)))
        monitor.variables.check(lines, file)
        lines.seek(0)
    session = monitor.model.session
    session.pictures_wait = lines.seekable()
    try:
        monitor.run(limited(lines, file), file)
    finally:
        session.pictures_wait = False
    monitor.show(session.write_rest_of_pictures())


def names_a_file(text: str) -> bool:
    """True if `text` is one line that begins with no command and ends like a file name, as in `.dat`."""
    if FILE_NAME.fullmatch(text) is None or match(COMMANDS, text.split()[0]):
        return False
    return NUMBER.fullmatch(WORD.findall(text)[-1]) is None


def outcome(call: Call, counts: Counts, n: int, model: Any) -> str:
    """One line: what `call`, which returned `n`, has done, or why it has done nothing."""
    name = call.command.name
    word, thing = counts.with_word
    if call.named.get(word) is None:
        thing = counts.thing
    if n == 0:
        if thing != counts.thing:  # why_none is about blocks
            return f" {name.upper()}: no {thing} in range"
        return f" {name.upper()}: {counts.none}: {model.why_none(name, *call.positional[:4])}"
    now = f", {counted(int(model.h.ci[g.NBLK]), 'block')} now" if counts.of_all else ""
    return f" {name.upper()}: {counted(n, thing)} {counts.done}{now}"
