"""How full the memory is, and a map of it by kind of group: `udec junk` and `udec map`."""

from __future__ import annotations

from collections.abc import Iterator
from textwrap import wrap
from typing import Any

import numpy as np

from udec_ia.printable_text import counted
from udec_ia.reader.kind_colours import LETTERS
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import JUNK, KINDS, NAMES, NOTHING, UNUSED, Atlas


def junk(atlas: Atlas) -> Listing:
    """How full the memory is: by kind of group, the junk list by sizes, and what nothing leads to."""
    rows: list[tuple[object, ...]] = []
    for kind in KINDS:
        many, size = len(atlas.groups[kind]), atlas.layout[kind].size
        if many:
            rows.append((kind, many, size, many * size))
    for chain in atlas.chains:
        rows.append((JUNK, len(chain), chain[0][1], sum(size for _, size in chain)))
    stretches, lost = _runs(atlas, NOTHING), _words(atlas, NOTHING)
    if lost:
        rows.append((NOTHING, len(stretches), "", lost))
    used, top, given = atlas.free - 1, len(atlas.h.ia), _words(atlas, JUNK)
    said = [
        f"high water: {used} of {top} words have been in use, {used / top:.1%}, MFREE {atlas.free}",
        f"in use: {used - given - lost} words, {(used - given - lost) / max(used, 1):.1%} of those",
        *_scattered(given, used, len(atlas.chains), _runs(atlas, JUNK)),
    ]
    if lost:
        said.append(
            f"{NOTHING}: {lost} words, {lost / used:.1%} of those, that no list leads to: the heap is damaged"
        )
    shares = (round(100 * float(row[3]) / max(used, 1), 1) for row in rows)  # type: ignore[arg-type]
    with_share = [(*row, share) for row, share in zip(rows, shares, strict=True)]
    return Listing(said, ("kind", "groups", "words each", "words", "percent"), with_share)


def _scattered(given: int, used: int, sizes: int, runs: Any) -> Iterator[str]:
    """Sentences on the junk list, and how scattered it lies."""
    if not given:
        yield "junk: none"
        return
    largest = int(runs.max())
    yield f"junk: {given} words, {given / used:.1%} of those, in {counted(sizes, 'size')}"
    share = 1 - largest / given
    runs_of = counted(len(runs), "run")
    yield f"fragmentation: {runs_of}, {share:.1%} of the junk outside the largest, of {largest} words"


def _words(atlas: Atlas, kind: str) -> int:
    first, last, kinds = atlas.bounds
    here = kinds == NAMES.index(kind)
    return int((last[here] - first[here] + 1).sum())


def _runs(atlas: Atlas, kind: str) -> Any:
    """Lengths in words of the runs of neighbouring spans of a kind."""
    first, last, kinds = atlas.bounds
    here = np.concatenate(([False], kinds == NAMES.index(kind), [False]))
    begins, ends = np.flatnonzero(here[1:] & ~here[:-1]), np.flatnonzero(~here[1:] & here[:-1])
    return last[ends - 1] - first[begins] + 1


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
