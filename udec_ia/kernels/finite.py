"""Has a run driven a number beyond the reals?

A force or a velocity that is infinite, or no number at all, moves its block out of the world in the next
cycle, and error 36 ends the run there. After the last cycle there is no next one: so all groups that a
cycle writes are looked through once. Corners follow from their block or their grid-points, and need no look.
"""

from __future__ import annotations

import numpy as np

from offsets.generated import (
    IBPNT,
    ICPNT,
    KB,
    KBEX,
    KBFT,
    KBFX,
    KBFY,
    KBI,
    KBRO,
    KC,
    KCFN,
    KCFS,
    KCN,
    KCS,
    KED11,
    KED12,
    KED21,
    KED22,
    KFG,
    KFZ,
    KG,
    KGFX,
    KGFY,
    KS111,
    KS112,
    KS122,
    KSA11,
    KSA12,
    KSA21,
    KSA22,
    KSJ11,
    KSJ12,
    KSJ22,
    KTD,
    KX,
    KXD,
    KXDC,
    KXDG,
    KXG,
    KY,
    KYD,
    KYDC,
    KYDG,
    KYG,
    KZ,
    KZS11,
    KZS12,
    KZS22,
    MFDEF,
    MSDEF,
)
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, int64
from udec_ia.heap.jit import kernel

OF_BLOCK = (KX, KY, KXD, KYD, KTD, KBI, KBRO, KBFX, KBFY, KBFT)
OF_SDEF = (KED11, KED12, KED21, KED22, KS111, KS112, KS122, KSA11, KSA12, KSA21, KSA22, KSJ11, KSJ12, KSJ22)
OF_POINT = (KXG, KYG, KXDG, KYDG, KGFX, KGFY)
OF_ZONE = (KZS11, KZS12, KZS22)
OF_CONTACT = (KXDC, KYDC, KCS, KCN, KCFS, KCFN)


@kernel
def _finite(h: Memory, iad: int, fields: tuple[Offset, ...]) -> bool:
    """True if those fields of the group at `iad` are finite."""
    finite = True
    for k in fields:
        finite = finite and bool(np.isfinite(getr(h, iad, k)))
    return finite


@kernel
def _all_finite(h: Memory, iad: int, following: Offset, fields: tuple[Offset, ...]) -> bool:
    """True if those fields are finite in all groups of the list that begins at `iad`."""
    while iad != 0:
        if not _finite(h, iad, fields):
            return False
        iad = iget(h, iad, following)
    return True


@kernel
def _body_finite(h: Memory, ib: int) -> bool:
    """True if block `ib` and its extension hold finite numbers."""
    kind, ie = iget(h, ib, HEAD), iget(h, ib, KBEX)
    if kind == MSDEF and not _finite(h, ie, OF_SDEF):
        return False
    if kind == MFDEF and not _all_finite(h, iget(h, ie, KFG), KG, OF_POINT):
        return False
    if kind == MFDEF and not _all_finite(h, iget(h, ie, KFZ), KZ, OF_ZONE):
        return False
    return _finite(h, ib, OF_BLOCK)


@kernel
def not_finite(h: Memory) -> int:
    """A block, or else a contact, with a number that is not finite; 0 if there is none."""
    ib = h.ci[IBPNT]
    while ib != 0:
        if not _body_finite(h, ib):
            return ib
        ib = iget(h, ib, KB)
    ic = h.ci[ICPNT]
    while ic != 0:
        if not _finite(h, ic, OF_CONTACT):
            return ic
        ic = iget(h, ic, KC)
    return int64(0)
