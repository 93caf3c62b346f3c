"""Invariant 7: contacts are what the outlines of their two blocks say."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_map import AHEAD
from udec_ia.compiling.interpreting import InterpretWhenSmall
from udec_ia.kernels.audit.block_outlines import Outlines
from udec_ia.kernels.audit.contact_positions import OVERLAP, PLACE, touching, unlike
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import INDEX, Numbers
from udec_ia.reader.kernel_rows import told

TOUCHING, UNLIKE = InterpretWhenSmall(touching, 5e5), InterpretWhenSmall(unlike, 1e6)  # contacts


class Touches(NamedTuple):
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


def touches(state: State, o: Outlines) -> Touches:
    """The real contacts whose code and corners are sound, with the overlap that the outlines give."""
    index = np.full(len(state.address["corner"]) + 1, -1, INDEX)  # one more, for row -1
    index[state.rows("corner", o.corner)] = np.arange(len(o.corner))
    code = state.column("contact", "KCCOD")
    ends = [index[state.rows("corner", state.column("contact", name))] for name in AHEAD]
    comparable = (code >= g.CORNER_CORNER) & (code < g.VIRTUAL) & (ends[0] >= 0) & (ends[1] >= 0)
    row = np.flatnonzero(comparable)
    i, j = (end[row] for end in ends)
    code, overlap, point = code[row].astype(np.int8), np.empty(len(row)), np.empty((len(row), 2))
    TOUCHING(len(row), o, code, i, j, overlap, point)
    slack = 2 * np.maximum(o.slack[o.owner[i]], o.slack[o.owner[j]])
    return Touches(row, code, i, j, overlap, point, slack)


def check_contacts(state: State, o: Outlines, touch: Touches) -> None:
    """Invariant 7: overlap and place of each contact are those of the outlines, the overlap within DTOL2."""
    contacts = state.address["contact"][touch.row]
    noted, x, y = (state.column("contact", name)[touch.row] for name in ("KCN", "KXC", "KYC"))
    limit = state.tolerance("DTOL2")
    by_outlines = touch.overlap, touch.point, touch.slack
    for k, what in told(UNLIKE, len(noted), 2, noted, x, y, *by_outlines, limit).tolist():
        contact, overlap = contacts[k], touch.overlap[k]
        if what == OVERLAP:
            state.report(
                7,
                f"KCN of contact@{contact} is {noted[k]}, but at corner@{o.corner[touch.i[k]]} and "
                f"corner@{o.corner[touch.j[k]]} the outlines overlap by {overlap}",
            )
        elif what == PLACE:
            state.report(
                7,
                f"KXC, KYC of contact@{contact} are {x[k]}, {y[k]}, but the outlines meet at "
                f"{touch.point[k, 0]}, {touch.point[k, 1]}",
            )
        else:
            state.report(7, f"the overlap of contact@{contact} is {max(noted[k], overlap)}, DTOL2 is {limit}")
