"""Where in the rock a group lies: the blocks that it belongs to, with centroid and corners.

Corners are those that name the block as their host, wherever the lists lead: so it can be told of a damaged
heap, too.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import getr, integers
from udec_ia.layout import offsets as g
from udec_ia.reader.atlas import KINDS, Atlas, Span

NEIGHBOURS = ("loop", "watched")  # roles of pointers to a group that lies where a group without a block does


def homes(atlas: Atlas, span: Span) -> list[int]:
    """The blocks that a group belongs to; of a domain those at one of its contacts, for instance."""
    blocks = atlas.owners(span)
    if not blocks and span.kind in KINDS:
        near = [int(atlas.value(word)) for word in atlas.words(span) if word.field.role in NEIGHBOURS]
        blocks = [block for iad in near if atlas.holds("any", iad) for block in atlas.owners(atlas.span(iad))]
    return [block for block in dict.fromkeys(blocks) if atlas.holds("block", block)]


def corners_of(atlas: Atlas, block: int) -> Any:
    """Places (n, 2) in m of the corners that name a block as theirs, by rising address."""
    at = atlas.groups["corner"]
    at = at[integers(atlas.h, at, g.KNB) == block]
    return np.stack([getr(atlas.h, at, g.KXP), getr(atlas.h, at, g.KYP)], axis=-1)


def places(atlas: Atlas, span: Span) -> list[str]:
    """A sentence for each block that a group belongs to."""
    said = []
    for block in homes(atlas, span):
        x, y = (float(getr(atlas.h, block, k)) for k in (g.KX, g.KY))
        corners = corners_of(atlas, block)
        here = f"block@{block}: centroid ({x:.6g}, {y:.6g}) m"
        if len(corners):
            (x1, y1), (x2, y2) = corners.min(axis=0), corners.max(axis=0)
            here += f", {len(corners)} corners in x {x1:.6g} to {x2:.6g} m, y {y1:.6g} to {y2:.6g} m"
        said.append(here)
    return said
