"""Three things of the memory that must not touch a result: addresses, the width of integers, reuse of words.

One run has it all: blocks of all types, boundary conditions, functions, damping, laws of the user's, an
account of the energy and histories; it is cut, loses blocks and breaks contacts, so that groups are made and
given back. It is played again with something done to the memory between any two steps, and must come to the
same map, numbers and records bit for bit. Scenes at random (test_scenes.py, test_deformable_scenes.py) are
played so, too.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
from naive.relocate import differences, essence, relocate
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.heap.word_scheme import scheme
from udec_ia.heap_tools.convert_word_scheme import convert
from udec_ia.heap_tools.renumber_groups import renumber
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.split_blocks import Boxes

STEPS: list[Callable[[Model], Any]] = [
    lambda m: m.property(1, block_cohesion=1e4, block_friction=0.5, dilation=0.1, critical_slip=0.001),
    lambda m: m.change(2, 4, -1, 1, constitutive=2),
    lambda m: m.damping(0.05, 20),
    lambda m: m.energy(),
    lambda m: m.history(3, "unbalanced"),
    *[lambda m: m.cycle(7)] * 4,
    lambda m: m.change(2, 3, 0, 1, type="rigid"),
    lambda m: m.split(1.4, -2, 1.4, 2),
    lambda m: m.boundary(5, 6, 0.1, 0.9, xvel=200.0),
    lambda m: m.cycle(7),
    lambda m: m.change(3, 4, 0, 1, type="sdef"),
    lambda m: m.delete(1, 1.4, 0, 1),
    lambda m: m.split(-1, 0.6, 1.2, 0.6),
    *[lambda m: m.cycle(7)] * 4,
]
Between = Callable[[Model], None]


def play(build: str, between: Between, folder: Any) -> tuple[dict[str, Any], list[Any]]:
    """The map at the end, and what was recorded."""
    m = Model(build, out=folder, constitutive=["mohr-coulomb", "joint-dilation"])
    m.tell = lambda _: None
    m.run(plain_deck())
    for step in STEPS:
        between(m)
        m.session.split_boxes = Boxes()  # SPLIT stores them by address
        m.session.undo.release()
        step(m)
    assert int(m.h.ci[g.NBROKE]) > 0
    assert [len(one.numbers) for one in m.histories()] == [7, 7, 7, 7, 22]
    return essence(m.array), [one.numbers for one in m.histories()]


@cache
def plain_deck() -> str:
    return every_kind().deck()


def nothing(_: Model) -> None:
    """The run as it is."""


def at_random() -> Between:
    """Every group anywhere."""
    rng = np.random.default_rng(4)

    def shuffle(m: Model) -> None:
        m.session.array = relocate(m.array, rng)
        assert m.check() == []

    return shuffle


def forget(m: Model) -> None:
    """No word is used a second time."""
    m.array.h.ci[g.JUNK] = 0


def in_order(m: Model) -> None:
    renumber(m.array)
    assert m.check() == []


def to_and_fro(m: Model) -> None:
    """Through all other widths of integers."""
    bits = m.array.scheme.real_bits
    names = [f"i{wide}r{bits}" for wide in (64, 16, 32) if wide <= bits]
    for name in (*names, m.array.scheme.name):
        m.session.array = convert(m.array, scheme(name)).array
    assert m.check() == []


@pytest.fixture(scope="module", name="runs")
def runs_as_they_are(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return {name: play(name, nothing, tmp_path_factory.mktemp(name)) for name in ("i32r32", "i32r64")}


def check_alike(one: tuple[dict[str, Any], list[Any]], two: tuple[dict[str, Any], list[Any]]) -> None:
    assert differences(one[0], two[0]) == []
    for numbers, others in zip(one[1], two[1], strict=True):
        assert np.array_equal(numbers, others, equal_nan=True)  # one of them loses its group


@pytest.mark.parametrize("how", ["at random", "forget", "in order", "to and fro"])
@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_the_memory_does_not_touch_a_bit(how: str, build: str, runs: dict[str, Any], tmp_path: Any) -> None:
    ways = {"at random": at_random(), "forget": forget, "in order": in_order, "to and fro": to_and_fro}
    check_alike(runs[build], play(build, ways[how], tmp_path))


@pytest.mark.parametrize("build", ["i16r64"])
def test_the_width_of_integers_does_not_touch_a_bit(build: str, runs: dict[str, Any], tmp_path: Any) -> None:
    check_alike(runs[f"i32r{build[-2:]}"], play(build, nothing, tmp_path))
