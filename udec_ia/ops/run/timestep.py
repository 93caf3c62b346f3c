"""The critical time-step: the 1980 estimate, and a bound that no mode exceeds (report 4.6).

Estimate: 2 sqrt(M/K), smallest over the blocks (least mass, greatest joint stiffness), the internal modes of
simply-deformable blocks and the grid-points (kernels.drive.timestep). It is only approximate: a mass on
several springs has a shorter period than on one.

Bound: 2 min sqrt(m_i / sum_j |K_ij|), with the row sums of the whole stiffness matrix over all degrees of
freedom (Gershgorin). No mode is faster. A contact's stiffness is the greater of KN and KS in every direction.
Degrees of freedom are x and y of blocks and grid-points, the rotation of a block and the three strains of a
simply-deformable one times its radius of gyration. What is fixed has none.

A viscous boundary takes the velocity of the step before. A step is stable if M - K dt^2/4 - C dt/2 has no
negative eigenvalue, so that with w^2 = K/m and c = C/2m of a row the limit is 2/(sqrt(w^2 + c^2) + c).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.errors import ADVICE, UdecError
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, integers
from udec_ia.heap.array import MainArray
from udec_ia.kernels.drive.contact_stiffness import DOFS, add_contacts
from udec_ia.kernels.drive.extremes import greatest_stiffness, smallest_mass
from udec_ia.kernels.drive.timestep import addresses, soft_step
from udec_ia.kernels.links.owner import BLOCK, GRIDPOINT, NOBODY, STRAIN, owner
from udec_ia.layout import offsets as g

Array = Any  # of addresses, or of the reals found there
# A stiffness or a frequency beyond the reals makes a step of 0, and that is error 28: nothing to warn of.
OVERFLOWS = np.errstate(over="ignore", divide="ignore", invalid="ignore")


@dataclass(frozen=True)
class Limit:
    """A critical time-step (s) and the address of the block, contact or grid-point that sets it."""

    step: float
    address: int


class _Rows:
    """Row sums of the stiffness matrix, one row for each address of a block or grid-point."""

    def __init__(self, h: Memory) -> None:
        self.h = h
        blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
        meshed = blocks[integers(h, blocks, HEAD) == g.MFDEF]
        firsts = integers(h, integers(h, meshed, g.KBEX), g.KFG)
        points = [addresses(h, int(first), g.KG) for first in firsts]
        self.address = np.sort(np.concatenate([[0], blocks, *points]))  # row 0 stands for nothing
        words = len(self.address)
        self.sum = np.zeros((words, DOFS))
        self.mass = np.full((words, DOFS), np.inf)
        self.drag = np.zeros((words, DOFS))  # row sums of the matrix of the dashpots
        self.free = np.zeros((words, DOFS))  # 1 for a degree of freedom, 0 for what is held
        self.length = np.ones(words)  # radius of gyration of a block
        self._enter_blocks(blocks[integers(h, blocks, HEAD) != g.MFDEF])
        if len(meshed):
            self._enter_points(meshed, points)
            self._enter_zones(meshed)

    def row(self, addresses: Array) -> Array:
        """Rows of blocks and grid-points."""
        return np.searchsorted(self.address, addresses)

    def _enter_blocks(self, blocks: Array) -> None:
        """Masses of rigid and simply-deformable blocks, and the inner stiffness of the latter."""
        h = self.h
        mass = _reals(h, blocks, g.KBM)
        rows = self.row(blocks)
        self.length[rows] = np.sqrt(_reals(h, blocks, g.KBI) / mass)
        self.mass[rows] = mass[:, None]
        fix = integers(h, blocks, g.KBFIX)
        self.free[rows, 0] = fix & (g.FIXED | g.GIVEN_X) == 0
        self.free[rows, 1] = fix & (g.FIXED | g.GIVEN_Y) == 0
        self.free[rows, 2] = (fix != g.FIXED) & (fix != g.GIVEN_X | g.GIVEN_Y)
        soft = blocks[(integers(h, blocks, HEAD) == g.MSDEF) & (fix != g.FIXED)]
        if not len(soft):
            return
        rows, ext, mat = self.row(soft), integers(h, soft, g.KBEX), integers(h, soft, g.KMAT) - 1
        j11, j12, j22, area = (_reals(h, ext, k) for k in (g.KSJ11, g.KSJ12, g.KSJ22, g.KSAREA))
        zero = np.zeros_like(j11)
        tensor = np.array([[j11, zero, j12], [zero, j22, j12], [j12, j12, j11 + j22]]).transpose(2, 0, 1)
        square = self.length[rows] ** 2
        known = np.isfinite(tensor).all(axis=(1, 2))  # the others have no eigenvalues, and no safe step
        smallest = np.full(len(rows), np.nan)
        smallest[known] = np.linalg.eigvalsh(tensor[known])[:, 0]
        self.mass[rows, 3:] = (smallest / square)[:, None]
        self.free[rows, 3:] = 1
        one, two, area = h.cr[g.ALAM1 + mat], h.cr[g.ALAM2 + mat], np.abs(area)
        self.sum[rows, 3] = self.sum[rows, 4] = area * (one + np.abs(two)) / square
        self.sum[rows, 5] = area * 2 * (one - two) / square

    def _enter_points(self, blocks: Array, points: list[Array]) -> None:
        """Masses of the grid-points of `blocks`, those of each block in a row."""
        h, own = self.h, np.concatenate(points)
        rows, fix = self.row(own), integers(h, own, g.KGFIX)
        held = np.repeat(integers(h, blocks, g.KBFIX) == g.FIXED, [len(row) for row in points])
        self.mass[rows] = _reals(h, own, g.KGPM)[:, None]
        self.free[rows, 0] = (fix & g.ALONG_X == 0) & ~held
        self.free[rows, 1] = (fix & g.ALONG_Y == 0) & ~held

    def _enter_zones(self, blocks: Array) -> None:
        """The stiffness of the zones of `blocks`."""
        h = self.h
        chains = [addresses(h, int(first), g.KZ) for first in integers(h, integers(h, blocks, g.KBEX), g.KFZ)]
        zones = np.concatenate(chains)
        mat = np.repeat(integers(h, blocks, g.KMAT) - 1, [len(chain) for chain in chains])
        corner = np.stack([integers(h, zones, g.KZG, i) for i in (2, 1, 0)], axis=1)
        x, y = (_reals(h, corner, k) for k in (g.KXG, g.KYG))
        b, c = np.roll(y, -1, 1) - np.roll(y, 1, 1), np.roll(x, 1, 1) - np.roll(x, -1, 1)
        corner = self.row(corner)
        twice = np.abs(b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0])  # a zone may have turned inside out
        one, two = (h.cr[k + mat].astype(float) for k in (g.ALAM1, g.ALAM2))
        shear = (one - two) / 2
        free = self.free[corner, :2]
        for i in range(3):
            for j in range(3):
                bb, cc = b[:, i] * b[:, j], c[:, i] * c[:, j]
                bc, cb = b[:, i] * c[:, j], c[:, i] * b[:, j]
                fx, fy = free[:, j].T
                row_x = np.abs(one * bb + shear * cc) * fx + np.abs(two * bc + shear * cb) * fy
                row_y = np.abs(two * cb + shear * bc) * fx + np.abs(one * cc + shear * bb) * fy
                np.add.at(self.sum[:, 0], corner[:, i], _over(row_x, 2 * twice))
                np.add.at(self.sum[:, 1], corner[:, i], _over(row_y, 2 * twice))

    def add_contacts(self) -> None:
        """The stiffness of all contacts that are not virtual."""
        row = np.zeros(int(self.h.ci[g.MFREE]) + 1, np.int32)
        row[self.address] = np.arange(len(self.address))
        add_contacts(self.h, row, self.length, self.free, self.sum)

    def _body(self, blocks: Array, x: Array, y: Array) -> Array:
        """How far a unit of each degree of freedom of blocks moves the points, shape (2, blocks, DOFS)."""
        length = self.length[self.row(blocks)]
        rx, ry = (np.abs(p - _reals(self.h, blocks, k)) / length for p, k in ((x, g.KX), (y, g.KY)))
        one, zero = np.ones_like(rx), np.zeros_like(rx)
        return np.array([[one, zero, ry, rx, zero, ry], [zero, one, rx, zero, ry, rx]]).transpose(0, 2, 1)

    def add_dashpots(self) -> None:
        """The dashpots of all viscous boundaries."""
        h = self.h
        bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
        cxx, cxy, cyy = (np.abs(_reals(h, bounds, k)) for k in (g.KUCXX, g.KUCXY, g.KUCYY))
        blocks, points, corners = (integers(h, bounds, k) for k in (g.KUB, g.KUG, g.KUP))
        x, y = (
            np.where(corners > 0, _reals(h, corners, kp), _reals(h, blocks, k))
            for kp, k in ((g.KXP, g.KX), (g.KYP, g.KY))
        )
        at = self.row(np.where(points > 0, points, blocks))
        share: Array = np.where((points > 0)[:, None], _point(len(at)), self._body(blocks, x, y))
        total = (share * self.free[at]).sum(axis=2)
        for axis, (along, across) in enumerate(((cxx, cxy), (cyy, cxy))):
            rows = share[axis] * (along * total[axis] + across * total[1 - axis])[:, None]
            np.add.at(self.drag, at, rows)

    def limit(self) -> Limit:
        """The bound, and who sets it: 0 where a mass or a stiffness is not a number."""
        rate = np.where(self.free > 0, _rate(self.sum, self.drag, self.mass), 0.0)
        rate[np.isnan(rate)] = np.inf
        at = int(rate.max(axis=1).argmax())
        fastest = float(rate[at].max())
        return Limit(2 / fastest if fastest else math.inf, int(self.address[at]))


def _point(n: int) -> Array:
    """How far a unit of each degree of freedom of a grid-point moves it, shape (2, n, DOFS)."""
    moves = np.zeros((2, n, DOFS))
    moves[0, :, 0] = moves[1, :, 1] = 1
    return moves


def _over(total: Array, mass: Array) -> Array:
    """`total` over `mass`; infinite where something acts on what has been squashed flat, and has no mass."""
    return np.divide(total, mass, out=np.where(total > 0, np.inf, 0.0), where=mass > 0)


def _rate(stiffness: Array, drag: Array, mass: Array) -> Array:
    """2 over the greatest stable step (1/s). A negative stiffness, of a zone inside out, makes no wave."""
    square, half = _over(np.maximum(stiffness, 0), mass), _over(drag, mass) / 2
    return np.sqrt(square + half * half) + half


@OVERFLOWS
def bound(array: MainArray) -> Limit:
    """The safe bound of the critical time-step; infinite if no stiffness acts on anything free."""
    rows = _Rows(array.h)
    rows.add_contacts()
    if array.h.ci[g.IBNPNT]:
        rows.add_dashpots()
    return rows.limit()


@OVERFLOWS
def estimate(array: MainArray) -> Limit:
    """The 1980 estimate of the critical time-step. Errors 11 and 12 for what is not defined."""
    h = array.h
    mass, at, massless = smallest_mass(h)
    if massless:
        m = iget(h, massless, g.KMAT)
        detail = f"block@{massless} has material {m}, whose density is not set"
        advice = f"PROPERTY MATERIAL={m} DENSITY=..."
        if h.cr[g.DENS + m - 1] > 0:
            detail, advice = f"block@{massless} has the mass {getr(h, massless, g.KBM):g}", ADVICE[20]
        raise UdecError(12, detail, advice, group=int(massless))
    stiffness = np.zeros(int(h.ci[g.MFREE]) + 1, h.cr.dtype)
    joints = _stiffness(h)
    ratio = float(mass) / joints
    if h.ci[g.NSOFT]:
        smallest, soft = soft_step(h, stiffness)
        if float(smallest) < ratio:
            ratio, at = float(smallest), soft
    limit = Limit(2 * math.sqrt(max(ratio, 0.0)), int(at))  # a block squashed flat has no mass left in it
    return min(limit, _drag_limit(h, stiffness, joints), key=lambda limit: limit.step)


def _drag_limit(h: Memory, stiffness: Array, joints: float) -> Limit:
    """The least step of what viscous boundaries hold; stiffness: of the grid-points, by address."""
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    if not len(bounds):
        return Limit(math.inf, 0)
    blocks, points = integers(h, bounds, g.KUB), integers(h, bounds, g.KUG)
    at = np.where(points > 0, points, blocks)
    drag = np.zeros_like(stiffness, dtype=float)
    cxx, cxy, cyy = (np.abs(_reals(h, bounds, k)) for k in (g.KUCXX, g.KUCXY, g.KUCYY))
    np.add.at(drag, at, np.maximum(cxx, cyy) + cxy)
    mass = np.where(points > 0, _reals(h, points, g.KGPM), _reals(h, blocks, g.KBM))
    rate = np.where(drag[at] > 0, _rate(np.where(points > 0, stiffness[at], joints), drag[at], mass), 0.0)
    fastest = int(rate.argmax())
    return Limit(2 / float(rate[fastest]) if rate[fastest] else math.inf, int(at[fastest]))


def _stiffness(h: Memory) -> float:
    """Greatest joint stiffness of any contact; of a lone block the one that its contacts would have."""
    if h.ci[g.NCON] == 0:
        m = iget(h, int(h.ci[g.IBPNT]), g.KMAT)
        stiffness = float(max(h.cr[g.AKN + m - 1], h.cr[g.AKS + m - 1]))
        if not stiffness > 0 and not h.ci[g.NSOFT]:
            raise UdecError(11, f"material {m}", f"PROPERTY MATERIAL={m} KN=... KS=...")
        return max(stiffness, 1e-300)
    stiffness, undefined = greatest_stiffness(h)
    if undefined:
        m = iget(h, undefined, g.KCM)
        detail = f"contact@{undefined} has material {m}"
        raise UdecError(11, detail, f"PROPERTY MATERIAL={m} KN=... KS=...", group=int(undefined))
    return float(stiffness)


def time_step(array: MainArray) -> float:
    """FRAC times the estimate, or times the safe bound if asked for; error 28 if reals cannot hold it."""
    critical = estimate(array).step
    if array.h.ci[g.LSAFE]:
        safe = bound(array).step
        critical = damped(safe, float(array.h.cr[g.BETA])) if math.isfinite(safe) else critical
    step = float(array.h.cr[g.FRAC]) * critical
    reals = np.finfo(array.scheme.real_type)
    if not reals.smallest_normal < step < reals.max:
        raise UdecError(28, f"the time-step is {step:g} s", "look at DENSITY, KN, KS and FRACTION")
    return step


def damped(step: float, beta: float) -> float:
    """The critical time-step with stiffness damping, `step` being that without it.

    A dashpot lowers it from 2/w to (2/w)(sqrt(1 + L^2) - L), where L = BETA w/2 is its fraction of critical
    damping at the frequency w.
    """
    if step == 0:
        return 0.0
    share = beta / step
    return step / (math.hypot(1, share) + share)


def safe_fraction(array: MainArray, share: float) -> float:
    """FRACTION that makes a time-step just below that which the present one is `share` of."""
    return 0.95 * float(array.h.cr[g.FRAC]) / share


def instability(array: MainArray, safe: Limit) -> str:
    """A warning if the time-step is above `safe`, or above what stiffness damping leaves of it, else ""."""
    beta, step = float(array.h.cr[g.BETA]), float(array.h.cr[g.TDEL])
    critical = damped(safe.step, beta)
    if step <= critical:
        return ""
    if safe.step == 0:
        place = _place(array.h, safe.address)
        return f"no time-step is safe: a mass or a stiffness of {place} is zero, infinite or no number"
    share = step / critical if critical else math.inf
    fraction = f"FRACTION {safe_fraction(array, share):.2g} is safe"
    if step <= safe.step:
        return (
            f"stiffness damping BETA = {beta:.3g} s may make the time-step of {step:.3g} s unstable: "
            f"{fraction}, or a smaller fcrit, or MASS damping alone"
        )
    return (
        f"the time-step of {step:.3g} s is {share:.3g} of the safe bound, which "
        f"{_place(array.h, safe.address)} sets, and may be unstable: {fraction}"
    )


def describe(array: MainArray, safe: Limit) -> str:
    """One line: the time-step, its shares of estimate and safe bound, and which groups set these."""
    step = float(array.h.cr[g.TDEL])
    parts = [
        f"{step / limit.step if limit.step else math.inf:.3g} of the {name} {limit.step:.4g} s "
        f"({_place(array.h, limit.address)})"
        for name, limit in (("estimate", estimate(array)), ("safe bound", safe))
        if math.isfinite(limit.step)
    ]
    return f"time-step {step:.4g} s, {', '.join(parts)}"


def kind_of(h: Memory, address: int) -> str:
    """What a message is about: `block@163`, or `grid-point@5917 of block@163`, or one of its zones."""
    ib, what = owner(h, address)
    if what == NOBODY:
        return f"@{address}"
    if what == BLOCK:
        return f"block@{ib}"
    if what == STRAIN:
        return f"the strain of block@{ib}"
    return f"{'grid-point' if what == GRIDPOINT else 'zone'}@{address} of block@{ib}"


def _place(h: Memory, address: int) -> str:
    """The same, with the centroid of the block."""
    ib, what = owner(h, address)
    at = f" at ({getr(h, ib, g.KX):.4g}, {getr(h, ib, g.KY):.4g})" if what != NOBODY else ""
    return kind_of(h, address) + at


def _reals(h: Memory, at: Array, k: Offset) -> Array:
    return np.asarray(getr(h, at, k), np.float64)
