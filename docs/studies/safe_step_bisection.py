"""The true limit of the time-step found by runs, against that of the matrices, the bound and the estimate.

    python docs/studies/safe_step_bisection.py [SCENE ...] [--file FILE] [--out PICTURE]

A scene is brought near rest under a weight that closes its joints, and run for CYCLES cycles twice, once
shaken a little before: a step is unstable if the energy of motion of the difference has grown a millionfold
at any of LOOKS looks, or if a run ended in an error. The greatest stable step is bisected to 1 part in 500.
Results are appended to FILE, and scenes in it are not run again.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from naive.stiffness import Scene

from safe_step_picture import dots
from udec_ia import Model, UdecError
from udec_ia.running.stiffness_bound import damped_step
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.layout import offsets as g
from udec_ia.ops.common.block_ranges import chain
from udec_ia.running.critical_step import bound, estimate
from udec_ia.studies.verification_tools import fan

CYCLES, LOOKS, GROWN, SHAKE, FINE = 800, 40, 1e6, 1e-7, 1 / 500
BULK, SHEAR, KN = 1e9, 6e8, 1e9
Materials = dict[int, tuple[float, float]]


def empty(density: float = 1.0) -> Model:
    """Without blocks, with two materials. density: of the second, over that of the first."""
    m = Model(out="/tmp")
    m.tell = m.inform = lambda _: None
    for number, d in ((1, 1.0), (2, density)):
        m.property(number, density=2500 * d, kn=KN, ks=KN / 2, bulk=BULK, g=SHEAR, cohesion=1e30)
    return m


def stack(heights: list[float], across: int = 1, density: float = 1.0) -> Model:
    """Blocks on each other, or a grid of `across` columns, in a corner of two fixed blocks.

    density: of every other block, over that of the rest.
    """
    m = empty(density)
    m.round(min(min(heights) / 10, 0.02))
    top, right = sum(heights), float(across)
    m.block(-1, -1, -1, top, right, top, right, -1)
    for y in np.cumsum([0, *heights[:-1]]):
        m.split(-2, float(y), right + 1, float(y))
    for x in range(across):
        m.split(x, -2, x, top + 1)
    m.fix(-1, right, -1, 0)
    m.fix(-1, 0, -1, top)
    for row in [*m.table("block")][::2]:
        x, y = float(row["KX"]), float(row["KY"])
        if density != 1:
            m.change(x - 1e-9, x + 1e-9, y - 1e-9, y + 1e-9, material=2)
    heavy = max(density, 1.0)
    m.gravity(-3 / heavy, -10 / heavy)
    return m


def pressed(ratio: float) -> Model:
    """A free column whose middle joint is stiffer by `ratio`, and pressed together by a pair of forces.

    It overlaps as it does with the usual stiffness under the weight, so that nothing moves. Under the weight
    alone, a joint of 1e12 times that stiffness would overlap by less than the last digit of a coordinate.
    """
    m = stack([1.0] * 4)
    m.delete(-1, 0, 0, 4)
    m.gravity(0, -10)
    m.solve(1e-6, limit=3000, static=True)
    m.property(2, kn=KN * ratio, ks=KN * ratio / 2, cohesion=1e30)
    force = 0.0
    for row in m.table("contact"):
        if round(float(row["KYC"]), 3) == 2:
            putr(m.h, int(row["address"]), g.KCFN, KN * ratio * float(row["KCN"]))
            puti(m.h, int(row["address"]), g.KCM, 2)
            force += KN * (ratio - 1) * float(row["KCN"])
    m.boundary(0, 1, 2, 3, yforce=-force)
    m.boundary(0, 1, 1, 2, yforce=force)
    return m


def wedges() -> Model:
    """Eight that meet in a point, one of them fixed, under a pressure from outside."""
    m = empty()
    m.round(0.02)
    m.block(-1, -1, -1, 1, 1, 1, 1, -1)
    for angle in np.pi * (np.arange(4) / 4 + 0.1):
        x, y = 2 * float(np.cos(angle)), 2 * float(np.sin(angle))
        m.split(-x, -y, x, y)
    m.fix(-1, 1, -1, -0.6)
    for low in (-1.1, 0.9):
        m.boundary(low, low + 0.2, -2, 2, stress=(-1e5, 0, -1e5))
        m.boundary(-2, 2, low, low + 0.2, stress=(-1e5, 0, -1e5))
    return m


def soft(kind: str, bad: bool = False) -> Model:
    """A column of four deformable blocks."""
    m = stack([1.0] * 4)
    m.change(0, 1, 0, 4, type=kind)
    if kind == "fdef" and not bad:
        for y in range(4):
            m.generate(0, 1, y, y + 1, "automatic", edge=0.5)
    elif kind == "fdef":
        for y in (0.5, 1.5, 2.5, 3.5):
            fan(m, 0.5, y, edge_points=2)
    return m


def with_damping(give: Callable[[Model], None]) -> Callable[[], Model]:
    def build() -> Model:
        m = stack([1.0] * 4)
        give(m)
        return m

    return build


SCENES: dict[str, Callable[[], Model]] = {
    "column of 8": lambda: stack([1.0] * 8),
    "grid, 4 x 4": lambda: stack([1.0] * 4, 4),
    "slabs, 1:100": lambda: stack([0.01, 1.0, 0.01, 1.0]),
    "fan of 8 wedges": wedges,
    "a tiny block": lambda: stack([1.0, 0.001, 1.0]),
    **{f"stiffness 1:1e{k}": lambda k=k: pressed(10.0**k) for k in (3, 6, 9, 12)},
    **{f"mass 1:1e{k}": lambda k=k: stack([1.0] * 4, density=10.0**k) for k in (3, 6, 9)},
    "SDEF": lambda: soft("sdef"),
    "FDEF, good mesh": lambda: soft("fdef"),
    "FDEF, bad mesh": lambda: soft("fdef", bad=True),
    "no damping": lambda: stack([1.0] * 4),
    "MASS": with_damping(lambda m: m.damping(0.5, 50, "mass")),
    "STIFFNESS": with_damping(lambda m: m.damping(0.2, 100, "stiffness")),
    "LOCAL 0.8": with_damping(lambda m: m.damping(local=0.8)),
    "COMBINED 0.8": with_damping(lambda m: m.damping(combined=0.8)),
    "ADAPTIVE 0.7": with_damping(lambda m: m.damping(adaptive=0.7)),
    "KINETIC": with_damping(lambda m: m.damping(kinetic=True)),
}


def settled(build: Callable[[], Model]) -> Model:
    """The scene near rest, with the damping that it is judged with."""
    m = build()
    m.solve(1e-6, limit=3000, static=True)
    return m


def ready(step: float, file: Path, shaken: bool) -> Model:
    """The state in `file`, about to go on with that step."""
    m = Model(out="/tmp")
    m.tell = m.inform = lambda _: None
    m.restart(str(file))
    h = m.array.h
    m.cycle(0)
    rng = np.random.default_rng(1)
    contacts = m.table("contact")
    overlaps = contacts["KCFN"] / h.cr[g.AKN + contacts["KCM"] - 1]
    speed = SHAKE * float(min(overlaps[overlaps > 0])) / step if shaken else 0.0  # of the least in a cycle
    for ib in chain(h, int(h.ci[g.IBPNT]), g.KB):
        if iget(h, ib, g.KBFIX) == 0:
            for k, arm in ((g.KXD, 1.0), (g.KYD, 1.0), (g.KTD, float(getr(h, ib, g.KBRO)))):
                putr(h, ib, k, float(getr(h, ib, k)) + speed * rng.uniform(-1, 1) / arm)
    h.cr[g.TDEL] = step  # a FRACTION above 1 is none
    return m


def motion(one: Model, other: Model) -> float:
    """Twice the energy of motion of the difference of two runs."""
    a, b = one.table("block"), other.table("block")
    x, y, t = (a[k].astype(float) - b[k] for k in ("KXD", "KYD", "KTD"))
    return float((a["KBM"] * (x * x + y * y) + a["KBI"] * t * t).sum())


def grows(step: float, file: Path) -> bool:
    """True if a run of that step from the state in `file` is unstable."""
    pair = [ready(step, file, shaken) for shaken in (False, True)]
    begun = motion(*pair)
    try:
        for _ in range(LOOKS):
            for one in pair:
                one.cycle(CYCLES // LOOKS)
            if not motion(*pair) < GROWN * begun:
                return True
    except UdecError:
        return True
    return False


def look(name: str) -> list[str | float]:
    """Name, limit of the matrices, and over it: limit of the runs, bound, estimate."""
    m = settled(SCENES[name])
    state = Path("/tmp") / f"bisected-{''.join(filter(str.isalnum, name))}.h5"
    m.save(str(state))
    materials = {k: (float(m.h.cr[g.AKN + k - 1]), float(m.h.cr[g.AKS + k - 1])) for k in (1, 2)}
    limit = Scene(m, (BULK, SHEAR), materials).critical()
    low, high = 0.3, 1.5
    while high - low > FINE:
        middle = (low + high) / 2
        low, high = (low, middle) if grows(middle * limit, state) else (middle, high)
    safe = damped_step(m.h, bound(m.array).step)
    return [name, limit, low, safe / limit, estimate(m.array).step / limit]


def main() -> None:
    """Run what is not in the file yet, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", choices=[*SCENES, []])
    parser.add_argument("--file", type=Path, default=Path("bisected.csv"))
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    shown = {}
    known = {row[0]: row for row in csv.reader(given.file.open())} if given.file.exists() else {}
    print("| scene | limit of the matrices, s | by runs | safe bound | estimate |\n|---|---|---|---|---|")
    for name in given.scenes or SCENES:
        row = known.get(name)
        if row is None:
            row = [str(one) for one in look(name)]
            with given.file.open("a", newline="") as out:
                csv.writer(out).writerow(row)
        limit, *shares = map(float, row[1:])
        shown[name] = dict(zip(("runs", "bound", "estimate"), shares, strict=True))
        print(f"| {name} | {limit:.3e} | {' | '.join(f'{share:.3f}' for share in shares)} |", flush=True)
    if given.out:
        dots(shown, given.out)


if __name__ == "__main__":
    main()
