"""Which group is which: against a slow matching by dictionaries, and after changes that change no state."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.relocate import relocate
from support.every_group_kind import every_kind
from support.random_scenes import play
from support.replayable_steps import blocks

from udec_ia import Model
from udec_ia.heap.accessors import iget
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.heap_tools.group_matching import Matching
from udec_ia.heap_tools.renumber_groups import renumber
from udec_ia.heap_tools.rewrite_heap import rewrite
from udec_ia.heap_tools.state_comparison import compare
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.group_tables import table

EXAMPLES = Path(__file__).parents[2] / "examples"
KINDS = [group.name for group in read_table().groups]
CHAINED = {"sdef", "fdef", "zone", "gridpoint", "tabpoint"}


def wall(columns: int = 4, rows: int = 3) -> Model:
    """Bricks of one size, of which some have been made and given back."""
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.block(0, 0, 0, rows, columns, rows, columns, 0)
    for y in range(1, rows):
        m.split(-1, y, columns + 1, y)
    for x in range(1, columns):
        m.split(x, -1, x, rows + 1)
    m.fix(0, columns, 0, 1)
    m.gravity(0, -10)
    return m


def by_hand(array: MainArray, gone: set[int]) -> dict[tuple[Any, ...], int]:
    """Address of each block, corner and contact by its place among the blocks that are not `gone`."""
    found: dict[tuple[Any, ...], int] = {}
    place: dict[int, int] = {}
    rows = {kind: table(array, kind) for kind in ("block", "corner", "contact")}
    corner = {int(row["address"]): row for row in rows["corner"]}
    key: dict[int, tuple[int, int]] = {}
    for row in rows["block"]:
        if int(row["address"]) in gone:
            continue
        number = place[int(row["address"])] = len(place)
        found["block", number] = int(row["address"])
        ip = int(row["KP"])
        for k in range(len(corner)):
            key[ip] = number, k
            found["corner", number, k] = ip
            ip = int(corner[ip]["KR"])
            if ip == row["KP"]:
                break
    for row in rows["contact"]:
        ends = [key.get(int(row[name])) for name in ("KCP1", "KCP2")]
        if None not in ends:
            count = sum(one[:3] == ("contact", *ends) for one in found)
            found[("contact", *ends, count)] = int(row["address"])
    return found


def matched(one: MainArray, two: MainArray) -> dict[str, set[tuple[int, int]]]:
    """Pairs of addresses, by kind."""
    pairs = Matching(one.h, two.h).pairs
    return {kind: {*zip(*(at.tolist() for at in both), strict=True)} for kind, both in pairs.items()}


def expected(one: MainArray, two: MainArray, gone: set[int], made: set[int]) -> set[tuple[int, int]]:
    """Pairs of blocks, corners and contacts that `by_hand` finds in both."""
    a, b = by_hand(one, gone), by_hand(two, made)
    return {(a[key], b[key]) for key in {*a} & {*b}}


@pytest.mark.parametrize("seed", range(6))
def test_blocks_that_go_anywhere(seed: int) -> None:
    """Some bricks are taken out of the wall, and it moves a little: the others are what they were."""
    rng = np.random.default_rng(seed)
    m = wall(5, 4)
    m.cycle(3)
    before, addresses = m.array.copy(), blocks(m)
    for ib in rng.choice(addresses, 3, replace=False).tolist():
        row = next(row for row in table(m.array, "block") if row["address"] == ib)
        m.delete(row["KX"] - 0.1, row["KX"] + 0.1, row["KY"] - 0.1, row["KY"] + 0.1)
    gone = {*addresses} - {*blocks(m)}
    assert len(gone) == 3
    m.cycle(20)
    after = relocate(m.array, rng)
    pairs = matched(before, after)
    found = {pair for kind in ("block", "corner", "contact") for pair in pairs[kind]}
    assert expected(before, after, gone, set()) <= found
    assert {a for a, _ in pairs["block"]} == {*addresses} - gone
    assert not {a for a, _ in pairs["corner"]} & {
        int(row["address"]) for row in table(before, "corner") if int(row["KNB"]) in gone
    }


def test_a_block_that_is_made_in_the_midst() -> None:
    """A cut: the block that was cut is what it was, and stands where it stood; the others match."""
    m = wall()
    m.cycle(1)
    before, addresses = m.array.copy(), blocks(m)
    m.split(1.5, 0.9, 1.5, 2.1)
    made = {*blocks(m)} - {*addresses}
    assert made
    pairs = matched(before, m.array)
    assert {a for a, _ in pairs["block"]} == {*addresses}
    assert all(a == b for a, b in pairs["block"])
    cut = {ib for ib in addresses if table(before, "block")["KBRO"].max() > 1.001 * _size(m.array, ib)}
    whole = {(a, b) for a, b in pairs["corner"] if iget(before.h, a, g.KNB) not in cut and a == b}
    assert len(whole) == 4 * (len(addresses) - len(cut))
    found = compare(before.h, m.array.h)
    assert {*found.alone["block"][1].tolist()} == made
    assert not len(found.alone["block"][0])


def _size(array: MainArray, ib: int) -> float:
    rows = table(array, "block")
    return float(rows["KBRO"][rows["address"] == ib][0])


@pytest.mark.parametrize("cycles", [0, 30])
def test_blocks_that_have_moved_far(cycles: int) -> None:
    """All by more than their own width: their order tells."""
    m = wall()
    m.cycle(1)
    before = m.array.copy()
    rows = table(m.array, "block")
    step = float(rows["KX"].max())
    for kind, names in (("block", ("KX",)), ("corner", ("KXP", "KXCP")), ("contact", ("KXC",))):
        for name in names:
            side = Matching(m.array.h, m.array.h).sides[0]
            at = side.atlas.groups[kind]
            m.array.h.ra[(at + side.word(kind, name).first - 1) // side.atlas.ratio] += step
    assert all(a == b for pairs in matched(before, m.array).values() for a, b in pairs)
    found = compare(before.h, m.array.h)
    assert {one.name for one in found.fields} == {"KX", "KXP", "KXCP", "KXC"}


@pytest.mark.parametrize("cycles", [1000, 2500])
def test_deformed_blocks_after_others_were_deleted(cycles: int, tmp_path: Path) -> None:
    """Deformable blocks change their size, and one may come to look like another did: their mass stays."""
    m = Model(out=tmp_path)
    m.run((EXAMPLES / "collapse-small.dat").read_text().partition("DUMP")[0] + "DAMP 0.5 1 MASS\n")
    m.cycle(400)
    one = m.array.copy()
    gone = {int(row["address"]) for row in m.table("block") if 20 < row["KX"] < 40 and 10 < row["KY"] < 20}
    m.damping(0.05, 1.0, "mass")
    m.delete(20, 40, 10, 20)
    m.cycle(cycles)
    found = Matching(one.h, m.array.h)
    assert {*found.left("block")[0].tolist()} == gone
    assert len(gone) == 4
    assert not len(found.left("block")[1])
    assert np.array_equal(*found.pairs["block"])  # no block that stays has got another address


@pytest.mark.parametrize("build", ["i16r32", "i32r64"])
def test_every_kind_at_other_addresses(build: str, tmp_path: Path) -> None:
    """Each group matches the one that `table` has in the same row, and nothing differs."""
    m = every_kind(build)
    m.out = tmp_path
    m.cycle(5)
    moved = relocate(m.array, np.random.default_rng(5))
    pairs = matched(m.array, moved)
    for kind in KINDS:
        rows = [table(array, kind)["address"].tolist() for array in (m.array, moved)]
        assert pairs[kind] == {*zip(*rows, strict=True)}, kind
        assert pairs[kind] or kind in ("jointext", "relax", "fracture")
    assert not compare(m.array.h, moved.h).differ


def test_in_the_order_of_its_lists_and_in_other_words(tmp_path: Path) -> None:
    m = every_kind()
    m.out = tmp_path
    m.cycle(7)
    m.delete(0, 1, 0, 1)
    other = rewrite(m.array, scheme("i64r64")).array
    renumber(other)
    assert not compare(m.array.h, other.h).differ
    narrow = compare(m.array.h, rewrite(m.array, scheme("i16r32")).array.h)
    assert not any(len(one) + len(two) for one, two in narrow.alone.values())
    assert all(float(one.distances.ulps.max()) <= 1 for one in narrow.fields)
    assert {one.kind for one in narrow.fields} <= {"common"}


def test_scenes_drawn_at_random() -> None:
    """Whatever commands and cycles do, each matches itself at other addresses."""
    for seed in range(4):
        array = play(seed, cycles=(5, 20)).model.array
        assert not compare(array.h, relocate(array, np.random.default_rng(seed)).h).differ
