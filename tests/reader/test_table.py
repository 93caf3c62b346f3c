"""Groups as structured arrays: every row and field is what the lists and the accessors give."""

from __future__ import annotations

import numpy as np
import pytest
from support.every_group_kind import every_kind
from support.handmade_map import two_blocks

from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import LISTS, Unsound, corners, groups

SCHEMES = tuple(ALL_SCHEMES)
KINDS = [group.name for group in read_table().groups]


def in_list_order(array: MainArray, kind: str) -> list[int]:
    """Addresses along the lists, by the plain walks."""
    if kind in LISTS:
        return list(groups(array.h, kind))
    return [iad for block in groups(array.h, "block") for iad in corners(array.h, block)]


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("kind", ["block", "corner", "contact", "domain"])
def test_every_field_of_every_group(name: str, kind: str) -> None:
    array = two_blocks(name)
    h = array.h
    rows = table(array, kind)
    assert rows["address"].tolist() == in_list_order(array, kind)
    for field in read_table().group(kind).fields:
        offset = (0, 0, 0) if field.name == "HEAD" else getattr(g, field.name)
        read = getr if field.real else iget
        assert rows[field.name].tolist() == [read(h, iad, offset) for iad in rows["address"].tolist()]


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("kind", KINDS)
def test_fields_and_types_are_those_of_the_table(name: str, kind: str) -> None:
    array = two_blocks(name)
    fields = read_table().group(kind).fields
    dtype = table(array, kind).dtype
    assert dtype.names == ("address", *(field.name for field in fields))
    assert dtype["address"] == np.int64
    for field in fields:
        assert dtype[field.name].base == (array.scheme.real_type if field.real else np.int64)
        assert dtype[field.name].shape == ((field.count,) if field.count > 1 else ())


def test_values_of_the_two_squares() -> None:
    blocks = table(two_blocks(), "block")
    assert blocks["KY"].tolist() == [0.5, 1.5]
    assert blocks["KBFIX"].tolist() == [1, 0]
    upper = table(two_blocks(), "corner")[4:]
    assert list(zip(upper["KXP"].tolist(), upper["KYP"].tolist(), strict=True)) == [
        (0.0, 1.0),
        (0.0, 2.0),
        (1.0, 2.0),
        (1.0, 1.0),
    ]


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("kind", KINDS)
def test_an_empty_array_has_empty_tables(name: str, kind: str) -> None:
    assert len(table(MainArray(scheme(name)), kind)) == 0


@pytest.mark.parametrize("name", SCHEMES)
def test_extensions_are_found_through_their_owners(name: str) -> None:
    array = two_blocks(name)
    h = array.h
    _, upper = groups(h, "block")
    inner, outer = groups(h, "domain")
    soft, first, second = find(h, g.NVSD), find(h, g.NVDE), find(h, g.NVDE)
    puti(h, upper, (0, 0, 0), g.MSDEF)
    puti(h, upper, g.KBEX, soft)
    puti(h, inner, g.KDEX, second)
    puti(h, outer, g.KDEX, first)
    putr(h, soft, g.KS122, -5.0)
    putr(h, first, g.KJL, 0.5)
    assert table(array, "sdef")[["address", "KS122"]].tolist() == [(soft, -5.0)]
    assert table(array, "jointext")[["address", "KJL"]].tolist() == [(second, 0.0), (first, 0.5)]


def test_a_table_is_a_copy() -> None:
    array = two_blocks()
    rows = table(array, "block")
    before = array.h.ia.tobytes()
    rows["KX"] = 1e9
    assert array.h.ia.tobytes() == before


def test_unknown_kind_lists_the_kinds() -> None:
    with pytest.raises(
        ValueError, match="'rock': choose one of block, corner, contact, domain, sdef, fdef, zone, "
    ):
        table(two_blocks(), "rock")


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize(("kind", "field"), [("block", "KB"), ("corner", "KR"), ("block", "KP")])
@pytest.mark.parametrize("value", [-1, 2, 32767])
def test_pointers_that_lead_astray(name: str, kind: str, field: str, value: int) -> None:
    array = two_blocks(name)
    group = in_list_order(array, kind)[0]
    puti(array.h, group, getattr(g, field), value)
    with pytest.raises(Unsound):
        table(array, "corner")


def test_lists_that_run_in_circles() -> None:
    array = two_blocks()
    first, second, third, _ = corners(array.h, next(groups(array.h, "block")))
    puti(array.h, second, g.KR, third)  # third -> second -> third, never back to the first
    puti(array.h, first, g.KR, third)
    with pytest.raises(
        Unsound, match=r"reverse list of block@1 breaks: KR of corner@\d+ leads back to corner@73"
    ):
        table(array, "corner")
    block = next(groups(array.h, "block"))
    puti(array.h, block, g.KB, block)
    with pytest.raises(Unsound, match="leads back to block@1: the block list is a circle"):
        table(array, "block")


def test_lists_of_blocks_that_run_in_circles_or_meet() -> None:
    m = every_kind()
    blocks, points = m.table("fdef"), m.table("gridpoint")["address"].tolist()
    first, second = blocks["KFG"][:2].tolist()
    owner = blocks["address"][1]
    last_of_first = points[points.index(second) - 1]
    for to, source in ((first, f"KG of gridpoint@{last_of_first}"), (second, f"KFG of fdef@{owner}")):
        puti(m.array.h, last_of_first, g.KG, to)
        with pytest.raises(
            Unsound, match=f"{source} leads back to gridpoint@{to}: two lists of the kind meet"
        ):
            table(m.array, "gridpoint")


@pytest.mark.parametrize("name", ["i32r32", "i32r64", "i64r64"])
def test_many_blocks_with_different_numbers_of_corners(name: str) -> None:
    """Corners come block by block and clockwise, however the rings differ in length."""
    count = 300
    array = MainArray(scheme(name), 40 * 12 * count)
    h = array.h
    sizes = [3 + i % 7 for i in range(count)]
    blocks = [find(h, g.NVBL) for _ in range(count)]
    expected = []
    for block, following, size in zip(blocks, [*blocks[1:], 0], sizes, strict=True):
        ring = [find(h, g.NVCR) for _ in range(size)]
        expected += ring
        for corner, clockwise in zip(ring, [*ring[1:], ring[0]], strict=True):
            puti(h, corner, (0, 0, 0), g.MCOR)
            puti(h, corner, g.KL, clockwise)
            puti(h, clockwise, g.KR, corner)
        for offset, value in (((0, 0, 0), g.MRIG), (g.KB, following), (g.KP, ring[0])):
            puti(h, block, offset, value)
    h.ci[g.IBPNT] = blocks[0]
    assert table(array, "block")["address"].tolist() == blocks
    assert table(array, "corner")["address"].tolist() == expected
