"""Distribution of the mass of a block: Euler tensor (SDEF), masses of zones and grid-points (FDEF)."""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, puti, putr, real
from udec_ia.heap.find_lose import find
from udec_ia.kernels.body.fdef import zone_area
from udec_ia.kernels.body.sdef import put_strain_rate, put_stress
from udec_ia.kernels.geometry.block_shape import density_of, geo, makeb
from udec_ia.layout import offsets as g


@kernel
def _euler(h: Memory, ib: int) -> None:
    """Area and Euler tensor of simply-deformable block `ib`."""
    ie = iget(h, ib, g.KBEX)
    area, _, _, jxx, jxy, jyy = geo(h, ib)
    density = getr(h, ib, g.KBM) / area
    putr(h, ie, g.KSAREA, area)
    putr(h, ie, g.KSJ11, density * jxx)
    putr(h, ie, g.KSJ12, density * jxy)
    putr(h, ie, g.KSJ22, density * jyy)


@kernel
def _lump(h: Memory, ib: int) -> None:
    """Masses of the zones of block `ib` by their areas; a third of each goes to each of its grid-points."""
    ie = iget(h, ib, g.KBEX)
    third = real(h, 1.0) / real(h, 3.0)
    ig = iget(h, ie, g.KFG)
    while ig != 0:
        putr(h, ig, g.KGPM, real(h, 0.0))
        ig = iget(h, ig, g.KG)
    area, _, _, _, _, _ = geo(h, ib)
    density = getr(h, ib, g.KBM) / area
    iz = iget(h, ie, g.KFZ)
    while iz != 0:
        mass = density * zone_area(h, iz)
        putr(h, iz, g.KZM, mass)
        for k in range(3):
            ig = iget(h, iz, g.KZG, k)
            putr(h, ig, g.KGPM, getr(h, ig, g.KGPM) + mass * third)
        iz = iget(h, iz, g.KZ)


@kernel
def share_mass(h: Memory, ib: int) -> None:
    """Distribute the mass KBM of block `ib` as its type requires."""
    if iget(h, ib, HEAD) == g.MSDEF:
        _euler(h, ib)
    elif iget(h, ib, HEAD) == g.MFDEF:
        _lump(h, ib)


@kernel
def share_extension(h: Memory, ib: int, jb: int) -> None:
    """Block `jb`, cut from simply-deformable block `ib`, has the same type, stress and strain rate.

    Both parts have the velocities of a rigid body yet; with the strain rate e, the velocity field of the
    block stays: e r is added at their centroids, r from that of the whole.
    """
    ie, je = iget(h, ib, g.KBEX), find(h, g.NVSD)
    puti(h, jb, HEAD, g.MSDEF)
    puti(h, jb, g.KBEX, je)
    h.ci[g.NSOFT] += 1
    put_stress(h, je, getr(h, ie, g.KS111), getr(h, ie, g.KS112), getr(h, ie, g.KS122))
    put_strain_rate(h, je, getr(h, ie, g.KED11), getr(h, ie, g.KED12), getr(h, ie, g.KED22))
    share_mass(h, ib)
    share_mass(h, jb)
    e11, e12, e22 = getr(h, ie, g.KED11), getr(h, ie, g.KED12), getr(h, ie, g.KED22)
    m, n = getr(h, ib, g.KBM), getr(h, jb, g.KBM)
    if e11 == 0 and e12 == 0 and e22 == 0:  # also before the first cycle, without masses
        return
    dx, dy = getr(h, jb, g.KX) - getr(h, ib, g.KX), getr(h, jb, g.KY) - getr(h, ib, g.KY)
    for b, part in ((ib, -n / (m + n)), (jb, m / (m + n))):
        putr(h, b, g.KXD, getr(h, b, g.KXD) + (e11 * dx + e12 * dy) * part)
        putr(h, b, g.KYD, getr(h, b, g.KYD) + (e12 * dx + e22 * dy) * part)


@kernel
def greatest_block(h: Memory) -> float:
    """Greatest distance of a corner from the centroid of its block."""
    largest = real(h, 0.0)
    ib = h.ci[g.IBPNT]
    while ib != 0:
        largest = max(largest, getr(h, ib, g.KBRO))
        ib = iget(h, ib, g.KB)
    return largest


@kernel
def make_masses(h: Memory, soft: Any) -> None:
    """Set masses and moments of inertia of all blocks from the present densities."""
    ib = h.ci[g.IBPNT]
    while ib != 0:
        makeb(h, ib, density_of(h, ib))
        if soft is not None:
            share_mass(h, ib)
        ib = iget(h, ib, g.KB)


@kernel
def zone_means(h: Memory, ie: int) -> tuple[float, float, float, float]:
    """Area of all zones of the extension `ie`, and their stresses 11, 12, 22 times area."""
    zero = real(h, 0.0)
    total, s11, s12, s22 = zero, zero, zero, zero
    iz = iget(h, ie, g.KFZ)
    while iz != 0:
        area = zone_area(h, iz)
        total += area
        s11 += area * getr(h, iz, g.KZS11)
        s12 += area * getr(h, iz, g.KZS12)
        s22 += area * getr(h, iz, g.KZS22)
        iz = iget(h, iz, g.KZ)
    return total, s11, s12, s22
