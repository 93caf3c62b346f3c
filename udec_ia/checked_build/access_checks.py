"""The checks themselves: accessors that test each address before they use it, and the error if it is wrong.

An access is right if a group of the kind that has the field begins at the address. All of a group lies below
MFREE, since FIND has it so; what was given back is a junk group. The first access that is not right ends the
kernel, before anything is read or written there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from udec_ia.checked_build.group_kinds import enter, leave, shadow
from udec_ia.checked_build.tagged_offsets import (
    COUNT,
    FIELD,
    HEADED,
    KIND,
    KINDS,
    NAMES,
    ROUTINE,
    ROUTINES,
    SPARE,
    WANTED,
    WITH_HEAD,
    named,
    of_routine,
)
from udec_ia.compiling.kernel_decorators import Kernel
from udec_ia.compiling.kernel_memory import Memory
from udec_ia.compiling.numba_loading import numba_form
from udec_ia.errors import DAMAGED, WrongAddress
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts

ADVICE = "udec check shows which pointer is wrong; if none is, the routine is wrong: keep this deck"
JITABLE = "numba.extending:register_jitable"


class Refused(Exception):
    """Of a kernel that was ended; the notes of the memory say why."""


class _Inside:
    """kernel: accessors that run as Python are called by a kernel, and look."""

    kernel = False


@numba_form(JITABLE)
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


@numba_form("udec_ia.checked_build.access_checks:_compile_look")
def look(h: Memory, iad: int, k: Any, i: int, writes: int) -> None:
    """The same within a kernel; what reads the heap from outside of them has tests of its own."""
    if _Inside.kernel:
        judge(h, iad, k, i, writes)


def _compile_look(look: Callable[..., Any]) -> None:
    """Compiled code is always within a kernel."""
    from numba.extending import overload

    @overload(look)
    def _look(h: Any, iad: Any, k: Any, i: Any, writes: Any) -> Callable[..., None]:
        def impl(h: Any, iad: Any, k: Any, i: Any, writes: Any) -> None:
            judge(h, iad, k, i, writes)

        return impl


def checked_accessors(*plain: Any) -> tuple[Any, ...]:
    """The accessors iget, puti, getr and putr, each of which looks first."""
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

    return tuple(numba_form(JITABLE)(one) for one in (iget, puti, getr, putr))


def begins(h: Memory, iad: int, nv: Any) -> None:
    """FIND hands out the words at `iad` for a group of the size `nv`."""
    h.kinds[iad - 1] = nv[KIND]


def ends(h: Memory, iad: int, nv: Any) -> None:
    """LOSE takes them back. Refused if there is no such group."""
    look(h, iad, nv, 0, 1)
    h.kinds[iad - 1] = SPARE


class CheckedKernel(Kernel):
    """A kernel of the checked build: called from Python, it ends in WrongAddress if an access is refused."""

    def __init__(self, function: Callable[..., Any], inline: bool, outlined: bool) -> None:
        own, self.number = named(function)
        super().__init__(own, inline, outlined, True)

    def __call__(self, *args: Any) -> Any:
        h = next((one for one in args if isinstance(one, Memory)), None)
        if h is None or _Inside.kernel:
            return super().__call__(*args)
        args = tuple(of_routine(one, self.number) for one in args)
        enter(h)
        _Inside.kernel = True
        try:
            return super().__call__(*args)
        except Refused:
            raise wrong_address(h) from None
        finally:
            _Inside.kernel = False
            leave(h)


def wrong_address(h: Memory) -> WrongAddress:
    """The error that the notes of `h` describe."""
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
    return WrongAddress(DAMAGED, detail, ADVICE, group=iad)


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
