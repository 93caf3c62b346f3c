"""IA() itself: its views, its common block, how it grows, and how its groups are relocated.

1980 fixed the size of IA() when the program was compiled (MTOP), as `mtop` does here; without it the array
grows whenever a routine asks for room. Where a group lies means nothing to the program (report 3.5). But
groups that are used together should lie together, and the field table knows which words are addresses.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from udec_ia.compiling.build_choice import CHECKED, checked_build, forget_kinds
from udec_ia.errors import OVERFLOW
from udec_ia.heap.accessors import Memory
from udec_ia.heap.find_lose import all_to_junk
from udec_ia.heap.junk_list import junk_chains, link_chains
from udec_ia.heap.word_scheme import Scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, Group, Layout, layouts, read_table

FIRST_SIZE = 8192
LARGE, AMPLE = 2**20, 2**27  # words: from LARGE on it grows to AMPLE at once, and then by doubling
PIECE = 16384  # groups that are copied together: they fit in the machine's caches
LINE = 64  # bytes that the machine's memory hands out at a time
MANY = 500  # blocks: from this number on the places of groups matter, as fewer fit in the machine's caches


def _words(n: int, kind: Any) -> Any:
    """`n` words of the type `kind`, all zero, that begin where a line of memory does."""
    data = np.zeros(n * kind.itemsize + LINE, np.uint8)
    start = -data.ctypes.data % LINE
    return data[start : start + n * kind.itemsize].view(kind)


def variable(h: Memory, field: Field) -> Any:
    """The elements of a variable of the common block, in place."""
    first = getattr(g, field.name)
    return {"int": h.ci, "real": h.cr, "double": h.cd}[field.type][first : first + field.count]


class MainArray:
    """The main array and the common block of one model.

    `h` is the Memory that kernels work on; it is a new object after the array has grown. `moved`: new address
    of the group at each old one after `lengthen`, until the session has taken it.
    """

    moved: Any = None

    def __init__(self, scheme: Scheme, mtop: int | None = None) -> None:
        if mtop is not None and not 1 <= mtop <= scheme.top_address:
            raise ValueError(
                f"mtop must lie between 1 and {scheme.top_address}, the last address of {scheme.name}"
            )
        self.scheme = scheme
        self.fixed = mtop is not None
        words = self._whole_reals(min(FIRST_SIZE, scheme.top_address) if mtop is None else mtop)
        common = (
            np.zeros(g.NCOMI, np.int64),
            np.zeros(g.NCOMR, scheme.real_type),
            np.zeros(g.NCOMD, np.float64),
        )
        self.h = self._views(_words(words, scheme.int_type), *common)
        self.h.ci[g.MFREE] = 1
        self.h.ci[g.MTOP] = words

    def _copied(self, size: int) -> Any:
        """`size` words, of which those below MFREE are as they are now and the others zero."""
        ia, used = _words(size, self.scheme.int_type), int(self.h.ci[g.MFREE]) - 1
        ia[:used] = self.h.ia[:used]
        if CHECKED:
            checked_build("access_checks").follow(self.h.ia, ia)
        return ia

    def _whole_reals(self, words: int) -> int:
        return words // self.scheme.ratio * self.scheme.ratio

    def _views(self, ia: Any, ci: Any, cr: Any, cd: Any) -> Memory:
        return Memory(ia, ia.view(self.scheme.real_type), ci, cr, cd)

    @property
    def limit(self) -> int:
        """Largest size that the array can ever have."""
        return int(self.h.ci[g.MTOP]) if self.fixed else self._whole_reals(self.scheme.top_address)

    def grow(self) -> bool:
        """Make the room that an interrupted routine asked for; False if the limit forbids it.

        On success error 1 and the request are cleared, and the routine can be called again.
        """
        ci = self.h.ci
        need = int(ci[g.MFREE] + ci[g.NWANT])
        if need - 1 > self.limit:
            return False
        wanted = max(2 * need, FIRST_SIZE if need < LARGE else AMPLE)  # words not touched yet cost nothing
        size = min(self._whole_reals(wanted), self.limit)
        self.h = self._views(self._copied(size), ci, self.h.cr, self.h.cd)
        ci[g.MTOP] = size
        ci[g.NWANT] = 0
        if ci[g.NERR] == OVERFLOW:
            ci[g.NERR] = 0
        return True

    def refit(self, mtop: int | None) -> bool:
        """Let the array have `mtop` words and no more, or grow if that is None; False if it holds more."""
        if mtop is not None:
            size = self._whole_reals(mtop)
            if self.h.ci[g.MFREE] - 1 > size or mtop > self.scheme.top_address:
                return False
            self.h = self._views(self._copied(size), *self.h[2:])
            self.h.ci[g.MTOP] = size
        self.fixed = mtop is not None
        return True

    def __getstate__(self) -> tuple[Any, ...]:
        """For pickle: what counts, which are the words below MFREE and the common block."""
        used = int(self.h.ci[g.MFREE]) - 1
        return self.scheme, self.fixed, len(self.h.ia), self.h.ia[:used], *self.h[2:]

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self.scheme, self.fixed, size, words, *common = state
        ia = _words(size, self.scheme.int_type)
        ia[: len(words)] = words
        self.h = self._views(ia, *common)

    def __deepcopy__(self, _: Any) -> MainArray:
        return self.copy()

    def copy(self) -> MainArray:
        """An independent copy of the whole state."""
        other = object.__new__(MainArray)
        other.scheme, other.fixed = self.scheme, self.fixed
        other.h = self._views(self._copied(len(self.h.ia)), *(part.copy() for part in self.h[2:]))
        return other


def relocate(array: MainArray, order: dict[str, Any]) -> Any:
    """Lay out all groups afresh from address 1: kind by kind, and within a kind in the given order.

    order: for every kind of group in use the addresses of all its groups; groups behind others follow these.
    The main lists follow the new order; the junk list is empty afterwards. Returns the new address of the
    group at each old address, 0 where there was none.
    """
    h, table = array.h, read_table()
    kinds = {kind: _together(array, kind) for kind in order if not table.group(kind).behind}
    moved = np.zeros(int(h.ci[g.MFREE]) + 1, h.ia.dtype)  # new address of the group at an address; 0 stays 0
    free = 1
    for kind, parts in kinds.items():
        size = sum(layout.size for _, layout in parts)
        moved[order[kind]] = free + size * np.arange(len(order[kind]))
        free += size * len(order[kind])
    words = np.zeros_like(h.ia[: free - 1])
    for kind, parts in kinds.items():
        start, size = int(moved[order[kind][0]]) - 1, sum(layout.size for _, layout in parts)
        rows = words[start : start + size * len(order[kind])].reshape(-1, size)
        before = 0  # words of the parts before
        for group, layout in parts:
            part = rows[:, before : before + layout.size]
            for first in range(0, len(rows), PIECE):
                at = order[kind][first : first + PIECE] + before
                part[first : first + PIECE] = _copies(h.ia, at, group, layout, moved)
            _relink(part, group, layout, moved[order[kind]])
            moved[order[kind] + before] = moved[order[kind]] + before
            before += layout.size
    h.ia[: free - 1] = words
    h.ia[free - 1 : int(h.ci[g.MFREE]) - 1] = 0
    for field in table.common:
        if field.role == "head":
            i = getattr(g, field.name)
            h.ci[i] = moved[h.ci[i]]
    for kind, ((group, _), *_) in kinds.items():
        if group.list_head is not None:
            h.ci[getattr(g, group.list_head)] = moved[order[kind][0]]
    h.ci[g.JUNK], h.ci[g.MFREE] = 0, free
    forget_kinds(h.ia)
    return moved


def _together(array: MainArray, kind: str, flag: str = "") -> list[tuple[Group, Layout]]:
    """A kind of group, and those behind it in this scene, or as if it had `flag`."""
    table, ci = read_table(), array.h.ci
    behind = table.behind(lambda name: name == flag or int(ci[getattr(g, name)]))
    kinds = [kind]
    while kinds[-1] in behind:
        kinds.append(behind[kinds[-1]])
    return [(table.group(one), layouts(array.scheme.ratio)[one]) for one in kinds]


def words_to_lengthen(array: MainArray, order: dict[str, Any], flag: str) -> int:
    """Words of new memory that `lengthen` needs."""
    total = 0
    for kind in (kind for kind in order if not read_table().group(kind).behind):
        longer = sum(one.size for _, one in _together(array, kind, flag))
        if longer > sum(one.size for _, one in _together(array, kind)):
            total += longer * len(order[kind])
    return total


def lengthen(array: MainArray, order: dict[str, Any], flag: str) -> None:
    """Set `flag`, and give all groups those that lie behind them in scenes with it, filled with 0.

    The longer groups move to the end of the heap. order: as of `relocate`. There must be room. `array.moved`
    becomes the new address of the group at each old address, that of before if groups have moved already.
    """
    h, table = array.h, read_table()
    free = int(h.ci[g.MFREE])
    before = {kind: _together(array, kind) for kind in order if not table.group(kind).behind}
    h.ci[getattr(g, flag)] = 1
    moved = np.arange(free + 1, dtype=h.ia.dtype)
    for kind, parts in before.items():
        size, at = sum(one.size for _, one in parts), order[kind]
        longer = sum(one.size for _, one in _together(array, kind))
        if longer == size:
            continue
        moved[at] = free + longer * np.arange(len(at))
        h.ia[free - 1 : free - 1 + longer * len(at)] = 0
        free += longer * len(at)
        words = np.arange(size) - 1
        h.ia[moved[at][:, None] + words] = h.ia[at[:, None] + words]
        behind = 0  # words of the parts before
        for _, part in parts:
            moved[at + behind] = moved[at] + behind
            behind += part.size
        all_to_junk(h, at, getattr(g, table.group(kind).size_name), size)
    h.ci[g.MFREE] = free
    _renew_pointers(array, order, moved)
    array.moved = moved if array.moved is None else moved[array.moved]


def gather(array: MainArray, order: dict[str, Any], first: int) -> None:
    """Lay out the groups from the address `first` on kind by kind, and within a kind in the given order.

    order: as of `relocate`, with all groups. Those below `first` stay, and lists run as before. Memory that
    was given back from `first` on is fresh memory again. Nobody may keep an address from `first` on.
    """
    h, end = array.h, int(array.h.ci[g.MFREE])
    moved, rows, free = np.arange(end + 1, dtype=h.ia.dtype), [], first
    for kind in (kind for kind in order if not read_table().group(kind).behind):
        at, parts = order[kind][order[kind] >= first], _together(array, kind)
        size = sum(layout.size for _, layout in parts)
        rows.append(sliding_window_view(h.ia, size)[at - 1].ravel())
        before = 0  # words of the parts before
        for _, layout in parts:
            moved[at + before] = free + before + size * np.arange(len(at))
            before += layout.size
        free += size * len(at)
    junk = [[one for one in chain if one[0] < first] for chain in junk_chains(h.ia[: end - 1], h.ci[g.JUNK])]
    h.ia[first - 1 : free - 1] = np.concatenate(rows)
    h.ia[free - 1 : end - 1] = 0
    h.ci[g.JUNK], h.ci[g.MFREE] = link_chains(h.ia, [chain for chain in junk if chain]), free
    _renew_pointers(array, order, moved)


def _renew_pointers(array: MainArray, order: dict[str, Any], moved: Any) -> None:
    """Make all pointers lead to the new addresses of groups. order: old addresses of all groups by kind."""
    h, table = array.h, read_table()
    for kind, at in order.items():
        offset = layouts(array.scheme.ratio)[kind].offset
        for field in table.group(kind).fields:
            if field.target is not None:
                words = moved[at][:, None] + (offset[field.name] - 1 + np.arange(field.count))
                h.ia[words] = moved[h.ia[words]]
    for field in table.common:
        if field.target is not None:
            i = getattr(g, field.name)
            h.ci[i] = moved[h.ci[i]]
    forget_kinds(h.ia)


def _copies(ia: Any, addresses: Any, group: Group, layout: Layout, moved: Any) -> Any:
    """The words of the groups at `addresses`, one row each, with all addresses in them renewed."""
    rows = sliding_window_view(ia, layout.size)[addresses - 1]
    for field in group.fields:
        if field.target is not None:
            column = slice(layout.offset[field.name], layout.offset[field.name] + field.count)
            rows[:, column] = moved[rows[:, column]]
    return rows


def _relink(rows: Any, group: Group, layout: Layout, addresses: Any) -> None:
    """Make the main list of a kind run through its rows in order."""
    if group.list_head is None:
        return
    for field in group.fields:
        column = layout.offset[field.name]
        if field.role == "next":
            rows[:-1, column], rows[-1, column] = addresses[1:], 0
        elif field.role == "back":
            rows[1:, column], rows[0, column] = addresses[:-1], 0
