"""CHANGE and DELETE: type, material and constitutive numbers of blocks, and their removal (report 4.2, 4.3).

A change of type keeps momentum and angular momentum. A rigid block that becomes deformable in a run gets the
mean stress of its contact forces and loads, so that a block at rest stays at rest. Between the deformable
types the mean stress is kept. Strain rates are lost, as is the motion of grid-points relative to the rigid
motion. With zones, boundary conditions on the block and the corners of GENERATE on its edges are lost. Masses
do not change after the first cycle.
"""

from __future__ import annotations

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.boundary_conditions import add_loads
from udec_ia.kernels.body.mass_distribution import share_mass, zone_means
from udec_ia.kernels.body.motion import set_corner_velocities
from udec_ia.kernels.body.sdef import put_stress
from udec_ia.kernels.constitutive.joint_properties import assign_material
from udec_ia.kernels.geometry.block_shape import geo
from udec_ia.kernels.links.linked_lists import is_corner
from udec_ia.kernels.links.longer_groups import lose_gridpoint
from udec_ia.kernels.map.block_removal import delb
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary_command import forget_blocks, set_loads
from udec_ia.ops.commands.corner_rounding import bring_up, check_overlaps, update_flagged
from udec_ia.ops.commands.excavation_loads import loads_of_blocks
from udec_ia.ops.commands.function_command import existing_function
from udec_ia.ops.commands.remove_edge_points import check_straight, edge_points, renew_reach, straighten
from udec_ia.ops.common.array_growth import all_or_nothing, require
from udec_ia.ops.common.block_ranges import blocks_in, items
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import lose_hosted
from udec_ia.ops.common.number_limits import check_real_range, constitutive_number, material_number
from udec_ia.reader.group_ranges import Range
from udec_ia.reader.list_walks import chain

STAYS = "leave the block fully-deformable"
TYPES = {"rigid": g.MRIG, "sdef": g.MSDEF, "fdef": g.MFDEF}
Stress = tuple[float, float, float]  # 11, 12, 22


def change(
    array: MainArray, where: Range, kind: str | None, material: int | None, constitutive: int | None
) -> int:
    """CHANGE: attributes of the blocks in the range. Returns their number.

    Contacts follow their first block (report 4.3). Masses follow a new material only before the first cycle.
    Errors 1, 4, 9, 10, 14 and 28; nothing is changed then.
    """
    if kind is not None and kind not in TYPES:
        raise UdecError(10, f"{kind}", ", ".join(TYPES))
    if material is not None:
        material_number(material)
    if constitutive is not None:
        constitutive_number(constitutive)
    blocks = blocks_in(array, where)
    if kind is not None:
        change_types(array, blocks, TYPES[kind])
    h = array.h
    for ib in blocks if material is not None or constitutive is not None else ():
        for number, of_block in ((material, g.KMAT), (constitutive, g.KCONS)):
            if number is not None:
                puti(h, ib, of_block, number)
        for ic in items(h, ib):
            if not is_corner(h, ic):
                assign_material(h, ic)
    return len(blocks)


def change_types(array: MainArray, blocks: list[int], kind: int) -> None:
    """Make all `blocks` the type `kind`. Error 1, 14 or 28, and nothing is changed, if one of them cannot."""
    changing = [ib for ib in blocks if iget(array.h, ib, HEAD) != kind]
    if not changing:
        return
    require(array, len(changing) * (size_of(array.h, g.NVSD) + size_of(array.h, g.NVFD)))
    meshed = [ib for ib in changing if edge_points(array.h, ib)]
    for ib in meshed:
        check_straight(array.h, ib)
    with all_or_nothing(array):
        for ib in meshed:
            straighten(array.h, ib)
        _change_types(array, changing, kind)
        if meshed:
            bring_up(array)
            check_overlaps(array, float(array.h.cr[g.DTOL]), STAYS)
            if array.h.ci[g.MCTOT] > 0:
                renew_forces(array)


def _change_types(array: MainArray, changing: list[int], kind: int) -> None:
    h = array.h
    rigid = [ib for ib in changing if iget(h, ib, HEAD) == g.MRIG]
    for ib in rigid:
        become(h, ib, g.MSDEF)
    if h.ci[g.MCTOT] > 0:
        renew_forces(array)
        add_loads(h, h.cr.dtype.type(0))
        for ib in rigid:
            stress = applied_stress(h, ib)
            check_real_range(array, f"the stress in block@{ib}", stress)
            _put_stress(h, ib, stress)
    forget_blocks(h, [ib for ib in changing if g.MFDEF in (kind, iget(h, ib, HEAD))])
    for ib in changing:
        if iget(h, ib, HEAD) != kind:
            become(h, ib, kind, mean_stress(h, ib))
    if h.ci[g.MCTOT] > 0:
        renew_forces(array)


def become(h: Memory, ib: int, kind: int, stress: Stress = (0.0, 0.0, 0.0)) -> None:
    """Give block `ib` the type `kind`, with the internal stress `stress`.

    Conditions on a block that is or becomes fully-deformable must have been removed before.
    """
    if iget(h, ib, HEAD) == g.MFDEF:
        _lose_zones(h, ib)
    if iget(h, ib, HEAD) != g.MRIG:
        lose(h, iget(h, ib, g.KBEX), g.NVSD if iget(h, ib, HEAD) == g.MSDEF else g.NVFD)
        h.ci[g.NSOFT] -= 1
    puti(h, ib, HEAD, kind)
    puti(h, ib, g.KBEX, 0)
    if kind != g.MRIG:
        puti(h, ib, g.KBEX, find(h, g.NVSD if kind == g.MSDEF else g.NVFD))
        h.ci[g.NSOFT] += 1
        _put_stress(h, ib, stress)
        share_mass(h, ib)


def _put_stress(h: Memory, ib: int, stress: Stress) -> None:
    """Set the internal stress of simply-deformable block `ib`, or the first stress of the zones of `ib`."""
    s11, s12, s22 = stress
    if iget(h, ib, HEAD) == g.MSDEF:
        put_stress(h, iget(h, ib, g.KBEX), *(h.cr.dtype.type(s) for s in stress))
        return
    for k, value in ((g.KFS11, s11), (g.KFS12, s12), (g.KFS22, s22)):
        putr(h, iget(h, ib, g.KBEX), k, value)


def _lose_zones(h: Memory, ib: int) -> None:
    """Give back zones and grid-points of block `ib`, which becomes a rigid body with their momentum.

    Its centroid is then that of its area, instead of that of the masses at the grid-points.
    """
    ie = iget(h, ib, g.KBEX)
    turning = float(getr(h, ib, g.KBI)) * float(getr(h, ib, g.KTD))
    for item in items(h, ib):
        if is_corner(h, item):
            puti(h, item, g.KGP, 0)
    for ig in chain(h, iget(h, ie, g.KFG), g.KG):
        lose_gridpoint(h, ig)
    for iz in chain(h, iget(h, ie, g.KFZ), g.KZ):
        lose(h, iz, g.NVZO)
    area, x, y, jxx, _, jyy = (float(n) for n in geo(h, ib))
    mass, xd, yd = (float(getr(h, ib, k)) for k in (g.KBM, g.KXD, g.KYD))
    second = mass * (jxx + jyy) / area
    turning += mass * ((float(getr(h, ib, g.KX)) - x) * yd - (float(getr(h, ib, g.KY)) - y) * xd)
    for k, value in ((g.KX, x), (g.KY, y), (g.KBI, second), (g.KTD, turning / second if second else 0.0)):
        putr(h, ib, k, value)
    renew_reach(h, ib)
    set_corner_velocities(h, ib)


def applied_stress(h: Memory, ib: int) -> Stress:
    """Stress of simply-deformable block `ib` that balances the applied stress."""
    ie = iget(h, ib, g.KBEX)
    s11, s12, s21, s22, area = (float(getr(h, ie, k)) for k in (g.KSA11, g.KSA12, g.KSA21, g.KSA22, g.KSAREA))
    return s11 / area, (s12 + s21) / 2 / area, s22 / area


def mean_stress(h: Memory, ib: int) -> Stress:
    """Mean stress of deformable block `ib`, by area."""
    ie = iget(h, ib, g.KBEX)
    if iget(h, ib, HEAD) == g.MSDEF:
        return float(getr(h, ie, g.KS111)), float(getr(h, ie, g.KS112)), float(getr(h, ie, g.KS122))
    if iget(h, ie, g.KFZ) == 0:
        return float(getr(h, ie, g.KFS11)), float(getr(h, ie, g.KFS12)), float(getr(h, ie, g.KFS22))
    area, s11, s12, s22 = zone_means(h, ie)
    return float(s11 / area), float(s12 / area), float(s22 / area)


# ---- DELETE: blocks are removed; the others remain one connected map


def delete(array: MainArray, where: Range, function: int | None = None) -> int:
    """Delete the blocks whose centroids lie in the range. Returns their number.

    function: number of a FUNCTION; their forces on other blocks stay as loads that it multiplies. Error 19,
    and nothing is deleted, if no contact would be left; 26 for a FUNCTION that does not exist.
    """
    h = array.h
    blocks = blocks_in(array, where)
    signal = 0 if function is None else existing_function(h, function)
    if not blocks:
        return 0
    left = int(h.ci[g.NBLK]) - len(blocks)
    if left < 2:
        raise UdecError(19, f"only {left} block(s) would be left", "two blocks must remain")
    loads = loads_of_blocks(array, blocks) if signal else {}
    require(array, len(loads) * size_of(h, g.NVBN))
    h = array.h
    remove_blocks(h, blocks)
    set_loads(array, loads, signal)
    update_flagged(array)
    if h.ci[g.MCTOT] > 0:
        renew_forces(array)
    return len(blocks)


def remove_blocks(h: Memory, blocks: list[int]) -> None:
    """Take `blocks` out of the map, with all that is in them and on them; one block must remain."""
    forget_blocks(h, blocks)
    lose_hosted(h, blocks)
    for ib in blocks:
        become(h, ib, g.MRIG)  # gives back the groups of a deformable block
        delb(h, ib)
