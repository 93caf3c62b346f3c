"""BREAKAGE: blocks that may crack in a run, and their strength (kernels/crack).

The strength is that of each block, and so a range can give it, groups too. Parts of a block that is cut have
its strength.
"""

from __future__ import annotations

from typing import NamedTuple

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.block_ranges import blocks_in
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import not_negative, positive
from udec_ia.reader.group_ranges import Range

FORM = "BREAKAGE x1 x2 y1 y2 TENSION=t SMALLEST=a"
NAMES = "tension", "cohesion", "friction"
NUMBERS = g.KBKT, g.KBKC, g.KBKF, g.KBKA


class Strength(NamedTuple):
    """Strength of a block. joint: of its cracks. numbers: fields NUMBERS."""

    joint: int
    numbers: tuple[float, ...]


def break_blocks(
    array: MainArray, where: Range, joint: int, smallest: float | None, **strength: float | None
) -> int:
    """BREAKAGE ON: the blocks in the range may crack, with this strength. Returns their number.

    joint: number of the joint that cracks belong to, 0 for none. smallest: area of a part, m2. strength:
    tension, cohesion (Pa) and friction; None: it does not crack by that. Error 1, 7 or 28, and nothing is
    changed.
    """
    given = {name: float(value) for name, value in strength.items() if value is not None}
    if smallest is None:
        raise UdecError(7, "SMALLEST a", f"{FORM}: no part of a block becomes smaller", parameter="x1")
    if not given:
        raise UdecError(7, "TENSION t, COHESION c or FRICTION f", FORM, parameter="x1")
    positive(array, smallest=smallest, **{name: v for name, v in given.items() if name == "tension"})
    not_negative(array, **given)
    if not any(given.values()):
        detail = "cohesion and friction are 0, so that nothing breaks a block"
        raise UdecError(28, detail, "give one of them above 0", parameter=next(iter(given)))
    blocks = blocks_in(array, where)
    forget_strengths(array, blocks)
    require(array, len(blocks) * size_of(array.h, g.NVBK))
    numbers = *(given.get(name, 0.0) for name in NAMES), smallest
    for ib in blocks[::-1]:
        add_strength(array, ib, Strength(joint, numbers))
    return len(blocks)


def add_strength(array: MainArray, ib: int, strength: Strength) -> None:
    """Block `ib`, which is not breakable, gets a strength. Error 1."""
    require(array, size_of(array.h, g.NVBK))
    h = array.h
    ik = int(find(h, g.NVBK))
    puti(h, ik, HEAD, g.MBRK)
    puti(h, ik, g.KBKN, int(h.ci[g.IBRPNT]))
    puti(h, ik, g.KBKB, ib)
    puti(h, ik, g.KBKJ, strength.joint)
    for field, value in zip(NUMBERS, strength.numbers, strict=True):
        putr(h, ik, field, h.cr.dtype.type(value))
    h.ci[g.IBRPNT] = ik


def strength_of(h: Memory, ib: int) -> Strength | None:
    """The strength of block `ib`; None if it is not breakable."""
    for ik in list_of(h, "breakable").tolist():
        if iget(h, ik, g.KBKB) == ib:
            return Strength(iget(h, ik, g.KBKJ), tuple(float(getr(h, ik, k)) for k in NUMBERS))
    return None


def keep_whole(array: MainArray, where: Range) -> int:
    """BREAKAGE OFF: the blocks in the range do not crack any more. Returns their number."""
    return forget_strengths(array, blocks_in(array, where))


def forget_strengths(array: MainArray, blocks: list[int]) -> int:
    """Give back the breakable groups of `blocks`; returns how many there were."""
    h, listed = array.h, list_of(array.h, "breakable")
    among = set(blocks)
    gone = [
        ik
        for ik, ib in zip(listed.tolist(), integers(h, listed, g.KBKB).tolist(), strict=True)
        if ib in among
    ]
    drop(h, "breakable", gone)
    return len(gone)


def joint_of_cracks(array: MainArray, jmaterial: int) -> int:
    """Number of the joint of cracks with that joint material in other blocks; 0 if there is none."""
    h = array.h
    joints = {iget(h, ik, g.KBKJ) for ik in list_of(h, "breakable").tolist()} - {0}
    return min((n for n in joints if h.ci[g.JLINE + n - 1] == jmaterial), default=0)
