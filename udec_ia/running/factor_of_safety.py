"""FOS: the factor by which strengths can be divided before blocks fail (strength reduction).

All trials begin with the same state, and are runs as of SOLVE ... STATIC. A trial is *stable* if it comes to
a force ratio of 1e-5. N, the cycles that the model needs for that after a kick if its strength is unlimited,
and 1000 at least, is the measure of the others: a trial *fails* if its mean ratio over N cycles is less
than a tenth below that over the N before, or if a block falls. After 6 N it is *undecided*, and does not
count.

Each round tries three factors, which quarter the bracket between the greatest stable and the next failing
one, in up to three processes. What they find does not depend on the number of processes.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic
from typing import Any

import numpy as np

from udec_ia.errors import DISORDERED, UdecError
from udec_ia.heap.accessors import HEAD, getr, iget, integers, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.unbalanced_force import force_ratios
from udec_ia.kernels.energy.stored_energy import strain_energy
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.strength_reduction import divide_strengths, remove_limits
from udec_ia.ops.common.kernel_arguments import soft, soft_or_loaded_in
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.printable_text import counted
from udec_ia.reader.list_walks import chain
from udec_ia.running.cycle_observer import Observer, between_cycles
from udec_ia.running.displacement_record import FALLEN, DisplacementRecord
from udec_ia.running.history_series import Recording
from udec_ia.running.run_cycles import cycle
from udec_ia.running.static_relaxation import static_settings

RATIO = 1e-5  # force ratio of a stable state
ALIKE = 0.1  # part of the mean ratio by which it must fall, or the trial does not get nearer to rest
WINDOWS = 6  # of N cycles, at most
SHORTEST, LONGEST = 1000, 100_000  # N
KICK = 0.01  # kinetic energy of the kick over the strain energy
LOOKS = 50  # at the ratio, in a window
FIRST = (0.5, 1.0, 2.0)  # the factors of the first round; in the next ones 8 times these, or an eighth
LARGEST = 100.0  # factor from which on nothing is sought
FINEST = 1e-9  # width of a bracket over its middle, which is not divided any more
STABLE, FAILING, UNDECIDED = "stable", "failing", "undecided"
BY_ITSELF = 1.0  # seconds of a trial, from which on trials run in processes of their own


@dataclass
class Trial:
    """A run with strengths divided by `factor`.

    ratio: force ratio at its end, or the mean of the last N cycles where it has not come to rest. moved:
    greatest displacement of a block in m, at (x, y). fallen: number of blocks that have fallen. array: the
    state at its end.
    """

    factor: float
    verdict: str
    cycles: int
    ratio: float
    moved: float
    x: float
    y: float
    fallen: int
    array: MainArray | None = field(default=None, repr=False)

    @property
    def line(self) -> str:
        """A line of the table."""
        fallen = f", {counted(self.fallen, 'block')} fallen" if self.fallen else ""
        return (
            f"{self.factor:10.5g}  {self.verdict:9}  {self.cycles:7}  {self.ratio:9.3g}  {self.moved:9.3g}  "
            f"({self.x:.4g}, {self.y:.4g}){fallen}"
        )


@dataclass(repr=False)
class FactorOfSafety:
    """The result of FOS.

    stable, failing: the trials with the greatest stable and the least failing factor; None if there is none.
    n: cycles of N. trials: all, by their factors. files: of the picture. tolerance: see factor_of_safety.
    """

    stable: Trial | None
    failing: Trial | None
    n: int
    trials: list[Trial]
    files: list[Path] = field(default_factory=list)
    tolerance: float = FINEST

    @property
    def bracket(self) -> tuple[float, float]:
        """The greatest stable factor, 0 for none, and the least failing one, infinite for none."""
        return (
            self.stable.factor if self.stable else 0.0,
            self.failing.factor if self.failing else np.inf,
        )

    @property
    def factor(self) -> float:
        """The middle of the bracket; not a number if one of its ends was not found."""
        low, high = self.bracket
        return (low + high) / 2 if self.stable and self.failing else np.nan

    @property
    def is_found(self) -> bool:
        """True if the bracket is as narrow as the tolerance."""
        low, high = self.bracket
        known = self.stable is not None and self.failing is not None
        return known and high - low <= max(self.tolerance, FINEST) * (high + low) / 2

    def __repr__(self) -> str:
        return str(self)

    def __str__(self) -> str:
        low, high = self.bracket
        if self.stable is None and self.failing is None:
            head = "factor of safety unknown: all trials are undecided"
        elif self.failing is None:
            head = f"factor of safety above {low:.4g}: nothing fails"
        elif self.stable is None:
            head = f"factor of safety below {high:.4g}: nothing is stable"
        else:
            head = f"factor of safety {self.factor:.4g}: stable at {low:.5g}, failing at {high:.5g}"
            if not self.is_found:
                head += f" (a bracket wider than {self.tolerance:g}: trials between are undecided)"
        many = counted(len(self.trials), "trial")
        columns = f"{'factor':>10}  {'':9}  {'cycles':>7}  {'ratio':>9}  {'moved (m)':>9}  at"
        lines = [f"{head}; {many}, N = {self.n} cycles", columns, *(one.line for one in self.trials)]
        return "\n".join([*lines, *(f"written: {path}" for path in self.files)])


class _MeanRatio(Observer):
    """The mean of the force ratio over a run."""

    def __init__(self, n: int) -> None:
        self.every, self.ratios = max(n // LOOKS, 1), list[float]()

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        return min(n, self.every)

    def look(self, array: MainArray, cycles: int) -> None:
        if between_cycles(array.h):
            self.ratios.append(float(force_ratios(array.h, soft_or_loaded_in(array.h))[0]))

    @property
    def mean(self) -> float:
        """The mean, 0 for none."""
        return float(np.mean(self.ratios)) if self.ratios else 0.0


def response_cycles(array: MainArray, laws: LawBook) -> int:
    """N: cycles to the force ratio RATIO after a kick, with unlimited strength. Error 26 without rest."""
    one = _copy(array)
    remove_limits(one)
    with static_settings(one):
        recording = Recording(one, [], RATIO)
        cycle(one, LONGEST, recording=recording, laws=laws)
        if recording.reached:
            _kick(one)
            recording = Recording(one, [], RATIO)
            n = cycle(one, LONGEST, recording=recording, laws=laws)
    if not recording.reached:
        detail = f"with unlimited strength the model is not at rest after {LONGEST:,} cycles"
        advice = "look for blocks that overturn or that nothing holds (SOLVE names them); take 64-bit reals"
        raise UdecError(26, detail, advice)
    return max(n, SHORTEST)


def _copy(array: MainArray) -> MainArray:
    """A copy without an account of its energy, which SOLVE ... STATIC excludes."""
    one = array.copy()
    one.h.ci[g.LENER] = 0
    return one


def _kick(array: MainArray) -> None:
    """Velocities for all free blocks whose kinetic energy is KICK times the strain energy."""
    h = array.h
    blocks = list_of(h, "block")
    free = blocks[integers(h, blocks, g.KBFIX) == 0]
    mass = float(np.asarray(getr(h, free, g.KBM), np.float64).sum())
    energy = float(strain_energy(h, soft(h)))
    if not (mass > 0 and energy > 0):
        raise UdecError(26, "no free block carries a force", "SOLVE leads to the state that FOS begins with")
    v = float(np.sqrt(KICK * energy / mass))
    for ib in free.tolist():
        putr(h, ib, g.KXD, v)
        putr(h, ib, g.KYD, v)
        for ig in chain(h, iget(h, iget(h, ib, g.KBEX), g.KFG), g.KG) if iget(h, ib, HEAD) == g.MFDEF else ():
            putr(h, ig, g.KXDG, v)
            putr(h, ig, g.KYDG, v)


def run_trial(array: MainArray, laws: LawBook, places: list[int], factor: float, n: int) -> Trial:
    """One trial: the state in `array`, which stays as it is, with strengths at `places` over `factor`."""
    one = _copy(array)
    divide_strengths(one, places, factor)
    record, before, done = DisplacementRecord(one), np.inf, 0
    verdict, means = UNDECIDED, _MeanRatio(n)
    with static_settings(one):
        for _ in range(WINDOWS):
            recording, means = Recording(one, [], RATIO), _MeanRatio(n)
            try:
                done += cycle(one, n, recording=recording, observers=[means], laws=laws)
            except UdecError as error:
                if error.number not in DISORDERED:
                    raise
                verdict = FAILING
                break
            if recording.reached and not _fallen(one, record).any():
                verdict = STABLE
                break
            if _fallen(one, record).any() or means.mean > (1 - ALIKE) * before:
                verdict = FAILING
                break
            before = means.mean
    moved = record.displacements(one.h, record.looks[0])
    worst = int(moved.argmax())
    x, y = (float(getr(one.h, int(record.blocks[worst]), k)) for k in (g.KX, g.KY))
    fallen = int(_fallen(one, record).sum())
    ratio = means.ratios[-1] if verdict == STABLE else means.mean
    return Trial(factor, verdict, done, ratio, float(moved[worst]), x, y, fallen, one)


def _fallen(array: MainArray, record: DisplacementRecord) -> Any:
    """True for each block that has moved by more than a tenth of its size."""
    size = 2 * np.asarray(getr(array.h, record.blocks, g.KBRO), np.float64)
    return record.displacements(array.h, record.looks[0]) > FALLEN * size


def factor_of_safety(
    array: MainArray,
    laws: LawBook,
    places: list[int],
    tolerance: float = 0.01,
    jobs: int | None = None,
    report: Callable[[str], None] = lambda line: None,
) -> FactorOfSafety:
    """The factor of safety of the state in `array`, which stays as it is.

    places: of strengths (strength_reduction.py). tolerance: width of the bracket over its middle. jobs:
    processes; None for three if that saves time, else one. report: takes a line for each round.
    """
    n = response_cycles(array, laws)
    found = FactorOfSafety(None, None, n, [], tolerance=tolerance)
    seconds = 0.0
    factors: tuple[float, ...] = FIRST
    while True:
        many = jobs or (1 if seconds < BY_ITSELF else min(3, os.cpu_count() or 1))
        start = monotonic()
        trials = _run_round(array, laws, places, factors, n, many)
        seconds = (monotonic() - start) / len(factors)
        report(", ".join(f"{one.factor:.5g} {one.verdict}" for one in trials))
        take_trials(found, trials)
        low, high = found.bracket
        if found.is_found or all(one.verdict == UNDECIDED for one in trials):
            return found
        if found.failing is None:
            factors = tuple(8 * one for one in factors)
        elif found.stable is None:
            factors = tuple(one / 8 for one in factors)
        else:
            tried = {one.factor for one in found.trials}  # those between are undecided
            quarters = (low + (high - low) * part for part in (0.25, 0.5, 0.75))
            factors = tuple(one for one in quarters if one not in tried)
        if not factors or max(factors[0], 1 / factors[-1]) > LARGEST:
            return found


def _run_round(
    array: MainArray, laws: LawBook, places: list[int], factors: tuple[float, ...], n: int, jobs: int
) -> list[Trial]:
    """Trials with these factors, in so many processes."""
    if jobs == 1:
        return [run_trial(array, laws, places, factor, n) for factor in factors]
    from joblib import Parallel, delayed

    call = delayed(run_trial)
    return list(Parallel(n_jobs=jobs)(call(array, laws, places, factor, n) for factor in factors))


def take_trials(found: FactorOfSafety, trials: list[Trial]) -> None:
    """Add trials, and narrow the bracket: the greatest stable factor, and the least failing one above it.

    A trial that rests is certain, and so is one in which a block has fallen. Others fail because they come no
    nearer to rest; below a stable factor they were only slow, and do not count.
    """
    known = [*trials, *(one for one in (found.stable, found.failing) if one)]
    limit = min((one.factor for one in known if one.verdict == FAILING and one.fallen), default=np.inf)
    stable = [one for one in known if one.verdict == STABLE and one.factor < limit]
    found.stable = max(stable, key=lambda one: one.factor, default=None)
    low = found.stable.factor if found.stable else 0.0
    failing = [one for one in known if one.verdict == FAILING and one.factor > low]
    found.failing = min(failing, key=lambda one: one.factor, default=None)
    for one in trials:
        if one not in (found.stable, found.failing):
            one.array = None
    found.trials = sorted([*found.trials, *trials], key=lambda one: one.factor)
