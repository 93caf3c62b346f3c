"""What a word is, what points to a group, and the groups along a list: `udec what`, `who` and `walk`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from itertools import repeat
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap.main_array import variable
from udec_ia.printable_text import counted
from udec_ia.reader.field_reading import LISTED
from udec_ia.reader.field_rows import COLUMNS, COMMON, meaning, span_rows
from udec_ia.reader.group_positions import places
from udec_ia.reader.list_walks import Unsound, boundary, follow, groups, loop
from udec_ia.reader.place_grammar import address_of
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import JUNK, KINDS, TABLE, Atlas, Word, called, kind_named, leads_to, names


class Pointers(NamedTuple):
    """One pointer field of groups of a kind: their addresses (n,), and where it leads (n,).

    target: kind of group it should lead to. word: None for a pointer of the common block, called `name`.
    """

    name: str
    target: str
    word: Word | None
    at: Any
    to: Any


def pointers(atlas: Atlas) -> Iterator[Pointers]:
    """Every pointer of the common block, and every pointer field of every kind of group."""
    for field in TABLE.common:
        if field.target:
            yield Pointers(field.name, field.target, None, np.zeros(1, np.int64), variable(atlas.h, field))
    for kind in KINDS:
        at = atlas.groups[kind]
        for word in atlas.shapes[kind]:
            if word.field.target:
                yield Pointers(word.name, word.field.target, word, at, atlas.gather(word, at))


def pointing(atlas: Atlas, address: int) -> Iterator[Pointers]:
    """Those whose value is `address`."""
    for one in pointers(atlas):
        found = one.to == address
        yield one._replace(at=one.at[found], to=one.to[found])


def pointer_rows(atlas: Atlas, found: Iterable[Pointers], limit: int | None = None) -> list[tuple[Any, ...]]:
    """Address, group and field of some pointers; those of the common block have no address."""
    rows: list[tuple[Any, ...]] = []
    for name, _, word, at, _ in found:
        at = at if limit is None else at[: limit - len(rows)]
        if word is None:
            rows += [("", COMMON, name)] * len(at)
        else:
            rows += zip((at + word.first).tolist(), names(atlas, at), repeat(name), strict=False)
    return rows


def who(atlas: Atlas, place: int | str) -> Listing:
    """All words that point to the group at, or around, a place, by field. Raises as `what` does."""
    span = atlas.span(address_of(atlas, place))
    rows = pointer_rows(atlas, pointing(atlas, span.first))
    head = f"{called(atlas, span)} is pointed to by {counted(len(rows), 'word')}"
    return Listing([head], ("address", "group", "field"), rows)


def what(atlas: Atlas, place: int | str) -> Listing:
    """What the word at a place is, and the whole group that it is part of.

    IndexError outside IA(), ValueError for no such place.
    """
    address = address_of(atlas, place)
    span, word = atlas.word_at(address)
    number = f"{address} is word {address - span.first + 1} of {span.last - span.first + 1}"
    if span.kind == JUNK:
        return Listing([f"{number} of {called(atlas, span)}, free to be used again"])
    if span.kind not in KINDS:
        return Listing([f"{number} that are {span.kind}"])
    if word is None:
        text = "no field: it fills the group up to a whole number of reals"
    else:
        says = meaning(atlas, span, word)
        text = f"{word.name}, {word.field.text}: {atlas.value(word)} {word.field.unit.strip('-')}".rstrip()
        text += f", {says}" if says != word.field.text else ""
    head = [f"{number} of {called(atlas, span)}", text, *places(atlas, span)]
    return Listing(head, COLUMNS, span_rows(atlas, span))


LINKS = {  # fields that lead along a list, with the kind of group that has them
    field.name: group.name
    for group in TABLE.groups
    for field in group.fields
    if field.role in ("next", "back", "anticlockwise")
}
AROUND = ("block", "domain")  # groups with a list around them


def walk(
    atlas: Atlas,
    along: str,
    start: int | str | None = None,
    field: str | None = None,
    limit: int | None = None,
) -> Listing:
    """A list, group by group, until it ends, closes or becomes invalid.

    along: the kind of the groups of a main list; "block" or "domain" with the place of one, for the list
    around it; or a field that links groups, with the place at which to begin. field: to show of each group
    that has it. limit: groups to show. ValueError for what is no list, no field or no limit.
    """
    if limit is not None and limit < 1:
        raise ValueError(f"limit {limit}: give the number of groups to show, 1 or more")
    words = _having(atlas, field) if field else {}
    name, addresses = _list(atlas, along, None if start is None else address_of(atlas, start))
    found, broken = list[int](), ""
    try:
        for iad in addresses:
            found.append(iad)
    except Unsound as error:
        broken = f", and then it breaks: {error.detail}"
    head = f"{name}: {counted(len(found), 'group')}{broken}"
    if limit is not None and limit < len(found):
        head += f"; the first {limit}:"
    at = np.array(found[:limit], np.int64)
    columns: list[Any] = [range(1, len(at) + 1), at.tolist(), names(atlas, at)]
    if field:
        columns.append(_values(atlas, words, at))
    rows = list(zip(*columns, strict=True))
    return Listing([head], ("place", "address", "group", *([field] if field else [])), rows)


def _list(atlas: Atlas, along: str, start: int | None) -> tuple[str, Iterator[int]]:
    """A list in words, and the addresses of its groups; these raise Unsound where it becomes invalid."""
    along = kind_named(str(along)) or along
    if along in LISTED and start is None:
        return f"the {along} list", groups(atlas.h, along)
    if along in AROUND and start is not None:
        if not atlas.holds(along, start):
            raise ValueError(f"{start} is {leads_to(atlas, along, np.array([start]))[0]}")
        if along == "block":
            return f"around block@{start}", boundary(atlas.h, start)
        return f"around domain@{start}", (iad for iad, _ in loop(atlas.h, start))
    if along in LINKS and start is not None:
        return f"from {start} along {along}", _linked(atlas, along, start)
    given = along if start is None else f"{along} from {start}"
    around = " and ".join(f"{kind} ADDRESS" for kind in AROUND)
    raise ValueError(
        f"no list {given}: there are {', '.join(LISTED)} without an ADDRESS, "
        f"{around} for the list around one, and lists from an ADDRESS along {', '.join(LINKS)}"
    )


def _linked(atlas: Atlas, link: str, start: int) -> Iterator[int]:
    """Groups from `start` along a field; Unsound where it becomes invalid or leads into itself."""
    kind = LINKS[link]
    (word,) = (word for word in atlas.shapes[kind] if word.field.name == link)

    def sound(iad: int, source: str) -> int:
        if iad and not atlas.holds(kind, iad):
            raise Unsound(f"{source} points to {iad}: {leads_to(atlas, kind, np.array([iad]))[0]}")
        return iad

    def in_words(iad: int) -> str:
        return f"{link} of {kind}@{iad}"

    def step(iad: int) -> int:
        return sound(int(atlas.gather(word, np.int64(iad))), in_words(iad))

    closed = word.field.role == "anticlockwise"
    yield from follow(sound(start, "the address given"), step, in_words, closed)


def _having(atlas: Atlas, name: str) -> dict[str, Word]:
    """The field of a name, KXD or KZG(2), by the kinds of group that have it. ValueError if none has."""
    found = {kind: word for kind, shape in atlas.shapes.items() for word in shape if word.name == name}
    if not found:
        known = {word.name: word.field.name for shape in atlas.shapes.values() for word in shape}
        likely = [one for one, field in known.items() if field == name] or get_close_matches(name, known, 1)
        advice = f": did you mean {' or '.join(likely)}?" if likely else ""
        raise ValueError(f"no group has a field {name}{advice}")
    return found


def _values(atlas: Atlas, words: dict[str, Word], at: Any) -> list[Any]:
    """What the groups at some addresses hold in a field; "" where they have none."""
    found = np.full(len(at), "", object)
    for kind, word in words.items():
        here = np.flatnonzero(atlas.holding(kind, at))
        found[here] = atlas.gather(word, at[here]).tolist()
    return list(found)
