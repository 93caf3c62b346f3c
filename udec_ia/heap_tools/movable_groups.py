"""Groups that can be told apart word for word: what laying them out afresh needs, and no more.

A word of IA() says nothing of itself. It is known by its group and field, so a heap can only be written in
another form if every word is in one group or in the junk list, and if every pointer leads to a group of the
kind that the table gives it. Whether the map that they make is sound, and what the numbers are, does not
matter.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts
from udec_ia.reader.atlas import Atlas, junk_list
from udec_ia.reader.field_reading import TABLE, TARGETS
from udec_ia.reader.group_lists import Lists
from udec_ia.reader.group_names import called
from udec_ia.reader.list_walks import Unsound


def movable(array: MainArray) -> dict[str, Any]:
    """Addresses of the groups of every kind, in the order of their lists, those of blocks block by block.

    Raises Unsound unless the groups in use and the junk list fill the heap, each word once, and every pointer
    is 0 or leads to a group of its kind.
    """
    words, free = len(array.h.ia), int(array.h.ci[g.MFREE])
    if not 1 <= free <= words + 1:
        raise Unsound(f"MFREE is {free}, which is no address in an array of {words} words")
    lists = Lists(array)
    found = {group.name: lists.addresses(group.name) for group in TABLE.groups}
    _check_words(array, found)
    _check_pointers(array, lists)
    return found


def name_at(array: MainArray, address: int) -> str:
    """The group at `address` with the blocks that it belongs to: corner@412 of block@88."""
    atlas = Atlas(array.h)
    return called(atlas, atlas.span(address))


def junk_words(array: MainArray) -> int:
    """Words of the junk list."""
    return sum(size for chain in junk_list(array.h) for _, size in chain)


def _check_words(array: MainArray, found: dict[str, Any]) -> None:
    """Unsound unless groups and junk groups, in the order of their addresses, lie end to end."""
    layout, free = layouts(array.scheme.ratio), int(array.h.ci[g.MFREE])
    junk = np.array([one for chain in junk_list(array.h) for one in chain], np.int64).reshape(-1, 2)
    start = np.concatenate([*found.values(), junk[:, 0]])
    size = np.concatenate([*(np.full(len(at), layout[kind].size) for kind, at in found.items()), junk[:, 1]])
    order = np.argsort(start)
    begins, ends = np.append(start[order], free), np.append(0, start[order] + size[order] - 1)
    wrong = np.flatnonzero(begins != ends + 1)
    if len(wrong):
        begin, end = int(begins[wrong[0]]), int(ends[wrong[0]])
        if begin > end:
            raise Unsound(f"words {end + 1} to {begin - 1} are in no group, so their meaning is unknown")
        raise Unsound(f"the group that ends at word {end} and the one that begins at {begin} share words")


def _check_pointers(array: MainArray, lists: Lists) -> None:
    """Unsound unless every pointer of a group or of the common block is 0 or leads to a group of its kind."""
    for kind, at in lists.address.items():
        for field in TABLE.group(kind).fields:
            targets = TARGETS[str(field.target)] if field.target else ()
            for i in range(field.count if targets else 0):
                for row, value in lists.pointers_astray(kind, field.name, i, targets, True)[:1]:
                    owner = name_at(array, int(at[row]))
                    raise Unsound(f"{field.name} of {owner} points to {value}, which is not a {field.target}")
    for field in TABLE.common:
        value = lists.common(field.name) if field.target else 0
        if value and not lists.is_one(value, TARGETS[str(field.target)]):
            raise Unsound(f"{field.name} points to {value}, which is no {field.target}")
