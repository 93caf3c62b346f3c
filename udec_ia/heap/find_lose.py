"""Memory management: FIND and LOSE (report 3.4).

Fresh memory is taken from MFREE upwards. A group that is given back goes to the junk list, and FIND reuses it
for the next request of exactly the same size (junk_list.py); groups are never cut up. LOSE updates what
refers to a group from outside the map, as a history does.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.build_choice import CHECKED, JITABLE, checked_build, numba_form, offset
from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.errors import OVERFLOW
from udec_ia.heap.accessors import Memory, Offset, iget, int64, puti, size_of
from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.layout import offsets as g

WORD: Offset = offset("WORD", (0, 0, 0), "any")  # the first one of any group


def note_found(h: Memory, iad: int, nv: Offset) -> None:
    """FIND hands out the words at `iad` for a group of the size `nv`; the checked build takes note."""


def note_lost(h: Memory, iad: int, nv: Offset) -> None:
    """LOSE takes the words back; the checked build tests the address and takes note."""


def note_merged(h: Memory, iad: int, nv: Offset) -> None:
    """LOSE takes the words back as a part of the group before; the checked build does as for note_lost."""


if CHECKED:
    checks = checked_build("access_checks")
    note_found, note_lost, note_merged = checks.note_found, checks.note_lost, checks.note_merged
for each in note_found, note_lost, note_merged:
    numba_form(JITABLE)(each)


@kernel
def _chain(h: Memory, n: int) -> tuple[int, int]:
    """First junk group of `n` words and first group of the chain before it; 0 where there is none."""
    before = int64(0)
    group = int64(h.ci[g.JUNK])
    while group != 0 and iget(h, group, JSIZE) != n:
        before = group
        group = iget(h, group, JSIZES)
    return group, before


@kernel
def _link_chain(h: Memory, before: int, group: int) -> None:
    if before == 0:
        h.ci[g.JUNK] = group
    else:
        puti(h, before, JSIZES, group)


@kernel
def want(h: Memory, words: int) -> None:
    """Ask for `words` words of fresh memory (NWANT): error 1, unless there is another error already."""
    h.ci[g.NWANT] = words
    if h.ci[g.NERR] == 0:
        h.ci[g.NERR] = OVERFLOW


@kernel
def find(h: Memory, nv: Offset) -> int:
    """Address of a group of the size `nv` (NVBL, NVCR, ...), its words zero.

    Returns 0 and sets error 1 when memory cannot be found; nothing else changes then.
    """
    group = take(h, int64(size_of(h, nv)))
    if group != 0:
        begin(h, group, nv)
    return group


@kernel
def find_copy(h: Memory, iad: int, nv: Offset) -> int:
    """Address of a new group with the words of that at `iad`, of the size `nv`; there must be room for it."""
    group = find(h, nv)
    copy_words(h, iad, group, int64(size_of(h, nv)))
    return group


@kernel
def copy_words(h: Memory, iad: int, group: int, n: int) -> None:
    """The first `n` words of the group at `group` := those of the group at `iad`."""
    for i in range(n):
        puti(h, group, WORD, iget(h, iad, WORD, i), i)


@kernel
def begin(h: Memory, group: int, nv: Offset) -> None:
    """A group of the size `nv` begins at `group`, its words zero."""
    note_found(h, group, nv)
    clear_group(h, group, nv)


@kernel
def clear_group(h: Memory, group: int, nv: Offset) -> None:
    """All words of the group of the size `nv` at `group` := 0."""
    for i in range(size_of(h, nv)):
        puti(h, group, WORD, 0, i)


@kernel
def take(h: Memory, n: int) -> int:
    """Address of `n` words from the junk list or the fresh memory; 0 and error 1 if there are none."""
    group, before = _chain(h, n)
    if group != 0:
        after = iget(h, group, JNEXT)
        if after != 0:
            puti(h, after, JSIZES, iget(h, group, JSIZES))
            _link_chain(h, before, after)
        else:
            _link_chain(h, before, iget(h, group, JSIZES))
    else:
        group = h.ci[g.MFREE]
        if group + n - 1 > h.ci[g.MTOP]:
            want(h, n)
            return int64(0)
        h.ci[g.MFREE] = group + n
    return group


@kernel
def unwatch(h: Memory, group: int) -> None:
    """Detach histories from the group at `group`."""
    ih = int64(h.ci[g.IHPNT])
    while ih != 0:
        if iget(h, ih, g.KHG) == group:
            puti(h, ih, g.KHG, 0)
        ih = iget(h, ih, g.KH)


@kernel
def lose_behind(h: Memory, group: int, nv: Offset) -> None:
    """The group of the size `nv` at `group` is part of the one before, which is lost next."""
    unwatch(h, group)
    note_merged(h, group, nv)


@kernel
def lose_with(h: Memory, group: int, nv: Offset, words: int) -> None:
    """Give the group of the size `nv` at `group` back with those behind it, `words` words together."""
    unwatch(h, group)
    note_lost(h, group, nv)
    to_junk(h, group, words)


@kernel
def lose(h: Memory, group: int, nv: Offset) -> None:
    """Give the group of the size `nv` at `group` back to the junk list."""
    lose_with(h, group, nv, int64(size_of(h, nv)))


@kernel
def to_junk(h: Memory, group: int, n: int) -> None:
    """Enter the `n` words at `group` in the junk list."""
    first, before = _chain(h, n)
    if first == 0:
        puti(h, group, JSIZES, h.ci[g.JUNK])
        h.ci[g.JUNK] = group
    else:
        puti(h, group, JSIZES, iget(h, first, JSIZES))
        _link_chain(h, before, group)
    puti(h, group, JNEXT, first)
    puti(h, group, JSIZE, n)


@kernel
def all_to_junk(h: Memory, groups: Any, nv: Offset, words: int) -> None:
    """Enter the groups of the size `nv` at the addresses `groups` in the junk list; histories stay.

    words: of each with those behind it.
    """
    for k in range(len(groups)):
        note_lost(h, int64(groups[k]), nv)
        to_junk(h, int64(groups[k]), int64(words))


@kernel
def room(h: Memory, words: int) -> bool:
    """True if `words` words of fresh memory are left; else asks for them (error 1, NWANT).

    A routine asks for all it may need before its first change, so that the map is never left half-made.
    """
    if h.ci[g.MFREE] + words - 1 > h.ci[g.MTOP]:
        want(h, words)
        return False
    return True


@kernel
def room_for_two(h: Memory, one: int, two: int) -> bool:
    """True if groups of `one` and `two` words, which differ, can be found; else asks for them."""
    words = int64(0)
    if _chain(h, one)[0] == 0:
        words += one
    if _chain(h, two)[0] == 0:
        words += two
    return words == 0 or room(h, words)
