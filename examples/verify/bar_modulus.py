"""Modulus of a jointed bar, whatever its mesh and the number of blocks

The joints of a bar have the stiffness kn per length (JPROPERTY) and the spacing S. Its modulus under the
axial stress s does not depend on how many blocks it has or how these are meshed:

     ///|####|/X/|XX|/X/| <- s        1/Em = 1/E + 1/(kn S)
           S

The first block is fixed; what the end moves by is the closure of n - 1 joints and the strain of n - 1
blocks. There is no Poisson effect, K = 2G/3, so that E = 2G. Blocks with zones have meshes that do not fit
those of their neighbours, with four to seven contacts on a joint.

Tolerance. Strains are taken from the lengths that the stresses act on now: one part in 1/e, e the strain of
the bar. The force ratio at which the run was ended.

Source: R. Goodman, Methods of Geological Engineering in Discontinuous Rocks (1976).
"""

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import generate, rectangle

BLOCKS = ("fdef", "sdef")
REALS = 64  # strains are 1e-4
G, KN, DENSITY, LENGTH, STRESS = 3e9, 8e9, 2500.0, 5.0, 1e6


def solve(case):
    for n in (2, 5, 10):
        side = LENGTH / n
        m = case.model()
        m.property(1, density=DENSITY, bulk=2 * G / 3, g=G)
        m.jproperty(1, kn=KN, ks=KN / 2, friction=0.6)
        m.block(0, 0, 0, 1, LENGTH, 1, LENGTH, 0)
        for k in range(1, n):
            m.split(k * side, -1, k * side, 2, joint=1, jmaterial=1)
        m.fix(0, side, 0, 1)
        m.round(0.02)
        for k in range(1, n):
            if case.blocks == "fdef":
                rows = 2 + k % 3
                generate(m, rectangle(k * side, (k + 1) * side, 0, 1, rows, rows))
            else:
                m.change(k * side, (k + 1) * side, 0, 1, type="sdef")
        m.boundary(LENGTH - 0.001, LENGTH + 0.001, -1, 2, stress=(-STRESS, 0, 0))
        m.solve(1e-8, static=True)
        strain = (LENGTH - float(m.table("corner")["KXP"].max())) / (LENGTH - side)
        exact = 1 / (1 / (2 * G) + 1 / (KN * side))
        yield Answer(
            f"modulus, {n} blocks",
            "Pa",
            STRESS / strain,
            exact,
            {"strain": 2 * strain * exact, "force ratio of rest": 1e-6 * exact},
        )
        if n == 5:
            case.draw(m, contacts=True)
