"""What can be drawn of a heap that may be damaged: blocks whose corners hang together, and places.

A block is whole if the list of its corners comes round and each of them names it. What is not a finite
number, or so far away that all else would be a dot, is left out; how many blocks that are is counted.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Offset, getr, iget
from udec_ia.layout import offsets as g
from udec_ia.output.outline import Outlines, outlines
from udec_ia.reader.atlas import KINDS, Atlas

FAR = 100.0  # times the median distance of corners from their middle: nothing sound is further away
BEYOND = 1e30  # m: no arc is there


def outlines_left(atlas: Atlas) -> tuple[Outlines, int]:
    """The outlines of all blocks that are whole and near, and the number of the others."""
    every = atlas.groups["block"].tolist()
    with np.errstate(all="ignore"):
        whole = outlines(atlas.h, [ib for ib in every if is_whole(atlas, ib)])
        arcs = np.abs(np.concatenate([whole.centre, whole.radius[:, None]], axis=1)) < BEYOND
        good = is_near(whole.corner, whole.corner) & arcs.all(axis=1)
        near = is_near(whole.centroid, whole.corner)
        near[near] = np.logical_and.reduceat(good, whole.first[:-1])[near] if len(good) else False
    rounding = whole.rounding if 0.0 <= whole.rounding < BEYOND else 0.0
    return part(replace(whole, rounding=rounding), near), len(every) - int(near.sum())


def part(o: Outlines, chosen: Any) -> Outlines:
    """Some of the blocks: those with True in `chosen` (m,)."""
    corners = np.diff(o.first)
    of_blocks = ("centroid", "fixed", "material", "address", "kind")
    of_corners = ("corner", "centre", "radius", "corner_address")
    return replace(
        o,
        first=np.cumsum([0, *corners[chosen]]),
        **{name: getattr(o, name)[chosen] for name in of_blocks},
        **{name: getattr(o, name)[np.repeat(chosen, corners)] for name in of_corners},
    )


def is_whole(atlas: Atlas, ib: int) -> bool:
    """True if the reverse list of a block comes round, and all its corners are those of the block."""
    starts, corner = memoryview(atlas.starts), KINDS.index("corner") + 1
    first = ip = iget(atlas.h, ib, g.KP)
    seen: set[int] = set()
    while ip not in seen:
        if not 0 < ip < len(starts) or starts[ip] != corner or iget(atlas.h, ip, g.KNB) != ib:
            return False
        seen.add(ip)
        ip = iget(atlas.h, ip, g.KR)
    return ip == first and len(seen) > 2


def is_near(places: Any, corners: Any) -> Any:
    """True for each of `places` (n, 2) in m that is finite and not far from where corners (m, 2) are."""
    finite = corners[np.isfinite(corners).all(axis=1)]
    if not len(finite):
        return np.zeros(len(places), bool)
    middle = np.median(finite, axis=0)
    reach = FAR * np.median(np.abs(finite - middle).max(axis=1))
    return np.isfinite(places).all(axis=1) & (np.abs(places - middle).max(axis=1, initial=0.0) <= reach)


def points(atlas: Atlas, at: Any, kx: Offset, ky: Offset) -> Any:
    """Places (n, 2) in m of groups at some addresses."""
    return np.stack([np.asarray(getr(atlas.h, at, k), np.float64) for k in (kx, ky)], axis=-1)
