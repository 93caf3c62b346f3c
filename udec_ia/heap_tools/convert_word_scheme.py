"""A sound state in the words of another scheme, ready to go on.

Every number is written as it is (rewrite.py), and with reals of the same width that is all: the run goes on
to the same last digit. In reals of another width circles, which follow from the corners, and overlaps, which
follow from both, need not fit any more. The last digit of wider ones is finer than all that narrow ones could
say, so these are found anew from the corners (settle.py); in narrower ones, if the checker asks for it.
"""

from __future__ import annotations

from typing import NamedTuple

from udec_ia.checker import Violation, check
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import Scheme
from udec_ia.heap_tools.fault_summary import too_coarse
from udec_ia.heap_tools.fitted_contacts import settle
from udec_ia.heap_tools.rewrite_heap import Rewritten, rewrite
from udec_ia.heap_tools.word_fit import Fit
from udec_ia.layout import offsets as g


class Converted(NamedTuple):
    """A state in other words. said: what has happened to it; broken: what the new reals have made unsound."""

    array: MainArray
    said: list[str]
    broken: list[Violation]


def convert(array: MainArray, to: Scheme) -> Converted:
    """The state of `array`, which stays as it is, in the words of the scheme `to`.

    Raises Unsound if there are groups that cannot be told apart, UdecError 1 if the addresses of `to` end
    before the groups do, and 28 if its integers or reals cannot hold all numbers.
    """
    return prove(rewrite(array, to))


def prove(made: Rewritten) -> Converted:
    """What was made, settled in its reals, and what they have made unsound.

    The state that it was made of is not needed any more, and may have been given up: it takes memory.
    """
    array, old, junk = made.array, made.old, made.junk
    after = int(array.h.ci[g.MFREE]) - 1
    name = array.scheme.name
    said = [f"{old.name} to {name}: {made.before} words, {junk} of them junk, are now {after} words"]
    if array.scheme.real_bits == old.real_bits:
        return Converted(array, said, [])
    narrower = array.scheme.real_bits < old.real_bits
    broken = check(array) if narrower else []
    if broken or not narrower:
        change = settle(array)
        said.append(
            f"circles and contacts are found anew from the corners, and differ by up to {change:.2g} m"
        )
        broken = check(array)
    if narrower:
        said.insert(1, _rounding(made.fit))
        broken += too_coarse(array)
    return Converted(array, said, broken)


def _rounding(made: Fit) -> str:
    """What narrower reals have cost."""
    if not made.rounded:
        return f"none of {made.reals} reals has lost a digit"
    worst = f"the largest relative change is {made.change:.2g}, in {made.where}" if made.where else ""
    gone = f"too small, now 0: {made.vanished}" if made.vanished else ""
    lost = f"{made.rounded} of {made.reals} reals have lost digits"
    return "; ".join(part for part in (lost, worst, gone) if part)
