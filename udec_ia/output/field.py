"""What goes on inside and around blocks: zones, stresses, velocities and displacements.

A Field is a copy of the moving points of one moment - grid-points of fully-deformable blocks, centroids of
all others - and of the stress in every zone and in every simply-deformable block. Displacements are those of
a point between two moments of one frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget
from udec_ia.layout import offsets as g
from udec_ia.reader.list_walks import groups, members

CONTOURS = {  # keyword of PLOT: what it means, from the stresses 11, 12, 22 (tension positive)
    "s11": "stress 11 (Pa)",
    "s12": "stress 12 (Pa)",
    "s22": "stress 22 (Pa)",
    "pressure": "pressure (Pa)",
    "shear": "greatest shear stress (Pa)",
}


@dataclass(frozen=True)
class Field:
    """Moving points (n): address, place (m) and velocity (m/s). Zones (k): corners (k, 3, 2), stress (k, 3).

    middle (m, 2), stress (m, 3): of all zones, and then of the simply-deformable blocks in list order.
    """

    address: Any
    place: Any
    velocity: Any
    zone: Any
    middle: Any
    stress: Any


def field(h: Memory) -> Field:
    """A copy of points and stresses of the present state. Unsound if the heap cannot be walked."""
    blocks = list(groups(h, "block"))
    hard = [ib for ib in blocks if iget(h, ib, HEAD) != g.MFDEF]
    points = [ig for ib in blocks for ig in members(h, ib, "gridpoint")]
    zones = [iz for ib in blocks for iz in members(h, ib, "zone")]
    simple = [iget(h, ib, g.KBEX) for ib in hard if iget(h, ib, HEAD) == g.MSDEF]
    place = np.concatenate([_reals(h, hard, g.KX, g.KY), _reals(h, points, g.KXG, g.KYG)])
    velocity = np.concatenate([_reals(h, hard, g.KXD, g.KYD), _reals(h, points, g.KXDG, g.KYDG)])
    at = {address: i for i, address in enumerate(hard + points)}
    rows = np.array([[at[iget(h, iz, g.KZG, i)] for i in range(3)] for iz in zones], int).reshape(-1, 3)
    zone_stress = _reals(h, zones, g.KZS11, g.KZS12, g.KZS22)
    centres = [place[at[ib]] for ib in hard if iget(h, ib, HEAD) == g.MSDEF]
    return Field(
        np.array(hard + points, np.int64),
        place,
        velocity,
        place[rows],
        np.concatenate([place[rows].mean(axis=1), np.array(centres).reshape(-1, 2)]),
        np.concatenate([zone_stress, _reals(h, simple, g.KS111, g.KS112, g.KS122)]),
    )


def _reals(h: Memory, addresses: list[int], *names: Offset) -> Any:
    at: Any = np.array(addresses, np.int64)
    return np.stack([np.array(getr(h, at, k), np.float64) for k in names], axis=-1)


def measure(stress: Any, name: str) -> Any:
    """One number for each stress (k, 3): see CONTOURS."""
    s11, s12, s22 = stress.T
    if name == "pressure":
        return -(s11 + s22) / 2
    if name == "shear":
        return np.hypot((s11 - s22) / 2, s12)
    return {"s11": s11, "s12": s12, "s22": s22}[name]
