"""What SOLVE reports at its end is true: of what flies off, slips or opens, with scaled masses, too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.mechanics_scenes import block

from udec_ia import Model, UdecError
from udec_ia.layout.offsets import TIME


def stack(out: Path, n: int, width: float, height: float, *, kn: float, d: float) -> Model:
    """`n` blocks on each other on a fixed base."""
    m = Model(out=out)
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=kn, ks=kn / 2, friction=1.5, bulk=1e9, g=6e8)
    m.round(d)
    m.block(0, -height, 0, n * height, width, n * height, width, -height)
    for k in range(n):
        m.split(-1, k * height, width + 1, k * height)
    m.fix(0, width, -height, 0)
    m.gravity(0, -10)
    return m


def test_what_flies_off_gets_its_mass_back_and_no_energy(tmp_path: Path) -> None:
    """A light block on soft joints was held by few of its masses: with all of them it begins from rest."""
    m = stack(tmp_path, 3, 2.0, 4.0, kn=1e10, d=0.4)
    m.property(2, density=60000, kn=1e8, ks=5e7, friction=1.5)
    m.gravity(3, -10)
    m.change(0, 2, 0, 4, material=2)
    solution = m.solve(1e-4, limit=4000, static=True)
    assert not solution
    assert len(solution.fallen) >= 1


def test_a_criterion_is_a_word(tmp_path: Path) -> None:
    with pytest.raises(UdecError, match="MEAN or MAX"):
        stack(tmp_path, 2, 1.0, 1.0, kn=1e8, d=0.1).solve(1e-3, criterion=None)  # type: ignore[arg-type]


def test_the_word_that_was_typed_is_the_one_in_the_error(tmp_path: Path) -> None:
    with pytest.raises(UdecError) as caught:
        stack(tmp_path, 2, 1.0, 1.0, kn=1e8, d=0.1).run("FRACTION 2 SCALED\n")
    assert "FRACTION f SCALED" in f"{caught.value} {caught.value.advice}"


def opening(out: Path) -> Model:
    """An opening in 5 x 5 blocks, of joints that are far too rough to slip."""
    m = Model(out=out)
    m.tell = m.inform = lambda _: None
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=1e3)
    m.round(0.02)
    m.block(0, 0, 0, 5, 5, 5, 5, 0)
    for y in range(1, 5):
        m.split(-1, y, 6, y)
    for y in range(5):
        for x in np.arange(1 + y % 2 * 0.3, 5):
            m.split(x, y - 0.01, x, y + 1.01)
    for corner in (0, 4):
        m.fix(corner, corner + 1, 0, 5)
    m.fix(0, 5, 0, 1)
    m.delete(1, 3, 1, 3)
    return m


def test_shear_that_is_lost_as_contacts_open_is_told(tmp_path: Path) -> None:
    """Nothing slips, but gravity at once leaves other forces than gravity in ten steps."""
    forces, told = [], []
    for steps in (1, 10):
        m = opening(tmp_path)
        for k in range(1, steps + 1):
            m.gravity(0, -10 * k / steps)
            solution = m.solve(1e-5, static=True)
            assert solution
        contacts = m.table("contact")
        forces.append(float(np.sqrt((contacts["KCFN"] ** 2 + contacts["KCFS"] ** 2).sum())))
        told.append(solution.keys)
    assert abs(forces[0] / forces[1] - 1) > 0.01
    assert told == [("joints-slipped",), ()]


def test_what_slipped_in_a_cycle_before_is_not_forgotten(tmp_path: Path) -> None:
    """Whether SOLVE runs all the way or a CYCLE goes before it; and rest begins anew what counts."""
    states = []
    for before in (0, 400):
        m = stack(tmp_path, 2, 2.0, 1.0, kn=1e8, d=0.05)
        m.property(1, friction=0.3)
        m.gravity(2.9, -10)
        m.fraction(0.3, safe=True)
        m.damping(local=0.8)
        m.cycle(before)
        states.append(m.solve(1e-4).keys)
        states.append(m.solve(1e-4).keys)
    assert states == [("joints-slipped",), (), ("joints-slipped",), ()]


@pytest.mark.parametrize("what", ["gravity", "force", "strength"])
def test_a_function_that_goes_on_is_reported(what: str, tmp_path: Path) -> None:
    """Not when it has come to its last value, nor if nothing follows it."""
    m = stack(tmp_path, 2, 1.0, 1.0, kn=1e8, d=0.05)
    m.damping(local=0.8)
    m.function(1, 0.0, 0.5, 10.0, 1.0, 20.0, 1.0)
    assert m.solve(1e-3).keys == ()
    if what == "gravity":
        m.gravity(0, -10, function=1)
    elif what == "force":
        m.boundary(0, 1, 1, 2, yforce=-1e4, function=1)
    else:
        m.property(1, friction=0.6, function=1)
    solution = m.solve(1e-3)
    assert solution.reached
    assert solution.keys == ("function-goes-on",)
    assert "FUNCTION goes on" in solution.short
    m.cycle(time=10.0 - float(m.h.cd[TIME]))
    assert m.solve(1e-3).keys == ()


HANGING = """START
PROP MAT=1 DENSITY=2600 KN=1E10 KS=1E10 FRICTION=0.6
BLOCK 0,0 0,3 10,3 10,0
SPLIT -1,1 11,1
SPLIT 4.5,-1 4.5,4
SPLIT 5.5,-1 5.5,4
SPLIT 4.4,2 5.6,2
ROUND 0.05
FIX 0 10 0 1
BOUNDARY 0 4 1 3 YFORCE -1E8
BOUNDARY 6 10 1 3 YFORCE -1E8
GRAVITY 0 -10
DELETE 4.5 5.5 1 2
"""


def test_a_block_whose_contacts_carry_nothing_has_fallen(tmp_path: Path) -> None:
    """Its weight is little against the forces beside it, so that the ratio is reached before it moves."""
    m = Model(out=tmp_path)
    m.run(HANGING)
    roof = int(block(m, 5, 2.5)["address"])
    solution = m.solve(1e-3, static=True)
    assert solution.reached
    assert solution.fallen == (roof,)
    assert "blocks-fallen" in solution.keys


def test_a_block_that_boundary_conditions_carry_has_not_fallen(tmp_path: Path) -> None:
    """A zoned block hangs from its top, so that it becomes narrower and its contact has no force."""
    m = Model(out=tmp_path)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.split(1, -1, 1, 2)
    m.fix(1, 2, 0, 1)
    m.change(0, 1, 0, 1, type="fdef")
    m.generate(0, 1, 0, 1, "automatic", edge=0.5)
    m.boundary(-0.1, 1.1, 0.9, 1.1, xvel=0, yvel=0)
    m.gravity(0, -10)
    solution = m.solve(1e-3, static=True)
    assert solution.reached
    assert not m.table("contact")["KCFN"].any()
    assert solution.fallen == ()
