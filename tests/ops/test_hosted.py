"""What belongs to a block is given back with it, by what the field table says of its host."""

from __future__ import annotations

import numpy as np

from udec_ia import Model
from udec_ia.heap.accessors import integers
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import lose_hosted


def loaded() -> Model:
    """Three blocks in a row, each under a load."""
    m = Model()
    m.block(0, 0, 0, 1, 3, 1, 3, 0)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.split(1, -1, 1, 2)
    m.split(2, -1, 2, 2)
    m.round(0.05)
    m.boundary(-1, 4, -1, 2, yforce=-1.0)
    return m


def test_those_of_other_blocks_stay_and_the_list_holds() -> None:
    for places in ([1], [0, 2]):
        m = loaded()
        before, gone = m.table("bound"), m.table("block")["address"][places].tolist()
        assert len(before) == 3
        lose_hosted(m.array.h, gone)
        after = m.table("bound")["address"]
        assert after.tolist() == before["address"][~np.isin(before["KUB"], gone)].tolist()
        assert not np.isin(integers(m.array.h, after, g.KUB), gone).any()
        assert m.check() == []
