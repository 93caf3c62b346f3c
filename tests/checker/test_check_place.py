"""The checker knows where along an outline a contact stands, also one that faces away from its arc."""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.checker.block_outlines import outlines
from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_places import Touches, place
from udec_ia.kernels.audit.outline_arrays import end_of
from udec_ia.layout import offsets as g


@pytest.mark.parametrize("turn", [0.0, 0.3, 2.0, 4.0])
def test_what_faces_away_from_an_arc_stands_at_its_nearer_end(turn: float) -> None:
    c, s = np.cos(turn), np.sin(turn)
    m = Model()
    m.block(*(n for x, y in ((0, 0), (0, 2), (4, 2), (4, 0)) for n in (c * x - s * y, s * x + c * y)))
    m.split(2 * c - 2 * -s, 2 * s - 2 * c, 2 * c - s * 4, 2 * s + c * 4)
    m.round(0.1)
    with np.errstate(all="ignore"):
        o = outlines(State(m.array))
    assert o is not None
    normals = np.column_stack((-o.t[:, 1], o.t[:, 0]))
    right = np.flatnonzero(np.abs(normals - (c, s)).max(axis=1) < 1e-9)  # corners at the end of right edges
    assert len(right) == 2
    one = np.zeros(1, np.int64)
    touch = Touches(one, one + g.CORNER_EDGE, right[:1], right[1:], one * 0.0, o.p[right[:1]], one * 0.0)
    (along,) = place(o, touch, 0)[3]
    (k,) = touch.i
    assert along == pytest.approx(end_of(o, k) + o.r[k] * np.pi / 2)
