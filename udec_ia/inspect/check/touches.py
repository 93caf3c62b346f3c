"""Invariant 7: contacts are what the outlines of their two blocks say."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from udec_ia.inspect.check.groups import State
from udec_ia.inspect.check.map import AHEAD
from udec_ia.inspect.check.outlines import Outlines, dot, length
from udec_ia.inspect.reading import INDEX, Numbers
from udec_ia.layout import offsets as g

TOGETHER = 20_000  # contacts that are looked at together


@dataclass(frozen=True)
class Touches:
    """The contacts that can be compared with the outlines; arrays with one element for each.

    row: row among the contacts in use; code; i, j: index of KCP1 and KCP2 among the corners of the
    outlines; overlap, point: from the outlines, the point in the middle of the overlap; slack: what they may
    be off by rounding, also because SPLIT has made the circles anew.
    """

    row: Numbers
    code: Numbers
    i: Numbers
    j: Numbers
    overlap: Numbers
    point: Numbers
    slack: Numbers

    def part(self, first: int, last: int) -> Touches:
        """Those from the first to before the last."""
        return Touches(*(column[first:last] for column in self.columns()))

    def columns(self) -> list[Numbers]:
        """All arrays."""
        return [getattr(self, field.name) for field in fields(self)]


def touches(state: State, o: Outlines) -> Touches:
    """The real contacts whose code and corners are sound, with the overlap that the outlines give."""
    index = np.full(len(state.address["corner"]) + 1, -1, INDEX)  # one more, for row -1
    index[state.rows("corner", o.corner)] = np.arange(len(o.corner))
    code = state.column("contact", "KCCOD")
    ends = [index[state.rows("corner", state.column("contact", name))] for name in AHEAD]
    comparable = (code >= g.CORNER_CORNER) & (code < g.VIRTUAL) & (ends[0] >= 0) & (ends[1] >= 0)
    at = np.flatnonzero(comparable)
    made = []
    for first in range(0, max(len(at), 1), TOGETHER):
        part = at[first : first + TOGETHER]
        made.append(_touches(o, part, code[part], ends[0][part], ends[1][part]))
    return Touches(*(np.concatenate(column) for column in zip(*map(Touches.columns, made), strict=True)))


def _touches(o: Outlines, at: Numbers, code: Numbers, i: Numbers, j: Numbers) -> Touches:
    """Those of the rows `at`, with these codes, at corners i and j."""
    between = o.c.take(j, 0) - o.c.take(i, 0)
    distance = length(between)
    two_arcs = code == g.CORNER_CORNER
    arc, edge = np.where(code == g.EDGE_CORNER, (j, i), (i, j))
    inward = np.where(
        two_arcs[:, None], between / distance[:, None], -o.normal(edge)
    )  # away from the arc's block
    deepest = o.deepest(arc, inward, ~two_arcs)
    overlap = np.where(two_arcs, o.r[i] + o.r[j] - distance, dot(deepest - o.p.take(edge, 0), inward))
    point = deepest - (overlap / 2)[:, None] * inward
    return Touches(at, code, i, j, overlap, point, 2 * np.maximum(o.slack[i], o.slack[j]))


def check_contacts(state: State, o: Outlines, touch: Touches) -> None:
    """Invariant 7: overlap and place of each contact are those of the outlines, the overlap within DTOL2."""
    contacts = state.address["contact"][touch.row]
    noted = state.column("contact", "KCN")[touch.row]
    for k in np.flatnonzero(np.abs(noted - touch.overlap) > touch.slack):
        state.report(
            7,
            f"KCN of contact@{contacts[k]} is {noted[k]}, but at corner@{o.corner[touch.i[k]]} and "
            f"corner@{o.corner[touch.j[k]]} the outlines overlap by {touch.overlap[k]}",
        )
    where = np.stack([state.column("contact", name)[touch.row] for name in ("KXC", "KYC")], axis=1)
    for k in np.flatnonzero(np.abs(where - touch.point).max(axis=1, initial=0.0) > touch.slack):
        state.report(
            7,
            f"KXC, KYC of contact@{contacts[k]} are {where[k, 0]}, {where[k, 1]}, but the outlines meet at "
            f"{touch.point[k, 0]}, {touch.point[k, 1]}",
        )
    limit = state.tolerance("DTOL2")
    for k in np.flatnonzero(np.maximum(noted, touch.overlap) > limit + touch.slack):
        state.report(
            7, f"the overlap of contact@{contacts[k]} is {max(noted[k], touch.overlap[k])}, DTOL2 is {limit}"
        )
