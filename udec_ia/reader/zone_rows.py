"""The zones of one block as arrays: grid-points, triangles and stresses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g


@dataclass(frozen=True, eq=False)
class ZoneRows:
    """Zones of a block.

    points: (n,) addresses of grid-points, place: (n, 2) coordinates (m). zones: (m,) addresses, triples: (m,
    3) rows of `points`, stress: (m, 3) components 11, 12 and 22 (Pa). paired: successive zones are pairs.
    """

    points: Any
    place: Any
    zones: Any
    triples: Any
    stress: Any
    paired: bool

    @property
    def centroids(self) -> Any:
        """Centroids of the zones, (m, 2) in m."""
        return self.place[self.triples].mean(axis=1)


def has_zones(h: Memory, ib: int) -> bool:
    """True if block `ib` is divided into zones."""
    return iget(h, ib, HEAD) == g.MFDEF and iget(h, iget(h, ib, g.KBEX), g.KFG) != 0


def any_zones(h: Memory) -> bool:
    """True if a block is divided into zones."""
    if h.ci[g.NSOFT] == 0:
        return False
    blocks = addresses(h, int(h.ci[g.IBPNT]), g.KB)
    zoned = blocks[integers(h, blocks, HEAD) == g.MFDEF]
    return bool(integers(h, integers(h, zoned, g.KBEX), g.KFG).any())


def zone_rows(h: Memory, ib: int) -> ZoneRows:
    """The zones of block `ib`, in the order of their list."""
    ie = iget(h, ib, g.KBEX)
    points, zones = addresses(h, iget(h, ie, g.KFG), g.KG), addresses(h, iget(h, ie, g.KFZ), g.KZ)
    order = np.argsort(points)
    triples = np.stack([integers(h, zones, g.KZG, i) for i in range(3)], axis=1)
    return ZoneRows(
        points,
        reals(h, points, g.KXG, g.KYG),
        zones,
        order[np.searchsorted(points, triples, sorter=order)],
        reals(h, zones, g.KZS11, g.KZS12, g.KZS22),
        iget(h, ie, g.KFMIX) == 1,
    )


def reals(h: Memory, groups: Any, *fields: Any) -> Any:
    """Real fields of many groups, one column each, as 64-bit reals."""
    return np.stack([np.asarray(getr(h, groups, k), np.float64) for k in fields], axis=1)
