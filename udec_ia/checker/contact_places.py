"""Overlap, point and place of each contact follow from the outlines of its two blocks: invariants 3 and 7.

A contact stands on the edge that ends at a corner, or on the arc of the corner. Both are measured clockwise
from the start of the edge, the arc by its length. Positions may be off by GTOL, which keeps codes from
flickering; and a contact does not pass a corner while another contact stands between them, so it may pass a
cycle late.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_map import AHEAD
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.kernels.audit.contact_positions import (
    OVERLAP,
    PASSED_OVER,
    PLACE,
    contacts_out_of_order,
    locate_on_outlines,
    touching,
    wrong_contacts,
)
from udec_ia.kernels.audit.outline_arrays import Outlines
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import HOSTS, INDEX, Numbers, kernel_rows

TOUCHING, UNLIKE = InterpretWhenSmall(touching, 5e5), InterpretWhenSmall(wrong_contacts, 1e6)  # contacts


class Touches(NamedTuple):
    """The contacts that can be compared with the outlines; arrays with one element for each.

    row: among the contacts in use; code; i, j: index of KCP1 and KCP2 among the corners of the outlines;
    overlap, point: from the outlines; slack: what they may be off by rounding, also because SPLIT has made
    the circles anew.
    """

    row: Numbers
    code: Numbers
    i: Numbers
    j: Numbers
    overlap: Numbers
    point: Numbers
    slack: Numbers


def touches(state: State, o: Outlines) -> Touches:
    """The real contacts whose code and corners are sound, with the overlap that the outlines give."""
    index = np.full(len(state.address["corner"]) + 1, -1, INDEX)  # one more, for row -1
    index[state.rows("corner", o.corner)] = np.arange(len(o.corner))
    code = state.column("contact", "KCCOD")
    ends = [index[state.rows("corner", state.column("contact", name))] for name in AHEAD]
    comparable = (code >= g.CORNER_CORNER) & (code < g.VIRTUAL) & (ends[0] >= 0) & (ends[1] >= 0)
    row = np.flatnonzero(comparable)
    i, j = (end[row] for end in ends)
    code, overlap, point = code[row].astype(np.int8), np.empty(len(row)), np.empty((len(row), 2))
    TOUCHING(len(row), o, code, i, j, overlap, point)
    slack = 2 * np.maximum(o.slack[o.owner[i]], o.slack[o.owner[j]])
    return Touches(row, code, i, j, overlap, point, slack)


def check_contacts(state: State, o: Outlines, touch: Touches) -> None:
    """Invariant 7: overlap and place of each contact are those of the outlines, the overlap within DTOL2."""
    contacts = state.address["contact"][touch.row]
    stored, x, y = (state.column("contact", name)[touch.row] for name in ("KCN", "KXC", "KYC"))
    limit = state.tolerance("DTOL2")
    by_outlines = touch.overlap, touch.point, touch.slack
    for k, what in kernel_rows(UNLIKE, len(stored), 2, stored, x, y, *by_outlines, limit).tolist():
        contact, overlap = contacts[k], touch.overlap[k]
        if what == OVERLAP:
            ends = f"corner@{o.corner[touch.i[k]]} and corner@{o.corner[touch.j[k]]}"
            text = f"KCN of contact@{contact} is {stored[k]}"
            state.report(7, f"{text}, but at {ends} the outlines overlap by {overlap}")
        elif what == PLACE:
            text = f"KXC, KYC of contact@{contact} are {x[k]}, {y[k]}"
            state.report(7, f"{text}, but the outlines meet at {touch.point[k, 0]}, {touch.point[k, 1]}")
        else:
            state.report(
                7, f"the overlap of contact@{contact} is {max(stored[k], overlap)}, DTOL2 is {limit}"
            )


LOCATE = InterpretWhenSmall(locate_on_outlines, 2e5)  # contacts
ON_EDGE = g.EDGE_CORNER, g.CORNER_EDGE  # codes of contacts on an edge of block KB1, and of block KB2
DISORDERED = InterpretWhenSmall(contacts_out_of_order, 2e6)  # items


def place(o: Outlines, touch: Touches, side: int) -> Numbers:
    """Where all contacts stand on side 0 (block KB1) or 1 (KB2): under, over, lever and along (4, n).

    under, over: distances by which they are outside their segment, before the start and after the end;
    negative inside. On an arc they are those of the other circle's centre; lever: what they are along the
    arc, as a part of that, where the other circle is a large one, or else 1. along: position, clockwise
    from the start of the edge. On an edge it is what touches it, the other circle or an end of a blunt arc,
    that must stand between the roundings. Of two arcs each must face the other's centre. An arc on an edge
    may face another way: its block has been tilted. Two edges that meet in a point without a radius are
    separated by their bisector.
    """
    k, other = (touch.i, touch.j) if side == 0 else (touch.j, touch.i)
    places = np.empty((len(k), 4))
    LOCATE(len(k), o, touch.code, k, other, ON_EDGE[side], places)
    return places.T


def check_places(state: State, o: Outlines, touch: Touches) -> None:
    """Invariants 3 and 7."""
    if not len(touch.row):
        return
    along = []
    for side in (0, 1):
        places = place(o, touch, side)
        _check_segment(state, o, touch, places, side)
        along.append(places[3].copy())  # the rest takes room
    state.forget()
    _check_order(state, touch, along)


def _check_segment(state: State, o: Outlines, touch: Touches, places: Numbers, side: int) -> None:
    contacts, end = state.address["contact"][touch.row], (touch.i, touch.j)[side]
    block = state.column("contact", HOSTS[side])[touch.row]
    force = state.column("contact", "KCFN")[touch.row]
    on_edge, sharp = touch.code == ON_EDGE[side], ~((o.r > 0) | o.pointed)
    for k in np.flatnonzero(sharp[end] & ~on_edge):
        if touch.code[k] == g.CORNER_CORNER or (touch.overlap[k] <= 0 and force[k] == 0):
            text = f"contact@{contacts[k]} stands on the arc of corner@{o.corner[end[k]]}"
            state.report(7, f"{text}, which has none")
    slack = state.tolerance("GTOL") + touch.slack
    under, over, lever, _ = places
    for beyond, step, what in ((under, -1, "before the start"), (over, 1, "after the end")):
        for k in np.flatnonzero(beyond > slack):
            concave = on_edge[k] and o.r[end[k] if step > 0 else o.before[end[k]]] < 0
            waits = concave or _waits(state, int(touch.row[k]), side, step)
            far = slack[k] + (o.d / lever[k] if waits else 0.0)
            if beyond[k] > far and not (concave and force[k] != 0):
                segment = f"{'edge' if on_edge[k] else 'arc'} of corner@{o.corner[end[k]]}"
                text = f"contact@{contacts[k]} stands on the {segment} of block@{block[k]}"
                state.report(7, f"{text}, but lies {beyond[k]} {what} of it")


def _waits(state: State, row: int, side: int, step: int) -> bool:
    """True if another contact stands between the contact and the corner, or has passed it just before."""
    rings = state.rings
    here = int(rings.at[side, row])
    if here < 0:
        return False
    along = rings.after if step > 0 else rings.before
    one = along[here]
    return bool(rings.contact[one] or rings.contact[along[one]])


def _check_order(state: State, touch: Touches, along: list[Numbers]) -> None:
    """Contacts between two corners follow each other clockwise.

    Nearer than FTOL they count as one, and until the next domain pass they move by less than HTOL. On an arc
    the program compares their places on it. Only two closed contacts with different blocks can be up to
    ETOL out of order, at a wedge of a block that is thinner than the overlap.
    """
    rings, contacts = state.rings, state.address["contact"][touch.row]
    index = np.where(state.column("contact", "KCCOD") == g.VIRTUAL, INDEX(PASSED_OVER), INDEX(-1))
    index[touch.row] = np.arange(len(touch.row))
    hosts = [state.column("contact", name)[touch.row] for name in HOSTS]
    near = state.tolerance("FTOL") + state.tolerance("HTOL")
    slack = touch.slack + near / 2
    of_lists = rings.lists, rings.contact, rings.row, rings.side
    rows = kernel_rows(DISORDERED, len(rings.item), 4, *of_lists, index, np.array(along), slack, of=float)
    for (owner, one, two), behind in zip(rows[:, :3].astype(int).tolist(), rows[:, 3].tolist(), strict=True):
        block = rings.block[owner]
        others = {int(host[k]) for host in hosts for k in (one, two)} - {int(block)}
        wedge = touch.overlap[one] > 0 and touch.overlap[two] > 0 and len(others) > 1
        if behind > slack[one] + slack[two] + (state.tolerance("ETOL") if wedge else 0.0):
            pair = f"contact@{contacts[one]} stands before contact@{contacts[two]}"
            state.report(3, f"{pair} in the list of block@{block}, but lies {behind} behind it")
