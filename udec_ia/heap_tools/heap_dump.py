"""The whole heap, or a part of it, field by field: every word is there, under the name of its group.

Groups come in the order of their addresses, some thousand at a time and each kind of them at once, so that a
dump takes time in proportion to the words and little memory. Repeated words outside groups are shown once.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.heap.main_array import variable
from udec_ia.reader.field_rows import (
    COLUMNS,
    COMMON,
    RADICES,
    Row,
    data_meanings,
    digits,
    group_rows,
    padded,
    span_rows,
    word_width,
)
from udec_ia.reader.place_grammar import stretch
from udec_ia.reader.printed_listing import Listing, Stream
from udec_ia.reader.word_map import JUNK, KINDS, NAMES, TABLE, Atlas, Span, leads_to, names

ALONE = "common"  # the common block, where a stretch of addresses is asked for
AT_ONCE = 1024  # spans that are looked at together
PIECE = 2**16  # words that are in no group and looked at together
VALUE = 13  # characters of a value
ROOM = 60  # characters of words that are in no group, on a line
JUNK_LINKS = (
    (JNEXT[0], "JNEXT", "next junk group of this size, 0 for none"),
    (JSIZE[0], "JSIZE", "its words"),
    (JSIZES[0], "JSIZES", "in the first group of a size: first junk group of the next size, 0 for none"),
)


def dump(atlas: Atlas, first: int | str | None = None, last: int | None = None, radix: int = 10) -> Listing:
    """The words from address `first` to `last`, field by field; without them the common block and all words.

    first: an address, or both as text: 412, 412-500, 412/20, block@88. radix: 8, 10 or 16, of the words as
    they are. IndexError for what does not lie in IA(), ValueError for what names no words, and for another
    radix.
    """
    top, whole = len(atlas.h.ia), first is None
    if isinstance(first, str):
        first, last = stretch(atlas, first)
    first, last = 1 if first is None else first, top if last is None else last
    if not 1 <= first <= last <= top:
        raise IndexError(f"there are no words {first} to {last}: IA() has the addresses 1 to {top}")

    def rows() -> Iterator[Row]:
        if whole:
            yield from _common_rows(atlas)
        for part in parts(atlas, first, last):
            yield from _part_rows(atlas, *part, (first, last), radix)

    words = f"{top} words of {atlas.h.ia.itemsize * 8} bits, {atlas.ratio} to a real"
    head = f"IA() has {words}, and {atlas.free - 1} have been in use"
    return Listing([head], ("group", *COLUMNS), Stream(rows), widths=_widths(atlas, radix), headed=True)


def common(atlas: Atlas) -> Listing:
    """The variables of the common block by name."""
    rows = Stream(lambda: _common_rows(atlas))
    return Listing([], ("group", *COLUMNS), rows, widths=_widths(atlas, RADICES[0]), headed=True)


def _widths(atlas: Atlas, radix: int) -> tuple[int, ...]:
    """Widths of the columns by what may stand in them."""
    if radix not in RADICES:
        raise ValueError(f"radix {radix}: choose one of {', '.join(map(str, RADICES))}")
    address = max(len(str(len(atlas.h.ia))), len(COLUMNS[0]))
    words = (word_width(atlas.h.ia, radix) + 1) * atlas.ratio - 1
    names = [word.name for shape in atlas.shapes.values() for word in shape]
    names += [f"{field.name}({field.count})" if field.count > 1 else field.name for field in TABLE.common]
    units = [field.unit for group in TABLE.groups for field in group.fields]
    return 0, address, -words, -max(map(len, names)), VALUE, -max(map(len, units)), -1


def parts(atlas: Atlas, first: int, last: int) -> Iterator[tuple[Any, Any, Any]]:
    """First and last addresses and kinds of the spans with a word from `first` to `last`, some at a time."""
    begin, end, kind = atlas.bounds
    place = int(np.searchsorted(begin, first, "right")) - 1
    stop = int(np.searchsorted(begin, last, "right"))
    for start in range(place, stop, AT_ONCE):
        part = slice(start, min(start + AT_ONCE, stop))
        yield begin[part], end[part], kind[part]


def _part_rows(
    atlas: Atlas, begin: Any, end: Any, kind: Any, limits: tuple[int, int], radix: int
) -> Iterator[Row]:
    """The same for some spans: groups that are whole come in one go, what is cut short or no group singly."""
    first, last = limits
    ready: dict[int, tuple[Row, ...]] = {}
    for number in range(len(KINDS)):
        here = np.flatnonzero(kind == number)
        size = atlas.layout[KINDS[number]].size
        whole = (begin[here] >= first) & (end[here] <= last) & (end[here] - begin[here] + 1 == size)
        here = here[whole & ~padded(atlas, KINDS[number], begin[here])] if len(here) else here
        ready.update(zip(here.tolist(), group_rows(atlas, KINDS[number], begin[here], radix), strict=True))
    heads = names(atlas, begin)
    for i, head in enumerate(heads):
        rows = ready.get(i)
        if rows is None:
            span = Span(int(begin[i]), int(end[i]), NAMES[kind[i]])
            rows = tuple(_single(atlas, span, max(span.first, first), min(span.last, last), radix))
            if span.kind in KINDS and span.last - span.first + 1 < atlas.layout[span.kind].size:
                head += f", cut short by {heads[i + 1] if i + 1 < len(heads) else 'what follows'}"
        for row in rows:
            yield (head, *row)


def _single(atlas: Atlas, span: Span, first: int, last: int, radix: int) -> Iterator[Row]:
    """Rows of those words of a span that lie between `first` and `last`."""
    if span.kind in KINDS:
        for row in span_rows(atlas, span, radix):
            if row[0] + row[1].count(" ") >= first and row[0] <= last:  # its last word, and its first
                yield row
        return
    if span.kind == JUNK:
        for offset, name, text in JUNK_LINKS:
            at = span.first + offset
            if first <= at <= last:
                word = atlas.h.ia[at - 1 : at]
                yield at, digits(word, radix)[0], name, int(word[0]), "", text
        first = max(first, span.first + len(JUNK_LINKS))
    yield from _plain_rows(atlas, first, last, radix)


def _plain_rows(atlas: Atlas, first: int, last: int, radix: int) -> Iterator[Row]:
    """Words in no group, several to a line; a word that comes over and over is shown once."""
    words = atlas.h.ia
    step = max(ROOM // (word_width(words, radix) + 1), 1)
    for start, stop in [*_repeats(words, first, last, step), (last + 1, last)]:
        for at in range(first, start, step):
            yield at, " ".join(digits(words[at - 1 : min(at + step, start) - 1], radix)), "", "", "", ""
        if start <= stop:
            yield start, digits(words[start - 1 : start], radix)[0], "", "", "", f"the same to {stop}"
        first = stop + 1


def _repeats(words: Any, first: int, last: int, longer: int) -> Iterator[tuple[int, int]]:
    """First and last address of each run of more than `longer` words that are the same."""
    run: tuple[int, int] | None = None
    for begin in range(first - 1, last, PIECE):
        piece = words[begin : min(begin + PIECE, last)]
        edges = np.concatenate(([0], np.flatnonzero(piece[1:] != piece[:-1]) + 1, [len(piece)]))
        for k in np.flatnonzero(np.diff(edges) > longer).tolist():
            start, stop = begin + int(edges[k]) + 1, begin + int(edges[k + 1])
            if run and run[1] + 1 == start and words[run[0] - 1] == words[start - 1]:
                start = run[0]
            elif run:
                yield run
            run = start, stop
    if run:
        yield run


def _common_rows(atlas: Atlas) -> Iterator[Row]:
    """Rows of the common block; elements of an array that are the same are shown together."""
    for field in TABLE.common:
        values = variable(atlas.h, field)
        meanings = leads_to(atlas, field.target, values) if field.target else [*data_meanings(field, values)]
        bits = values.view(f"i{values.itemsize}")
        edges = [0, *(np.flatnonzero(bits[1:] != bits[:-1]) + 1).tolist(), len(values)]
        for k, after in pairwise(edges):
            name = field.name + (f"({k + 1})" if field.count > 1 else "")
            more = f"; the same to {field.name}({after})" if after > k + 1 else ""
            yield COMMON, "", "", name, values[k].item(), field.unit.strip("-"), meanings[k] + more
