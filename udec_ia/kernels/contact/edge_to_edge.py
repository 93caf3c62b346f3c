"""Edge-to-edge contacts: the data of domains that are joints, as averages of their two ends (report 2.4).

A joint material with the word ENDS has the report's form. Each end carries its stress on half of the joint:

    Fn = p sn,  sn = (snA + snB)/2,  FnA = p snA/2 = r Fn  with  r = uA/(uA + uB)  for a linear spring

and an end slips where its shear stress has reached the strength under the average normal stress; where the
other end is open, that under its own.
The averages are in the extension of the domain (group 8, KDEX): normal stress as it was after the last cycle,
so that the result does not depend on the order of the contacts.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr, real, size_of
from udec_ia.heap.find_lose import find, lose, room
from udec_ia.kernels.constitutive.joint_materials import MATERIALS, has_ends
from udec_ia.kernels.constitutive.joint_models import closure_of
from udec_ia.kernels.constitutive.joint_stresses import SIDE1, SIDE2, joint_neighbour
from udec_ia.kernels.links.longer_groups import contact_of, joint_at
from udec_ia.layout import offsets as g


@kernel
def uses_ends(h: Memory) -> bool:
    """True if a joint material has the report's form."""
    found = False
    for m in range(MATERIALS):
        found = found or h.ci[g.JMUNIT + m] == g.PER_LENGTH_AT_ENDS
    return found


@kernel
def _joint_with_ends(h: Memory, ic: int) -> int:
    """The joint of contact `ic` if it has the report's form, else 0."""
    ix = joint_at(h, ic) if iget(h, ic, g.KCCOD) != g.VIRTUAL else int64(0)
    return ix if ix != 0 and has_ends(h, ix) else int64(0)


@kernel
def _average(h: Memory, ic: int, ix: int, side: int) -> None:
    """Averages of the ends of the joint on that side of contact `ic`, in the extension of its domain."""
    ie = iget(h, iget(h, ic, g.KD1 if side == SIDE1 else g.KD2), g.KDEX)
    jx = joint_neighbour(h, ic, side)
    if ie == 0 or jx == 0:
        return
    half, zero = real(h, 0.5), real(h, 0.0)
    one, two = closure_of(h, ix), closure_of(h, jx)
    if getr(h, ix, g.KCJSN) == 0:
        one = zero
    if getr(h, jx, g.KCJSN) == 0:
        two = zero
    putr(h, ie, g.KJL, getr(h, ix, g.KCJP1 if side == SIDE1 else g.KCJP2))
    putr(h, ie, g.KJUN, (one + two) * half)
    putr(h, ie, g.KJUS, (getr(h, ic, g.KCS) + getr(h, contact_of(h, jx), g.KCS)) * half)
    putr(h, ie, g.KJSN, (getr(h, ix, g.KCJSN) + getr(h, jx, g.KCJSN)) * half)
    putr(h, ie, g.KJTS, (getr(h, ix, g.KCJTS) + getr(h, jx, g.KCJTS)) * half)


@kernel
def _has_side(h: Memory, ix: int, side: int) -> bool:
    """True if the domain on that side of joint `ix` is a joint."""
    return getr(h, ix, g.KCJP1 if side == SIDE1 else g.KCJP2) > 0


@outlined
def average_ends(h: Memory) -> bool:
    """Averages of all joints in the report's form, after the contact pass."""
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        ix = _joint_with_ends(h, ic)
        for side in (SIDE1, SIDE2):
            if ix != 0 and _has_side(h, ix, side):
                _average(h, ic, ix, side)
        ic = iget(h, ic, g.KC)
    return True


@kernel
def extend_domains(h: Memory) -> bool:
    """Give extensions to the domains that are joints in the report's form, and to no others.

    False if there is no memory; then it is to be called again.
    """
    idm = int64(h.ci[g.IDPNT])
    while idm != 0:
        if iget(h, idm, g.KDEX) != 0:
            putr(h, iget(h, idm, g.KDEX), g.KJL, real(h, 0.0))
        idm = iget(h, idm, g.KD)
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        ix = _joint_with_ends(h, ic)
        for side in (SIDE1, SIDE2):
            if ix != 0 and _has_side(h, ix, side):
                idm = iget(h, ic, g.KD1 if side == SIDE1 else g.KD2)
                if iget(h, idm, g.KDEX) == 0:
                    if not room(h, size_of(h, g.NVDE)):
                        return False
                    puti(h, idm, g.KDEX, find(h, g.NVDE))
                _average(h, ic, ix, side)
        ic = iget(h, ic, g.KC)
    idm = int64(h.ci[g.IDPNT])
    while idm != 0:
        ie = iget(h, idm, g.KDEX)
        if ie != 0 and getr(h, ie, g.KJL) == 0:
            puti(h, idm, g.KDEX, 0)
            lose(h, ie, g.NVDE)
        idm = iget(h, idm, g.KD)
    return True
