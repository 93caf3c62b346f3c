"""Cuts of blocks with zones: stress, momentum, conditions and histories, by areas of shapely and sums."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
from support.random_cuts import polygons

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

ALL = (-100.0, 100.0, -100.0, 100.0)
SCHEMES = ("i16r64", "i32r32", "i32r64", "i64r64")


def wall(build: str = "i32r64", mixed: bool = False, edge: float = 0.5) -> Model:
    """A block with zones, 4 m wide and 2 m high, on a fixed one."""
    m = Model(build)
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=2e9, ks=2e9, friction=0.5, bulk=5e9, g=3e9)
    m.block(0, -1, 0, 2, 4, 2, 4, -1)
    m.split(-1, 0, 5, 0)
    m.round(0.02)
    m.fix(0, 4, -1, 0)
    m.change(0, 4, 0, 2, type="fdef")
    m.generate(0, 4, 0, 2, "automatic", edge=edge, mixed=mixed)
    return m


def stir(m: Model) -> None:
    """One cycle; then velocities of all kinds, and a stress that is different in each zone."""
    m.cycle(1)
    for row in m.table("gridpoint"):
        at, x, y = f"gridpoint@{row['address']}", float(row["KXG"]), float(row["KYG"])
        m.patch(f"{at}.KXDG = {0.1 - 0.2 * y!r}, {at}.KYDG = {0.2 * x + 0.03 * x * x!r}")
    for k, row in enumerate(m.table("zone")):
        at = f"zone@{row['address']}"
        m.patch(f"{at}.KZS11 = {1e4 * (k % 7)!r}, {at}.KZS12 = {-2e3 * (k % 3)!r}")


def momentum(m: Model) -> Any:
    """Mass, linear and angular momentum of all grid-points."""
    points = m.table("gridpoint")
    mass, x, y, u, v = (points[name].astype(float) for name in ("KGPM", "KXG", "KYG", "KXDG", "KYDG"))
    return np.array([(mass * one).sum() for one in (np.ones(len(mass)), u, v, x * v - y * u)])


def triangles(m: Model) -> Any:
    """Zones as polygons."""
    points = m.table("gridpoint")
    place = dict(zip(points["address"].tolist(), zip(points["KXG"], points["KYG"], strict=True), strict=True))
    return shapely.polygons([[place[ig] for ig in row] for row in m.table("zone")["KZG"].tolist()])


def force(m: Model) -> Any:
    """Stress times area, summed over all zones."""
    rows, areas = m.table("zone"), shapely.area(triangles(m))
    return np.array([(rows[name] * areas).sum() for name in ("KZS11", "KZS12", "KZS22")])


@pytest.mark.parametrize("mixed", [False, True])
@pytest.mark.parametrize("build", SCHEMES)
def test_momentum_and_stress_stay(build: str, mixed: bool) -> None:
    m = wall(build, mixed)
    stir(m)
    before, stress, many = momentum(m), force(m), len(m.table("zone"))
    assert m.split(0.7, -3, 3.1, 4) == 2  # the block below is cut as well
    digits = 1e-5 if build.endswith("32") else 1e-11
    np.testing.assert_allclose(momentum(m), before, rtol=digits, atol=digits * np.abs(before).max())
    np.testing.assert_allclose(force(m), stress, rtol=digits, atol=digits * np.abs(stress).max())
    line = shapely.LineString([(0.7, -3), (3.1, 4)])
    assert (shapely.length(shapely.intersection(triangles(m), line)) < 1e-4).sum() >= len(
        m.table("zone")
    ) - 12
    assert not shapely.crosses(shapely.buffer(triangles(m), -1e-4), line).any()
    assert abs(len(m.table("zone")) - many) < 0.4 * many
    assert m.check() == []
    m.cycle(20)
    assert m.check() == []


def test_a_uniform_stress_stays_uniform() -> None:
    m = wall()
    m.insitu(*ALL, -1e6, 2e5, -3e6)
    m.polyline(0, 1.1, 1.4, 0.9, 2.2, 1.5, 4, 1.2)
    m.arc(2, 0, 3, 0, 180, 6)
    rows = m.table("zone")
    for name, value in (("KZS11", -1e6), ("KZS12", 2e5), ("KZS22", -3e6)):
        np.testing.assert_allclose(rows[name], value, rtol=1e-12)
    assert m.check() == []


def test_a_tunnel_in_a_zoned_block() -> None:
    """The outline closes inside, so the rock around it becomes two blocks."""
    m = wall(edge=0.3)
    m.tunnel(2, 1, 0.5, 12)
    found = polygons(m)
    assert sum(one.area for one in found) == pytest.approx(12.0, rel=1e-12)
    assert len(found) == 4
    assert shapely.area(triangles(m)).sum() == pytest.approx(8.0, rel=1e-12)
    assert m.check() == []
    m.delete("CIRCLE 2 1 0.3")
    m.cycle(50)
    assert m.check() == []


def test_a_wall_that_is_cut_by_glue_deflects_as_before() -> None:
    """A loaded wall comes to the same rest with a glued cut through its zones."""
    whole, cut = wall(edge=0.4), wall(edge=0.4)
    for m in (whole, cut):
        m.gravity(0, -10)
        m.boundary(0, 4, 1.99, 2.01, stress=(0.0, 0.0, -1e6))
        m.solve(1e-5, static=True)
    cut.polyline(1.3, 0, 2.4, 2, glued=True)
    cut.solve(1e-5, static=True)
    top = [
        (-rows["KYG"][np.abs(rows["KYG"] - 2) < 0.01] + 2).mean()
        for rows in (m.table("gridpoint") for m in (whole, cut))
    ]
    assert top[1] == pytest.approx(top[0], rel=0.03)
    np.testing.assert_allclose(force(cut), force(whole), rtol=0.02, atol=0.02 * np.abs(force(whole)).max())


def test_conditions_and_histories_pass_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # for the files of histories
    m = wall()
    m.boundary(-1, 5, 1.99, 2.01, yvel=0.0)
    inner = next(row for row in m.table("gridpoint") if row["KCOR"] == 0)
    x, y = float(inner["KXG"]), float(inner["KYG"])
    m.boundary(x - 1e-3, x + 1e-3, y - 1e-3, y + 1e-3, xforce=500.0)
    m.history(1, "KXDG", at=[(x, y)])
    m.history(1, "KZS11", at=[(1.0, 1.0)])
    m.cycle(3)
    m.split(1.9, -2, 2.1, 3)
    top = [row for row in m.table("gridpoint") if abs(row["KYG"] - 2) < 1e-6]
    assert {int(row["KGFIX"]) for row in top} == {int(g.ALONG_Y)}
    loads = m.table("bound")
    assert loads["KUFX"].sum() == pytest.approx(500.0)
    moved = loads[loads["KUFX"] != 0]["KUG"][0]
    place = next(row for row in m.table("gridpoint") if row["address"] == moved)
    assert np.hypot(place["KXG"] - x, place["KYG"] - y) < 0.5
    assert (m.table("history")["KHG"] != 0).all()
    m.cycle(3)
    assert m.check() == []


def test_grid_points_near_the_ends_are_removed() -> None:
    """A line 2 cm beside a grid-point on the edge would leave an edge of 2 cm."""
    m = wall()
    top = np.sort([row["KXG"] for row in m.table("gridpoint") if row["KYG"] == 2])
    at = float(top[3])
    m.split(at + 0.02, -2, at + 0.02, 3)
    after = np.array([row["KXG"] for row in m.table("gridpoint") if row["KYG"] == 2])
    assert at not in after
    assert (np.abs(after - (at + 0.02)) < 1e-9).sum() == 2
    assert m.check() == []


def test_what_is_refused_changes_nothing() -> None:
    m = wall()
    m.cycle(5)
    before = m.h.ia.copy()
    for line in ((0.01, -3, 0.01, 4), (-1, 1.99, 5, 1.99)):  # too near to an edge
        with pytest.raises(UdecError) as caught:
            m.split(*line)
        assert caught.value.number in (14, 27)
        assert np.array_equal(m.h.ia[: len(before)], before)
    assert m.split(1, 0.5, 3, 1.5) == 0  # it ends inside
    m.cycle(5)
    assert m.check() == []


def test_parallel_joints_cut_all_zones() -> None:
    m = wall(edge=0.4)
    m.jset(70, spacing=0.9)
    m.jset(10, spacing=0.7)
    assert shapely.area(triangles(m)).sum() == pytest.approx(8.0, rel=1e-12)
    assert m.h.ci[g.NBLK] > 20
    assert m.check() == []
    m.gravity(0, -10)
    m.damping(0.5, 10, "mass")
    m.cycle(200)
    assert m.check() == []


def test_no_force_is_left_behind() -> None:
    """Before the first cycle, without stress: grid-points have no forces, and what floats stays at rest."""
    m = wall()
    m.gravity(0, 0)
    m.split(0.7, -3, 3.1, 4)
    assert np.abs([m.table("gridpoint")[name] for name in ("KGFX", "KGFY")]).max() == 0
    m.cycle(1)
    assert np.abs(m.table("gridpoint")["KXDG"]).max() == 0


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_a_cut_after_insitu_and_before_the_first_cycle_keeps_the_rest(kind: str) -> None:
    """Blocks in a frame under a stress that joints carry; the cut is at right angles to the stress."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=5e9, g=3e9)
    m.jproperty(1, kn=1e10, ks=1e10, friction=1.0, between=(1, 1))
    m.block(0, 0, 0, 6, 4, 6, 4, 0)
    for y in (1, 3, 5):
        m.split(-1, y, 5, y)
    m.round(0.02)
    m.fix(0, 4, 0, 1)
    m.fix(0, 4, 5, 6)
    m.change(0, 4, 1, 5, type=kind)
    if kind == "fdef":
        m.generate(0, 4, 1, 5, "automatic", edge=0.7)
    m.insitu(0, 4, 0, 6, 0.0, 0.0, -1e6)
    m.split(1.7, 1, 1.7, 5)
    m.cycle(1)
    free = m.table("block")
    free = free[free["KBFIX"] == 0]
    assert len(free) == 4
    fall = 1e6 * 4 / (4 * 2 * 2000) * float(m.h.cr[g.TDEL])  # velocity after a step, under one side alone
    assert np.abs(free["KYD"]).max() < 0.05 * fall


def test_a_dead_end_leaves_no_corner() -> None:
    """The first piece of the line begins inside and leaves the block near a corner: it is dropped."""
    m = wall()
    before = {(row["KXP"], row["KYP"]) for row in m.table("corner")}
    m.polyline(2, 1, -1, 1.95, -2, 0.8, 5, 0.9)
    new = {(row["KXP"], row["KYP"]) for row in m.table("corner")} - before
    line = shapely.LineString([(-2, 0.8), (5, 0.9)])
    assert new
    assert all(line.distance(shapely.Point(*one)) < 1e-9 for one in new)
    assert m.check() == []


def test_angular_momentum_stays_before_the_first_cycle() -> None:
    m = wall()
    m.velocity(0, 4, 0, 2, 1.0, 0.5, 0.3)
    before = momentum(m)
    m.split(0.7, -3, 3.1, 4)
    np.testing.assert_allclose(momentum(m), before, rtol=1e-11)


@pytest.mark.parametrize("seed", range(1, 5))
def test_contacts_at_one_place_do_not_lack_stiffness(seed: int) -> None:
    """Cuts that meet in a point, in a run, with a joint material: one of two contacts there has no length."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=2e9, ks=2e9, friction=0.5, bulk=5e9, g=3e9)
    m.jproperty(1, kn=2e10, ks=1e10, friction=0.5, cohesion=2e5, tension=1e5, between=(1, 1))
    m.block(0, 0, 0, 10, 15, 10, 15, 0)
    m.split(-1, 4.1, 16, 5.2)
    m.generate("ALL", edge=1.3)
    m.boundary(-0.1, 15.1, -0.1, 0.1, yvel=0.0, xvel=0.0)
    m.gravity(0, -10)
    m.fraction(0.5, safe=True)
    m.cycle(1)
    m.voronoi(1.3, seed=seed, within=(3, 12, 2, 8))
    m.cycle(1)
    assert m.check() == []
