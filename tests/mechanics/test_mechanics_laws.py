"""Contacts that follow laws of the user's, in whole models."""

from __future__ import annotations

from math import cos, pi, radians, sin, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.relocate import differences, essence
from support.interpreted_kernels import both_ways
from support.mechanics_scenes import G, at, block, no_damping, on_base, push, sound, step
from test_mechanics_energy import cycle_and_energy

from udec_ia import Model
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.errors import UdecError
from udec_ia.layout.offsets import NERR, WFRIC

ROOT = Path(__file__).parents[2]
B, H, D = 2.0, 1.0, 0.1
MASS = 1000.0 * B * H
KN, KS = 1e9, 4e8


def resting(law: Any, **numbers: Any) -> Model:
    """A block settled on its two contacts on a long base."""
    m = on_base(B, H, D, 12.0, stiffness=(KN, KS), law=law, **numbers)
    m.damping(1.0, (2 * KN / MASS) ** 0.5 / (2 * pi), "mass")
    m.cycle(400)
    return m


def coulomb(fn: Any, fs: Any, dun: Any, dus: Any, un: Any, us: Any, m: Any) -> Any:
    """Constitutive number 1, as a user would write it."""
    normal, shear = fn + m.kn * dun, fs + m.ks * dus
    most = m.cohesion + m.friction * normal
    return normal - fn, min(most, max(-most, shear)) - fs


@pytest.mark.parametrize("law", [{"clj2": coulomb}, "joint-dilation"])
def test_coulombs_law_of_the_user_is_number_1(law: Any) -> None:
    """A block thrown along the base slides, rocks and stops: with a law of its own as with number 1.

    A law returns differences, which round differently: each cycle may turn the last digit of a force F over,
    which moves a block of mass M by F eps/M dt t in the rest of the time t.
    """
    rows = []
    for given in (None, law):
        m = resting(given, friction=0.4)
        no_damping(m)
        push(m, block(m, 0, H / 2)["address"], xd=1.0)
        m.cycle(1000)
        rows.append(block(m, 0.1, H / 2))
    assert rows[0]["KX"] > 0.05
    t, eps = 1000 * step(m), float(np.finfo(float).eps)
    slack = 1000 * (10 * MASS * G * eps / MASS) * step(m) * t
    for name in ("KX", "KY", "KTD"):
        assert rows[1][name] == pytest.approx(rows[0][name], abs=slack)


def test_a_block_rises_on_joints_that_dilate() -> None:
    """Drawn by more than the critical slip it rises by DILATION CRITICAL, ten times what it had sunk in.

    The contacts then bear the weight across a gap.
    """
    dilation, critical = 0.1, 1e-3
    m = resting("joint-dilation", friction=0.5)
    m.property(1, dilation=dilation, critical_slip=critical, residual_friction=0.5)
    before = block(m, 0, H / 2)
    assert m.table("contact")["KCN"].max() == pytest.approx(dilation * critical / 10, rel=1e-6)
    m.gravity(8.0, -G)
    m.cycle(4000)
    m.gravity(0.0, -G)
    m.cycle(1000)
    after, contacts = at(m, "block", before["address"]), m.table("contact")
    assert after["KX"] - before["KX"] > 2 * critical
    assert after["KY"] - before["KY"] == pytest.approx(dilation * critical, rel=1e-6)
    closed = contacts[contacts["KCFN"] > 0]
    assert closed["KCFN"].sum() == pytest.approx(MASS * G, rel=1e-6)
    assert closed["KCN"].max() < 0
    sound(m)


def test_peak_and_residual_strength_on_an_incline() -> None:
    """Between its two friction angles a block rests, and once pushed over the critical slip slides away.

    Its acceleration is then g (sin psi - RFRICTION cos psi), less the friction of what normal velocity the
    forces had to change meanwhile.
    """
    psi, peak, residual = radians(25), tan(radians(30)), tan(radians(15))
    m = resting("joint-dilation", friction=peak)
    m.property(1, critical_slip=1e-3, residual_friction=residual)
    address = block(m, 0, H / 2)["address"]
    m.gravity(G * sin(psi), -G * cos(psi))
    m.cycle(1000)
    start = at(m, "block", address)
    m.cycle(1000)
    assert at(m, "block", address)["KX"] == pytest.approx(start["KX"], abs=1e-9)
    no_damping(m)
    push(m, address, xd=0.5)
    m.cycle(1000)
    one = at(m, "block", address)
    assert one["KX"] - start["KX"] > 2e-3
    m.cycle(1000)
    two = at(m, "block", address)
    t = 1000 * step(m)
    fall = G * (sin(psi) - residual * cos(psi)) - residual * (two["KYD"] - one["KYD"]) / t
    assert (two["KXD"] - one["KXD"]) / t == pytest.approx(fall, rel=1e-6)


def test_energy_of_joints_that_dilate_and_weaken() -> None:
    """Without damping, motion, height, springs and what slipping has taken add up, lifting included.

    Gravity is great, so that the block does not leave the ground while the joints lift it.
    """
    gravity, v, dilation, critical = 1000.0, 10.0, 0.05, 0.02
    m = resting("joint-dilation", friction=0.8, gravity=(0.0, -gravity), fraction=0.01)
    m.property(1, dilation=dilation, critical_slip=critical, residual_friction=0.3)
    no_damping(m)
    push(m, block(m, 0, H / 2)["address"], xd=v)
    m.cycle(1)
    energies, taken = [], float(m.h.cd[WFRIC])
    for _ in range(80):
        energies.append(cycle_and_energy(m))
        m.cycle(9)
    assert m.h.cd[WFRIC] - taken > 0.5 * MASS * v**2 / 2
    assert np.ptp(energies) < 0.01 * MASS * gravity * dilation * critical


def pressed(psi: float, mixed: bool) -> Model:
    """A square of four zones between smooth plates, the upper one coming down slowly; its sides are free."""
    m = Model(constitutive="mohr-coulomb")
    m.start()
    m.fraction(0.3)
    elastic = {"bulk": 2e9, "g": 1e9, "density": 2000, "kn": 1e10, "ks": 1e10}
    strength = {"block_friction": tan(radians(30)), "block_cohesion": 2e5, "block_tension": 1e9}
    m.property(1, **elastic, **strength, block_dilation=tan(radians(psi)))
    m.round(0.05)
    m.block(0, 0, 0, 3, 1, 3, 1, 0, constitutive=2)
    for y in (1, 2):
        m.split(-1, y, 2, y)
    m.delete(0, 1, 1, 2)
    m.fix(0, 1, 0, 1)
    m.change(0, 1, 2, 3, type="fdef")
    points = [(0.5, 2.5), (0.0, 2.0), (0.0, 3.0), (1.0, 3.0), (1.0, 2.0)]  # numbered from the last one
    m.generate(0, 1, 2, 3, "manual", points, [(5, 4, 3), (5, 3, 2), (5, 2, 1), (5, 1, 4)], mixed=mixed)
    m.boundary(-0.1, 1.1, 2.9, 3.1, yvel=-0.002)
    m.boundary(-0.1, 1.1, 1.9, 2.1, yvel=0.0)
    m.damping(1.0, 200.0, "mass")
    return m


def size(m: Model) -> tuple[float, float]:
    """Height and area of the square: its corners are the grid-points with a block corner, clockwise."""
    points = m.table("gridpoint")
    x, y = (points[points["KCOR"] > 0][name] for name in ("KXG", "KYG"))
    return float(np.ptp(y)), abs(float(np.sum(x * np.roll(y, 1) - y * np.roll(x, 1)))) / 2


@pytest.mark.parametrize("psi", [0.0, 15.0])
@pytest.mark.parametrize("mixed", [False, True])
def test_zones_yield_under_a_plate(psi: float, mixed: bool) -> None:
    """Unconfined strength 2 c sqrt(N), zones on the shear limit (of a pair, the mean of two that share their
    pressure), and an area that grows as sin psi tells:

        dA/A = e11 + e22 = sin psi (e11 - e22), so that  ln A = -2 sin psi/(1 - sin psi) ln H

    The sides are pushed outwards against mass damping: a little more is borne than by zones at rest.
    """
    m = pressed(psi, mixed)
    n, unconfined = 3.0, 2 * 2e5 * 3.0**0.5
    m.cycle(2500)
    one = size(m)
    m.cycle(2500)
    two = size(m)
    zones = m.table("zone")
    mean, half = (zones["KZS11"] + zones["KZS22"]) / 2, (zones["KZS11"] - zones["KZS22"]) / 2
    radius = np.hypot(half, zones["KZS12"])
    beyond = n * (mean + radius) - unconfined - (mean - radius)
    assert beyond[::2] + beyond[1::2] == pytest.approx(0, abs=1e-9 * unconfined)
    assert mixed or beyond == pytest.approx(0, abs=1e-9 * unconfined)
    assert -zones["KZS22"].mean() == pytest.approx(unconfined, rel=0.01)
    shrunk, grown = np.log(two[0] / one[0]), np.log(two[1] / one[1])
    s = sin(radians(psi))
    assert shrunk < -1e-4
    assert grown == pytest.approx(-2 * s / (1 - s) * shrunk, abs=0.01 * abs(shrunk))
    sound(m)


@both_ways
@pytest.mark.parametrize("build", ["i32r64", "i32r32"])
def test_uncompiled_it_is_the_same_bit_for_bit(build: str) -> None:
    one, two = (resting("joint-dilation", friction=0.5, build=build) for _ in range(2))
    for m in one, two:
        m.property(1, dilation=0.1, critical_slip=1e-4, residual_friction=0.3)
        m.gravity(8.0, -10.0)
    one.cycle(100)
    with interpreted():
        two.cycle(100)
    assert differences(essence(one.array), essence(two.array)) == []


def refusal(m: Model) -> UdecError:
    with pytest.raises(UdecError) as caught:
        m.cycle(10)
    return caught.value


def test_a_number_without_a_law_is_error_9() -> None:
    m = on_base(B, H, D, 12.0)
    m.change(-1, 1, 0, H, constitutive=3)
    error = refusal(m)
    assert error.number == 9
    assert error.detail == f"contact@{error.group} has number 3, for which there is no law"
    assert "function clj3: --constitutive" in error.advice
    assert error.group in m.table("contact")["address"]


def test_a_number_with_a_block_law_only_has_joints_of_number_1() -> None:
    rows = []
    for law in (None, "mohr-coulomb"):
        m = resting(law, friction=0.3)
        rows.append(m.table("contact"))
    for name in ("KCFN", "KCFS", "KCN"):
        assert np.array_equal(rows[0][name], rows[1][name])


def test_a_run_goes_on_only_with_the_laws_it_began_with(tmp_path: Path) -> None:
    m = resting("joint-dilation", friction=0.3)
    saved = m.save(tmp_path / "one.h5")
    with_another = Model.restore(saved, constitutive="mohr-coulomb")
    for other in (Model.restore(saved), with_another):
        error = refusal(other)
        assert error.number == 9
        assert "follows clj2 of joint_dilation.py, which is not given" in error.detail
        assert error.advice == "give it again: --constitutive joint_dilation.py"
    again = Model.restore(saved, constitutive="joint_dilation.py")
    assert again.cycle(10) == m.cycle(10) == 10
    assert np.array_equal(again.table("contact"), m.table("contact"))


def test_a_law_that_returns_no_number_is_error_35() -> None:
    def torn(fn: Any, fs: Any, dun: Any, dus: Any, un: Any, us: Any, m: Any) -> Any:
        return m.kn * dun / (0.0 if fn > 100.0 else 1.0), 0.0

    m = on_base(B, H, D, 12.0, law={"clj2": torn})
    error = refusal(m)
    assert error.number == 35
    assert error.detail.startswith(f"clj2, for contact@{error.group} of material 1 in cycle ")
    assert m.h.ci[NERR] == 0
    sound(m)
