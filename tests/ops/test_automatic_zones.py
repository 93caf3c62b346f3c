"""GENERATE ... AUTOMATIC in a model: exact edges, neighbours undisturbed, elasticity to rounding, restart."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.mechanics_scenes import block, model, sound

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import refit

K, G, D = 2e8, 1e8, 0.05
EPS = float(np.finfo(float).eps)
SQUARE = [(0.0, 0.0), (0.0, 2.0), (2.0, 2.0), (2.0, 0.0)]
COMB = [(0, 0), (0, 3), (1, 3), (1, 1.2), (1.5, 1), (2, 3), (3, 3), (3, 0)]


def stacked(build: str = "i32r64") -> Model:
    """A block of 4 by 2 m on two fixed ones of 2 by 2 m; settles under gravity with friction."""
    m = model((0, 0), (0, 4), (4, 4), (4, 0), d=D, build=build, stiffness=(1e9, 1e9), friction=0.5)
    m.property(1, bulk=K, g=G)
    m.split(-1, 2, 5, 2)
    m.split(2, -1, 2, 2)
    m.fix(0, 4, 0, 2)
    m.damping(0.5, 5, "mass")
    return m


def test_graded_zones_grow_with_the_distance_from_a_point() -> None:
    """Blocks of 2 m along a line: each as with an EDGE of its own, d plus growth times its distance."""
    graded, alone = Model(), Model()
    for m in (graded, alone):
        m.property(1, density=2500, bulk=5e9, g=3e9, kn=1e10, ks=1e10, friction=0.6)
        m.block(0, 0, 0, 2, 10, 2, 10, 0)
        for x in (2, 4, 6, 8):
            m.split(x, -1, x, 3)
    graded.generate("ALL", edge=0.3, graded=(0.1, 3, 1))
    for x, distance in ((1, 1), (3, 0), (5, 1), (7, 3), (9, 5)):
        alone.generate(x - 1, x + 1, 0, 2, edge=0.3 + 0.1 * distance)
    for kind in ("gridpoint", "zone"):
        one, other = graded.table(kind), alone.table(kind)
        assert len(one) == len(other)
    xs = graded.table("gridpoint")["KXG"]
    inside = [np.count_nonzero((xs > x) & (xs < x + 2)) for x in (0, 2, 4, 6, 8)]
    assert inside[1] > inside[0] == inside[2] > inside[3] > inside[4]
    with pytest.raises(UdecError) as caught:
        graded.generate("ALL", mode="manual", graded=(0.1, 3, 1))
    assert caught.value.number == 28  # all have zones already
    fresh = Model()
    fresh.block(0, 0, 0, 2, 10, 2, 10, 0)
    with pytest.raises(UdecError) as caught:
        fresh.generate("ALL", edge=0.3, graded=(-0.1, 3, 1))
    assert caught.value.number == 28


@pytest.mark.parametrize("spin", [1.0, 1e-18])
def test_the_angular_momentum_of_turning_blocks_is_reported_once(spin: float) -> None:
    """It grows with the moment of inertia; a turn that moves no point in a step is rest."""
    m = stacked()
    m.free(0, 4, 0, 2)
    m.cycle(10)
    blocks = m.table("block")["address"].tolist()
    for k, ib in enumerate(blocks, 1):
        putr(m.h, ib, g.KTD, k * spin)
    printed: list[Any] = []
    m.tell = printed.append
    m.generate("ALL", edge=1.0)
    found = [one for one in printed if one.key == "angular-momentum-changed"]
    assert len(found) == (1 if spin == 1.0 else 0)
    for one in found:
        inertia = float(m.table("block")["KBI"][m.table("block")["address"] == int(one.split()[0][6:])][0])
        (turn,) = (k * spin for k, ib in enumerate(blocks, 1) if one.startswith(f"block@{ib} "))
        assert f"{turn * inertia:.4g} N.s" in one
        assert "2 other blocks" in one


def outline_of(m: Model, ib: int) -> tuple[Any, Any]:
    """Corners and grid-points of block `ib`, rows with the same place in both."""
    corners = m.table("corner")
    corners = corners[corners["KNB"] == ib]
    points = m.table("gridpoint")
    (which,) = np.nonzero(np.isin(points["address"], corners["KGP"]))
    order = np.argsort(points["KCOR"][which])
    return corners[np.argsort(corners["address"])], points[which[order]]


def test_one_command_divides_all_blocks_of_a_range() -> None:
    """Each as by a command of its own; one that has zones keeps them."""
    models = []
    for ranges in ([(3, 6, 0, 9)], [(3, 6, 0, 9), (0, 9, 0, 9)], [(3, 6, 0, 9), (6, 9, 0, 9), (0, 3, 0, 9)]):
        m = Model()
        m.property(1, density=2500, bulk=5e9, g=3e9, kn=1e10, ks=1e10, friction=0.6)
        m.block(0, 0, 0, 9, 9, 9, 9, 0)
        m.split(3, -1, 3, 10)
        m.split(6, -1, 6, 10)
        for where in ranges:
            m.generate(*where, "automatic", edge=1.5)
        assert list(map(str, m.check())) == []
        models.append(m)
    one, two, three = models
    assert sorted(one.table("block")["HEAD"].tolist()) == [1, 1, 3]
    assert sorted(two.table("zone")["KZM"].tolist()) == sorted(three.table("zone")["KZM"].tolist())
    assert two.generate(0, 9, 0, 9, "automatic", edge=1.5) == 0


def test_blocks_that_carry_load_are_divided_at_once_as_one_by_one() -> None:
    """Zones start with the stress of their block, and force sums do not depend on the order of the blocks."""
    together, alone = stacked(), stacked()
    for m in (together, alone):
        m.cycle(400)
    together.generate("ALL", edge=0.7)
    for where in ((2, 4, 0, 2), (0, 4, 2, 4), (0, 2, 0, 2)):
        alone.generate(*where, edge=0.7)
    sound(together)
    for kind, words in (("block", "KX KY KBFX KBFY KBFT"), ("gridpoint", "KXG KYG KXDG KYDG KGFX KGFY")):
        one, other = (np.column_stack([m.table(kind)[w] for w in words.split()]) for m in (together, alone))
        one, other = (rows[np.lexsort(np.round(rows[:, :2], 6).T)] for rows in (one, other))
        assert np.allclose(one, other, rtol=0, atol=1e3 * EPS * np.abs(other).max())
    stresses = [
        np.sort(np.column_stack([m.table("zone")[w] for w in ("KZS11", "KZS12", "KZS22")]), axis=0)
        for m in (together, alone)
    ]
    assert np.abs(stresses[1]).max() > 1e3
    assert np.allclose(*stresses, rtol=0, atol=1e3 * EPS * np.abs(stresses[1]).max())


@pytest.mark.parametrize("outline", [SQUARE, COMB], ids=["square", "comb"])
@pytest.mark.parametrize("mixed", [False, True])
@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_grid_points_stand_on_the_edges(outline: list[Any], mixed: bool, build: str) -> None:
    """New corners are not rounded, have a grid-point each, and do not change the block's outline or mass."""
    m = model(*outline, d=D, build=build)
    ib = block(m, 1, 1)["address"]
    area = (
        sum((b[0] - a[0]) * (b[1] + a[1]) for a, b in zip(outline, outline[1:] + outline[:1], strict=True))
        / 2
    )
    printed: list[str] = []
    m.inform = printed.append
    assert m.generate(0, 3, 0, 3, "automatic", edge=0.45, mixed=mixed) == ib
    sound(m)
    corners, points = outline_of(m, ib)
    zones, all_points = m.table("zone"), m.table("gridpoint")
    assert (
        printed[:1]
        == [  # what follows is about the inertia of zones
            f"block@{ib} has {len(zones)} zones and {len(all_points)} grid-points, "
            f"the least angle is {printed[0].split()[-5]} degrees, at {' '.join(printed[0].split()[-2:])}"
        ]
    )
    eps = float(np.finfo(m.h.cr.dtype).eps)
    assert (points["KCOR"] == corners["address"]).all()
    for one, two in (("KXP", "KXG"), ("KYP", "KYG")):
        assert (corners[one] == points[two]).all()
    given = {(float(np.float32(x)), float(np.float32(y))) for x, y in outline}
    new = points["KGEDGE"] == 1
    assert np.count_nonzero(~new) == len(outline)
    assert {
        (float(np.float32(x)), float(np.float32(y)))
        for x, y in zip(*(corners[k][~new] for k in ("KXP", "KYP")), strict=True)
    } == given
    assert (corners["KRAD"][new] == 0).all()
    a, b = np.array(outline, float), np.roll(np.array(outline, float), -1, axis=0)
    at = np.stack([corners["KXP"], corners["KYP"]], axis=1)[new][:, None]
    along, length = b - a, np.linalg.norm(b - a, axis=1)
    off = np.abs((at - a)[..., 0] * along[:, 1] - (at - a)[..., 1] * along[:, 0]) / length
    part = ((at - a) * along).sum(axis=-1) / length**2
    off[(part < 0) | (part > 1)] = np.inf
    assert off.min(axis=1).max() <= 4 * 3 * eps  # a coordinate, of 3 at most, takes part in a few roundings
    mass = 1000.0 * area
    assert all_points["KGPM"].sum() == pytest.approx(mass, rel=100 * eps)
    assert zones["KZM"].sum() == pytest.approx(mass, rel=100 * eps)


@pytest.mark.parametrize("mixed", [False, True])
@pytest.mark.parametrize("outline", [SQUARE, COMB], ids=["square", "comb"])
def test_patch(outline: list[Any], mixed: bool) -> None:
    """A linear velocity field strains all zones by what elasticity says, to rounding."""
    m = model(*outline, d=D, gravity=(0, 0), density=2000)
    m.property(1, bulk=K, g=G)
    m.damping(0, 1)
    m.generate(0, 3, 0, 3, "automatic", edge=0.3, mixed=mixed)
    m.cycle(0)
    for row in m.table("gridpoint"):
        x, y, ig = float(row["KXG"]), float(row["KYG"]), int(row["address"])
        putr(m.array.h, ig, g.KXDG, 1e-4 * x + 3e-4 * y)
        putr(m.array.h, ig, g.KYDG, -2e-4 * x + 4e-4 * y)
        puti(m.array.h, ig, g.KGFIX, 3)
    m.cycle(1)
    dt = float(m.h.cr[g.TDEL])
    one, two = K + 4 * G / 3, K - 2 * G / 3
    wanted = (one * 1e-4 + two * 4e-4, 2 * G * 0.5e-4, one * 4e-4 + two * 1e-4)
    zones = m.table("zone")
    # Coordinates move by 1e-3 dt; the stress turns by the spin 2.5e-4 dt: of second order in dt, like e dt.
    slack = 100 * EPS + 1e-3 * dt
    for name, value in zip(("KZS11", "KZS12", "KZS22"), wanted, strict=True):
        np.testing.assert_allclose(zones[name], value * dt, rtol=slack)


def contacts(m: Model) -> dict[tuple[int, int, float, float], tuple[float, float]]:
    """Forces of the contacts that carry any, by blocks and place."""
    rows = m.table("contact")
    rows = rows[rows["KCFN"] > 0]
    return {
        (int(r["KB1"]), int(r["KB2"]), round(float(r["KXC"]), 9), round(float(r["KYC"]), 9)): (
            float(r["KCFN"]),
            float(r["KCFS"]),
        )
        for r in rows
    }


@pytest.mark.parametrize("mixed", [False, True])
def test_neighbours_feel_nothing_in_a_run(mixed: bool) -> None:
    """Contacts and forces of a settled stack are kept; blocks that are divided then stay at rest."""
    m = stacked()
    m.cycle(2000)
    before = contacts(m)
    top = block(m, 2, 3)
    force = sum(fn for fn, _ in before.values())
    m.generate(0, 4, 2, 4, "automatic", edge=0.5, mixed=mixed)
    m.generate(0, 2, 0, 2, "automatic", edge=0.4, mixed=mixed)
    sound(m)
    after = contacts(m)
    assert {key: after[key] for key in before} == before
    assert set(after) == set(before)  # new ones begin without force
    assert m.h.ci[g.NCON] > len(before)
    for _ in range(20):
        m.cycle(100)
        sound(m)
    m.cycle(round(1.0 / float(m.h.cr[g.TDEL])))  # 16 times the time in which damping takes all but 1/e
    now = block(m, 2, 3)
    sag = 1000 * 10 * 4**2 / 2 / K + force / 1e9  # of a column of 4 m under its weight, and of one joint
    assert abs(now["KY"] - top["KY"]) < sag
    assert sum(fn for fn, _ in contacts(m).values()) == pytest.approx(force, rel=1e-3)


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_neighbours_share_the_grid_points_of_a_common_edge(build: str) -> None:
    m = stacked(build)
    m.generate(0, 2, 0, 2, "automatic", edge=0.4)
    m.generate(2, 4, 0, 2, "automatic", edge=0.4)
    sound(m)
    points = m.table("gridpoint")
    left = points[(points["KXG"] == 2) & (points["KYG"] < 2)]
    heights, count = np.unique(left["KYG"], return_counts=True)
    assert len(heights) == 5
    assert (count == 2).all()
    m.free(2, 4, 0, 2)
    for _ in range(5):
        m.cycle(20)
        sound(m)


def test_restart_goes_on_with_the_same_bits(tmp_path: Path) -> None:
    m = stacked()
    m.cycle(50)
    m.generate(0, 4, 2, 4, "automatic", edge=0.6, mixed=True)
    m.cycle(10)
    other = Model.restore(m.save(tmp_path / "half.h5"))
    for each in (m, other):
        each.cycle(30)
    for name in ("gridpoint", "zone", "corner", "contact"):
        assert m.table(name).tobytes() == other.table(name).tobytes()


def test_generating_twice_makes_the_same_bits() -> None:
    one, two = stacked(), stacked()
    for m in (one, two):
        m.generate(0, 4, 2, 4, "automatic", edge=0.6, mixed=True)
    assert (one.h.ia == two.h.ia).all()


@pytest.mark.parametrize(("build", "mtop"), [("i16r32", None), ("i16r64", None), ("i32r64", 9000)])
def test_no_memory_changes_nothing(build: str, mtop: int | None) -> None:
    m = Model(build, mtop=mtop)
    m.start()
    m.round(0.01)
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    m.split(-1, 2, 5, 2)
    before = m.h.ia.copy(), m.h.ci.copy()
    with pytest.raises(UdecError) as caught:
        m.generate(0, 4, 2, 4, "automatic", edge=0.05)
    assert caught.value.number == 1
    assert "--mtop" in caught.value.advice or "--build" in caught.value.advice
    assert (m.h.ia == before[0]).all()
    assert (m.h.ci == before[1]).all()


def test_a_range_of_blocks_needs_no_more_memory_than_one_by_one() -> None:
    """Memory that ends within the range changes nothing, whichever block it ends in."""
    used = stacked()
    for where in ((2, 4, 0, 2), (0, 4, 2, 4), (0, 2, 0, 2)):
        used.generate(*where, edge=0.5)
    most, least = int(used.h.ci[g.MFREE]), int(stacked().h.ci[g.MFREE])
    for part in (0.0, 0.3, 0.6, 0.9):
        m = stacked()
        refit(m.array, int(least + part * (most - least)))
        before = [words[: least - 1].copy() for words in (m.h.ia, m.h.ci, m.h.cr)]
        with pytest.raises(UdecError) as caught:
            m.generate("ALL", edge=0.5)
        assert caught.value.number == 1
        after = [words[: least - 1] for words in (m.h.ia, m.h.ci, m.h.cr)]
        assert all((one == other).all() for one, other in zip(before, after, strict=True))
        sound(m)
    m = stacked()
    refit(m.array, int(least + 1.2 * (most - least)))
    m.generate("ALL", edge=0.5)


def test_a_rounded_corner_needs_room() -> None:
    m = model(*SQUARE, d=0.1)
    with pytest.raises(UdecError) as caught:
        m.generate(0, 2, 0, 2, "automatic", edge=0.08)
    assert (caught.value.number, caught.value.parameter) == (14, "edge")
    assert len(m.table("gridpoint")) == 0
    m.round(float(caught.value.advice.split()[-1]))
    m.generate(0, 2, 0, 2, "automatic", edge=0.08)
    sound(m)


def test_a_block_without_zones_feels_its_contacts_later() -> None:
    """CHANGE to FDEF in a run: until GENERATE there are no grid-points to take the forces of the contacts."""
    m = stacked()
    m.cycle(500)
    top = int(block(m, 2, 3)["address"])

    def others() -> list[Any]:
        rows = m.table("block")[["address", "KX", "KY", "KXD", "KYD", "KTD", "KBRO", "KBM"]]
        return rows[rows["address"] != top].tolist()

    before = others()
    m.change(0, 4, 2, 4, type="fdef")
    sound(m)
    assert others() == before
    m.generate(0, 4, 2, 4, "automatic", edge=0.5)
    sound(m)
    assert others() == before
    felt = float(m.table("gridpoint")["KGFY"].sum())
    assert felt == pytest.approx(float(block(m, 2, 3)["KBFY"]), rel=1000 * EPS)
    assert felt > 0
