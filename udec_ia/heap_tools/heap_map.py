"""The heap as a map: what the words of each stretch belong to, stretch by stretch as one reads."""

from __future__ import annotations

from textwrap import wrap
from typing import Any

import numpy as np

from udec_ia.reader.atlas import NAMES, UNUSED, Atlas
from udec_ia.reader.kind_colours import LETTERS
from udec_ia.reader.listing import Listing

ACROSS, DOWN, WIDTH = 64, 24, 80  # characters of a map, and of a line
PIECE = 2**20  # words that are counted together
FINE = 4  # words of a character up to which a map shows where groups begin
PICTURE = "map"  # the column whose characters are LETTERS


def cover(atlas: Atlas, step: int) -> Any:
    """For each stretch of `step` words that have been in use, from 1 on: the kind that has a majority there.

    By its place in NAMES; of kinds that have as many words the first.
    """
    first, last, kind = atlas.bounds
    used = kind != NAMES.index(UNUSED)
    words = np.repeat(kind[used].astype(np.int8), (last - first + 1)[used])
    piece = max(PIECE // step, 1) * step  # so many words are counted together
    parts = [_majority(words[first : first + piece], step) for first in range(0, len(words), piece)]
    return np.concatenate([np.zeros(0, np.int8), *parts])


def _majority(words: Any, step: int) -> Any:
    """For each stretch of `step` of the kinds `words` (n,) that which most of them are."""
    starts = np.arange(0, len(words), step)
    found, largest = np.zeros(len(starts), np.int8), np.zeros(len(starts), np.int64)
    for number in np.flatnonzero(np.bincount(words)).tolist():
        many = np.add.reduceat(words == number, starts, dtype=np.int64)
        found[many > largest] = number
        largest = np.maximum(many, largest)
    return found


def stretch(atlas: Atlas, places: int) -> int:
    """The smallest of 1, 2, 5, 10, ... words for which there are enough places for all that are in use."""
    step, factors = 1, (2.0, 2.5, 2.0)
    k = 0
    while step * places < atlas.free - 1:
        step = int(step * factors[k % 3])
        k += 1
    return step


def heap_map(atlas: Atlas) -> Listing:
    """A map of the heap in 80 columns: a letter for each stretch of words, by kind of group."""
    step = stretch(atlas, ACROSS * DOWN)
    found = cover(atlas, step)
    key = [f"{LETTERS[NAMES[number]]} {NAMES[number]}" for number in np.unique(found).tolist()]
    letters = np.array([LETTERS[name] for name in NAMES])[found]
    unit = "one word" if step == 1 else f"{step} words, by the kind with the largest share"
    if step <= FINE:
        begins = (atlas.bounds[0][atlas.bounds[0] < atlas.free] - 1) // step
        letters[begins] = np.char.upper(letters[begins])
        key.append("a capital where a group begins")
    rows = [(k * step + 1, "".join(letters[k : k + ACROSS])) for k in range(0, len(letters), ACROSS)]
    said = [f"{atlas.free - 1} of {len(atlas.h.ia)} words have been in use", f"a character is {unit}"]
    said += wrap(", ".join(key), WIDTH) if rows else []
    return Listing(
        [*said, "--out map.png or map.svg draws it, beside the blocks"], ("address", PICTURE), rows
    )
