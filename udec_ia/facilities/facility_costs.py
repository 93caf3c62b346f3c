"""What each facility costs a cycle: the same cycles are run with it and without it, by turns.

A copy of the state is made to run without the facility, unless that cannot be. The time-step stays as it is,
so that a cycle moves everything as far as before. Every piece begins with the same state and takes the same
number of cycles, so pieces differ by what is left out, and by the noise of the machine. A piece with the
facility and one without follow each other; the answer is the median of the ratios of their processor times,
and half of the range in which the middle half of these ratios lies. Machine code is made before, by a piece
that is not counted.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import monotonic, process_time
from typing import NamedTuple

import numpy as np

from udec_ia.advice.energy_monitor import EnergyMonitor
from udec_ia.advice.run_monitors import RunMonitors
from udec_ia.errors import UdecError
from udec_ia.facilities.facilities_in_use import FACILITIES, REMEMBER, Facility, Scene
from udec_ia.heap.accessors import HEAD, iget, puti
from udec_ia.heap.find_lose import lose
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.renumber_groups import arrange
from udec_ia.kernels.links.relaxations import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary_conditions import forget_blocks
from udec_ia.ops.commands.change_or_delete_blocks import change_types
from udec_ia.ops.common.block_ranges import chain
from udec_ia.ops.laws.law_book import LawBook
from udec_ia.reader.listing import Listing
from udec_ia.running.cycle import cycle, prepare
from udec_ia.running.history_series import Recording

NEVER = 1e30  # m, a displacement that nothing comes to


@dataclass
class Trial:
    """A copy of a state that runs. judged: its energy is monitored."""

    array: MainArray
    laws: LawBook
    judged: bool = True


def _rigid(code: int) -> Callable[[Trial], None]:
    def without(trial: Trial) -> None:
        h = trial.array.h
        change_types(
            trial.array,
            [ib for ib in chain(h, int(h.ci[g.IBPNT]), g.KB) if iget(h, ib, HEAD) == code],
            g.MRIG,
        )

    return without


def _put(**values: float) -> Callable[[Trial], None]:
    """Give variables of the common block other values."""

    def without(trial: Trial) -> None:
        h = trial.array.h
        for name, value in values.items():
            words = h.ci if isinstance(value, int) else h.cr
            words[getattr(g, name)] = value

    return without


def _in_every(kind: str, field: str, value: int) -> Callable[[Trial], None]:
    """Give an integer another value in all groups of a kind."""

    def without(trial: Trial) -> None:
        for iad in Scene(trial.array).atlas.groups[kind].tolist():
            puti(trial.array.h, iad, getattr(g, field), value)

    return without


def _free_of_conditions(trial: Trial) -> None:
    h = trial.array.h
    forget_blocks(h, list(chain(h, int(h.ci[g.IBPNT]), g.KB)))
    for isg in chain(h, int(h.ci[g.ISGPNT]), g.KT):
        for it in chain(h, iget(h, isg, g.KTP), g.KTPN):
            lose(h, it, g.NVTP)
        lose(h, isg, g.NVSG)
    h.ci[g.ISGPNT] = 0


def _unrelaxed(*, how: bool = False, scaled: bool = False) -> Callable[[Trial], None]:
    def without(trial: Trial) -> None:
        ci = trial.array.h.ci
        ci[g.LREST] = 0 if how else ci[g.LREST]
        ci[g.LSCALE] = 0 if scaled else ci[g.LSCALE]
        if not (ci[g.LSCALE] or ci[g.LREST] in REMEMBER):
            lose_relaxations(trial.array.h)

    return without


def _unrecorded(trial: Trial) -> None:
    h = trial.array.h
    for ih in chain(h, int(h.ci[g.IHPNT]), g.KH):
        lose(h, ih, g.NVHI)
    h.ci[g.IHPNT] = 0


def _unjudged(trial: Trial) -> None:
    trial.judged = False


WITHOUT: dict[str, Callable[[Trial], None] | str] = {
    "blocks and contacts": "nothing would be left to run",
    "domain pass": _put(ETOL=NEVER, HTOL=NEVER),
    "short edges": _put(LSHORT=0),
    "SDEF": _rigid(g.MSDEF),
    "FDEF": _rigid(g.MFDEF),
    "MIXED": _in_every("fdef", "KFMIX", 0),
    "BOUNDARY": _free_of_conditions,
    "joint law": _in_every("contact", "KCC", 1),
    "block law": _in_every("block", "KCONS", 1),
    "DAMPING MASS": _put(ALPHA=0.0, CON1=1.0, CON2=1.0),
    "DAMPING STIFFNESS": _put(BETA=0.0),
    "DAMPING INTERNAL": _put(ALPB=0.0, C1B=1.0, C2B=1.0),
    "DAMPING to rest": _unrelaxed(how=True),
    "FRACTION SCALED": _unrelaxed(scaled=True),
    "to rest and SCALED": _unrelaxed(how=True, scaled=True),
    "ENERGY": _put(LENER=0),
    "HISTORY": _unrecorded,
    "watch of the energy": _unjudged,
    "other groups": "nothing here knows what they are for",
}


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
