"""INSITU: initial stresses in deformable blocks.

Zones and simply-deformable blocks get S(x, y) = S0 + x SX + y SY at their centroids, tension positive. The
forces at contacts follow from overlaps and cannot be given: they grow while the blocks spread against each
other, by the small strain that closes the joints.
"""

from __future__ import annotations

from offsets.generated import KBEX, KFZ, KX, KXG, KY, KYG, KZ, KZG, KZS11, KZS12, KZS22, MFDEF, MSDEF
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, getr, iget, putr
from udec_ia.heap.array import MainArray
from udec_ia.kernels.sdef import put_stress
from udec_ia.ops.bounds import ZERO, Triple
from udec_ia.ops.forces import renew_forces
from udec_ia.ops.limits import finite
from udec_ia.ops.lists import chain
from udec_ia.ops.ranges import Range, blocks_in


def insitu(array: MainArray, where: Range, stress: Triple, xgrad: Triple = ZERO, ygrad: Triple = ZERO) -> int:
    """INSITU: stresses (Pa; 11, 12, 22) of the deformable blocks in the range. Returns the number of blocks.

    Error 24 if no deformable block with zones lies in the range.
    """
    for name, triple in (("s11", stress), ("xgrad", xgrad), ("ygrad", ygrad)):
        for component in triple:
            finite(array, **{name: component})
    h = array.h

    def at(x: float, y: float) -> Triple:
        one, two, three = (s + x * sx + y * sy for s, sx, sy in zip(stress, xgrad, ygrad, strict=True))
        return one, two, three

    done = 0
    for ib in blocks_in(array, where):
        ie = iget(h, ib, KBEX)
        if iget(h, ib, HEAD) == MSDEF:
            values = at(float(getr(h, ib, KX)), float(getr(h, ib, KY)))
            put_stress(h, ie, *(h.cr.dtype.type(s) for s in values))
            done += 1
        elif iget(h, ib, HEAD) == MFDEF and iget(h, ie, KFZ):
            for iz in chain(h, iget(h, ie, KFZ), KZ):
                corners = [iget(h, iz, KZG, i) for i in range(3)]
                x, y = (sum(float(getr(h, ig, k)) for ig in corners) / 3 for k in (KXG, KYG))
                for k, value in zip((KZS11, KZS12, KZS22), at(x, y), strict=True):
                    putr(h, iz, k, value)
            done += 1
    if not done:
        place = "x {:g} to {:g}, y {:g} to {:g}".format(*where)
        advice = "CHANGE and GENERATE make them"
        raise UdecError(24, f"no deformable block with zones in {place}", advice, parameter="x1")
    renew_forces(array)
    return done
