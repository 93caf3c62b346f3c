"""The safe bound of the time-step from the row sums of the stiffness matrix (report 4.6).

The bound is 2 min sqrt(d_i m_i / sum_j |K_ij| d_j) over all degrees of freedom (Gershgorin): no mode is
faster, for any weights d > 0. With d = 1/sqrt(m) heavy neighbours of a light body do not lower the bound.
Contacts count as closed and sticking (kernels.drive.critical_stiffness). Degrees of freedom are x and y of
blocks and grid-points, the rotation of a block, and the three strains of a simply-deformable block along the
principal axes of its Euler tensor, rotation and strains times its radius of gyration. What is fixed has none.

A viscous boundary uses the velocity of the step before. A step is stable if M - K dt^2/4 - C dt/2 has no
negative eigenvalue. With w^2 = K/m and c = C/2m of a row the limit is 2/(sqrt(w^2 + c^2) + c).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, integers
from udec_ia.kernels.body.turned_blocks import AS_WHOLE
from udec_ia.kernels.drive.critical_stiffness import DOFS, add_contacts
from udec_ia.kernels.drive.damping_modes import mode_of
from udec_ia.kernels.drive.structure_stiffness import add_structures
from udec_ia.kernels.geometry.plane_tensors import ROUND
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.common.attached_structures import has_structures

Array = Any  # of addresses, or of reals
ADD_CONTACTS = InterpretWhenSmall(add_contacts, 2e3)
# A stiffness or a frequency that overflows gives a step of 0, which is error 28.
OVERFLOWS = np.errstate(over="ignore", divide="ignore", invalid="ignore")


@dataclass(frozen=True)
class StepLimit:
    """A critical time-step (s) and the address of the block, contact or grid-point that sets it."""

    step: float
    address: int


class Rows:
    """Row sums of the stiffness matrix, one row for each block, grid-point and node of a structure.

    even: with equal weights, for masses that are scaled by the sums; else with 1/sqrt(m).
    """

    def __init__(self, h: Memory, even: bool = False) -> None:
        self.h = h
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        meshed = blocks[integers(h, blocks, HEAD) == g.MFDEF]
        firsts = integers(h, integers(h, meshed, g.KBEX), g.KFG)
        points = [addresses(h, int(first), g.KG) for first in firsts]
        nodes = addresses(h, int(h.ci[g.INDPNT]), g.KN)
        self.address = np.sort(np.concatenate([[0], blocks, nodes, *points]))  # row 0 has no group
        rows = len(self.address)
        self.sum = np.zeros((rows, DOFS))
        self.own = np.zeros((rows, DOFS, DOFS))  # the matrix of each row within its group
        self.mass = np.full((rows, DOFS), np.inf)
        self.drag = np.zeros((rows, DOFS))  # row sums of the matrix of the dashpots
        self.free = np.zeros((rows, DOFS))  # 1 for a degree of freedom, 0 if it is fixed
        # Columns: radius of gyration, cosine and sine of the first principal axis.
        self.frame = np.tile([1.0, 1.0, 0.0], (rows, 1))
        self._enter_blocks(blocks[integers(h, blocks, HEAD) != g.MFDEF])
        if len(meshed):
            self._enter_points(meshed, points)
        if len(nodes):
            self._enter_nodes(nodes)
        self.weight = self.free / np.sqrt(np.where((self.mass > 0) & (not even), self.mass, 1.0))
        if len(meshed):
            self._enter_zones(meshed)
        self._enter_contacts()
        self.sum += (np.abs(self.own) * self.weight[:, None, :]).sum(axis=2)
        if h.ci[g.IBNPNT]:
            self._enter_dashpots()

    def row(self, addresses: Array) -> Array:
        """Rows of blocks and grid-points."""
        return np.searchsorted(self.address, addresses)

    def _enter_blocks(self, blocks: Array) -> None:
        """Masses of blocks without zones, and the stiffness of simply-deformable ones."""
        h = self.h
        mass = reals(h, blocks, g.KBM)
        rows = self.row(blocks)
        self.frame[rows, 0] = np.sqrt(reals(h, blocks, g.KBI) / mass)
        self.mass[rows] = mass[:, None]
        fix = integers(h, blocks, g.KBFIX)
        self.free[rows, 0] = fix & (g.FIXED | g.GIVEN_X) == 0
        self.free[rows, 1] = fix & (g.FIXED | g.GIVEN_Y) == 0
        self.free[rows, 2] = (fix & (g.FIXED | g.GIVEN_TURN) == 0) & (fix != g.GIVEN_X | g.GIVEN_Y)
        soft = blocks[(integers(h, blocks, HEAD) == g.MSDEF) & (fix != g.FIXED) & (fix != AS_WHOLE)]
        if not len(soft):
            return
        rows, ext, mat = self.row(soft), integers(h, soft, g.KBEX), integers(h, soft, g.KMAT) - 1
        j11, j12, j22, area = (reals(h, ext, k) for k in (g.KSJ11, g.KSJ12, g.KSJ22, g.KSAREA))
        square, half, mean = self.frame[rows, 0] ** 2, np.hypot((j11 - j22) / 2, j12), (j11 + j22) / 2
        angle = np.where(half > ROUND * mean, np.arctan2(2 * j12, j11 - j22) / 2, 0.0)
        self.frame[rows, 1], self.frame[rows, 2] = np.cos(angle), np.sin(angle)
        self.mass[rows, 3:] = (np.stack([mean + half, mean - half, 2 * mean]) / square).T
        self.free[rows, 3:] = 1
        one, two, area = h.cr[g.ALAM1 + mat], h.cr[g.ALAM2 + mat], np.abs(area)
        self.own[rows, 3, 3] = self.own[rows, 4, 4] = area * one / square
        self.own[rows, 3, 4] = self.own[rows, 4, 3] = area * two / square
        self.own[rows, 5, 5] = area * 2 * (one - two) / square

    def _enter_points(self, blocks: Array, points: list[Array]) -> None:
        """Masses of the grid-points of `blocks`; points: those of each block."""
        h, own = self.h, np.concatenate(points)
        rows, fix = self.row(own), integers(h, own, g.KGFIX)
        held = np.repeat(integers(h, blocks, g.KBFIX) == g.FIXED, [len(row) for row in points])
        self.mass[rows] = reals(h, own, g.KGPM)[:, None]
        self.free[rows, 0] = (fix & g.ALONG_X == 0) & ~held
        self.free[rows, 1] = (fix & g.ALONG_Y == 0) & ~held

    def _enter_nodes(self, nodes: Array) -> None:
        """Masses of the nodes of structures."""
        rows, mass = self.row(nodes), reals(self.h, nodes, g.KNM)
        self.mass[rows] = mass[:, None]
        self.frame[rows, 0] = np.sqrt(reals(self.h, nodes, g.KNI) / mass)
        self.free[rows, :3] = 1

    def _enter_zones(self, blocks: Array) -> None:
        """The stiffness of the zones of `blocks`."""
        h = self.h
        chains = [addresses(h, int(first), g.KZ) for first in integers(h, integers(h, blocks, g.KBEX), g.KFZ)]
        zones = np.concatenate(chains)
        mat = np.repeat(integers(h, blocks, g.KMAT) - 1, [len(chain) for chain in chains])
        corner = np.stack([integers(h, zones, g.KZG, i) for i in (2, 1, 0)], axis=1)
        x, y = (reals(h, corner, k) for k in (g.KXG, g.KYG))
        b, c = np.roll(y, -1, 1) - np.roll(y, 1, 1), np.roll(x, 1, 1) - np.roll(x, -1, 1)
        corner = self.row(corner)
        twice = np.abs(b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])  # a zone may have turned inside out
        one, two = (h.cr[k + mat].astype(float) for k in (g.ALAM1, g.ALAM2))
        shear = (one - two) / 2
        weight = self.weight[corner, :2]
        for i in range(3):
            for j in range(3):
                bb, cc = b[:, i] * b[:, j], c[:, i] * c[:, j]
                bc, cb = b[:, i] * c[:, j], c[:, i] * b[:, j]
                along = one * bb + shear * cc, two * bc + shear * cb
                across = two * cb + shear * bc, one * cc + shear * bb
                for axis, pair in enumerate((along, across)):
                    if i == j:
                        for other, k in enumerate(pair):
                            np.add.at(self.own[:, axis, other], corner[:, i], _over(k, 2 * twice))
                    else:
                        row = np.abs(pair[0]) * weight[:, j, 0] + np.abs(pair[1]) * weight[:, j, 1]
                        np.add.at(self.sum[:, axis], corner[:, i], _over(row, 2 * twice))

    def _enter_contacts(self) -> None:
        """The stiffness of all contacts that are not virtual, and of structures."""
        row = np.zeros(int(self.h.ci[g.MFREE]) + 1, np.int32)
        row[self.address] = np.arange(len(self.address))
        ADD_CONTACTS(int(self.h.ci[g.NCON]), self.h, row, self.frame, self.weight, self.own, self.sum)
        if has_structures(self.h):
            add_structures(self.h, row, self.frame, self.weight, self.own, self.sum)

    def _body(self, blocks: Array, x: Array, y: Array) -> Array:
        """Displacement of the points (x, y) by a unit of each degree of freedom, shape (2, blocks, DOFS)."""
        length, c, s = self.frame[self.row(blocks)].T
        rx, ry = ((p - reals(self.h, blocks, k)) / length for p, k in ((x, g.KX), (y, g.KY)))
        p, q, one, zero = c * rx + s * ry, c * ry - s * rx, np.ones_like(rx), np.zeros_like(rx)
        along_x = [one, zero, -ry, p * c, -q * s, q * c - p * s]
        along_y = [zero, one, rx, p * s, q * c, q * s + p * c]
        return np.abs([along_x, along_y]).transpose(0, 2, 1)

    def _enter_dashpots(self) -> None:
        """The dashpots of all viscous boundaries."""
        h = self.h
        bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
        cxx, cxy, cyy = (np.abs(reals(h, bounds, k)) for k in (g.KUCXX, g.KUCXY, g.KUCYY))
        blocks, points, corners = (integers(h, bounds, k) for k in (g.KUB, g.KUG, g.KUP))
        x, y = (
            np.where(corners > 0, reals(h, corners, kp), reals(h, blocks, k))
            for kp, k in ((g.KXP, g.KX), (g.KYP, g.KY))
        )
        at = self.row(np.where(points > 0, points, blocks))
        of_point = np.eye(2, DOFS)[:, np.newaxis, :]
        share: Array = np.where((points > 0)[:, None], of_point, self._body(blocks, x, y))
        total = (share * self.weight[at]).sum(axis=2)
        for axis, (along, across) in enumerate(((cxx, cxy), (cyy, cxy))):
            rows = share[axis] * (along * total[axis] + across * total[1 - axis])[:, None]
            np.add.at(self.drag, at, rows)

    def limit(self) -> StepLimit:
        """The bound and its group; the bound is 0 if a mass or a stiffness is not a number."""
        mass = np.where(self.free > 0, self.mass, 1.0) * self.weight
        rate = np.where(self.free > 0, rate_of(self.sum, self.drag, mass), 0.0)
        rate[np.isnan(rate)] = np.inf
        at = int(rate.max(axis=1).argmax())
        fastest = float(rate[at].max())
        return StepLimit(2 / fastest if fastest else math.inf, int(self.address[at]))


def _over(total: Array, mass: Array) -> Array:
    """`total` over `mass`; infinite for a positive total on a mass of 0, of a zone squashed flat."""
    return np.divide(total, mass, out=np.where(total > 0, np.inf, 0.0), where=mass > 0)


def rate_of(stiffness: Array, drag: Array, mass: Array) -> Array:
    """2 over the greatest stable step (1/s). A negative stiffness, of a zone inside out, counts as 0."""
    square, half = _over(np.maximum(stiffness, 0), mass), _over(drag, mass) / 2
    return np.sqrt(square + half * half) + half


def reals(h: Memory, at: Array, k: Offset) -> Array:
    return np.asarray(getr(h, at, k), np.float64)


def damped_step(h: Memory, step: float) -> float:
    """The critical time-step with the damping of `h`; step: without damping.

    Stiffness damping lowers it from 2/w to (2/w)(sqrt(1 + L^2) - L), where L = BETA w/2 is the fraction of
    critical damping at the frequency w. The fastest motion reverses in each cycle: LOCAL and COMBINED damping
    then add f times the force, so that joints are 1 + f times as stiff.
    """
    if step == 0:
        return 0.0
    step /= _stiffened(h)
    share = float(h.cr[g.BETA]) / step
    return step / (math.hypot(1, share) + share)


def undamped_step(h: Memory, step: float) -> float:
    """The critical time-step without damping; step: with damping."""
    beta = float(h.cr[g.BETA])
    return math.sqrt((step + beta) ** 2 - beta**2) * _stiffened(h)


def _stiffened(h: Memory) -> float:
    """Factor by which the damping mode raises the frequency of motion that reverses in every cycle."""
    mode = mode_of(h)
    return math.sqrt(1 + float(h.cr[g.RESTF])) if mode and "stiffens" in mode.effects else 1.0
