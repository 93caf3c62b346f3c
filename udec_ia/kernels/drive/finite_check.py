"""Check that all reals of a model are finite numbers.

An infinite force or velocity, or one that is not a number, moves its block beyond all limits in the next
cycle, where error 36 ends the run. After the last cycle there is no next one. So all reals of blocks, of
their members, of contacts and of structures are checked once.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

# Offsets of all reals of a kind of group, from the field table, and how many; 0 fills tuples of one length.
LISTED = {
    group.name: [getattr(g, field.name) for field in group.fields if field.real]
    for group in read_table().groups
}
LONGEST = max(len(fields) for fields in LISTED.values())
REALS = {name: ((*fields, *(LONGEST - len(fields)) * [HEAD]), len(fields)) for name, fields in LISTED.items()}
OF_BLOCK, OF_CORNER, OF_CONTACT = REALS["block"], REALS["corner"], REALS["contact"]
OF_BOLT, OF_NODE, OF_ELEMENT = REALS["bolt"], REALS["node"], REALS["element"]
OF_SDEF, OF_FDEF, OF_POINT, OF_ZONE = REALS["sdef"], REALS["fdef"], REALS["gridpoint"], REALS["zone"]


@kernel
def _finite(h: Memory, iad: int, reals: tuple[tuple[Offset, ...], int]) -> bool:
    """True if those fields of the group at `iad` are finite."""
    fields, n = reals
    finite = True
    for i in range(n):
        finite = finite and bool(np.isfinite(getr(h, iad, fields[i])))
    return finite


@kernel
def _all_finite(h: Memory, iad: int, following: Offset, reals: tuple[tuple[Offset, ...], int]) -> bool:
    """True if those fields are finite in all groups of the list that begins at `iad`, or of the ring."""
    first = iad
    while iad != 0:
        if not _finite(h, iad, reals):
            return False
        iad = iget(h, iad, following)
        if iad == first:
            break
    return True


@kernel
def _body_finite(h: Memory, ib: int) -> bool:
    """True if all reals of block `ib`, its corners and its extension are finite."""
    if not (_finite(h, ib, OF_BLOCK) and _all_finite(h, iget(h, ib, g.KP), g.KR, OF_CORNER)):
        return False
    kind, ie = iget(h, ib, HEAD), iget(h, ib, g.KBEX)
    if kind == g.MSDEF:
        return _finite(h, ie, OF_SDEF)
    if kind == g.MFDEF:
        points = _all_finite(h, iget(h, ie, g.KFG), g.KG, OF_POINT)
        return points and _all_finite(h, iget(h, ie, g.KFZ), g.KZ, OF_ZONE) and _finite(h, ie, OF_FDEF)
    return True


@kernel
def first_not_finite(h: Memory) -> int:
    """A block, or else a contact or structure, with a number that is not finite; 0 if there is none."""
    ib = h.ci[g.IBPNT]
    while ib != 0:
        if not _body_finite(h, ib):
            return ib
        ib = iget(h, ib, g.KB)
    ic = h.ci[g.ICPNT]
    while ic != 0:
        if not _finite(h, ic, OF_CONTACT):
            return ic
        ic = iget(h, ic, g.KC)
    for first, following, reals in (
        (h.ci[g.IBTPNT], g.KA, OF_BOLT),
        (h.ci[g.INDPNT], g.KN, OF_NODE),
        (h.ci[g.IELPNT], g.KM, OF_ELEMENT),
    ):
        at = int64(first)
        while at != 0:
            if not _finite(h, at, reals):
                return at
            at = iget(h, at, following)
    return int64(0)
