"""Edges of blocks that deform may shorten until their two roundings overlap by FTOL, and no further."""

from __future__ import annotations

import math

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import putr
from udec_ia.kernels.body.sdef import put_stress
from udec_ia.layout import offsets as g

D = 0.02
KN = 1e9
STIFF = 1e8  # BULK and G
DENSITY = 2000.0


def strip(stress: float) -> Model:
    """A free simply-deformable block whose short edges just hold two roundings; `stress` pulls it thinner."""
    model = Model()
    model.round(D)
    model.block(0, 0, 0, 2 * D, 1, 2 * D, 1, 0)
    model.property(1, density=DENSITY, kn=KN, ks=KN, bulk=STIFF, g=STIFF)
    model.change(-1, 2, -1, 1, "sdef")
    model.cycle(0)
    put_stress(model.h, int(model.table("block")["KBEX"][0]), 0.0, 0.0, stress)
    return model


def height(model: Model) -> float:
    return float(np.ptp(model.table("corner")["KYP"]))


def test_roundings_may_overlap_by_less_than_ftol_however_the_cycles_are_divided() -> None:
    """A stress of 0.3 % of the stiffness takes less than 2.5 % off the edges, which is FTOL / 2 D.

    The time-step is found anew for the second run: it is proportional to the square root of a length that has
    shrunk by 0.2 %, and what the edges lose grows with its square.
    """
    one, two = strip(3e5), strip(3e5)
    one.cycle(20)
    two.cycle(10)
    two.cycle(10)
    assert 0.975 < height(one) / (2 * D) < 1 - 1e-3
    assert height(two) == pytest.approx(height(one), abs=2e-3 * (2 * D - height(one)))
    assert one.check() == two.check() == []


def test_an_edge_that_shortens_further_ends_the_run() -> None:
    """Error 14 in the cycle in which it does, again for the next run, until ROUND is smaller."""
    model = strip(3e6)
    with pytest.raises(UdecError, match=r"holds roundings of .* strained as it is after cycle") as caught:
        model.cycle(1000)
    assert caught.value.number == 14
    cycles = int(model.h.ci[g.MCTOT])
    assert 0 < cycles < 1000
    assert height(model) < 0.975 * 2 * D
    assert [violation.invariant for violation in model.check()] == [7, 7]
    with pytest.raises(UdecError, match="error 14: "):
        model.cycle(1)
    assert int(model.h.ci[g.MCTOT]) == cycles
    model.round(D / 4)
    model.cycle(20)
    assert model.check() == []


def test_an_edge_that_still_holds_its_roundings_before_the_run_does_not_stop_it() -> None:
    """One cycle before the error there is nothing to complain about."""
    model = strip(3e6)
    with pytest.raises(UdecError, match="error 14: "):
        model.cycle(1000)
    other = strip(3e6)
    other.cycle(int(model.h.ci[g.MCTOT]) - 1)
    assert height(other) > 0.975 * 2 * D
    assert other.check() == []


def meshed(stress: float) -> Model:
    """As strip, but fully-deformable, with grid-points in the middle of the short edges."""
    model = Model()
    model.round(D)
    model.block(0, 0, 0, 2 * D, 1, 2 * D, 1, 0)
    model.property(1, density=DENSITY, kn=KN, ks=KN, bulk=STIFF, g=STIFF)
    points = [(0.0, 0.0), (0.0, D), (0.0, 2 * D), (1.0, 2 * D), (1.0, D), (1.0, 0.0)]
    zones = [(1, 2, 5), (1, 5, 6), (2, 3, 4), (2, 4, 5)]
    model.generate(-1, 2, -1, 1, "manual", gridpoints=points, zones=zones)
    model.cycle(0)
    for iz in model.table("zone")["address"]:
        putr(model.h, int(iz), g.KZS22, stress)
    return model


def test_the_part_of_an_edge_beside_a_grid_point_may_shorten_as_much() -> None:
    """It holds one rounding, and may lose half of FTOL."""
    model = meshed(3e5)
    model.cycle(20)
    assert 0.975 < height(model) / (2 * D) < 1 - 1e-3
    model.cycle(0)
    assert model.check() == []
    model = meshed(3e6)
    with pytest.raises(UdecError, match=r"holds roundings of .* strained as it is after cycle") as caught:
        model.cycle(1000)
    assert caught.value.number == 14
    assert height(model) < 0.98 * 2 * D
    assert {violation.invariant for violation in model.check()} == {7}


def column(stress: float) -> tuple[Model, int]:
    """A heavy block on a thin column on a base; `stress` narrows the column. Address of the heavy one."""
    model = Model()
    model.round(D)
    model.block(-0.06, 0, -0.06, 3, 0.1, 3, 0.1, 0)
    model.property(1, density=DENSITY, kn=KN, ks=KN, bulk=STIFF, g=STIFF)
    model.property(2, density=1e5 * DENSITY, kn=KN, ks=KN)
    for line in ((-1, 1, 1, 1), (-1, 2, 1, 2), (0, 1, 0, 2), (2 * D, 1, 2 * D, 2)):
        model.split(*line)
    model.delete(-0.06, 0, 1, 2)
    model.delete(2 * D, 0.1, 1, 2)
    model.change(0, 2 * D, 1, 2, "sdef")
    model.change(-1, 1, 2, 3, material=2)
    model.fix(-1, 1, 0, 1)
    model.damping(0.3, 100.0, "internal")
    model.cycle(0)
    blocks = model.table("block")
    put_stress(model.h, int(blocks["KBEX"].max()), stress, 0.0, 0.0)
    model.cycle(300)
    return model, int(blocks["address"][blocks["KY"] > 2][0])


def width(model: Model) -> float:
    """Width of the column's top."""
    corners = model.table("corner")
    middle = (corners["KXP"] > -D / 2) & (corners["KXP"] < 2.5 * D) & (abs(corners["KYP"] - 2) < D)
    xs = corners["KXP"][middle & (corners["KYDP"] != 0)]
    return float(np.ptp(xs))


@pytest.mark.parametrize(("stress", "direction"), [(8e5, 1), (1.6e6, -1)])
def test_a_corner_slides_over_such_an_edge_without_a_break_in_force(stress: float, direction: int) -> None:
    """The heavy block is pushed on the column, and sideways until its corner has passed the column's top.

    Its corner then falls around the arc, both arcs of radius D: u = u0 - s^2 / 4 D, at most
    sqrt(u0 / D) v dt in a step. Where the contact passes from one rounding to the other its foot may be off
    either by what they overlap, which changes u by (2 D - z)^2 / 4 D.
    """
    model, heavy = column(stress)
    speed = 10.0
    putr(model.h, heavy, g.KXD, direction * speed)
    putr(model.h, heavy, g.KYD, -1e-3)
    dt = float(model.h.cr[g.TDEL])
    force, codes, overlap = [], set(), 2 * D - width(model)
    assert 0 < overlap < D / 20
    for _ in range(int(0.12 / speed / dt)):
        model.cycle(1)
        rows = model.table("contact")
        rows = rows[((rows["KB1"] == heavy) | (rows["KB2"] == heavy)) & (rows["KCCOD"] != g.VIRTUAL)]
        assert len(rows) <= 1
        force.append(float(rows["KCFN"].sum()))
        codes.update(rows["KCCOD"].tolist())
        if len(force) % 20 == 0:
            assert model.check() == []
    assert force[-1] == 0
    assert len(codes) > 1
    most = max(force)
    assert most > 1e3
    bound = KN * (math.sqrt(most / KN / D) * speed * dt + overlap**2 / (4 * D))
    assert np.abs(np.diff(force)).max() < 1.1 * bound
