"""Joints in decks as engineers write them: walls, two materials, a jointed roof, a platen."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

WALLS = """START
PROP MAT=1 DENS=2500 BULK=5E9 G=3E9 KN=1E9 KS=1E9 F=0.6
{joint}
BLOCK 0,0 0,1 6,1 6,0
SPLIT 1,-1 1,2
SPLIT 2,-1 2,2
SPLIT 3,-1 3,2
SPLIT 4,-1 4,2
SPLIT 5,-1 5,2
FIX 0 1 0 1
FIX 5 6 0 1
CHANGE 1 5 0 1 SDEF
ROUND 0.05
INSITU 1 5 0 1 -1E6 0 0
"""


@pytest.mark.parametrize("joint", ["", "JPROPERTY JMATERIAL=1 KN=1E9 KS=1E9 F=0.6 BETWEEN 1 1"])
def test_stress_between_fixed_walls_stays(joint: str) -> None:
    """Four blocks between two fixed ones, by the joints of 1980 and by those per length."""
    m = Model()
    m.run(WALLS.format(joint=joint))
    m.solve(1e-6, static=True)
    assert m.table("sdef")["KS111"] == pytest.approx(-1e6, rel=1e-6)
    joints = m.table("contact")
    across = joints["KCFN"][(joints["KXC"] > 0.9) & (joints["KXC"] < 1.1)]
    assert across.sum() == pytest.approx(1e6, rel=1e-6)


def test_a_joint_between_two_materials_is_one_joint() -> None:
    """A block of material 1 between a floor and a roof of material 2; PRINT shows the joint material."""
    deck = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5
PROP MAT=2 DENS=2000 KN=1E8 KS=1E8 F=0.0
{joint}
BLOCK 0,0 0,3 4,3 4,0
SPLIT -1,1 5,1
SPLIT -1,2 5,2
SPLIT 1,1 1,2
SPLIT 3,1 3,2
DELETE 0 1 1 2
DELETE 3 4 1 2
CHANGE 0 4 0 1 MATERIAL=2
CHANGE 0 4 2 3 MATERIAL=2
FIX 0 4 0 1
FIX 0 4 2 3
ROUND 0.1
GRAVITY 6 -10
CYCLE 100
"""
    m = Model()
    m.run(deck.format(joint="JPROPERTY JMATERIAL=1 KN=1E8 KS=1E8 F=0.4 BETWEEN 1 2"))
    joints, contacts = m.table("joint"), m.table("contact")
    assert (joints["KCJMAT"] == 1).all()
    on_floor = contacts["KYC"] < 1.5
    shear, normal = contacts["KCFS"][on_floor].sum(), contacts["KCFN"][on_floor].sum()
    assert abs(shear) == pytest.approx(0.4 * normal, rel=1e-6)  # it slides


def test_stress_stays_in_a_roof_of_two_joint_sets() -> None:
    """Joints at 45 and 351 degrees, 5 m apart; -24 MPa with a gradient. Nothing moves on release."""
    m = Model()
    m.property(1, density=3000, bulk=3.906e10, g=3.178e10, kn=5e10, ks=5e10, friction=0.577)
    m.jproperty(1, kn=5e10, ks=5e10, friction=0.9, cohesion=5e6, between=(1, 1))
    m.block(-25, -20, -25, 20, 25, 20, 25, -20)
    for angle in (45, 351):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        for k in range(-9, 10):
            x, y = -s * 5 * k, c * 5 * k
            with suppress(UdecError):  # some miss the block
                m.split(x - 60 * c, y - 60 * s, x + 60 * c, y + 60 * s)
    assert len(m.table("block")) > 80
    m.change(-25, 25, -20, 20, "sdef")
    m.round(0.05)
    stress, gradient = -24e6, 0.03e6
    m.insitu(-25, 25, -20, 20, stress, 0, stress, ygrad=(gradient, 0, gradient))
    for x in (-25, 25):
        m.boundary(x - 0.1, x + 0.1, -20.1, 20.1, stress=(stress, 0, stress), ygrad=(gradient, 0, gradient))
    for y in (-20, 20):
        m.boundary(-25.1, 25.1, y - 0.1, y + 0.1, stress=(stress, 0, stress), ygrad=(gradient, 0, gradient))
    m.gravity(0, -10)
    before = m.table("block")
    m.cycle(500)
    after = m.table("block")
    moved = np.hypot(after["KX"] - before["KX"], after["KY"] - before["KY"]).max()
    elastic = abs(stress) / 5.3e10 * 40  # of the whole mass
    assert moved < 1e-6 * elastic
    by_extension = {int(row["address"]): float(row["KS122"]) for row in m.table("sdef")}
    found = np.array([by_extension[int(row["KBEX"])] for row in after])
    assert found == pytest.approx(stress + gradient * after["KY"], rel=1e-6)


def test_a_fixed_platen_moves_as_it_is_driven() -> None:
    m = Model()
    m.run("""START
PROP MAT=1 DENS=2000 KN=1E9 KS=1E9 F=0.5
BLOCK 0,0 0,3 6,3 6,0
SPLIT -1,1 7,1
SPLIT -1,2 7,2
FIX 0 6 0 1
GRAVITY 0 -10
ROUND 0.05
DAMP LOCAL 0.8
CYCLE 500
""")
    before, time = m.table("block"), float(m.h.cd[g.TIME])
    m.run("BOUNDARY 2.9 3.1 0.4 0.6 XVEL 0.01\nCYCLE 1000")
    after = m.table("block")
    platen = before["KY"].argmin()
    assert after["KX"][platen] - before["KX"][platen] == pytest.approx(
        0.01 * (float(m.h.cd[g.TIME]) - time), rel=1e-2
    )
    assert (after["KX"] > before["KX"]).all()  # it takes the others along
