"""Does the recommendation of `udec trade` hold, on decks that nobody had in mind when it was written?

    python docs/studies/trade_on_random_decks.py [--decks 50] [--seed 1] [--out DIR]

Random decks of six kinds: a block slides down a slope, a stack settles, a wall comes to rest by SOLVE,
blocks slide on a joint, a deformable column is loaded, a block falls on another one. For each a tolerance
is drawn, the study made, and its recommendation is judged against a truth that it has not seen: 64-bit reals and steps
of an eighth and a sixteenth of the finest that the study has used, extrapolated. The cheapest setting
is looked for on a ladder of steps that is three times as fine, in both word schemes; costs are those of
cycles, without preparing.
"""

from __future__ import annotations

import argparse
import io
import math
import random
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

from udec_ia.studies.accuracy_study import AccuracyStudy, study_accuracy
from udec_ia.studies.extrapolation import extrapolate
from udec_ia.studies.setting_runner import Options, SettingRunner
from udec_ia.studies.settings import BEYOND, Setting, rounded, share_of_bound

FINE = 2 ** (1 / 4)
TOLERANCES = (1e-2, 3e-3, 1e-3)


@dataclass
class Verdict:
    """Of one deck. error: of the recommendation, against the truth. times: its cost over the cheapest."""

    kind: str
    tolerance: float
    recommended: str
    error: float = math.nan
    times: float = math.nan
    cheapest: str = ""

    @property
    def holds(self) -> bool:
        return self.error <= self.tolerance

    @property
    def cheap(self) -> bool:
        return self.times <= 1.5


# ---- decks


def _material(r: random.Random) -> str:
    kn = 10 ** r.uniform(7.5, 9)
    friction = r.uniform(0.2, 0.9)
    density, shear = r.uniform(1500, 3000), r.uniform(0.3, 1)
    return f"DENS={density:.0f} KN={kn:.3g} KS={kn * shear:.3g} FRICTION={friction:.3f}"


def _fraction(r: random.Random) -> str:
    return f"FRACTION {r.choice((0.01, 0.02, 0.05, 0.1))}\n"


def _damping(r: random.Random) -> str:
    return f"DAMP {r.uniform(0.1, 0.8):.2f} {r.uniform(1, 10):.2f} MASS\n"


def slope(r: random.Random) -> str:
    """A block that slides or stays."""
    material, left, right = _material(r), r.uniform(0, 1), r.uniform(4, 8)
    low, high = (left + (right - left) * (x + 1) / 16 - 0.5 for x in (9, 12))  # the cuts begin in the base
    return (
        f"START\nPROP MAT=1 {material}\nBLOCK 0,-2 0,10 14,10 14,-2\n"
        f"SPLIT -1,{left:.3f} 15,{right:.3f}\nSPLIT 9,{low:.3f} {r.uniform(7, 8.5):.3f},11\n"
        f"SPLIT 12,{high:.3f} 12,11\nDELETE 0,8 4,10\nDELETE 12,14 4,10\n"
        f"FIX 0,14 -2,4\nROUND {r.uniform(0.1, 0.4):.3f}\nGRAVITY 0,-9.81\n{_fraction(r)}"
        f"{_damping(r) if r.random() < 0.5 else ''}CYCLE {r.randint(2000, 6000)}\nSTOP\nEND\n"
    )


def stack(r: random.Random) -> str:
    """Blocks upon each other settle under their weight."""
    n, size = r.randint(2, 5), r.uniform(1, 4)
    cuts = "".join(f"SPLIT -1 {k * size:.4f} {size + 1:.4f} {k * size:.4f}\n" for k in range(1, n))
    return (
        f"START\nPROP MAT=1 {_material(r)}\n"
        f"BLOCK 0,0 0,{n * size:.4f} {size:.4f},{n * size:.4f} {size:.4f},0\n"
        f"{cuts}FIX 0 {size:.3f} 0 {size:.3f}\nROUND {0.1 * size:.3f}\nGRAVITY {r.uniform(0, 1):.2f},-10\n"
        f"{_fraction(r)}{_damping(r)}"
        f"CYCLE {r.randint(1000, 3000)}\nCYCLE {r.randint(1000, 3000)}\nSTOP\nEND\n"
    )


def _wall(r: random.Random) -> str:
    rows, columns = r.randint(2, 4), r.randint(2, 5)
    cuts = "".join(f"SPLIT -1 {k} {columns + 1} {k}\n" for k in range(1, rows))
    cuts += "".join(f"SPLIT {k} -1 {k} {rows + 1}\n" for k in range(1, columns))
    return (
        f"START\nPROP MAT=1 {_material(r)}\nBLOCK 0,0 0,{rows} {columns},{rows} {columns},0\n{cuts}"
        f"FIX 0 {columns} 0 1\nROUND {r.uniform(0.02, 0.1):.3f}\nGRAVITY 0,-10\n{_fraction(r)}"
    )


def wall(r: random.Random) -> str:
    """A wall comes to rest."""
    return f"{_wall(r)}DAMP 0.5 {r.uniform(5, 20):.1f} MASS\nSOLVE {r.choice(('1E-2', '1E-3'))}\nSTOP\nEND\n"


def shove(r: random.Random) -> str:
    """A wall settles, and is then shoved sideways by a gravity that leans."""
    return (
        f"{_wall(r)}{_damping(r)}CYCLE {r.randint(1000, 3000)}\nGRAVITY {r.uniform(2, 8):.2f},-10\n"
        f"CYCLE {r.randint(1000, 3000)}\nSTOP\nEND\n"
    )


def column(r: random.Random) -> str:
    """A simply-deformable column under a load."""
    bulk = 10 ** r.uniform(8, 9)
    return (
        f"START\nPROP MAT=1 {_material(r)} BULK={bulk:.3g} G={bulk * 0.6:.3g}\nBLOCK 0,0 0,6 2,6 2,0\n"
        f"SPLIT -1 2 3 2\nSPLIT -1 4 3 4\nFIX 0 2 0 2\nCHANGE 0 2 2 6 SDEF\nROUND 0.1\n"
        f"GRAVITY {r.uniform(0, 2):.2f},-10\n{_fraction(r)}{_damping(r)}"
        f"CYCLE {r.randint(2000, 6000)}\nSTOP\nEND\n"
    )


def fall(r: random.Random) -> str:
    """A block falls on another one."""
    gap = r.uniform(0.02, 0.5)
    return (
        f"START\nPROP MAT=1 {_material(r)}\nBLOCK 0,0 0,6 2,6 2,0\n"
        f"SPLIT -1 2 3 2\nSPLIT -1 {2 + gap:.4f} 3 {2 + gap:.4f}\nDELETE 0 2 2 {2 + gap:.4f}\n"
        f"FIX 0 2 0 2\nROUND 0.1\nGRAVITY {r.uniform(0, 1):.2f},-10\n{_fraction(r)}"
        f"{_damping(r)}CYCLE {r.randint(2000, 6000)}\nSTOP\nEND\n"
    )


KINDS = (slope, stack, wall, shove, column, fall)


# ---- judging


def truth(study: AccuracyStudy, runner: SettingRunner) -> dict[str, float]:
    """The quantities, as well as can be had."""
    finest = study.levels[-1].setting
    rows = [runner.row(Setting(finest.build, finest.step / k, ratio=finest.ratio / 10)) for k in (2, 8, 16)]
    runner.run_rows(rows)
    values = [[row.result.quantities[name] for row in rows if row.result] for name in study.known]
    found = [extrapolate(one, 12.0) for one in values]
    return {name: one.value for name, one in zip(study.known, found, strict=True)}


def error(quantities: dict[str, float], true: dict[str, float]) -> float:
    """The greatest of all relative errors."""
    return max(abs(quantities[name] - value) / abs(value) if value else 0.0 for name, value in true.items())


def over_cheapest(study: AccuracyStudy, runner: SettingRunner, true: dict[str, float]) -> tuple[float, str]:
    """Seconds of what is recommended over those of the cheapest within the tolerance, and its name."""
    steps = [rounded(FINE**k) for k in range(-8, 17)]
    settings = [Setting(build, step) for build in runner.builds for step in steps]
    settings = [one for one in settings if share_of_bound(runner.survey, one) <= BEYOND]
    settings += [row.setting for row in study.rows if row.ran and row.setting.step >= steps[0]]
    assert study.best is not None
    rows = [runner.row(one) for one in dict.fromkeys([study.best.setting, *settings])]
    runner.run_rows(rows)
    costs = [row.cost for row in rows]
    within = [
        (cost, row.setting.name)
        for row, cost in zip(rows, costs, strict=True)
        if row.ran and row.result and error(row.result.quantities, true) <= study.tolerance
    ]
    return (costs[0] / min(within)[0], min(within)[1]) if within else (math.nan, "")


def judge_deck(kind: str, text: str, tolerance: float, folder: Path) -> Verdict:
    """The verdict on one deck."""
    options = Options(tolerance=tolerance, jobs=0, stream=io.StringIO())
    found = study_accuracy(text, f"{kind}.dat", {}, folder, options)
    best = found.best
    if best is None or best.result is None:
        reason = "nothing comparable" if not found.known else "none within"
        return Verdict(kind, tolerance, reason if found.rows else found.notes[-1])
    with SettingRunner(found.deck, replace(options, budget=math.inf), folder) as runner:
        runner.run_own_deck()
        true = truth(found, runner)
        times, cheapest = over_cheapest(found, runner, true)
    return Verdict(kind, tolerance, best.setting.name, error(best.result.quantities, true), times, cheapest)


def main() -> int:
    """Study as many decks as are asked for, and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--decks", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, help="folder that keeps the decks and their runs")
    args = parser.parse_args()
    found: list[Verdict] = []
    with tempfile.TemporaryDirectory() as temporary:
        for k in range(args.decks):
            r = random.Random(f"{args.seed} {k}")
            kind = KINDS[k % len(KINDS)]
            text, tolerance = kind(r), r.choice(TOLERANCES)
            folder = (args.out or Path(temporary)) / f"{k}"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "random.dat").write_text(text)
            one = judge_deck(kind.__name__, text, tolerance, folder)
            found.append(one)
            print(
                f"{k:3d} {one.kind:7s} {one.tolerance:7.0e} {one.recommended:32s} error {one.error:8.1e} "
                f"{'holds' if one.holds else '-----'}  cost {one.times:5.2f} of {one.cheapest}",
                flush=True,
            )
    given = [one for one in found if not math.isnan(one.error)]
    print(
        f"{len(found)} decks: {len(given)} recommendations, {sum(one.holds for one in given)} hold, "
        f"{sum(one.cheap for one in given)} cost at most 1.5 times the cheapest"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
