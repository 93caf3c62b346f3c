"""What each facility costs a cycle: the same cycles are run with it and without it, by turns.

A copy of the state is changed so that it runs without the facility, where that is possible, with the same
time-step. The answer is the median of the ratios of processor times, with half the range of the middle half
of them. Machine code is made before, by a piece that is not counted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from time import monotonic, process_time
from typing import Any

import numpy as np

from udec_ia.advice.run_monitors import RunMonitors
from udec_ia.errors import UdecError
from udec_ia.facilities.facilities_in_use import FACILITIES, REMEMBER, Facility, Scene
from udec_ia.heap.accessors import HEAD, iget, puti
from udec_ia.heap.find_lose import lose
from udec_ia.heap.main_array import MainArray, relocate
from udec_ia.heap_tools.renumber_groups import arrange
from udec_ia.heap_tools.rewrite_heap import groups_in_list_order
from udec_ia.kernels.constitutive.joint_materials import JOINTS, MATERIALS, lose_joint
from udec_ia.kernels.links.relaxation_groups import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary_command import forget_blocks
from udec_ia.ops.commands.change_or_delete_blocks import change_types
from udec_ia.ops.common.attached_structures import attach
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.reader.list_walks import chain
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import Atlas
from udec_ia.running.history_series import Recording
from udec_ia.running.run_cycles import cycle, prepare

NEVER = 1e30  # m, a displacement that nothing reaches


@dataclass
class Trial:
    """A copy of a state that runs without a facility, or with all of them.

    monitored: its energy is judged. words: of IA() that the facility takes. why_not: why the state cannot run
    without it, "" if it can. ratios: processor times of pieces, as parts of those with everything.
    """

    array: MainArray
    laws: LawBook
    monitored: bool = True
    words: int = 0
    why_not: str = ""
    ratios: list[float] = field(default_factory=list)


def _make_rigid(code: int, trial: Trial) -> None:
    """Make all blocks with the head code `code` rigid."""
    h = trial.array.h
    blocks = [ib for ib in chain(h, int(h.ci[g.IBPNT]), g.KB) if iget(h, ib, HEAD) == code]
    if h.ci[g.IRXPNT]:
        lose_relaxations(h)  # CYCLE makes those of the blocks that there are
        h.ci[g.LREADY] = 0
    change_types(trial.array, blocks, g.MRIG)
    attach(h)


def _put(trial: Trial, **values: float) -> None:
    """Give variables of the common block other values."""
    for name, value in values.items():
        words = trial.array.h.ci if isinstance(value, int) else trial.array.h.cr
        words[getattr(g, name)] = value


def _put_in_all(kind: str, field: str, value: int, trial: Trial) -> None:
    """Give an integer another value in all groups of a kind."""
    for iad in Atlas(trial.array.h).groups[kind].tolist():
        puti(trial.array.h, iad, getattr(g, field), value)


def _lose_conditions(trial: Trial) -> None:
    h = trial.array.h
    forget_blocks(h, list(chain(h, int(h.ci[g.IBPNT]), g.KB)))


def _lose_functions(trial: Trial) -> None:
    """Leave loads, velocities and numbers constant."""
    h = trial.array.h
    drop(h, "follower", list_of(h, "follower").tolist())
    for iu in list_of(h, "bound").tolist():
        puti(h, iu, g.KUS, 0)
    for iou in list_of(h, "outside").tolist():
        puti(h, iou, g.KOS, 0)
    for isg in list_of(h, "signal").tolist():
        for it in chain(h, iget(h, isg, g.KTP), g.KTPN):
            lose(h, it, g.NVTP)
    drop(h, "signal", list_of(h, "signal").tolist())


def _lose_relaxations(trial: Trial, **settings: int) -> None:
    """Switch off what needs relaxations (LREST, LSCALE), and give them back if nothing else needs them."""
    _put(trial, **settings)
    ci = trial.array.h.ci
    if not (ci[g.LSCALE] or ci[g.LREST] in REMEMBER):
        lose_relaxations(trial.array.h)


def _lose_histories(trial: Trial) -> None:
    h = trial.array.h
    for kind in ("summand", "history"):
        drop(h, kind, list_of(h, kind).tolist())


def _lose_joints(trial: Trial) -> None:
    """Contacts have the properties of their blocks' materials, and nothing lies behind them and corners."""
    h = trial.array.h
    if h.ci[g.LWATER]:
        raise UdecError(26, "water needs the apertures of joint materials")
    for ic in list_of(h, "contact").tolist():
        lose_joint(h, ic)
    h.ci[g.JMLAW : g.JMLAW + MATERIALS] = 0
    h.ci[g.JLINE : g.JLINE + JOINTS] = 0
    _shorten(trial, groups_in_list_order(trial.array), LJOINT=0)


def _lose_water(trial: Trial) -> None:
    """Nothing lies behind domains and joints, and edges have no conditions."""
    h = trial.array.h
    order = groups_in_list_order(trial.array)
    for edge in order["edge"].tolist():
        puti(h, edge, g.KEOUT, 0)
    drop(h, "outside", order.pop("outside").tolist())
    _shorten(trial, order, LWATER=0)
    renew_forces(trial.array)


def _shorten(trial: Trial, order: dict[str, Any], **flag: int) -> None:
    """Set a flag to 0, and take away the groups that lie behind others with it. order: addresses by kind."""
    _put(trial, **flag)
    relocate(trial.array, order)


def _lose_displacements(trial: Trial) -> None:
    _shorten(trial, groups_in_list_order(trial.array), LDISP=0)


def _lose_all(kind: str, trial: Trial) -> None:
    """No groups of a kind."""
    drop(trial.array.h, kind, list_of(trial.array.h, kind).tolist())


def _lose_structures(trial: Trial) -> None:
    for kind in ("bolt", "element", "node"):
        drop(trial.array.h, kind, list_of(trial.array.h, kind).tolist())
    renew_forces(trial.array)


def _stop_monitoring(trial: Trial) -> None:
    trial.monitored = False


WITHOUT: dict[str, Callable[[Trial], None] | str] = {
    "blocks and contacts": "nothing would be left to run",
    "domain pass": partial(_put, ETOL=NEVER, HTOL=NEVER),
    "short edges": partial(_put, LSHORT=0),
    "SDEF": partial(_make_rigid, g.MSDEF),
    "FDEF": partial(_make_rigid, g.MFDEF),
    "MIXED": partial(_put_in_all, "fdef", "KFMIX", 0),
    "BOUNDARY": _lose_conditions,
    "FUNCTION": _lose_functions,
    "joint materials": _lose_joints,
    "FLUID": _lose_water,
    "cracks kept for later cuts": partial(_lose_all, "crack"),
    "GROUP": partial(_lose_all, "member"),
    "structures": _lose_structures,
    "BREAKAGE": partial(_lose_all, "breakable"),
    "DISPLACEMENTS": _lose_displacements,
    "cracks made in runs": partial(_lose_all, "fracture"),
    "joint law": partial(_put_in_all, "contact", "KCC", 1),
    "block law": partial(_put_in_all, "block", "KCONS", 1),
    "DAMPING MASS": partial(_put, ALPHA=0.0, CON1=1.0, CON2=1.0),
    "DAMPING STIFFNESS": partial(_put, BETA=0.0),
    "DAMPING INTERNAL": partial(_put, ALPB=0.0, C1B=1.0, C2B=1.0),
    "DAMPING to rest": partial(_lose_relaxations, LREST=0),
    "FRACTION SCALED": partial(_lose_relaxations, LSCALE=0),
    "to rest with SCALED": partial(_lose_relaxations, LREST=0, LSCALE=0),
    "ENERGY": partial(_put, LENER=0),
    "HISTORY": _lose_histories,
    "energy monitor": _stop_monitoring,
    "other groups": "their use is unknown",
}


SECONDS = 20.0  # of all pieces together
PIECE = 0.05  # seconds of a piece
LONGEST, SHORTEST, ROUNDS = 2000, 10, 3  # cycles of a piece; pieces of each kind, at least
COLUMNS = ("facility", "words", "bytes", "ns a cycle", "percent", "+-", "in this scene")


def costs(array: MainArray, laws: LawBook | None = None, seconds: float = SECONDS) -> Listing:
    """What each facility that the state in `array` uses costs in time and words; `array` stays as it is.

    laws: the user's laws. seconds: time for measuring, beside that for compiling. Raises what CYCLE raises.
    """
    whole = Trial(array.copy(), laws or LawBook())
    arrange(whole.array)
    prepare(whole.array)
    scene = Scene(whole.array)
    used = [(one, use) for one in FACILITIES if (use := one.use_in(scene))]
    n = _cycles(whole)
    trials = [_without(one, whole, n) for one, _ in used]
    times = _measure(whole, [trial for trial in trials if not trial.why_not], n, seconds)
    size, each = array.scheme.int_bits // 8, float(np.median(times)) / n
    rows = [_row(one, here, trial, each, size) for (one, here), trial in zip(used, trials, strict=True)]
    text = f"a cycle takes {each * 1e9:,.0f} ns of processor time: median of {len(times)} runs of {n} cycles"
    return Listing([text], COLUMNS, rows)


def _row(one: Facility, here: str, trial: Trial, each: float, size: int) -> tuple[object, ...]:
    words = one.name, trial.words, trial.words * size
    if trial.why_not:
        return *words, "", "", "", f"{here}; cannot be left out: {trial.why_not}"
    low, middle, high = np.quantile(trial.ratios, (0.25, 0.5, 0.75)).tolist()
    part = 1 - middle
    return *words, round(part * each * 1e9), round(100 * part, 1), round(50 * (high - low), 1), here


def _piece(trial: Trial, n: int) -> float:
    """Processor time of `n` cycles of a copy."""
    array, monitors = trial.array.copy(), RunMonitors(trial.laws)
    if trial.monitored:
        monitors.energy.check_step(array)
    recording = Recording(array, [], marks=monitors.chatter.marks)
    start = process_time()
    cycle(array, n, recording=recording, observers=[monitors] if trial.monitored else [], laws=trial.laws)
    return process_time() - start


def _cycles(trial: Trial) -> int:
    """Cycles of a piece, after a first one for which machine code may be made."""
    n = SHORTEST
    _piece(trial, n)
    while n < LONGEST and (spent := _piece(trial, n)) < PIECE:
        n = min(LONGEST, max(2 * n, int(n * PIECE / max(spent, 1e-3))))
    return n


def _without(one: Facility, whole: Trial, n: int) -> Trial:
    """A trial without a facility, or why there can be none; and the words that it sets free."""
    before, change = Scene(whole.array), WITHOUT[one.name]
    trial = Trial(whole.array.copy(), whole.laws, words=one.words(before))
    if isinstance(change, str):
        trial.why_not = change
        return trial
    try:
        change(trial)
        freed = before.in_use - Scene(trial.array).in_use
        _piece(trial, n)
        trial.words = freed
    except UdecError as error:
        trial.why_not = error.detail
    return trial


def _measure(whole: Trial, trials: list[Trial], n: int, seconds: float) -> list[float]:
    """Times of all pieces of `n` cycles with everything; the trials take turns, ROUNDS times at least."""
    times = [_piece(whole, n)]
    end, rounds = monotonic() + seconds, 0
    while trials and (rounds < ROUNDS or monotonic() < end):
        for trial in trials:
            times.append(_piece(whole, n))
            trial.ratios.append(_piece(trial, n) / times[-1])
        rounds += 1
    return times
