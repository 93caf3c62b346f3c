"""One block, or a column of them, on a plane: friction, cohesion, toppling and statics by formula."""

from __future__ import annotations

from math import atan, cos, pi, radians, sin, tan

import numpy as np
import pytest
from naive.dynamics import slide
from support.mechanics_scenes import G, at, block, no_damping, on_base, sound, step

from udec_ia import Model

KN, KS = 1e9, 4e8
D = 0.1


def tilt(m: Model, angle: float) -> None:
    """Turn gravity instead of the plane: down to the right."""
    m.gravity(G * sin(angle), -G * cos(angle))


def resting(b: float, h: float, friction: float, cohesion: float = 0.0, width: float = 12.0) -> Model:
    """A block on a fixed base, settled on its two contacts under gravity that is normal to the base."""
    m = on_base(b, h, D, width, stiffness=(KN, KS), friction=friction, cohesion=cohesion)
    m.damping(1.0, (2 * KN / (1000 * b * h)) ** 0.5 / (2 * pi), "mass")
    m.cycle(400)
    return m


def loaded(m: Model) -> np.ndarray:
    """The contacts that carry a force, from left to right."""
    contacts = m.table("contact")
    return np.sort(contacts[contacts["KCFN"] > 0], order="KXC")


def test_a_block_lies_on_its_tangent_points() -> None:
    """A rigid block stands on the ends of its roundings, base b - 2D; each contact carries half of it."""
    b, h = 2.0, 1.0
    m = resting(b, h, friction=0.5)
    left, right = loaded(m)
    assert [left["KXC"], right["KXC"]] == pytest.approx([-b / 2 + D, b / 2 - D], abs=1e-9)
    weight = 1000 * b * h * G
    for row in (left, right):
        assert row["KCFN"] == pytest.approx(weight / 2, rel=1e-9)
        assert row["KCN"] == pytest.approx(weight / (2 * KN), rel=1e-9)
        assert row["KYC"] == pytest.approx(-weight / (4 * KN), rel=1e-9)  # in the middle of the overlap
    sound(m)


@pytest.mark.parametrize(("psi", "phi"), [(30, 20), (25, 24), (40, 0)])
def test_sliding_down_an_incline(psi: float, phi: float) -> None:
    """a = g (sin psi - mu cos psi) on average over a time T in which both contacts slip.

    The two shear forces add up to mu times the normal forces, and these to m (g cos psi + dv_n/T), dv_n the
    change of the normal velocity: so the average differs from the formula by exactly mu dv_n/T.
    """
    mu = tan(radians(phi))
    m = resting(2.0, 1.0, mu, width=30.0)
    no_damping(m)
    tilt(m, radians(psi))
    address = block(m, 0, 0.5)["address"]
    m.cycle(3000)  # the shear springs fill, the block begins to slide
    before, n = at(m, "block", address), 2000
    m.cycle(n)
    after, time = at(m, "block", address), n * step(m)
    normal = float(after["KYD"] - before["KYD"]) / time
    expected = slide(G, radians(psi), mu)
    assert (after["KXD"] - before["KXD"]) / time == pytest.approx(expected - mu * normal, rel=1e-9)
    assert abs(mu * normal) < 0.01 * expected
    assert after["KXD"] > 10 * step(m) * G  # it has really gone
    sound(m)


def _give(force: float, b: float, h: float) -> float:
    """How far a force along the base at the centroid moves it: the shear springs, and the rotation."""
    theta = force * h / 2 / (2 * KN * (b / 2 - D) ** 2)
    return force / (2 * KS) + theta * h / 2


def test_rest_below_the_friction_angle() -> None:
    """Statics, to first order in the overlaps, which are W/(2 KN) = 1e-5 of the lengths.

    The shear springs carry W sin psi; its moment about the base goes from one normal spring to the other.
    """
    b, h, psi = 2.0, 1.0, radians(29)
    m = resting(b, h, friction=tan(radians(60)))
    tilt(m, psi)
    m.cycle(4000)
    row, weight = block(m, 0, h / 2), 1000 * b * h * G
    assert row["KX"] == pytest.approx(_give(weight * sin(psi), b, h), rel=1e-3)
    assert abs(row["KXD"]) < 1e-9
    left, right = loaded(m)
    couple = weight * sin(psi) * h / (b - 2 * D)
    assert right["KCFN"] - left["KCFN"] == pytest.approx(couple, rel=1e-4)
    assert abs(left["KCFS"] + right["KCFS"]) == pytest.approx(weight * sin(psi), rel=1e-6)
    sound(m)


@pytest.mark.parametrize(("share", "holds"), [(0.98, True), (1.02, False)])
def test_cohesion_holds_up_to_its_strength(share: float, holds: bool) -> None:
    """Without friction two closed contacts carry 2 COH along the base, and no more: a = g_x - 2 COH/m.

    The pull is raised in small parts and damped, so that it never overshoots.
    """
    b, h, cohesion = 2.0, 1.0, 3000.0
    m = resting(b, h, friction=0.0, cohesion=cohesion)
    mass = 1000 * b * h
    pull = share * 2 * cohesion / mass
    for k in range(1, 11):
        m.gravity(pull * k / 10, -G)
        m.cycle(200)
    no_damping(m)
    address = block(m, 0, h / 2)["address"]
    before = at(m, "block", address)
    m.cycle(1000)
    after = at(m, "block", address)
    acceleration = (after["KXD"] - before["KXD"]) / (1000 * step(m))
    assert acceleration == pytest.approx(0.0 if holds else pull - 2 * cohesion / mass, abs=1e-6)
    give = _give(mass * pull, b, h)
    assert after["KX"] == pytest.approx(give, rel=1e-2) if holds else after["KX"] > 10 * give
    sound(m)


@pytest.mark.parametrize("d", [0.05, 0.25])
@pytest.mark.parametrize(("share", "topples"), [(0.98, False), (1.02, True)])
def test_toppling(d: float, share: float, topples: bool) -> None:
    """A block topples when (b - 2D)/h < tan psi: it turns about its tangent point, not about its corner.

    At rest the springs let it turn by no more than theta = W/(KN (b - 2D)): the whole weight on one contact.
    """
    b, h = 1.0, 2.0
    m = on_base(b, h, d, 12.0, stiffness=(KN, KS), friction=3.0)
    m.damping(1.0, (2 * KN / (1000 * b * h)) ** 0.5 / (2 * pi), "mass")
    m.cycle(400)
    m.damping(1.0, 1.0, "mass")
    tilt(m, atan(share * (b - 2 * d) / h))
    m.cycle(12_000)
    corners = m.table("corner")
    body = block(m, 0, h / 2)
    of_body = corners[corners["KNB"] == body["address"]]
    turned = float(np.ptp(of_body["KXP"])) - b  # h sin(theta), to first order
    limit = 1000 * b * h * G / (KN * (b - 2 * d)) * h
    assert turned > 100 * limit if topples else turned < limit
    sound(m)


def test_column() -> None:
    """n blocks on two contacts each: the overlap k levels from the top is k W/(2 KN)."""
    n, b = 6, 2.0
    m = on_base(b, n * b, D, 4.0, stiffness=(KN, KS), friction=0.5, fraction=0.2)
    for k in range(1, n):
        m.split(-3, k * b, 3, k * b)
    lowest = (KN / (1000 * b * b)) ** 0.5 * 2**0.5 * 2 * sin(pi / (2 * (2 * n + 1)))
    m.damping(1.0, lowest / (2 * pi), "mass")
    m.cycle(1500)
    contacts = np.sort(loaded(m), order="KYC")[::-1]
    assert len(contacts) == 2 * n
    weight = 1000 * b * b * G
    expected = [(k // 2 + 1) * weight / (2 * KN) for k in range(2 * n)]
    assert contacts["KCN"] == pytest.approx(expected, rel=1e-6)
    sound(m)
