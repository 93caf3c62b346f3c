"""The checked build: accessors that test each address before they use it, and the error if it is wrong.

Another array beside IA() has a small number for each word: the kind of the group that begins there. FIND and
LOSE update it. Where the words came from elsewhere, as from a restart file, it is made anew from the
pointers. An access is right if a group of the kind that has the field begins at the address. The first access
that is not right ends the kernel, before anything is read or written there.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from udec_ia.checked_build import tagged_offsets as tags
from udec_ia.checked_build.tagged_offsets import COUNT, FIELD, KIND, KINDS, NAMES, ROUTINE, SPARE, WANTED
from udec_ia.compiling.build_choice import JITABLE, numba_form
from udec_ia.compiling.kernel_decorators import Kernel
from udec_ia.compiling.kernel_memory import Memory
from udec_ia.errors import DAMAGED, WrongAddress
from udec_ia.heap.group_census import census
from udec_ia.heap.junk_list import junk_chains
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts

ADVICE = "udec check shows which pointer is wrong; if none is, the routine is wrong: keep this deck"
NOTES = 5  # what an access that was refused leaves behind: routine, address, field, element, 1 if it writes
MARKS = g.MFREE, g.JUNK, g.IBPNT, g.ICPNT, g.IDPNT  # what only kernels change
WITH_CODE = {head.group for head in tags.TABLE.heads}  # kinds with a head code

# ---- kinds of groups


class Shadow:
    """Beside an array of `size` words. kinds: by address - 1; known: False if they have to be found anew.

    left: MARKS when kernels were last left. Others have changed the array if they differ.
    """

    def __init__(self, size: int) -> None:
        self.kinds = np.zeros(size, np.int8)
        self.notes = np.zeros(NOTES, np.int64)
        self.known = False
        self.left: tuple[int, ...] = ()


_SHADOWS: dict[tuple[int, int], Shadow] = {}


def shadow(ia: Any) -> Shadow:
    """The Shadow of the words `ia`, through whatever view of them."""
    own = getattr(ia, "array", ia)
    key = own.__array_interface__["data"][0], own.nbytes
    if key not in _SHADOWS:
        while isinstance(own.base, np.ndarray):
            own = own.base
        _SHADOWS[key] = Shadow(len(ia))
        weakref.finalize(own, _SHADOWS.pop, key, None)
    return _SHADOWS[key]


def follow(old: Any, new: Any) -> None:
    """The groups of `old` lie at the same addresses of `new`."""
    was, now = shadow(old), shadow(new)
    size = min(len(old), len(new))
    now.kinds[:size], now.known, now.left = was.kinds[:size], was.known, was.left


def find_kinds(h: Any) -> None:
    """Find the kinds of the groups of `h` anew unless they are known."""
    here = shadow(h.ia)
    here.notes[:] = 0
    if not here.known or here.left != _marks(h):
        here.kinds[:] = tags.NOTHING
        _enter_groups(h, here.kinds)
        here.known = True


def _marks(h: Any) -> tuple[int, ...]:
    return tuple(int(h.ci[mark]) for mark in MARKS)


def _enter_groups(h: Any, kinds: Any) -> None:
    """Put the kinds of all groups into `kinds`; of groups that overlap, the first of `_groups`."""
    taken = np.zeros(len(kinds) + 2, np.int64)  # by address: groups that begin there less those that end
    for number, at, size in _groups(h):
        before = np.concatenate(([0], np.cumsum(np.cumsum(taken) > 0)))  # words of groups below an address
        free = before[at + size] == before[at]
        free[1:] &= at[1:] >= (at + size)[:-1]
        kinds[at[free] - 1] = number
        np.add.at(taken, at[free], 1)
        np.add.at(taken, (at + size)[free], -1)


def _groups(h: Any) -> Iterator[tuple[int, Any, Any]]:
    """Number of the kind, addresses, and words of the groups: junk first, then kinds with a head code."""
    layout, words = layouts(int(h.ra.itemsize // h.ia.itemsize)), getattr(h.ia, "array", h.ia)
    top = max(1, min(int(h.ci[g.MFREE]), len(words) + 1))
    junk = sorted(group for chain in junk_chains(words[: top - 1], int(h.ci[g.JUNK])) for group in chain)
    yield SPARE, np.array([at for at, _ in junk], np.int64), np.array([size for _, size in junk], np.int64)
    for kind, at in sorted(census(h).items(), key=lambda item: item[0] not in WITH_CODE):
        yield KINDS.index(kind), at, np.full(len(at), layout[kind].size)


# ---- checks


class Refused(Exception):
    """Ends a kernel; the notes of its memory contain the reason."""


class _Inside:
    """kernel: True if accessors that run as Python are called by a kernel, and test addresses."""

    kernel = False


@numba_form(JITABLE)
def test_address(h: Any, iad: Any, k: Any, i: Any, writes: int) -> None:
    """Refused unless a group that has the field `k` begins at `iad`, and `i` is one of its elements."""
    top: Any = h.ci[g.MFREE]
    good: Any = False
    if 1 <= iad < top:
        kind = np.int64(h.kinds[iad - 1])
        if k[KIND] > 0:
            good = kind == k[KIND] and 0 <= i < k[COUNT]
        elif i == 0:
            good = kind > 0 and (k[KIND] != tags.WITH_HEAD or (tags.HEADED >> kind) & 1 == 1)
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
        test_address(h, iad, k, i, writes)


def _compile_look(look: Callable[..., Any]) -> None:
    """Compiled code is always within a kernel."""
    from numba.extending import overload

    @overload(look)
    def _look(h: Any, iad: Any, k: Any, i: Any, writes: Any) -> Callable[..., None]:
        def impl(h: Any, iad: Any, k: Any, i: Any, writes: Any) -> None:
            test_address(h, iad, k, i, writes)

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


def note_found(h: Memory, iad: int, nv: Any) -> None:
    """FIND hands out the words at `iad` for a group of the size `nv`."""
    h.kinds[iad - 1] = nv[KIND]


def note_lost(h: Memory, iad: int, nv: Any) -> None:
    """LOSE takes the words back. Refused if there is no such group."""
    look(h, iad, nv, 0, 1)
    h.kinds[iad - 1] = SPARE


def note_merged(h: Memory, iad: int, nv: Any) -> None:
    """LOSE takes the words back as a part of the group before. Refused if there is no such group."""
    look(h, iad, nv, 0, 1)
    h.kinds[iad - 1] = tags.NOTHING


class CheckedKernel(Kernel):
    """A kernel of the checked build: called from Python, it ends in WrongAddress if an access is refused."""

    def __init__(self, function: Callable[..., Any], inline: bool, outlined: bool) -> None:
        own, self.number = tags.tag_routine(function)
        super().__init__(own, inline, outlined, True)

    def __call__(self, *args: Any) -> Any:
        h = next((one for one in args if isinstance(one, Memory)), None)
        if h is None or _Inside.kernel:
            return super().__call__(*args)
        args = tuple(tags.of_routine(one, self.number) for one in args)
        find_kinds(h)
        _Inside.kernel = True
        try:
            return super().__call__(*args)
        except Refused:
            raise wrong_address(h) from None
        finally:
            _Inside.kernel = False
            shadow(h.ia).left = _marks(h)


def wrong_address(h: Memory) -> WrongAddress:
    """The error that the notes of `h` describe."""
    routine, iad, field, element, writes = (int(word) for word in shadow(h.ia).notes)
    name, deed = NAMES[field], "writes" if writes else "reads"
    if name.startswith("NV"):
        name, deed = f"a group of the size {name}", "gives back"
    which = f"word {element} of the group" if element and name == "HEAD" else name
    detail = f"{tags.ROUTINES[routine]} {deed} {which} at {iad}: that is {_describe(h, iad)}"
    if field in WANTED and KINDS[WANTED[field]] != _kind(h, iad):
        detail += f", not a {KINDS[WANTED[field]]}"
    elif element:
        detail += f", and {name} has no element {element}"
    return WrongAddress(DAMAGED, detail, ADVICE, group=iad)


def _kind(h: Memory, iad: int) -> str:
    inside = 1 <= iad < min(int(h.ci[g.MFREE]), len(h.ia) + 1)
    return KINDS[shadow(h.ia).kinds[iad - 1]] if inside else ""


def _describe(h: Memory, iad: int) -> str:
    """What is at `iad`, in words."""
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
