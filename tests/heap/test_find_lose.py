"""FIND, LOSE, growth and the accessors, against a dict and in all five word schemes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from naive.memory import Memory as NaiveMemory
from support.checked_build_marks import with_any_offset, without_groups

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.errors import OVERFLOW
from udec_ia.heap.accessors import Memory, Offset, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find, lose, room
from udec_ia.heap.main_array import LINE, MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

SCHEMES = tuple(ALL_SCHEMES)
SIZES: tuple[Offset, ...] = (g.NVBL, g.NVCR, g.NVCN, g.NVDO, g.NVZO, g.NVDE)
FIELDS = [
    (group, field)
    for group in read_table().groups
    for field in group.fields
    if field.role != "head" and field.count == 1
]


class Heap(RuleBasedStateMachine):
    """FIND and LOSE in any order do what the dict does; the array grows when it may."""

    @initialize(name=st.sampled_from(SCHEMES), mtop=st.one_of(st.none(), st.integers(40, 400)))
    def start(self, name: str, mtop: int | None) -> None:
        self.array = MainArray(scheme(name), mtop)
        self.naive = NaiveMemory(int(self.array.h.ci[g.MTOP]))
        self.sizes: dict[int, Offset] = {}
        self.stamp = 0
        self.stamps: dict[int, int] = {}

    @rule(nv=st.sampled_from(SIZES))
    def find(self, nv: Offset) -> None:
        h = self.array.h
        before = h.ia.copy()
        group, expected = int(find(h, nv)), self.naive.find(size_of(h, nv))
        assert group == expected
        if group == 0:
            assert h.ci[g.NERR] == OVERFLOW
            assert h.ci[g.NWANT] == size_of(h, nv)
            assert (h.ia == before).all()
            h.ci[g.NERR] = h.ci[g.NWANT] = 0
            return
        assert not h.ia[group - 1 : group - 1 + size_of(h, nv)].any()
        self.sizes[group] = nv
        self.stamp = self.stamp % 30000 + 1
        self.stamps[group] = self.stamp
        h.ia[group - 1 : group - 1 + size_of(h, nv)] = self.stamp

    @precondition(lambda self: self.sizes)
    @rule(data=st.data())
    def lose(self, data: Any) -> None:
        group = data.draw(st.sampled_from(sorted(self.sizes)))
        lose(self.array.h, group, self.sizes.pop(group))
        del self.stamps[group]
        self.naive.lose(group)

    @precondition(lambda self: not self.array.fixed)
    @rule(words=st.integers(1, 20000))
    def grow(self, words: int) -> None:
        h = self.array.h
        if room(h, words):
            assert h.ci[g.NERR] == 0
            return
        assert h.ci[g.NERR] == OVERFLOW
        size = int(h.ci[g.MTOP])
        if self.array.grow():
            assert self.array.h.ci[g.NERR] == self.array.h.ci[g.NWANT] == 0
            assert room(self.array.h, words)
        else:
            assert h.ci[g.MFREE] + words - 1 > self.array.limit
            assert self.array.h.ci[g.MTOP] == size
            h.ci[g.NERR] = h.ci[g.NWANT] = 0
        self.naive.top = int(self.array.h.ci[g.MTOP])

    @invariant()
    def tiles_and_keeps(self) -> None:
        if not hasattr(self, "array"):
            return
        h = self.array.h
        assert h.ci[g.MFREE] == self.naive.free
        assert self.naive.words() == list(range(1, self.naive.free))
        assert len(h.ia) == h.ci[g.MTOP] <= self.array.scheme.top_address
        for group, stamp in self.stamps.items():
            assert (h.ia[group - 1 : group - 1 + size_of(h, self.sizes[group])] == stamp).all()


TestHeap = Heap.TestCase
TestHeap.settings = settings(
    deadline=None, max_examples=60, stateful_step_count=40, suppress_health_check=[HealthCheck.too_slow]
)


@pytest.mark.parametrize("name", ["i16r32", "i16r64"])
@pytest.mark.parametrize("mtop", [None, 32767])
def test_16_bit_heap_ends_before_an_address_wraps(name: str, mtop: int | None) -> None:
    array = MainArray(scheme(name), mtop)
    last = 0
    for _ in range(32767):
        group = int(find(array.h, g.NVCN))
        if group == 0 and not array.grow():
            break
        if group:
            assert group > last
            puti(array.h, group, g.KC, last)
            last = group
    else:
        pytest.fail("a 16-bit heap took more groups than it has words")
    size = size_of(array.h, g.NVCN)
    assert last + size - 1 <= 32767 < last + 2 * size - 1 + array.scheme.ratio
    assert array.h.ci[g.NERR] == OVERFLOW
    steps = 0
    while last:  # the chain leads all the way down again: no address was cut off by the word
        below = iget(array.h, last, g.KC)
        assert below in (0, last - size)
        last, steps = below, steps + 1
    assert steps == (array.h.ci[g.MFREE] - 1) // size


def test_mtop_beyond_the_word_is_refused() -> None:
    with pytest.raises(ValueError, match="32767"):
        MainArray(scheme("i16r32"), 32768)
    with pytest.raises(ValueError, match="between 1"):
        MainArray(scheme("i32r64"), 0)


@pytest.mark.parametrize("name", SCHEMES)
def test_words_begin_where_a_line_of_memory_does(name: str) -> None:
    array = MainArray(scheme(name))
    copy = array.copy()
    assert not room(array.h, 9000)
    assert array.grow()
    for one in (MainArray(scheme(name), 100), copy, array):
        assert one.h.ia.ctypes.data % LINE == 0


@pytest.mark.parametrize("name", SCHEMES)
def test_growth_keeps_both_views(name: str) -> None:
    array = MainArray(scheme(name))
    group = int(find(array.h, g.NVBL))
    puti(array.h, group, g.KP, 1234)
    putr(array.h, group, g.KX, -2.5)
    old = array.h
    array.h.ci[g.NERR], array.h.ci[g.NWANT] = OVERFLOW, len(array.h.ia)
    assert array.grow()
    assert len(array.h.ia) > len(old.ia)
    assert iget(array.h, group, g.KP) == 1234
    assert getr(array.h, group, g.KX) == -2.5
    puti(array.h, group, g.KP, 1)
    assert iget(old, group, g.KP) == 1234


@pytest.mark.parametrize("name", SCHEMES)
def test_int_and_real_views_share_bytes(name: str) -> None:
    array = MainArray(scheme(name))
    h = array.h
    group = int(find(h, g.NVCR))
    putr(h, group, g.KXP, 1.75)
    ratio = array.scheme.ratio
    word = group + (g.KXP[ratio >> 1] - 1) * ratio  # first integer word of the real
    bits = h.ia[word - 1 : word - 1 + ratio].tobytes()
    assert np.frombuffer(bits, array.scheme.real_type)[0] == 1.75
    h.ia[word - 1 : word - 1 + ratio] = np.frombuffer(np.array([-3.5], array.scheme.real_type), h.ia.dtype)
    assert getr(h, group, g.KXP) == -3.5


@kernel
def _put_both(h: Memory, iad: int, ki: Offset, n: int, kr: Offset, v: float) -> None:
    puti(h, iad, ki, n)
    putr(h, iad, kr, v)


@kernel
def _get_both(h: Memory, iad: int, ki: Offset, kr: Offset) -> tuple[int, float]:
    return iget(h, iad, ki), getr(h, iad, kr)


@kernel
def _real_then_words(h: Memory, iad: int, kr: Offset, v: float, ki: Offset) -> int:
    putr(h, iad, kr, v)  # the store through one view must be seen by the load through the other
    return iget(h, iad, ki)


@without_groups
@pytest.mark.parametrize("name", SCHEMES)
def test_accessors_compiled_and_interpreted_agree(name: str) -> None:
    """Every field of every group: written by one, read by the other, at the first and at a later address."""
    array = MainArray(scheme(name))
    h = array.h
    integers = [getattr(g, field.name) for _, field in FIELDS if not field.real]
    reals = [getattr(g, field.name) for _, field in FIELDS if field.real]
    kind = array.scheme.real_type.type
    for iad in (1, 1 + 40 * array.scheme.ratio):
        for i in range(max(len(integers), len(reals))):
            ki, kr = integers[i % len(integers)], reals[i % len(reals)]
            value = kind(0.1 + i)
            h.ia[:] = 0
            _put_both(h, iad, ki, 7 + i, kr, value)
            compiled = h.ia.copy()
            h.ia[:] = 0
            puti(h, iad, ki, 7 + i)
            putr(h, iad, kr, value)
            assert (h.ia == compiled).all()
            assert _get_both(h, iad, ki, kr) == (iget(h, iad, ki), getr(h, iad, kr))


@with_any_offset
@pytest.mark.parametrize("name", SCHEMES)
def test_a_compiled_load_sees_a_store_through_the_other_view(name: str) -> None:
    array = MainArray(scheme(name))
    h, ratio = array.h, array.scheme.ratio
    word = (g.KX[0] - 1, (g.KX[1] - 1) * 2, (g.KX[2] - 1) * 4)  # first word of the real, as an integer
    for value in (1.0, -2.0, 3.25):
        seen = _real_then_words(h, 1, g.KX, array.scheme.real_type.type(value), word)
        assert seen == h.ia[word[ratio >> 1]] == np.array([value], array.scheme.real_type).view(h.ia.dtype)[0]
