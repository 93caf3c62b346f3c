"""BREAKAGE: blocks that crack under load (docs/cracking.md)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.random_crack_scenes import play
from support.replayable_steps import replay
from support.seldom_compiled import compiled_if_usual

from udec_ia import Model, UdecError
from udec_ia.kernels.drive.cycle import CRACKS, passes
from udec_ia.layout import offsets as g
from udec_ia.running.cycle_replay import Replay
from udec_ia.running.history_series import NEVER, NO_MARKS
from udec_ia.studies.verification_tools import generate, outline, rectangle

T, ALL = 1e5, (-1e3, 1e3, -1e3, 1e3)


def pressed(
    corners: Any, speed: float = 1e-3, high: float = 1.0, foot: float = 1.0, build: str = "i32r64"
) -> Model:
    """A block with those corners between two platens at y = high and -high; the upper one moves down.

    foot: half of the width of the lower one.
    """
    m = Model(build)
    m.tell = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.round(0.02)
    m.block(*(float(x) for x in np.ravel(corners)))
    m.block(-1, high, -1, high + 0.5, 1, high + 0.5, 1, high)
    m.block(-foot, -high - 0.5, -foot, -high, foot, -high, foot, -high - 0.5)
    m.fix(-1, 1, -2, -high)
    m.boundary(-1, 1, high, 2, xvel=0.0, yvel=-speed)
    m.damping(local=0.8)
    return m


def disc(n: int = 24) -> Any:
    """A regular polygon with a corner at the top, clockwise."""
    angle = np.pi / 2 - 2 * np.pi * np.arange(n) / n
    return np.column_stack([np.cos(angle), np.sin(angle)])


def force_at_crack(m: Model, most: int = 500, step: int = 20) -> float:
    """The greatest contact force before the first crack."""
    p = 0.0
    for _ in range(most):
        m.cycle(step)
        if len(m.cracks()):
            return p
        p = float(m.table("contact")["KCFN"].max())
    raise AssertionError("no crack")


def floating(kind: str = "sdef", stress: tuple[float, float, float] = (0, 0, 0), **words: Any) -> Model:
    """A lone block with a stress in it."""
    m = Model()
    m.tell = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 3, 3, 3, 3, 0)  # its moments have no axes
    m.round(0.05)
    m.change(*ALL, type=kind)
    m.insitu(*ALL, *stress)
    m.breakage(*ALL, smallest=0.5, **words)
    return m


# ---- two opposed forces


def test_a_disc_breaks_along_its_loaded_diameter() -> None:
    m = pressed(disc())
    m.breakage(-1, 1, -1, 1, tension=T, smallest=0.1)
    p = force_at_crack(m)
    assert p == pytest.approx(np.pi / 2 * 2 * T, rel=0.01)
    (crack,) = m.cracks()
    assert crack["cause"] == "forces"
    np.testing.assert_allclose([crack[name] for name in ("x1", "x2")], 0, atol=1e-9)
    assert abs(crack["y2"] - crack["y1"]) == pytest.approx(2)
    assert m.h.ci[g.NBLK] == 4
    assert m.check() == []


@pytest.mark.parametrize("radius", [0.5, 0.7])
def test_strength_grows_with_the_distance(radius: float) -> None:
    m = pressed(radius * disc(), high=radius, speed=2e-3)
    assert force_at_crack(_breakable(m)) == pytest.approx(np.pi / 2 * 2 * radius * T, rel=0.02)


def _breakable(m: Model, **words: Any) -> Model:
    m.breakage(-1, 1, -0.49, 0.49, **{"tension": T, "smallest": 0.05} | words)
    return m


@pytest.mark.parametrize("kind", ["rigid", "sdef"])
def test_parts_are_not_below_the_smallest_area(kind: str) -> None:
    m = pressed(disc(), speed=0.01)
    m.change(-1, 1, -0.9, 0.9, type=kind)
    area = np.pi / 2 * 0.97  # of half the polygon: 1.55
    _breakable(m, smallest=area * 1.05, tension=T / 20)
    p = 0.0
    while p < 0.06 * np.pi * T:
        m.cycle(20)
        p = float(m.table("contact")["KCFN"].min())
        assert m.h.ci[g.MCTOT] < 10_000
    assert len(m.cracks()) == 0
    _breakable(m, smallest=area * 0.9, tension=T / 20)
    m.cycle(20)
    assert len(m.cracks()) == 1


@pytest.mark.parametrize(("foot", "cracks"), [(0.6, 1), (1.4, 0)])
def test_forces_are_opposed_within_30_degrees(foot: float, cracks: int) -> None:
    """A force at the top of a triangle, and two on its foot, 17 or 35 degrees beside that."""
    m = pressed([(-2, -1), (0, 1), (2, -1)], speed=0.05, foot=foot)
    m.breakage(-1, 1, -0.99, 0.99, tension=T / 20, smallest=0.05)
    largest = 0.0
    for _ in range(60):
        m.cycle(10)
        largest = max(largest, float(m.table("contact")["KCFN"].max()))
        if len(m.cracks()):
            break
    assert len(m.cracks()) == cracks
    assert largest > 3e4 or cracks


def test_a_crack_takes_the_energy_of_springs_at_its_mouth() -> None:
    """The account balances across the cycles around the crack, in which nothing else opens or closes."""
    m = pressed(disc(), speed=0.01)
    _breakable(m)
    m.damping(0, 1)
    m.energy("on")
    m.cycle(690)
    before = m.balance()
    while not len(m.cracks()):
        m.cycle(1)
        assert m.h.ci[g.MCTOT] < 800
    m.cycle(1)
    after = m.balance()
    assert after.cracks == pytest.approx(m.cracks()["energy"].sum(), rel=1e-12)
    assert after.cracks > 0.8 * before.contacts
    assert after.residual - before.residual == pytest.approx(0.0, abs=0.05)


# ---- stress


def test_an_sdef_block_cracks_across_the_greatest_tension() -> None:
    angle = np.radians(20)
    c, s = np.cos(angle), np.sin(angle)
    stress = tuple(1.3 * T * v for v in (c * c, c * s, s * s))
    m = floating(stress=stress, tension=T)
    m.cycle(1)
    (crack,) = m.cracks()
    assert crack["cause"] == "tension"
    way = np.array([crack["x2"] - crack["x1"], crack["y2"] - crack["y1"]])
    assert abs(way @ (c, s)) < 1e-6 * np.hypot(*way)
    assert abs(way[0] * (1.5 - crack["y1"]) - way[1] * (1.5 - crack["x1"])) < 1e-6  # through the centroid
    assert m.check() == []


@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_an_sdef_block_cracks_in_shear(friction: float) -> None:
    """At 45 - phi/2 from the direction of the greatest pressure, when Mohr's circle touches the line."""
    cohesion, phi = 1e5, np.arctan(friction)
    strength = 2 * cohesion * np.cos(phi) / (1 - np.sin(phi))  # uniaxial
    m = floating(stress=(0.0, 0.0, -0.99 * strength), cohesion=cohesion, friction=friction)
    m.breakage(*ALL, smallest=0.5, cohesion=cohesion / 0.985, friction=friction)
    m.cycle(1)
    assert len(m.cracks()) == 0
    m.breakage(*ALL, smallest=0.5, cohesion=cohesion * 0.5, friction=friction)
    m.cycle(1)
    (crack,) = m.cracks()
    assert crack["cause"] == "shear"
    from_y = np.arctan2(abs(crack["x2"] - crack["x1"]), abs(crack["y2"] - crack["y1"]))
    assert from_y == pytest.approx(np.pi / 4 - phi / 2, abs=1e-3)


def moments(m: Model) -> Any:
    """Linear and angular momentum about 0, and kinetic energy, of simply-deformable blocks."""
    total = np.zeros(4)
    for block, ext in zip(m.table("block"), m.table("sdef"), strict=True):
        mass, x, y = block["KBM"], block["KX"], block["KY"]
        gradient = np.array([[ext["KED11"], ext["KED12"]], [ext["KED12"], ext["KED22"]]])
        gradient += block["KTD"] * np.array([[0, -1], [1, 0]])
        second = np.array([[ext["KSJ11"], ext["KSJ12"]], [ext["KSJ12"], ext["KSJ22"]]])
        v = np.array([block["KXD"], block["KYD"]])
        of_field = gradient @ second  # integral of density v_i r_j
        total[:2] += mass * v
        total[2] += mass * (x * v[1] - y * v[0]) + of_field[1, 0] - of_field[0, 1]
        total[3] += (mass * v @ v + np.trace(of_field @ gradient.T)) / 2
    return total


def test_a_crack_leaves_momentum_and_energy() -> None:
    m = floating(stress=(1.3 * T, 2e4, 0.0), tension=T)
    m.patch(f"block@{m.table('block')['address'][0]}.KXD = 0.3")
    m.patch(f"block@{m.table('block')['address'][0]}.KTD = 0.2")
    twin = floating(stress=(1.3 * T, 2e4, 0.0), tension=10 * T)
    twin.patch(f"block@{twin.table('block')['address'][0]}.KXD = 0.3")
    twin.patch(f"block@{twin.table('block')['address'][0]}.KTD = 0.2")
    m.cycle(1)
    twin.cycle(1)
    assert m.h.ci[g.NBLK] == 2
    assert twin.h.ci[g.NBLK] == 1
    assert abs(twin.table("sdef")["KED11"][0]) > 1e-6
    np.testing.assert_allclose(moments(m), moments(twin), rtol=1e-12, atol=1e-9)


def test_parts_wait_for_a_wave() -> None:
    """The stress of the halves is that of the block: without a pause they would crack at once."""
    m = floating(stress=(3 * T, 0.0, 0.0), tension=T)
    m.cycle(4)
    assert len(m.cracks()) == 1
    assert m.table("sdef")["KS111"].min() > T


def test_a_glued_crack_carries_the_stress() -> None:
    """With a joint material of greater strength the block hardly notices its crack."""
    m = Model()
    m.tell = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.jproperty(1, kn=1e11, ks=1e11, cohesion=1e9, tension=1e9)
    m.block(0, 0, 0, 1, 4, 1, 4, 0)
    m.round(0.02)
    m.change(*ALL, type="sdef")
    m.boundary(-1, 5, -1, 2, stress=(1.001 * T, 0.0, 0.0))
    m.insitu(*ALL, 1.001 * T, 0.0, 0.0)
    m.breakage(*ALL, tension=T, smallest=1.5, jmaterial=1)
    m.cycle(300)
    assert len(m.cracks()) == 1
    np.testing.assert_allclose(m.table("sdef")["KS111"], 1.001 * T, rtol=1e-3)
    assert np.abs(m.table("block")["KXD"]).max() < 1e-5
    assert m.check() == []


# ---- zones


def zoned(stress: tuple[float, float, float], mixed: bool = False, **words: Any) -> Model:
    """A lone block with zones and a stress, in motion of several kinds."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.jproperty(1, kn=1e11, ks=1e11, friction=0.6, cohesion=5 * T, tension=5 * T)
    nodes = rectangle(0.0, 3.0, 0.0, 2.0, 9, 6)
    m.block(*outline(nodes))
    m.round(0.02)
    generate(m, nodes, mixed=mixed)
    m.insitu(*ALL, *stress)
    for row in m.table("gridpoint"):
        at, x, y = f"gridpoint@{row['address']}", float(row["KXG"]), float(row["KYG"])
        m.patch(f"{at}.KXDG = {0.1 - 0.2 * y!r}, {at}.KYDG = {0.2 * x + 0.01 * x * x!r}")
    m.breakage(*ALL, **{"smallest": 0.3} | words)
    return m


def of_points(m: Model) -> Any:
    """Mass, linear and angular momentum, and twice the kinetic energy of all grid-points."""
    points = m.table("gridpoint")
    mass, x, y, u, v = (points[name].astype(float) for name in ("KGPM", "KXG", "KYG", "KXDG", "KYDG"))
    return [float((mass * one).sum()) for one in (1.0, u, v, x * v - y * u, u * u + v * v)]


@pytest.mark.parametrize("mixed", [False, True])
def test_a_crack_along_zone_sides_is_exact(mixed: bool) -> None:
    stress = (3 * T, 0.5 * T, T)
    m, whole = zoned(stress, mixed, tension=T), zoned(stress, mixed, tension=100 * T)
    m.cycle(1)
    whole.cycle(1)
    (crack,) = m.cracks()
    assert crack["cause"] == "tension"
    assert abs(crack["energy"]) < 1e-9
    assert (m.h.ci[g.NBLK], whole.h.ci[g.NBLK]) == (2, 1)
    np.testing.assert_allclose(of_points(m), of_points(whole), rtol=1e-12)
    names = ["KZS11", "KZS12", "KZS22", "KZM"]
    assert sorted(m.table("zone")[names].tolist()) == sorted(whole.table("zone")[names].tolist())
    assert m.check() == []
    m.cycle(20)
    assert m.check() == []


def test_the_path_is_near_the_plane() -> None:
    """Uniform tension: the crack is as straight as the mesh allows, and parts are large enough."""
    m = zoned((3 * T, 0.0, T), tension=2 * T)
    m.cycle(1)
    (crack,) = m.cracks()
    assert abs(crack["x2"] - crack["x1"]) <= 3.0 / 9 + 1e-3
    assert abs(crack["y2"] - crack["y1"]) == pytest.approx(2.0, abs=0.01)
    assert m.table("block")["KBM"].min() >= 0.3 * 2000


def test_what_has_not_failed_is_glued() -> None:
    """One zone fails: beside it the faces are broken, elsewhere they carry the stress that was there."""
    stress = (0.9 * T, 0.0, 0.0)
    m = zoned(stress, tension=T, jmaterial=1)
    m.property(1, density=2000)
    row = m.table("zone")[7]
    m.patch(f"zone@{row['address']}.KZS11 = {2.5 * T!r}")
    m.cycle(1)
    assert len(m.cracks()) == 1
    ours = m.table("joint")
    broken = (ours["KCJFLAG"] & g.JOINT_BROKEN) != 0
    assert 0 < broken.sum() < len(ours)
    assert (ours["KCJSN"][broken] >= 0).all()
    assert (ours["KCJSN"][~broken] < 0).all()
    assert m.check() == []


def test_conditions_pass_to_the_points_that_double() -> None:
    m = zoned((3 * T, 0.0, T), tension=2 * T)
    m.boundary(-1, 4, 1.99, 2.01, yvel=0.0)
    m.boundary(-1, 4, -0.01, 0.01, yforce=90.0)
    before = len(m.table("bound"))
    m.cycle(1)
    assert len(m.cracks()) == 1
    after = m.table("bound")
    assert len(after) == before + 2
    assert after["KUFY"].sum() == pytest.approx(10 * 90.0)
    assert ((after["KUFIX"] != 0).sum(), (after["KUFY"] != 0).sum()) == (11, 11)
    assert m.check() == []


def test_a_block_without_a_path_stays_whole() -> None:
    m = zoned((3 * T, 0.0, T), tension=2 * T, smallest=3.5)
    m.cycle(30)
    assert len(m.cracks()) == 0
    assert m.table("breakable")["KBKW"][0] > 0
    assert m.check() == []


# ---- runs


def same(one: Model, two: Model) -> None:
    """Both states are the same, bit for bit."""
    used = int(one.h.ci[g.MFREE]) - 1
    assert used == int(two.h.ci[g.MFREE]) - 1
    assert one.h.ia[:used].tobytes() == two.h.ia[:used].tobytes()
    assert one.h.cd.tobytes() == two.h.cd.tobytes()


@pytest.mark.parametrize("zones", [False, True])
def test_a_run_with_cracks_is_repeated_bit_for_bit(tmp_path: Path, zones: bool) -> None:
    def run() -> Model:
        stress = (5 * T, T, 2 * T)
        return zoned(stress, tension=T, jmaterial=1) if zones else floating(stress=stress, tension=T)

    whole, pieces = run(), run()
    whole.cycle(600)
    assert len(whole.cracks()) > (0 if zones else 1)
    pieces.cycle(0 if zones else 150)
    pieces.save(tmp_path / "part.h5")
    twin = Replay(pieces.array, pieces.session.laws)
    pieces = Model.restore(tmp_path / "part.h5")
    left = 600 - int(pieces.h.ci[g.MCTOT])
    for _ in range(left):
        pieces.cycle(1)
    same(whole, pieces)
    twin.step(left)
    used = int(whole.h.ci[g.MFREE]) - 1
    assert twin.array.h.ia[:used].tobytes() == whole.h.ia[:used].tobytes()
    assert whole.check() == []


@pytest.mark.parametrize("build", ["i16r32", "i32r32", "i16r64", "i64r64"])
def test_every_word_scheme_cracks_alike(build: str) -> None:
    m = pressed(disc(), speed=0.05, build=build)
    _breakable(m)
    with compiled_if_usual(build):
        m.cycle(300)
    (crack,) = m.cracks()[:1]
    assert abs(crack["x1"]) + abs(crack["x2"]) < 1e-3
    assert m.check() == []


def test_a_scene_without_breakage_has_no_pass_for_it() -> None:
    m = pressed(disc())
    assert passes(m.h, None, (), NEVER, False, NO_MARKS)[CRACKS] == 0
    _breakable(m)
    assert passes(m.h, None, (), NEVER, False, NO_MARKS)[CRACKS] != 0
    assert m.breakage(*ALL, state="off") == 1
    assert passes(m.h, None, (), NEVER, False, NO_MARKS)[CRACKS] == 0
    assert len(m.table("breakable")) == 0


def test_parts_have_groups_conditions_and_strength_of_the_block() -> None:
    m = floating(stress=(1.3 * T, 0.0, 0.0), tension=T)
    m.group("core", *ALL)
    m.boundary(*ALL, xforce=300.0)
    m.cycle(1)
    assert len(m.table("member")) == len(m.table("breakable")) == len(m.table("bound")) == 2
    assert m.table("bound")["KUFX"].sum() == pytest.approx(300)
    assert set(m.table("breakable")["KBKB"]) == set(m.table("block")["address"])
    assert (m.table("breakable")["KBKW"] > 0).all()


def test_a_deck_cracks_and_shows_it(tmp_path: Path) -> None:
    m = floating(stress=(1.3 * T, 0.0, 0.0), tension=T)
    m.out, lines = tmp_path, list[str]()
    m.inform = lines.append
    m.cycle(1)
    assert sum(line.startswith("cycle 1: crack by tension") for line in lines) == 1
    assert "tension" in m.print("cracks")
    paths = m.plot(0, cracks=True)
    assert all(path.stat().st_size > 0 for path in paths)
    deck = m.deck()
    assert "BREAKAGE" in deck
    again = Model(out=tmp_path)
    again.run(deck + "PRINT CRACKS\nPLOT 0 CRACKS\nSTOP\nEND\n")
    assert len(again.cracks()) == 1


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (7, {"tension": T}),
        (7, {"smallest": 1.0}),
        (28, {"tension": 0.0, "smallest": 1.0}),
        (28, {"tension": -T, "smallest": 1.0}),
        (28, {"tension": T, "smallest": 0.0}),
        (28, {"cohesion": 0.0, "smallest": 1.0}),
        (4, {"tension": T, "smallest": 1.0, "jmaterial": 3}),
        (10, {"state": "maybe"}),
        (10, {"state": "off", "tension": T}),
    ],
)
def test_errors(number: int, words: dict[str, Any]) -> None:
    m = floating(tension=T)
    with pytest.raises(UdecError) as error:
        m.breakage(*ALL, **words)
    assert error.value.number == number
    assert len(m.table("breakable")) == 1
    assert m.check() == []


def test_random_scenes_are_played_again_alike() -> None:
    for seed in (3, 5):
        scene = play(seed)
        same(scene.model, replay(Model(), scene.steps))
