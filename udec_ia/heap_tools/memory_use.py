"""How full the memory is: kinds of groups, the junk list by sizes, and how scattered what is free lies."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from udec_ia.counting import counted
from udec_ia.reader.atlas import JUNK, KINDS, NAMES, NOTHING, Atlas
from udec_ia.reader.listing import Listing


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
