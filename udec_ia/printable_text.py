"""Text from files and users, made safe to print.

A terminal obeys escape sequences, and a name in a file can contain them, or characters that reverse the line,
or bytes that are not text. All that is not visible becomes an escape, as Python writes it, and a long name is
cut. Sentences are folded to the width of a terminal.
"""

from __future__ import annotations

from textwrap import TextWrapper

NAME = 100  # characters of a foreign name
WIDTH, INDENT = 80, "    "  # columns of a line, and what is before what does not fit
MESSAGE = 2000  # characters of a whole message, which may contain paths of the user


def printable(text: str, limit: int = NAME) -> str:
    """The first `limit` characters of `text`, on one line."""
    cut = text if len(text) <= limit else f"{text[:limit]}..."
    return _escaped(cut)


def visible(text: str) -> str:
    """All lines of `text`, with escapes for characters that are not visible."""
    return "\n".join(map(_escaped, text.split("\n")))


def _escaped(line: str) -> str:
    if line.isprintable():
        return line
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in line)


def folded(text: str) -> str:
    """`text` folded to the width of a terminal."""
    return "\n".join(_folded(line) for line in text.split("\n"))


def _folded(line: str) -> str:
    if len(line) <= WIDTH:
        return line
    bare = line.lstrip(" ")
    first = " " * (len(line) - len(bare))
    words = TextWrapper(WIDTH, first, first + INDENT, break_long_words=False, break_on_hyphens=False)
    return words.fill(bare)


def counted(n: int, what: str, form: str = "") -> str:
    """`n` and the noun `what`, in the plural unless `n` is 1. form: of `n`, such as "," for thousands."""
    plural = f"{what[:-1]}ies" if what.endswith("ry") else f"{what}s"
    return f"{n:{form}} {what if n == 1 else plural}"


def is_of_notebook(stream: object) -> bool:
    """True for the output of a cell in Jupyter."""
    return type(stream).__module__.partition(".")[0] == "ipykernel"
