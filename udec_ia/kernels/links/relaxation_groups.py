"""The list of relaxations: one for each block without grid-points, and one for each grid-point.

They are in the order of the block list and the lists of grid-points, so that a walk along these needs no
search.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import HEAD, Memory, iget, int64, puti, putr, real
from udec_ia.heap.find_lose import find, lose
from udec_ia.layout import offsets as g


@inlined
def next_relaxation(h: Memory, ir: int) -> int:
    """The relaxation after `ir`, 0 if there are none."""
    return iget(h, ir, g.KRX) if ir != 0 else int64(0)


@kernel
def lose_relaxations(h: Memory) -> None:
    """Give back all relaxations."""
    ir = int64(h.ci[g.IRXPNT])
    h.ci[g.IRXPNT] = 0
    while ir != 0:
        after = iget(h, ir, g.KRX)
        lose(h, ir, g.NVRX)
        ir = after


@kernel
def _relaxation(h: Memory, last: int, ib: int, ig: int) -> int:
    """Make a relaxation of block `ib`, or its grid-point `ig`, after the one at `last`; its factors are 1."""
    ir, one = find(h, g.NVRX), real(h, 1.0)
    puti(h, ir, HEAD, g.MRLX)
    puti(h, ir, g.KRXB, ib)
    puti(h, ir, g.KRXG, ig)
    putr(h, ir, g.KRXM, one)
    if ig == 0:
        putr(h, ir, g.KRXI, one)
        if iget(h, ib, HEAD) == g.MSDEF:
            putr(h, ir, g.KRXE, one)
    if last == 0:
        h.ci[g.IRXPNT] = ir
    else:
        puti(h, last, g.KRX, ir)
    return int64(ir)


@kernel
def make_relaxations(h: Memory) -> None:
    """Make all relaxations if there are none; there must be memory for them."""
    last = int64(0)
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        if iget(h, ib, HEAD) == g.MFDEF:
            ig = iget(h, iget(h, ib, g.KBEX), g.KFG)
            while ig != 0:
                last = _relaxation(h, last, ib, ig)
                ig = iget(h, ig, g.KG)
        else:
            last = _relaxation(h, last, ib, int64(0))
        ib = iget(h, ib, g.KB)
