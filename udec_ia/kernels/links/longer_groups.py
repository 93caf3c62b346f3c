"""Contacts and corners, which are longer in scenes with joint materials or numbered joints (LJOINT).

Directly behind each contact lies its joint then, and behind each corner the edge that ends there. No pointer
leads to them. Other scenes have neither, so that they do not pay for them.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, iget, int64, integers, size_of
from udec_ia.heap.find_lose import find, find_two, lose, lose_two
from udec_ia.layout import offsets as g


@inlined
def contact_words(h: Memory) -> int:
    """Words of a contact with what lies behind it."""
    joint = size_of(h, g.NVJT) if h.ci[g.LJOINT] != 0 else 0
    return int64(size_of(h, g.NVCN) + joint)


@inlined
def domain_words(h: Memory) -> int:
    """Words of a domain."""
    return int64(size_of(h, g.NVDO))


@inlined
def corner_words(h: Memory) -> int:
    """Words of a corner with what lies behind it."""
    edge = size_of(h, g.NVED) if h.ci[g.LJOINT] != 0 else 0
    return int64(size_of(h, g.NVCR) + edge)


@inlined
def joint_at(h: Memory, ic: int) -> int:
    """The joint behind contact `ic` if it has a joint material, else 0."""
    if h.ci[g.LJOINT] == 0:
        return int64(0)
    ix = int64(ic + size_of(h, g.NVCN))
    return ix if iget(h, ix, g.KCJMAT) != 0 else int64(0)


@inlined
def contact_of(h: Memory, ix: int) -> int:
    """The contact before joint `ix`."""
    return int64(ix - size_of(h, g.NVCN))


def joints_at(h: Memory, contacts: Any) -> Any:
    """The same for the contacts at the addresses `contacts`, as an array; not for kernels."""
    if h.ci[g.LJOINT] == 0:
        return np.zeros(len(contacts), np.int64)
    found = contacts + size_of(h, g.NVCN)
    return np.where(integers(h, found, g.KCJMAT) != 0, found, 0)


@inlined
def edge_at(h: Memory, ip: int) -> int:
    """The edge that ends at corner `ip`, 0 in a scene without joints."""
    return int64(ip + size_of(h, g.NVCR)) if h.ci[g.LJOINT] != 0 else int64(0)


@kernel
def find_contact(h: Memory) -> int:
    """Address of a new contact, its words zero, and those of its joint."""
    return find_two(h, g.NVCN, g.NVJT) if h.ci[g.LJOINT] != 0 else find(h, g.NVCN)


@kernel
def lose_contact(h: Memory, ic: int) -> None:
    """Give contact `ic` back, and its joint."""
    if h.ci[g.LJOINT] != 0:
        lose_two(h, ic, g.NVCN, g.NVJT)
    else:
        lose(h, ic, g.NVCN)


@kernel
def find_corner(h: Memory) -> int:
    """Address of a new corner, its words zero, and those of its edge."""
    return find_two(h, g.NVCR, g.NVED) if h.ci[g.LJOINT] != 0 else find(h, g.NVCR)


@kernel
def lose_corner(h: Memory, ip: int) -> None:
    """Give corner `ip` back, and its edge."""
    if h.ci[g.LJOINT] != 0:
        lose_two(h, ip, g.NVCR, g.NVED)
    else:
        lose(h, ip, g.NVCR)
