"""INSITU: initial stresses in deformable blocks, and in the joints of all blocks.

Zones and simply-deformable blocks get S(x, y) = S0 + x SX + y SY at their centroids, tension positive. The
contacts of the blocks, also of rigid ones, get the forces that this field has on the joints
(initial_joint_stress.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.sdef import put_stress
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary_command import ZERO, Triple
from udec_ia.ops.commands.initial_joint_stress import stress_joints
from udec_ia.ops.common.block_ranges import blocks_in, range_text, why_no_block
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.number_limits import check_real_range, finite
from udec_ia.reader.group_ranges import Range
from udec_ia.reader.list_walks import chain


class Stressed(NamedTuple):
    """Number of stressed blocks, and places at which joints cannot carry the stress."""

    blocks: int
    exceeded: list[tuple[float, float]]


def insitu(
    array: MainArray, where: Range, stress: Triple, xgrad: Triple = ZERO, ygrad: Triple = ZERO
) -> Stressed:
    """INSITU: stresses (Pa; 11, 12, 22) of the blocks in the range and of their joints.

    Error 24 without a suitable block in the range; 28, and nothing is changed, if the reals cannot hold the
    stresses or their forces.
    """
    for name, triple in (("s11", stress), ("xgrad", xgrad), ("ygrad", ygrad)):
        for component in triple:
            finite(array, **{name: component})
    h = array.h

    def at(x: float, y: float) -> Triple:
        one, two, three = (s + x * sx + y * sy for s, sx, sy in zip(stress, xgrad, ygrad, strict=True))
        return one, two, three

    stresses: dict[int, dict[int, Triple]] = {}
    for ib in blocks_in(array, where):
        inside = {iad: at(x, y) for iad, x, y in _pieces(h, ib)}
        length = max(1.0, 4 * float(getr(h, ib, g.KBRO)) * len(inside))  # greatest force over stress
        forces = (length * s for triple in inside.values() for s in triple)
        check_real_range(array, f"a stress or a force in block@{ib}", forces)
        if inside or iget(h, ib, HEAD) == g.MRIG:
            stresses[ib] = inside
    if not stresses or (h.ci[g.NCON] == 0 and not any(stresses.values())):
        raise _no_stress(array, where)
    for ib, inside in stresses.items():
        for iad, triple in inside.items():
            if iget(h, ib, HEAD) == g.MSDEF:
                put_stress(h, iad, *(h.cr.dtype.type(s) for s in triple))
            else:
                for k, s in zip((g.KZS11, g.KZS12, g.KZS22), triple, strict=True):
                    putr(h, iad, k, s)
    exceeded = stress_joints(array, list(stresses), at)
    renew_forces(array)
    return Stressed(len(stresses), exceeded)


def _no_stress(array: MainArray, where: Range) -> UdecError:
    """Error 24: no block in the range, or none that can have stress."""
    blocks, limits = blocks_in(array, where), range_text(where)
    if not blocks:
        return UdecError(24, why_no_block(array, where), parameter="x1")
    if any(iget(array.h, ib, HEAD) == g.MFDEF for ib in blocks):
        advice = f"GENERATE divides a block into zones; CHANGE {limits} SDEF needs no zones"
        return UdecError(24, "the fully-deformable blocks there have no zones yet", advice, parameter="x1")
    detail = (
        f"all blocks there are rigid, such as block@{blocks[0]}, and there is no joint that takes a stress"
    )
    advice = f"first make the blocks deformable: CHANGE {limits} SDEF, with BULK and G of their material"
    return UdecError(24, detail, advice, parameter="x1")


def _pieces(h: Memory, ib: int) -> Iterator[tuple[int, float, float]]:
    """The groups with the stress of block `ib`, its zones or its extension, with their centroids."""
    if iget(h, ib, HEAD) == g.MSDEF:
        yield iget(h, ib, g.KBEX), float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
    elif iget(h, ib, HEAD) == g.MFDEF:
        for iz in chain(h, iget(h, iget(h, ib, g.KBEX), g.KFZ), g.KZ):
            corners = [iget(h, iz, g.KZG, i) for i in range(3)]
            x, y = (sum(float(getr(h, ig, k)) for ig in corners) / 3 for k in (g.KXG, g.KYG))
            yield iz, x, y
