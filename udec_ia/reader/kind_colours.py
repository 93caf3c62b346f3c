"""A letter and a colour for each kind of group, the same in every picture."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import cycle
from string import ascii_lowercase, ascii_uppercase

from udec_ia.reader.word_map import JUNK, KINDS, NOTHING, UNUSED

PALETTE = (  # dark enough for paper, light enough for a dark terminal
    "#b0762b",
    "#d1495b",
    "#7a5bc9",
    "#2a8fbd",
    "#5f9e3a",
    "#2f9e7d",
    "#93a12c",
    "#c56aa8",
    "#8a8f98",
    "#e08a3c",
    "#4f74d9",
    "#43a9a3",
    "#a8577e",
    "#b04de0",
    "#6f7d2a",
    "#c2742f",
    "#5b8fd6",
    "#b5485f",
    "#3d7ea6",
    "#7c8f3a",
    "#9a6fb0",
    "#4d8a5a",
    "#d17fb0",
    "#7d5a3c",
    "#2e6f6a",
    "#c9a227",
    "#5a5aa8",
    "#a33c3c",
    "#6b9bb8",
    "#8f4f9e",
    "#4c7a2f",
)
COLOURS = {
    **dict(zip(KINDS, cycle(PALETTE), strict=False)),
    JUNK: "#9c968c",
    NOTHING: "#e0201b",
    UNUSED: "#e9e6df",
}


def _letters(kinds: Iterable[str]) -> dict[str, str]:
    """A letter for each kind: of those of its name the first that no kind before it has, else a capital."""
    found: dict[str, str] = {}
    for kind in kinds:
        found[kind] = next(c for c in (*kind, *ascii_lowercase, *ascii_uppercase) if c not in found.values())
    return found


LETTERS = {**_letters(KINDS), JUNK: "-", NOTHING: "?", UNUSED: "."}
