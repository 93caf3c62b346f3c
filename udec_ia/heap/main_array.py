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
from udec_ia.heap.junk_list import chains_below, junk_chains, link_chains
from udec_ia.heap.word_scheme import Scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, Group, Layout, layouts, read_table

FIRST_SIZE = 8192
LARGE, AMPLE = 2**20, 2**27  # words: from LARGE on it grows to AMPLE at once, and then by doubling
PIECE = 16384  # groups that are copied together: they fit in the machine's caches
LINE = 64  # bytes that the machine's memory hands out at a time
MANY_BLOCKS = 500  # from this number on it matters where groups lie: fewer fit in the machine's caches


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

    order: the addresses of all groups by kind; groups behind others follow these. The main lists follow the
    new order; the junk list is empty afterwards. Returns the new address of the group at each old address, 0
    where there was none.
    """
    moved = compact(array, order, 1)
    for kind, at in order.items():
        if read_table().group(kind).list_head is not None and len(at):
            _relink(array, kind, moved[at])
    return moved


def compact(array: MainArray, order: dict[str, Any], first: int) -> Any:
    """Lay out the groups from the address `first` on: kind by kind, and within a kind in the given order.

    Takes the order of `relocate`, and returns what it does. first: where a group begins, or MFREE. Groups
    below it stay, lists keep their order, and junk from `first` on becomes fresh memory.
    """
    h, end = array.h, int(array.h.ci[g.MFREE])
    moved, words = np.zeros(end + 1, h.ia.dtype), np.zeros_like(h.ia[first - 1 : end - 1])
    moved[:first] = np.arange(first)
    free = first
    for kind, parts in _hosts(array, order).items():
        at, size = order[kind][order[kind] >= first], _size(parts)
        _enter(moved, at, free + size * np.arange(len(at)), parts)
        rows = words[free - first :][: size * len(at)].reshape(-1, size)
        for k in range(0, len(at), PIECE):
            rows[k : k + PIECE] = sliding_window_view(h.ia, size)[at[k : k + PIECE] - 1]
        free += size * len(at)
    junk = chains_below(junk_chains(h.ia[: end - 1], h.ci[g.JUNK]), first)
    h.ia[first - 1 : end - 1] = words
    h.ci[g.JUNK], h.ci[g.MFREE] = link_chains(h.ia, junk), free
    _renew_pointers(array, order, moved)
    return moved


def _hosts(array: MainArray, order: dict[str, Any]) -> dict[str, list[tuple[Group, Layout]]]:
    """The kinds of `order` that lie behind no other, each with those that lie behind it."""
    return {kind: _together(array, kind) for kind in order if not read_table().group(kind).behind}


def _together(array: MainArray, kind: str, flag: str = "") -> list[tuple[Group, Layout]]:
    """A kind of group, and those behind it in this scene, or as if it had `flag`."""
    table, ci = read_table(), array.h.ci
    behind = table.behind(lambda name: name == flag or int(ci[getattr(g, name)]))
    kinds = [kind]
    while kinds[-1] in behind:
        kinds.append(behind[kinds[-1]])
    return [(table.group(one), layouts(array.scheme.ratio)[one]) for one in kinds]


def _size(parts: list[tuple[Group, Layout]]) -> int:
    return sum(layout.size for _, layout in parts)


def words_to_lengthen(array: MainArray, order: dict[str, Any], flag: str) -> int:
    """Words of new memory that `lengthen` needs."""
    total = 0
    for kind, parts in _hosts(array, order).items():
        longer = _size(_together(array, kind, flag))
        if longer > _size(parts):
            total += longer * len(order[kind])
    return total


def lengthen(array: MainArray, order: dict[str, Any], flag: str) -> None:
    """Set `flag`, and give all groups those that lie behind them in scenes with it, filled with 0.

    The longer groups move to the end of the heap. order: as of `relocate`. There must be room. `array.moved`
    becomes the new address of the group at each old address, that of before if groups have moved already.
    """
    h, free = array.h, int(array.h.ci[g.MFREE])
    moved = np.arange(free + 1, dtype=h.ia.dtype)
    for kind, parts in _hosts(array, order).items():
        at, size, longer = order[kind], _size(parts), _size(_together(array, kind, flag))
        if longer == size or not len(at):
            continue
        _enter(moved, at, free + longer * np.arange(len(at)), parts)
        rows = h.ia[free - 1 :][: longer * len(at)].reshape(-1, longer)
        rows[:, :size], rows[:, size:] = sliding_window_view(h.ia, size)[at - 1], 0
        free += longer * len(at)
        all_to_junk(h, at, getattr(g, read_table().group(kind).size_name), size)
    h.ci[getattr(g, flag)], h.ci[g.MFREE] = 1, free
    _renew_pointers(array, order, moved)
    array.moved = moved if array.moved is None else moved[array.moved]


def _enter(moved: Any, at: Any, to: Any, parts: list[tuple[Group, Layout]]) -> None:
    """Groups of some kind at the addresses `at` get the addresses `to`, with those behind them."""
    before = 0  # words of the parts before
    for _, layout in parts:
        moved[at + before] = to + before
        before += layout.size


def _renew_pointers(array: MainArray, order: dict[str, Any], moved: Any) -> None:
    """Make all pointers lead to the new addresses of groups. order: old addresses of all groups by kind."""
    h = array.h
    for kind, parts in _hosts(array, order).items():
        at = moved[order[kind]].astype(np.int64)
        for group, layout in parts:
            for field in group.fields:
                if field.target is not None:
                    words = at[:, None] + (layout.offset[field.name] - 1 + np.arange(field.count))
                    h.ia[words] = moved[h.ia[words]]
            at += layout.size
    for field in read_table().common:
        if field.target is not None:
            i = getattr(g, field.name)
            h.ci[i] = moved[h.ci[i]]
    forget_kinds(h.ia)


def _relink(array: MainArray, kind: str, at: Any) -> None:
    """Make the main list of a kind run through its groups at the addresses `at` in order."""
    h, group = array.h, read_table().group(kind)
    h.ci[getattr(g, str(group.list_head))] = at[0]
    for field in group.fields:
        words = at.astype(np.int64) + (layouts(array.scheme.ratio)[kind].offset[field.name] - 1)
        if field.role == "next":
            h.ia[words[:-1]], h.ia[words[-1]] = at[1:], 0
        elif field.role == "back":
            h.ia[words[1:]], h.ia[words[0]] = at[:-1], 0
