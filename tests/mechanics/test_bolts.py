"""Bolts: springs between points of blocks that yield, break, and follow the blocks (docs/structures.md)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.kernels.drive.cycle import STRUCTURES, passes
from udec_ia.layout import offsets as g
from udec_ia.running.critical_step import bound

ALL = (-99.0, 99.0, -99.0, 99.0)
KINDS = ("rigid", "sdef", "fdef")
KN, KS = 1e7, 2e6


def separate_blocks(kind: str = "rigid", build: str = "i32r64") -> Model:
    """Two free blocks, 4 m by 1 m, 2 m from each other, and a fixed one far away; no gravity."""
    m = Model(build)
    m.tell = lambda _: None
    m.block(0, 0, 0, 4, 4, 4, 4, 0)
    m.split(-1, 1, 5, 1)
    m.split(-1, 3, 5, 3)
    m.round(0.05)
    m.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5, bulk=1e9, g=6e8)
    m.block(-20, -20, -20, -19, -19, -19, -19, -20)
    m.delete(-9, 9, 1, 3)
    m.fix(-30, -10, -30, -10)
    m.change(*ALL, type=kind)
    if kind == "fdef":
        m.generate(-9, 9, -9, 9, mode="automatic", edge=0.7)
        m.generate(*ALL, mode="automatic", edge=1.0)
    m.fraction(0.05, safe=True)
    return m


def hanging(kind: str = "rigid") -> Model:
    """A block, 4 m by 1 m and 8000 kg/m, 2 m below a fixed one."""
    m = separate_blocks(kind)
    m.fix(0, 4, 3, 4)
    return m


def throw(m: Model) -> None:
    """Velocities for the two free blocks: they part and turn."""
    for row in m.table("block"):
        if row["KX"] > 0:
            way = 1.0 if row["KY"] > 2 else -1.0
            a = row["address"]
            m.patch(f"block@{a}.KXD = {way}, block@{a}.KYD = {0.2 * way}, block@{a}.KTD = {0.3 - 0.2 * way}")
    for row in m.table("gridpoint"):
        if row["KXG"] > 0:
            way = 1.0 if row["KYG"] > 2 else -1.0
            turn, y = 0.3 - 0.2 * way, row["KYG"] - (3.5 if way > 0 else 0.5)
            u, v = way - turn * y, 0.2 * way + turn * (row["KXG"] - 2)
            m.patch(f"gridpoint@{row['address']}.KXDG = {u}, gridpoint@{row['address']}.KYDG = {v}")


def momentum(m: Model) -> Any:
    """Momentum in x and y, and angular momentum about the origin, of the free blocks."""
    rows = m.table("block")
    rows = rows[rows["KX"] > 0].astype([(name, float) for name in rows.dtype.names])
    x, y = rows["KBM"] * rows["KXD"], rows["KBM"] * rows["KYD"]
    turning = rows["KX"] * y - rows["KY"] * x + rows["KBI"] * rows["KTD"]
    return np.array([x.sum(), y.sum(), turning.sum()])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_momentum_and_energy_with_bolts_that_yield(kind: str, build: str) -> None:
    m = separate_blocks(kind, build)
    m.sproperty(1, kn=KN, ks=KS)
    m.sproperty(2, young=2e11, area=1e-4, ks=1e6, yield_force=3e4, shear_strength=1e4)
    m.bolt(0.5, 0.5, 0.7, 3.5)
    m.bolt(3.5, 0.5, 3.0, 3.4)
    m.bolt(2, 0.5, 2, 3.5, smaterial=2)
    m.cycle(1)
    throw(m)
    m.cycle(1)  # the words of a block with zones follow from its grid-points
    m.energy("on")
    before, digit = momentum(m), float(np.finfo(m.array.scheme.real_type).eps)
    m.cycle(1500)
    done = m.balance()
    size = 8000.0 * 4  # mass times velocity times the size of the model
    assert np.abs(momentum(m) - before).max() < 1500 * digit * size
    assert abs(done.residual) < 1e-5 * done.throughput
    assert done.yielding > 0.01 * done.throughput
    assert done.structures > 0
    rows = m.table("bolt")
    assert sorted(rows["KASTAT"].tolist())[:2] == [0, 0]
    assert max(rows["KASTAT"].tolist()) & (g.YIELDED | g.SHEARED)
    assert np.abs(rows["KAFN"][rows["KAMAT"] == 2]).max() <= 3e4 * (1 + 1e-6)
    assert m.check() == []


@pytest.mark.parametrize("kind", KINDS)
def test_the_axial_force_is_that_of_the_change_of_length(kind: str) -> None:
    m = separate_blocks(kind)
    m.sproperty(1, kn=KN)
    m.bolt(0.5, 0.5, 3.3, 3.4, pretension=1e4)
    m.cycle(1)
    throw(m)
    m.cycle(1000)
    (row,) = m.table("bolt")
    length = np.hypot(row["KAX2"] - row["KAX1"], row["KAY2"] - row["KAY1"])
    assert abs(length - row["KALEN"]) > 0.01
    assert row["KAFN"] == pytest.approx(1e4 + KN * (length - row["KALEN"]), rel=1e-7)
    assert row["KAFS"] == 0


@pytest.mark.parametrize("kind", KINDS)
def test_a_bolt_within_a_body_is_not_strained_by_motion(kind: str) -> None:
    """A point at a corner stays there, and a bolt in one rigid block has no force, however it turns."""
    m = separate_blocks(kind)
    m.sproperty(1, kn=KN, ks=KS)
    m.bolt(0, 0, 4, 1)
    m.cycle(1)
    throw(m)
    m.cycle(3000)
    (row,) = m.table("bolt")
    corners = m.table("corner")
    first, last = (
        np.hypot(corners["KXP"] - row[f"KAX{end}"], corners["KYP"] - row[f"KAY{end}"]).min() for end in (1, 2)
    )
    way = np.hypot(row["KAX1"], row["KAY1"])
    assert way > 0.05
    assert max(first, last) < (1e-6 if kind == "sdef" else 1e-12)
    if kind == "rigid":
        assert abs(row["KAFN"]) < 1e-13 * KN
        assert abs(row["KAFS"]) < 1e-13 * KN


@pytest.mark.parametrize("kind", KINDS)
def test_a_block_hangs_from_two_bolts(kind: str) -> None:
    m = hanging(kind)
    m.gravity(0, -10)
    m.sproperty(1, young=2e11, area=1e-4)
    for x in (1.0, 3.0):
        m.bolt(x, 0.5, x, 3.5)
    m.solve(1e-6, static=True)
    rows = m.table("bolt")
    assert rows["KAFN"] == pytest.approx([40e3, 40e3], rel=1e-4)
    stretched = np.hypot(rows["KAX2"] - rows["KAX1"], rows["KAY2"] - rows["KAY1"]) - 3
    assert stretched == pytest.approx(rows["KAFN"] * 3 / (2e11 * 1e-4), rel=1e-6)


def test_shear_is_that_of_the_middle_of_the_bolt() -> None:
    """Two rigid blocks held apart: one moves across, then turns about the middle of the bolt."""
    m = hanging()
    m.sproperty(1, ks=KS, kn=1.0)
    m.bolt(2, 0.5, 2, 3.5)
    m.boundary(0, 4, 0, 1, xvel=0.1, yvel=0, rotation=0)
    m.cycle(1)
    m.cycle(1000)
    moved = 0.1 * float(m.h.cd[g.TIME])
    (row,) = m.table("bolt")
    across = row["KAFS"] * (row["KAX2"] - row["KAX1"]) / 3  # its direction turns a little
    assert abs(row["KAFS"]) == pytest.approx(KS * moved, rel=2 * (moved / 3) ** 2)
    assert abs(across) < abs(row["KAFS"])


@pytest.mark.parametrize("broken", [False, True])
def test_a_bolt_that_is_pulled_yields_and_breaks(broken: bool) -> None:
    m = hanging()
    m.sproperty(1, kn=KN, ks=KS, yield_force=2e4, break_strain=0.01 if broken else 0.0)
    m.bolt(2, 0.5, 2, 3.5)
    m.energy("on")
    m.boundary(0, 4, 0, 1, xvel=0, yvel=-1, rotation=0)
    m.cycle(time=0.1)
    (row,) = m.table("bolt")
    pulled, elastic = float(m.h.cd[g.TIME]), 2e4 / KN
    step, done = float(m.h.cr[g.TDEL]), m.balance()
    if broken:
        assert row["KASTAT"] == g.YIELDED | g.BROKEN
        assert row["KAFN"] == 0
        assert row["KAPL"] == pytest.approx(0.03, abs=step)
        assert done.yielding == pytest.approx(2e4 * (0.03 + elastic / 2), abs=2 * 2e4 * step)
    else:
        assert row["KASTAT"] == g.YIELDED
        assert row["KAFN"] == pytest.approx(2e4)
        assert row["KAPL"] == pytest.approx(pulled - elastic, rel=1e-9)
        assert done.yielding == pytest.approx(2e4 * (pulled - elastic), rel=1e-3)
    assert abs(done.residual) < 1e-9 * done.throughput


def test_bolts_belong_to_what_is_there_after_each_command(tmp_path: Path) -> None:
    heard: list[Any] = []
    m = hanging()
    m.tell = heard.append
    m.sproperty(1, kn=KN, ks=KS)
    m.bolt(1, 0.5, 1, 3.5, pretension=1e3)
    m.bolt(3, 0.5, 3, 3.5)
    m.cycle(10)
    m.split(2, -1, 2, 1.5)
    assert len(set(m.table("bolt")["KAB1"].tolist())) == 2
    assert m.check() == []
    m.change(0, 4, 0, 1, type="fdef")
    m.generate(0, 4, 0, 1, mode="automatic", edge=0.5)
    assert (m.table("bolt")["KAZ1"] > 0).all()
    assert (m.table("bolt")["KAZ2"] == 0).all()
    m.cycle(10)
    m.save(tmp_path / "state.h5")
    runs = [m, Model.restore(tmp_path / "state.h5")]
    for one in runs:
        one.tell = heard.append
        one.delete(2, 4, 0, 1)
        one.cycle(10)
        assert len(one.table("bolt")) == 1
        assert one.check() == []
    assert "structures-removed" in [one.key for one in heard if hasattr(one, "key")]
    used = int(m.h.ci[g.MFREE]) - 1
    assert (runs[0].h.ia[:used] == runs[1].h.ia[:used]).all()


def test_force_sums_before_the_first_cycle_have_the_pretension() -> None:
    m = hanging()
    m.sproperty(1, kn=KN)
    m.bolt(2, 0.5, 2, 3.5, pretension=1e4)
    m.split(1, -1, 1, 1.5)
    below = m.table("block")
    pulled = below[np.abs(below["KBFY"]) > 0]
    assert sorted(pulled["KBFY"].tolist()) == pytest.approx([-1e4, 1e4])


@pytest.mark.parametrize("kind", KINDS)
def test_the_safe_step_allows_for_bolts(kind: str) -> None:
    """A block on stiff bolts stays stable just below the bound, and the bound is not far from the limit."""
    m = hanging(kind)
    m.sproperty(1, kn=1e11, ks=1e11)
    m.cycle(0)
    before = bound(m.array).step
    for x in (1.0, 3.0):
        m.bolt(x, 0.5, x, 3.5)
    m.fraction(0.99, safe=True)
    m.cycle(0)
    assert bound(m.array).step < before
    if kind == "rigid":
        limit = 2 / np.sqrt((2e11 + 2e11 * (1 + 1.5**2 / 1.0)) / 8000)  # more than axial, shear and turning
        assert bound(m.array).step > 0.3 * limit
    m.energy("on")
    m.boundary(0, 4, -0.1, 1.1, xforce=1e3, yforce=-1e3)
    m.cycle(3000)
    done = m.balance()
    assert abs(done.residual) < 1e-3 * done.throughput
    assert done.kinetic < 1.0


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (26, {"y1": 2.0}),
        (4, {"smaterial": 99}),
        (26, {"smaterial": 2}),
        (28, {"x1": 2.0, "y1": 3.5}),
        (28, {"pretension": -1.0}),
    ],
)
def test_refused_bolts_change_nothing(number: int, words: dict[str, Any]) -> None:
    m = hanging()
    m.sproperty(1, kn=KN)
    before = m.h.ia.copy()
    place = {"x1": 2.0, "y1": 0.5, "x2": 2.0, "y2": 3.5, **words}
    with pytest.raises(UdecError) as raised:
        m.bolt(**place)
    assert raised.value.number == number
    assert (m.h.ia == before).all()
    assert len(m.table("bolt")) == 0


def test_a_deck_with_bolts_is_written_again(tmp_path: Path) -> None:
    m = hanging()
    m.out = tmp_path / "first"
    m.sproperty(1, young=2e11, area=1e-4, yield_force=1e5)
    m.bolt(2, 0.5, 2, 3.5, pretension=2e4)
    m.history(1, "KAFN", at=(2, 2))
    m.cycle(20)
    m.plot(0, structures=True)
    text = m.deck()
    again = Model(out=tmp_path)
    again.run(text)
    assert "BOLT 2 0.5 2 3.5 PRETENSION 20000" in text
    assert (again.table("bolt") == m.table("bolt")).all()
    assert m.histories()[0].numbers[-1, 2] == m.table("bolt")["KAFN"][0]


def test_scenes_without_structures_do_not_run_the_pass() -> None:
    m = hanging()
    m.cycle(1)
    run = passes(m.h, None, (), -1.0, False, np.zeros(0, np.int8))
    assert run[STRUCTURES] == 0
