"""A listing: a few sentences and a table, as text, JSON or Python objects.

Text and JSON are made line by line, so that a table of millions of rows needs no memory.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import chain
from math import isfinite
from typing import Any, NamedTuple

INDENT = "  "  # of rows under a heading
LINES = ("line",)  # columns of a listing whose rows are whole lines, as they are


class Stream:
    """Rows that are made as they are asked for, and each time anew."""

    def __init__(self, make: Callable[[], Iterator[tuple[Any, ...]]]) -> None:
        self.make = make

    def __iter__(self) -> Iterator[tuple[Any, ...]]:
        return self.make()


class Line(NamedTuple):
    """One line. heading: that it is or stands under, "" for none; last: where its last column begins."""

    text: str
    heading: str = ""
    last: int = 0


class Listing(NamedTuple):
    """head: sentences above the table. columns: names of the columns; rows: text or numbers in them.

    status: exit status of a command that prints this. widths: of the columns, negative for what stands on the
    left; () where they follow from the rows. headed: the first column stands above the rows that have it.
    """

    head: list[str]
    columns: tuple[str, ...] = ()
    rows: Iterable[tuple[Any, ...]] = ()
    status: int = 0
    widths: tuple[int, ...] = ()
    headed: bool = False

    def as_json(self) -> str:
        """One object: `head`, and `rows` as objects by the names of the columns; NaN and infinity as text."""
        return "".join(self.json())

    def json(self) -> Iterator[str]:
        """The same in pieces, a row to a line."""
        yield f'{{"head": {json.dumps(self.head)},\n "rows": ['
        before = "\n"
        for row in self.rows:
            named = dict(zip(self.columns, map(_plain, row), strict=True))
            yield f"{before}  {json.dumps(named, allow_nan=False)}"
            before = ",\n"
        yield "]}"

    def as_text(self) -> str:
        """The sentences, and the columns beside each other: numbers to the right, the rest to the left."""
        return "".join(f"{line.text}\n" for line in self.lines())

    def lines(self) -> Iterator[Line]:
        """The same line by line."""
        yield from map(Line, self.head)
        if self.columns == LINES:
            yield from (Line(row[0]) for row in self.rows)
            return
        rows = iter(self.rows)
        first = next(rows, None)
        if first is None:
            return
        widths = self.widths or self._widths()
        form, last = self._form(widths)
        yield Line((form(tuple(map(type, self.columns))) % self.columns).rstrip(), "", last)
        heading = ""
        for row in chain([first], rows):
            if self.headed and row[0] != heading:
                heading = row[0]
                yield Line(heading, heading)
            yield Line((form(tuple(map(type, row))) % row).rstrip(), heading, last)

    def with_head(self, head: list[str]) -> Listing:
        """The same with more sentences."""
        return self._replace(head=self.head + head)

    def _form(self, widths: tuple[int, ...]) -> tuple[Callable[[tuple[type, ...]], str], int]:
        """Gives how rows of some types are printed, as for %; and where the last column begins."""
        skip = int(self.headed)
        start = "%.0s" + INDENT if self.headed else ""  # a heading stands above

        @cache
        def form(types: tuple[type, ...]) -> str:
            cells = zip(widths[skip:], types[skip:], strict=True)
            return start + "  ".join(f"%{w}.7g" if issubclass(t, float) else f"%{w}s" for w, t in cells)

        return form, len(INDENT) * skip + sum(abs(w) + 2 for w in widths[skip:-1])

    def _widths(self) -> tuple[int, ...]:
        """What the rows need."""
        columns = list(zip(*self.rows, strict=True))
        wide = [
            max(len(name), *(len(_cell(cell)) for cell in column))
            for name, column in zip(self.columns, columns, strict=True)
        ]
        words = [any(isinstance(cell, str) and cell for cell in column) for column in columns]
        return tuple(-w if left else w for w, left in zip(wide, words, strict=True))


class Tables(NamedTuple):
    """Listings by name, one below the other. status: exit status of a command that prints them."""

    parts: dict[str, Listing]
    status: int = 0
    columns: tuple[str, ...] = ()  # none that all of them have

    def as_text(self) -> str:
        """As of a Listing."""
        return "".join(f"{line.text}\n" for line in self.lines())

    def lines(self) -> Iterator[Line]:
        """The same line by line."""
        for listing in self.parts.values():
            yield from listing.lines()

    def with_head(self, head: list[str]) -> Tables:
        """The same with more sentences in the first of them."""
        first, *_ = self.parts
        return self._replace(parts=self.parts | {first: self.parts[first].with_head(head)})

    def as_json(self) -> str:
        """One object: each listing by its name."""
        return "".join(self.json())

    def json(self) -> Iterator[str]:
        """The same in pieces."""
        before = "{"
        for name, listing in self.parts.items():
            yield f"{before}{json.dumps(name)}:\n"
            yield from listing.json()
            before = ",\n"
        yield "}"


def _plain(value: Any) -> Any:
    value = value.item() if hasattr(value, "item") else value
    return str(value) if isinstance(value, float) and not isfinite(value) else value


def _cell(value: Any) -> str:
    return f"{value:.7g}" if isinstance(value, float) else str(value)
