"""The Mohr-Coulomb law that comes with the program against closed forms.

A sample is one zone in a testing machine: strains are given in steps, and where a stress is given, the
strain that keeps it is found by iteration. The law is called as the Python function that it is; that its
compiled form gives the same bits is tested in test_laws.py.
"""

from __future__ import annotations

from math import cos, hypot, radians, sin, sqrt, tan

import numpy as np
import pytest

from udec_ia.laws.mohr_coulomb import cl2
from udec_ia.layout.material import Material

BULK, SHEAR = 2e9, 1e9
C, P = 2e5, 5e5
EPS = float(np.finfo(float).eps)
Pair = tuple[float, float]
Tensor = tuple[float, float, float]


def material(phi: float, c: float = C, psi: float = 0.0, tension: float = 1e12) -> Material:
    """Angles in degrees."""
    elastic = {"bulk": BULK, "shear": SHEAR, "alam1": BULK + 4 * SHEAR / 3, "alam2": BULK - 2 * SHEAR / 3}
    strength = {
        "block_friction": tan(radians(phi)),
        "block_cohesion": c,
        "block_tension": tension,
        "block_dilation": tan(radians(psi)),
    }
    return Material(**{**dict.fromkeys(Material._fields, 0.0), **elastic, **strength})


def after(s: Tensor, e: Tensor, m: Material) -> Tensor:
    """The stress after one strain increment."""
    s11, s12, s22 = (x + dx for x, dx in zip(s, cl2(*s, *e, m), strict=True))
    return s11, s12, s22


def servo(s: Tensor, e: Tensor, free: int, m: Material) -> tuple[Tensor, Tensor]:
    """Stress and strain increment when normal strain `free` (0 or 2) keeps its stress."""
    strain = list(e)
    for _ in range(400):
        t = after(s, (strain[0], strain[1], strain[2]), m)
        if abs(t[free] - s[free]) <= 8 * EPS * max(map(abs, t)):
            break
        strain[free] -= (t[free] - s[free]) / m.alam1
    return t, (strain[0], strain[1], strain[2])


def principal(s: Tensor) -> Pair:
    mean, radius = (s[0] + s[2]) / 2, hypot((s[0] - s[2]) / 2, s[1])
    return mean - radius, mean + radius


def n_phi(phi: float) -> float:
    return (1 + sin(radians(phi))) / (1 - sin(radians(phi)))


def turned(s: Tensor, angle: float) -> Tensor:
    c, s_ = cos(angle), sin(angle)
    return (
        c * c * s[0] - 2 * c * s_ * s[1] + s_ * s_ * s[2],
        c * s_ * (s[0] - s[2]) + (c * c - s_ * s_) * s[1],
        s_ * s_ * s[0] + 2 * c * s_ * s[1] + c * c * s[2],
    )


@pytest.mark.parametrize("phi", [0.0, 20.0, 45.0])
@pytest.mark.parametrize("p", [0.0, P])
def test_biaxial_strength(phi: float, p: float) -> None:
    """Pressed in direction 2 while direction 1 keeps the pressure p: s = p N + 2 c sqrt(N), and no more.

    Before that the modulus is that of plane strain, 4G (K + G/3)/(K + 4G/3).
    """
    m = material(phi)
    strength = p * n_phi(phi) + 2 * C * sqrt(n_phi(phi))
    modulus = 4 * SHEAR * (BULK + SHEAR / 3) / (BULK + 4 * SHEAR / 3)
    s: Tensor = (-p, 0.0, -p)
    step = (strength - p) / modulus / 10
    for i in range(1, 16):
        s, _ = servo(s, (0.0, 0.0, -step), 0, m)
        assert -s[2] == pytest.approx(min(p + modulus * i * step, strength), rel=1000 * EPS)


@pytest.mark.parametrize("phi", [10.0, 35.0])
@pytest.mark.parametrize("psi", [0.0, 10.0])
def test_the_volume_grows_with_the_sine_of_the_dilation_angle(phi: float, psi: float) -> None:
    """At failure all strain is plastic: the area grows by sin psi for a unit of shear strain."""
    m = material(phi, psi=psi)
    s: Tensor = (-P, 0.0, -P * n_phi(phi) - 2 * C * sqrt(n_phi(phi)))
    s, e = servo(s, (0.0, 0.0, -1e-4), 0, m)
    assert e[0] + e[2] == pytest.approx(sin(radians(psi)) * (e[0] - e[2]), abs=1e4 * EPS * 1e-4)


@pytest.mark.parametrize("phi", [20.0, 40.0])
@pytest.mark.parametrize("psi", [0.0, 15.0])
def test_simple_shear(phi: float, psi: float) -> None:
    """Sheared along direction 1, which keeps its length, under a normal stress in direction 2.

    In the end the sample rises by tan psi for a unit of shear, and along the plane of shear acts (Davis 1968)

        s12 = (p sin phi + c cos phi) cos psi / (1 - sin phi sin psi)

    The stress in direction 1 creeps up to its final value; with what is left of the elastic strain the ratios
    of the last step are right to 1e-9.
    """
    m = material(phi, psi=psi)
    s: Tensor = (-P, 0.0, -P)
    for _ in range(4000):
        s, e = servo(s, (0.0, 1e-5, 0.0), 2, m)
    f, d = radians(phi), radians(psi)
    strength = (P * sin(f) + C * cos(f)) * cos(d) / (1 - sin(f) * sin(d))
    assert s[1] == pytest.approx(strength, rel=1e-9)
    assert e[2] == pytest.approx(2 * e[1] * tan(d), abs=1e-9 * 2e-5)


def test_tension_is_cut_off() -> None:
    """Pulled in one direction, the other held: tension stays at its limit, the other stress follows Poisson.

    Pulled in both, both stay at it.
    """
    t = 1e5
    m = material(30.0, tension=t)
    s = after((0.0, 0.0, 0.0), (0.0, 0.0, 1e-4), m)
    assert s == pytest.approx((t * m.alam2 / m.alam1, 0.0, t), rel=8 * EPS)
    assert after((0.0, 0.0, 0.0), (2e-4, 0.0, 1e-4), m) == pytest.approx((t, 0.0, t), rel=8 * EPS)


def test_tension_ends_at_the_tip_of_the_shear_limit() -> None:
    """Never more than c/tan phi, whatever BTENSION is; and a material without properties bears no tension."""
    tip = C / tan(radians(30.0))
    pulled = after((0.0, 0.0, 0.0), (1e-3, 0.0, 1e-3), material(30.0))
    assert pulled == pytest.approx((tip, 0.0, tip), rel=8 * EPS)
    loose = material(0.0, c=0.0, tension=0.0)
    assert after((0.0, 0.0, 0.0), (1e-3, 2e-4, 5e-4), loose) == (0.0, 0.0, 0.0)


def states(n: int) -> list[tuple[Tensor, Tensor]]:
    """Random stresses and strain increments around the limits of the materials here."""
    draw = np.random.default_rng(7).normal(size=(n, 6))
    low = np.array([5e5, 0, 5e5])
    return [(tuple((1e6 * row[:3] - low).tolist()), tuple((1e-3 * row[3:]).tolist())) for row in draw]


@pytest.mark.parametrize("psi", [0.0, 12.0, 30.0])
def test_no_stress_is_beyond_a_limit_and_no_direction_is_preferred(psi: float) -> None:
    t, n = 8e4, n_phi(30.0)
    m = material(30.0, psi=psi, tension=t)
    yielded = 0
    for s, e in states(300):
        new = after(s, e, m)
        slack = 64 * EPS * (max(map(abs, s)) + 2 * m.alam1 * max(map(abs, e))) * n
        s1, s3 = principal(new)
        assert s3 <= t + slack
        assert s1 >= n * s3 - 2 * C * sqrt(n) - slack
        other = after(turned(s, 0.7), turned(e, 0.7), m)
        assert other == pytest.approx(turned(new, 0.7), abs=slack)
        yielded += new != after(s, e, material(30.0, c=1e12))
    assert 100 < yielded < 300


def nearest(
    trial: tuple[float, float], corners: list[tuple[float, float]], m: Material
) -> tuple[float, float]:
    """The point of the path through `corners` that is nearest to `trial` in elastic energy.

    By the law of normality that is where an associated flow leads to.
    """
    stiff = np.array([[m.alam1, m.alam2], [m.alam2, m.alam1]])
    inverse = np.linalg.inv(stiff)
    found = []
    for a, b in zip(np.array(corners[:-1]), np.array(corners[1:]), strict=True):
        along = (np.array(trial) - a) @ inverse @ (b - a) / ((b - a) @ inverse @ (b - a))
        point = a + min(max(along, 0), 1) * (b - a)
        gap = np.array(trial) - point
        found.append((gap @ inverse @ gap, tuple(point)))
    return min(found)[1]


def test_associated_flow_is_the_shortest_way_back() -> None:
    """With psi = phi: tension, shear and the corner between them, against a search along the limits."""
    t, n, m = 8e4, n_phi(30.0), material(30.0, psi=30.0, tension=8e4)
    strength = 2 * C * sqrt(n)
    limits = [(-1e9 * n - strength, -1e9), (n * t - strength, t), (t, t)]
    seen = set()
    for s, e in states(300):
        trial = principal(after(s, e, material(30.0, c=1e12)))
        if trial[1] <= t and trial[0] >= n * trial[1] - strength:
            continue
        new = principal(after(s, e, m))
        back = nearest(trial, limits, m)
        slack = 64 * EPS * (max(map(abs, s)) + 2 * m.alam1 * max(map(abs, e))) * n
        # Along the limits the search divides two differences of the size of the longest of them, 1e9 N.
        assert new == pytest.approx(back, abs=slack + 16 * EPS * 1e9 * n)
        seen.add((abs(back[0] - limits[1][0]) < 1, abs(back[1] - t) < 1, abs(back[0] - t) < 1))
    assert len(seen) == 4
