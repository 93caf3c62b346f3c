"""Contacts between pieces of one domain, found by walks around the smaller piece only.

The boundary of a domain consists of pieces that virtual contacts link (virtual_contacts.py). A domain around
thousands of loose blocks has thousands of pieces. The walks of this file are parallel and end when the
shortest of them does, so that a contact costs as much as its smaller side:

- pieces: two walks, from either place of the new contact, show whether both are on one piece;
- the virtual contact on the path between two pieces: one walk across each virtual contact of the smaller
  piece, around all that hangs on it; the new contact replaces the one whose walk meets the other piece, or
  the only one whose walk has not ended;
- a contact of a piece with itself cuts the domain: the shorter loop becomes the new domain. Virtual contacts
  on it are moved to the other loop, and blocks that lie in the new domain are linked to it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, iget, int64, puti
from udec_ia.kernels.geometry.block_grid import blocks_inside
from udec_ia.kernels.geometry.contact_geometry import begin_contact
from udec_ia.kernels.links.linked_lists import (
    flag_for_search,
    idomp,
    insert_after,
    is_contact,
    is_corner,
    nextcp,
    other,
    take_out,
)
from udec_ia.kernels.map.bridge import is_outline, makec, maked, nextd, relabel
from udec_ia.kernels.map.domain_segments import next_not_virtual, not_virtual
from udec_ia.kernels.map.domain_water import cut_water
from udec_ia.kernels.map.virtual_contacts import hook, lies_in, place_of, rehook, take_contact_out
from udec_ia.layout import offsets as g

FIRST_IS_SMALLER, SECOND_IS_SMALLER, FIRST_LOOP, SECOND_LOOP = 0, 1, 2, 3


@kernel
def _next_on_piece(h: Memory, item: int, block: int) -> tuple[int, int]:
    """As nextd, but past virtual contacts, so that the walk stays on its piece."""
    item = next_not_virtual(h, block, item)
    if is_contact(h, item):
        return item, other(h, block, item)
    return item, int64(block)


@kernel
def compare_pieces(h: Memory, ib: int, iad: int, jb: int, jad: int) -> int:
    """The relation of two places on the boundary of a domain: after item `iad` of block `ib`, and `jad`.

    FIRST_IS_SMALLER or SECOND_IS_SMALLER: they are on two pieces. FIRST_LOOP or SECOND_LOOP: they are on the
    same one, and the way from the first place to the second is the shorter one, or that back.
    """
    iad, jad = not_virtual(h, ib, iad), not_virtual(h, jb, jad)
    one, first, two, second = iad, ib, jad, jb
    while True:
        one, first = _next_on_piece(h, one, first)
        if one == jad and first == jb:
            return FIRST_LOOP
        if one == iad and first == ib:
            return FIRST_IS_SMALLER
        two, second = _next_on_piece(h, two, second)
        if two == iad and second == ib:
            return SECOND_LOOP
        if two == jad and second == jb:
            return SECOND_IS_SMALLER


@kernel
def _virtual_on_piece(h: Memory, ib: int, iad: int, found: Any, blocks: Any) -> int:
    """Enter the virtual contacts of the piece through (iad, ib), and their blocks on it; returns the number.

    With empty arrays they are only counted.
    """
    n = 0
    item, block = int64(iad), int64(ib)
    while True:
        item = nextcp(h, block, item)
        if not is_corner(h, item):
            if iget(h, item, g.KCCOD) == g.VIRTUAL:
                if len(found) > 0:
                    found[n], blocks[n] = item, block
                n += 1
                continue
            block = other(h, block, item)
        if item == iad and block == ib:
            return n


@kernel
def virtual_on_path(h: Memory, ib: int, iad: int, jb: int, jad: int) -> int:
    """The virtual contact at the piece of (iad, ib) on the path to the piece of (jad, jb); 0 for none."""
    iad, jad = not_virtual(h, ib, iad), not_virtual(h, jb, jad)
    nothing = np.empty(0, np.int64)
    n = _virtual_on_piece(h, ib, iad, nothing, nothing)
    if n == 0:
        return int64(0)
    found, blocks = np.empty(n, np.int64), np.empty(n, np.int64)
    _virtual_on_piece(h, ib, iad, found, blocks)
    items = found.copy()
    for k in range(n):
        blocks[k] = other(h, blocks[k], found[k])
    left = n
    while left > 1:
        for k in range(n):
            if items[k] == 0:
                continue
            items[k], blocks[k] = nextd(h, items[k], blocks[k])
            if items[k] == jad and blocks[k] == jb:
                return found[k]
            if items[k] == found[k]:  # it is back: what hangs on it does not contain the other piece
                items[k] = 0
                left -= 1
                if left == 1:
                    break
    for k in range(n):
        if items[k] != 0:
            return found[k]
    return int64(0)


@kernel
def move_virtual(h: Memory, iv: int, block: int, to: int, after: int) -> None:
    """Move the end of virtual contact `iv` on `block` to block `to`, after its item `after`."""
    take_out(h, block, iv)
    puti(h, iv, g.KB1 if iget(h, iv, g.KB1) == block else g.KB2, to)
    insert_after(h, to, after, iv)


@kernel
def _item_on(h: Memory, ib: int, idm: int) -> int:
    """An item of block `ib` that is not a virtual contact, with domain `idm` after it; 0 if there is none."""
    ip = iget(h, ib, g.KP)
    item = ip
    while True:
        is_virtual = not is_corner(h, item) and iget(h, item, g.KCCOD) == g.VIRTUAL
        if not is_virtual and idomp(h, ib, item) == idm:
            return int64(item)
        item = nextcp(h, ib, item)
        if item == ip:
            return int64(0)


@kernel
def _link_inside(h: Memory, kb: int, ic: int, inner: int, outer: int, idm: int, idnew: int) -> None:
    """Link the piece of block `kb` to domain `idnew`, cut from `idm` by contact `ic`, if it lies there.

    inner, outer: the blocks of the contact that are walked after it around `idnew` and `idm`.
    """
    item = _item_on(h, kb, idm)
    if item == 0 or not lies_in(h, ic, inner, kb):
        return
    link = virtual_on_path(h, kb, item, outer, ic)
    if link == 0:
        return
    nothing = np.empty(0, np.int64)
    n = _virtual_on_piece(h, kb, item, nothing, nothing)
    found, blocks = np.empty(n, np.int64), np.empty(n, np.int64)
    _virtual_on_piece(h, kb, item, found, blocks)
    for k in range(n):
        if found[k] != link:
            move_virtual(h, found[k], blocks[k], outer, ic)
    take_contact_out(h, link)
    relabel(h, item, kb, idnew)
    hook(h, link, inner, ic, kb, item, idnew)


@kernel
def _clear_loop(h: Memory, ic: int, inner: int, outer: int, box: Any) -> None:
    """Move the virtual contacts of the loop through (ic, inner) to block `outer`, after contact `ic`.

    box: gets the lower x and y and the upper x and y of the loop.
    """
    box[0], box[1], box[2], box[3] = np.inf, np.inf, -np.inf, -np.inf
    item, block = int64(ic), int64(inner)
    while True:
        x, y = place_of(h, item)
        box[0], box[1], box[2], box[3] = min(box[0], x), min(box[1], y), max(box[2], x), max(box[3], y)
        following = nextcp(h, block, item)
        while not is_corner(h, following) and iget(h, following, g.KCCOD) == g.VIRTUAL:
            move_virtual(h, following, block, outer, ic)
            following = nextcp(h, block, item)
        if not is_corner(h, following):
            block = other(h, block, following)
        item = following
        if item == ic and block == inner:
            return


@kernel
def cut_piece(
    h: Memory, ib: int, iad: int, jb: int, jad: int, icod: int, idm: int, loop: int, grid: Any
) -> int:
    """Make a contact of a piece with itself, which cuts domain `idm`; returns the new domain.

    loop: FIRST_LOOP or SECOND_LOOP, as compare_pieces has found. grid: of all blocks on the domain. There
    must be memory for a contact and a domain.
    """
    ic = makec(h, ib, jb, icod, idm, idm)
    insert_after(h, ib, not_virtual(h, ib, iad), ic)
    insert_after(h, jb, not_virtual(h, jb, jad), ic)
    begin_contact(h, ic)
    inner, outer = (ib, jb) if loop == FIRST_LOOP else (jb, ib)
    box = np.empty(4, np.float64)
    _clear_loop(h, ic, inner, outer, box)
    idnew = maked(h)
    relabel(h, ic, inner, idnew)
    puti(h, idnew, g.KDLOOP, ic)
    puti(h, idm, g.KDLOOP, ic)
    flag_for_search(h, idnew)
    around = is_outline(h, ic, inner)
    if idm == h.ci[g.IODPNT] and around:
        h.ci[g.IODPNT] = idnew
    if h.ci[g.LWATER] != 0:
        cut_water(h, idm, idnew)
    blocks = grid.blocks if around else blocks_inside(grid, box)
    for k in range(len(blocks)):
        _link_inside(h, blocks[k], ic, inner, outer, idm, idnew)
    return idnew


@kernel
def join_pieces(h: Memory, ib: int, iad: int, jb: int, jad: int, icod: int, which: int) -> None:
    """Make a contact of two pieces, which replaces a virtual contact on the path between them.

    which: FIRST_IS_SMALLER or SECOND_IS_SMALLER, as compare_pieces has found.
    """
    if which == FIRST_IS_SMALLER:
        iv = virtual_on_path(h, ib, iad, jb, jad)
    else:
        iv = virtual_on_path(h, jb, jad, ib, iad)
    rehook(h, iv, ib, iad, jb, jad, icod)
