"""A round hole in rock that yields

Rock with the cohesion c and the friction angle phi is under equal pressure p from all sides; a hole of
the radius a is cut into it, and around it the rock yields, out to the radius R:

        .--.           R/a = (2/(N + 1) (p + s)/s)^(1/(N - 1))
      .' __ '.         N = (1 + sin phi)/(1 - sin phi),  s = q/(N - 1),  q = 2 c sqrt(N)
      | (a ) | R       radial stress  s ((r/a)^(N-1) - 1)      r < R
      '. -- .'         hoop stress    s (N (r/a)^(N-1) - 1)
        '--'           beyond R: p - (p - sR) (R/r)^2 and p + (p - sR) (R/r)^2,  sR = (2p - q)/(N + 1)

A quarter of it, with rollers, is a ring of zones from a to b = 12 a, pairs of zones with a common
change of volume. R is where the hoop stress is largest: the computed one is where both straight lines
meet that fit the stresses inside and outside best, over the exact functions of r.

Tolerance. The two zones of a quadrilateral have the stress of its middle to the second order: (h/a)^2,
with the longest side h of a zone at the wall, times N for stresses that grow with r^(N-1). The ring
ends at b: (R/b)^2. The force ratio at which the run was ended.

Source: J. Salencon, Contraction quasi-statique d'une cavite a symetrie spherique ou cylindrique dans un
milieu elastoplastique, Annales des Ponts et Chaussees 4 (1969) 231-236.
"""

from math import radians, sin, sqrt, tan

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, generate, outline, polar, quarter_ring

BLOCKS = ("fdef",)
A, B, P, COHESION, PHI = 1.0, 12.0, 30e6, 3.45e6, radians(30)
BULK, SHEAR, DENSITY, AROUND, ACROSS = 3.9e9, 2.8e9, 2600.0, 16, 30
N = (1 + sin(PHI)) / (1 - sin(PHI))
Q = 2 * COHESION * sqrt(N)
S = Q / (N - 1)
R = A * (2 / (N + 1) * (P + S) / S) ** (1 / (N - 1))


def stresses(r):
    """Radial and hoop stress, compression positive, Pa."""
    edge = (2 * P - Q) / (N + 1)
    inner = S * ((r / A) ** (N - 1) - 1), S * (N * (r / A) ** (N - 1) - 1)
    outer = P - (P - edge) * (R / r) ** 2, P + (P - edge) * (R / r) ** 2
    return tuple(np.where(r < R, one, two) for one, two in zip(inner, outer, strict=True))


def solve(case):
    nodes = quarter_ring(A, B, AROUND, ACROSS)
    m = case.model("mohr-coulomb")
    m.property(1, density=DENSITY, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    m.property(
        1, block_cohesion=COHESION, block_friction=tan(PHI), block_dilation=tan(PHI), block_tension=1e9
    )
    m.round(0.02)
    m.block(*outline(nodes), constitutive=2)
    generate(m, nodes, mixed=True)
    m.insitu(0, B, 0, B, -P, 0, -P)
    m.boundary(-0.001, 0.001, -1, B + 1, xvel=0)
    m.boundary(-1, B + 1, -0.001, 0.001, yvel=0)
    m.boundary(-0.001, B + 0.001, -0.001, B + 0.001, stress=(-P, 0, -P))
    # the wall is set free little by little: what yields does not forget that it was shaken
    m.function(1, 0, 0, 0.05, 1.0)
    m.boundary(-0.001, A + 0.001, -0.001, A + 0.001, stress=(P, 0, P), function=1)
    m.fraction(0.5)
    m.damping(0.6, sqrt((BULK + 4 * SHEAR / 3) / DENSITY) / B / 4, "mass")
    m.cycle(0)
    cycle_for(m, 0.05)
    m.solve(1e-4, 20000)
    r, radial, hoop, _ = polar(m)
    side = A * np.hypot(np.pi / 2 / AROUND, (B / A) ** (1 / ACROSS) - 1)
    want_radial, want_hoop = stresses(r)
    within = {
        "zones, N (h/a)^2": N * side**2,
        "end of the ring, (R/b)^2": (R / B) ** 2,
        "force ratio of rest": 1e-3,
    }
    for what, got, want, where in (
        ("hoop stress where it yields", -hoop, want_hoop, r < 0.9 * R),
        ("hoop stress beyond", -hoop, want_hoop, (r > 1.1 * R) & (r < 4 * R)),
        ("radial stress beyond", -radial, want_radial, (r > 1.1 * R) & (r < 4 * R)),
    ):
        exact = float(want[where].mean())
        yield Answer(
            what, "Pa", float(got[where].mean()), exact, {name: part * exact for name, part in within.items()}
        )
    inside, outside = r < 0.9 * R, (r > 1.1 * R) & (r < 4 * R)
    one = np.polyfit(r[inside] ** (N - 1), -hoop[inside], 1)
    two = np.polyfit(r[outside] ** -2.0, -hoop[outside], 1)
    fine = np.linspace(0.8 * R, 1.3 * R, 5001)
    got = float(fine[abs(np.polyval(one, fine ** (N - 1)) - np.polyval(two, fine**-2.0)).argmin()])
    yield Answer(
        "radius R to which it yields", "m", got, R, {name: part * R for name, part in within.items()}
    )
    line, few = np.linspace(A, 4, 200), r < 4
    exact_radial, exact_hoop = stresses(line)
    case.graph(
        "r/a",
        "stress (MPa)",
        {"hoop": (line, exact_hoop / 1e6), "radial": (line, exact_radial / 1e6)},
        [(r[few][::3], -hoop[few][::3] / 1e6), (r[few][::3], -radial[few][::3] / 1e6)],
    )
