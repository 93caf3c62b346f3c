"""SPROPERTY and BOLT (report section 5, structural connection)."""

from __future__ import annotations

import math
from collections.abc import Iterator

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.structures.attached_points import block_at, zone_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.attached_structures import attach, number_of_structures
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.number_limits import NMAT, check_real_range, finite, not_negative, whole
from udec_ia.printable_text import counted
from udec_ia.remark import Remark

SPROPERTIES = {one.argument: getattr(g, one.array) for one in read_table().structural_properties}


def structural_number(smaterial: int) -> int:
    """`smaterial` if it is the number of a structural material, else error 4."""
    if not 1 <= whole(smaterial=smaterial) <= NMAT:
        advice = f"structural materials run from 1 to {NMAT}"
        raise UdecError(4, f"{smaterial}", advice, parameter="smaterial")
    return smaterial


def set_structural_property(array: MainArray, smaterial: int, **values: float | None) -> None:
    """SPROPERTY: properties of a structural material; those not given stay.

    Forces in structures stay as they are. Error 4 or 28, and nothing is changed.
    """
    i = structural_number(smaterial) - 1
    given = {name: value for name, value in values.items() if value is not None}
    not_negative(array, **given)
    for name, value in given.items():
        array.h.cr[SPROPERTIES[name] + i] = value


def make_bolt(
    array: MainArray, x1: float, y1: float, x2: float, y2: float, smaterial: int, pretension: float
) -> int:
    """BOLT: a bolt between the blocks at two points. Returns its address.

    Error 4, 26 without a block or a stiffness, or 28; nothing is changed then.
    """
    finite(array, x1=x1, y1=y1, x2=x2, y2=y2)
    not_negative(array, pretension=pretension)
    i, h = structural_number(smaterial) - 1, array.h
    length = math.hypot(x2 - x1, y2 - y1)
    if not length > float(h.cr[g.FTOL]):
        raise UdecError(28, f"the bolt is {length:g} m long", "give two points apart", parameter="x2")
    if not (h.cr[g.STKN + i] > 0 or h.cr[g.STYM + i] * h.cr[g.STAREA + i] > 0):
        advice = f"first SPROPERTY SMATERIAL={smaterial} YOUNG=... AREA=..., or KN=..."
        raise UdecError(26, f"structural material {smaterial} is not stiff", advice, parameter="smaterial")
    check_real_range(array, "the length of the bolt", [length])
    ends = [held_point(array, x1, y1, "x1"), held_point(array, x2, y2, "x2")]
    require(array, size_of(h, g.NVBT))
    h = array.h
    ia = int(find(h, g.NVBT))
    numbers = (HEAD, g.MBLT), (g.KA, int(h.ci[g.IBTPNT])), (g.KAMAT, smaterial)
    for k, number in numbers:
        puti(h, ia, k, number)
    for (ib, iz), to_block, to_zone in zip(ends, (g.KAB1, g.KAB2), (g.KAZ1, g.KAZ2), strict=True):
        puti(h, ia, to_block, ib)
        puti(h, ia, to_zone, iz)
    reals = (g.KAX1, x1), (g.KAY1, y1), (g.KAX2, x2), (g.KAY2, y2), (g.KALEN, length), (g.KAFN, pretension)
    for k, value in reals:
        putr(h, ia, k, value)
    h.ci[g.IBTPNT] = ia
    renew_forces(array)
    return ia


def held_point(array: MainArray, x: float, y: float, parameter: str) -> tuple[int, int]:
    """Block and zone that hold a point; the zone is 0 in a block without zones. Error 26 outside all blocks."""
    h = array.h
    x, y = float(h.cr.dtype.type(x)), float(h.cr.dtype.type(y))
    ib = int(block_at(h, x, y, 0))
    if not ib:
        raise UdecError(26, f"there is no block at ({x:g}, {y:g})", "PRINT BLOCKS shows them", parameter=parameter)
    return ib, int(zone_at(h, ib, x, y))


def update_structures(array: MainArray, before: int) -> Iterator[Remark]:
    """After a command that may have changed blocks: points belong to what is there now.

    before: number of structures before it. Yields a remark if some have been given back.
    """
    if attach(array.h) or array.h.ci[g.MCTOT] == 0:  # until then commands do not sum forces
        renew_forces(array)
    lost = before - number_of_structures(array.h)
    if lost > 0:
        text = f"{counted(lost, 'structure')} removed, of which an end is in no block any more"
        yield Remark("structures-removed", text)
