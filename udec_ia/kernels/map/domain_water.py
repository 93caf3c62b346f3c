"""Water of domains that are cut, merged or emptied by DELETE (report 2.8).

Both parts of a domain that is cut have its pressure and saturation, and half its volume each, until volumes
are found again (water/water_pressure.py). Domains that merge add up their volumes and their water. If the
pressure of one of them is held, that of the whole is. The outer domain holds no water.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget, puti, putr, real
from udec_ia.heap.find_lose import clear_group
from udec_ia.kernels.links.longer_groups import water_at
from udec_ia.layout import offsets as g


@inlined
def water_in(h: Memory, p: float, saturation: float, volume: float) -> float:
    """Water in a domain, as the volume (m2) that it has at the pressure 0. A held pressure may be below 0."""
    return volume * (saturation + max(p, 0.0) / h.cr[g.WKW])


@kernel
def water_of(h: Memory, idm: int) -> float:
    """The same of domain `idm`."""
    ix = water_at(h, idm)
    p, saturation = np.float64(getr(h, idm, g.KPP)), np.float64(getr(h, ix, g.KVSAT))
    return water_in(h, p, saturation, np.float64(getr(h, ix, g.KVVOL)))


@inlined
def excess_in(h: Memory, idm: int, volume: float) -> float:
    """Water in domain `idm`, if it has that volume, less what fills it at the pressure 0."""
    p, saturation = np.float64(getr(h, idm, g.KPP)), np.float64(getr(h, water_at(h, idm), g.KVSAT))
    return volume * (max(p, 0.0) / h.cr[g.WKW] + (saturation - 1.0))


@kernel
def put_water(h: Memory, idm: int, volume: float, excess: float) -> None:
    """Volume of domain `idm`, and the pressure and saturation that follow from the water in it.

    excess: the water less what fills the volume at the pressure 0, in m2.
    """
    p, saturation = 0.0, 1.0
    if excess >= 0:
        p = excess * h.cr[g.WKW] / volume if volume > 0 else 0.0
    else:
        saturation = max(1.0 + excess / volume, 0.0) if volume > 0 else 0.0
    putr(h, idm, g.KPP, p)
    putr(h, water_at(h, idm), g.KVSAT, saturation)
    putr(h, water_at(h, idm), g.KVVOL, volume)


@inlined
def is_held(h: Memory, idm: int) -> bool:
    """True if the pressure of domain `idm` is held."""
    code = iget(h, water_at(h, idm), g.KVCODE)
    return code in (g.HELD, g.EXCAVATED)


@kernel
def empty_domain(h: Memory, idm: int) -> None:
    """The water of domain `idm` leaves to the outside."""
    h.cd[g.WATIN] -= water_of(h, idm)
    putr(h, idm, g.KPP, real(h, 0.0))
    clear_group(h, water_at(h, idm), g.NVWA)


@kernel
def drain_domain(h: Memory, idm: int) -> None:
    """Blocks were deleted in domain `idm`: it is drained."""
    if h.ci[g.LWATER] != 0 and idm != h.ci[g.IODPNT]:
        volume = getr(h, water_at(h, idm), g.KVVOL)
        empty_domain(h, idm)
        puti(h, water_at(h, idm), g.KVCODE, g.EXCAVATED)
        putr(h, water_at(h, idm), g.KVVOL, volume)


@kernel
def cut_water(h: Memory, idm: int, idnew: int) -> None:
    """Domain `idnew` has been cut from domain `idm`; the outer domain is one of the two, or neither."""
    if idm == h.ci[g.IODPNT] or idnew == h.ci[g.IODPNT]:
        inner = idnew if idm == h.ci[g.IODPNT] else idm
        puti(h, water_at(h, inner), g.KVCODE, g.CUT_FROM_OUTSIDE)
        return
    one, two = water_at(h, idm), water_at(h, idnew)
    puti(h, two, g.KVCODE, iget(h, one, g.KVCODE))
    putr(h, one, g.KVVOL, getr(h, one, g.KVVOL) * real(h, 0.5))
    putr(h, idnew, g.KPP, getr(h, idm, g.KPP))
    for k in (g.KVSAT, g.KVVOL, g.KVX, g.KVY, g.KVGX, g.KVGY):
        putr(h, two, k, getr(h, one, k))


@kernel
def merge_water(h: Memory, gone: int, kept: int) -> None:
    """The water of domain `gone`, which is going to be lost, comes into domain `kept`."""
    outer = h.ci[g.IODPNT]
    if gone == outer or kept == outer:
        empty_domain(h, kept if gone == outer else gone)
        return
    one, two = water_at(h, gone), water_at(h, kept)
    putr(h, two, g.KVGIVN, getr(h, one, g.KVGIVN) + getr(h, two, g.KVGIVN))
    volume = np.float64(getr(h, one, g.KVVOL)) + np.float64(getr(h, two, g.KVVOL))
    if not (is_held(h, gone) or is_held(h, kept)):
        excess = excess_in(h, gone, np.float64(getr(h, one, g.KVVOL)))
        excess += excess_in(h, kept, np.float64(getr(h, two, g.KVVOL)))
        put_water(h, kept, volume, excess)
        puti(h, two, g.KVCODE, g.FLOWS)
        return
    before = water_of(h, gone) + water_of(h, kept)
    if not is_held(h, kept):
        puti(h, two, g.KVCODE, iget(h, one, g.KVCODE))
        putr(h, kept, g.KPP, getr(h, gone, g.KPP))
        for k in (g.KVSAT, g.KVX, g.KVY, g.KVGX, g.KVGY):
            putr(h, two, k, getr(h, one, k))
    putr(h, two, g.KVVOL, volume)
    h.cd[g.WATIN] += water_of(h, kept) - before
