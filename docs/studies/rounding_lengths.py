"""Rounding lengths from 1e-6 of an edge to half of it: overlaps, soundness, and the largest stable step.

    python docs/studies/rounding_lengths.py [--out FILE.png]

Three squares of 1 m, each of the weight W, stand on a fixed block. By statics each of the N contacts under
n squares sinks in by n W/(KN N). No overlap may exceed half of the rounding length, so there are two
stiffnesses: W/KN is 1e-8 or 1e-4 of an edge. In 64- and in 32-bit reals:

- overlap: at rest, the greatest error of the sum of the overlaps in a joint, over n W/KN. LOCAL damping at
  FRACTION 0.5 SAFE leads there.
- contacts: those that are closed then, from the lowest joint up.
- bound: the step of FRACTION 1 SAFE over the true limit, that of the matrices of mass and stiffness.
- shaken: 4000 cycles at FRACTION 1 SAFE, without damping, after all bodies have been given speeds so small
  that no joint opens: the greatest energy of motion in the last tenth over that in the first.
- LOCAL: the same with DAMPING LOCAL 0.8, of which the safe step takes account.

The checker looks at the state after each tenth: `unsound` if it finds anything. What the program refuses is
shown with its error number. Messages and warnings go to standard error.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from naive.stiffness import Scene

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g

ROUNDINGS = (1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 0.25, 0.4, 0.5, 0.51)
SINKING = (1e-8, 1e-4)  # W/KN
BUILDS = {"64": "i32r64", "32": "i32r32"}
STOREYS, WEIGHT, SHAKE = 3, 2000.0 * 10, 0.1
PARTS, CYCLES, EVERY = 10, 4000, 5  # cycles between two looks at the energy


def stack(build: str, sinking: float, rounding: float) -> Model:
    """The squares, before their first cycle."""
    m = Model(BUILDS[build], out="/tmp")
    where = f"{build} bits, W/KN {sinking:g}, rounding {rounding:g}"
    m.tell, m.inform = lambda text: print(f"{where}: {text}", file=sys.stderr), lambda _: None
    m.property(1, density=2000, kn=WEIGHT / sinking, ks=WEIGHT / sinking / 2, friction=0.5)
    m.gravity(0, -10)
    m.block(0, -1, 0, STOREYS, 1, STOREYS, 1, -1)
    for y in range(STOREYS):
        m.split(-1, y, 2, y)
    m.fix(0, 1, -1, 0)
    m.round(rounding)
    return m


def tenth(m: Model) -> float:
    """A tenth of the cycles and a look of the checker: AssertionError if it finds anything.

    Returns the greatest energy of motion.
    """
    greatest = 0.0
    for _ in range(CYCLES // PARTS // EVERY):
        m.cycle(EVERY)
        rows = m.table("block")
        x, y, t = (rows[k].astype(float) for k in ("KXD", "KYD", "KTD"))
        greatest = max(greatest, float((rows["KBM"] * (x * x + y * y) + rows["KBI"] * t * t).sum()) / 2)
    faults = m.check()
    assert not faults, str(faults[0])
    return greatest


def joints(m: Model, sinking: float) -> tuple[float, str]:
    """The error of the overlaps, and the numbers of closed contacts."""
    rows = m.table("contact")
    rows = rows[rows["KCFN"] > 0]
    of_joint = [rows[np.abs(rows["KYC"] - k) < 0.4] for k in range(STOREYS)]
    sums = [float(one["KCN"].astype(float).sum()) for one in of_joint]
    wrong = max(abs(one / (STOREYS - k) / sinking - 1) for k, one in enumerate(sums))
    return wrong, " ".join(str(len(one)) for one in of_joint)


def shaken(m: Model, sinking: float, local: float) -> float:
    """How much the energy of motion grows. local: damping."""
    m.damping(local=local)
    speed = SHAKE * sinking / 2 / float(m.h.cr[g.TDEL])
    rng = np.random.default_rng(1)
    for row in m.table("block"):
        if row["KBFIX"] == 0:
            for k in (g.KXD, g.KYD, g.KTD):
                putr(m.array.h, int(row["address"]), k, speed * rng.uniform(-1, 1))
    found = [tenth(m) for _ in range(PARTS)]
    return found[-1] / found[0]


def look(build: str, sinking: float, rounding: float) -> list[str]:
    """Overlap, contacts, bound, shaken and LOCAL, or why there are none from some point on."""
    cells: list[str] = []
    try:
        m = stack(build, sinking, rounding)
        m.damping(local=0.8)
        m.fraction(0.5, safe=True)
        for _ in range(PARTS):
            tenth(m)
        wrong, closed = joints(m, sinking)
        cells += [f"{wrong:.1e}", closed]
        kn = WEIGHT / sinking
        limit = Scene(m, (0, 0), (kn, kn / 2)).critical()
        m.damping(0, 1)
        m.fraction(1, safe=True)
        m.cycle(0)
        cells.append(f"{float(m.h.cr[g.TDEL]) / limit:.3f}")
        m.save("/tmp/rounding.h5")
        cells.append(f"{shaken(m, sinking, 0.0):.2g}")
        m.restart("/tmp/rounding.h5")
        cells.append(f"{shaken(m, sinking, 0.8):.2g}")
    except (UdecError, AssertionError) as error:
        print(f"{build} bits, W/KN {sinking:g}, rounding {rounding:g}: {error}", file=sys.stderr)
        cells.append(f"error {error.number}" if isinstance(error, UdecError) else "unsound")
    return cells + ["-"] * (5 - len(cells))


def draw(file: Path, curves: dict[str, list[tuple[float, float]]]) -> None:
    """Write a picture of the errors, by rounding length, of several models."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    for label, points in curves.items():
        axes.plot([one for one, _ in points], [one for _, one in points], "o-", ms=3, label=label)
    axes.set(xlabel="rounding length over edge", ylabel="error of the overlaps", xscale="log", yscale="log")
    figure.legend(fontsize="small", loc="outside right upper")
    figure.savefig(file, dpi=120)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    heads = [
        f"{what}, {build}" for build in BUILDS for what in ("overlap", "contacts", "bound", "shaken", "LOCAL")
    ]
    print(f"| W/KN | rounding | {' | '.join(heads)} |\n|---|---|{'---|' * len(heads)}")
    errors: dict[str, list[tuple[float, float]]] = {}
    for sinking in SINKING:
        for d in ROUNDINGS:
            found = {build: look(build, sinking, d) for build in BUILDS}
            print(
                f"| {sinking:g} | {d:g} | {' | '.join(cell for cells in found.values() for cell in cells)} |",
                flush=True,
            )
            for build, (wrong, *_) in found.items():
                if wrong[0].isdigit():
                    errors.setdefault(f"{build} bits, W/KN {sinking:g}", []).append((d, float(wrong)))
    if given.out:
        draw(given.out, errors)


if __name__ == "__main__":
    main()
