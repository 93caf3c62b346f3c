"""Invariants 3 and 7: each contact stands where its code says, and in physical order along the boundary.

A contact stands on the edge that ends at a corner, or on the arc of the corner. Both are measured clockwise
from the start of the edge, the arc by its length. Positions may be off by GTOL, which keeps codes from
flickering; and a contact does not pass a corner while another contact stands between them, so it may pass a
cycle late.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from udec_ia.inspect.check.groups import State
from udec_ia.inspect.check.map import neighbours
from udec_ia.inspect.check.outlines import Outlines, cross, dot, length
from udec_ia.inspect.check.touches import TOGETHER, Touches
from udec_ia.inspect.reading import HOSTS, INDEX, Numbers
from udec_ia.kernels.geometry.contact_geometry import BLUNT
from udec_ia.layout import offsets as g


@dataclass(frozen=True)
class Place:
    """Where the contacts stand on one of their two blocks; arrays with one element for each contact.

    corner: index of the first corner after the contact. on_edge: True on the edge, False on the arc.
    under, over: distances by which it is outside its segment, before the start and after the end; negative
    inside. On an arc they are those of the other circle's centre; lever: what they are along the arc, as a
    part of that, where the other circle is a large one, or else 1. along: position, clockwise from the start
    of the edge.
    """

    corner: Numbers
    on_edge: Numbers
    under: Numbers
    over: Numbers
    lever: Numbers
    along: Numbers


def place(o: Outlines, touch: Touches, side: int) -> Place:
    """The places of all contacts on side 0 (block KB1) or 1 (KB2).

    On an edge it is what touches it, the other circle or an end of a blunt arc, that must stand between the
    roundings. Of two arcs each
    must face the other's centre. An arc on an edge may face another way: its block has been tilted. Two edges
    that meet in a point without a radius part the ground between them at their bisector.
    """
    k, other = (touch.i, touch.j) if side == 0 else (touch.j, touch.i)
    on_edge = touch.code == (g.EDGE_CORNER if side == 0 else g.CORNER_EDGE)
    two_arcs = touch.code == g.CORNER_CORNER
    touching = o.deepest(other, -o.normal(k), on_edge)
    from_start = dot(touching - o.p.take(o.before[k], 0), o.t.take(k, 0))
    to_other = o.c.take(other, 0) - o.c.take(k, 0)
    under = np.where(o.r[o.before[k]] == 0, -_past(o, o.before[k], other), o.start[k] - from_start)
    over = np.where(o.r[k] == 0, _past(o, k, other), from_start - o.end[k])
    far = two_arcs & (o.r[other] > BLUNT * o.d)
    facing = np.where(two_arcs[:, None], to_other, -o.normal(other))
    turn = np.maximum(o.turn[k], 0.0)
    normal = o.normal(k)
    angle = np.arctan2(-cross(normal, facing), dot(normal, facing))
    angle += 2 * np.pi * (angle < turn / 2 - np.pi)  # facing away, nearer to the end
    arc = o.end[k] + o.r[k] * np.clip(angle, 0.0, turn)
    return Place(
        corner=k,
        on_edge=on_edge,
        under=np.select([on_edge, two_arcs], [under, -dot(to_other, o.t.take(k, 0))], -np.inf),
        over=np.select([on_edge, two_arcs], [over, dot(to_other, o.t.take(o.after[k], 0))], -np.inf),
        lever=np.where(far, np.maximum(o.r[k], o.d) / length(to_other), 1.0),
        along=np.where(on_edge, np.clip(from_start, o.start[k], np.maximum(o.end[k], o.start[k])), arc),
    )


def _past(o: Outlines, k: Numbers, other: Numbers) -> Numbers:
    """How far what touches there of corners `other` has passed the bisectors at corners k, clockwise."""
    mean = (o.t.take(k, 0) + o.t.take(o.after[k], 0)) / 2
    inward = np.stack([mean[:, 1], -mean[:, 0]], axis=1)
    touching = o.deepest(other, inward, np.ones(len(k), bool))
    return dot(touching - o.p.take(k, 0), mean)


def check_places(state: State, o: Outlines, touch: Touches) -> None:
    """Invariants 3 and 7."""
    if not len(touch.row):
        return
    along = []
    for side in (0, 1):
        positions = []
        for first in range(0, len(touch.row), TOGETHER):
            part = touch.part(first, first + TOGETHER)
            here = place(o, part, side)
            _check_segment(state, o, part, here, side)
            positions.append(here.along)
        along.append(np.concatenate(positions))
    state.forget()
    _check_order(state, touch, along)


def _check_segment(state: State, o: Outlines, touch: Touches, here: Place, side: int) -> None:
    contacts = state.address["contact"][touch.row]
    block = state.column("contact", HOSTS[side])[touch.row]
    force = state.column("contact", "KCFN")[touch.row]
    idle = (touch.overlap <= 0) & (force == 0)
    for k in np.flatnonzero(~o.arc[here.corner] & ~here.on_edge & ((touch.code == g.CORNER_CORNER) | idle)):
        state.report(
            7, f"contact@{contacts[k]} stands on the arc of corner@{o.corner[here.corner[k]]}, which has none"
        )
    slack = state.tolerance("GTOL") + touch.slack
    for beyond, step, corner, what in (
        (here.under, -1, o.before[here.corner], "before the start"),
        (here.over, 1, here.corner, "after the end"),
    ):
        for k in np.flatnonzero(beyond > slack):
            concave = here.on_edge[k] and o.r[corner[k]] < 0
            waits = concave or _waits(state, int(touch.row[k]), side, step)
            far = slack[k] + (o.d / here.lever[k] if waits else 0.0)
            if beyond[k] > far and not (concave and force[k] != 0):
                segment = "edge" if here.on_edge[k] else "arc"
                state.report(
                    7,
                    f"contact@{contacts[k]} stands on the {segment} of corner@{o.corner[here.corner[k]]} of "
                    f"block@{block[k]}, but lies {beyond[k]} {what} of it",
                )


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
    the program compares them along its chord. Only two closed contacts with different blocks can be made up
    to ETOL out of order: one block is so thin a wedge there that the overlap lets the other one through, and
    an open contact would be given up.
    """
    virtual = np.flatnonzero(state.column("contact", "KCCOD") == g.VIRTUAL)
    block, before, after = neighbours(state, virtual)
    index = np.full(len(state.address["contact"]), -1, INDEX)
    index[touch.row] = np.arange(len(touch.row))
    hosts = [state.column("contact", name)[touch.row] for name in HOSTS]
    for first in range(0, len(block), TOGETHER):
        part = slice(first, first + TOGETHER)
        one, two = index[before[part]], index[after[part]]
        known = (one >= 0) & (two >= 0)
        _check_behind(state, touch, along, hosts, (block[part][known], one[known], two[known]))


def _check_behind(
    state: State, touch: Touches, along: list[Numbers], hosts: list[Numbers], pairs: tuple[Numbers, ...]
) -> None:
    """The second of each pair of contacts is not behind the first. pairs: block, and both by their index."""
    block, one, two = pairs
    here, other = (
        [np.where(hosts[0][k] == block, of[0][k], of[1][k]) for k in (one, two)]
        for of in (along, hosts[::-1])
    )
    wedge = (touch.overlap[one] > 0) & (touch.overlap[two] > 0) & (other[0] != other[1])
    slack = state.tolerance("FTOL") + state.tolerance("HTOL") + touch.slack[one] + touch.slack[two]
    slack += np.where(wedge, state.tolerance("ETOL"), 0.0)
    behind = here[0] - here[1]
    contacts = state.address["contact"][touch.row]
    for k in np.flatnonzero(behind > slack):
        state.report(
            3,
            f"contact@{contacts[one[k]]} stands before contact@{contacts[two[k]]} in the list of "
            f"block@{block[k]}, but lies {behind[k]} behind it",
        )
