"""DUMP: the words of IA() as they are, and what each of them means.

The words alone do not say what they are: what belongs to which group is found by following all pointers from
the list heads (inspect/census.py). What no pointer leads to is either on the junk list, or not linked at all.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.heap.memory import JNEXT, JSIZE, JSIZES
from udec_ia.inspect.census import census
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field, layouts, read_table

TABLE = read_table()
POINTERS = ("MFREE", "JUNK", "IBPNT", "ICPNT", "IDPNT")
HEAD_NAMES = {head.value: head.name for head in TABLE.heads}


class Span(NamedTuple):
    """Words that belong together: first and last address, what they are, and the kind of group or ""."""

    first: int
    last: int
    label: str
    kind: str


def dump(h: Memory, n: int, m: int) -> str:
    """The words from address n to address m, and the five pointers (DUMP, report I-1).

    Several words to a line; beside them the group and the fields that they belong to, reals decoded. Error 30
    unless 1 <= n <= m and m lies within the array.
    """
    if not 1 <= n <= m <= len(h.ia):
        advice = f"give two addresses in rising order, from 1 to {len(h.ia)}"
        raise UdecError(30, f"DUMP {n} {m}", advice, parameter="n")
    lines = ["  ".join(f"{name} {h.ci[getattr(g, name)]}" for name in POINTERS)]
    for span in _spans(h, n, m):
        lines += _span_lines(h, span, n, m)
    return "\n".join(lines) + "\n"


def _ratio(h: Memory) -> int:
    return int(h.ra.itemsize // h.ia.itemsize)


def _junk(h: Memory) -> list[Span]:
    """The groups on the junk list, one chain for each size, as far as they make sense."""
    spans: dict[int, Span] = {}
    chain = int(h.ci[g.JUNK])
    while 1 <= chain < h.ci[g.MFREE] and chain not in spans:
        size = iget(h, chain, JSIZE)
        following = iget(h, chain, JSIZES)
        group = chain
        while size > 0 and 1 <= group <= h.ci[g.MFREE] - size and group not in spans:
            spans[group] = Span(group, group + size - 1, f"junk@{group}, {size} words", "")
            group = iget(h, group, JNEXT)
        chain = following
    return list(spans.values())


def _spans(h: Memory, n: int, m: int) -> Iterator[Span]:
    """What the words n to m belong to, in rising order and without gaps."""
    known = _junk(h)
    for kind, addresses in census(h).items():
        size = layouts(_ratio(h))[kind].size
        near = addresses[(addresses > n - size) & (addresses <= m)]
        known += [Span(int(iad), int(iad) + size - 1, f"{kind}@{iad}", kind) for iad in near]
    free = int(h.ci[g.MFREE])
    if free <= len(h.ia):
        known.append(Span(free, len(h.ia), "unused", ""))
    at = n
    for span in sorted(known):
        if span.first > m:
            break
        if span.first > at:
            yield Span(at, span.first - 1, "not linked", "")
        if span.last >= at:
            yield span
            at = span.last + 1
    if at <= m:
        yield Span(at, m, "not linked", "")


def _span_lines(h: Memory, span: Span, n: int, m: int) -> Iterator[str]:
    """The lines of those words of a span that lie between n and m; lines count from the span's start."""
    first, last = max(n, span.first), min(m, span.last)
    if not span.kind and not h.ia[first - 1 : last].any():
        yield f"{first:8} | 0 to address {last}  | {span.label}"
        return
    digits = {2: 6, 4: 11, 8: 20}[h.ia.itemsize]
    step = 2 if h.ia.itemsize == 8 else 4
    for start in range(span.first + (first - span.first) // step * step, last + 1, step):
        stop = min(start + step - 1, last)
        words = " ".join(f"{h.ia[iad - 1]:{digits}}" for iad in range(max(start, first), stop + 1))
        label = span.label if start <= first else ""
        meaning = " ".join(_meanings(h, span, max(start, first), stop)) if span.kind else ""
        width = step * (digits + 1) - 1
        yield f"{max(start, first):8} | {words:{width}} | {label:14} {meaning}".rstrip()


def _meanings(h: Memory, span: Span, first: int, last: int) -> Iterator[str]:
    """NAME=value for every field with a word between the addresses first and last."""
    ratio = _ratio(h)
    group = TABLE.group(span.kind)
    offset = layouts(ratio)[span.kind].offset
    for field in group.fields:
        for i in range(field.count):
            word = span.first + (
                (offset[field.name] - 1 + i) * ratio if field.real else offset[field.name] + i
            )
            if word <= last and word + (ratio if field.real else 1) > first:
                yield f"{_name(field, i)}={_value(h, span.first, field, i)}"


def _name(field: Field, i: int) -> str:
    return "head" if field.role == "head" else field.name + (f"({i + 1})" if field.count > 1 else "")


def _value(h: Memory, iad: int, field: Field, i: int) -> str:
    if field.role == "head":
        code = iget(h, iad, HEAD)
        return HEAD_NAMES.get(code, str(code))
    offset = getattr(g, field.name)
    return f"{getr(h, iad, offset):.6g}" if field.real else str(iget(h, iad, offset, i))
