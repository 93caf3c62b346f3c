"""The checker finds a piece that hangs in another domain than the one in which it lies."""

from __future__ import annotations

import pytest

from udec_ia.checker import check
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.kernels.links.linked_lists import idomp
from udec_ia.kernels.map.virtual_contacts import hook, take_contact_out
from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.reader.list_walks import corners, groups

# A box with a closed room; of what was in it one block is left, which hangs in the room.
WALLS = """SPLIT -1 1 5 1
SPLIT -1 4 5 4
SPLIT 1 1 1 4
SPLIT 4 1 4 4
"""
ROOM = f"""START
BLOCK 0 0 0 5 5 5 5 0
{WALLS}SPLIT 1 2 4 2
SPLIT 1 3 4 3
SPLIT 2 2 2 3
SPLIT 3 2 3 3
DELETE 1 4 1 2
DELETE 1 4 3 4
DELETE 1 2 2 3
DELETE 3 4 2 3
"""


def room(build: str) -> tuple[Model, int]:
    """The model, and the block in the room."""
    model = Model(build)
    model.run(ROOM)
    inside = [
        block
        for block in groups(model.h, "block")
        if abs(getr(model.h, block, g.KX) - 2.5) < 0.1 and abs(getr(model.h, block, g.KY) - 2.5) < 0.1
    ]
    return model, inside[0]


def move(model: Model, block: int, dx: float, dy: float) -> None:
    """Put a block, and nothing else, somewhere else."""
    h = model.h
    for group, fields in [(block, (g.KX, g.KY)), *((c, (g.KXP, g.KYP)) for c in corners(h, block))]:
        for field, step in zip(fields, (dx, dy), strict=True):
            putr(h, group, field, getr(h, group, field) + step)
    for corner in corners(h, block):
        for field, step in ((g.KXCP, dx), (g.KYCP, dy)):
            putr(h, corner, field, getr(h, corner, field) + step)


@pytest.mark.parametrize("build", ["i32r64", "i16r32"])
def test_a_block_in_a_room_hangs_in_the_room(build: str) -> None:
    model, block = room(build)
    assert model.h.ci[g.NVIRT] == 1
    assert check(model.array) == []
    move(model, block, -0.5, 0.5)  # still in the room
    assert check(model.array) == []


@pytest.mark.parametrize("build", ["i32r64", "i16r32"])
@pytest.mark.parametrize("step", [(10.0, 0.0), (0.0, -20.0), (-7.0, 7.0)])
def test_a_block_that_left_its_domain_is_named(build: str, step: tuple[float, float]) -> None:
    model, block = room(build)
    move(model, block, *step)
    found = check(model.array)
    assert {violation.invariant for violation in found} == {4}
    assert any(f"block@{block} hangs in domain@" in str(violation) for violation in found)


def test_a_block_tied_to_the_wrong_side_of_a_wall_is_named() -> None:
    """The same block, tied to the outside of the wall: all lists are sound, but it lies in the room."""
    model, block = room("i32r64")
    h = model.h
    (tie,) = [c for c in groups(h, "contact") if iget(h, c, g.KCCOD) == g.VIRTUAL]
    room_domain, outside = iget(h, tie, g.KD1), h.ci[g.IODPNT]
    take_contact_out(h, tie)
    sides = {c: (iget(h, c, g.KD1), iget(h, c, g.KD2)) for c in groups(h, "contact") if c != tie}
    puti(h, room_domain, g.KDLOOP, next(c for c in sides if room_domain in sides[c]))
    wall, item = next(
        (other, corner)
        for other in groups(h, "block")
        for corner in corners(h, other)
        if other != block and idomp(h, other, corner) == outside
    )
    hook(h, tie, wall, item, block, iget(h, block, g.KP), outside)
    (violation, *_) = found = check(model.array)
    assert {violation.invariant for violation in found} == {4}
    assert f"block@{block} hangs in domain@{outside}" in str(violation)


def test_a_block_outside_that_is_put_into_a_room_is_named() -> None:
    """A block hangs in the outer domain, beside a box with an empty room."""
    model = Model()
    model.run("START\nBLOCK 0 0 0 5 8 5 8 0\nSPLIT 5 -1 5 6\nSPLIT 7 -1 7 6\nSPLIT 7 1 8 1\n" + WALLS)
    model.delete(1, 4, 1, 4)
    model.delete(5, 7, 0, 5)
    model.delete(7, 8, 1, 5)
    assert model.h.ci[g.NVIRT] == 1
    assert check(model.array) == []
    outside = max(groups(model.h, "block"), key=lambda block: getr(model.h, block, g.KX))
    move(model, outside, -5.0, 2.0)
    assert {violation.invariant for violation in check(model.array)} == {4}


TRIANGLE = "BLOCK 0 0 0 4 4 4 4 0\nSPLIT -1 1 5 1\nSPLIT -1 2 5 2\n"


@pytest.mark.parametrize("part", [0.3, 0.45, 0.4999])
@pytest.mark.parametrize("cut", [(3.6, 4.1, 4.1, 3.6), (3.3, 4.2, 4.05, 3.7)])
def test_a_small_block_that_is_nearly_all_rounding_is_no_wall(
    part: float, cut: tuple[float, float, float, float]
) -> None:
    """A triangle that has parted from the rest, its rounding a part of its shortest edge."""
    model = Model()
    model.run(f"START\n{TRIANGLE}SPLIT {' '.join(map(str, cut))}\n")
    model.delete(1, 3, 2, 4)
    triangle = min(groups(model.h, "block"), key=lambda block: len(corners(model.h, block)))
    assert len(corners(model.h, triangle)) == 3
    places = [complex(getr(model.h, c, g.KXP), getr(model.h, c, g.KYP)) for c in corners(model.h, triangle)]
    shortest = min(abs(one - two) for one, two in zip(places, places[1:] + places[:1], strict=True))
    model.round(part * shortest)
    assert model.h.ci[g.NVIRT] == 1
    assert check(model.array) == []
    move(model, triangle, -1.6, -2.35)  # into the slab below, where it cannot hang
    assert any(f"block@{triangle} " in str(violation) for violation in check(model.array))
