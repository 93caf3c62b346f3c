"""A sound state in the words of another scheme, ready to go on (`udec convert`).

Every number is written as it is (rewrite_heap.py). With wider reals the circles, reaches of blocks, and
places and overlaps of contacts, which follow from the corners, are computed anew: else the checker, SPLIT and
the springs would take the missing digits for damage or movement. With narrower reals that is done only if the
checker asks for it. Between two passes of a cycle (JPHASE) contacts stay as they are.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from udec_ia.checker import Violation, check, check_links
from udec_ia.checker.block_outlines import circles, extent, outlines
from udec_ia.checker.checked_state import State
from udec_ia.checker.contact_places import touches
from udec_ia.checker.water_volumes import RENEW
from udec_ia.heap.accessors import Memory, getr, putr
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import Scheme
from udec_ia.heap_tools.field_translation import Fit
from udec_ia.heap_tools.rewrite_heap import Rewritten, rewrite
from udec_ia.layout import offsets as g
from udec_ia.ops.common.number_limits import ROUNDING_DIGITS, last_digit
from udec_ia.reader.group_tables import addresses


class Converted(NamedTuple):
    """A state in other words. head: what has happened to it; broken: what the new reals have made unsound."""

    array: MainArray
    head: list[str]
    broken: list[Violation]


def convert(array: MainArray, to: Scheme) -> Converted:
    """The state of `array`, which stays as it is, in the words of the scheme `to`.

    Raises Unsound if there are groups whose kinds cannot be known, UdecError 1 if the addresses of `to` end
    before the groups do, and 28 if its integers or reals cannot hold all numbers.
    """
    return prove(rewrite(array, to))


def prove(made: Rewritten) -> Converted:
    """What was made, settled in its reals, and what they have made unsound; its source may be given up."""
    array, old, junk = made.array, made.old, made.junk
    after = int(array.h.ci[g.MFREE]) - 1
    name = array.scheme.name
    head = [f"{old.name} to {name}: {made.before} words, {junk} of them junk, are now {after} words"]
    if array.scheme.real_bits == old.real_bits:
        return Converted(array, head, [])
    narrower = array.scheme.real_bits < old.real_bits
    broken = check(array) if narrower else []
    if broken or not narrower:
        change = settle(array)
        head.append(
            f"circles and contacts are found anew from the corners, and differ by up to {change:.2g} m"
        )
        broken = check(array)
    if narrower:
        head.insert(1, _rounding(made.fit))
        broken += too_coarse(array)
    return Converted(array, head, broken)


def _rounding(made: Fit) -> str:
    """What narrower reals have cost."""
    if not made.rounded:
        return f"none of {made.reals} reals has lost a digit"
    worst = f"the largest relative change is {made.change:.2g}, in {made.where}" if made.where else ""
    gone = f"too small, now 0: {made.vanished}" if made.vanished else ""
    lost = f"{made.rounded} of {made.reals} reals have lost digits"
    return "; ".join(part for part in (lost, worst, gone) if part)


def settle(array: MainArray) -> float:
    """Bring circles, reaches and contacts of `array` up to its corners. Returns the greatest change, in m."""
    with np.errstate(all="ignore"):
        state = State(array)
        o = outlines(state)
        if o is None or not o.d > 0:
            return 0.0
        h, rows = array.h, state.rows("block", o.block)
        centre, radius = circles(o)
        arc = (o.r != 0) & (radius != 0)  # a corner with a radius keeps one, and one without it none
        centre[~arc], radius[~arc] = np.where(o.r == 0, o.p.T, o.c.T).T[~arc], o.r[~arc]
        changes = [
            _put(h, o.corner, zip((g.KXCP, g.KYCP, g.KRAD), (*centre.T, radius), strict=True)),
            _put(h, o.block, [(g.KBRO, extent(state, o, rows)[1])]),
        ]
        if state.common("JPHASE") == g.AT_BLOCKS:
            touch = touches(state, o._replace(c=centre, r=radius))
            contacts = state.address["contact"][touch.row]
            new = (touch.overlap, *touch.point.T)
            changes.append(_put(h, contacts, zip((g.KCN, g.KXC, g.KYC), new, strict=True)))
            if h.ci[g.LWATER] and not check_links(array):
                RENEW(len(contacts), h)
    return max(changes)


def _put(h: Memory, at: Any, fields: Any) -> float:
    """Put reals of the groups at `at` where they are finite; returns the greatest change."""
    change = 0.0
    for offset, values in fields:
        old = getr(h, at, offset)
        new = np.where(np.isfinite(values), values, old)
        putr(h, at, offset, new)
        change = max(change, float(np.nanmax(np.abs(new - old), initial=0.0)))
    return change


def too_coarse(array: MainArray) -> list[Violation]:
    """Whether the reals resolve the rounding length where the blocks are as well as ROUND asks for."""
    at = addresses(array, "corner")
    size = float(sum(np.abs(getr(array.h, at, k)) for k in (g.KXP, g.KYP)).max(initial=0.0))
    d, digit = float(array.h.cr[g.DTOL]), last_digit(array, size)
    if d >= ROUNDING_DIGITS * digit:
        return []
    what = f"the rounding length is {d:g}, and {array.scheme.real_bits}-bit reals resolve {digit:g} there"
    return [Violation(7, f"{what}: it must be at least {ROUNDING_DIGITS * digit:g}")]
