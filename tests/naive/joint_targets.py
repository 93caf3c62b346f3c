"""Closed forms for joints with a length: stiffness, strength, rotation, rocking and the direct shear box.

Everything is per metre of thickness. kn, ks: stiffness of a joint, Pa/m. L: its length. M: moments about the
middle of the joint. [U80] is the report of 1980; what has no source is statics, derived in the docstring.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt


def modulus_of_jointed_bar(young: float, kn: float, spacing: float) -> float:
    """1/E_m = 1/E + 1/(kn S): compliances add. Goodman, Methods of geological engineering (1976), chapter 6.

    Spacing is the length of the bar over the number of its joints. A rigid block has an infinite E.
    """
    return 1 / (1 / young + 1 / (kn * spacing))


def slip_force(length: float, cohesion: float, normal: float, friction: float) -> float:
    """T = L (c + s tan phi), Coulomb."""
    return length * (cohesion + normal * friction)


def rotation_stiffness(kn: float, length: float) -> float:
    """k L^3/12, N m/rad: the integral of k y^2 over a closed joint."""
    return kn * length**3 / 12


def rotation_stiffness_by_contact(kn: float, length: float, n: int) -> float:
    """The sum of k l_i y_i^2 over n contacts at equal distances, the outer ones at the ends, half as long."""
    return rotation_stiffness(kn, length) * (1 + 2 / (n - 1) ** 2)


def rotation_stiffness_of_two_ends(kn: float, length: float, p: float) -> float:
    """k L p^2/4: two ends at the distance p with half the stiffness each, the report's joint [U80 2.4]."""
    return kn * length * p**2 / 4


def share_of_end(u_a: float, u_b: float) -> float:
    """Part of the force of a closed linear joint that acts at its end A, by the lever rule."""
    return (2 * u_a + u_b) / (3 * (u_a + u_b))


def partly_open_joint(k: float, p: float, u_a: float, u_b: float) -> tuple[float, float, float]:
    """Closed length from A, force, and its distance from A, where A is closed and B open (u_b < 0).

    Closure is linear from u_a at A to u_b at B and 0 at p_c = p u_a/(u_a - u_b); the force of that triangle
    is k u_a p_c/2, at a third of p_c.
    """
    closed = p * u_a / (u_a - u_b)
    return closed, k * u_a * closed / 2, closed / 3


def breaking_moment(tension: float, height: float) -> float:
    """M = T h^2/6: the edge of a linear distribution reaches T."""
    return tension * height**2 / 6


def breaking_moment_by_contact(tension: float, height: float, n: int) -> float:
    """The same for n equal distances of contacts: stiffness in rotation over half the height, times T/k."""
    return breaking_moment(tension, height) * (1 + 2 / (n - 1) ** 2)


def breaking_moment_of_two_ends(tension: float, height: float, p: float) -> float:
    """T h p/2: each end carries T over half the height, at p/2 from the middle [U80 2.4]."""
    return tension * height * p / 2


def root_moment(density: float, gravity: float, height: float, length: float) -> float:
    """Moment at the root of a horizontal cantilever under its weight: rho g h l^2/2."""
    return density * gravity * height * length**2 / 2


def rocking_moment(k: float, length: float, weight: float, theta: float) -> float:
    """Moment that holds a rigid block turned by a small angle theta > 0 on a linear joint without tension.

    Closed: k L^3 theta/12, until the edge is without stress at theta = 2 W/(k L^2), M = W L/6. Then a
    triangle of the width a = sqrt(2 W/(k theta)) carries W at a/3 from the edge: M = W (L/2 - a/3).
    """
    if k * length * theta / 2 <= weight / length:
        return rotation_stiffness(k, length) * theta
    return weight * (length / 2 - sqrt(2 * weight / (k * theta)) / 3)


def overturning_moment(k: float, length: float, weight: float, height: float, theta: float) -> float:
    """The same less W h theta, the moment of the weight whose centre, h above the joint, moves sideways."""
    return rocking_moment(k, length, weight, theta) - weight * height * theta


def largest_overturning_moment(k: float, length: float, weight: float, height: float) -> tuple[float, float]:
    """Angle and value of the maximum of `overturning_moment`.

    On the open branch dM/dtheta = W a/(6 theta) - W h = 0: theta = (W/(18 k h^2))^(1/3), M = W (L/2 - 3 h
    theta). Raises ValueError if that is not on the open branch: then the block falls before a corner lifts.
    """
    theta = (weight / (18 * k * height**2)) ** (1 / 3)
    if theta < 2 * weight / (k * length**2):
        raise ValueError("the greatest moment is on the closed branch")
    return theta, weight * (length / 2 - 3 * height * theta)


def rocking_moment_of_two_ends(k: float, length: float, p: float, weight: float, theta: float) -> float:
    """The same block on two ends with half the stiffness each, which open: at most W p/2 [U80 2.4]."""
    return min(rotation_stiffness_of_two_ends(k, length, p) * theta, weight * p / 2)


def bandis_closure(stress: float, kni: float, um: float) -> float:
    """u = s/(kni + s/um). Bandis, Lumsden and Barton, Int. J. Rock Mech. Min. Sci. 20 (1983) 249-268."""
    return stress / (kni + stress / um)


def shear_box(
    ks: float,
    kn: float,
    length: float,
    force: float,
    friction: float,
    cohesion: float,
    push: float,
    arm: float,
) -> float:
    """Shear force of a direct shear box whose rigid block is pushed by `push`, `arm` above the joint.

    Until the peak the block slides on ks L and leans on k L^3/12; the peak is L c + N tan phi.
    """
    compliance = 1 / (ks * length) + arm**2 / rotation_stiffness(kn, length)
    return min(push / compliance, length * cohesion + force * friction)


def rise_of_shear_box(dilation: float, plastic_slip: float, limit: float = 0.0) -> float:
    """The block rises by tan(psi) for each metre of plastic slip, up to the limit (0 for none)."""
    return dilation * (min(plastic_slip, limit) if limit else plastic_slip)


def shear_box_under_roof(
    kn_below: float, kn_above: float, length: float, weight: float, dilation: float, plastic_slip: float
) -> tuple[float, float, float]:
    """Rise of a dilating block, normal force below it and force of a frictionless roof above it.

    The rise y is that above the height at which both joints are just without force. Below, N = kn L (psi s -
    y); the roof, touched when y > 0, gives R = kn_above L y; N = W + R.
    """
    below, above = kn_below * length, kn_above * length
    rise = dilation * plastic_slip - weight / below
    if rise > 0:
        rise = (below * dilation * plastic_slip - weight) / (below + above)
    roof = max(above * rise, 0.0)
    return rise, weight + roof, roof


def remaining_stress(stress: float, young: float, kn: float, lengths: Sequence[float], joints: int) -> float:
    """Stress that remains in a row of blocks between fixed walls whose joints start without force.

    The row is stressed at constant length: strain -s/E of the blocks turns into closure of the joints, and
    s' (l/E + n/kn) = s l/E. With INSITU on the joints all of s remains.
    """
    soft = sum(lengths) / young
    return stress * soft / (soft + joints / kn)
