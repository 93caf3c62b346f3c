"""Names and places of blocks, grid-points, zones and contacts for messages."""

from __future__ import annotations

from udec_ia.heap.accessors import HEAD, Memory, getr, iget
from udec_ia.kernels.links.linked_lists import BLOCK, GRIDPOINT, NOBODY, STRAIN, owner
from udec_ia.layout import offsets as g


def name_of(h: Memory, address: int) -> str:
    """The name of a group: `block@163`, `grid-point@5917 of block@163`, one of its zones, or `node@99`."""
    ib, what = owner(h, address)
    if what == NOBODY:
        return f"node@{address}" if _is_node(h, address) else f"@{address}"
    if what == BLOCK:
        return f"block@{ib}"
    if what == STRAIN:
        return f"the strain of block@{ib}"
    return f"{'grid-point' if what == GRIDPOINT else 'zone'}@{address} of block@{ib}"


def name_and_place(h: Memory, address: int) -> str:
    """The name of a group with the centroid of its block, or of a node with its place."""
    ib, what = owner(h, address)
    if _is_node(h, address):
        return f"{name_of(h, address)} at ({getr(h, address, g.KNX):.4g}, {getr(h, address, g.KNY):.4g})"
    at = f" at ({getr(h, ib, g.KX):.4g}, {getr(h, ib, g.KY):.4g})" if what != NOBODY else ""
    return name_of(h, address) + at


def _is_node(h: Memory, address: int) -> bool:
    """True if a node of a structure is at `address`."""
    return address > 0 and iget(h, address, HEAD) == g.MNOD


def strained_name(h: Memory, iz: int) -> str:
    """Name and centroid of zone `iz` with its block, or of simply-deformable block `iz`."""
    if iget(h, iz, HEAD) == g.MSDEF:
        return f"block@{iz} at ({getr(h, iz, g.KX):g}, {getr(h, iz, g.KY):g})"
    corners = [iget(h, iz, g.KZG, i) for i in range(3)]
    x, y = (sum(float(getr(h, ig, k)) for ig in corners) / 3 for k in (g.KXG, g.KYG))
    return f"{name_of(h, iz)} at ({x:g}, {y:g})"


def contact_name(h: Memory, ic: int) -> str:
    """Name of contact `ic` with its blocks and its place."""
    return (
        f"contact@{ic} of block@{iget(h, ic, g.KB1)} and block@{iget(h, ic, g.KB2)} at "
        f"({getr(h, ic, g.KXC):.4g}, {getr(h, ic, g.KYC):.4g})"
    )
