"""Dense matrices of mass, stiffness and viscous resistance of a model, put together element by element.

Degrees of freedom: x, y and rotation of a rigid block; these and the strains 11, 22, 12 of a
simply-deformable one; x and y of every grid-point. Contacts count as closed and sticking. What is held is
left out.
"""

from __future__ import annotations

from math import hypot, sqrt
from typing import Any

import numpy as np

from naive.bodies import FULLY, ON_CORNERS, SIMPLY, by_address, zone_area, zones_of
from udec_ia.layout import offsets as g

Model = Any
Pair = tuple[float, float]
Materials = Pair | dict[int, Pair]  # two numbers of a material, of all or by its number


def of(given: Materials, material: int) -> Pair:
    """The two numbers of a material."""
    return given[material] if isinstance(given, dict) else given


def elastic(bulk: float, shear: float) -> Any:
    """Stresses 11, 22, 12 of strains 11, 22 and twice 12 in plane strain."""
    one, two = bulk + 4 * shear / 3, bulk - 2 * shear / 3
    return np.array([[one, two, 0], [two, one, 0], [0, 0, shear]])


class Scene:
    """A model taken apart. first: row of the first degree of freedom of a block or grid-point.

    moduli: bulk and shear modulus. joints: KN and KS.
    """

    def __init__(self, model: Model, moduli: Materials, joints: Materials) -> None:
        self.blocks, self.corners = by_address(model.table("block")), by_address(model.table("corner"))
        self.points, self.soft = by_address(model.table("gridpoint")), by_address(model.table("sdef"))
        self.first: dict[int, int] = {}
        self.held: list[int] = []
        n = 0
        for ib, row in self.blocks.items():
            if row["HEAD"] != FULLY:
                self.first[ib] = n
                n += 6 if row["HEAD"] == SIMPLY else 3
        for ig in self.points:
            self.first[ig] = n
            n += 2
        self.mass, self.stiffness, self.drag = (np.zeros((n, n)) for _ in range(3))
        self._masses()
        self._hold(model)
        self._zones(model, moduli)
        self._contacts(model, joints)
        self._dashpots(model)

    def _masses(self) -> None:
        for ib, row in self.blocks.items():
            if row["HEAD"] == FULLY:
                continue
            k = self.first[ib]
            self.mass[k, k] = self.mass[k + 1, k + 1] = row["KBM"]
            self.mass[k + 2, k + 2] = row["KBI"]
            if row["HEAD"] == SIMPLY:
                j = self.soft[int(row["KBEX"])]
                j11, j12, j22 = float(j["KSJ11"]), float(j["KSJ12"]), float(j["KSJ22"])
                self.mass[k + 3 : k + 6, k + 3 : k + 6] = [
                    [j11, 0, j12],
                    [0, j22, j12],
                    [j12, j12, j11 + j22],
                ]
        for ig, row in self.points.items():
            k = self.first[ig]
            self.mass[k, k] = self.mass[k + 1, k + 1] = row["KGPM"]

    def _hold(self, model: Model) -> None:
        """What FIX and given velocities hold."""
        host = {}
        for row in self.corners.values():
            host[int(row["KNB"])] = row
        extension = by_address(model.table("fdef"))
        for ib, row in self.blocks.items():
            fix = int(row["KBFIX"])
            if row["HEAD"] == FULLY:
                ig = int(extension[int(row["KBEX"])]["KFG"])
                while ig:
                    given = 3 if fix == 1 else int(self.points[ig]["KGFIX"])
                    self.held += [self.first[ig] + axis for axis in (0, 1) if given & (1 << axis)]
                    ig = int(self.points[ig]["KG"])
                continue
            k = self.first[ib]
            if fix == 1:
                self.held += range(k, k + (6 if row["HEAD"] == SIMPLY else 3))
            else:
                self.held += [k] * bool(fix & 2) + [k + 1] * bool(fix & 4) + [k + 2] * (fix == 6)

    def _zones(self, model: Model, moduli: Materials) -> None:
        hosts = zones_of(model)
        for ib, zone in [(ib, zone) for ib, zones in hosts.items() for zone in zones]:
            law = elastic(*of(moduli, int(self.blocks[ib]["KMAT"])))
            ring = [int(ig) for ig in zone["KZG"]]
            at = np.array(
                [(1.0, float(self.points[ig]["KXG"]), float(self.points[ig]["KYG"])) for ig in ring]
            )
            shapes = np.linalg.inv(at)  # column i: constant, d/dx and d/dy of the shape function of corner i
            strain, rows = np.zeros((3, 6)), []
            for i, ig in enumerate(ring):
                b, c = shapes[1, i], shapes[2, i]
                strain[:, 2 * i : 2 * i + 2] = [[b, 0], [0, c], [c, b]]
                rows += [self.first[ig], self.first[ig] + 1]
            self.stiffness[np.ix_(rows, rows)] += zone_area(self.points, zone) * strain.T @ law @ strain
        for ib, row in self.blocks.items():
            if row["HEAD"] == SIMPLY:
                law = elastic(*of(moduli, int(row["KMAT"])))
                area = float(self.soft[int(row["KBEX"])]["KSAREA"])
                k = self.first[ib] + 3
                scale = np.diag([1.0, 1.0, 2.0])
                self.stiffness[k : k + 3, k : k + 3] += area * scale @ law @ scale

    def moves(self, ib: int, ip: int, at_corner: bool, x: float, y: float) -> Any:
        """How the point (x, y) of block `ib`, on or before corner `ip`, moves with all degrees of freedom."""
        found = np.zeros((2, len(self.mass)))
        row = self.blocks[ib]
        if row["HEAD"] == FULLY:
            end, start = self.corners[ip], self.corners[int(self.corners[ip]["KR"])]
            dx, dy = float(end["KXP"] - start["KXP"]), float(end["KYP"] - start["KYP"])
            part = ((x - start["KXP"]) * dx + (y - start["KYP"]) * dy) / (dx * dx + dy * dy)
            for corner, share in ((end, 1.0 if at_corner else part), (start, 0.0 if at_corner else 1 - part)):
                k = self.first[int(corner["KGP"])]
                found[0, k] += share
                found[1, k + 1] += share
            return found
        rx, ry, k = x - float(row["KX"]), y - float(row["KY"]), self.first[ib]
        found[:, k : k + 3] = [[1, 0, -ry], [0, 1, rx]]
        if row["HEAD"] == SIMPLY:
            found[:, k + 3 : k + 6] = [[rx, 0, ry], [0, ry, rx]]
        return found

    def _contacts(self, model: Model, joints: Materials) -> None:
        for row in model.table("contact"):
            kn, ks = of(joints, int(row["KCM"]))
            code = int(row["KCCOD"])
            if code == g.VIRTUAL:
                continue
            x, y = float(row["KXC"]), float(row["KYC"])
            one, two = int(row["KCP1"]), int(row["KCP2"])
            on_one, on_two = code in (ON_CORNERS, 2), code in (ON_CORNERS, 3)
            between = self.moves(int(row["KB2"]), two, on_two, x, y)
            between -= self.moves(int(row["KB1"]), one, on_one, x, y)
            n = self.normal(code, one, two)
            t = np.array((n[1], -n[0]))
            self.stiffness += between.T @ (kn * np.outer(n, n) + ks * np.outer(t, t)) @ between

    def normal(self, code: int, one: int, two: int) -> Any:
        """Unit normal of a contact of the corners `one` and `two`, or of the edges that end there."""
        a, b = self.corners[one], self.corners[two]
        if code == ON_CORNERS:
            n = np.array((b["KXCP"] - a["KXCP"], b["KYCP"] - a["KYCP"]), float)
        else:
            end = b if code == 2 else a
            start = self.corners[int(end["KR"])]
            n = np.array((-(end["KYP"] - start["KYP"]), end["KXP"] - start["KXP"]), float)
        return n / hypot(*n)

    def _dashpots(self, model: Model) -> None:
        for row in model.table("bound"):
            ib, ig, ip = (int(row[k]) for k in ("KUB", "KUG", "KUP"))
            c = np.array([[row["KUCXX"], row["KUCXY"]], [row["KUCXY"], row["KUCYY"]]], float)
            if ig:
                k = self.first[ig]
                self.drag[k : k + 2, k : k + 2] += c
            elif ip:
                corner = self.corners[ip]
                moves = self.moves(ib, ip, True, float(corner["KXP"]), float(corner["KYP"]))
                self.drag += moves.T @ c @ moves

    def critical(self) -> float:
        """The greatest stable time-step: where dt^2 K + 2 dt C first reaches 4 M.

        Positions and velocities at half steps, dashpots with the last velocity: v+ = v - dt (K x + C v)/M.
        """
        free = np.setdiff1d(np.arange(len(self.mass)), self.held)
        mass, stiffness, drag = (a[np.ix_(free, free)] for a in (self.mass, self.stiffness, self.drag))
        lower = np.linalg.inv(np.linalg.cholesky(mass))
        stiff, damp = lower @ stiffness @ lower.T, lower @ drag @ lower.T
        most = float(np.linalg.eigvalsh(stiff)[-1])
        dt = 2 / sqrt(most)
        if not damp.any():
            return dt
        low, high = 0.0, dt
        for _ in range(60):
            dt = (low + high) / 2
            stable = float(np.linalg.eigvalsh(dt * dt * stiff + 2 * dt * damp)[-1]) < 4
            low, high = (dt, high) if stable else (low, dt)
        return low
