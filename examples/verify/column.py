"""A column of blocks compresses its joints

Each joint of a column of n blocks has two contacts, which carry the weight W of every block above them:

      +-----+  1
      +-----+  2         u = k W/(2 KN)   below block k from above
      +-----+ ...
      +-----+  n

Tolerance. The force ratio at which the run was ended, and the last digits of the places from which the
overlap is taken. Deformable blocks bulge by the strain e of the lowest one, and the shear forces that
hold them are then not quite level: they carry at most e of themselves.

Source: equilibrium, and the definition of KN (report of 1980, 2.6).
"""

import numpy as np

from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import on_base, settle

BLOCKS = ("rigid", "sdef", "fdef")
G, DENSITY, KN, SIDE, N = 10.0, 2000.0, 1e9, 2.0, 5
BULK, SHEAR = 4e9, 2e9
WEIGHT = DENSITY * SIDE**2 * G


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY, kn=KN, ks=KN, bulk=BULK, g=SHEAR, friction=0.5)
    m.fraction(0.1)
    m.round(0.1)
    on_base(case, m, SIDE, SIDE, N, width=8)
    m.gravity(0, -G)
    settle(case, m, 2 * KN, 8 * N**2 * WEIGHT / G / np.pi**2)  # about the mass of the lowest mode
    contacts = m.table("contact")
    contacts = contacts[contacts["KCFN"] > 0]
    strain = 0.0 if case.blocks == "rigid" else N * WEIGHT / SIDE / (BULK + 4 / 3 * SHEAR)
    level = np.round(contacts["KYC"] / SIDE).astype(int)
    for k in range(1, N + 1):
        exact = k * WEIGHT / (2 * KN)
        yield Answer(
            f"overlap below block {k}",
            "m",
            float(contacts["KCN"][level == N - k].mean()),
            exact,
            {
                "force ratio of rest": max(1e-10, 1e4 * case.last_digit) * N * WEIGHT / KN,
                "bulge, e Fs/KN": strain * float(abs(contacts["KCFS"]).max()) / KN,
                "last digits of places": 8 * case.last_digit * N * SIDE,
            },
        )
    case.draw(m, contacts=True)
