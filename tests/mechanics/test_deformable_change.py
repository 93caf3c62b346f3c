"""CHANGE and GENERATE against sums by hand: what a change of type keeps, and what a refusal leaves."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from naive.bodies import (
    applied_stress,
    area_and_moments,
    block_forces,
    by_address,
    mean_stress,
    momentum,
    outlines,
    points_of,
    zone_forces,
)
from support.mechanics_scenes import at, block, box, model, push, sound

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import putr
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.studies.verification_tools import fan

KINDS = ("rigid", "sdef", "fdef", "zoned")
CHANGES = [(old, new) for old in KINDS for new in KINDS if (old, new) != ("zoned", "zoned")]
NUMBERS = {"rigid": g.MRIG, "sdef": g.MSDEF, "fdef": g.MFDEF, "zoned": g.MFDEF}
EPS = float(np.finfo(float).eps)


def become(m: Model, address: int, kind: str) -> None:
    """Make the block at `address` rigid, simply-deformable, or fully-deformable with zones or without."""
    row = at(m, "block", address)
    x, y = float(row["KX"]), float(row["KY"])
    m.change(x - 1e-6, x + 1e-6, y - 1e-6, y + 1e-6, type="fdef" if kind == "zoned" else kind)
    if kind == "zoned":
        fan(m, x, y, edge_points=1)


def stack(kind: str, build: str = "i32r64", cycles: int = 60) -> tuple[Model, int]:
    """A block of `kind` between a fixed one and a rigid one, all pressed and sheared; the block's address.

    A block without zones cannot be cycled: it is rigid until the cycles are over.
    """
    m = model(*box(0, 2, -1, 3), d=0.1, stiffness=(1e8, 1e8), friction=0.5, build=build)
    m.property(1, bulk=2e8, g=1e8)
    m.split(-1, 0, 3, 0)
    m.split(-1, 1, 3, 1.3)
    m.fix(0, 2, -1, 0)
    address = int(block(m, 1, 0.5)["address"])
    if kind != "fdef":
        become(m, address, kind)
    if cycles:
        m.cycle(1)
        push(m, int(block(m, 1, 2)["address"]), 0.1, -0.2, 0.05)
        m.cycle(cycles - 1)
    if kind == "fdef":
        become(m, address, kind)
    return m, address


def limited(m: Model, mtop: int) -> Model:
    """`m` in a main array of `mtop` words, which cannot grow."""
    other = Model()
    other.start()
    other.session.array = MainArray(m.array.scheme, mtop)
    here, there = other.array.h, m.array.h
    size = len(here.ia)
    here.ia[:] = there.ia[:size]
    here.ci[:], here.cr[:], here.cd[:] = there.ci, there.cr, there.cd
    here.ci[g.MTOP] = size
    return other


def words(m: Model) -> tuple[bytes, bytes, bytes]:
    """All words in use."""
    return m.h.ia.tobytes(), m.h.ci.tobytes(), m.h.cr.tobytes(), m.h.cd.tobytes()


def soft_blocks(m: Model) -> int:
    return int((m.table("block")["HEAD"] != g.MRIG).sum())


@pytest.mark.parametrize(("old", "new"), CHANGES)
def test_a_change_in_a_run(old: str, new: str) -> None:
    """Momentum, mass and stress stay; force sums are those of the contacts and zones.

    The angular momentum stays as well, but for new zones, which take over the velocities of the block.
    """
    m, address = stack(old)
    m.property(1, density=5000.0)  # too late to count
    mass = at(m, "block", address)["KBM"]
    total, size = momentum(m)
    if old == "rigid":
        (s, area) = applied_stress(m, address)
        stress = np.array([s[0, 0], (s[0, 1] + s[1, 0]) / 2, s[1, 1]]) / area
    else:
        stress = mean_stress(m, address)
    assert np.abs(stress).max() > 1e3

    become(m, address, new)
    sound(m)
    after, _ = momentum(m)
    same = 2 if new == "zoned" else 3
    np.testing.assert_array_less(np.abs(after - total)[:same], 100 * EPS * size[:same])
    assert at(m, "block", address)["KBM"] == mass
    assert int(m.h.ci[g.NSOFT]) == soft_blocks(m) == (new != "rigid")
    if new != "rigid":
        np.testing.assert_allclose(mean_stress(m, address), stress, atol=1e-10 * np.abs(stress).max())
    check_masses(m, address)
    check_forces(m)
    if new != "fdef":
        before, _ = momentum(m)
        m.gravity(0, 0)
        m.free(0, 2, -1, 0)
        m.cycle(20)
        sound(m)
        after, size = momentum(m)
        np.testing.assert_array_less(np.abs(after - before)[:2], 20 * 100 * EPS * size[:2] + 1e-9)


def check_masses(m: Model, address: int) -> None:
    """Masses of grid-points and Euler tensor are those of the block's mass spread over its area."""
    row = at(m, "block", address)
    ring = [(float(c["KXP"]), float(c["KYP"])) for c in outlines(m)[address]]
    area, _, _, second = area_and_moments(ring)
    density = float(row["KBM"]) / area
    if row["HEAD"] == g.MFDEF and points_of(m)[address]:
        points = points_of(m)[address]
        masses = np.array([p["KGPM"] for p in points])
        assert masses.sum() == pytest.approx(float(row["KBM"]), rel=1e-12)
        assert (masses > 0).all()
        for inner, of_block in (("KXG", "KX"), ("KYG", "KY")):
            mean = (masses @ [float(p[inner]) for p in points]) / masses.sum()
            assert mean == pytest.approx(float(row[of_block]), rel=1e-12)
    elif row["HEAD"] == g.MSDEF:
        ext = at(m, "sdef", int(row["KBEX"]))
        found = np.array([[ext["KSJ11"], ext["KSJ12"]], [ext["KSJ12"], ext["KSJ22"]]])
        np.testing.assert_allclose(found, density * second, rtol=1e-10, atol=1e-10 * density * second.max())
    if row["HEAD"] != g.MFDEF:
        assert row["KBI"] == pytest.approx(density * second.trace(), rel=1e-10)


def check_forces(m: Model) -> None:
    """Force sums are the sums of what contacts and zones exert."""
    expected, blocks = block_forces(m), by_address(m.table("block"))
    scale = max(np.abs(f).max() for f in expected.values())
    for ib, force in expected.items():
        found = [float(blocks[ib][k]) for k in ("KBFX", "KBFY", "KBFT")]
        np.testing.assert_allclose(found, force, atol=1e-11 * scale)
        if blocks[ib]["HEAD"] == g.MSDEF:
            ext = at(m, "sdef", int(blocks[ib]["KBEX"]))
            sums = np.array([[ext["KSA11"], ext["KSA12"]], [ext["KSA21"], ext["KSA22"]]])
            np.testing.assert_allclose(sums, applied_stress(m, ib)[0], atol=1e-11 * scale)
    zones = zone_forces(m)
    for ib, points in points_of(m).items():
        if points:
            sums = sum(np.array((p["KGFX"], p["KGFY"]), float) for p in points)
            np.testing.assert_allclose(sums, expected[ib][:2], atol=1e-11 * scale)
            inner = next(p for p in points if p["KCOR"] == 0)
            force = [float(inner["KGFX"]), float(inner["KGFY"])]
            np.testing.assert_allclose(force, zones[int(inner["address"])], atol=1e-11 * scale)


@pytest.mark.parametrize(("old", "new"), CHANGES)
def test_a_change_before_the_run(old: str, new: str) -> None:
    """It leaves no trace: the run is that of a block which has always been of the new type."""
    m, address = stack("rigid", cycles=0)
    for kind in (old, new):
        become(m, address, kind)
        sound(m)
    if new == "fdef" and old != "zoned":
        with pytest.raises(UdecError) as refused:
            m.cycle(1)
        assert refused.value.number == 26
        return
    straight, there = stack("rigid", cycles=0)
    become(straight, there, "zoned" if old == "zoned" and new == "fdef" else new)
    for one in (m, straight):
        one.cycle(30)
    for kind in ("block", "contact", "gridpoint", "zone", "sdef"):
        here, other = m.table(kind), straight.table(kind)
        for name in {"KXD", "KBI", "KCFN", "KXDG", "KZS22", "KED11"} & set(here.dtype.names):
            np.testing.assert_array_equal(here[name], other[name])
    sound(m)


def test_numbers_follow_and_masses_are_protected() -> None:
    m, address = stack("sdef", cycles=0)
    m.property(2, density=3000.0, kn=1e8, ks=1e8, bulk=2e8, g=1e8)
    area = applied_stress(m, address)[1]
    m.change(0, 2, 0, 1.1, material=2)
    m.cycle(1)
    mass = float(at(m, "block", address)["KBM"])
    assert mass == pytest.approx(3000 * area, rel=1e-12)
    m.change(0, 2, -2, 4, material=1, constitutive=1)
    m.cycle(1)
    assert float(at(m, "block", address)["KBM"]) == mass
    blocks, contacts = m.table("block"), m.table("contact")
    assert set(blocks["KMAT"]) == {1}
    assert set(contacts["KCM"]) == {1}
    m.change(0, 2, 0, 1.1, material=2)
    contacts = m.table("contact")
    assert ((contacts["KCM"] == 2) == (contacts["KB1"] == address)).all()


REFUSED: list[dict[str, Any]] = [
    {"type": "soft"},
    {"type": "sdef", "material": 0},
    {"type": "sdef", "material": 51},
    {"type": "fdef", "constitutive": 6},
    {"material": 2, "constitutive": 0},
    {"type": "rigid", "material": 1.5},
]


@pytest.mark.parametrize("asked", REFUSED, ids=str)
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_refused_changes_no_word(kind: str, asked: dict[str, Any]) -> None:
    m, _ = stack(kind, cycles=10)
    before = words(m)
    with pytest.raises(UdecError):
        m.change(0, 2, -2, 4, **asked)
    assert words(m) == before


def test_a_refused_mesh_changes_no_word() -> None:
    """Wrong numbers, a corner without a grid-point, a gap, an overlap, a block that has zones."""
    m, address = stack("rigid", cycles=10)
    ring = [(float(c["KXP"]), float(c["KYP"])) for c in outlines(m)[address]]
    x, y = float(at(m, "block", address)["KX"]), float(at(m, "block", address)["KY"])
    points, full = [*reversed(ring), (x, y)], [(1, 2, 3), (1, 3, 4), (1, 4, 5), (1, 5, 2)]
    near = x - 1e-6, x + 1e-6, y - 1e-6, y + 1e-6
    before = words(m)
    for number, given, zones in (
        (25, points, [*full[:3], (1, 6, 2)]),
        (26, points[1:], [(1, 2, 3)]),
        (33, points, full[:3]),
        (33, points, [*full, (1, 2, 3)]),
        (33, points, [(2, 3, 4), (2, 4, 5)]),
        (28, [*points, (x + 5, y)], full),
    ):
        with pytest.raises(UdecError) as refused:
            m.generate(*near, "manual", given, zones)
        assert refused.value.number == number
        assert words(m) == before
    m.generate(*near, "manual", points, full)
    before = words(m)
    with pytest.raises(UdecError) as refused:
        m.generate(*near, "manual", points, full)
    assert refused.value.number == 28
    assert words(m) == before


@pytest.mark.parametrize(("old", "new"), CHANGES)
def test_too_little_memory_changes_no_word(old: str, new: str) -> None:
    """With every size of IA() from what is there to what is needed: all or nothing."""
    scene, address = stack(old, cycles=10)
    used = int(scene.h.ci[g.MFREE]) - 1
    refusals = []
    for mtop in range(used, used + 1400, 52):
        m = limited(scene, mtop)
        before = words(m)
        try:
            if new == "zoned" and old != "fdef":
                become(m, address, "fdef")
                before = words(m)
            become(m, address, new)
        except UdecError as error:
            refusals.append(error.number)
            assert words(m) == before
        assert m.check() == []
    assert m.table("block")["HEAD"][m.table("block")["address"] == address] == NUMBERS[new]
    assert set(refusals) <= {1}
    assert bool(refusals) == (old != new and (old, new) != ("zoned", "fdef"))


def test_a_fixed_block_with_zones_is_freed_without_a_kick() -> None:
    """Its grid-points get the forces of the zones back, which they had before FIX."""
    m, address = stack("zoned", cycles=200)
    before = {int(p["address"]): (float(p["KGFX"]), float(p["KGFY"])) for p in m.table("gridpoint")}
    m.fix(0, 2, 0, 1.1)
    m.free(0, 2, 0, 1.1)
    check_forces(m)
    scale = max(abs(f) for force in before.values() for f in force)
    for p in m.table("gridpoint"):
        found = [float(p["KGFX"]), float(p["KGFY"])]
        np.testing.assert_allclose(found, before[int(p["address"])], atol=1e-10 * scale)
    m.fix(0, 2, 0, 1.1)
    m.cycle(10)
    m.free(0, 2, 0, 1.1)
    check_forces(m)
    assert not at(m, "block", address)["KBFIX"]


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_split_keeps_the_mass_in_a_run(kind: str) -> None:
    """Neither a new density nor what the block has been strained changes its mass when it is cut."""
    m, address = stack(kind, cycles=200)
    mass, (_, area) = float(at(m, "block", address)["KBM"]), applied_stress(m, address)
    m.property(1, density=5000.0)
    m.split(0.7, -0.5, 1.1, 3.5)
    halves = [row for row in m.table("block") if 0 < row["KY"] < 1.1]
    assert len(halves) == 2
    assert sum(float(row["KBM"]) for row in halves) == pytest.approx(mass, rel=1e-13)
    for row in halves:
        part = area_and_moments(
            [(float(c["KXP"]), float(c["KYP"])) for c in outlines(m)[int(row["address"])]]
        )[0]
        assert float(row["KBM"]) == pytest.approx(mass * part / area, rel=1e-12)
        check_masses(m, int(row["address"]))
    sound(m)


@pytest.mark.parametrize("then", ["split", "zoned", "sdef"])
def test_momentum_of_a_block_that_was_deformed(then: str) -> None:
    """Masses at grid-points have another centroid than the area, once the block has been bent."""
    m, address = stack("zoned", cycles=60)
    points = m.table("gridpoint")
    for p in points:  # a strong and lopsided strain, and a motion
        putr(m.h, int(p["address"]), g.KXDG, 30 * float(p["KYG"]) ** 2)
        putr(m.h, int(p["address"]), g.KYDG, -4 * float(p["KXG"]) ** 2)
    m.cycle(4)
    total, size = momentum(m)
    become(m, address, "rigid")
    if then == "split":
        row = at(m, "block", address)
        x, y = float(row["KX"]), float(row["KY"])
        m.split(x - 0.3, y - 0.9, x + 0.3, y + 0.9)
    else:
        become(m, address, then)
    after, _ = momentum(m)
    same = 2 if then == "zoned" else 3  # new zones take over the velocities
    np.testing.assert_array_less(np.abs(after - total)[:same], 1000 * EPS * size[:same])
    sound(m)


def test_a_loaded_block_becomes_deformable_at_rest() -> None:
    """Its stress is that of what presses on it, but for 2 mm of overlap below; its load stays."""
    m = model(*box(0, 4, -1, 3), d=0.1, stiffness=(1e9, 1e9), friction=0.5)
    m.property(1, bulk=2e8, g=1e8)
    m.split(-1, 0, 5, 0)
    m.fix(0, 4, -1, 0)
    m.boundary(-1, 5, 2.9, 3.1, stress=(0, 0, -1e6))
    m.damping(0.5, 20, "mass")
    m.cycle(2000)
    address = int(block(m, 2, 1.5)["address"])
    become(m, address, "sdef")
    weight = float(at(m, "block", address)["KBM"]) * 10
    assert mean_stress(m, address)[2] == pytest.approx(-1e6 - weight / 8, rel=2e-3 / 3)
    assert len(m.table("bound")) == 2
    m.cycle(200)
    assert abs(float(at(m, "block", address)["KYD"])) < 1e-4
    become(m, address, "rigid")
    assert len(m.table("bound")) == 2
    sound(m)


def test_an_edge_that_would_be_straight_in_its_neighbour_stays_bent() -> None:
    """A narrow block presses an edge in: bend and overlap are each less than DTOL2, their sum is not."""
    m = Model()
    m.round(0.1)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.property(1, density=1000, kn=4e4, ks=4e4, bulk=3.2e4, g=3.2e4, friction=0.5)
    for line in ((-1, 1, 3, 1), (0.8, 0.5, 0.8, 3), (1.2, 0.5, 1.2, 3)):
        m.split(*line)
    m.delete(0, 0.8, 1, 2)
    m.delete(1.2, 2, 1, 2)
    points = [(2, 0), (2, 1), (1, 1), (0, 1), (0, 0), (1, 0.5)]
    zones = [(2, 3, 1), (3, 4, 1), (4, 5, 1), (5, 6, 1), (6, 2, 1)]
    m.generate(0, 2, 0, 1, "manual", gridpoints=points, zones=zones)
    m.boundary(-0.1, 2.1, -0.1, 0.1, xvel=0, yvel=0)
    m.gravity(0, -10)
    m.damping(0.5, 10, "mass")
    m.cycle(3000)
    assert m.check() == []
    assert 0 < m.table("contact")["KCN"].max() < 0.05
    before = m.array.copy()
    with pytest.raises(
        UdecError, match=r"allows overlaps up to 0\.05, but block@\d+ and block@\d+ overlap"
    ) as caught:
        m.change(0, 2, 0, 1, type="sdef")
    assert caught.value.number == 14
    assert m.array.h.ia.tobytes() == before.h.ia.tobytes()
    assert m.check() == []
