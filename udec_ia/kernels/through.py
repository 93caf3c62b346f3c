"""Has a block gone into another one in a single step, too fast for a contact (error 15)?

While no two points of a domain's boundary approach by more than 2 ETOL in a step, a contact is known before
the blocks touch. Blocks may move faster where nothing is in their way; what must not happen is that an arc
that was outside an edge, or no deeper in it than a contact may be, lies deeper than CTOL behind it one step
later: no contact would ever be formed, and one between two corners would be taken for an open one.
All arcs of the domain are held against the edges whose surroundings they passed through.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from offsets.generated import CTOL, KR, KRAD, KXCP, KXDP, KXP, KYCP, KYDP, KYP, NVIRT, TDEL
from udec_ia.heap.accessors import Memory, getr, iget, real
from udec_ia.heap.jit import kernel
from udec_ia.kernels.segments import ARC, BLOCK, COLUMNS, CORNER, collect, count_items
from udec_ia.kernels.sweep import ABOVE, BELOW, LEFT, RIGHT, meeting
from udec_ia.kernels.touch import ce


@kernel
def entered(h: Memory, ip: int, iq: int) -> bool:
    """True if in this step the circle of `ip` came from where a contact may be to deeper than CTOL behind the
    edge that ends at `iq`.

    It came in through the edge if its centre met the edge's line there, or is over the edge now.
    """
    ex, ey, overlap, along, z = ce(h, ip, iq)
    if overlap <= h.cr[CTOL]:
        return False
    ia, part = iget(h, iq, KR), along / z
    dx = getr(h, ip, KXDP) - getr(h, ia, KXDP) - part * (getr(h, iq, KXDP) - getr(h, ia, KXDP))
    dy = getr(h, ip, KYDP) - getr(h, ia, KYDP) - part * (getr(h, iq, KYDP) - getr(h, ia, KYDP))
    came = -(dx * ex + dy * ey) * h.cr[TDEL]
    if came <= overlap - h.cr[CTOL]:
        return False
    inside = max(overlap - getr(h, ip, KRAD), real(h, 0.0))
    met = along - inside / came * (dx * ey - dy * ex) * h.cr[TDEL]
    return 0 <= met <= z


@kernel
def _swept(h: Memory, ip: int, x: float, y: float, reach: float, boxes: Any, i: int) -> None:
    """Widen box `i` by the circle of radius `reach` round (x, y), which moves as corner `ip`, and its way."""
    back_x, back_y = x - getr(h, ip, KXDP) * h.cr[TDEL], y - getr(h, ip, KYDP) * h.cr[TDEL]
    boxes[i, LEFT] = min(boxes[i, LEFT], min(x, back_x) - reach)
    boxes[i, BELOW] = min(boxes[i, BELOW], min(y, back_y) - reach)
    boxes[i, RIGHT] = max(boxes[i, RIGHT], max(x, back_x) + reach)
    boxes[i, ABOVE] = max(boxes[i, ABOVE], max(y, back_y) + reach)


@kernel
def _boxes(h: Memory, seg: Any, n: int) -> Any:
    """What each segment has passed through in this step."""
    boxes = np.empty((n, 4), np.float64)
    for i in range(n):
        boxes[i, LEFT] = boxes[i, BELOW] = np.inf
        boxes[i, RIGHT] = boxes[i, ABOVE] = -np.inf
        ip = seg[i, CORNER]
        if seg[i, ARC] == 1:
            _swept(h, ip, getr(h, ip, KXCP), getr(h, ip, KYCP), getr(h, ip, KRAD), boxes, i)
        else:
            ia = iget(h, ip, KR)
            _swept(h, ip, getr(h, ip, KXP), getr(h, ip, KYP), h.cr[CTOL], boxes, i)
            _swept(h, ia, getr(h, ia, KXP), getr(h, ia, KYP), h.cr[CTOL], boxes, i)
    return boxes


@kernel
def gone_through(h: Memory, idm: int) -> bool:
    """True if an arc in domain `idm` has gone through an edge of another block in this step."""
    items = count_items(h, idm)
    seg = np.empty((2 * items + 2, COLUMNS), np.int64)
    n, _ = collect(h, idm, seg, np.empty((min(h.ci[NVIRT], items), 3), np.int64))
    pairs = meeting(_boxes(h, seg, n), n)
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        if seg[i, ARC] == seg[j, ARC] or seg[i, BLOCK] == seg[j, BLOCK]:
            continue
        arc, edge = (i, j) if seg[i, ARC] == 1 else (j, i)
        if entered(h, seg[arc, CORNER], seg[edge, CORNER]):
            return True
    return False
