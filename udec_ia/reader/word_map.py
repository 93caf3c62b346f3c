"""What each word of IA() is: part of a group, of a junk group, not linked, or unused; and names of groups.

The census (heap/group_census.py) finds the groups that lists reach. In a damaged heap there may be words that
nothing leads to, and groups may lie in each other: a word then belongs to the group that begins nearest
before it. Names: corner@412 of block@88; a junk group by its place in the junk list; other words by their
stretch.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.accessors import Memory, gather
from udec_ia.heap.group_census import CHOICES, census, one_of
from udec_ia.heap.junk_list import junk_chains
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, layouts, read_table

TABLE = read_table()
KINDS = tuple(group.name for group in TABLE.groups)
JUNK, NOTHING, UNUSED = "junk", "not linked", "unused"
NAMES = (*KINDS, JUNK, NOTHING, UNUSED)
ENDINGS = (("", ""), ("s", ""), ("es", ""), ("ies", "y"))  # of a plural, and of its singular


def kind_named(text: str) -> str | None:
    """The kind of group that `text` names, singular or plural, such as grid-points; None if it names none."""
    word = text.lower().replace("-", "")
    singulars = (word.removesuffix(one) + other for one, other in ENDINGS if word.endswith(one))
    return next((one for one in singulars if one in KINDS), None)


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
    """One field of a group, and one element of it. first, last: addresses of its words."""

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
    """The words of one memory.

    groups: addresses of the groups of every kind, ascending. shapes: the fields of a group of every kind,
    element by element, as they would stand in a group at the address 0.
    """

    def __init__(self, h: Memory) -> None:
        self.h = h
        self.ratio = int(h.ra.itemsize // h.ia.itemsize)
        self.layout = layouts(self.ratio)
        self.free = first_free(h)
        self.groups: dict[str, Any] = census(self.h)
        self.shapes = {kind: list(self._shape(kind)) for kind in KINDS}

    def _shape(self, kind: str) -> Iterator[Word]:
        offset = self.layout[kind].offset
        for field in TABLE.group(kind).fields:
            wide = self.ratio if field.real else 1
            first = (offset[field.name] - 1) * wide if field.real else offset[field.name]
            for element in range(field.count):
                yield Word(field, element, first + element * wide, first + (element + 1) * wide - 1)

    # ---- spans

    @cached_property
    def chains(self) -> list[list[tuple[int, int]]]:
        """The junk list, as `junk_list` gives it."""
        return junk_list(self.h)

    @cached_property
    def junk_places(self) -> dict[int, str]:
        """Where in the junk list the group at an address stands: number 3 of 7 of 20 words."""
        return {
            iad: f"number {k} of {len(chain)} of {size} words"
            for chain in self.chains
            for k, (iad, size) in enumerate(chain, 1)
        }

    @cached_property
    def bounds(self) -> tuple[Any, Any, Any]:
        """First and last address and kind, by its place in NAMES, of all spans: ascending, without gaps."""
        junk = np.array([one for chain in self.chains for one in chain], np.int64).reshape(-1, 2)
        sizes = [np.full(len(at), self.layout[kind].size) for kind, at in self.groups.items()]
        first = np.concatenate([*self.groups.values(), junk[:, 0]])
        kind = np.repeat(np.arange(len(sizes) + 1), [*map(len, sizes), len(junk)])
        first, once = np.unique(first, return_index=True)  # a group in use goes before junk at its address
        size, kind = np.concatenate([*sizes, junk[:, 1]])[once], kind[once]
        behind = np.minimum(first + size, np.append(first[1:], self.free))  # may be the next group, or unused
        begin = np.concatenate((first, [self.free], behind, [1]))
        unlinked = np.full(len(behind) + 1, NAMES.index(NOTHING))
        kind = np.concatenate((kind, [NAMES.index(UNUSED)], unlinked))
        begin, once = np.unique(begin, return_index=True)  # of several spans at one address the first counts
        end = np.append(begin[1:], len(self.h.ia) + 1) - 1
        there = begin <= len(self.h.ia)
        return begin[there], end[there], kind[once][there]

    def spans(self) -> Iterator[Span]:
        """What all words belong to, in rising order and without gaps."""
        for first, last, kind in zip(*(column.tolist() for column in self.bounds), strict=True):
            yield Span(first, last, NAMES[kind])

    def span(self, address: int) -> Span:
        """What the word at `address` belongs to. IndexError outside IA()."""
        if not 1 <= address <= len(self.h.ia):
            raise IndexError(f"IA() has the addresses 1 to {len(self.h.ia)}")
        first, last, kind = self.bounds
        k = int(np.searchsorted(first, address, "right")) - 1
        return Span(int(first[k]), int(last[k]), NAMES[kind[k]])

    # ---- words

    def words(self, span: Span) -> Iterator[Word]:
        """The fields of a group, element by element, in the order of its words."""
        for word in self.shapes[span.kind]:
            yield word._replace(first=span.first + word.first, last=span.first + word.last)

    def word(self, span: Span, field: Field, element: int = 0) -> Word:
        """Where an element of a field of a group stands."""
        return next(word for word in self.words(span) if (word.field, word.element) == (field, element))

    def word_at(self, address: int) -> tuple[Span, Word | None]:
        """The span and the field at an address; None where no field is, in a padding or outside of groups."""
        span = self.span(address)
        if span.kind not in KINDS:
            return span, None
        found = (word for word in self.words(span) if word.first <= address <= word.last)
        return span, next(found, None)

    def value(self, word: Word) -> int | float:
        """What a field holds."""
        found: int | float = self.gather(word, np.zeros(1, np.int64)).tolist()[0]
        return found

    def gather(self, word: Word, at: Any) -> Any:
        """What a field of a shape holds in the groups at the addresses `at`: int64, or reals."""
        return gather(self.h, at, word.first, word.field.real)

    # ---- relations

    @cached_property
    def starts(self) -> Any:
        """For each address below MFREE: 1 + place in KINDS of the group that begins there, or 0."""
        found = np.zeros(self.free, np.int8)
        for number, at in enumerate(self.groups.values(), 1):
            found[at] = number
        return found

    def holding(self, target: str, addresses: Any) -> Any:
        """True for each of `addresses` at which a group stands that a pointer to `target` may lead to."""
        within = (addresses >= 1) & (addresses < self.free)
        return one_of(self.starts[np.where(within, addresses, 0)], _numbers(target))

    def holds(self, target: str, address: int) -> bool:
        """The same for one address."""
        return 0 < address < self.free and bool(self.holding(target, np.array([address]))[0])

    @cached_property
    def indirect_owners(self) -> dict[int, int]:
        """Block of each group that hangs on a block and does not name it: extensions, and lists in these."""
        links = {  # by number of the kind: offset, role, and numbers of the kinds that the pointer leads to
            number: [
                (word.first - 1, word.field.role, _numbers(str(word.field.target)))
                for word in self.shapes[kind]
                if word.field.role in ("extension", "first", "next")
            ]
            for number, kind in enumerate(KINDS, 1)
        }
        words, starts, found = memoryview(self.h.ia), memoryview(self.starts), dict[int, int]()
        waiting = [(block, block) for block in self.groups["block"].tolist()]
        while waiting:
            iad, block = waiting.pop()
            for offset, role, numbers in links[starts[iad]]:
                to = words[iad + offset]
                if role == "next" and iad not in found:  # the list of blocks itself
                    continue
                if 0 < to < self.free and starts[to] in numbers and to not in found:
                    found[to] = block
                    waiting.append((to, block))
        return found

    def owners(self, span: Span) -> list[int]:
        """The blocks that a group belongs to: two for a contact, none for a domain; a block is its own."""
        if span.kind not in KINDS:
            return []
        if span.kind == "block":
            return [span.first]
        hosts = [int(self.value(word)) for word in self.words(span) if word.field.role == "host"]
        owner = self.indirect_owners.get(span.first)
        return hosts or ([owner] if owner else [])


def choices(target: str) -> tuple[str, ...]:
    """The kinds of group that a pointer to `target` may lead to."""
    return KINDS if target == "any" else CHOICES.get(target, (target,))


def _numbers(target: str) -> tuple[int, ...]:
    """The same by their numbers in Atlas.starts."""
    return tuple(KINDS.index(kind) + 1 for kind in choices(target))


IS_NO = ", no "  # begins what a value should be and is not
NOTHING_THERE = "nothing"  # what 0 leads to


def names(atlas: Atlas, addresses: Any) -> list[str]:
    """What is at the addresses (n,), all within IA(): a group, or a word of one."""
    first, last, kind = atlas.bounds
    at = np.searchsorted(first, addresses, "right") - 1
    found = _of_spans(atlas, first[at], last[at], kind[at])
    for k in np.flatnonzero(first[at] != addresses).tolist():
        found[k] = f"word {addresses[k] - first[at[k]] + 1} of {found[k]}"
    return found


def called(atlas: Atlas, span: Span) -> str:
    """A span by name."""
    return names(atlas, np.array([span.first]))[0]


def _of_spans(atlas: Atlas, first: Any, last: Any, kind: Any) -> list[str]:
    found = np.empty(len(first), object)
    for number in np.unique(kind).tolist():
        here = np.flatnonzero(kind == number)
        found[here] = _of_kind(atlas, NAMES[number], first[here], last[here])
    named: list[str] = found.tolist()
    return named


def _of_kind(atlas: Atlas, kind: str, first: Any, last: Any) -> list[str]:
    at = first.tolist()
    if kind == JUNK:
        return [f"{JUNK}@{iad}, {atlas.junk_places[iad]}" for iad in at]
    if kind not in KINDS:
        return [f"{kind} {iad} to {end}" for iad, end in zip(at, last.tolist(), strict=True)]
    hosts = [
        _hosts(atlas, atlas.gather(word, first)) for word in atlas.shapes[kind] if word.field.role == "host"
    ]
    if hosts:
        owners = [" and ".join(several) for several in zip(*hosts, strict=True)]
        return [f"{kind}@{iad} of {owner}" for iad, owner in zip(at, owners, strict=True)]
    if host := TABLE.group(kind).behind:
        return [f"{kind}@{iad} of {host}@{iad - atlas.layout[host].size}" for iad in at]
    indirect = atlas.indirect_owners
    return [f"{kind}@{iad} of block@{indirect[iad]}" if iad in indirect else f"{kind}@{iad}" for iad in at]


def _hosts(atlas: Atlas, hosts: Any) -> list[str]:
    sound = atlas.holding("block", hosts).tolist()
    return [
        f"block@{ib}" if is_block else "no block" for ib, is_block in zip(hosts.tolist(), sound, strict=True)
    ]


def leads_to(atlas: Atlas, target: str, values: Any, required: bool = False) -> list[str]:
    """What pointers to `target` with the values (n,) lead to, or that this is wrong. required: so is 0."""
    wanted = IS_NO + ("group" if target == "any" else " or ".join(choices(target)))
    found = np.full(len(values), NOTHING_THERE + (wanted if required else ""), object)
    sound = atlas.holding(target, values)
    found[sound] = _of_spans(atlas, values[sound], values[sound], atlas.starts[values[sound]] - 1)
    found[~sound & (values != 0)] = "outside IA()" + wanted
    invalid = np.flatnonzero(~sound & (values >= 1) & (values <= len(atlas.h.ia)))
    found[invalid] = [name + wanted for name in names(atlas, values[invalid])]
    led: list[str] = found.tolist()
    return led
