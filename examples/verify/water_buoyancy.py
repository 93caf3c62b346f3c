r"""Buoyancy of a block

A block is surrounded by joints that are full of water at rest. It stands on the joint below it; the others
open, as it sinks on it, and carry nothing:

            level   ~~~~~~~~~~            N = (rho_r - rho_w) g V      under water
        ---+-----------+---               N = rho_r g V - rho_w g V'   V' is below the level
          /             \
         /       V       \    sides narrow upwards; no water: N = rho_r g V
     ---+-----------------+---

The pressures are those of PPRESSURE ... LEVEL and do not change (DRAINED). Those of a joint are uniform, that
of its middle, or vary along it if they are HELD. Where the level cuts the block they have to be HELD.

Tolerance. The force ratio of rest, and strain, which changes V. A crossing has the pressure of the mean of
its contacts, at most 2D from its walls of the length D, four of them.

Source: Archimedes, On floating bodies; K. Terzaghi, Theoretical soil mechanics (1943), effective stress.
"""

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import block, fan

BLOCKS = ("rigid", "sdef", "fdef")
REALS = 64  # the joint closes by micrometres
BASE, TOP, HIGH, D, KN, REST = 4.0, 3.0, 2.0, 0.01, 1e10, 1e-7
ROCK, WATER, G, BULK, SHEAR = 2500.0, 1000.0, 10.0, 2e11, 1e11
WIDE, FLOOR = 8.0, 2.0  # of the scene, and where the block stands


def scene(case):
    """The block among fixed ones."""
    m = case.model()
    m.property(1, density=ROCK, bulk=BULK, g=SHEAR)
    m.jproperty(1, kn=KN, ks=KN, aperture=1e-3, between=(1, 1))
    m.block(0, 0, 0, 6, WIDE, 6, WIDE, 0)
    for y in (FLOOR, FLOOR + HIGH):
        m.split(-1, y, WIDE + 1, y)
    for side in (-1, 1):
        lean = side * (TOP - BASE) / 2 / HIGH
        x = WIDE / 2 + side * BASE / 2
        m.split(x - 0.01 * lean, FLOOR - 0.01, x + (HIGH + 0.01) * lean, FLOOR + HIGH + 0.01)
    m.fix(0, WIDE, 0, 6)
    x, y = (float(block(m, WIDE / 2, 3)[name]) for name in ("KX", "KY"))
    m.free(x - 0.1, x + 0.1, y - 0.1, y + 0.1)
    m.round(D)
    if case.blocks == "sdef":
        m.change(x - 0.1, x + 0.1, y - 0.1, y + 0.1, type="sdef")
    elif case.blocks == "fdef":
        fan(m, x, y)
    m.gravity(0, -G)
    m.fluid(kw=2e9, density=WATER, mode="drained")
    return m


def solve(case):
    volume = (BASE + TOP) / 2 * HIGH
    weight = ROCK * G * volume
    half = (BASE + (BASE + TOP) / 2) / 2 * HIGH / 2  # below the middle
    for name, level, state, wet in (
        ("no water", None, None, 0.0),
        ("under water", 10.0, None, volume),
        ("under water, held", 10.0, "held", volume),
        ("half under water, held", FLOOR + HIGH / 2, "held", half),
    ):
        m = scene(case)
        if level is not None:
            m.ppressure(-1, WIDE + 1, -1, 7, level=level, state=state)
        m.solve(REST, static=True)
        rows = m.table("contact")
        below = np.abs(rows["KYC"] - FLOOR) < 5 * D
        exact = weight - WATER * G * wet
        within = {
            "force ratio of rest": REST * exact,
            "strain": weight / BASE / BULK * exact,
            "crossings": 4 * D * 2 * D * WATER * G if wet else 0.0,
        }
        yield Answer(f"force of the joint, {name}", "N/m", float(rows["KCFN"][below].sum()), exact, within)
        if wet == volume and state:
            case.draw(m, contacts=True)
        others = float(np.abs(rows["KCFN"][~below]).sum())
        yield Answer(f"force of the other joints, {name}", "N/m", others, 0.0, within)
