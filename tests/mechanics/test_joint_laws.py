"""Laws of the user on joint materials: what they get and return, energy, memory, restart and errors."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

KN, KS, FRICTION, COHESION, DECAY = 1e9, 5e8, 0.5, 2e5, 1e-3
LENGTH = 4.0


def weakening(sn, ts, dun, dus, un, us, v1, v2, v3, m):  # type: ignore[no-untyped-def]
    """Cohesion that falls with the sum of the slips; v1 is that sum, v2 the largest closure."""
    sn = max(m.kn * (un + dun), 0.0)
    trial = ts + m.ks * dus
    limit = sn * m.friction + m.cohesion * math.exp(-v1 / m.p1)
    ts = max(-limit, min(limit, trial)) if sn > 0 else 0.0
    return sn, ts, v1 + abs(trial - ts) / m.ks, max(v2, un + dun), 0.0


def coulomb(sn, ts, dun, dus, un, us, v1, v2, v3, m):  # type: ignore[no-untyped-def]
    """The built-in model without tension."""
    sn = m.kn * (un + dun)
    if sn <= 0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    trial = ts + m.ks * dus
    limit = m.cohesion + m.friction * sn
    return sn, max(-limit, min(limit, trial)), 0.0, 0.0, 0.0


def glue(sn, ts, dun, dus, un, us, v1, v2, v3, m):  # type: ignore[no-untyped-def]
    """Springs that hold tension, without end."""
    return m.kn * (un + dun), ts + m.ks * dus, 0.0, 0.0, 0.0


def box(law: Callable[..., Any] | None, build: str = "i32r64", **joint: Any) -> Model:
    """A block LENGTH wide and 1 high on a fixed one; joint 1 has the law, or the built-in model."""
    m = Model(build, constitutive={"jl2": law} if law else None)
    m.property(1, density=2000)
    given = {"kn": KN, "ks": KS, "friction": FRICTION, "cohesion": COHESION} | joint
    m.jproperty(1, model="jl2" if law else "coulomb", **given)
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1, jmaterial=1)
    m.fix(0, LENGTH, 0, 1)
    m.round(0.05)
    m.energy("on")
    return m


def test_the_law_gets_what_the_last_step_left(tmp_path: Path) -> None:
    """Each step again in Python: stresses and kept numbers, to rounding; the block is driven to and fro."""
    m = box(weakening, p1=DECAY)
    keeps = dict.fromkeys(("sn", "ts", "un", "us", "v1", "v2"), 0.0)

    class material:  # noqa: N801
        kn, ks, friction, cohesion, p1 = KN, KS, FRICTION, COHESION, DECAY

    slid = 0.0
    for xvel, yvel in ((0, -2e-3), (0.02, 0), (-0.02, -1e-3), (0.01, 3e-3), (0.02, -2e-3)):
        m.boundary(1, 3, 1.4, 1.6, xvel=xvel, yvel=yvel, rotation=0.0)
        for _ in range(150):
            m.cycle(1)
            contact, joint = m.table("contact")[0], m.table("joint")[0]
            un, us = float(contact["KCN"] + joint["KCJOFF"]), float(contact["KCS"])
            sn, ts, v1, v2, _ = weakening(
                keeps["sn"], keeps["ts"], un - keeps["un"], us - keeps["us"], keeps["un"], keeps["us"],
                keeps["v1"], keeps["v2"], 0.0, material,
            )  # fmt: skip
            found = [float(joint[name]) for name in ("KCJSN", "KCJTS", "KCJV1", "KCJV2")]
            assert found == pytest.approx([sn, ts, v1, v2], rel=1e-9, abs=1e-9)
            keeps = dict(zip(keeps, (found[0], found[1], un, us, found[2], found[3]), strict=True))
        slid = max(slid, keeps["v1"])
    assert slid > DECAY  # the cohesion has fallen to a third
    balance = m.balance()
    assert abs(balance.residual) < 1e-5 * balance.throughput
    assert m.check() == []


@pytest.mark.parametrize(("cohesion", "gravity"), [(0.0, (8, -10)), (2e3, (4, -10))])
@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_coulomb_as_a_law_is_the_built_in_model(
    build: str, cohesion: float, gravity: tuple[float, float]
) -> None:
    """A block that slides down a slope, and without cohesion rocks: all agrees to rounding."""
    results = []
    for law in (coulomb, None):
        m = box(law, build, cohesion=cohesion, friction=0.3)
        m.gravity(*gravity)
        if cohesion > 0:  # it does not open at one end
            m.damping(local=0.8)
        m.cycle(300)
        rows = m.table("joint")
        fields = [*rows["KCJSN"], *rows["KCJTS"], *rows["KCJSLIP"], *m.table("block")["KX"]]
        results.append([*fields, m.balance().friction])
    assert np.abs(results[1][-1]) > 0
    rel = 1e-9 if build == "i32r64" else 1e-3
    scale = np.maximum(np.abs(results[1]), 1e-6)
    assert np.abs(np.subtract(*results) / scale).max() < rel


def test_a_law_may_hold_tension() -> None:
    """A block hangs from a fixed one: W/KN L, and its energies balance."""
    m = Model(constitutive={"jl3": glue})
    m.property(1, density=2000)
    m.jproperty(1, model="jl3", kn=KN, ks=KS, tension=1e6)
    m.block(0, 0, 0, 2, LENGTH, 2, LENGTH, 0)
    m.split(-1, 1, LENGTH + 1, 1, joint=1, jmaterial=1)
    m.fix(0, LENGTH, 1, 2)
    m.round(0.05)
    m.gravity(3, -10)
    m.damping(local=0.8)
    m.energy("on")
    m.cycle(2000)
    joints = m.table("joint")
    assert joints["KCJSN"].mean() == pytest.approx(-2000 * 10.0, rel=1e-6)
    assert abs(joints["KCJTS"].mean()) == pytest.approx(2000 * 3.0, rel=1e-5)
    assert not (joints["KCJFLAG"] & g.JOINT_BROKEN).any()
    balance = m.balance()
    assert abs(balance.residual) < 1e-4 * balance.throughput


def test_saved_and_continued_is_the_same(tmp_path: Path) -> None:
    """The file names the law; without it CYCLE has error 9."""
    m = box(weakening, p1=DECAY)
    m.gravity(8, -10)
    m.cycle(200)
    file = m.save(tmp_path / "half.h5")
    m.cycle(200)
    other = Model(constitutive={"jl2": weakening})
    other.restart(file)
    other.cycle(200)
    for name in ("joint", "contact", "block"):
        assert (other.table(name) == m.table(name)).all()
    lost = Model()
    lost.restart(file)
    with pytest.raises(UdecError) as raised:
        lost.cycle(1)
    assert raised.value.number == 9
    assert "jl2" in str(raised.value)


def test_errors_of_a_law() -> None:
    def wrong(sn, ts, dun, dus, un, us, v1, v2, v3, m):  # type: ignore[no-untyped-def]
        return m.kn * (un + dun), math.nan if abs(us) > 1e-3 else 0.0, 0.0, 0.0, 0.0

    def short(sn, ts, dun, dus, un, us, m):  # type: ignore[no-untyped-def]
        return sn, ts

    m = box(wrong)
    m.gravity(8, -10)
    with pytest.raises(UdecError) as raised:
        m.cycle(5000)
    assert raised.value.number == 35
    assert "jl2" in str(raised.value)
    assert "joint material 1" in str(raised.value)
    assert m.check() == []
    assert np.isfinite(m.table("joint")["KCJTS"]).all()
    with pytest.raises(UdecError) as raised:
        Model(constitutive={"jl2": short})
    assert raised.value.number == 34
    m = box(None)
    m.jproperty(1, model="jl2")
    with pytest.raises(UdecError) as raised:
        m.cycle(1)
    assert raised.value.number == 9
