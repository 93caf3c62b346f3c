"""How full the memory is, and a map of it by kind of group: `udec junk` and `udec map`."""

from __future__ import annotations

from textwrap import wrap
from typing import Any

import numpy as np

from udec_ia.printable_text import counted
from udec_ia.reader.kind_colours import LETTERS
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import JUNK, NAMES, NOTHING, UNUSED, Atlas


def junk(atlas: Atlas) -> Listing:
    """How full the memory is: by kind of group, the junk list by sizes, and what nothing leads to."""
    rows: list[tuple[Any, ...]] = []
    for kind, at in atlas.groups.items():
        size = atlas.layout[kind].size
        rows += [(kind, len(at), size, len(at) * size)] if len(at) else []
    rows += [(JUNK, len(chain), chain[0][1], sum(size for _, size in chain)) for chain in atlas.chains]
    given, lost = words_of_kind(atlas, JUNK), words_of_kind(atlas, NOTHING)
    if lost:
        rows.append((NOTHING, len(_runs(atlas, NOTHING)), "", lost))
    used, top = atlas.free - 1, len(atlas.h.ia)

    def share(words: int) -> str:
        return f"{words} words, {words / max(used, 1):.1%} of those"

    head = [
        f"high water: {used} of {top} words have been in use, {used / top:.1%}, MFREE {atlas.free}",
        f"in use: {share(used - given - lost)}",
        f"junk: {share(given)}, in {counted(len(atlas.chains), 'size')}" if given else "junk: none",
    ]
    if given:
        runs = _runs(atlas, JUNK)
        head.append(f"the junk lies in {counted(len(runs), 'run')}, the longest of {runs.max()} words")
    if lost:
        head.append(f"{NOTHING}: {share(lost)}, that no list leads to: the heap is damaged")
    with_share = [(*row, round(100 * row[3] / max(used, 1), 1)) for row in rows]
    return Listing(head, ("kind", "groups", "words each", "words", "percent"), with_share)


def words_of_kind(atlas: Atlas, kind: str) -> int:
    """How many words are in spans of a kind of group, or JUNK, NOTHING or UNUSED."""
    first, last, kinds = atlas.bounds
    here = kinds == NAMES.index(kind)
    return int((last[here] - first[here] + 1).sum())


def _runs(atlas: Atlas, kind: str) -> Any:
    """Lengths in words of the runs of neighbouring spans of a kind."""
    first, last, kinds = atlas.bounds
    edges = np.diff(np.concatenate(([False], kinds == NAMES.index(kind), [False])).astype(np.int8))
    return last[np.flatnonzero(edges < 0) - 1] - first[edges[:-1] > 0] + 1


ACROSS, DOWN, WIDTH = 64, 24, 80  # characters of a map, and of a line
PIECE = 2**20  # words that are counted together
FINE = 4  # words of a character up to which a map shows where groups begin
PICTURE = "map"  # the column whose characters are LETTERS


def cover(atlas: Atlas, step: int) -> Any:
    """For each stretch of `step` words in use, from 1 on, the place in NAMES of its main kind."""
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
    steps = (factor * 10**power for power in range(20) for factor in (1, 2, 5))
    return int(next(step for step in steps if step * places >= atlas.free - 1))


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
    head = [f"{atlas.free - 1} of {len(atlas.h.ia)} words have been in use", f"a character is {unit}"]
    head += wrap(", ".join(key), WIDTH) if rows else []
    head.append("--out map.png or map.svg draws it, beside the blocks")
    return Listing(head, ("address", PICTURE), rows)
