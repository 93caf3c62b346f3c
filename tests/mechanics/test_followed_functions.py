"""GRAVITY and PROPERTY that follow a FUNCTION, against sums and limits by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from naive.bodies import momentum
from support.lone_block_loads import SKEW, TYPES, lone
from support.mechanics_scenes import block, on_base, sound

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

POINTS = (0.0, 0.5, 0.002, 2.0, 0.003, 0.25, 0.0045, 1.0)


def halfway(m: Model, n: int) -> Any:
    """Factors of the function above in the middle of the next `n` steps."""
    t = float(m.h.cd[g.TIME]) + float(m.h.cr[g.TDEL]) * (np.arange(n) + 0.5)
    return np.interp(t, POINTS[::2], POINTS[1::2])


@pytest.mark.parametrize("kind", TYPES)
def test_gravity_gives_the_impulse_of_its_history(kind: str) -> None:
    m = lone(kind, SKEW)
    m.fraction(0.05)
    m.cycle(0)
    m.function(7, *POINTS)
    m.gravity(2.0, -10.0, function=7)
    n = int(6e-3 / float(m.h.cr[g.TDEL]))
    mass = float(m.table("block")["KBM"][0])
    impulse = mass * (halfway(m, n) * float(m.h.cr[g.TDEL])).sum()
    m.cycle(n)
    total, _ = momentum(m)
    np.testing.assert_allclose(total[:2], np.array([2.0, -10.0]) * impulse, rtol=n * 1e-15)
    m.gravity(0.0, 0.0)
    assert len(m.table("follower")) == 0
    m.cycle(3)
    np.testing.assert_allclose(momentum(m)[0], total, rtol=1e-13)
    sound(m)


@pytest.mark.parametrize("kind", TYPES)
def test_the_energy_of_gravity_that_changes_balances(kind: str) -> None:
    """A block that stays on its base, and swings under a weight that grows and shrinks."""
    m = on_base(1.0, 1.0, 0.1, 4.0, fraction=0.05)
    m.property(1, bulk=1e9, g=6e8)
    if kind == "sdef":
        m.change(-0.4, 0.4, 0, 1, "sdef")
    elif kind == "zoned":
        m.generate(-0.4, 0.4, 0, 1, "automatic", edge=0.6)
    m.damping(local=0.8)
    m.solve(1e-6)
    m.damping(0.0, 1.0)
    m.reset("time")
    m.function(1, 0.0, 1.0, 0.01, 1.3, 0.03, 0.6)
    m.gravity(0.0, -10.0, function=1)
    m.energy()
    m.cycle(time=0.05)
    account = m.balance()
    assert account.potential != 0
    assert abs(account.residual) < 1e-8 * account.throughput
    sound(m)


def test_friction_that_decreases_lets_a_block_slide_at_its_limit() -> None:
    """A force of 0.4 weights holds as long as the friction 0.5 f is above that; then v' = g (0.4 - 0.5 f)."""
    width, height = 4.0, 0.2
    m = on_base(width, height, 0.02, 9.0, friction=0.5, fraction=0.2)
    weight = 1000 * width * height * 10.0
    m.boundary(-1, 1, 0, height, xforce=0.4 * weight)
    m.damping(local=0.8)
    m.solve(1e-7)
    m.damping(0.0, 1.0)
    m.reset("time")
    slope = 0.5
    m.function(2, 0.0, 1.0, 1.0, 1.0 - slope)
    m.property(1, friction=0.5, function=2)
    start = float(block(m, 0, 0.1)["KX"])
    limit = 0.2 / slope  # s
    m.cycle(time=0.97 * limit)
    elastic = 0.4 * weight / (2 * 1e8)
    assert abs(float(block(m, 0, 0.1)["KX"]) - start) < elastic
    m.cycle(time=0.33 * limit)
    t = float(m.h.cd[g.TIME])
    assert float(m.h.cr[g.AMU]) == pytest.approx(
        0.5 * (1 - slope * (t - float(m.h.cr[g.TDEL]) / 2)), rel=1e-12
    )
    contacts = m.table("contact")
    closed = contacts[contacts["KCFN"] > 0]
    np.testing.assert_allclose(np.abs(closed["KCFS"]), float(m.h.cr[g.AMU]) * closed["KCFN"], rtol=1e-12)
    expected = 10.0 * 0.5 * slope * (t - limit) ** 2 / 2
    assert float(block(m, 0, 0.1)["KXD"]) == pytest.approx(expected, rel=0.02)


def test_a_property_that_is_given_again_is_constant() -> None:
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.5)
    m.function(1, 0.0, 0.5)
    m.property(1, friction=0.8, cohesion=100.0, function=1)
    assert (float(m.h.cr[g.AMU]), float(m.h.cr[g.COH])) == (0.4, 50.0)
    m.property(1, friction=0.7)
    m.function(1, 0.0, 0.25)
    m.cycle(2)
    assert (float(m.h.cr[g.AMU]), float(m.h.cr[g.COH])) == (0.7, 25.0)
    assert "COH(1)" in m.print("functions")
    assert "AMU" not in m.print("functions")


@pytest.mark.parametrize(
    ("given", "number", "parameter"),
    [
        ({"kn": 1e8, "function": 1}, 10, "kn"),
        ({"density": 1e3, "function": 1}, 10, "density"),
        ({"friction": 0.5, "function": 9}, 26, "function"),
        ({"friction": 0.5, "function": 2}, 28, "function"),
        ({"function": 1}, 26, ""),
    ],
)
def test_what_cannot_follow_is_refused(given: dict[str, Any], number: int, parameter: str) -> None:
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.3)
    m.function(1, 0.0, 1.0)
    m.function(2, 0.0, 1.0, 1.0, -1.0)
    before = [part.tobytes() for part in m.array.h[:4]]
    with pytest.raises(UdecError) as caught:
        m.property(1, **given)
    assert (caught.value.number, caught.value.parameter) == (number, parameter)
    assert [part.tobytes() for part in m.array.h[:4]] == before
    m.property(1, friction=0.5, function=1)
    with pytest.raises(UdecError) as caught:
        m.function(1, 0.0, 1.0, 1.0, -0.5)
    assert caught.value.number == 28


def test_a_command_that_fails_is_undone_with_its_followers() -> None:
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.3)
    m.function(1, 0.0, 1.0)
    before = m.h.ia.tobytes(), m.h.cr.tobytes()

    def both() -> None:
        m.gravity(0.0, -5.0, function=1)
        m.property(1, friction=0.5, function=1)
        raise ValueError

    with pytest.raises(ValueError, match=r"^$"):
        m.whole(both)
    used = int(m.h.ci[g.MFREE]) - 1
    assert (m.h.ia[:used].tobytes(), m.h.cr.tobytes()) == (before[0][: m.h.ia[:used].nbytes], before[1])
    assert m.check() == []


def test_strength_of_a_joint_material_follows_a_function() -> None:
    """Friction and cohesion fall: the block slides when c L + f W tan = H, at that time; stiffness cannot."""
    m = Model()
    m.property(1, density=1000)
    m.jproperty(1, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 2, 4, 2, 4, 0)
    m.split(-1, 1, 5, 1, joint=1, jmaterial=1)
    m.fix(0, 4, 0, 1)
    m.round(0.02)
    m.gravity(3, -10)
    m.function(2, 0.0, 1.0, 2.0, 0.2)
    for name in ("kn", "ks", "dilation"):
        with pytest.raises(UdecError) as raised:
            m.jproperty(1, **{name: 1e8}, function=2)
        assert raised.value.number == 10
    m.jproperty(1, friction=0.5, cohesion=4e3)
    m.damping(local=0.8)
    m.solve(1e-6)
    m.reset("time")
    m.jproperty(1, friction=0.5, cohesion=4e3, function=2)
    weight, push, length = 4e4, 1.2e4, 4.0
    factor = push / (0.5 * weight + 4e3 * length)
    begins = (1 - factor) / 0.4
    m.cycle(time=begins - 0.02)
    assert not (m.table("joint")["KCJFLAG"] & g.JOINT_SLIPS).all()
    x = m.table("block")["KX"].max()
    m.cycle(time=0.05)
    assert (m.table("joint")["KCJFLAG"] & g.JOINT_SLIPS).all()
    assert m.table("block")["KX"].max() != x
    m.jproperty(1, friction=0.5, cohesion=4e3)
    assert len(m.table("follower")) == 0
    sound(m)
