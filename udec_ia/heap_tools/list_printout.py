"""Along a list, group by group, until it ends, comes round or leads astray."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from difflib import get_close_matches
from typing import Any

import numpy as np

from udec_ia.counting import counted
from udec_ia.reader.atlas import TABLE, Atlas, Word
from udec_ia.reader.group_names import leads_to, names
from udec_ia.reader.list_walks import Unsound, boundary, groups, loop
from udec_ia.reader.listing import Listing
from udec_ia.reader.places import address_of

LINKS = {  # fields that lead along a list, with the kind of group that has them
    field.name: group.name
    for group in TABLE.groups
    for field in group.fields
    if field.role in ("next", "back", "anticlockwise")
}
MAIN = {group.name: group.list_head for group in TABLE.groups if group.list_head}
AROUND = ("block", "domain")  # groups with a list around them


def walk(
    atlas: Atlas,
    along: str,
    start: int | str | None = None,
    field: str | None = None,
    limit: int | None = None,
) -> Listing:
    """A list, group by group, until it ends, comes round or leads astray.

    along: the kind of the groups of a main list; or "block" or "domain" with the place of one, for the list
    around it; or the name of a field that links groups, with the place at which to begin. field: what to
    show of each group that has it, such as KXD or KZG(2). limit: groups to show. ValueError for what is no
    list, no field or no limit.
    """
    if limit is not None and limit < 1:
        raise ValueError(f"limit {limit}: give the number of groups to show, 1 or more")
    shown = _having(atlas, field) if field else {}
    way, addresses = _way(atlas, along, None if start is None else address_of(atlas, start))
    found, broken = list[int](), ""
    try:
        for iad in addresses:
            found.append(iad)
    except Unsound as error:
        broken = f", and then it breaks: {error.detail}"
    said = f"{way}: {counted(len(found), 'group')}{broken}"
    if limit is not None and limit < len(found):
        said += f"; the first {limit}:"
    at = np.array(found[:limit], np.int64)
    columns: list[Any] = [range(1, len(at) + 1), at.tolist(), names(atlas, at)]
    if field:
        columns.append(_values(atlas, shown, at))
    rows = list(zip(*columns, strict=True))
    return Listing([said], ("place", "address", "group", *([field] if field else [])), rows)


def _way(atlas: Atlas, along: str, start: int | None) -> tuple[str, Iterator[int]]:
    """A list in words, and the addresses of its groups; these raise Unsound where it leads astray."""
    if along in MAIN and start is None:
        return f"the {along} list", _once(along, ((iad, iad) for iad in groups(atlas.h, along)))
    if along in AROUND and start is not None:
        if not atlas.holds(along, start):
            raise ValueError(f"{start} is {leads_to(atlas, along, np.array([start]))[0]}")
        if along == "block":
            return f"around block@{start}", _once("item", ((iad, iad) for iad in boundary(atlas.h, start)))
        return f"around domain@{start}", _once("item", (((iad, ib), iad) for iad, ib in loop(atlas.h, start)))
    if along in LINKS and start is not None:
        return f"from {start} along {along}", _linked(atlas, along, start)
    if along in LINKS:
        raise ValueError(f"a list along {along} begins at a {LINKS[along]}: give its ADDRESS as well")
    if along in MAIN:
        raise ValueError(
            f"the {along} list begins at {MAIN[along]}: give no ADDRESS, or a field that links them"
        )
    around = " and ".join(f"{kind} ADDRESS" for kind in AROUND)
    raise ValueError(
        f"no list {along}: there are {', '.join(MAIN)}; "
        f"{around} for the list around one; and from an ADDRESS along {', '.join(LINKS)}"
    )


def _once(kind: str, steps: Iterable[tuple[Hashable, int]]) -> Iterator[int]:
    """The addresses of some steps, each with a key; Unsound when a key comes again: the list does not end."""
    seen: set[Hashable] = set()
    for key, iad in steps:
        if key in seen:
            raise Unsound(f"it leads back to {kind}@{iad}, where it did not begin")
        seen.add(key)
        yield iad


def _linked(atlas: Atlas, link: str, start: int) -> Iterator[int]:
    """Groups from `start` along a field; Unsound where it leads astray or into itself."""
    kind, iad, source = LINKS[link], start, "the address given"
    (word,) = (word for word in atlas.shapes[kind] if word.field.name == link)
    seen: set[int] = set()
    while iad and not (iad == start and seen):
        if iad in seen:
            raise Unsound(f"{source} leads back to {kind}@{iad}, where the list did not begin")
        if not atlas.holds(kind, iad):
            raise Unsound(f"{source} points to {iad}: {leads_to(atlas, kind, np.array([iad]))[0]}")
        seen.add(iad)
        yield iad
        source = f"{link} of {kind}@{iad}"
        iad = int(atlas.gather(word, np.int64(iad)))


def _having(atlas: Atlas, name: str) -> dict[str, Word]:
    """The field of a name, KXD or KZG(2), by the kinds of group that have it. ValueError if none has."""
    found = {kind: word for kind, shape in atlas.shapes.items() for word in shape if word.name == name}
    if not found:
        known = {one.name: one.field.name for shape in atlas.shapes.values() for one in shape}
        several = [one for one, field in known.items() if field == name]
        meant = get_close_matches(name, known, 1)
        advice = (
            f": it is {several[0]} to {several[-1]}"
            if several
            else f": did you mean {meant[0]}?"
            if meant
            else ""
        )
        raise ValueError(f"no group has a field {name}{advice}")
    return found


def _values(atlas: Atlas, shown: dict[str, Word], at: Any) -> list[Any]:
    """What the groups at some addresses hold in a field; "" where they have none."""
    found = np.full(len(at), "", object)
    for kind, word in shown.items():
        here = np.flatnonzero(atlas.holding(kind, at))
        found[here] = atlas.gather(word, at[here]).tolist()
    values: list[Any] = found.tolist()
    return values
