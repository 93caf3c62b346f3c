"""What each word of IA() is: part of a group, of a junk group, of nothing, or not used yet.

The census (inspect/census.py) tells which groups the lists reach; the junk list tells what was given back.
Between them there may be words that nothing leads to, in a damaged heap, and groups may lie in each other: a
word then belongs to the group that begins nearest before it. Above MFREE nothing has been used.

Nothing is trusted, and making an atlas takes time in proportion to the words that are in use.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.inspect.census import CHOICES, census, junk_chains
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field, layouts, read_table

TABLE = read_table()
KINDS = tuple(group.name for group in TABLE.groups)
JUNK, NOTHING, UNUSED = "junk", "not linked", "unused"
NAMES = (*KINDS, JUNK, NOTHING, UNUSED)


class Span(NamedTuple):
    """Words that belong together: first and last address, and the kind of group, or JUNK, NOTHING, UNUSED."""

    first: int
    last: int
    kind: str

    @property
    def name(self) -> str:
        """How it is called: corner@412, or by its words."""
        if self.kind in KINDS or self.kind == JUNK:
            return f"{self.kind}@{self.first}"
        return f"{self.kind} {self.first} to {self.last}"


class Word(NamedTuple):
    """One field of a group, and one element of it. first, last: its words; offset: as in the table."""

    field: Field
    element: int
    first: int
    last: int

    @property
    def name(self) -> str:
        """KXD, or KZG(2) for the second of several."""
        return self.field.name + (f"({self.element + 1})" if self.field.count > 1 else "")


def junk_list(h: Memory) -> list[list[tuple[int, int]]]:
    """For each size the groups of its chain (address, words), as far as it makes sense."""
    return junk_chains(h.ia[: first_free(h) - 1], int(h.ci[g.JUNK]))


def first_free(h: Memory) -> int:
    """The first unused address, as far as it can be believed."""
    return max(min(int(h.ci[g.MFREE]), len(h.ia) + 1), 1)


class Atlas:
    """The words of one memory. groups: addresses of the groups of every kind, ascending."""

    def __init__(self, h: Memory) -> None:
        self.h = h
        self.ratio = int(h.ra.itemsize // h.ia.itemsize)
        self.layout = layouts(self.ratio)
        self.free = first_free(h)
        self.groups: dict[str, Any] = census(self.h)

    # ---- spans

    @cached_property
    def chains(self) -> list[list[tuple[int, int]]]:
        """The junk list, as `junk_list` gives it."""
        return junk_list(self.h)

    @cached_property
    def _spans(self) -> tuple[Any, Any, Any]:
        """First and last address and kind, by its place in NAMES, of all spans: ascending, without gaps."""
        junk = np.array([one for chain in self.chains for one in chain], np.int64).reshape(-1, 2)
        first = np.concatenate([*self.groups.values(), junk[:, 0]])
        size = np.concatenate(
            [*(np.full(len(at), self.layout[k].size) for k, at in self.groups.items()), junk[:, 1]]
        )
        kind = np.repeat(np.arange(len(KINDS) + 1), [*(len(at) for at in self.groups.values()), len(junk)])
        first, once = np.unique(
            first, return_index=True
        )  # a group in use goes before junk at the same address
        size, kind = size[once], kind[once]
        top = min(self.free, len(self.h.ia) + 1)
        last = np.minimum(first + size, np.append(first[1:], top)) - 1
        before, after = np.append(1, last + 1), np.append(first, top)  # what lies between
        gap = np.flatnonzero(before < after)
        rest = [(top, len(self.h.ia), NAMES.index(UNUSED))] if top <= len(self.h.ia) else []
        nothing = np.full(len(gap), NAMES.index(NOTHING))
        parts = [(first, last, kind), (before[gap], after[gap] - 1, nothing)]
        rows = [np.concatenate([*(part[c] for part in parts), [one[c] for one in rest]]) for c in range(3)]
        order = np.argsort(rows[0], kind="stable")
        return (
            rows[0][order].astype(np.int64),
            rows[1][order].astype(np.int64),
            rows[2][order].astype(np.int64),
        )

    def spans(self, first: int = 1, last: int | None = None) -> Iterator[Span]:
        """What the words `first` to `last` belong to, in rising order and without gaps; each span whole."""
        begin, end, kind = self._spans
        k = int(np.searchsorted(begin, first, "right")) - 1
        while k < len(begin) and (last is None or begin[k] <= last):
            yield Span(int(begin[k]), int(end[k]), NAMES[kind[k]])
            k += 1

    def span(self, address: int) -> Span:
        """What the word at `address` belongs to. IndexError outside IA()."""
        if not 1 <= address <= len(self.h.ia):
            raise IndexError(f"IA() has the addresses 1 to {len(self.h.ia)}")
        return next(self.spans(address, address))

    # ---- words

    def words(self, span: Span) -> Iterator[Word]:
        """The fields of a group, element by element, in the order of its words."""
        for field in TABLE.group(span.kind).fields:
            for element in range(field.count):
                yield self.word(span, field, element)

    def word(self, span: Span, field: Field, element: int = 0) -> Word:
        """Where an element of a field of a group stands."""
        offset = self.layout[span.kind].offset[field.name]
        wide = self.ratio if field.real else 1
        first = span.first + ((offset - 1 + element) * wide if field.real else offset + element)
        return Word(field, element, first, first + wide - 1)

    def word_at(self, address: int) -> tuple[Span, Word | None]:
        """The span and the field at an address; None where no field is, in a padding or outside of groups."""
        span = self.span(address)
        if span.kind not in KINDS:
            return span, None
        found = (word for word in self.words(span) if word.first <= address <= word.last)
        return span, next(found, None)

    def value(self, word: Word) -> int | float:
        """What a field holds."""
        if word.field.real:
            return float(self.h.ra[(word.first - 1) // self.ratio])
        return int(self.h.ia[word.first - 1])

    def read(self, span: Span, name: str, element: int = 0) -> int | float:
        """What the field `name` of a group holds."""
        field = next(field for field in TABLE.group(span.kind).fields if field.name == name)
        return self.value(self.word(span, field, element))

    # ---- relations

    def holds(self, kind: str, address: int) -> bool:
        """True if a group of that kind is there; "item", "soft" and "any" stand for several kinds."""
        kinds = KINDS if kind == "any" else CHOICES.get(kind, (kind,))
        for one in kinds:
            k = int(np.searchsorted(self.groups[one], address))
            if k < len(self.groups[one]) and self.groups[one][k] == address:
                return True
        return False

    @cached_property
    def _owner(self) -> dict[int, int]:
        """Block of each group that hangs on a block and does not name it: extensions, and lists in these."""
        found: dict[int, int] = {}
        waiting = [(block, block) for block in self.groups["block"].tolist()]
        while waiting:
            iad, block = waiting.pop()
            span = self.span(iad)
            for field in TABLE.group(span.kind).fields:
                leads = field.role in ("extension", "first") or (field.role == "next" and iad in found)
                to = int(self.read(span, field.name)) if leads else 0
                if to and to not in found and self.holds(str(field.target), to):
                    found[to] = block
                    waiting.append((to, block))
        return found

    def owners(self, span: Span) -> list[int]:
        """The blocks that a group belongs to: two for a contact, none for a domain; a block is its own."""
        if span.kind == "block":
            return [span.first]
        fields = TABLE.group(span.kind).fields if span.kind in KINDS else ()
        hosts = [int(self.read(span, field.name)) for field in fields if field.role == "host"]
        held = self._owner.get(span.first)
        return hosts or ([held] if held else [])
