"""VELOCITY throws blocks, and DELETE OUTSIDE removes those that leave the scene."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import getr, iget
from udec_ia.layout import offsets as g

SCENE = """
START
ROUND 0.05
BLOCK 0,0 0,1 20,1 20,0
BLOCK 2,5 2,6 3,6 3,5
BLOCK 5,5 5,6 6,6 6,5
BLOCK 8,5 8,6 9,6 9,5
PROP MAT=1 DENS=2000 KN=1E9 KS=1E9 FRIC=.5 BULK=1E9 G=6E8
FIX 0 20 0 1
GRAVITY 0 -10
"""


def scene(*lines: str) -> Model:
    model = Model()
    model.run("\n".join([SCENE, *lines]))
    return model


def block_at(model: Model, x: float, y: float) -> int:
    rows = model.table("block")
    return int(rows["address"][np.argmin(np.hypot(rows["KX"] - x, rows["KY"] - y))])


@pytest.mark.parametrize("kind", ["rigid", "sdef", "zoned"])
def test_a_thrown_block_moves_as_a_rigid_body(kind: str) -> None:
    """Free flight: the centroid follows v t + g t2/2 of the central differences, and the spin stays."""
    model = scene()
    if kind == "sdef":
        model.change(2, 3, 5, 6, type="sdef")
    elif kind == "zoned":
        model.generate(2, 3, 5, 6, "automatic", edge=2.0)
    assert model.velocity(2, 3, 5, 6, 4.0, 3.0, -0.5) == 1
    ib = block_at(model, 2.5, 5.5)
    model.cycle(200)
    h, t, dt = model.h, float(model.h.cd[g.TIME]), float(model.h.cr[g.TDEL])
    assert float(getr(h, ib, g.KX)) == pytest.approx(2.5 + 4 * t, abs=1e-9)
    assert float(getr(h, ib, g.KY)) == pytest.approx(5.5 + 3 * t - 5 * t * (t + dt), abs=1e-9)
    tolerance = 1e-12 if kind == "rigid" else 2e-3  # deformable bodies widen as they spin
    assert float(getr(h, ib, g.KTD)) == pytest.approx(-0.5, rel=tolerance)


def test_corners_and_grid_points_have_the_velocity_of_their_place() -> None:
    model = scene()
    model.generate(2, 3, 5, 6, "automatic", edge=0.4)
    model.velocity(1, 4, 4, 7, 1.0, 2.0, 3.0)
    rows = model.table("gridpoint")
    assert rows["KXDG"] == pytest.approx(1.0 - 3.0 * (rows["KYG"] - 5.5))
    assert rows["KYDG"] == pytest.approx(2.0 + 3.0 * (rows["KXG"] - 2.5))


def test_fixed_blocks_are_not_thrown() -> None:
    model = scene()
    assert model.velocity("ALL", vx=1.0) == 3
    assert float(getr(model.h, block_at(model, 10, 0.5), g.KXD)) == 0


def test_a_deck_throws_blocks_in_ranges_of_both_forms() -> None:
    model = scene("VELOCITY 2 3 5 6 8 3 -2", "VELOCITY CIRCLE 8.5 5.5 1 -8 3")
    one, two = block_at(model, 2.5, 5.5), block_at(model, 8.5, 5.5)
    assert [float(getr(model.h, one, k)) for k in (g.KXD, g.KYD, g.KTD)] == [8, 3, -2]
    assert [float(getr(model.h, two, k)) for k in (g.KXD, g.KYD, g.KTD)] == [-8, 3, 0]


def test_blocks_that_leave_are_deleted_while_cycling() -> None:
    model = scene("DELETE OUTSIDE -2 12 -5 30", "VELOCITY 2 3 5 6 -60 0")
    assert model.h.ci[g.NBLK] == 4
    while model.h.ci[g.NBLK] == 4:
        model.cycle(50)
        assert model.h.ci[g.MCTOT] < 2000
    assert model.h.ci[g.NLEFT] == 1
    assert model.check() == []
    assert float(model.h.cd[g.TIME]) == pytest.approx(4.5 / 60, rel=0.2)


def test_blocks_that_are_outside_are_deleted_at_once_but_for_fixed_ones() -> None:
    model = scene()
    assert model.delete("OUTSIDE 4 30 2 30") == 1
    assert model.h.ci[g.NBLK] == 3  # the fixed floor is outside, and stays


def test_a_deletion_keeps_the_energy_account_and_histories(tmp_path: Path) -> None:
    """What leaves takes its energy along; the rest of the account does not change."""
    found = []
    for limits in ("-100 100 -100 100", "-2 100 -5 30"):
        model = scene("ENERGY ON", "HIST XVEL 2.5 5.5", "HIST YVEL 8.5 5.5", f"DELETE OUTSIDE {limits}")
        model.out = tmp_path
        model.velocity(2, 3, 5, 6, -20.0, 0.0)
        model.cycle(2500)
        b = model.balance()
        missing = b.commands - b.kinetic - b.contacts - b.potential - b.friction
        found.append((b.friction, missing, int(model.h.ci[g.NBLK])))
    (friction, missing, blocks), (other, rest, left) = found
    assert (blocks, left) == (4, 3)
    assert rest == pytest.approx(missing, abs=1e-6 * abs(friction) + 1e-3)
    assert other <= friction + 1e-9


def test_a_run_in_parts_deletes_in_the_same_cycles() -> None:
    states = []
    for parts in ([700], [130, 170, 400]):
        model = scene("DELETE OUTSIDE -2 12 -5 30", "VELOCITY 2 3 5 6 -60 0")
        for n in parts:
            model.cycle(n)
        states.append(model.h.ia[: int(model.h.ci[g.MFREE])].copy())
    assert (states[0] == states[1]).all()


def test_two_blocks_stay_and_impossible_limits_are_refused() -> None:
    model = scene()
    for bad, number in (("OUTSIDE 5 4 0 1", 10), ("OUTSIDE 100 200 100 200", 19)):
        before = model.h.ia.copy()
        with pytest.raises(UdecError) as error:
            model.delete(bad) if number != 19 else (model.free(0, 20, 0, 1), model.delete(bad))
        assert error.value.number == number
        assert number == 19 or (model.h.ia == before).all()
    assert model.h.ci[g.NBLK] == 4
    assert iget(model.h, block_at(model, 10, 0.5), g.KBFIX) == 0
