"""Mohr-Coulomb plasticity with tension cut-off, in plane strain: `--constitutive mohr-coulomb`, number 2.

The stress increment is elastic at first. Principal stresses s1 <= s3 (tension positive) beyond one of the
limits are then returned to it:

    shear    s1 = N s3 - 2 c sqrt(N)    N = (1 + sin phi)/(1 - sin phi), BFRICTION = tan phi, BCOHESION = c
    tension  s3 = t                     t = BTENSION, and at most c/tan phi, the tip of the shear limit

Plastic strain in shear follows the potential s1 - s3 M, with M for the dilation angle psi (BDILATION = tan
psi) as N for phi: the area grows by sin psi for a unit of plastic shear strain, so with psi = phi the flow is
associated and with psi = 0 it keeps the area. In tension the flow is associated. If both limits are exceeded
the stress goes to their corner. Directions of principal stress do not change.

A zone stores three stresses, as in 1980, and not the out-of-plane stress. The law assumes that this is the
intermediate principal stress, as solutions of limit analysis do. It then never yields and, as all plastic
strain is in the plane, it never influences the others. If it is in fact the greatest or least stress, true
yielding begins earlier. That requires a nearly hydrostatic state in the plane or an unusual initial stress.
"""

from math import sqrt


def passive(tangent):
    """(1 + sin a)/(1 - sin a), from the tangent of the angle a."""
    root = tangent + sqrt(1 + tangent * tangent)
    return root * root


def principal(s1, s3, m):
    """Principal stresses s1 <= s3 within the limits, from the elastic ones."""
    n = passive(m.block_friction)
    strength = 2 * m.block_cohesion * sqrt(n)
    t = m.block_tension
    if m.block_friction > 0:
        t = min(t, m.block_cohesion / m.block_friction)
    corner = n * t - strength
    if s3 > t:  # tension, unless the return ends outside the shear limit
        back = min(t, s1 - (s3 - t) * m.alam2 / m.alam1)
        if back >= corner:
            return back, t
    beyond = n * s3 - strength - s1
    if beyond <= 0:
        return s1, s3
    flow = passive(m.block_dilation)
    f1, f3 = m.alam1 - m.alam2 * flow, m.alam2 - m.alam1 * flow
    step = beyond / (f1 - n * f3)
    if s3 + step * f3 > t:
        return corner, t
    return s1 + step * f1, s3 + step * f3


def cl2(s11, s12, s22, de11, de12, de22, m):
    t11 = s11 + m.alam1 * de11 + m.alam2 * de22
    t22 = s22 + m.alam2 * de11 + m.alam1 * de22
    t12 = s12 + 2 * m.shear * de12
    mean, half = (t11 + t22) / 2, (t11 - t22) / 2
    radius = sqrt(half * half + t12 * t12)
    s1, s3 = principal(mean - radius, mean + radius, m)
    mean = (s1 + s3) / 2
    if radius > 0:
        share = (s3 - s1) / 2 / radius
        half, t12 = half * share, t12 * share
    return mean + half - s11, t12 - s12, mean - half - s22
