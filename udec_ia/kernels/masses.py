"""How the mass of a block is spread: Euler tensor (SDEF), masses of zones and grid-points (FDEF)."""

from __future__ import annotations

from offsets.generated import (
    IBPNT,
    KB,
    KBEX,
    KBM,
    KFG,
    KFZ,
    KG,
    KGPM,
    KSAREA,
    KSJ11,
    KSJ12,
    KSJ22,
    KZ,
    KZG,
    KZM,
    KZS11,
    KZS12,
    KZS22,
    MFDEF,
    MSDEF,
)
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr, real
from udec_ia.heap.jit import kernel
from udec_ia.kernels.fdef import zone_area
from udec_ia.kernels.shape import geo, makeb


@kernel
def _euler(h: Memory, ib: int) -> None:
    """Area and Euler tensor of simply-deformable block `ib`."""
    ie = iget(h, ib, KBEX)
    area, _, _, jxx, jxy, jyy = geo(h, ib)
    density = getr(h, ib, KBM) / area
    putr(h, ie, KSAREA, area)
    putr(h, ie, KSJ11, density * jxx)
    putr(h, ie, KSJ12, density * jxy)
    putr(h, ie, KSJ22, density * jyy)


@kernel
def _lump(h: Memory, ib: int) -> None:
    """Masses of the zones of block `ib` by their areas; a third of each goes to each of its grid-points."""
    ie = iget(h, ib, KBEX)
    third = real(h, 1.0) / real(h, 3.0)
    ig = iget(h, ie, KFG)
    while ig != 0:
        putr(h, ig, KGPM, real(h, 0.0))
        ig = iget(h, ig, KG)
    area, _, _, _, _, _ = geo(h, ib)
    density = getr(h, ib, KBM) / area
    iz = iget(h, ie, KFZ)
    while iz != 0:
        mass = density * zone_area(h, iz)
        putr(h, iz, KZM, mass)
        for k in range(3):
            ig = iget(h, iz, KZG, k)
            putr(h, ig, KGPM, getr(h, ig, KGPM) + mass * third)
        iz = iget(h, iz, KZ)


@kernel
def share_mass(h: Memory, ib: int) -> None:
    """Spread the mass KBM of block `ib` over what its type gives mass to."""
    if iget(h, ib, HEAD) == MSDEF:
        _euler(h, ib)
    elif iget(h, ib, HEAD) == MFDEF:
        _lump(h, ib)


@kernel
def make_masses(h: Memory) -> None:
    """Masses and moments of inertia of all blocks from the densities as they are now."""
    ib = h.ci[IBPNT]
    while ib != 0:
        makeb(h, ib)
        share_mass(h, ib)
        ib = iget(h, ib, KB)


@kernel
def zone_means(h: Memory, ie: int) -> tuple[float, float, float, float]:
    """Area of all zones of the extension `ie`, and their stresses 11, 12, 22 times area."""
    zero = real(h, 0.0)
    total, s11, s12, s22 = zero, zero, zero, zero
    iz = iget(h, ie, KFZ)
    while iz != 0:
        area = zone_area(h, iz)
        total += area
        s11 += area * getr(h, iz, KZS11)
        s12 += area * getr(h, iz, KZS12)
        s22 += area * getr(h, iz, KZS22)
        iz = iget(h, iz, KZ)
    return total, s11, s12, s22
