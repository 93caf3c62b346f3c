"""A shear box, and dilation under a stiff roof

A block of the length L is pushed along its joint, under a constant load N or under a roof that does not move:

          N            ////////
       +-----+         +------+         T = L KS u, at most L c + N tan phi
   T ->|     |     T ->|      |         rise = tan(psi) times the slip under N
    ---+-----+---   ---+------+---      base - roof = W, base = L KN (tan(psi) slip - rise)

Under the roof base and roof are springs in series, so that the normal force and the strength grow with the
slip (constant normal stiffness).

Tolerance. The block is driven sideways at a constant velocity. What the joint carries more or less than the
load accelerates the block upwards; LOCAL damping leaves some of these oscillations.

Source: C.-A. Coulomb, Essai sur une application des regles de maximis et minimis (1773); R. Goodman, Methods
of geological engineering in discontinuous rocks (1976).
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, step

BLOCKS = ("rigid",)
REALS = 64
K, FRICTION, COHESION, DILATION = 1e8, 0.5, 2e4, 0.2
LENGTH, DENSITY, LOAD, SPEED = 2.0, 2000.0, 1e5, 1e-3


def shear_box(case, roof):
    """The block between a floor and, if asked for, a roof without friction."""
    m = case.model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=K, ks=K, friction=FRICTION, cohesion=0.0 if roof else COHESION, dilation=DILATION)
    m.jproperty(2, kn=K, ks=K)
    m.block(0, 0, 0, 3, 4, 3, 4, 0)
    m.split(-1, 1, 5, 1, joint=1, jmaterial=1)
    m.split(-1, 2, 5, 2, joint=2, jmaterial=2)
    m.split(1, 1, 1, 2)
    m.split(3, 1, 3, 2)
    m.delete(0, 1, 1, 2)
    m.delete(3, 4, 1, 2)
    m.fix(0, 4, 0, 1)
    if roof:
        m.fix(0, 4, 2, 3)
    else:
        m.delete(0, 4, 2, 3)
    m.round(0.1)
    m.gravity(0, -LOAD / (DENSITY * LENGTH))
    m.damping(local=0.8)
    m.solve(1e-8)
    m.boundary(1.9, 2.1, 1.4, 1.6, xvel=SPEED, rotation=0.0)
    return m


def forces(m):
    """Normal forces of base and roof, and the shear force of the base."""
    rows = m.table("contact")
    base = rows["KYC"] < 1.5
    return rows["KCFN"][base].sum(), rows["KCFN"][~base].sum(), abs(rows["KCFS"][base].sum())


def solve(case):
    m = shear_box(case, roof=False)
    start, peak = block(m, 2, 1.5), LENGTH * COHESION + FRICTION * LOAD
    for share in (0.5, 3.0):
        while block(m, 2, 1.5)["KX"] - start["KX"] < share * peak / (LENGTH * K):
            m.cycle(20)
        u, rise = (float(block(m, 2, 1.5)[k] - start[k]) for k in ("KX", "KY"))
        base, _, shear = forces(m)
        lag = {"load that accelerates it": abs(base - LOAD), "a step": LENGTH * K * SPEED * step(m)}
        if share < 1:
            yield Answer("shear force before the peak", "N/m", shear, LENGTH * K * u, lag)
        else:
            yield Answer("shear force at the peak", "N/m", shear, peak, lag)
            slip = u - shear / (LENGTH * K)
            within = {"load that accelerates it": abs(base - LOAD) / (LENGTH * K), "a step": 1e-3 * slip}
            yield Answer("rise", "m", rise, DILATION * slip, within)
    m = shear_box(case, roof=True)
    start = block(m, 2, 1.5)
    sunk = LOAD / (LENGTH * K)
    while block(m, 2, 1.5)["KX"] - start["KX"] < 8e-3:
        m.cycle(50)
    u, rise = (float(block(m, 2, 1.5)[k] - start[k]) for k in ("KX", "KY"))
    base, roof, shear = forces(m)
    lag = {"load that accelerates it": abs(base - roof - LOAD) + 1e-3 * LOAD}
    slip = u - shear / (LENGTH * K)
    exact = (LOAD + DILATION * slip * LENGTH * K) / 2  # of the base: both springs in series
    yield Answer("normal force under a stiff roof", "N/m", base, exact, lag)
    yield Answer("force on the roof", "N/m", roof, LENGTH * K * (rise - sunk), lag)
    yield Answer("strength under a stiff roof", "N/m", shear, FRICTION * base, lag)
    case.draw(m, joints="slip")
