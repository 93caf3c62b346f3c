"""Boundary conditions go with what they act on: through SPLIT, DELETE, CHANGE, GENERATE and RESTART."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.bodies import area_and_moments, by_address, outlines
from naive.relocate import differences, essence
from support.lone_block_loads import CP, EVERYWHERE, RHO, SKEW, D, G, K, lone, tractions
from support.mechanics_scenes import block, box, model, sound

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.studies.verification_tools import fan


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_conditions_on_a_block_that_is_cut(kind: str) -> None:
    """Both parts have the velocities; the resultant and the moment of the loads stay."""
    m = model(*box(0, 4, 0, 2), d=D, gravity=(0.0, 0.0), density=RHO)
    m.property(1, bulk=K, g=G)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    m.boundary(*EVERYWHERE, xforce=100.0, yforce=-50.0)
    m.boundary(*EVERYWHERE, stress=(-1e4, 2e3, -3e4), xgrad=(1e3, 0, 2e3))
    m.boundary(*EVERYWHERE, yvel=0.25)
    before = load_sums(m)
    m.split(-1, 0.7, 5, 1.1)
    m.split(1.5, -1, 2.5, 3)
    sound(m)
    np.testing.assert_allclose(load_sums(m), before, rtol=1e-10)
    assert set(m.table("block")["KBFIX"]) == {4}
    m.cycle(3)
    np.testing.assert_array_equal(m.table("block")["KYD"], 0.25)
    corners = by_address(m.table("corner"))
    for row in m.table("bound"):
        if row["KUP"]:
            assert corners[int(row["KUP"])]["KNB"] == row["KUB"]
    m.boundary(*EVERYWHERE, free=True)
    assert set(m.table("block")["KBFIX"]) == {0}
    assert len(m.table("bound")) == 0


def load_sums(m: Model, only: int = 0) -> Any:
    """Resultant and moment about the origin of all loads, or of those on the block at the address `only`."""
    corners, blocks = by_address(m.table("corner")), by_address(m.table("block"))
    total = np.zeros(3)
    for row in m.table("bound"):
        if only and row["KUB"] != only:
            continue
        fx, fy = float(row["KUFX"]), float(row["KUFY"])
        if row["KUP"]:
            x, y = (float(corners[int(row["KUP"])][k]) for k in ("KXP", "KYP"))
        else:
            ring = [(float(c["KXP"]), float(c["KYP"])) for c in outlines(m)[int(row["KUB"])]]
            _, x, y, _ = area_and_moments(ring)
            assert int(row["KUB"]) in blocks
        total += (fx, fy, x * fy - y * fx)
    return total


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_an_edge_that_is_cut_carries_its_traction_on(kind: str) -> None:
    """Each new edge has the resultant and the moment of the traction on it, however often it is cut."""
    m = model(*box(0, 10, 0, 3), d=D, gravity=(0.0, 0.0), density=RHO)
    m.property(1, bulk=K, g=G)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    stress, xgrad = (2e4, 1e4, -1e5), (0.0, 5e2, -3e4)
    m.boundary(-1, 11, 2.9, 3.1, stress=stress, xgrad=xgrad)
    m.boundary(-1, 11, 2.9, 3.1, viscous=True)
    m.split(-1, 1, 11, 1)  # touches no loaded edge
    m.split(2, 0.5, 2, 4)
    m.split(8, -1, 10, 3)  # through the corner where the load ends
    m.split(5, 4, 7, -1)
    sound(m)
    loaded = 0
    for ib, ring in outlines(m).items():
        points = [(float(c["KXP"]), float(c["KYP"])) for c in ring]
        force, moment = np.zeros(2), 0.0
        length = 0.0
        for (ax, ay), (bx, by) in pairwise([*points, points[0]]):
            if ay == by == 3:
                edge, turn = tractions([(ax, ay), (bx, by), (ax, ay)], stress, xgrad, (0, 0, 0), edges=1)
                force, moment, length = force + edge, moment + turn, length + abs(bx - ax)
        np.testing.assert_allclose(load_sums(m, ib), [*force, moment], atol=1e-7)
        normal = sum(float(row["KUCYY"]) for row in m.table("bound") if row["KUB"] == ib)
        assert normal == pytest.approx(RHO * CP * length, rel=1e-12)
        loaded += length > 0
    assert loaded == 3


def all_kinds() -> Model:
    """A rigid, a simply-deformable and two meshed blocks on a floor, with conditions of all sorts."""
    m = model(*box(0, 4, -1, 1), d=D, friction=0.5, density=RHO)
    m.property(1, bulk=K, g=G)
    m.split(-1, 0, 5, 0)
    for x in (2, 1, 3):
        m.split(x, -0.5, x, 2)
    m.fix(0, 4, -1, 0)
    m.change(1, 2, 0, 1, type="sdef")
    fan(m, 2.5, 0.5, edge_points=1)
    fan(m, 3.5, 0.5)
    m.function(2, 0, 0, 0.01, 1)
    m.boundary(-0.1, 4.1, 0.9, 1.1, stress=(0, 0, -2e4), xgrad=(0, 0, 5e3), function=2)
    m.boundary(-0.1, 1.6, 0.1, 0.9, xforce=500.0, sine=(40.0, 1.0))
    m.boundary(3.9, 4.1, -0.1, 1.1, viscous=True)
    m.boundary(3.4, 4.1, 0.9, 1.1, xvel=-0.01, sine=(20.0, 1.0))
    return m


def test_conditions_go_with_what_they_act_on() -> None:
    """DELETE, CHANGE and GENERATE take those of their block, and a sine that is no longer in use."""
    m = all_kinds()
    m.cycle(20)
    sound(m)
    assert len(m.table("signal")) == 3
    for gone, (x, signals) in (
        (lambda: m.change(2, 3, 0, 1, type="rigid"), (2.5, 3)),
        (lambda: m.delete(3, 4, 0, 1), (3.5, 2)),
        (lambda: m.change(1, 2, 0, 1, type="fdef"), (1.5, 2)),
        (lambda: m.change(0, 1, 0, 1, type="fdef"), (0.5, 1)),
    ):
        ib = int(block(m, x, 0.5)["address"])
        others = sorted(m.table("bound")["address"][m.table("bound")["KUB"] != ib].tolist())
        assert len(others) < len(m.table("bound"))
        gone()
        assert sorted(m.table("bound")["address"].tolist()) == others
        assert len(m.table("signal")) == signals
        assert m.check() == []
    assert len(m.table("bound")) == 0


def test_a_block_without_zones_takes_no_condition() -> None:
    """GENERATE would leave nothing of it for the condition to act on."""
    m = lone("rigid", SKEW)
    m.change(*EVERYWHERE, type="fdef")
    for asked in ({"stress": (-1.0, 0.0, 0.0)}, {"viscous": True}, {"xforce": 1.0}, {"xvel": 0.0}):
        with pytest.raises(UdecError) as refused:
            m.boundary(*EVERYWHERE, **asked)
        assert refused.value.number == 24
    assert len(m.table("bound")) == 0


@pytest.mark.parametrize("cycles", [0, 15])
def test_a_restart_keeps_all_conditions(cycles: int, tmp_path: Path) -> None:
    m = all_kinds()
    m.cycle(cycles)
    other = Model.restore(m.save(tmp_path / "bounds.h5"))
    for one in (m, other):
        one.cycle(30)
    assert differences(essence(m.array), essence(other.array)) == []
