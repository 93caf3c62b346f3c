r"""A block on a plane with a crack full of water behind it

A block lies on a plane without cohesion. In the crack behind it stands water of the depth zw, which seeps
along the plane to its toe:

     .-------+ crack          V = rho g zw^2/2                       thrust in the crack
     |       |~~~             U = rho g zw A/2                       uplift, A: length of the plane
     |  W    |  zw            N = W cos psi - U - V sin psi
      \      |                T = W sin psi + V cos psi
        '-.  |                it slides if tan phi < T/N
     psi   '-+

The pressures are HELD: that in the crack grows from 0 at the level, that on the plane falls from the foot of
the crack to 0 at the toe. With less friction, tan phi = f, the block is let down slowly by a horizontal force

     F = V + U sin psi + N' (sin psi - f cos psi)      N' = (W - U cos psi)/(cos psi + f sin psi)

which is 0 at the limit, f = T/N.

Tolerance. The force ratio of rest, and strain. A crossing has the pressure of the mean of its contacts, up to
D from its walls of the length D. The block moves at a constant velocity, with damping in the joint; pressures
stay where they are while it moves.

Source: E. Hoek and J. Bray, Rock slope engineering (1974), plane failure with a tension crack.
"""

import copy
from math import atan, cos, hypot, pi, sin, sqrt

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import cycle_for, fan

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # the joint closes by micrometres
WIDE, TOE, DEEP, D = 8.0, 7.0, 3.0, 0.01  # width of the block, height at the toe, depth of the crack
PSI, PLANE = atan((TOE - DEEP) / WIDE), hypot(WIDE, TOE - DEEP)
ROCK, WATER, G, KN, BULK, SHEAR, REST = 2500.0, 1000.0, 10.0, 1e10, 2e10, 1e10, 1e-7
AREA = WIDE * (TOE + DEEP) / 2
SPEED, WAY = 1e-3, 1e-3


def forces(depth):
    """T and N of the plane for the depth of water in the crack."""
    weight = ROCK * G * AREA
    v, u = WATER * G * depth**2 / 2, WATER * G * depth * PLANE / 2
    return weight * sin(PSI) + v * cos(PSI), weight * cos(PSI) - u - v * sin(PSI)


def at_rest(case, depth):
    """The block at rest with much friction."""
    m = case.model()
    m.property(1, density=ROCK, bulk=BULK, g=SHEAR)
    m.jproperty(1, kn=KN, ks=KN, friction=4.0, aperture=1e-3)
    m.jproperty(2, kn=KN, ks=KN, aperture=1e-3)
    m.block(0, -6, 0, TOE, WIDE + 4, TOE, WIDE + 4, -6)  # the lowest centroid is below y = 0
    rise = (TOE - DEEP) / WIDE
    m.split(-2, -2 * rise, WIDE + 6, (WIDE + 6) * rise, joint=1, jmaterial=1)
    m.split(WIDE, TOE - DEEP - 0.1, WIDE, TOE + 1, joint=2, jmaterial=2)
    blocks = m.table("block")
    one = blocks[blocks["KX"].argmin()]
    x, y = float(one["KX"]), float(one["KY"])
    m.fix(0, WIDE + 4, -6, TOE)
    m.free(x - 0.1, x + 0.1, y - 0.1, y + 0.1)
    m.round(D)
    if case.blocks == "sdef":
        m.change(x - 0.1, x + 0.1, y - 0.1, y + 0.1, type="sdef")
    elif case.blocks == "fdef":
        fan(m, x, y, edge_points=1)
    m.gravity(0, -G)
    if depth > 0:
        m.fluid(density=WATER, mode="drained")
        near = WIDE - 0.1, WIDE + 0.1
        m.ppressure(*near, TOE - DEEP - 0.1, TOE, level=TOE - DEEP + depth, state="held")
        m.ppressure(0, WIDE - 0.1, 0, TOE - DEEP, 0.0, pxgrad=WATER * G * depth / WIDE, state="held")
    m.solve(REST, static=True)
    return m


def held_by(case, m, friction):
    """Force that holds the block as it slides down with this friction."""
    m = copy.deepcopy(m)
    m.jproperty(1, friction=friction)
    m.damping(1.0, sqrt(KN * PLANE / (ROCK * AREA)) / (2 * pi), "stiffness")
    # centroid or grid-points of the block; it moves up and down freely
    if case.blocks == "fdef":
        m.boundary(-0.01, WIDE + 0.01, -0.01, TOE + 0.01, xvel=-SPEED)
    else:
        m.boundary(1, WIDE - 1, 2, TOE, xvel=-SPEED, rotation=0)
    m.cycle(1)
    cycle_for(m, WAY / SPEED)
    return float(m.reactions(-0.1, WIDE + 0.1, -0.1, TOE + 0.1)["fx"].sum())


def solve(case):
    found, curve = [], []
    for depth in (0.0, 2.0, DEEP):
        name = f"water {depth:g} m deep"
        shear, normal = forces(depth)
        m = at_rest(case, depth)
        rows = m.table("contact")
        on_plane = abs(rows["KYC"] - rows["KXC"] * (TOE - DEEP) / WIDE) < 1e-3
        share = {"force ratio of rest": REST, "strain": ROCK * G * TOE / BULK}
        within = {why: part * normal for why, part in share.items()} | {"crossings": WATER * G * D * 4 * D}
        computed = float(rows["KCFN"][on_plane].sum())
        yield Answer(f"normal force, {name}", "N/m", computed, normal, within)
        computed = float(abs(rows["KCFS"][on_plane].sum()))
        yield Answer(f"shear force, {name}", "N/m", computed, shear, within)
        if depth == DEEP:
            case.draw(m, contacts=True)
        weight = ROCK * G * AREA
        v, u = WATER * G * depth**2 / 2, WATER * G * depth * PLANE / 2
        for part in (0.5, 0.75, 1.0) if depth == DEEP else (0.5, 1.0):
            f = part * shear / normal
            force = held_by(case, m, f)
            pressed = (weight - u * cos(PSI)) / (cos(PSI) + f * sin(PSI))
            sliding = within | {"way of the block": WATER * G * depth * WAY}
            exact = v + u * sin(PSI) + pressed * (sin(PSI) - f * cos(PSI))
            yield Answer(
                f"holding force, {name}, f = {part:g} T/N", "N/m", force, exact if part < 1 else 0.0, sliding
            )
            if depth == DEEP:
                found.append((f, force / 1e3))
                curve.append((f, exact / 1e3))
    case.graph(
        "friction coefficient f",
        "holding force (kN/m)",
        {"exact": tuple(zip(*curve, strict=True))},
        [tuple(zip(*found, strict=True))],
    )
