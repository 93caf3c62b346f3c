"""Groups with a list in the common block: walking along the list, and giving groups back.

Groups whose host, by the field table, is a block are given back with it. Contacts are not among them:
kernels/map removes these, as they are part of the map.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, Offset, integers, puti
from udec_ia.heap.find_lose import lose
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Group, read_table


def _hosts(group: Group) -> list[Offset]:
    """The fields of a group for blocks that are its hosts."""
    if not group.list_head or group.name == "contact":
        return []
    return [getattr(g, one.name) for one in group.fields if one.role == "host" and one.target == "block"]


HOSTED = {group.name: hosts for group in read_table().groups if (hosts := _hosts(group))}


def lose_hosted(h: Memory, blocks: Collection[int]) -> None:
    """Give back all groups of which one of `blocks` is a host."""
    for kind, hosts in HOSTED.items():
        listed = list_of(h, kind)
        gone = np.zeros(len(listed), bool)
        for host in hosts:
            gone |= np.isin(integers(h, listed, host), [*blocks])
        drop(h, kind, listed[gone].tolist())


def list_of(h: Memory, kind: str) -> Any:
    """The addresses of all groups of a kind with a list in the common block, in its order."""
    head, link, _ = _list_fields(kind)
    return addresses(h, int(h.ci[head]), link)


@cache
def _list_fields(kind: str) -> tuple[int, Offset, Offset]:
    """Index of the list head of a kind of groups, link to the next one, and size."""
    group = read_table().group(kind)
    link = next(field.name for field in group.fields if field.role == "next")
    return getattr(g, str(group.list_head)), getattr(g, link), getattr(g, group.size_name)


def drop(h: Memory, kind: str, gone: Collection[int]) -> None:
    """Take the groups `gone` out of the list of their kind and give them back, in their order."""
    if not gone:
        return
    head, link, size = _list_fields(kind)
    leaving, before, cut = set(gone), 0, False
    for iad in [*list_of(h, kind).tolist(), 0]:
        if iad in leaving:
            cut = True
            continue
        if cut and before:
            puti(h, before, link, iad)
        elif cut:
            h.ci[head] = iad
        before, cut = iad, False
    for iad in gone:
        puti(h, iad, HEAD, 0)
        lose(h, iad, size)
