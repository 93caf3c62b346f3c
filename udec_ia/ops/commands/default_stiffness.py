"""Stiffnesses of contacts whose material has moduli, but neither KN nor KS."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from udec_ia.heap.accessors import integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.longer_groups import joints_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.common.number_limits import NMAT
from udec_ia.reader.group_tables import table

KN, KS = (
    getattr(g, one.array) for name in ("kn", "ks") for one in read_table().properties if one.argument == name
)
STIFFER = 10.0  # times the stiffness of a block as large as the length of joint at the contact


def settle_stiffness(array: MainArray) -> Iterator[str]:
    """Give such materials KN = KS = 10 (K + 4 G/3) before a run; a line for each.

    A block of the size s yields by K + 4 G/3 over s per length. A contact stands for a joint of about the
    length s, so that its stiffness, a force by displacement and thickness, does not depend on s.
    """
    h = array.h
    modulus = h.cr[g.BULK : g.BULK + NMAT].astype(np.float64) + 4 / 3 * h.cr[g.SHEAR : g.SHEAR + NMAT]
    lacks = (h.cr[KN : KN + NMAT] == 0) & (h.cr[KS : KS + NMAT] == 0) & (modulus > 0)
    if not lacks.any():
        return
    contacts = table(array, "contact")
    contacts = contacts[contacts["KCCOD"] != g.VIRTUAL]
    joint = joints_at(h, contacts["address"])
    own = np.where(joint != 0, integers(h, np.where(joint != 0, joint, 1), g.KCJMAT), 0) <= 0
    materials = np.unique(integers(h, contacts["KB1"][own], g.KMAT)) if own.any() else ()
    for m in (int(one) for one in materials if lacks[one - 1]):
        stiffness = STIFFER * float(modulus[m - 1])
        h.cr[KN + m - 1] = h.cr[KS + m - 1] = stiffness
        what = f"{stiffness:.4g} N/m2 for each contact, {STIFFER:g} (K + 4 G/3)"
        yield f"material {m} has no KN and KS: they are {what}"
