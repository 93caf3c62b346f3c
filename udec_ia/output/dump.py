"""DUMP: the words of IA() as they are, and what each of them means (inspect/look/atlas.py)."""

from __future__ import annotations

from collections.abc import Iterator

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.inspect.look.atlas import JUNK, KINDS, Atlas, Span, Word
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table

POINTERS = ("MFREE", "JUNK", "IBPNT", "ICPNT", "IDPNT")
HEAD_NAMES = {head.value: head.name for head in read_table().heads}


def dump(h: Memory, n: int, m: int) -> str:
    """The words from address n to address m, and the five pointers (DUMP, report I-1).

    Several words to a line; beside them the group and the fields that they belong to, reals decoded. Error 30
    unless 1 <= n <= m and m lies within the array.
    """
    if not 1 <= n <= m <= len(h.ia):
        advice = f"give two addresses in rising order, from 1 to {len(h.ia)}"
        raise UdecError(30, f"DUMP {n} {m}", advice, parameter="n")
    lines = ["  ".join(f"{name} {h.ci[getattr(g, name)]}" for name in POINTERS)]
    atlas = Atlas(h)
    for span in atlas.spans(n, m):
        lines += _span_lines(atlas, span, n, m)
    return "\n".join(lines) + "\n"


def _label(span: Span) -> str:
    if span.kind == JUNK:
        return f"{span.name}, {span.last - span.first + 1} words"
    return span.name if span.kind in KINDS else span.kind


def _span_lines(atlas: Atlas, span: Span, n: int, m: int) -> Iterator[str]:
    """The lines of those words of a span that lie between n and m; lines count from the span's start."""
    first, last, words = max(n, span.first), min(m, span.last), atlas.h.ia
    known = span.kind in KINDS
    if not known and not words[first - 1 : last].any():
        yield f"{first:8} | 0 to address {last}  | {_label(span)}"
        return
    digits = {2: 6, 4: 11, 8: 20}[words.itemsize]
    step = 2 if words.itemsize == 8 else 4
    for start in range(span.first + (first - span.first) // step * step, last + 1, step):
        begin, stop = max(start, first), min(start + step - 1, last)
        raw = " ".join(f"{words[iad - 1]:{digits}}" for iad in range(begin, stop + 1))
        label = _label(span) if start <= first else ""
        meaning = " ".join(_meanings(atlas, span, begin, stop)) if known else ""
        width = step * (digits + 1) - 1
        yield f"{begin:8} | {raw:{width}} | {label:14} {meaning}".rstrip()


def _meanings(atlas: Atlas, span: Span, first: int, last: int) -> Iterator[str]:
    """NAME=value for every field with a word between the addresses first and last."""
    for word in atlas.words(span):
        if word.first <= last and word.last >= first:
            head = word.field.role == "head"
            yield f"{'head' if head else word.name}={_value(atlas, word)}"


def _value(atlas: Atlas, word: Word) -> str:
    value = atlas.value(word)
    if word.field.role == "head":
        return HEAD_NAMES.get(int(value), str(value))
    return f"{value:.6g}" if word.field.real else str(value)
