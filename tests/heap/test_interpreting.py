"""Kernels that run as Python beside compiled ones: the same bits, and every word that they touch is told."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support import random_deformable_scenes as soft_scenes
from support import random_scenes as scenes
from support.checked_build_marks import without_groups
from support.interpreted_kernels import both_ways

from udec_ia import Model
from udec_ia.compiling.interpreted_kernels import interpreted, mode, observe
from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, iget, int64, puti
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.kernels.drive.cycle import passes
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.running.history_series import run_unwatched
from udec_ia.running.run_cycles import prepare

LONG, SHORT = 30, 3  # cycles compiled, and cycles interpreted

pytestmark = both_ways


@kernel
def twice(h: Memory, iad: int) -> int:
    """Double a word."""
    puti(h, iad, g.KB, 2 * iget(h, iad, g.KB))
    return iget(h, iad, g.KB)


@kernel
def four_times(h: Memory, iad: int) -> int:
    """Double it twice."""
    twice(h, iad)
    return twice(h, iad)


def words(h: Memory) -> list[bytes]:
    return [np.asarray(part).tobytes() for part in (h.ia, h.ci, h.cr, h.cd)]


@without_groups
def test_what_a_kernel_calls_is_interpreted_too_and_all_is_told() -> None:
    array = MainArray(ALL_SCHEMES["i32r64"])
    puti(array.h, 10, g.KB, 5)
    told: list[Any] = []
    with interpreted():
        assert four_times(observe(array.h, lambda *access: told.append(access)), int64(10)) == 20
    assert told == [
        *[("ia", 10, 5, False), ("ia", 10, 10, True), ("ia", 10, 10, False)],
        *[("ia", 10, 10, False), ("ia", 10, 20, True), ("ia", 10, 20, False)],
    ]
    assert four_times(array.h, int64(10)) == 80
    assert len(told) == 6
    assert four_times(observe(array.h, lambda *access: told.append(access)), int64(10)) == 320
    assert len(told) == 12


def test_it_ends_with_the_context_whatever_ends_that() -> None:
    found = []

    def fails() -> None:
        with interpreted():
            found.append(mode.python)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fails()
    assert [*found, mode.python] == [True, False]


class Twin:
    """The words `h` of a memory as they follow from what is told of it."""

    def __init__(self, h: Memory) -> None:
        self.h = h
        self.accesses = 0

    def tell(self, name: str, where: Any, value: Any, written: bool) -> None:
        """Do the same, or find the same there."""
        part = getattr(self.h, name)
        self.accesses += 1
        if written:
            part[where] = value
        else:
            assert np.array_equal(part[where], value, equal_nan=np.asarray(value).dtype.kind == "f")


@pytest.mark.parametrize("module", [scenes, soft_scenes], ids=["rigid", "soft"])
@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_cycles_are_the_same_bit_for_bit(build: str, module: Any) -> None:
    """With the account of the energy, so that every pass is among them."""
    model = module.play(3, Model(build), cycles=(2, 8)).model
    model.energy("on")
    model.cycle(LONG)
    array = model.array
    prepare(array)
    array.h.ci[g.NCYC] = SHORT
    compiled, seen, twin = array.copy(), array.copy(), Twin(array.copy().h)
    laws = LawBook().bind(compiled)
    given = (True if laws.blocks else None, laws.blocks, laws.joints)
    done = run_unwatched(compiled.h, SHORT, given)
    with interpreted():
        laws = LawBook().bind(seen)
        given = (True if laws.blocks else None, laws.blocks, laws.joints)
        assert run_unwatched(observe(seen.h, twin.tell), SHORT, given) == done
    assert words(seen.h) == words(compiled.h)
    assert words(twin.h) == words(seen.h)
    assert twin.accesses > 1000


def test_a_command_within_is_the_same_command() -> None:
    one, two = (scenes.play(7, Model(), cycles=(2, 8)).model for _ in range(2))
    one.cycle(5)
    with interpreted():
        two.cycle(5)
        assert all(callable(entry) for entry in passes(two.array.h, None, (), -1.0, False, ())[:2])
    assert words(one.array.h) == words(two.array.h)
    assert one.check() == two.check() == []
