"""From lines to statements: comments, continuation lines and separators (TIDY and SEP, Appendix III-3).

A statement is one command with all its continuation lines, as a list of tokens, each with its file, line and
column. A command is complete when the line after it does not continue it: this is why the report requires
one more line after STOP.
"""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple, TextIO

from udec_ia.errors import UdecError
from udec_ia.printable_text import printable

SEPARATORS = "=(),/"
WORD = re.compile(rf"<|[^\s<{re.escape(SEPARATORS)}]+")
COMMENTS = "*;#!"  # a line that begins with one of them is a comment
REMARK = re.compile("[;#!]")  # begins a comment behind a command; the * of 1980 does not
CONTINUATION = "+"
GOES_ON = re.compile(r"(?:&|\.\.\.)\s*$")  # at the end of a line: the next one continues it, as in UDEC 7
LARGEST = 100_000_000  # characters of a deck
SHOWN = 40  # characters of a word that are repeated in a message
WIDTH = 200  # longer lines are shown up to the place of the error, or not at all if it is beyond


class Put(NamedTuple):
    """A value that replaced a variable: columns first to end - 1, of the variable from at to after - 1."""

    first: int
    end: int
    at: int
    after: int


@dataclass(frozen=True)
class Line:
    """One line of a deck. number counts from 1.

    written: the line with its variables, if values have replaced them; put_in: these values, in order.
    """

    file: str
    number: int
    text: str
    written: Line | None = None
    put_in: tuple[Put, ...] = ()

    @property
    def shown(self) -> str:
        """The line with one printable character for each of its characters."""
        if self.text.isprintable():
            return self.text
        return "".join(c if c.isprintable() else " " if c.isspace() else "?" for c in self.text)

    def as_written(self, column: int) -> tuple[Line, int]:
        """The line with its variables, and the column there that corresponds to `column` here."""
        shift = 0
        for put in self.put_in:
            if column < put.first:
                break
            if column < put.end:
                return self.written or self, put.at
            shift = put.after - put.end
        return self.written or self, column + shift


@dataclass(frozen=True)
class Token:
    """A word or number of a deck, and its place. column counts from 1."""

    text: str
    line: Line
    column: int

    @property
    def end(self) -> int:
        """The column just after the token."""
        return self.column + len(self.text)


@dataclass
class Statement:
    """A command: its tokens, and all its lines with the comments between them."""

    lines: list[Line]
    tokens: list[Token] = field(default_factory=list)


def at(error: UdecError, place: Token) -> UdecError:
    """`error`, with its place: file, line and column as the line was written.

    The column is that of the token, or of a part of the text behind it that the error has as its source.
    """
    begin = place.column
    if error.source is not None and error.column is not None:
        part = place.line.text.find(error.source, place.column - 1)
        begin = part + error.column if part >= 0 else begin
    line, column = place.line.as_written(begin)
    error.file, error.line, error.column = line.file, line.number, column
    error.token = place.text
    if column <= WIDTH:
        error.source = line.shown if len(line.shown) <= WIDTH else line.shown[: column + SHOWN] + " ..."
    return error


def quoted(text: str) -> str:
    """`text` in quotes, shortened if it is very long, with printable characters only."""
    shown = "".join(c if c.isprintable() else "?" for c in text[:SHOWN])
    return f'"{shown}{"..." if len(text) > SHOWN else ""}"'


def without_comment(text: str) -> str:
    """A line without its comment."""
    return "" if text.lstrip()[:1] in tuple(COMMENTS) else REMARK.split(text, 1)[0]


def tokens(line: Line, start: int = 0) -> list[Token]:
    """The words and numbers of `line` from the character `start` on."""
    text = GOES_ON.sub("", without_comment(line.text))
    return [Token(found.group(), line, found.start() + 1) for found in WORD.finditer(text, start)]


def tokens_of(lines: Iterable[Line]) -> list[Token]:
    """The words and numbers of a command with these lines, which may contain comments."""
    found: list[Token] = []
    for line in lines:
        if WORD.search(without_comment(line.text)):
            found += tokens(line, _after_mark(line.text) if found else 0)
    return found


def _after_mark(text: str) -> int:
    """Where a line that continues another begins: behind its +, if it has one."""
    return text.index(CONTINUATION) + 1 if text.lstrip().startswith(CONTINUATION) else 0


class Reader:
    """Joins lines to statements.

    pending: the last command, which may still be continued. Comments and blank lines after it are held back.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self.pending: Statement | None = None
        self._held: list[Line] = []
        self._number = 0

    def feed(self, text: str) -> Statement | None:
        """Read one line. Returns the command before it if the line does not continue it."""
        self._number += 1
        line = Line(self.file, self._number, text)
        if not WORD.search(without_comment(text)):
            self._held.append(line)
            return None
        complete = None
        goes_on = text.lstrip().startswith(CONTINUATION) or self._goes_on()
        if goes_on and self.pending is not None:
            self.pending.lines += [*self._held, line]
            self.pending.tokens += tokens(line, _after_mark(text))
        else:
            complete = self.pending
            self.pending = Statement([*self._held, line], tokens(line))
        self._held = []
        return complete

    def _goes_on(self) -> bool:
        """True if the last line of the pending command ends with a mark of continuation."""
        return self.pending is not None and bool(GOES_ON.search(without_comment(self.pending.lines[-1].text)))

    def flush(self) -> Statement | None:
        """The pending command, or None: no line will continue it."""
        complete, self.pending = self.pending, None
        return complete

    def rest(self) -> Statement | None:
        """Comments and blank lines at the end of the deck, as a statement without tokens."""
        held, self._held = self._held, []
        return Statement(held) if held else None


def limited(lines: Iterable[str] | TextIO, file: str) -> Iterator[str]:
    """The lines of a deck. Error 28 after LARGEST characters: a file or pipe may be endless."""
    left = LARGEST
    read = getattr(lines, "readline", None)
    source = iter(lambda: read(left + 1), "") if read else iter(lines)
    for line in source:
        left -= len(line)
        if left < 0:
            detail = f"{printable(file)} has more than {LARGEST:,} characters, and is no deck"
            raise UdecError(28, detail, "give a file with commands, one to a line")
        yield line


def read_deck(path: str | Path) -> str:
    """The text of the deck in a file. UdecError 28 if it is too long, OSError if it cannot be read."""
    with open_deck(path) as lines:
        return "".join(limited(lines, str(path)))


def open_deck(path: str | Path) -> TextIO:
    """The file of a deck. OSError also for a name that no file can have, such as one with a NUL."""
    try:
        with open(path, "rb") as file:
            is_wide = file.peek(2)[:2] in (b"\xff\xfe", b"\xfe\xff") if os.path.isfile(path) else False
        return open(path, encoding="utf-16" if is_wide else "utf-8-sig", errors="replace")
    except ValueError as error:
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(path)) from error


def statements(lines: Iterable[str], file: str) -> Iterator[Statement]:
    """The statements of a deck, in order. A statement without tokens holds comments only."""
    reader = Reader(file)
    for text in lines:
        complete = reader.feed(text.rstrip("\r\n"))
        if complete is not None:
            yield complete
    for last in (reader.flush(), reader.rest()):
        if last is not None:
            yield last
