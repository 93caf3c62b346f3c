"""How many there are of something, in words: 1 contact, 2 contacts."""

from __future__ import annotations


def counted(n: int, what: str, form: str = "") -> str:
    """`n` and the noun `what`, with an s unless `n` is 1. form: of the number, such as "," for thousands."""
    return f"{n:{form}} {what}" + ("" if n == 1 else "s")
