"""The commands that set numbers: PROPERTY, GRAVITY, DAMPING, FRACTION, SCALE, FIX, FREE, RSET."""

from __future__ import annotations

import math

from offsets.generated import (
    AKN,
    AKS,
    ALAM1,
    ALAM2,
    ALPB,
    ALPHA,
    AMU,
    BETA,
    BULK,
    COH,
    DENS,
    FRAC,
    GRAVX,
    GRAVY,
    KBFIX,
    KTD,
    KXD,
    KXDP,
    KYD,
    KYDP,
    MFREE,
    PSCALE,
    SHEAR,
)
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.heap.array import MainArray
from udec_ia.kernels.lists import is_corner
from udec_ia.ops.limits import finite, material_number, not_negative
from udec_ia.ops.lists import items
from udec_ia.ops.ranges import Range, blocks_in

DEFAULT_FRACTION = 0.1
PROPERTIES = {  # keyword of the PROPERTY command: array of the common block
    "bulk": BULK,
    "cohesion": COH,
    "density": DENS,
    "kn": AKN,
    "friction": AMU,
    "ks": AKS,
    "g": SHEAR,
}


def set_property(array: MainArray, material: int, **values: float | None) -> None:
    """PROPERTY: set properties of a material; those not given stay. Error 4, or 28 for a negative value."""
    i = material_number(material) - 1
    given = {name: not_negative(name, value) for name, value in values.items() if value is not None}
    cr = array.h.cr
    for name, value in given.items():
        cr[PROPERTIES[name] + i] = value
    cr[ALAM1 + i] = cr[BULK + i] + 4 * cr[SHEAR + i] / 3  # Lame constants of plane strain:
    cr[ALAM2 + i] = cr[BULK + i] - 2 * cr[SHEAR + i] / 3  # K + 4G/3 and K - 2G/3


def set_gravity(array: MainArray, gx: float, gy: float) -> None:
    """GRAVITY: accelerations in the x and y directions."""
    finite(gx, gy)
    array.h.cr[GRAVX], array.h.cr[GRAVY] = gx, gy


def set_damping(array: MainArray, fcrit: float, freq: float, only: str | None = None) -> None:
    """DAMPING: Rayleigh damping with the fraction `fcrit` of critical at the centre frequency `freq` (Hz).

    ALPHA = fcrit 2 pi freq, BETA = fcrit/(2 pi freq). "mass" or "stiffness" drops the other half without
    rescaling, so the damping at the centre frequency is then fcrit/2. "internal" sets the damping of the
    internal degrees of freedom of simply-deformable blocks instead.
    """
    not_negative("the fraction of critical damping", fcrit)
    finite(freq)
    if freq <= 0:
        raise UdecError(28, f"the centre frequency must be positive, it is {freq:g}")
    if only not in (None, "mass", "stiffness", "internal"):
        raise UdecError(10, f"{only}", "mass, stiffness or internal")
    omega = 2 * math.pi * freq
    cr = array.h.cr
    if only == "internal":
        cr[ALPB] = fcrit * omega
        return
    cr[ALPHA] = 0 if only == "stiffness" else fcrit * omega
    cr[BETA] = 0 if only == "mass" else fcrit / omega


def set_fraction(array: MainArray, f: float) -> None:
    """FRACTION: fraction of the critical time-step to be used."""
    finite(f)
    if f <= 0:
        raise UdecError(28, f"the fraction of the critical time-step must be positive, it is {f:g}")
    array.h.cr[FRAC] = f


def set_scale(array: MainArray, s: float) -> None:
    """SCALE: plot scale; 0 lets the plot fill its frame."""
    array.h.cr[PSCALE] = not_negative("the plot scale", s)


def set_fixity(array: MainArray, where: Range, fixed: bool) -> int:
    """FIX and FREE: hold or release the blocks in the range. Returns their number.

    A block that is fixed stops at once; one that is set free starts from rest.
    """
    h = array.h
    blocks = blocks_in(array, where)
    for ib in blocks:
        puti(h, ib, KBFIX, int(fixed))
        if fixed:
            _stop(array, ib)
    return len(blocks)


def _stop(array: MainArray, ib: int) -> None:
    """Set the velocities of block `ib` and of its corners to zero."""
    h = array.h
    for k in (KXD, KYD, KTD):
        putr(h, ib, k, 0.0)
    for item in items(h, ib):
        if is_corner(h, item):
            putr(h, item, KXDP, 0.0)
            putr(h, item, KYDP, 0.0)


def rset(array: MainArray, v: float, ia: int, ioff: int) -> None:
    """RSET: put the real value `v` at offset `ioff` (counted from 1) of the group at address `ia`.

    Error 30 if the real would lie outside the groups in use, or if `ia` cannot be the address of a group.
    """
    finite(v)
    h, ratio = array.h, array.scheme.ratio
    last = int(h.ci[MFREE]) - 1
    if ia < 1 or (ia - 1) % ratio:
        raise UdecError(
            30, f"{ia} is not the address of a group", f"addresses are 1 plus a multiple of {ratio}"
        )
    if ioff < 1 or ia + ioff * ratio - 1 > last:
        raise UdecError(30, f"offset {ioff} from address {ia}", f"the last word in use is {last}")
    h.ra[(ia - 1) // ratio + ioff - 1] = v
