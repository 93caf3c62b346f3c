"""The oracles for joints agree with quadrature, with other formulas, and with each other."""

from __future__ import annotations

from math import exp, hypot, inf, radians, tan
from typing import Any

import mpmath
import numpy as np
import pytest
from naive import joint_targets as targets
from naive.geometry import area, centroid
from naive.joint_geometry import Joint, Stretch, field_traction, find_joints, nodal_forces
from naive.joint_models import BartonBandis, ContinuouslyYielding, Coulomb, Hyperbola, JointPoint
from shapely.geometry import LineString, Polygon

# ---- Coulomb


def box() -> Coulomb:
    return Coulomb(kn=1e8, ks=5e7, friction=0.5, cohesion=2e4, tension=1e4, dilation=0.2, limit=2e-3)


def test_coulomb_sticks_and_slips_under_constant_stress() -> None:
    point = box()
    point.dilation = 0.0
    point.move(1e-3, 0.0, 10)
    point.move(0.0, 1e-3)
    assert point.normal == pytest.approx(1e5)
    assert point.shear == pytest.approx(5e4)  # ks times slip, below 2e4 + 0.5 * 1e5
    point.move(0.0, 4e-3)
    assert point.shear == pytest.approx(7e4)
    assert point.plastic == pytest.approx(5e-3 - 7e4 / 5e7)
    assert point.dissipated() == pytest.approx(7e4 * point.plastic)
    point.move(0.0, -3e-3)  # back by twice the elastic slip, and 2e-4 of plastic slip
    assert (point.shear, point.plastic) == pytest.approx((-7e4, 3.4e-3))


def test_coulomb_dilates_against_its_spring_until_the_limit_and_back() -> None:
    """While it slips: tau = c + f kn (u + a p), s = p + tau/ks."""
    point = box()
    point.move(1e-3, 0.0, 10)
    peak = (2e4 + 0.5 * 1e8 * 1e-3) / 5e7
    point.move(0.0, peak + 1e-3)
    p = 1e-3 / (1 + 0.5 * 1e8 * 0.2 / 5e7)
    assert point.plastic == pytest.approx(p)
    assert point.normal == pytest.approx(1e8 * (1e-3 + 0.2 * p))
    assert point.shear == pytest.approx(2e4 + 0.5 * point.normal)
    point.move(0.0, 5e-3)
    assert point.normal == pytest.approx(1e8 * (1e-3 + 0.2 * 2e-3))  # the limit
    assert point.plastic == pytest.approx(point.slip - point.shear / 5e7)
    lost = 0.0
    for _ in range(20):
        point.move(0.0, -5e-4, 100)
        assert point.plastic == pytest.approx(point.slip - point.shear / 5e7)
        assert point.normal == pytest.approx(1e8 * (1e-3 + 0.2 * min(abs(point.plastic), 2e-3)))
        assert lost <= point.dissipated() + 1e-6
        lost = point.dissipated()
    assert point.plastic < 0  # it has passed the place with the least normal stress


def test_coulomb_under_constant_load_rises_with_plastic_slip() -> None:
    point = box()
    point.move(1e-3, 0.0, 10)
    point.shear_under(1e5, 3e-3, 300)
    assert point.shear == pytest.approx(7e4)
    assert 1e-3 - point.closure == pytest.approx(0.2 * point.plastic)
    assert point.plastic == pytest.approx(3e-3 - 7e4 / 5e7)
    assert point.dissipated() == pytest.approx((7e4 - 0.2 * 1e5) * point.plastic, rel=1e-3)


def test_coulomb_weakens_with_its_first_slip() -> None:
    point = Coulomb(kn=1e8, ks=5e7, friction=0.6, cohesion=5e4, residual_friction=0.4, residual_cohesion=0.0)
    point.move(1e-3, 0.0, 10)
    point.move(0.0, 2.1e-3, 210)
    assert point.shear == pytest.approx(1.05e5)
    point.move(0.0, 2e-4, 200)
    assert (point.shear, point.broken) == (pytest.approx(4e4), True)


def test_coulomb_tension_breaks_once() -> None:
    point = box()
    point.move(-0.9e-4, 0.0, 90)
    assert point.normal == pytest.approx(-0.9e4)
    point.move(-0.2e-4, 0.0, 20)
    assert (point.normal, point.broken) == (0.0, True)
    point.move(0.5e-4, 0.0, 50)
    assert point.normal == 0.0
    point.move(1e-4, 0.0, 100)
    assert point.normal == pytest.approx(4e3)
    lost = 1e4**2 / (2 * 1e8)
    assert point.dissipated() == pytest.approx(lost, rel=0.05)  # one step of the trapezoid rule


def test_slip_in_tension_opens() -> None:
    point = box()
    point.move(-0.5e-4, 0.0, 50)
    point.move(0.0, 3.4e-4, 340)
    assert (point.normal, point.shear) == pytest.approx((-5e3, 1.7e4))
    point.move(0.0, 0.2e-4, 20)
    assert (point.normal, point.shear, point.broken) == (0.0, 0.0, True)


# ---- continuously yielding

YIELDING: dict[str, Any] = {
    "an": 2e8,
    "en": 0.3,
    "as_": 1e8,
    "es": 0.25,
    "peak": radians(45),
    "basic": radians(30),
    "roughness": 2e-3,
}


def yielding(**changes: Any) -> ContinuouslyYielding:
    return ContinuouslyYielding(**(YIELDING | {"kn_range": (1e9, 1e11)} | changes))


def closure_by_quadrature(point: ContinuouslyYielding, low: float, high: float) -> float:
    """Integral of ds/kn, with cuts where kn reaches its limits."""
    cuts = [(k / point.an) ** (1 / point.en) for k in point.kn_range if 0 < k < inf]
    places = sorted({low, high, *(s for s in cuts if low < s < high)})
    return float(mpmath.quad(lambda s: 1 / point.kn(float(s)), places))


def test_yielding_joint_closes_along_one_curve() -> None:
    point = yielding()
    u = closure_by_quadrature(point, 0.0, 2e6)
    point.move(u, 0.0, 20000)
    assert point.normal == pytest.approx(2e6, rel=1e-6)
    exact = (2e6**0.7 - 1e6**0.7) / (0.7 * 2e8)  # where both stiffnesses are between their limits
    assert closure_by_quadrature(point, 1e6, 2e6) == pytest.approx(exact)
    assert point.dissipated() == pytest.approx(0.0, abs=1e-5 * point.work)
    point.move(-exact, 0.0)
    assert point.normal == pytest.approx(1e6, rel=1e-6)
    point.move(-2 * (u - exact), 0.0)
    assert point.normal == 0.0
    point.move(2 * (u - exact), 0.0)
    assert point.normal == pytest.approx(1e6, rel=1e-3)


def path_by_series(
    point: ContinuouslyYielding, normal: float, shear: float, angle: float, r: float, way: int
) -> Any:
    """The equations of the model until tau reaches tau_m, by mpmath's Taylor series: x to tau, phi_m."""
    ks = point.ks(normal)

    def slopes(x: Any, y: Any) -> list[Any]:
        part = (1 - way * y[0] / (normal * mpmath.tan(y[1]))) / (1 - r)
        part = min(part, 1)
        return [way * ks * part, -(y[1] - point.basic) * (1 - part) / point.roughness]

    return mpmath.odefun(slopes, 0, [shear, angle], tol=1e-9)


def test_yielding_joint_to_its_peak_and_residual_strength() -> None:
    point = yielding()
    point.normal = 1e6
    series = path_by_series(point, 1e6, 0.0, point.peak, 0.0, 1)
    for x in (2e-4, 5e-4, 9e-4):
        point.move(0.0, x - point.slip)
        tau, angle = map(float, series(x))
        assert (point.shear, point.angle) == pytest.approx((tau, angle), rel=1e-5)
    while point.shear < point.normal * tan(point.angle) * (1 - 1e-9):
        before = point.shear
        point.move(0.0, 1e-7, 1)
        assert point.shear >= before * (1 - 2e-5)  # it meets the bound within a step
    slip, angle = point.slip, point.angle
    assert tan(point.basic) * 1e6 < point.shear < tan(point.peak) * 1e6
    point.move(0.0, 3e-3, 3000)  # F is 0: phi_m falls exponentially
    expected = point.basic + (angle - point.basic) * exp(-(point.slip - slip) / point.roughness)
    assert point.angle == pytest.approx(expected, rel=1e-5)
    assert point.shear == pytest.approx(1e6 * tan(expected), rel=1e-5)
    assert point.dissipated() > 0


def test_yielding_joint_after_reversals() -> None:
    point = yielding()
    point.normal = 1e6
    point.move(0.0, 5e-4)
    shear, angle = point.shear, point.angle
    r = -shear / (1e6 * tan(angle))
    point.move(0.0, -3e-4, 3000)
    tau, phi = map(float, path_by_series(point, 1e6, shear, angle, r, -1)(3e-4))
    assert (point.ratio, point.shear, point.angle) == pytest.approx((r, tau, phi), rel=1e-5)
    again = point.shear / (1e6 * tan(point.angle))
    point.move(0.0, 1e-9, 10)  # shorter than 1e-6 R: no reversal
    assert point.ratio == pytest.approx(r)
    point.move(0.0, -1e-9, 10)
    point.move(0.0, 1e-4)
    assert point.ratio == pytest.approx(again, rel=1e-4)
    assert abs(point.shear) <= 1e6 * tan(point.angle)


def test_ratio_of_a_yielding_joint_is_limited() -> None:
    point = yielding()
    point.normal = 1e6
    point.move(0.0, 3e-3)
    point.move(0.0, -1e-6, 10)
    point.move(0.0, 1e-6, 10)
    assert point.ratio == 0.75


# ---- Barton-Bandis


def granite(**changes: Any) -> BartonBandis:
    return BartonBandis(
        **({"jrc": 8.0, "jcs": 100e6, "sigma_c": 100e6, "residual": 28.0, "ks": 5e9} | changes)
    )


def test_constants_of_a_joint_in_granite() -> None:
    """a_j = 0.16 mm, JCS/a_j = 625 MPa/mm, worked out by hand with logarithms of 625: 6.437752."""
    point = granite()
    assert point.aperture_at_rest() == pytest.approx(0.16e-3)
    assert point.initial_stiffness() == pytest.approx(19.35e9)
    assert point.first().greatest == pytest.approx(
        1e-3 * (-0.296 - 0.0448 + 2.241 * exp(-0.245 * 6.437752)), 1e-6
    )
    assert point.later().greatest == pytest.approx(
        1e-3 * (-0.1032 - 0.0592 + 1.135 * exp(-0.251 * 6.437752)), 1e-6
    )
    assert 0 < point.later().greatest < point.first().greatest < point.aperture_at_rest()


def test_hyperbola() -> None:
    curve = Hyperbola(2e10, 1e-4)
    for stress in (1e5, 1e6, 1e7, 1e8):
        u = targets.bandis_closure(stress, 2e10, 1e-4)
        assert curve.closure(stress) == pytest.approx(u)
        assert curve.stress(u) == pytest.approx(stress)
        assert curve.stiffness(stress) == pytest.approx(float(mpmath.diff(curve.stress, u)), rel=1e-6)
        assert curve.energy(stress) == pytest.approx(float(mpmath.quad(curve.stress, [0, u])))
    with pytest.raises(OverflowError):
        curve.stress(1e-4)


def test_memory_of_the_largest_stress() -> None:
    point = granite()
    u = point.first().closure(10e6)
    point.move(u, 0.0)
    assert (point.normal, point.largest) == pytest.approx((10e6, 10e6))
    remains = point.permanent()
    assert 0 < remains < u
    point.move(0.5 * (remains - u), 0.0)  # half-way back to no stress
    half = point.later().stress(0.5 * (u - remains))
    assert point.normal == pytest.approx(half)
    assert half < point.first().stress(point.closure)  # steeper than the first loading
    point.move(0.6 * (remains - u), 0.0)
    assert point.normal == 0.0
    point.move(u - point.closure, 0.0)
    assert point.normal == pytest.approx(10e6)  # reloading meets the first curve where it was left
    lost = point.first().energy(10e6) - point.later().energy(10e6)
    assert point.dissipated() == pytest.approx(lost, rel=1e-3)
    point.move(point.first().closure(20e6) - u, 0.0)
    assert point.normal == pytest.approx(20e6)
    assert point.permanent() > remains


@pytest.mark.parametrize("jrc", [5, 8, 10, 15])
@pytest.mark.parametrize("jcs", [22e6, 60e6, 100e6, 182e6])
@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_no_cycle_of_loads_makes_energy(jrc: float, jcs: float, ratio: float) -> None:
    """In the range of the tests of Bandis et al.: with the same k and V_m of unloading <= V_m of loading, the
    tangent of unloading is the steeper one at every stress."""
    point = granite(jrc=jrc, jcs=jcs, sigma_c=ratio * jcs)
    try:
        first, later = point.first(), point.later()
    except ValueError:
        pytest.skip("the relations give no positive closure")
    for stress in np.geomspace(1e4, 1e8, 30):
        assert later.stiffness(stress) >= first.stiffness(stress)
        assert first.energy(stress) >= later.energy(stress)
        point.largest = float(stress)
        assert point.permanent() >= 0
        assert first.closure(stress) < point.aperture_at_rest()


def test_strength_of_barton_bandis() -> None:
    point = granite()
    assert point.strength(1e6) == pytest.approx(1e6 * tan(radians(28 + 8 * 2)))
    assert point.strength(200e6) == pytest.approx(200e6 * tan(radians(28)))  # the logarithm is not negative
    assert point.strength(1.0) == pytest.approx(tan(radians(70)))
    point.move(point.first().closure(1e6), 0.0)
    point.move(0.0, 1e-3)
    assert point.shear == pytest.approx(point.strength(1e6))
    assert point.dissipated() > 0


def test_hydraulic_aperture() -> None:
    point = granite()
    assert point.hydraulic_aperture() == pytest.approx(160.0**2 / 8**2.5 * 1e-6)
    smooth = granite(jrc=3.0, jcs=50e6, sigma_c=100e6)
    assert smooth.hydraulic_aperture() == smooth.aperture_at_rest()  # 180 um: E^2/JRC^2.5 is more than E


# ---- closed forms


def test_rotation_stiffness_is_the_second_moment_of_springs() -> None:
    k, length = 3e8, 2.5
    many = sum(k * length / 1000 * ((i + 0.5) / 1000 * length - length / 2) ** 2 for i in range(1000))
    assert targets.rotation_stiffness(k, length) == pytest.approx(many, rel=1e-5)
    for n in (2, 3, 5, 9):
        places = np.linspace(-length / 2, length / 2, n)
        lengths = np.full(n, length / (n - 1))
        lengths[[0, -1]] /= 2
        assert targets.rotation_stiffness_by_contact(k, length, n) == pytest.approx(
            float(np.sum(k * lengths * places**2))
        )
        edge = targets.breaking_moment_by_contact(1e5, length, n)
        inertia = float(np.sum(lengths * places**2))
        assert edge == pytest.approx(1e5 * inertia / (length / 2))
    assert targets.rotation_stiffness_of_two_ends(k, length, length) == pytest.approx(
        targets.rotation_stiffness_by_contact(k, length, 2)
    )
    assert targets.breaking_moment_of_two_ends(1e5, length, length) == pytest.approx(
        targets.breaking_moment_by_contact(1e5, length, 2)
    )


def by_springs(k: float, u_a: float, u_b: float, p: float) -> tuple[float, float]:
    """Force and its distance from A of a joint without tension, by many springs."""
    s = (np.arange(100000) + 0.5) / 100000 * p
    forces = k * np.maximum(u_a + (u_b - u_a) * s / p, 0) * p / 100000
    return float(forces.sum()), float((forces * s).sum() / forces.sum())


def test_closed_and_partly_open_joint() -> None:
    _, force, place = targets.partly_open_joint(1e8, 3.0, 2e-3, -1e-3)
    assert (force, place) == pytest.approx(by_springs(1e8, 2e-3, -1e-3, 3.0), rel=1e-4)
    _, place = by_springs(1e8, 2e-3, 1e-3, 3.0)
    assert 1 - place / 3.0 == pytest.approx(targets.share_of_end(2e-3, 1e-3), rel=1e-4)


@pytest.mark.parametrize("theta", [1e-5, 1e-4, 4e-4, 1e-3, 1e-2])
def test_rocking_block_by_springs(theta: float) -> None:
    """The closure that carries the weight is found by bisection."""
    k, length, weight = 1e8, 2.0, 8e4
    y = ((np.arange(20000) + 0.5) / 20000 - 0.5) * length
    low, high = -1.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        carried = np.maximum(middle + theta * y, 0).sum() * k * length / 20000
        low, high = (middle, high) if carried < weight else (low, middle)
    moment = (np.maximum(high + theta * y, 0) * y).sum() * k * length / 20000
    assert targets.rocking_moment(k, length, weight, theta) == pytest.approx(moment, rel=1e-3)


def test_largest_overturning_moment() -> None:
    k, length, weight, height = 1e8, 2.0, 8e4, 3.0
    theta, moment = targets.largest_overturning_moment(k, length, weight, height)
    angles = np.linspace(theta / 3, theta * 3, 20001)
    curve = [targets.overturning_moment(k, length, weight, height, float(angle)) for angle in angles]
    assert moment == pytest.approx(max(curve))
    assert angles[int(np.argmax(curve))] == pytest.approx(theta, rel=1e-3)
    with pytest.raises(ValueError, match="closed branch"):
        targets.largest_overturning_moment(1e6, 2.0, 8e4, 30.0)


def test_shear_box_by_the_model_of_a_point() -> None:
    """Two metres of joint under 1e5 N; under a roof, the forces balance."""
    kn, ks, length = 1e8, 1e8, 2.0
    point = Coulomb(kn=kn, ks=ks, friction=0.5, cohesion=2e4, dilation=0.2)
    point.move(1e5 / length / kn, 0.0, 10)
    point.shear_under(1e5 / length, 2e-3, 400)
    assert point.shear * length == pytest.approx(targets.shear_box(ks, kn, length, 1e5, 0.5, 2e4, 1.0, 0.0))
    rise = 1e5 / length / kn - point.closure
    assert rise == pytest.approx(targets.rise_of_shear_box(0.2, point.plastic))
    y, below, above = targets.shear_box_under_roof(kn, kn, length, 1e5, 0.2, 0.01)
    assert below == pytest.approx(kn * length * (0.2 * 0.01 - y))
    assert above == pytest.approx(kn * length * y)
    assert below == pytest.approx(1e5 + above)


def test_bar_and_walls() -> None:
    assert targets.modulus_of_jointed_bar(1e10, 1e10, 1.0) == pytest.approx(5e9)
    assert targets.modulus_of_jointed_bar(inf, 1e9, 2.0) == pytest.approx(2e9)
    # four blocks of E/(1 - nu^2) = 8e9 Pa and five joints of 2e9 Pa/m between fixed walls: 1/6 remains
    assert targets.remaining_stress(-1e6, 8e9, 2e9, [1.0] * 4, 5) == pytest.approx(-1e6 / 6)
    assert targets.root_moment(2000, 10, 0.5, 2.0) == pytest.approx(2e4)
    assert targets.slip_force(5.0, 4.4e4, 0.0, 0.0) == pytest.approx(2.2e5)
    assert targets.breaking_moment(6e5, 2.0) == pytest.approx(4e5)
    assert targets.rocking_moment_of_two_ends(1e8, 2.0, 1.8, 8e4, 1.0) == pytest.approx(8e4 * 0.9)


# ---- geometry


def test_joint_of_two_offset_blocks() -> None:
    low, high = [(0, 0), (0, 1), (4, 1), (4, 0)], [(1, 1.001), (1, 2), (6, 2), (6, 1.001)]
    (joint,) = find_joints(low, high, 0.01)
    assert joint.length == pytest.approx(3.0)
    assert [point for end in joint.ends for point in end] == pytest.approx([1, 1, 4, 1])
    assert joint.stretches[0].outward == pytest.approx((0, 1))
    (other,) = find_joints(low[::-1], high[::-1], 0.01)
    assert other.length == pytest.approx(3.0)
    assert other.stretches[0].outward == pytest.approx((0, 1))
    assert find_joints(low, high, 1e-4) == []


def test_nodes_of_unlike_meshes_and_two_joints_in_a_notch() -> None:
    """Block 2 has corners at 1.5 and 3.5 on its lower edge; block 3 stands in the notch of block 1."""
    low = [(0, 0), (0, 1), (2, 1), (4, 1), (4, 0)]
    high = [(1, 1), (1, 2), (6, 2), (6, 1), (3.5, 1), (1.5, 1)]
    (joint,) = find_joints(low, high, 1e-6)
    assert joint.length == pytest.approx(3.0)
    assert joint.nodes == pytest.approx([0, 0.5, 1.0, 2.5, 3.0])
    notched = [(0, 0), (0, 2), (1, 2), (1, 1), (2, 1), (2, 2), (3, 2), (3, 0)]
    plug = [(1, 1), (1, 3), (2, 3), (2, 1)]
    assert [joint.length for joint in find_joints(notched, plug, 1e-6)] == pytest.approx([1, 1, 1])


def test_lengths_are_what_the_outlines_share() -> None:
    rng = np.random.default_rng(5)
    whole = Polygon([(0, 0), (0, 6), (8, 6), (8, 0)])
    for _ in range(40):
        x, angle = rng.uniform(2, 6), rng.uniform(-0.6, 0.6)
        cut = LineString([(x - 9 * np.sin(angle), -6), (x + 9 * np.sin(angle), 12)]).buffer(1e-9)
        one, two = (list(part.exterior.coords)[:-1] for part in whole.difference(cut).geoms)
        shared = Polygon(one).buffer(1e-7).intersection(Polygon(two).exterior).length
        (joint,) = find_joints(one, two, 1e-6)
        assert joint.length == pytest.approx(shared, abs=1e-5)


def test_nodal_forces_of_a_linear_traction() -> None:
    joint = Joint([Stretch((0, 0), (1, 0), (0, 1), 0.0, 3.0)], [0.0, 3.0])
    forces = nodal_forces(joint, [0.0, 3.0], lambda s: np.array(4.0 + 2.0 * s))
    assert forces == pytest.approx([3 * (2 * 4 + 10) / 6, 3 * (4 + 2 * 10) / 6])
    places = [0.2, 1.0, 2.6]  # the functions are continued to the ends
    forces = nodal_forces(joint, places, lambda s: np.array(4.0 + 2.0 * s))
    assert forces.sum() == pytest.approx(21.0)
    assert (forces * places).sum() == pytest.approx(4 * 4.5 + 2 * 9)


def test_hat_functions_by_quadrature() -> None:
    joint = Joint([Stretch((0, 0), (1, 0), (0, 1), 0.0, 3.0)], [0.0, 1.0, 1.5, 3.0])
    found = nodal_forces(joint, joint.nodes, lambda s: np.array(1.0 - 0.3 * s))
    for k, place in enumerate(joint.nodes):

        def hat(s: Any, k: int = k) -> Any:
            return float(np.interp(float(s), joint.nodes, np.eye(4)[k]))

        expected = mpmath.quad(lambda s, hat=hat: hat(s) * (1 - 0.3 * s), joint.nodes)
        assert found[k] == pytest.approx(float(expected)), place


def test_nodal_forces_balance_weight_and_gradient() -> None:
    """A block between four neighbours with unlike corners, in a field that is in equilibrium with its weight.

    s11 = a + b y, s12 = c, s22 = d + (rho g) y: divergence is (0, rho g).
    """
    block = [(0.0, 0.0), (0.5, 2.0), (3.0, 2.5), (3.5, 0.2)]
    rho_g = 2.5e4

    def stress(x: float, y: float) -> Any:
        return np.array([[-1e6 + 3e4 * y, 2e5], [2e5, -2e6 + rho_g * y]])

    force, moment = np.zeros(2), 0.0
    x0, y0 = centroid(block)
    for i in range(4):
        p, q = np.array(block[i - 1]), np.array(block[i])
        out = np.array([-(q - p)[1], (q - p)[0]]) / hypot(*(q - p))
        corners = [q, p + 0.37 * (q - p), p, p + out, q + out]  # clockwise, with a corner on the common edge
        (joint,) = find_joints(block, [tuple(corner) for corner in corners], 1e-6)
        assert len(joint.nodes) == 3
        for nodes in (joint.nodes, [0.1, 0.9, joint.length - 0.1]):
            parts = nodal_forces(joint, nodes, field_traction(joint, stress))
            assert parts.sum(axis=0) == pytest.approx(
                nodal_forces(joint, joint.nodes[::2], field_traction(joint, stress)).sum(axis=0)
            )
        for s, part in zip(nodes, parts, strict=True):
            (x, y), _ = joint.at(s)
            force += part
            moment += (x - x0) * part[1] - (y - y0) * part[0]
    assert force == pytest.approx([0.0, rho_g * area(block)], abs=1e-3)
    # about the centroid, as the divergence is constant and the stress symmetric
    assert moment == pytest.approx(0.0, abs=1e-3)


def test_every_model_starts_at_rest() -> None:
    points: list[JointPoint] = [box(), yielding(), granite()]
    for point in points:
        point.move(0.0, 0.0, 3)
        assert (point.normal, point.shear, point.work, point.energy()) == (0.0, 0.0, 0.0, 0.0)
