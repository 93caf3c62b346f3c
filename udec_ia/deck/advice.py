"""What an error tells the user besides its number: where it arose, what to do, what may have been meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from udec_ia.deck.reader import Token
from udec_ia.errors import UdecError

SHOWN = 40  # characters of a word that are worth repeating
WIDTH = 200  # longer lines are shown up to the place of the error, and not at all if it is beyond


def at(error: UdecError, place: Token) -> UdecError:
    """`error`, telling that it arose at `place`."""
    error.file, error.line, error.column = place.line.file, place.line.number, place.column
    error.token = place.text
    if place.column <= WIDTH:
        shown = place.line.shown
        error.source = shown if len(shown) <= WIDTH else shown[: place.column + SHOWN] + " ..."
    return error


def quoted(text: str) -> str:
    """`text` in quotes, cut off when it is very long, harmless to print."""
    shown = "".join(c if c.isprintable() else "?" for c in text[:SHOWN])
    return f'"{shown}{"..." if len(text) > SHOWN else ""}"'


def hint(typed: str, keywords: Iterable[str], advice: str) -> str:
    """`advice`, behind `did you mean PROPERTY?` if one of `keywords` comes near to what was typed."""
    near = difflib.get_close_matches(typed[:SHOWN].upper(), [k.upper() for k in keywords], n=1, cutoff=0.5)
    return f"did you mean {near[0]}? {advice}" if near else advice
