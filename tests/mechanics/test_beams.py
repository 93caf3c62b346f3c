"""Cables, beams and linings: elements, interfaces, and how they follow blocks (docs/structures.md)."""

from __future__ import annotations

import copy
import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mechanics.test_bolts import hanging, separate_blocks, throw
from naive.beams import element_matrix, loaded_beam

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g
from udec_ia.reader.structure_rows import structure_rows
from udec_ia.running.critical_step import bound, estimate

EXAMPLES = Path(__file__).parents[2] / "examples"
KINDS = ("rigid", "sdef", "fdef")
STEEL = {
    "young": 2e9,
    "area": 0.05,
    "inertia": 1e-4,
    "density": 2500.0,
    "kn": 1e7,
    "ks": 1e7,
    "cohesion": 1e5,
}


def room(kind: str = "rigid") -> Model:
    """Nine blocks of 2 m around a space of 2 m, which is the middle one; the outer ones are fixed."""
    m = Model()
    m.tell = lambda _: None
    m.block(0, 0, 0, 6, 6, 6, 6, 0)
    for at in (2, 4):
        m.split(-1, at, 7, at)
        m.split(at, -1, at, 7)
    m.delete(2, 4, 2, 4)
    m.round(0.05)
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.fix(0, 6, 0, 6)
    if kind == "fdef":
        m.generate(0, 6, 0, 6, mode="automatic", edge=1.0)
    return m


def momentum(m: Model) -> Any:
    """Momentum in x and y, and angular momentum about the origin, of free blocks and nodes."""
    total = np.zeros(3)
    blocks, nodes = m.table("block"), m.table("node")
    for rows, names in (
        (blocks[blocks["KX"] > 0], ("KX", "KY", "KXD", "KYD", "KTD", "KBM", "KBI")),
        (nodes, ("KNX", "KNY", "KNXD", "KNYD", "KNTD", "KNM", "KNI")),
    ):
        x, y, u, v, w, mass, inertia = (rows[name].astype(float) for name in names)
        turning = mass * (x * v - y * u) + inertia * w
        total += [(mass * u).sum(), (mass * v).sum(), turning.sum()]
    return total


# ---- elements


@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_forces_of_an_element_are_those_of_its_stiffness_matrix(build: str) -> None:
    m = separate_blocks(build=build)
    m.sproperty(1, **STEEL | {"density": 1e6})
    m.beam(0.5, 0.5, 2.5, 3.5, segments=3)
    m.cycle(1)
    rng, nodes = np.random.default_rng(5), m.table("node")[1:3]
    moves = rng.normal(size=(2, 3)) * 1e-6 / float(m.h.cr[g.TDEL])
    for row, (u, v, w) in zip(nodes, moves, strict=True):
        at = f"node@{row['address']}"
        m.patch(f"{at}.KNXD = {u}, {at}.KNYD = {v}, {at}.KNTD = {w}")
    m.cycle(1)
    after = m.table("node")[1:3]
    step = np.array([after[name] for name in ("KNXD", "KNYD", "KNTD")], float).T * float(m.h.cr[g.TDEL])
    places = [(row["KNX"], row["KNY"]) for row in nodes]
    element = m.table("element")[1]
    exact = element_matrix(2e9, 0.05, 1e-4, *places) @ step.ravel()
    way = np.subtract(*places[::-1])
    nx, ny = way / np.hypot(*way)
    across = (element["KMM1"] + element["KMM2"]) / np.hypot(*way)
    fx, fy = element["KMFN"] * nx + across * ny, element["KMFN"] * ny - across * nx
    got = np.array([-fx, -fy, element["KMM1"], fx, fy, element["KMM2"]])
    assert got == pytest.approx(exact, rel=1e-4, abs=1e-4 * np.abs(exact).max())


@pytest.mark.parametrize("kind", KINDS)
def test_momentum_and_energy_with_cables_and_beams(kind: str) -> None:
    m = separate_blocks(kind)
    m.sproperty(1, **STEEL)
    m.sproperty(2, young=2e9, area=0.01, density=2500, ks=1e6, cohesion=1e4)
    m.sproperty(3, **STEEL, yield_moment=3e3, yield_force=1e5)
    assert m.beam(0.5, 0.2, 0.7, 3.8, segments=12) == 12
    assert m.cable(3.5, 0.2, 3, 3.7, smaterial=2) == 10
    m.beam(2, 0.1, 1.5, 3.9, segments=12, smaterial=3)
    m.cycle(1)
    throw(m)
    m.cycle(1)
    m.energy("on")
    before = momentum(m)
    m.cycle(3000)
    done, elements = m.balance(), m.table("element")
    assert np.abs(momentum(m) - before).max() < 1e-9
    assert abs(done.residual) < 1e-5 * done.throughput
    assert done.structures > 0.01 * done.throughput
    assert done.yielding > 0.001 * done.throughput
    weak = elements["KMMAT"] == 3
    assert np.abs(elements["KMFN"][weak]).max() <= 1e5 * (1 + 1e-9)
    assert np.abs(elements["KMM1"][weak]).max() <= 3e3 * (1 + 1e-9)
    assert (elements["KMSTAT"][weak] & g.HINGED).any()
    assert (elements["KMM1"][elements["KMKIND"] == g.OF_CABLE] == 0).all()
    assert m.check() == []


def test_a_beam_in_a_block_that_turns_is_not_strained() -> None:
    m = separate_blocks()
    m.sproperty(1, **STEEL)
    m.beam(1, 0.2, 3, 0.8)
    m.fraction(0.3, safe=True)
    m.cycle(1)
    throw(m)
    for row in m.table("node"):  # with the block: w = 0.5, v = (-1, -0.2) at (2, 0.5)
        at, x, y = f"node@{row['address']}", row["KNX"] - 2, row["KNY"] - 0.5
        m.patch(f"{at}.KNXD = {-1 - 0.5 * y}, {at}.KNYD = {-0.2 + 0.5 * x}, {at}.KNTD = 0.5")
    m.cycle(20_000)
    elements = m.table("element")
    assert m.table("node")["KNANG"] == pytest.approx(0.5 * float(m.h.cd[g.TIME]), rel=1e-3)
    assert 0.5 * float(m.h.cd[g.TIME]) > 0.2
    spread = 2500 * 0.05 * 0.5**2 * 1.1**2 / 2  # centrifugal, of half of the beam; it swings to twice that
    assert np.abs(elements["KMFN"]).max() < 2.5 * spread
    assert np.abs(elements["KMM1"]).max() < spread * 0.01


def test_an_element_that_breaks_carries_nothing() -> None:
    m = hanging()
    m.sproperty(
        1, young=2e9, area=0.01, density=2500, ks=1e8, cohesion=1e6, yield_force=2e4, break_strain=0.01
    )
    m.cable(2, 0.5, 2, 3.5, segments=6)
    m.boundary(0, 4, 0, 1, xvel=0, yvel=-0.5, rotation=0)
    m.cycle(time=0.1)
    elements = m.table("element")
    broken = elements["KMSTAT"] & g.BROKEN != 0
    assert broken.any()
    assert (elements["KMFN"][broken] == 0).all()
    assert m.check() == []


# ---- interfaces


@pytest.mark.parametrize("tension", [0.0, 1e5])
def test_a_lining_parts_from_a_wall_that_moves_away_and_closes_again(tension: float) -> None:
    m = room()
    m.sproperty(1, young=3e10, area=0.1, inertia=1e-4, density=2400, kn=1e9, ks=1e8, tension=tension)
    assert m.beam(around=(3, 3), segments=4) == 16
    m.fraction(0.5, scaled=True)
    m.damping(kinetic=True)
    far = 1e-3  # moves the wall below the space
    below = m.table("block")
    below = int(below["address"][np.hypot(below["KX"] - 3, below["KY"] - 1).argmin()])
    for speed, gap in ((-1.0, True), (1.0, False)):
        m.boundary(2, 4, 0, 2, xvel=0, yvel=speed, rotation=0)
        m.cycle(round(far / float(m.h.cr[g.TDEL])) if m.h.ci[g.MCTOT] else 0)
        m.cycle(round(far / float(m.h.cr[g.TDEL])))
        m.boundary(2, 4, 0, 2, xvel=0, yvel=0, rotation=0)
        m.solve(1e-6, 50_000)
        nodes = m.table("node")
        floor = nodes[(nodes["KNBL"] == below) & (np.abs(nodes["KNX"] - 3) < 0.9)]
        assert len(floor) == 3
        assert ((floor["KNGAP"] > 0.5 * far) == gap).all()
        if gap:
            assert (floor["KNFN"] == 0).all()
        assert (floor["KNSTAT"] & g.NODE_PARTED != 0).all()


def test_the_interface_slips_at_cohesion_and_friction() -> None:
    """Rigid walls press a lining by `pressed` each; the floor then moves along by more than slip takes."""
    m = room()
    m.sproperty(
        1, young=3e12, area=0.1, inertia=1e-2, density=2400, kn=1e9, ks=1e9, friction=0.3, cohesion=2e3
    )
    m.beam(around=(3, 3), segments=2)
    m.fraction(0.5, safe=True)
    m.damping(local=0.8)
    m.boundary(2, 4, 0, 2, xvel=0, yvel=1e-3, rotation=0)
    m.boundary(2, 4, 4, 6, xvel=0, yvel=-1e-3, rotation=0)
    m.cycle(time=0.02)
    m.boundary(2, 4, 0, 2, xvel=2e-2, yvel=0, rotation=0)
    m.boundary(2, 4, 4, 6, xvel=0, yvel=0, rotation=0)
    m.cycle(time=0.05)
    nodes = m.table("node")
    (row,) = nodes[np.hypot(nodes["KNAX"] - 3, nodes["KNAY"] - 2) < 0.1]
    assert row["KNFN"] > 1e3
    assert row["KNSTAT"] & g.NODE_SLIPPED
    assert abs(row["KNFS"]) == pytest.approx(0.3 * row["KNFN"] + 2e3 * row["KNLEN"], rel=1e-6)
    assert row["KNFS"] * row["KNTX"] < 0  # on the block, against its motion


# ---- commands


def test_linings_follow_the_walls() -> None:
    m = room("fdef")
    m.sproperty(1, **STEEL)
    assert m.beam(around=(3, 3), segments=3) == 12
    nodes = m.table("node")
    assert sorted(set(np.abs(np.stack([nodes["KNX"], nodes["KNY"]]) - 3).max(axis=0).round(9))) == [1.0]
    assert (nodes["KNSIDE"] == g.ROCK_ON_LEFT).all()
    assert (nodes["KNBL"] > 0).all()
    assert nodes["KNLEN"].sum() == pytest.approx(8.0)
    assert nodes["KNM"].sum() == pytest.approx(8.0 * 0.05 * 2500)
    assert m.beam(around=(3, 3), segments=3, within=(1.5, 4.5, 2.5, 4.5)) == 3 + 2 * 2
    assert m.beam(around=(3, 3), segments=4, within="CIRCLE 3 4 0.6") == 2
    assert len(m.table("node")) == 12 + 8 + 3
    assert m.check() == []


@pytest.mark.parametrize(
    ("number", "call"),
    [
        (18, lambda m: m.beam(around=(1, 1))),
        (24, lambda m: m.beam(around=(9, 9))),
        (24, lambda m: m.beam(around=(3, 3), within=(0, 1, 0, 1))),
        (10, lambda m: m.beam(0, 0, 1, 1, within=(0, 1, 0, 1))),
        (10, lambda m: m.beam(0, 0, 1, 1, around=(3, 3))),
        (7, lambda m: m.beam(0, 0)),
        (26, lambda m: m.beam(2.5, 2.5, 3.5, 3.5)),
        (26, lambda m: m.beam(1, 1, 5, 5, smaterial=2)),
        (26, lambda m: m.cable(1, 1, 5, 5, smaterial=3)),
        (28, lambda m: m.cable(1, 1, 5, 5, segments=0)),
        (28, lambda m: m.cable(1, 1, 1, 1)),
        (28, lambda m: m.cable(1, 1, 5, 5, pretension=-1)),
        (4, lambda m: m.cable(1, 1, 5, 5, smaterial=0)),
    ],
)
def test_refused_lines_change_nothing(number: int, call: Any) -> None:
    m = room()
    m.sproperty(1, **STEEL)
    m.sproperty(2, young=1e9, area=0.1, density=2400, ks=1e6)
    m.sproperty(3, young=1e9, area=0.1, ks=1e6)
    before = m.h.ia.copy()
    with pytest.raises(UdecError) as raised:
        call(m)
    assert raised.value.number == number
    assert (m.h.ia == before).all()


def test_nodes_belong_to_what_is_there_after_each_command(tmp_path: Path) -> None:
    heard: list[Any] = []
    m = hanging()
    m.tell = heard.append
    m.sproperty(1, **STEEL)
    m.cable(1, 0.1, 1, 3.9, segments=19)
    m.beam(3, 0.1, 3, 3.9, segments=19)
    m.cycle(10)
    m.split(-1, 0.5, 5, 0.5)
    assert len(set(m.table("node")["KNBL"].tolist())) == 4  # three blocks, and none between them
    m.change(0, 4, 0, 1, type="fdef")
    m.generate(0, 4, 0, 1, mode="automatic", edge=0.5)
    m.cycle(10)
    assert (m.table("node")["KNZN"] > 0).sum() == 10
    m.save(tmp_path / "state.h5")
    runs = [m, Model.restore(tmp_path / "state.h5")]
    for one in runs:
        one.tell = heard.append
        one.delete(0, 4, 0, 0.5)
        assert one.check() == []
        one.cycle(10)
        assert len(one.table("element")) == 2 * (19 - 2)
        assert len(one.table("node")) == 2 * (20 - 2)
    assert "structures-removed" in [one.key for one in heard if hasattr(one, "key")]
    used = int(m.h.ci[g.MFREE]) - 1
    assert (runs[0].h.ia[:used] == runs[1].h.ia[:used]).all()


@pytest.mark.parametrize("words", [{"local": 0.8}, {"combined": 0.8}, {"kinetic": True}, {"adaptive": 1.0}])
@pytest.mark.parametrize("scaled", [False, True])
def test_every_damping_leads_to_the_same_state(words: dict[str, Any], scaled: bool) -> None:
    """A strut under its own weight between two walls: the moment in its middle."""
    m = room()
    m.sproperty(1, young=3e10, area=0.1, inertia=8e-5, density=2400, kn=1e10, ks=1e10, cohesion=1e9)
    m.beam(1, 3, 5, 3, segments=16)
    m.gravity(0, -10)
    m.fraction(0.5, safe=not scaled, scaled=scaled)
    m.damping(**words)
    m.solve(1e-6, 200_000)
    (solution,) = m.solutions()
    assert solution.reached
    nodes, middle = m.table("node"), m.table("element")[7]["KMM2"]
    at = np.column_stack([np.linspace(1, 5, 17), np.full(17, 3.0)])
    springs = np.where(nodes["KNBL"] > 0, 1e10 * nodes["KNLEN"], 0.0)
    moved = loaded_beam(3e10, 0.1, 8e-5, at, springs, 10 * nodes["KNM"])
    exact = element_matrix(3e10, 0.1, 8e-5, at[7], at[8]) @ moved[7:9].ravel()
    assert middle == pytest.approx(exact[5], rel=1e-4)
    assert nodes["KNY"] - 3 == pytest.approx(moved[:, 1], rel=1e-4)


def test_the_safe_step_allows_for_beams() -> None:
    """Just below the bound a stiff beam adds no energy, and the bound is less than twice too short."""
    m = hanging()
    m.sproperty(1, **STEEL | {"kn": 1e9, "ks": 1e9, "cohesion": 1e9})
    m.beam(2, 0.2, 2, 3.8, segments=12)
    m.cycle(0)
    for share, grows in ((0.99, False), (2.2, True)):
        one = copy.copy(m)
        one.fraction(share * bound(m.array).step / estimate(m.array).step)
        one.boundary(0, 4, 0, 1, xforce=1e3, yforce=-1e3)
        one.energy("on")
        if grows:
            with pytest.raises(UdecError) as raised:
                one.cycle(3000)
            assert raised.value.number in (36, 37)  # energy from nowhere, or too far away
        else:
            one.cycle(3000)
            assert abs(one.balance().residual) < 1e-6 * one.balance().throughput


def test_moments_are_drawn_on_the_side_in_tension() -> None:
    """Of a strut between walls: below in its middle, above at the walls."""
    m = room()
    m.sproperty(1, young=3e10, area=0.1, inertia=8e-5, density=2400, kn=1e10, ks=1e10, cohesion=1e9)
    m.beam(1, 3, 5, 3, segments=16)
    m.gravity(0, -10)
    m.solve(1e-4, static=True)
    left = structure_rows(m.h)["moment"]  # from left to right, the left side is above
    assert left[7, 1] < 0 < left[3, 1]
    assert left[1:, 0] == pytest.approx(left[:-1, 1], abs=1e-3 * np.abs(left).max())


def test_a_deck_with_beams_is_written_again(tmp_path: Path) -> None:
    m = room()
    m.out = tmp_path / "first"
    m.sproperty(1, **STEEL)
    m.cable(0.5, 5, 5.5, 5, segments=5, pretension=1e4)
    m.beam(around=(3, 3), segments=2, within=(0, 6, 2.5, 6))
    m.beam(1, 3, 5, 3)
    m.history(1, "KMFN", at=(3, 5))
    m.history(1, "KNY", at=(3, 3))
    m.cycle(20)
    m.plot(0, structures=True)
    text = m.print("elements", "nodes")
    assert "Elements: 19" in text
    again = Model(out=tmp_path)
    again.run(m.deck())
    for kind in ("element", "node"):
        assert (again.table(kind) == m.table(kind)).all()
    assert m.histories()[0].numbers[-1, 2] == m.table("element")["KMFN"][-3]


# ---- example decks


def test_bolts_hold_the_wedge_in_a_roof(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.run(EXAMPLES / "bolted-roof.dat")
    rows = m.table("bolt")
    (wedge,) = m.table("block")[m.table("block")["KBFIX"] == 0]
    upwards = (
        rows["KAFN"]
        * (rows["KAY2"] - rows["KAY1"])
        / np.hypot(rows["KAX2"] - rows["KAX1"], rows["KAY2"] - rows["KAY1"])
    )
    assert float(upwards.sum()) == pytest.approx(float(wedge["KBM"]) * 10, rel=0.01)


def test_a_lining_takes_what_is_relaxed_after_it(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.run(EXAMPLES / "lined-tunnel.dat", io.StringIO(), {"EDGE": 4, "RATIO": 1e-3})
    elements = m.table("element")
    lining = elements[elements["KMKIND"] == g.OF_BEAM]
    assert len(lining) == 48
    assert (lining["KMFN"] < 0).all()
    mean = -float(lining["KMFN"].mean())
    assert (
        0.1 * 2e6 * 3 < mean < 2e6 * 3
    )  # between a tenth and all of half of the mean stress times the radius
    assert m.check() == []


def test_structures_are_removed() -> None:
    """A strut holds a space open until it is removed; of a longer beam the elements in the range go."""
    m = room()
    m.sproperty(1, **STEEL)
    m.beam(2, 3, 4, 3, segments=8)
    m.cable(4.2, 3, 5.8, 3, segments=4)
    m.bolt(1, 1, 3, 1)
    m.cycle(5)
    heard: list[Any] = []
    m.tell = heard.append
    assert m.remove(10, 11, 10, 11) == 0
    assert m.remove(2.9, 4.1, 2, 4, beams=True) == 4
    left = m.table("element")
    assert (len(left), len(m.table("node"))) == (4 + 4, 5 + 5)
    assert m.check() == []
    assert m.remove(0, 6, 0, 6, bolts=True, cables=True) == 5
    assert (len(m.table("bolt")), len(m.table("element"))) == (0, 4)
    assert m.remove(0, 6, 0, 6) == 4
    assert len(m.table("node")) == 0
    m.cycle(5)
    assert m.check() == []
    assert np.abs(m.table("block")["KBFX"]).max() == 0
    assert "structures-removed" not in [one.key for one in heard if hasattr(one, "key")]
