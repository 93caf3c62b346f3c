"""The safe bound over random scenes: never above the true limit, and how far below.

Each scene is prepared by the program, and its matrices are put together from its tables by an oracle that
shares no code with it (tests/naive/stiffness.py). The true limit is where an eigenvalue of the linear system
first leaves the unit circle. Scenes are known by kind and seed: a search that was cut off goes on behind
what its file holds.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from naive.stiffness import Scene

from support.safe_step_scenes import draw
from udec_ia import UdecError
from udec_ia.running.critical_step import bound, estimate

LIMITS = {"rigid": 1 / 2, "deformable": 1 / 3}  # of the true limit, which the bound is never to be below
ROUNDING = 1e-6  # of the oracle's eigenvalues, whose masses and stiffnesses may differ by 1e12


class Found(NamedTuple):
    """A scene: the true limit in s, and estimate and bound over it. error: what refused it, or 0."""

    kind: str
    seed: int
    layout: str
    blocks: int
    limit: float
    estimate: float
    bound: float
    error: int


def look(kind: str, seed: int) -> Found:
    """Draw a scene and compare."""
    try:
        scene = draw(kind, seed)
        scene.model.cycle(0)
    except UdecError as error:
        return Found(kind, seed, "", 0, np.nan, np.nan, np.nan, error.number)
    m = scene.model
    many = len(m.table("block"))
    matrices = Scene(m, scene.moduli, scene.joints)
    if not np.setdiff1d(np.arange(len(matrices.mass)), matrices.held).size or not np.any(matrices.stiffness):
        return Found(kind, seed, scene.layout, many, np.inf, np.nan, np.nan, 0)  # all is held
    limit = matrices.critical()
    return Found(
        kind, seed, scene.layout, many, limit, estimate(m.array).step / limit, bound(m.array).step / limit, 0
    )


def search(kinds: Iterable[str], first: int, count: int, file: Path) -> None:
    """Look at `count` scenes of each kind from seed `first` on; write them to `file`, but for those in it."""
    done = {(one.kind, one.seed) for one in read(file)} if file.exists() else set()
    with file.open("a", newline="") as out:
        writer = csv.writer(out)
        if not done:
            writer.writerow(Found._fields)
        for seed in range(first, first + count):
            for kind in kinds:
                if (kind, seed) not in done:
                    writer.writerow(look(kind, seed))
            if seed % 100 == 99:
                out.flush()
                print(f"{seed + 1 - first} of {count}", file=sys.stderr, flush=True)


def read(file: Path) -> Iterator[Found]:
    """What a search has found."""
    with file.open(newline="") as rows:
        for row in csv.DictReader(rows):
            text = {name: row[name] for name in ("kind", "layout")}
            whole = {name: int(row[name]) for name in ("seed", "blocks", "error")}
            reals = {name: float(row[name]) for name in ("limit", "estimate", "bound")}
            yield Found(**text, **whole, **reals)


def summary(found: list[Found]) -> Iterator[list[Any]]:
    """Rows of a table: kind, layout, scenes, bound over limit (least, median), and estimates above it."""
    for kind in LIMITS:
        of_kind = [one for one in found if one.kind == kind and np.isfinite(one.bound)]
        for layout in [*sorted({one.layout for one in of_kind}), ""]:
            rows = [one for one in of_kind if layout in ("", one.layout)]
            if rows:
                shares, guesses = (np.array([getattr(one, k) for one in rows]) for k in ("bound", "estimate"))
                yield [
                    kind,
                    layout or "all",
                    f"{len(rows):,}",
                    *(f"{q:.3f}" for q in np.quantile(shares, [0, 0.01, 0.5, 1])),
                    *(f"{q:.2f}" for q in np.quantile(guesses, [0, 0.5, 1])),
                    str(int((shares > 1 + ROUNDING).sum())),
                    str(int((shares < LIMITS[kind]).sum())),
                ]
