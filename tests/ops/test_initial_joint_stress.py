"""INSITU for joints: a jointed mass under a stress field with gradient and gravity does not move."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.layout import offsets as g

STRESS, GRADIENT, DENSITY, YOUNG = (-2e6, 0.3e6, -3e6), (12500.0, 0.0, 25000.0), 2500.0, 8e9
CUTS = (
    (-1, -1.5, 9, 8.5),
    (-1, 2.0, 9, 12),
    (-1, 5, 9, -5),
    (-1, 9, 9, -1),
    (3.1, -1, 3.3, 7),
    (-1, 2.9, 9, 3.1),
)
EDGES = (
    (-0.05, 0.05, -0.05, 6.05),
    (7.95, 8.05, -0.05, 6.05),
    (-0.05, 8.05, -0.05, 0.05),
    (-0.05, 8.05, 5.95, 6.05),
)


def mass(kind: str, per_length: bool) -> Model:
    """18 blocks cut by oblique joints; those with zones have unlike meshes. The field balances gravity."""
    m = Model()
    m.property(1, density=DENSITY, bulk=5e9, g=3e9, kn=1e9, ks=1e9, friction=0.9)
    if per_length:
        m.jproperty(1, kn=1e10, ks=1e10, friction=0.9, between=(1, 1))
    m.block(0, 0, 0, 6, 8, 6, 8, 0)
    for cut in CUTS:
        m.split(*cut)
    m.round(0.02)
    if kind == "sdef":
        m.change(0, 8, 0, 6, type="sdef")
    for k in range(int(m.h.ci[g.NBLK])) if kind == "fdef" else ():
        m.generate(0, 8, 0, 6, "automatic", edge=0.7 + 0.13 * k)
    m.gravity(0, -10)
    for one in EDGES:
        m.boundary(*one, stress=STRESS, ygrad=GRADIENT)
    return m


@pytest.mark.parametrize("unit", [None, "length", "ends"])
@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_nothing_moves_on_release(kind: str, unit: str | None) -> None:
    """By less than 1e-6 of the elastic displacement, s L/E."""
    m = mass(kind, unit is not None)
    if unit is not None:
        m.jproperty(1, unit=unit)
    assert m.insitu(0, 8, 0, 6, *STRESS, ygrad=GRADIENT) == len(m.table("block")) == 18
    assert m.check() == []
    before = m.table("corner")
    m.cycle(300)
    after = m.table("corner")
    moved = max(np.abs(after[name] - before[name]).max() for name in ("KXP", "KYP"))
    assert moved < 1e-6 * -STRESS[2] * 8 / YOUNG
    assert m.check() == []


def test_joints_between_fixed_walls_keep_their_stress() -> None:
    """Four blocks in a row, INSITU of -1 MPa along it: 1 MPa stays, with joints as in 1980."""
    m = Model()
    m.property(1, density=2500, bulk=5e9, g=3e9, kn=1e9, ks=1e9, friction=0.6)
    m.block(0, 0, 0, 1, 6, 1, 6, 0)
    for x in range(1, 6):
        m.split(x, -1, x, 2)
    m.fix(0, 1, 0, 1)
    m.fix(5, 6, 0, 1)
    m.change(1, 5, 0, 1, type="sdef")
    m.round(0.05)
    m.insitu(1, 5, 0, 1, -1e6, 0, 0)
    assert m.solve(1e-6, static=True).reached
    assert m.table("sdef")["KS111"] == pytest.approx(-1e6, rel=1e-9)
    assert m.table("contact")["KCFN"] == pytest.approx(5e5, rel=1e-9)


def test_what_joints_cannot_carry_is_reported(caplog: pytest.LogCaptureFixture) -> None:
    """A shear stress beyond friction, and a tension."""
    m = mass("sdef", True)
    m.insitu(0, 8, 0, 6, 1e5, 0, -3e6)
    keys = [getattr(record.msg, "key", "") for record in caplog.records]
    assert "initial-stress-exceeds-joints" in keys


def test_a_restart_changes_no_bit(tmp_path: Path) -> None:
    m = mass("fdef", True)
    m.insitu(0, 8, 0, 6, *STRESS)  # without the gradient: it moves
    m.cycle(50)
    m.save(tmp_path / "a.h5")
    m.cycle(50)
    other = Model()
    other.restart(tmp_path / "a.h5")
    other.cycle(50)
    used = int(m.h.ci[g.MFREE]) - 1
    assert np.array_equal(m.h.ia[:used], other.h.ia[:used])
