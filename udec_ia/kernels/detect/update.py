"""Update of a domain: search for new contacts and make them (UPDATE, UPDT; report 2.2).

An update makes the most urgent contact that the domain needs and repeats the search, in both parts if the
domain was cut, until none is needed. Blocks that then overlap where no contact can be made are error 15. The
map is sound after every contact; when memory runs out the update stops between two contacts and can be
continued.

A kernel that leads to updates gets the address of `update_domains`, which is compiled separately, so that
updates are not compiled again with it.

An update always ends. After a long step contacts are given up first, while there is one to give up. Then
contacts are made: none twice, and none of them is given up in the same update, unless a domain that has not
been searched yet gives up its own. The number of these domains decreases each time.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.compiling.non_inlined_calls import entry
from udec_ia.errors import OVERLAP_TOO_GREAT
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.heap.find_lose import room_for_two
from udec_ia.kernels.detect.contact_search import SMALL, STRAY, search
from udec_ia.kernels.detect.large_domains import MANY, begin_large
from udec_ia.kernels.detect.passage_through_block import edge_lies_in
from udec_ia.kernels.detect.third_block_in_gap import delete_occupied_contact
from udec_ia.kernels.links.linked_lists import flag_for_search
from udec_ia.kernels.links.longer_groups import contact_words, domain_words
from udec_ia.kernels.map.bridge import bridge
from udec_ia.kernels.map.domain_segments import (
    ARC,
    BLOCK,
    COLUMNS,
    CORNER,
    ITEM,
    PIECE,
    collect,
    count_items,
    not_virtual,
    update_loop_geometry,
)
from udec_ia.kernels.map.virtual_contacts import cut_among_pieces, rehook
from udec_ia.layout import offsets as g

NOTHING, MADE, CUT, MERGED, NO_ROOM = 0, 1, 2, 3, 4
WAITING = 64  # domains that may wait for their turn in one update


@kernel
def tie_between(ties: Any, one: int, two: int) -> int:
    """Row of a virtual contact on the path from piece `one` to piece `two`.

    Piece k + 1 was first reached over tie k, so the ties form a tree rooted in piece 0, and a piece has a
    greater number than its parent. A step to the parent of the greater of two different numbers always
    follows the path between them.
    """
    return max(one, two) - 1


@kernel
def _pieces(h: Memory, seg: Any, n: int, nties: int, own: int) -> Any:
    """One exposure of every piece: rows (block, item, 1 for the piece `own`)."""
    pieces = np.zeros((nties + 1, 3), np.int64)
    for i in range(n):
        k = seg[i, PIECE]
        if pieces[k, 0] == 0:
            pieces[k, 0] = seg[i, BLOCK]
            pieces[k, 1] = not_virtual(h, seg[i, BLOCK], seg[i, ITEM])
            pieces[k, 2] = 1 if k == own else 0
    return pieces


@kernel
def _without_contact(h: Memory, seg: Any, n: int, code: int, i: int, j: int) -> int:
    """A corner, or an edge by its corner, that lies in another block without a contact, or 0.

    code, i, j: the result of the search. Edges are tested in small domains, such as cracks.
    """
    if code == STRAY:
        return int64(seg[i, CORNER] if seg[i, ARC] == 1 else seg[j, CORNER])
    for one in range(n if n <= SMALL else 0):
        for two in range(n):
            edges = seg[one, ARC] + seg[two, ARC] == 0 and seg[one, BLOCK] != seg[two, BLOCK]
            if edges and edge_lies_in(h, seg[one, CORNER], seg[two, BLOCK], seg[two, CORNER]):
                return int64(seg[one, CORNER])
    return int64(0)


@kernel
def updt(h: Memory, idm: int) -> tuple[int, int]:
    """Make the most urgent contact in domain `idm` (UPDT), or give up one that has a third block in its gap.

    Returns a code for the change, and the new domain (CUT) or the domain that contains `idm` now (MERGED).
    """
    zero = int64(0)
    if iget(h, idm, g.KDLOOP) == 0:
        return NOTHING, zero
    items = count_items(h, idm)
    seg = np.empty((2 * items + 2, COLUMNS), np.int64)
    ties = np.empty((min(h.ci[g.NVIRT], items), 3), np.int64)
    n, nties = collect(h, idm, seg, ties)
    if getr(h, idm, g.KUMAX) >= h.cr[g.ETOL] + h.cr[g.ETOL]:  # a long step, or a domain that was flagged
        found, merged = delete_occupied_contact(h, idm, seg, n)
        if found:
            return MERGED, merged
        flag_for_search(h, idm)  # contacts made now are not given up at once
    if nties >= MANY and iget(h, idm, g.KDLRG) == 0:
        begin_large(h, idm)
    code, i, j = search(h, seg, n)
    if code <= 0:
        ip = _without_contact(h, seg, n, code, i, j)
        if ip != 0 and h.ci[g.NERR] == 0:
            h.ci[g.NERR] = OVERLAP_TOO_GREAT
            h.ci[g.IERAD] = ip
        return NOTHING, zero
    ib, iad, jb, jad = seg[i, BLOCK], seg[i, ITEM], seg[j, BLOCK], seg[j, ITEM]
    one, two = seg[i, PIECE], seg[j, PIECE]
    if one != two:
        rehook(h, ties[tie_between(ties, one, two), 0], ib, iad, jb, jad, code)
        return MADE, zero
    if not room_for_two(h, contact_words(h), domain_words(h)):
        return NO_ROOM, zero
    if nties > 0:
        pieces = _pieces(h, seg, n, nties, one)
        return CUT, cut_among_pieces(h, ib, iad, jb, jad, code, idm, ties[:nties, 0].copy(), pieces)
    ic = bridge(h, ib, iad, jb, jad, code, idm)
    return CUT, iget(h, ic, g.KD1) if iget(h, ic, g.KD2) == idm else iget(h, ic, g.KD2)


@kernel
def update(h: Memory, idm: int) -> bool:
    """Update domain `idm` and every domain that is cut from it (UPDATE). False if memory ran out."""
    waiting = np.empty(WAITING, np.int64)
    waiting[0] = idm
    n = 1
    if iget(h, idm, g.KDLOOP) != 0:
        update_loop_geometry(h, idm)
    while n > 0:
        here = waiting[n - 1]
        done, idnew = updt(h, here)
        if done == NO_ROOM:
            return False
        if done == NOTHING:
            putr(h, here, g.KUMAX, real(h, 0.0))
            if h.ci[g.NTIPS] > 0:  # test again in the next cycle: the gap may close then
                putr(h, here, g.KUMAX, h.cr[g.ETOL])
                h.cr[g.UPEND] = h.cr[g.HTOL]
            n -= 1
        elif done == CUT:
            putr(h, idnew, g.KUMAX, getr(h, here, g.KUMAX))
            if n < WAITING:  # otherwise it keeps its displacement, and the next pass finds it
                waiting[n] = waiting[n - 1]
                waiting[n - 1] = idnew
                n += 1
        elif done == MERGED:  # waiting ones may not exist any more; _update_all finds them by their flags
            update_loop_geometry(h, idnew)
            waiting[0] = idnew
            n = 1
    return True


@kernel
def _update_all(h: Memory) -> bool:
    """Update every domain whose fictitious displacement exceeds ETOL. False if memory ran out."""
    again = True
    while again:
        again = False
        broken = h.ci[g.NBROKE]
        idm = h.ci[g.IDPNT]
        while idm != 0:
            following = iget(h, idm, g.KD)
            if getr(h, idm, g.KUMAX) > h.cr[g.ETOL]:
                if not update(h, idm):
                    return False
                again = True
            if h.ci[g.NBROKE] != broken:
                break  # domains have merged, the following one may not exist any more
            idm = following
    return True


@outlined
def update_domains(h: Memory, idm: int) -> bool:
    """Update domain `idm`, or with 0 every domain that needs it. False if memory ran out."""
    return bool(_update_all(h) if idm == 0 else update(h, idm))


def updating(h: Memory) -> Any:
    """The address of update_domains for kernels that lead to updates: see compiling.non_inlined_calls."""
    return entry(update_domains, h, 0)
