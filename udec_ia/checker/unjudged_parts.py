"""What the checker leaves out, and why: a state may be unfinished, or beyond what an invariant can tell."""

from __future__ import annotations

from collections.abc import Sequence

from udec_ia.checker.checked_state import Violation
from udec_ia.errors import DISORDERED, MESSAGES
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import TABLE

PHASES = {code.value: code.text for code in TABLE.codes_of("JPHASE")}
BEYOND_LINKS = 7  # the first invariant that is not of links


def unjudged(array: MainArray, found: Sequence[Violation] = ()) -> list[str]:
    """What `check` does not judge in the state of `array`, in sentences; [] if it judges all.

    found: what `check` has found. Where links are broken, what hangs on them is left out.
    """
    phase, error, cycle = (int(array.h.ci[place]) for place in (g.JPHASE, g.NSPOIL, g.MCSPOI))
    broken = any(one.invariant < BEYOND_LINKS for one in found)
    return unfinished(phase, error, cycle) + (["not judged: what depends on broken links"] if broken else [])


def unfinished(phase: int, error: int, cycle: int) -> list[str]:
    """What is not judged in a state that stopped before a pass, or of which an error has ended a run.

    phase, error, cycle: JPHASE, NSPOIL and MCSPOI.
    """
    said = []
    if phase != g.AT_BLOCKS:
        said.append(
            "not judged: contacts against outlines, as the state stopped in the middle of a cycle, "
            f"{PHASES.get(phase, 'before an unknown pass')} (JPHASE {phase})"
        )
    if error in DISORDERED:
        said.append(
            f"not judged: which domain is the outer one, as error {error} in cycle {cycle}, "
            f"{MESSAGES[error]}, has ended a run of this state"
        )
    return said
