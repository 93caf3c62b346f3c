"""A listing on a terminal, in colours by kind of group and folded to its width.

Rows under the heading of a group have the colour of its kind, and so has a name such as corner@412. Junk is
dim; pointers and numbers that are not allowed are red. There are no colours where NO_COLOR is set or the
terminal has none.
"""

from __future__ import annotations

import re
from functools import partial
from textwrap import wrap
from typing import TextIO

from rich.console import Console
from rich.style import Style
from rich.text import Text

from udec_ia.heap_tools.memory_use import PICTURE
from udec_ia.printable_text import visible
from udec_ia.reader.field_rows import NOT_ALLOWED
from udec_ia.reader.kind_colours import COLOURS, LETTERS
from udec_ia.reader.printed_listing import Line, Listing, Tables
from udec_ia.reader.word_map import IS_NO, JUNK, KINDS, NOTHING, UNUSED

ROOM = 20  # characters that the last column must have, to be folded within itself
INDENT = 13  # characters before what has no room beside the rest
STYLES = {kind: Style(color=colour, dim=kind in (JUNK, UNUSED)) for kind, colour in COLOURS.items()}
NAME = re.compile(rf"\b({'|'.join((*KINDS, JUNK))})@\d+")
WRONG = re.compile(rf"{IS_NO}({'|'.join(KINDS)}|group)( or [a-z]+)*$|^{NOT_ALLOWED}, |\bno block\b")
BOLD, RED = Style(bold=True), Style(color=COLOURS[NOTHING], bold=True)
LETTER_STYLES = {c: STYLES[kind] for kind, letter in LETTERS.items() for c in (letter, letter.upper())}


def show(listing: Listing | Tables, stream: TextIO) -> None:
    """Print a listing to a terminal."""
    console = Console(file=stream, highlight=False, markup=False, emoji=False)
    coloured = console.color_system is not None and not console.no_color
    picture = PICTURE in listing.columns
    for line in listing.lines():
        line = line._replace(text=visible(line.text))
        for text, last in _folded(line, max(console.width, 2 * ROOM)):
            console.print(_coloured(text, last, line, picture) if coloured else text, soft_wrap=True)


def _folded(line: Line, width: int) -> list[tuple[str, int]]:
    """A line in pieces that fit the width, each with the place where what is in its last column begins.

    The last column is folded within itself, or placed below the others if there is no room for it.
    """
    if len(line.text) <= width:
        return [(line.text, line.last)]
    fold = partial(wrap, replace_whitespace=False, break_on_hyphens=False)
    if not line.last:
        return [(text, 0) for text in fold(line.text, width)]
    before, text = line.text[: line.last].rstrip(), line.text[line.last :]
    if line.last + ROOM <= width:
        first, *others = fold(text, width - line.last)
        return [
            (f"{before:{line.last}}{first}", line.last),
            *((" " * line.last + one, line.last) for one in others),
        ]
    below = fold(" " * INDENT + text, width, subsequent_indent=" " * INDENT)
    return [(one, len(one)) for one in fold(before, width)] + [(one, INDENT) for one in below]


def _coloured(text: str, last: int, line: Line, picture: bool) -> Text:
    """A piece of a line with its styles. last: where what is in its last column begins."""
    base = next((style for name, style in STYLES.items() if line.heading.startswith(name)), Style())
    found = Text(text, base + BOLD if text == line.heading else base)
    for match in NAME.finditer(text):
        found.stylize(STYLES[match[1]], *match.span())
    if WRONG.search(line.text[line.last :]):
        found.stylize(RED, last)
    if picture and line.last:
        for place in range(last, len(text)):
            found.stylize(LETTER_STYLES.get(text[place], Style()), place, place + 1)
    return found
