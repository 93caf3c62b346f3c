"""The checker: proves that a main array holds a sound map of blocks, or says all that is wrong.

    1. every word below MFREE is in exactly one group, in use or junk; nothing points into junk
    2. every pointer is 0, where it may be, or the base of a group of its kind; the main lists are linked both
       ways; codes are in their range
    3. clockwise lists close, contacts in physical order; links back and reverse lists mirror them
    4. each contact is in the lists of both its blocks and on the loops of both its domains; loops close; what
       hangs on a virtual contact lies in the domain in which it hangs; the outer domain lies around them all
    5. blocks - contacts + domains = 2; the counts of the common block and of zones are true, and tolerances
       are those of the rounding length
    6. grid-point and corner links are mutual, zones fill their block, boundary conditions act on one place,
       points of structures belong to zones of their blocks
    7. reals are finite, areas positive, overlaps within DTOL2; masses and contact codes agree with geometry
    8. no two blocks overlap or touch without a contact between them
    9. force sums are finite, virtual contacts carry none
   10. volumes of domains and pipes of contacts agree with geometry, and the amount of water is true

What depends on a broken part is left out, the rest is still checked. Whatever the words of the array say, the
checker comes to an end and raises nothing.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from udec_ia.checker.block_members import check_members, check_point_masses, check_zone_areas
from udec_ia.checker.block_outlines import check_outlines, outlines
from udec_ia.checker.checked_state import State, Violation
from udec_ia.checker.condition_proofs import check_bounds, check_times
from udec_ia.checker.connected_pieces import check_pieces
from udec_ia.checker.contact_map import check_map, check_outer
from udec_ia.checker.contact_places import check_contacts, check_places, touches
from udec_ia.checker.memory_words import check_memory
from udec_ia.checker.missing_contacts import check_complete
from udec_ia.checker.pointers_and_codes import (
    check_codes,
    check_common,
    check_histories,
    check_numbers,
    check_pointers,
)
from udec_ia.checker.structure_points import check_places_of_points, check_points
from udec_ia.checker.water_volumes import check_water
from udec_ia.errors import DISORDERED, MESSAGES
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.audit.outline_arrays import Outlines
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import KIND_CODE, TABLE


def check_links(array: MainArray) -> list[Violation]:
    """The violations that would mislead a routine that follows pointers: invariants 1 to 6, and codes."""
    with np.errstate(all="ignore"):
        state = State(array)
        _check_links(state)
    return state.violations()


def check_shapes(array: MainArray) -> list[Violation]:
    """Those that would mislead a routine that cuts outlines: of the links, of numbers and of the outlines."""
    with np.errstate(all="ignore"):
        state = State(array)
        _check_links(state)
        _check_shapes(state)
    return state.violations()


def check(array: MainArray) -> list[Violation]:
    """All violations of the invariants in `array`, by number, lost words last; none when it is sound.

    A cycle that has stopped half-way, as the memory was full, has moved blocks that their contacts are yet to
    follow: these are not compared with the outlines then.
    """
    with np.errstate(all="ignore"):
        state = State(array)
        _check_links(state)
        state.forget()
        shapes = _check_shapes(state)
        if shapes is not None and state.common("JPHASE") == g.AT_BLOCKS:  # else contacts are yet to follow
            check_places_of_points(state)
            check_pieces(state, shapes)
            state.forget()
            touching = touches(state, shapes)
            state.forget()
            check_contacts(state, shapes, touching)
            state.forget()
            check_places(state, shapes, touching)
            state.forget()
            check_complete(state, shapes, touching)
            check_water(state, array)
    return state.violations()


def _check_shapes(state: State) -> Outlines | None:
    """Numbers and outlines; the outlines, or None if there are none."""
    check_numbers(state)
    check_zone_areas(state)
    check_point_masses(state)
    check_times(state)
    shapes = outlines(state)
    if shapes is not None:
        check_outlines(state, shapes)
    return shapes


def _check_links(state: State) -> None:
    check_common(state)
    check_pointers(state)
    if state.found:  # else every pointer leads to a group that a list leads to
        state.report_lost(*KIND_CODE)
    check_memory(state)
    check_codes(state)
    check_histories(state)
    check_map(state)
    state.forget()
    check_outer(state)
    check_members(state)
    check_bounds(state)
    check_points(state)


SHOWN = 3  # violations that a summary names
PHASES = {code.value: code.text for code in TABLE.codes_of("JPHASE")}
BEYOND_LINKS = 7  # the first invariant that is not of links


def unchecked_parts(array: MainArray, found: Sequence[Violation] = ()) -> list[str]:
    """What `check`, which has found `found`, does not check in the state of `array`, in sentences."""
    phase, error, cycle = (int(array.h.ci[place]) for place in (g.JPHASE, g.NSPOIL, g.MCSPOI))
    broken = any(one.invariant < BEYOND_LINKS for one in found)
    return unfinished(phase, error, cycle) + (["not checked: what depends on broken links"] if broken else [])


def unfinished(phase: int, error: int, cycle: int) -> list[str]:
    """What is not checked if JPHASE is `phase`, and `error` (NSPOIL) has ended a run in `cycle` (MCSPOI)."""
    lines = []
    if phase != g.AT_BLOCKS:
        lines.append(
            "not checked: contacts against outlines, as the state stopped in the middle of a cycle, "
            f"{PHASES.get(phase, 'before an unknown pass')} (JPHASE {phase})"
        )
    if error in DISORDERED:
        lines.append(
            f"not checked: which domain is the outer one, as error {error} in cycle {cycle}, "
            f"{MESSAGES[error]}, has ended a run of this state"
        )
    return lines


def in_short(broken: Sequence[Violation]) -> str:
    """Some violations in words: those that mislead go before the words that are lost because of them."""
    more = [f"and {len(broken) - SHOWN} more"] if len(broken) > SHOWN else []
    first = sorted(broken, key=lambda one: not one.misleads)
    return "; ".join([*map(str, first[:SHOWN]), *more])
