"""Ways through a heap: along a list, and back from a group to all that points to it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from udec_ia.inspect.look.atlas import KINDS, TABLE, Atlas
from udec_ia.inspect.look.fields import called, heads, leads_to
from udec_ia.inspect.look.listing import Listing
from udec_ia.inspect.walk import Unsound, boundary, groups, loop

LINKS = {  # fields that lead along a list, with the kind of group that has them
    field.name: group.name
    for group in TABLE.groups
    for field in group.fields
    if field.role in ("next", "back", "anticlockwise")
}
MAIN = {group.name: group.list_head for group in TABLE.groups if group.list_head}
AROUND = ("block", "domain")  # groups with a list around them
COLUMNS = ("place", "address", "group")


def who(atlas: Atlas, address: int) -> Listing:
    """All words that point to the group at, or around, `address`, by field. IndexError outside IA()."""
    span = atlas.span(address)
    rows: list[tuple[object, ...]] = [
        ("", "common block", name) for name, value, _ in heads(atlas) if value == span.first
    ]
    for group in TABLE.groups:
        at = atlas.groups[group.name]
        for field in group.fields:
            for element in range(field.count if field.target else 0):
                offset = atlas.layout[group.name].offset[field.name] + element
                for iad in at[atlas.h.ia[at + offset - 1] == span.first].tolist():
                    word = atlas.word(atlas.span(iad), field, element)
                    rows.append((word.first, called(atlas, atlas.span(iad)), word.name))
    return Listing(
        [f"{called(atlas, span)} is pointed to by {len(rows)} words"], ("address", "group", "field"), rows
    )


def walk(atlas: Atlas, along: str, start: int | None = None) -> Listing:
    """A list, group by group, until it ends, comes round or leads astray.

    along: the kind of the groups of a main list; or "block" or "domain" with the address of one, for the list
    around it; or the name of a field that links groups, with the address at which to begin. ValueError for
    what is no list.
    """
    if along in MAIN and start is None:
        return _told(atlas, f"the {along} list", groups(atlas.h, along))
    if along in AROUND and start is not None:
        if not atlas.holds(along, start):
            raise ValueError(f"{start} is {leads_to(atlas, along, start)}")
        items = boundary(atlas.h, start) if along == "block" else (item for item, _ in loop(atlas.h, start))
        return _told(atlas, f"around {along}@{start}", items)
    if along in LINKS and start is not None:
        return _told(atlas, f"from {start} along {along}", _linked(atlas, along, start))
    names = [*MAIN, *(f"{kind} ADDRESS" for kind in AROUND), *(f"{name} ADDRESS" for name in LINKS)]
    raise ValueError(f"no list {along}: there are {', '.join(names)}")


def _linked(atlas: Atlas, link: str, start: int) -> Iterator[int]:
    """Groups from `start` along a field; Unsound where it leads astray or into itself."""
    kind, iad, source = LINKS[link], start, "the address given"
    seen: set[int] = set()
    while iad and not (iad == start and seen):
        if iad in seen:
            raise Unsound(f"{source} leads back to {kind}@{iad}, where the list did not begin")
        if not atlas.holds(kind, iad):
            raise Unsound(f"{source} points to {iad}: {leads_to(atlas, kind, iad)}")
        seen.add(iad)
        yield iad
        source = f"{link} of {kind}@{iad}"
        iad = int(atlas.read(atlas.span(iad), link))


def _told(atlas: Atlas, way: str, addresses: Iterator[int]) -> Listing:
    rows: list[tuple[object, ...]] = []
    broken = ""
    try:
        for iad in addresses:
            rows.append((len(rows) + 1, iad, called(atlas, atlas.span(iad))))
    except Unsound as error:
        broken = f", and then it breaks: {error.detail}"
    return Listing([f"{way}: {len(rows)} groups{broken}"], COLUMNS, rows)


def junk(atlas: Atlas) -> Listing:
    """How full the memory is: by kind of group, the junk list by sizes, and what nothing leads to."""
    h, words = atlas.h, np.zeros(0, np.int64)
    rows: list[tuple[object, ...]] = []
    for kind in KINDS:
        many = len(atlas.groups[kind])
        if many:
            rows.append((kind, many, atlas.layout[kind].size, many * atlas.layout[kind].size))
    for chain in atlas.chains:
        rows.append(("junk", len(chain), chain[0][1], sum(size for _, size in chain)))
    lost = [span for span in atlas.spans() if span.kind == "not linked"]
    if lost:
        words = np.array([span.last - span.first + 1 for span in lost])
        rows.append(("not linked", len(lost), "", int(words.sum())))
    free, top = atlas.free - 1, len(h.ia)
    given = sum(size for chain in atlas.chains for _, size in chain)
    said = [
        f"{free} of {top} words have been in use, {free - given - int(words.sum())} are",
        f"junk: {given} words, {given / max(free, 1):.1%} of those, in {len(atlas.chains)} sizes",
    ]
    return Listing(said, ("kind", "groups", "words each", "words"), rows)
