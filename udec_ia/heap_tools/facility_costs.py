"""What each facility costs a cycle: the same cycles are run with it and without it, by turns.

Every piece begins with the same state and takes the same number of cycles, so pieces differ by what is left
out, and by the noise of the machine. A piece with the facility and one without follow each other; what is
told is the median of the ratios of their processor times, and half of the range in which the middle half of
these ratios lies. Machine code is made before, by a piece that is not counted.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import monotonic, process_time
from typing import NamedTuple

import numpy as np

from udec_ia.advice.energy_monitor import EnergyMonitor
from udec_ia.advice.run_monitors import RunMonitors
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.facilities import FACILITIES, Facility
from udec_ia.heap_tools.facility_scene import Scene
from udec_ia.heap_tools.facility_trials import WITHOUT, Trial
from udec_ia.heap_tools.memory_order import arrange
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.law_book import LawBook
from udec_ia.reader.listing import Listing
from udec_ia.running.cycle import cycle, prepare
from udec_ia.running.history_series import Recording

SECONDS = 20.0  # of all pieces together
PIECE = 0.05  # seconds of a piece
LONGEST, SHORTEST, ROUNDS = 2000, 10, 3  # cycles of a piece; pieces of each kind, at least
COLUMNS = ("facility", "words", "bytes", "ns a cycle", "percent", "+-", "in this scene")


class Share(NamedTuple):
    """What a facility has of a cycle: as a part of its time, within what, and words of IA().

    why_not: why that could not be measured, "" if it was.
    """

    part: float = np.nan
    within: float = np.nan
    words: int = 0
    why_not: str = ""


def costs(array: MainArray, laws: LawBook | None = None, seconds: float = SECONDS) -> Listing:
    """What each facility that the state in `array` uses costs in time and words; `array` stays as it is.

    laws: of the user's. seconds: that measuring may take, beside what is to be compiled. Raises what CYCLE
    raises.
    """
    whole = Trial(array.copy(), laws or LawBook())
    arrange(whole.array)
    prepare(whole.array)
    scene = Scene(whole.array)
    used = [(one, here) for one in FACILITIES if (here := one.here(scene))]
    n = _cycles(whole)
    times, shares = _measured(whole, [one for one, _ in used], n, seconds)
    size, each = array.scheme.int_bits // 8, float(np.median(times)) / n
    rows = [_row(one, here, share, each, size) for (one, here), share in zip(used, shares, strict=True)]
    said = [
        f"a cycle takes {each * 1e9:,.0f} ns of processor time: median of {len(times)} runs of {n} cycles",
        f"CYCLE takes {_preparing(whole.array) * 1e3:.3g} ms to prepare itself and to judge the time-step, "
        "once after each change of the model",
    ]
    return Listing(said, COLUMNS, rows)


def _row(one: Facility, here: str, share: Share, each: float, size: int) -> tuple[object, ...]:
    if share.why_not:
        return one.name, share.words, share.words * size, "", "", "", f"{here}; {share.why_not}"
    part, within = round(100 * share.part, 1), round(100 * share.within, 1)
    return one.name, share.words, share.words * size, round(share.part * each * 1e9), part, within, here


def _piece(trial: Trial, n: int) -> float:
    """Processor time of `n` cycles of a copy."""
    array, monitors = trial.array.copy(), RunMonitors(trial.laws)
    if trial.judged:
        monitors.energy.judge(array)
    recording = Recording(array, [], marks=monitors.chatter.marks)
    start = process_time()
    cycle(array, n, recording=recording, observers=[monitors] if trial.judged else [], laws=trial.laws)
    return process_time() - start


def _cycles(trial: Trial) -> int:
    """Cycles of a piece, after a first one for which machine code may be made."""
    n = SHORTEST
    _piece(trial, n)
    while n < LONGEST and (spent := _piece(trial, n)) < PIECE:
        n = min(LONGEST, max(2 * n, int(n * PIECE / max(spent, 1e-3))))
    return n


def _measured(whole: Trial, used: list[Facility], n: int, seconds: float) -> tuple[list[float], list[Share]]:
    """Times of all pieces of `n` cycles with everything, and the shares of what is in use."""
    trials = [_without(one, whole, n) for one in used]
    turns = [k for k, (trial, _) in enumerate(trials) if trial is not None]
    times: list[float] = [_piece(whole, n)]
    ratios: dict[int, list[float]] = {k: [] for k in turns}
    for k in _in_turn(turns, seconds):
        trial, _ = trials[k]
        assert trial is not None
        times.append(_piece(whole, n))
        ratios[k].append(_piece(trial, n) / times[-1])
    shares = []
    for k, (_, share) in enumerate(trials):
        if k in ratios:
            low, middle, high = np.quantile(ratios[k], (0.25, 0.5, 0.75))
            share = share._replace(part=float(1 - middle), within=float(high - low) / 2)
        shares.append(share)
    return times, shares


def _in_turn(turns: list[int], seconds: float) -> Iterator[int]:
    """All of `turns`, over and over, until time is up; ROUNDS times at least."""
    end, rounds = monotonic() + seconds, 0
    while turns and (rounds < ROUNDS or monotonic() < end):
        yield from turns
        rounds += 1


def _without(one: Facility, whole: Trial, n: int) -> tuple[Trial | None, Share]:
    """A trial without a facility, None if there can be none; and the words that it sets free."""
    before, change = Scene(whole.array), WITHOUT[one.name]
    if isinstance(change, str):
        return None, Share(words=one.words(before), why_not=f"cannot be left out: {change}")
    trial = Trial(whole.array.copy(), whole.laws)
    try:
        change(trial)
        words = before.in_use - Scene(trial.array).in_use
        _piece(trial, n)
    except UdecError as error:
        return None, Share(words=one.words(before), why_not=f"cannot be left out: {error.detail}")
    return trial, Share(words=words)


def _preparing(array: MainArray) -> float:
    """Seconds of what CYCLE does before its first cycle, once after each change of the model."""
    found = []
    for _ in range(ROUNDS):
        copy = array.copy()
        copy.h.ci[g.LREADY] = 0
        start = process_time()
        prepare(copy)
        EnergyMonitor().judge(copy)
        found.append(process_time() - start)
    return float(np.median(found))
