"""Structures between two cycles: points that belong to blocks are found again, and forces are summed again.

A command may cut blocks, merge them, delete them or divide them into zones. The points of structures keep
their places, and belong to what is there then. A bolt or element that has lost the block at one of its ends
is given back, and so is a node that is left without elements.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.kernels.structures.beams import attach_nodes, sum_beams
from udec_ia.kernels.structures.bolts import attach_bolts, sum_bolts
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import drop, list_of


def has_structures(h: Memory) -> bool:
    """True if there is any structure."""
    return bool(h.ci[g.IBTPNT] or h.ci[g.INDPNT])


def number_of_structures(h: Memory) -> int:
    """How many bolts and elements there are."""
    return len(list_of(h, "bolt")) + len(list_of(h, "element"))


def held_blocks(h: Memory) -> Any:
    """Addresses of blocks on which a structure acts with a force."""
    bolts, nodes = list_of(h, "bolt"), list_of(h, "node")
    bolts = bolts[(np.asarray(getr(h, bolts, g.KAFN)) != 0) | (np.asarray(getr(h, bolts, g.KAFS)) != 0)]
    nodes = nodes[(np.asarray(getr(h, nodes, g.KNFN)) != 0) | (np.asarray(getr(h, nodes, g.KNFS)) != 0)]
    ends = [integers(h, bolts, k) for k in (g.KAB1, g.KAB2)] + [integers(h, nodes, g.KNBL)]
    return np.unique(np.concatenate(ends))


def attach(h: Memory) -> bool:
    """Find the blocks of all points of structures again; True if one has changed."""
    nodes = list_of(h, "node")
    joined = nodes[integers(h, nodes, g.KNBL) != 0]
    changed = bool(attach_bolts(h)) | bool(attach_nodes(h))
    if changed:
        bolts, elements = list_of(h, "bolt"), list_of(h, "element")
        lost = (integers(h, bolts, g.KAB1) == 0) | (integers(h, bolts, g.KAB2) == 0)
        drop(h, "bolt", bolts[lost].tolist())
        gone = joined[integers(h, joined, g.KNBL) == 0]
        ends = np.stack([integers(h, elements, k) for k in (g.KMN1, g.KMN2)])
        drop_elements(h, elements[np.isin(ends, gone).any(axis=0)])
    return changed


def drop_elements(h: Memory, elements: Any) -> None:
    """Give back elements of cables and beams, and nodes that are left without any."""
    drop(h, "element", elements.tolist())
    left, nodes = list_of(h, "element"), list_of(h, "node")
    ends = np.concatenate([integers(h, left, k) for k in (g.KMN1, g.KMN2)])
    drop(h, "node", np.setdiff1d(nodes, ends).tolist())


def push_by_structures(h: Memory) -> None:
    """Add the forces of all structures to the force sums of the blocks to which they belong now."""
    if has_structures(h):
        attach(h)
        sum_beams(h, False)
        sum_bolts(h, False)
