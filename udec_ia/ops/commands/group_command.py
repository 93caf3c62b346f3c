"""GROUP: a name for the blocks that are in a range now, wherever they move later."""

from __future__ import annotations

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, iget, puti, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.block_ranges import blocks_in
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.reader.block_groups import letters_of
from udec_ia.reader.group_ranges import PARTS, Range


def set_group(array: MainArray, name: str, where: Range) -> int:
    """GROUP: the blocks in the range are group `name`, and no others. Returns their number.

    Error 10 for an impossible name. Without a block in the range nothing changes.
    """
    words = letters_of(name)
    if name.upper() in (*PARTS, "NOT", "RANGE", "ZONE", "BLOCK", "CONTACT"):
        advice = "the name of the group comes first, then a range: GROUP crown CIRCLE 0 5 2"
        raise UdecError(10, f"{name} is not the name of a group", advice, parameter="name")
    blocks = blocks_in(array, where)
    if not blocks:
        return 0
    _drop_group(array, words)
    add_members(array, words, blocks)
    return len(blocks)


def add_members(array: MainArray, words: list[int], blocks: list[int]) -> None:
    """Add blocks to the group whose name has these words."""
    require(array, len(blocks) * size_of(array.h, g.NVMB))
    h = array.h
    for ib in blocks[::-1]:
        im = int(find(h, g.NVMB))
        puti(h, im, HEAD, g.MMBR)
        puti(h, im, g.KI, int(h.ci[g.IMBPNT]))
        puti(h, im, g.KIB, ib)
        for i, word in enumerate(words):
            puti(h, im, g.KIN, word, i)
        h.ci[g.IMBPNT] = im


def _drop_group(array: MainArray, words: list[int]) -> None:
    """Give back the members of the group with that name."""
    h, members = array.h, list_of(array.h, "member")
    same = [all(iget(h, im, g.KIN, i) == word for i, word in enumerate(words)) for im in members.tolist()]
    drop(h, "member", members[same].tolist())
