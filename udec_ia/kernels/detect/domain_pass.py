"""The domain pass: fictitious displacements that trigger updates (ACCUM; report 2.2).

In every domain the greatest relative velocities in x and in y between any two of its corners and contact
points are multiplied by the time-step and summed. When the sum exceeds ETOL = ATOL/sqrt(2), segments may be
near enough for a contact, and the domain is updated.

A contact point counts with the velocities of both its blocks: then no point of a domain's boundary is faster
than the compared points, and no contact can be missed.

A domain is updated when the sum would exceed ETOL in the next step, so that contacts form before segments
touch. In a step with a relative displacement of more than ETOL, two blocks can change from no overlap to one
of more than CTOL, at which no contact can form. This is an error. passage_through_block.py proves that no
other case can be missed.

The pass may wait while all blocks are slow. No relative velocity exceeds twice that of the fastest block, so
this bound is summed instead (UPEND), and added to every domain before it reaches HTOL, a hundredth of ETOL. A
scene at rest spends no time on its domains.

Open contacts are compared with their neighbours (map_changes.py) in a cycle in which a domain will be
updated, or in which the greatest displacement within any domain since the last comparison (ULOOK) has reached
HTOL. Blocks that fly together cause no comparison.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.kernel_memory import LEAD, fetch
from udec_ia.heap.accessors import Memory, getr, iget, int64, putr, real
from udec_ia.kernels.body.boundary_point import velocity_at
from udec_ia.kernels.links.linked_lists import is_corner
from udec_ia.kernels.links.longer_groups import contact_words
from udec_ia.kernels.map.domain_segments import loop_start
from udec_ia.layout import offsets as g


@kernel
def relative_velocity(h: Memory, idm: int, soft: Any) -> float:
    """Greatest relative velocity, in x or in y, between two points of domain `idm` (ACCUM)."""
    if iget(h, idm, g.KDLOOP) == 0:
        return real(h, 0.0)
    start, first = loop_start(h, idm)
    item, block = start, first
    far = real(h, np.inf)
    lx, ly, hx, hy = far, far, -far, -far
    one, two = iget(h, item, g.KB1), iget(h, item, g.KB2)
    all_real = h.ci[g.NVIRT] == 0  # saves reading the far end of every contact
    while True:
        if all_real or iget(h, item, g.KCCOD) != g.VIRTUAL:
            x, y = getr(h, item, g.KXC), getr(h, item, g.KYC)
            vx, vy = velocity_at(h, one, item, x, y, soft)
            wx, wy = velocity_at(h, two, item, x, y, soft)
            lx, ly = min(lx, min(vx, wx)), min(ly, min(vy, wy))
            hx, hy = max(hx, max(vx, wx)), max(hy, max(vy, wy))
        after_one, after_two = iget(h, item, g.KL1), iget(h, item, g.KL2)  # both: to guess which costs more
        item = after_one if block == one else after_two
        while is_corner(h, item):
            vx, vy = getr(h, item, g.KXDP), getr(h, item, g.KYDP)
            lx, ly, hx, hy = min(lx, vx), min(ly, vy), max(hx, vx), max(hy, vy)
            item = iget(h, item, g.KL)
        one, two = iget(h, item, g.KB1), iget(h, item, g.KB2)
        block = two if block == one else one
        if item == start and block == first:
            return max(hx - lx, hy - ly)


@inlined
def prefetch_domain(h: Memory, idm: int) -> int:
    """Prefetch the words that domain `idm` needs; returns the next domain, 0 if there is none."""
    if idm == 0:
        return int64(0)
    ic = iget(h, idm, g.KDLOOP)
    fetch(h, idm, g.NVDO, LEAD)
    fetch(h, ic + (LEAD + LEAD) * contact_words(h), g.NVCN)  # there are more contacts than domains
    if ic != 0:
        fetch(h, iget(h, ic, g.KL1), g.NVCR)
        fetch(h, iget(h, ic, g.KL2), g.NVCR)
        fetch(h, iget(h, ic, g.KB1), g.NVDO)  # the first words contain the velocities
        fetch(h, iget(h, ic, g.KB2), g.NVDO)
    return iget(h, idm, g.KD)


@kernel
def accumulate(h: Memory, fastest: float, soft: Any) -> int:
    """Sum the fictitious displacements of one step; returns the next phase, a value of JPHASE.

    AT_WAYS if a part of a domain has moved by more than ETOL in this step, else AT_DOMAINS if a domain must
    be updated, else AT_CONTACTS. fastest: a bound on the velocity of any point of any block in this step.
    """
    dt = h.cr[g.TDEL]
    bound = (fastest + fastest) * dt
    waiting = h.cr[g.UPEND]
    looked = h.cr[g.ULOOK] >= h.cr[g.HTOL]
    unseen = real(h, 0.0) if looked else h.cr[g.ULOOK]
    if waiting + bound < h.cr[g.HTOL]:
        h.cr[g.ULOOK] = unseen
        h.cr[g.UPEND] = waiting + bound
        return int64(g.AT_CONTACTS if h.ci[g.NDUE] == 0 else g.AT_DOMAINS)
    large = h.ci[g.LLARGE]
    largest = greatest = real(h, 0.0)
    idm = h.ci[g.IDPNT]
    ahead = idm
    for _ in range(LEAD):
        ahead = prefetch_domain(h, ahead)
    while idm != 0:
        ahead = prefetch_domain(h, ahead)
        is_large = large != 0 and iget(h, idm, g.KDLRG) != 0
        moved = bound if is_large and bound <= h.cr[g.ETOL] else relative_velocity(h, idm, soft) * dt
        umax = getr(h, idm, g.KUMAX)
        if not is_large or moved > h.cr[g.ETOL]:
            umax += waiting + moved
        if umax + moved > h.cr[g.ETOL] and not is_large:
            umax += moved
        putr(h, idm, g.KUMAX, umax)
        largest, greatest = max(largest, umax), max(greatest, moved)
        idm = iget(h, idm, g.KD)
    h.cr[g.UPEND] = real(h, 0.0)
    to_update = bool(largest > h.cr[g.ETOL] or h.ci[g.NDUE] != 0)
    h.cr[g.ULOOK] = h.cr[g.HTOL] if to_update else unseen + waiting + greatest
    if greatest > h.cr[g.ETOL]:
        return int64(g.AT_WAYS)
    return int64(g.AT_DOMAINS) if to_update else int64(g.AT_CONTACTS)
