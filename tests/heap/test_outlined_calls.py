"""A kernel that others call where it is does what it does when Python calls it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.checked_build_marks import without_groups

from udec_ia.compiling import build_choice
from udec_ia.compiling.build_choice import DISABLED
from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.compiling.non_inlined_calls import call_entry, entry, entry_if
from udec_ia.heap.accessors import Memory, iget, int64, puti
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME, Scheme
from udec_ia.layout import offsets as g

with_our_linking = pytest.mark.skipif(
    DISABLED or build_choice.plain_wanted(), reason="nothing is compiled, or without our linking"
)


@outlined
def count_down(h: Memory, iad: int) -> bool:
    """Take 1 from the word at `iad`; True as long as something is left."""
    puti(h, iad, g.KB, iget(h, iad, g.KB) - 1)
    return bool(iget(h, iad, g.KB) > 0)


@kernel
def calls(h: Memory, iad: int, where: Any) -> int:
    """How often `where` says True."""
    n = 0
    while call_entry(where, h, int64(iad)):
        n += 1
    return n


@kernel
def takes_it_in(h: Memory, iad: int) -> bool:
    """The same, taken in."""
    return count_down(h, iad)


@without_groups
@pytest.mark.parametrize("scheme", ALL_SCHEMES.values(), ids=list(ALL_SCHEMES))
def test_it_is_called_with_the_memory_and_what_it_returns_comes_back(scheme: Scheme) -> None:
    h = MainArray(scheme).h
    puti(h, 10, g.KB, 7)
    assert calls(h, 10, entry(count_down, h, 0)) == 6
    assert iget(h, 10, g.KB) == 0
    puti(h, 10, g.KB, 2)
    assert [count_down(h, int64(10)) for _ in range(2)] == [True, False]


def test_there_is_one_for_each_word_scheme() -> None:
    """And the same again for another memory of the same scheme."""
    where = [entry(count_down, MainArray(scheme).h, 0) for scheme in ALL_SCHEMES.values()]
    again = [entry(count_down, MainArray(scheme).h, 0) for scheme in ALL_SCHEMES.values()]
    assert where == again
    assert len(set(where)) == (len(ALL_SCHEMES) if isinstance(where[0], int) else 1)


@with_our_linking
def test_what_is_not_wanted_is_not_compiled_and_is_at_hand_from_then_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("udec_ia.compiling.cache_folder.cache_folder", lambda: tmp_path)
    seldom = outlined(count_down.dispatcher.py_func)
    one, other = (MainArray(ALL_SCHEMES[build]).h for build in ("i32r64", "i32r32"))
    assert entry_if(False, seldom, one, 0) == 0
    where = entry_if(True, seldom, one, 0)
    assert where == entry(seldom, one, 0) == entry_if(False, seldom, one, 0) != 0
    assert entry_if(False, seldom, other, 0) == 0


@with_our_linking
@without_groups
def test_what_calls_it_does_not_take_it_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The machine code of the caller has no copy of it. Of what it finds on disk numba shows nothing."""
    monkeypatch.setattr("udec_ia.compiling.cache_folder.cache_folder", lambda: tmp_path)
    taking, calling = (kernel(one.dispatcher.py_func) for one in (takes_it_in, calls))
    h = MainArray(ALL_SCHEMES[DEFAULT_SCHEME]).h
    puti(h, 10, g.KB, 1)
    assert not taking(h, np.int64(10))
    assert calling(h, np.int64(10), entry(count_down, h, 0)) == 0
    made = [next(iter(one.dispatcher.overloads.values())).library.get_llvm_str() for one in (taking, calling)]
    assert ["count_down" in code for code in made] == [True, False]
