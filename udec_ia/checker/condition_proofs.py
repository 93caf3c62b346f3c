"""Invariant 6 for boundary conditions and signals: a condition acts on one place, which it holds as it says.

a condition acts on a grid-point if the block has zones, else on a corner or on the block itself; conditions
on a block with zones itself give it both velocities and the rotation, and no load
one on a corner carries the load of an edge that begins or ends there, and is given no velocities; where
the other end has a condition of its own that names this one's corner, this one names that of the other
a grid-point or block holds the velocities that conditions give it (KGFIX, KBFIX) and no others
a block that FIX holds has no velocity
a FUNCTION has a number of its own and points, a sine has neither
a follower has a FUNCTION and a real of the common block, which no other one has
a summand belongs to a history of summands
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.block_members import zoned
from udec_ia.checker.checked_state import State
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import KR, TABLE, Numbers

LOADS = "KUFX", "KUFY", "KUCXX", "KUCXY", "KUCYY"
WHOLE = g.ALONG_X | g.ALONG_Y | g.TURNS  # of KUFIX


def check_bounds(state: State) -> None:
    """Invariant 6."""
    if len(state.address["bound"]):
        _check_places(state)
        _check_edges(state)
    _check_velocities(state)
    _check_signals(state)
    _check_followers(state)
    _check_summands(state)


def _check_places(state: State) -> None:
    """One of a grid-point, a corner or the block itself."""
    bounds, block = state.address["bound"], state.column("bound", "KUB")
    point, corner = (state.column("bound", name) != 0 for name in ("KUG", "KUP"))
    with_zones = np.isin(block, zoned(state))
    loads = np.any([state.column("bound", name) != 0 for name in LOADS], axis=0)
    whole = with_zones & ~corner & (state.column("bound", "KUFIX") != 0) & ~loads
    for k in np.flatnonzero((point != with_zones) & ~whole):
        what = "no grid-point of it" if with_zones[k] else "a grid-point"
        has = "has zones" if with_zones[k] else "has none"
        state.report(6, f"bound@{bounds[k]} acts on {what}, but block@{block[k]} {has}")
    for k in np.flatnonzero(point & corner):
        state.report(6, f"bound@{bounds[k]} acts on a grid-point and on a corner: only one may be named")
    for k in np.flatnonzero(corner & (state.column("bound", "KUFIX") != 0)):
        state.report(6, f"bound@{bounds[k]} gives velocities to a corner")


def _check_edges(state: State) -> None:
    """The other end of an edge is a corner beside, and the conditions at both ends name each other.

    BOUNDARY puts the two next to each other. FREE may take one away; SPLIT then clears the name in the other.
    """
    bounds = state.address["bound"]
    corner, other = (state.column("bound", name) for name in ("KUP", "KUQ"))
    before = np.append(state.column("corner", KR), 0)
    rows = [state.rows("corner", values) for values in (corner, other)]
    beside = (before[rows[0]] == other) | (before[rows[1]] == corner)
    wrong = (other != 0) & ((corner == 0) | ~beside)
    state.report_rows(6, "bound", "KUQ", wrong, lambda k: f"but no edge leads there from {corner[k]} (KUP)")
    alone = ~np.isin(other * state.free + corner, corner * state.free + other)
    for one, two in (slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1)):
        lost = (corner[one] != 0) & (other[one] == 0) & (other[two] == corner[one]) & alone[two]
        for k in np.flatnonzero(lost):
            text = f"bound@{bounds[two][k]} names the edge to corner@{corner[one][k]}"
            state.report(6, f"{text}, but bound@{bounds[one][k]} beside it, on that corner, names no edge")


def _check_velocities(state: State) -> None:
    """Velocities are fixed where conditions give them, and nowhere else; a fixed block is at rest."""
    given, on_point = state.column("bound", "KUFIX"), state.column("bound", "KUG") != 0
    pairs = (g.ALONG_X, g.GIVEN_X), (g.ALONG_Y, g.GIVEN_Y), (g.TURNS, g.GIVEN_TURN)
    of_blocks = np.bitwise_or.reduce([np.where(given & code, flag, 0) for code, flag in pairs])
    fixed = state.column("block", "KBFIX") == g.FIXED
    for kind, name, field, codes, acts, exempt in (
        ("gridpoint", "KUG", "KGFIX", given, on_point, False),
        ("block", "KUB", "KBFIX", of_blocks, ~on_point, fixed),
    ):
        row = state.rows(kind, state.column("bound", name))
        acts = acts & (row >= 0)
        due = np.zeros(len(state.address[kind]), np.int64)
        np.bitwise_or.at(due, row[acts], codes[acts])
        if kind == "gridpoint":
            due |= _of_whole_blocks(state, on_point)
        stored = state.column(kind, field)
        for k in np.flatnonzero((stored != due) & ~exempt):
            text = f"{field} of {kind}@{state.address[kind][k]} is {stored[k]}"
            state.report(6, f"{text}, but conditions give it the velocities {due[k]}")
    moving = np.any([state.column("block", name) != 0 for name in ("KXD", "KYD", "KTD")], axis=0)
    for k in np.flatnonzero(fixed & moving):
        state.report(6, f"block@{state.address['block'][k]} is fixed (KBFIX is 1), but has a velocity")


def _of_whole_blocks(state: State, on_point: Numbers) -> Numbers:
    """The codes of KGFIX of each grid-point that follow from conditions on its block as a whole.

    A block with zones that lacks a part of its motion is a violation.
    """
    given, block = state.column("bound", "KUFIX"), state.column("bound", "KUB")
    bodies = np.isin(block, zoned(state)) & ~on_point
    for ib in np.unique(block[bodies]):
        held = int(np.bitwise_or.reduce(given[bodies & (block == ib)]))
        if held != WHOLE:
            state.report(
                6, f"block@{ib} has zones, and conditions give it the parts {held} of its motion only"
            )
    return np.where(np.isin(state.owner["gridpoint"], block[bodies]), g.ALONG_X | g.ALONG_Y, 0)


def _check_signals(state: State) -> None:
    signals, number = state.address["signal"], state.column("signal", "KTNUM")

    def why(k: int) -> str:
        return "but it has no points" if number[k] else "but it has points, which a sine does not have"

    state.report_rows(6, "signal", "KTNUM", (number != 0) != (state.column("signal", "KTP") != 0), why)
    order = np.argsort(number, kind="stable")
    for k in np.flatnonzero((number[order[1:]] == number[order[:-1]]) & (number[order[1:]] != 0)):
        one, two = order[k], order[k + 1]
        state.report(6, f"signal@{signals[one]} and signal@{signals[two]} are both FUNCTION {number[one]}")


def _check_followers(state: State) -> None:
    """What follows a FUNCTION."""
    number, last = state.column("follower", "KWN"), len(TABLE.common_reals) - 1
    first = np.isin(np.arange(len(number)), np.unique(number, return_index=True)[1])
    wrong = (number > last) | ~first
    state.report_rows(
        6, "follower", "KWN", wrong, lambda k: f"but it is 0 to {last} and of no other follower"
    )
    row = state.rows("signal", state.column("follower", "KWS"))
    sine = (row >= 0) & (np.append(state.column("signal", "KTP"), 0)[row] == 0)
    state.report_rows(6, "follower", "KWS", sine, lambda k: "which is a sine, and no FUNCTION")


def _check_summands(state: State) -> None:
    row = state.rows("history", state.column("summand", "KQH"))
    other = (row >= 0) & (np.append(state.column("history", "KHK"), g.SUMMANDS)[row] != g.SUMMANDS)
    state.report_rows(6, "summand", "KQH", other, lambda k: "a history without summands")


def check_times(state: State) -> None:
    """Invariant 7: the times of a FUNCTION ascend."""
    time, following = state.column("tabpoint", "KTPT"), state.column("tabpoint", "KTPN")
    row = state.rows("tabpoint", following)
    after = np.append(time, 0.0)[row]
    for k in np.flatnonzero((row >= 0) & ~(after > time)):
        text = f"KTPT of tabpoint@{following[k]} is {after[k]}"
        state.report(7, f"{text}, not after {time[k]} of the point before it")
