"""Fields of groups in words: what a value means, and what a pointer leads to."""

from __future__ import annotations

from collections.abc import Iterator

from udec_ia.inspect.look.atlas import JUNK, KINDS, TABLE, Atlas, Span, Word
from udec_ia.inspect.look.listing import Listing
from udec_ia.layout import offsets as g

COLUMNS = ("address", "words", "field", "value", "unit", "meaning")
HEADS = {(head.group, head.value): head for head in TABLE.heads}
CODES = {(code.field, code.value): f"{code.name}: {code.text}" for code in TABLE.codes}


def called(atlas: Atlas, span: Span) -> str:
    """A span by name, with the blocks that it belongs to: corner@412 of block@88; junk with its place."""
    if span.kind == JUNK:
        return f"{span.name}, {junk_place(atlas, span.first)}"
    blocks = " and ".join(f"block@{block}" for block in atlas.owners(span))
    return f"{span.name} of {blocks}" if blocks and span.kind != "block" else span.name


def junk_place(atlas: Atlas, address: int) -> str:
    """Where in the junk list a group stands: third of 7 of 20 words."""
    for chain in atlas.chains:
        for k, (iad, size) in enumerate(chain, 1):
            if iad == address:
                return f"number {k} of {len(chain)} of {size} words"
    raise KeyError(address)


def meaning(atlas: Atlas, span: Span, word: Word) -> str:
    """What the value of a field says: the group that it leads to, a code's name, or the table's text."""
    field, value = word.field, atlas.value(word)
    if field.role == "head":
        head = HEADS.get((span.kind, int(value)))
        return f"{head.name}: {head.text}" if head else "no head code of its kind"
    if field.target:
        return leads_to(atlas, field.target, int(value))
    return CODES.get((field.name, int(value)), field.text) if not field.real else field.text


def leads_to(atlas: Atlas, target: str, value: int) -> str:
    """What a pointer leads to, or that it is not what the table says."""
    if value == 0:
        return "nothing"
    if not 1 <= value <= len(atlas.h.ia):
        return f"outside IA(), no {target}"
    span = atlas.span(value)
    if span.first == value and atlas.holds(target, value):
        return called(atlas, span)
    place = called(atlas, span) if span.first == value else f"word {value - span.first + 1} of {span.name}"
    return f"{place}, no {target}"


def lines(atlas: Atlas, span: Span, first: int, last: int) -> Iterator[tuple[object, ...]]:
    """Rows of COLUMNS for the fields of a group with a word from `first` to `last`."""
    for word in atlas.words(span):
        if word.last >= first and word.first <= last:
            raw = " ".join(str(atlas.h.ia[iad - 1]) for iad in range(word.first, word.last + 1))
            told = meaning(atlas, span, word)
            yield word.first, raw, word.name, atlas.value(word), word.field.unit.strip("-"), told


def what(atlas: Atlas, address: int) -> Listing:
    """What the word at `address` is, and the whole group that it is part of. IndexError outside IA()."""
    span, word = atlas.word_at(address)
    size, place = span.last - span.first + 1, address - span.first + 1
    said = [f"{address} is word {place} of {size} of {called(atlas, span)}"]
    if span.kind not in KINDS:
        said[0] = f"{address} is word {place} of {size} that are {span.kind}"
        if span.kind == JUNK:
            said = [f"{address} is word {place} of {size} of {called(atlas, span)}, free to be used again"]
        return Listing(said)
    if word is None:
        said.append("no field: it fills up the group to whole reals")
    else:
        said.append(f"{word.name}, {word.field.text}: {_value(atlas, word)}")
    return Listing(said, COLUMNS, list(lines(atlas, span, span.first, span.last)))


def _value(atlas: Atlas, word: Word) -> str:
    unit = word.field.unit.strip("-")
    return f"{atlas.value(word)}{' ' if unit else ''}{unit}"


def heads(atlas: Atlas) -> Iterator[tuple[str, int, str]]:
    """The list heads and other pointers of the common block: name, value, kind of group."""
    for field in TABLE.common:
        if field.role == "head" and field.target:
            yield field.name, int(atlas.h.ci[getattr(g, field.name)]), field.target
