"""The checked build at work: accessors that look first, and what is said of an access that they refuse.

An access is right if a group of the kind that has the field begins at the address. All of a group lies below
MFREE, since FIND has it so; what was given back is a junk group. The first access that is not right ends the
kernel, before anything is read or written there.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import update_wrapper
from typing import Any

import numpy as np

from udec_ia.errors import DAMAGED, UdecError
from udec_ia.heap.checked import (
    CHECKED,
    COUNT,
    FIELD,
    HEADED,
    KIND,
    KINDS,
    NAMES,
    ROUTINE,
    ROUTINES,
    SPARE,
    WITH_HEAD,
    of_routine,
)
from udec_ia.heap.entering import enter, leave
from udec_ia.heap.kinds import shadow
from udec_ia.heap.loading import has_numba_side
from udec_ia.heap.views import Memory
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts

ADVICE = "udec check shows which pointer is wrong; if none is, the routine is wrong: keep this deck"


class Refused(Exception):
    """Of a kernel that was ended; the notes of the memory say why."""


class Astray(UdecError):
    """Error 20: a kernel has gone to where it has nothing to do, and may have changed words before."""


class _Inside:
    """kernel: accessors that run as Python are called by a kernel, and look."""

    kernel = False


def judge(h: Any, iad: Any, k: Any, i: Any, writes: int) -> None:
    """Refused unless a group that has the field `k` begins at `iad`, and `i` is one of its elements."""
    top: Any = h.ci[g.MFREE]
    good: Any = False
    if 1 <= iad < top:
        kind = np.int64(h.kinds[iad - 1])
        if k[KIND] > 0:
            good = kind == k[KIND] and 0 <= i < k[COUNT]
        elif i == 0:
            good = kind > 0 and (k[KIND] != WITH_HEAD or (HEADED >> kind) & 1 == 1)
        else:  # words of a group that is copied or cleared
            good = kind > 0 and 0 < i < top - iad and h.kinds[iad + i - 1] == 0
    if not good:
        notes = h.notes
        notes[0], notes[1], notes[2], notes[3], notes[4] = k[ROUTINE], iad, k[FIELD], i, writes
        raise Refused


def look(h: Memory, iad: int, k: Any, i: int, writes: int) -> None:
    """The same within a kernel; what reads the heap from outside of them has tests of its own."""
    if _Inside.kernel:
        judge(h, iad, k, i, writes)


def guarded(*plain: Any) -> tuple[Any, ...]:
    """The accessors iget, puti, getr and putr as they are in this build."""
    if not CHECKED:
        return plain
    plain_iget, plain_puti, plain_getr, plain_putr = plain

    def iget(h: Memory, iad: int, k: Any, i: int = 0) -> Any:
        look(h, iad, k, i, 0)
        return plain_iget(h, iad, k, i)

    def puti(h: Memory, iad: int, k: Any, n: int, i: int = 0) -> None:
        look(h, iad, k, i, 1)
        plain_puti(h, iad, k, n, i)

    def getr(h: Memory, iad: int, k: Any) -> Any:
        look(h, iad, k, 0, 0)
        return plain_getr(h, iad, k)

    def putr(h: Memory, iad: int, k: Any, v: Any) -> None:
        look(h, iad, k, 0, 1)
        plain_putr(h, iad, k, v)

    return iget, puti, getr, putr


def begins(h: Memory, iad: int, nv: Any) -> None:
    """FIND hands out the words at `iad` for a group of the size `nv`. Nothing in an ordinary build."""
    if CHECKED:
        h.kinds[iad - 1] = nv[KIND]


def ends(h: Memory, iad: int, nv: Any) -> None:
    """LOSE takes them back. Refused if there is no such group. Nothing in an ordinary build."""
    if CHECKED:
        look(h, iad, nv, 0, 1)
        h.kinds[iad - 1] = SPARE


class Guarded:
    """A kernel of the checked build. Called from Python it ends in Astray where an access is refused."""

    def __init__(self, made: Any, function: Callable[..., Any], number: int) -> None:
        update_wrapper(self, function)
        self.number = number
        self.made = made

    @property
    def whole(self) -> Any:
        """What is compiled of it."""
        return self.made.whole

    def __call__(self, *args: Any) -> Any:
        h = next((one for one in args if isinstance(one, Memory)), None)
        if h is None or _Inside.kernel:
            return self.made(*args)
        args = tuple(of_routine(one, self.number) for one in args)
        enter(h)
        _Inside.kernel = True
        try:
            return self.made(*args)
        except Refused:
            raise astray(h) from None
        finally:
            _Inside.kernel = False
            leave(h)


def astray(h: Memory) -> Astray:
    """The error that the notes of `h` tell of."""
    routine, iad, field, element, writes = (int(word) for word in shadow(h.ia).notes)
    name, deed = NAMES[field], "writes" if writes else "reads"
    if name.startswith("NV"):
        name, deed = f"a group of the size {name}", "gives back"
    which = f"word {element} of the group" if element and name == "HEAD" else name
    detail = f"{ROUTINES[routine]} {deed} {which} at {iad}: that is {_there(h, iad)}"
    if field in WANTED and KINDS[WANTED[field]] != _kind(h, iad):
        detail += f", not a {KINDS[WANTED[field]]}"
    elif element:
        detail += f", and {name} has no element {element}"
    return Astray(DAMAGED, detail, ADVICE, group=iad)


WANTED = {
    value[FIELD]: value[KIND]
    for value in vars(g).values()
    if CHECKED and isinstance(value, tuple) and len(value) > ROUTINE
}


def _kind(h: Memory, iad: int) -> str:
    inside = 1 <= iad < min(int(h.ci[g.MFREE]), len(h.ia) + 1)
    return KINDS[shadow(h.ia).kinds[iad - 1]] if inside else ""


def _there(h: Memory, iad: int) -> str:
    """What stands at `iad`, in words."""
    if iad == 0:
        return "the null pointer"
    if not 1 <= iad < int(h.ci[g.MFREE]):
        return f"outside of the words in use, which end at {int(h.ci[g.MFREE]) - 1}"
    if kind := _kind(h, iad):
        return "a group that was given back" if kind == KINDS[SPARE] else f"a {kind}"
    before = np.flatnonzero(shadow(h.ia).kinds[:iad])
    if not len(before):
        return "no group"
    first = int(before[-1]) + 1
    sizes = layouts(int(h.ra.itemsize // h.ia.itemsize))
    kind = _kind(h, first)
    size = sizes[kind].size if kind in sizes else int(h.ia[first])
    return f"a word of {kind}@{first}" if iad < first + size else "no group"


has_numba_side(__name__)
