"""The kinds of groups (kinds.py) are made anew where something else than kernels has changed the words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from udec_ia.heap.census import census
from udec_ia.heap.checked import KINDS, NOTHING, SPARE, TABLE
from udec_ia.heap.junk import junk_chains
from udec_ia.heap.kinds import shadow
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts

MARKS = g.MFREE, g.JUNK, g.IBPNT, g.ICPNT, g.IDPNT  # what only kernels change
HEADED = {head.group for head in TABLE.heads}  # kinds that their head code gives away


def enter(h: Any) -> None:
    """Kernels are about to work on `h`: see to it that the kinds are known."""
    here = shadow(h.ia)
    here.notes[:] = 0
    if not here.known or here.left != _marks(h):
        here.kinds[:] = NOTHING
        _find(h, here.kinds)
        here.known = True


def leave(h: Any) -> None:
    """They have done."""
    shadow(h.ia).left = _marks(h)


def _marks(h: Any) -> tuple[int, ...]:
    return tuple(int(h.ci[mark]) for mark in MARKS)


def _find(h: Any, kinds: Any) -> None:
    """Put the kinds of all groups into `kinds`; of groups that lie in each other, that of the surest one."""
    taken = np.zeros(len(kinds) + 2, np.int64)  # by address: groups that begin there less those that end
    for number, at, size in _groups(h):
        before = np.concatenate(([0], np.cumsum(np.cumsum(taken) > 0)))  # words of groups below an address
        free = before[at + size] == before[at]
        free[1:] &= at[1:] >= (at + size)[:-1]
        kinds[at[free] - 1] = number
        np.add.at(taken, at[free], 1)
        np.add.at(taken, (at + size)[free], -1)


def _groups(h: Any) -> Iterator[tuple[int, Any, Any]]:
    """Number of the kind, addresses, and words of the groups: junk, then what its head code gives away."""
    layout, words = layouts(int(h.ra.itemsize // h.ia.itemsize)), getattr(h.ia, "array", h.ia)
    top = max(1, min(int(h.ci[g.MFREE]), len(words) + 1))
    junk = sorted(group for chain in junk_chains(words[: top - 1], int(h.ci[g.JUNK])) for group in chain)
    yield SPARE, np.array([at for at, _ in junk], np.int64), np.array([size for _, size in junk], np.int64)
    for kind, at in sorted(census(h).items(), key=lambda item: item[0] not in HEADED):
        yield KINDS.index(kind), at, np.full(len(at), layout[kind].size)
