"""Text of others, made safe to print.

A terminal obeys what it is sent. A name out of a file can hold escape sequences, marks that turn the line
round, or bytes that are no text, and it can be as long as it likes: all that is not plainly visible becomes
an escape, as Python writes it, and the end of what is long is left out.
"""

from __future__ import annotations

NAME = 100  # characters of a name that somebody else has chosen
MESSAGE = 2000  # characters of a whole message, in which there may be paths of the user's own


def printable(text: str, limit: int = NAME) -> str:
    """The first `limit` characters of `text`, each of which takes its place on a line."""
    cut = text if len(text) <= limit else f"{text[:limit]}..."
    if cut.isprintable():
        return cut
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in cut)
