"""Do blocks overlap by more than a contact can be made with?

A contact is formed while its overlap is at most CTOL, and no block that moves gets deeper than that unseen.
Where outlines change otherwise, by ROUND or by CHANGE, a corner that stood free in the void beside its
neighbours may lie deeper in one of them, and would never get a contact. Two blocks that overlap border on
one domain; of every domain all segments that face each other are held against each other.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, iget, int64, real
from udec_ia.kernels.detect.search import box, facing
from udec_ia.kernels.geometry.boxes import ABOVE, BELOW, LEFT, RIGHT, meeting
from udec_ia.kernels.map.segments import ARC, BLOCK, COLUMNS, CORNER, collect, count_items
from udec_ia.layout import offsets as g


@kernel
def _boxes(h: Memory, seg: Any, n: int, reach: float) -> Any:
    """Surroundings of the segments, grown so that those of two that overlap by up to `reach` meet."""
    boxes = np.empty((n, 4), np.float64)
    half = reach * real(h, 0.5)
    for i in range(n):
        boxes[i, LEFT], boxes[i, BELOW], boxes[i, RIGHT], boxes[i, ABOVE] = box(h, seg, i, half)
    return boxes


@kernel
def _deep_in_domain(h: Memory, idm: int, reach: float) -> tuple[int, int, float]:
    """deep_overlap for one domain, which has a loop."""
    items = count_items(h, idm)
    seg = np.empty((2 * items + 2, COLUMNS), np.int64)
    n, _ = collect(h, idm, seg, np.empty((min(h.ci[g.NVIRT], items), 3), np.int64))
    pairs = meeting(_boxes(h, seg, n, reach), n)
    for k in range(len(pairs)):
        i, j = pairs[k, 0], pairs[k, 1]
        if seg[i, BLOCK] == seg[j, BLOCK] or seg[i, ARC] + seg[j, ARC] == 0:
            continue
        code, overlap = facing(h, seg, i, j, reach)
        if code != 0 and overlap > h.cr[g.CTOL]:
            return seg[i, CORNER], seg[j, CORNER], overlap
    return int64(0), int64(0), real(h, 0.0)


@kernel
def deep_overlap(h: Memory, reach: float) -> tuple[int, int, float]:
    """Corners of two segments that overlap by more than CTOL, up to `reach`, and the overlap; or zeros."""
    idm = h.ci[g.IDPNT]
    while idm != 0:
        if iget(h, idm, g.KDLOOP) != 0:  # 0: a lone block
            ip, iq, overlap = _deep_in_domain(h, idm, reach)
            if ip != 0:
                return ip, iq, overlap
        idm = iget(h, idm, g.KD)
    return int64(0), int64(0), real(h, 0.0)
