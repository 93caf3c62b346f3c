"""Scenes that word_scheme_costs.py runs in all word schemes: what each loses, what it takes, and when runs part."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from time import process_time
from typing import NamedTuple

import numpy as np

from udec_ia import Model, UdecError
from udec_ia.kernels.drive.unbalanced_force import force_ratio
from udec_ia.layout.offsets import MCTOT

EXAMPLES = Path(__file__).parents[2] / "examples"
LEFT_OUT = ("PLOT", "P ", "PRINT", "SAVE", "STOP", "END")
LOOKS = 20  # at the places of blocks, within each CYCLE
PARTED = 0.01  # of the farthest way that a block has gone: two runs have parted
TURNS, SLICE = 7, 0.04  # of each scheme, by turns, and how long one takes at least, in s


class Run(NamedTuple):
    """One scene in one scheme.

    model: None if IA() was too small. looks: of each, cycle and the centroids of all blocks, (n, 2).
    warned: "yes" if CYCLE warns that the reals are too coarse, else "no".
    """

    model: Model | None
    looks: list[tuple[int, np.ndarray]]
    warned: str


def wall() -> str:
    """20 x 10 squares of 1 m that come to rest."""
    cuts = [f"SPLIT -1,{y} 21,{y}" for y in range(1, 11)] + [f"SPLIT {x},0.99 {x},12" for x in range(1, 20)]
    return "\n".join(
        [
            "START",
            "PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5",
            *("BLOCK 0,0 0,11 20,11 20,0", *cuts, "FIX 0,20 0,1", "ROUND 0.05", "GRAVITY 0,-10"),
            *("DAMP 0.5 5 MASS", "SOLVE 1E-4 LIMIT 20000"),
        ]
    )


def footing() -> str:
    """3 x 3 simply-deformable blocks, loaded in the middle of the top."""
    cuts = [f"SPLIT -1,{y} 4,{y}" for y in range(3)] + [f"SPLIT {x},-0.01 {x},4" for x in (1, 2)]
    return "\n".join(
        [
            "START",
            "PROP MAT=1 DENS=2500 KN=1E10 KS=1E10 F=0.6 BULK=1E10 G=6E9",
            *("BLOCK 0,-1 0,3 3,3 3,-1", *cuts, "FIX 0,3 -1,0", "CHANGE 0,3 0,3 SDEF", "ROUND 0.02"),
            "BOUNDARY 0.95 2.05 2.95 3.05 STRESS 0,0,-1E6",
            "SOLVE 1E-4 LIMIT 20000 STATIC",
        ]
    )


def example(name: str) -> Callable[[], str]:
    """The deck of that name."""
    return lambda: (EXAMPLES / f"{name}.dat").read_text()


SCENES = {
    "ball": example("ball-rolling"),
    "wall of squares": wall,
    "jointed slope": example("jointed-slope"),
    "collapse": example("collapse-rigid"),
    "slab, 1,000 blocks": example("slab"),
    "footing, SDEF": footing,
    "opening, FDEF": example("opening"),
}


def pieces(text: str) -> Iterator[str]:
    """The lines of a deck, each CYCLE in LOOKS parts."""
    for line in text.splitlines():
        found = re.match(r"\s*CYC\w*\s+(\d+)", line, re.IGNORECASE)
        if found and int(found[1]) >= LOOKS:
            each, rest = divmod(int(found[1]), LOOKS)
            yield from [f"CYCLE {each + (k < rest)}" for k in range(LOOKS)]
        elif not line.strip().upper().startswith(LEFT_OUT):
            yield line


def centroids(m: Model) -> np.ndarray:
    """Of all blocks, in the order of their list."""
    blocks = m.table("block")
    return np.stack([np.asarray(blocks[k], float) for k in ("KX", "KY")], axis=1)


def run(text: str, build: str) -> Run:
    """The deck `text` in the words of `build`."""
    with tempfile.TemporaryDirectory() as folder:
        m = Model(build, out=folder)
        printed: list[str] = []
        m.tell = m.inform = lambda _: None
        looks, begun = [], 0
        try:
            for line in pieces(text):
                if not looks and line.upper().startswith(("CYC", "SOLVE")):
                    printed.append(
                        m.run("CYCLE 0") or ""
                    )  # which puts a large model's groups where they will stay
                    looks.append((0, centroids(m)))
                printed.append(m.run(line) or "")
                cycles, places = int(m.h.ci[MCTOT]), centroids(m)
                if looks and len(looks[-1][1]) != len(places):
                    looks = [(cycles, places)]  # blocks were taken away: what counts is what comes of it
                elif cycles > begun:
                    looks.append((cycles, places))
                begun = cycles
        except UdecError as error:
            if error.number not in (1, 2):
                raise
            return Run(None, [], "no")
    return Run(
        m,
        looks,
        "yes" if "the last digit of coordinates" in " ".join("".join(printed).split()) else "no",
    )


def forces(m: Model) -> tuple[float, float]:
    """Greatest force of a contact, and the root of the sum of the squares of all, in N/m."""
    contacts = m.table("contact")
    force = np.hypot(np.asarray(contacts["KCFN"], float), np.asarray(contacts["KCFS"], float))
    return float(force.max()), float(np.sqrt((force**2).sum()))


def rest(text: str, one: Run) -> str:
    """Force ratio at the end, of what was to come to rest."""
    assert one.model is not None
    return f"{float(force_ratio(one.model.h, True)):.1e}" if "SOLVE" in text.upper() else "-"


def way(one: Run) -> float:
    """The farthest that a block has gone from where it was at the first look."""
    start = one.looks[0][1]
    return max(float(np.hypot(*(places - start).T).max()) for _, places in one.looks)


def losses(wide: Run, narrow: Run) -> tuple[float, float, float, int]:
    """What `narrow` differs by from `wide`, and the cycle in which they part; 0 if they do not.

    Of the places at the end, as a part of the farthest way, and of the greatest and of all forces.
    """
    assert wide.model is not None
    assert narrow.model is not None
    apart = parting(wide, narrow)
    parted = int(next((cycle for cycle, off in apart if off > PARTED), 0))
    most, every = (abs(a / b - 1) for a, b in zip(forces(narrow.model), forces(wide.model), strict=True))
    return apart[-1][1], most, every, parted


def parting(wide: Run, narrow: Run) -> list[tuple[float, float]]:
    """Cycles, and by how much places differ there, as a part of the farthest way."""
    farthest = way(wide)
    pairs = zip(wide.looks, narrow.looks, strict=False)
    return [(cycle, float(np.hypot(*(a - b).T).max()) / farthest) for (cycle, a), (_, b) in pairs]


def times(models: dict[str, Model]) -> dict[str, float]:
    """Seconds that a cycle takes in each scheme, as medians of turns, each from the same state on."""
    slices: dict[str, int] = {}
    begin = {name: m.array.copy() for name, m in models.items()}
    for name, m in models.items():
        m.cycle(20)
        start = process_time()
        m.cycle(50)
        slices[name] = max(50, int(SLICE * 50 / max(process_time() - start, 1e-4)))
    found: dict[str, list[float]] = {name: [] for name in models}
    for _ in range(TURNS):
        for name, m in models.items():
            m.session.return_to(begin[name].copy(), [])
            m.cycle(20)
            start = process_time()
            m.cycle(slices[name])
            found[name].append((process_time() - start) / slices[name])
    return {name: median(turns) for name, turns in found.items()}
