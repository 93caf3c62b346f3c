"""How a copy of a state is made to run without a facility; or why that cannot be.

The time-step stays as it is, so that a cycle moves everything as far as before.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from udec_ia.heap.accessors import HEAD, iget, puti
from udec_ia.heap.find_lose import lose
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.facilities import REMEMBER
from udec_ia.heap_tools.facility_scene import Scene
from udec_ia.kernels.links.relaxations import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.boundary_conditions import forget_blocks
from udec_ia.ops.commands.change_or_delete_blocks import change_types
from udec_ia.ops.common.block_ranges import chain
from udec_ia.ops.laws.law_book import LawBook

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
