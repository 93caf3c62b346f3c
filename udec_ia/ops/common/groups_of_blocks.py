"""What belongs to blocks goes with them: listed groups whose host, by the field table, is a block.

Contacts, too, have blocks for hosts; but they are the map, and it is mended where they go (kernels/map).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, Offset, integers, puti
from udec_ia.heap.find_lose import lose
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Group, read_table


class Hosted(NamedTuple):
    """A kind of such groups: index of its list head, link to the next one, size, and its fields for hosts."""

    head: int
    link: Offset
    size: Offset
    hosts: list[Offset]


def _of(group: Group) -> Hosted | None:
    hosts = [one.name for one in group.fields if one.role == "host" and one.target == "block"]
    if not group.list_head or group.name == "contact" or not hosts:
        return None
    link = next(field.name for field in group.fields if field.role == "next")
    return Hosted(
        getattr(g, group.list_head),
        getattr(g, link),
        getattr(g, group.size_name),
        [getattr(g, name) for name in hosts],
    )


HOSTED = {group.name: kind for group in read_table().groups if (kind := _of(group))}


def lose_hosted(h: Memory, blocks: Collection[int]) -> None:
    """Give back all groups of which one of `blocks` is a host."""
    for kind in HOSTED.values():
        listed = addresses(h, int(h.ci[kind.head]), kind.link)
        gone = np.zeros(len(listed), bool)
        for host in kind.hosts:
            gone |= np.isin(integers(h, listed, host), [*blocks])
        drop(h, kind, listed[gone].tolist())


def drop(h: Memory, kind: Hosted, gone: Sequence[int]) -> None:
    """Take the groups `gone` out of the list of their kind and give them back, in one walk along it."""
    leaving = set(gone)
    before, cut = 0, False
    for iad in [*addresses(h, int(h.ci[kind.head]), kind.link).tolist(), 0] if gone else ():
        if iad in leaving:
            cut = True
            continue
        if cut and before:
            puti(h, before, kind.link, iad)
        elif cut:
            h.ci[kind.head] = iad
        before, cut = iad, False
    for iad in gone:
        puti(h, iad, HEAD, 0)
        lose(h, iad, kind.size)
