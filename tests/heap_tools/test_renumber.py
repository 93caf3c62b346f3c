"""Groups in the order of their lists: the same map and the same digits, at other addresses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from naive.relocate import differences, essence, relocate
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.checker import check
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, iget, puti
from udec_ia.heap_tools.renumber_groups import renumber
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts, read_table
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import Unsound, boundary, groups, members

TABLE = read_table()


@pytest.fixture(name="shuffled", params=["i16r32", "i32r64"])
def at_random_addresses(request: pytest.FixtureRequest) -> Model:
    """Groups of every kind, anywhere, and some junk."""
    m = every_kind(request.param)
    m.session.array = relocate(m.array, np.random.default_rng(3))
    m.split(0.2, -2, 0.2, 2)
    m.delete(0, 0.2, 0, 1)
    assert m.h.ci[g.JUNK] != 0
    return m


def test_lists_lie_in_their_order(shuffled: Model) -> None:
    """From address 1, kind by kind, each group where the one before it in its list ends."""
    before = essence(shuffled.array)
    renumber(shuffled.array)
    assert differences(before, essence(shuffled.array)) == []
    assert check(shuffled.array) == []
    h, layout = shuffled.array.h, layouts(shuffled.array.scheme.ratio)
    assert h.ci[g.JUNK] == 0
    listed = ("block", "contact", "domain", "bound", "signal", "follower", "history", "summand", "outside")
    listed = *listed, "crack", "member", "breakable", "bolt", "node", "element"
    order = {kind: [*groups(h, kind)] for kind in listed}
    order["corner"] = [
        iad for ib in order["block"] for iad in boundary(h, ib) if iget(h, iad, HEAD) == g.MCOR
    ]
    for kind in ("gridpoint", "zone"):
        order[kind] = [iad for ib in order["block"] for iad in members(h, ib, kind)]
    for kind in ("sdef", "fdef", "tabpoint"):
        order[kind] = table(shuffled.array, kind)["address"].tolist()
    expected = 1
    behind = TABLE.behind(lambda flag: int(h.ci[getattr(g, flag)]))
    for kind in (group.name for group in TABLE.groups if not group.behind):
        row = [kind]
        while row[-1] in behind:
            row.append(behind[row[-1]])
        for iad in order.get(kind, ()):
            assert iad == expected
            expected += sum(layout[one].size for one in row)
    assert h.ci[g.MFREE] == expected


def test_a_second_time_nothing_moves(shuffled: Model) -> None:
    renumber(shuffled.array)
    again = renumber(shuffled.array)
    assert again.head[0].startswith("0 of ")
    assert again.head[0].endswith("; 0 words were junk")


@pytest.mark.parametrize("cycles", [0, 40])
def test_a_run_goes_on_to_the_last_bit(cycles: int, tmp_path: Path) -> None:
    here, there = every_kind(), every_kind()
    for m in (here, there):
        m.out = tmp_path
        m.cycle(cycles)
    renumber(there.array)
    for m in (here, there):
        m.cycle(40)
        m.split(-1, 0.7, 1.2, 0.7)
        m.cycle(20)
    assert differences(essence(here.array), essence(there.array)) == []
    for one, two in zip(here.histories(), there.histories(), strict=True):
        assert np.array_equal(one.numbers, two.numbers)


def test_an_empty_model() -> None:
    m = Model()
    m.start()
    assert renumber(m.array).head == ["0 of 0 groups have another address; 0 words were junk"]
    assert (m.h.ci[g.MFREE], check(m.array)) == (1, [])


def test_what_cannot_be_told_apart_stays_as_it_is(shuffled: Model) -> None:
    rng, words = np.random.default_rng(11), int(shuffled.h.ci[g.MFREE]) - 1
    refused = 0
    for _ in range(200):
        array = shuffled.array.copy()
        at = int(rng.integers(words))
        array.h.ia[at] = rng.choice([0, 1, -1, int(rng.integers(words)), 32767])
        before = array.h.ia.tobytes(), array.h.ci.tobytes()
        try:
            renumber(array)
        except UdecError:
            refused += 1
            assert (array.h.ia.tobytes(), array.h.ci.tobytes()) == before
    assert 10 < refused < 190
    array = shuffled.array
    puti(array.h, int(array.h.ci[g.IBPNT]), g.KP, 1)
    with pytest.raises(Unsound):
        renumber(array)
