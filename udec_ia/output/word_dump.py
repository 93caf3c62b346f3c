"""DUMP: the words of IA() as they are, and what each of them means (reader/word_map.py)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.heap_tools.heap_dump import parts
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.place_grammar import stretch
from udec_ia.reader.printed_listing import LINES, Listing, Stream
from udec_ia.reader.word_map import JUNK, KINDS, NAMES, Atlas, Span, Word

POINTERS = ("MFREE", "JUNK", "IBPNT", "ICPNT", "IDPNT")
HEAD_NAMES = {head.value: head.name for head in read_table().heads}


def dump(h: Memory, n: int, m: int) -> str:
    """The words from address n to address m, and the five pointers (DUMP, report I-1).

    Several words to a line; beside them the group and the fields that they belong to, reals decoded. Error 30
    unless 1 <= n <= m and m lies within the array.
    """
    return "".join(f"{line.text}\n" for line in raw(Atlas(h), n, m).lines())


def raw(atlas: Atlas, n: int | str = 1, m: int | None = None) -> Listing:
    """The same line by line, however many there are; all words if none are named.

    n: an address, or both as text: 412-500, 412/20, block@88.
    """
    h = atlas.h
    if isinstance(n, str):
        n, m = stretch(atlas, n)
    m = len(h.ia) if m is None else m
    if not 1 <= n <= m <= len(h.ia):
        advice = f"give two addresses in increasing order, from 1 to {len(h.ia)}"
        raise UdecError(30, f"DUMP {n} {m}", advice, parameter="n")
    pointers = "  ".join(f"{name} {h.ci[getattr(g, name)]}" for name in POINTERS)
    return Listing([pointers], LINES, Stream(lambda: ((line,) for line in _lines(atlas, n, m))))


def _lines(atlas: Atlas, n: int, m: int) -> Iterator[str]:
    for begin, end, kind in parts(atlas, n, m):
        texts = _texts(atlas, begin, kind)
        for i, (first, last, number) in enumerate(
            zip(begin.tolist(), end.tolist(), kind.tolist(), strict=True)
        ):
            yield from _span_lines(atlas, Span(first, last, NAMES[number]), n, m, texts.get(i, ()))


def _texts(atlas: Atlas, begin: Any, kind: Any) -> dict[int, tuple[str, ...]]:
    """NAME=value for every field of those of some spans that are groups, in the order of Atlas.shapes."""
    found: dict[int, tuple[str, ...]] = {}
    for number, name in enumerate(KINDS):
        here = np.flatnonzero(kind == number)
        columns = [_column(word, atlas.gather(word, begin[here]).tolist()) for word in atlas.shapes[name]]
        found.update(zip(here.tolist(), zip(*columns, strict=True), strict=True))
    return found


def _column(word: Word, values: list[Any]) -> list[str]:
    if word.field.role == "head":
        return [f"head={HEAD_NAMES.get(value, value)}" for value in values]
    return [f"{word.name}={value:.6g}" if word.field.real else f"{word.name}={value}" for value in values]


def _label(span: Span) -> str:
    if span.kind == JUNK:
        return f"{span.name}, {span.last - span.first + 1} words"
    return span.name if span.kind in KINDS else span.kind


def _span_lines(atlas: Atlas, span: Span, n: int, m: int, texts: Sequence[str]) -> Iterator[str]:
    """The lines of those words of a span that lie between n and m; lines count from the span's start."""
    first, last, words = max(n, span.first), min(m, span.last), atlas.h.ia
    if not texts and not words[first - 1 : last].any():
        yield f"{first:8} | 0 to address {last}  | {_label(span)}"
        return
    fields = atlas.shapes[span.kind] if texts else []
    digits = {2: 6, 4: 11, 8: 20}[words.itemsize]
    step = 2 if words.itemsize == 8 else 4
    width = step * (digits + 1) - 1
    for start in range(span.first + (first - span.first) // step * step, last + 1, step):
        begin, stop = max(start, first), min(start + step - 1, last)
        raw = " ".join([f"{word:{digits}}" for word in words[begin - 1 : stop].tolist()])
        low, high = begin - span.first, stop - span.first
        fields_here = [
            text for one, text in zip(fields, texts, strict=True) if one.first <= high and one.last >= low
        ]
        label = _label(span) if start <= first else ""
        yield f"{begin:8} | {raw:{width}} | {label:14} {' '.join(fields_here)}".rstrip()
