"""Invariant 1: every word below MFREE belongs to exactly one group, in use or in the junk list.

The groups in use and the junk groups, laid side by side, must tile the heap without gap or overlap.
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import LOST, State
from udec_ia.heap.accessors import iget, integers
from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.reader.field_reading import KIND_CODE, TABLE, Numbers

JUNK = len(KIND_CODE) + 1  # code of a junk group among those of the kinds


def check_memory(state: State) -> None:
    """Invariant 1; the pointers have been looked at."""
    _check_limits(state)
    junk = _junk_groups(state)
    _check_tiling(state, junk)
    if state.found:  # else every pointer leads to a group in use, and no group in use is junk
        _check_nothing_points_to_junk(state, junk)


def _check_limits(state: State) -> None:
    words, top, free = len(state.h.ia), state.common("MTOP"), state.common("MFREE")
    if top != words:
        state.report(1, f"MTOP is {top}, but the main array has {words} words")
    if not 1 <= free <= words + 1 or (free - 1) % state.ratio:
        state.report(1, f"MFREE is {free}, which is no address of a group in an array of {words} words")


def _junk_groups(state: State) -> dict[int, int]:
    """Address and size of every junk group, as far as the junk list can be followed."""
    sizes = {layout.size for layout in state.layout.values()}
    sizes |= {sum(state.layout[kind].size for kind in row) for row in TABLE.rows}
    junk: dict[int, int] = {}
    known: set[int] = set()
    waiting = [("JUNK", state.common("JUNK"), 0)]  # source and address of a link, and the size of its chain
    while waiting:
        source, iad, of_chain = waiting.pop()
        size = _junk_size(state, iad, sizes, source, junk) if iad else None
        if size is None:
            continue
        if of_chain and size != of_chain:
            text = f"{source} leads to junk@{iad} of {size} words, in the chain of {of_chain} words"
            state.report(1, text)
            continue
        if not of_chain:
            if size in known:
                state.report(1, f"{source} leads to junk@{iad}: a second chain of groups of {size} words")
            known.add(size)
            waiting.append((f"the link to the next size of junk@{iad}", iget(state.h, iad, JSIZES), 0))
        junk[iad] = size
        waiting.append((f"the link of junk@{iad}", iget(state.h, iad, JNEXT), size))
    return junk


def _junk_size(state: State, iad: int, sizes: set[int], source: str, junk: dict[int, int]) -> int | None:
    """Size of the junk group at `iad`; None, and a violation, if none can be there."""
    if iad in junk:
        state.report(1, f"{source} leads back to junk@{iad}: the junk list is a circle")
        return None
    if not 1 <= iad <= state.free - 3 or (iad - 1) % state.ratio:
        state.report(1, f"{source} leads to {iad}, which is no address of a group")
        return None
    size = iget(state.h, iad, JSIZE)
    if size not in sizes or iad + size > state.free:
        state.report(1, f"{source} leads to {iad}, whose size {size} is that of no group there")
        return None
    return size


def gaps(starts: Numbers, sizes: Numbers, free: int) -> Numbers:
    """Where groups, in order of address, do not tile the words below `free`: three columns.

    Address of the group before, 0 for none; the word after it; and where the next group begins, or `free`.
    """
    before, end, start = np.append(0, starts), np.append(1, starts + sizes), np.append(starts, free)
    return np.asarray(np.column_stack((before, end, start))[end != start])


def _check_tiling(state: State, junk: dict[int, int]) -> None:
    names = {code: kind for kind, code in KIND_CODE.items()} | {JUNK: "junk"}
    sizes = np.array([0, *(state.layout[kind].size for kind in KIND_CODE), 0])
    at = np.fromiter(junk, np.int64)
    place = state.place(at)
    taken = state.kind_at[place]
    state.kind_at[place[taken == 0]] = JUNK
    for iad, code in zip(at[taken > 0].tolist(), taken[taken > 0].tolist(), strict=True):
        last = iad + sizes[code] - 1
        state.report(1, f"{names[code]}@{iad} ends at word {last}, but junk@{iad} starts at {iad}")

    def name(iad: int) -> str:
        return f"{names[int(state.kind_at[(iad - 1) // state.ratio])]}@{iad}"

    place = np.flatnonzero(state.kind_at)
    starts, words = place * state.ratio + 1, sizes[state.kind_at[place]]
    of_junk = state.kind_at[place] == JUNK
    words[of_junk] = integers(state.h, starts[of_junk], JSIZE)
    for before, end, start in gaps(starts, words, state.free).tolist():
        left = name(before) if before else "the start of the heap"
        right = name(start) if start != state.free else "MFREE"
        if end < start:
            state.report(1, f"words {end} to {start - 1} between {left} and {right} {LOST}")
        else:
            state.report(1, f"{left} ends at word {end - 1}, but {right} starts at {start}")


def _check_nothing_points_to_junk(state: State, junk: dict[int, int]) -> None:
    if not junk:
        return
    start, size = np.array(sorted(junk.items())).T

    def in_junk(values: Numbers) -> Numbers:
        group = np.searchsorted(start, values, side="right") - 1
        return np.where((group >= 0) & (values - start[group] < size[group]), start[group], 0)

    for kind, addresses in state.address.items():
        for field in TABLE.group(kind).fields:
            if field.target is None:
                continue
            for i in range(field.count):
                group = in_junk(state.column(kind, field.name, i))
                for row in np.flatnonzero(group):
                    state.report(1, f"{field.name} of {kind}@{addresses[row]} points into junk@{group[row]}")
