"""Strength of a specimen with a plane of weakness

A specimen is cut by one joint, inclined by b. It is pressed by s3 from the sides and by s1 from above,
until the joint slips:

        s1              s1 = s3 + 2 (c + mu s3)/((1 - mu cot b) sin 2b)
       _v__
      | .-'|            c = 2 C/L: cohesion of two contacts over the length L = w/cos b of the joint
  s3->|'   |<- s3
      |____|            never, if tan b < mu

s1 grows in small parts, with rest between them.

Tolerance. Half of the last part of s1. The contacts give way by their forces over KN, and forces act at
places that are wrong by that, over w; and there is the force ratio of rest. A part of a force changes
s1 by a larger one, as only sin b cos b - mu cos^2 b of s1 makes the joint slip.

Source: J. Jaeger, Shear failure of anisotropic rocks, Geol. Mag. 97 (1960) 65-72.
"""

from math import cos, pi, radians, sin, sqrt, tan

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, fan

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # overlaps are some micrometres
MU, COHESION, S3, K, DENSITY, W, H = 0.5, 5e4, 2e5, 1e10, 2000.0, 1.0, 4.0
PART = 8e3  # of s1, Pa


def exact(b):
    c = 2 * COHESION * cos(b) / W
    return S3 + 2 * (c + MU * S3) / ((1 - MU / tan(b)) * sin(2 * b))


def strength(case, b, draw):
    """s1 at which the joint slips, Pa, and the model."""
    m = case.model()
    m.property(1, density=DENSITY, kn=K, ks=K, bulk=2e10, g=1e10, friction=MU, cohesion=COHESION)
    m.fraction(0.2)
    m.round(0.05)
    m.block(-W / 2, 0, -W / 2, H, W / 2, H, W / 2, 0)
    rise = tan(b) * W
    m.split(-W, H / 2 - rise, W, H / 2 + rise)
    m.fix(-W, W, 0, H / 2)
    upper = block(m, 0, 0.75 * H)
    x, y = float(upper["KX"]), float(upper["KY"])
    if case.blocks == "sdef":
        m.change(x - 0.01, x + 0.01, y - 0.01, y + 0.01, type="sdef")
    elif case.blocks == "fdef":
        fan(m, x, y)
    for side in (-W / 2, W / 2):
        m.boundary(side - 0.01, side + 0.01, H / 2 - rise, H + 1, stress=(-S3, 0, 0))
    m.boundary(-W, W, H - 0.01, H + 0.01, stress=(0, 0, -S3))
    frequency = sqrt(2 * K / float(upper["KBM"] or DENSITY * H * W / 2)) / (2 * pi)
    m.damping(1.0, frequency, "mass")
    m.damping(1.0, frequency, "internal")
    m.solve(1e-5)
    s1, start = S3, float(block(m, 0, 0.75 * H)["KY"])
    while float(block(m, x, y)["KY"]) > start - 0.01 * W:
        m.boundary(-W, W, H - 0.01, H + 0.01, stress=(0, 0, -PART))
        s1 += PART
        if not m.solve(1e-5, 4000):
            break
    if draw:
        case.draw(m, contacts=True)
    return s1 - PART / 2


def solve(case):
    angles, found = (40, 50, 60, 70), []
    for degrees in angles:
        b = radians(degrees)
        s1, want = strength(case, b, False), exact(b)
        found.append(s1)
        yield Answer(
            f"s1 for b = {degrees} degrees",
            "Pa",
            s1,
            want,
            {
                "half of a part": PART / 2,
                "give of the joint, s1/KN": want * want * W / K / (sin(b) * cos(b) - MU * cos(b) ** 2),
                "force ratio of rest": 1e-5 * want / (sin(b) * cos(b) - MU * cos(b) ** 2),
            },
        )
    b = np.linspace(36, 76, 80)
    curve = [exact(radians(one)) / 1e6 for one in b]
    case.graph(
        "inclination of the joint (degrees)",
        "strength s1 (MPa)",
        {"Jaeger": (b, curve)},
        [(angles, np.array(found) / 1e6)],
    )
