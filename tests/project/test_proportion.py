"""Every command takes time in proportion to what it touches: four times as much, about four times the time.

Where it was once the square, sixteen times. Times are processor times, the best of three;
`tools/bench.py commands` measures all commands at greater sizes.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from functools import cache
from math import isqrt
from time import process_time

import pytest

from udec_ia import Model
from udec_ia.advice.time_step_warnings import describe_step
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.heap_dump import dump
from udec_ia.heap_tools.memory_use import heap_map
from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import snapshot
from udec_ia.output.plot_frames import Frame, What
from udec_ia.reader.word_map import Atlas
from udec_ia.running.critical_step import bound

ALL = (-1.0, 1e6, -1.0, 1e6)
WORSE = 9  # times the time for four times the size: 4 in proportion, 16 for the square


@pytest.fixture(autouse=True)
def _no_garbage_is_looked_for() -> Iterator[None]:
    """All that a process of the tests has loaded takes a second to go through."""
    gc.disable()
    yield
    gc.enable()


def grid(n: int) -> Model:
    """n blocks in a square, the lowest row fixed."""
    model = Model()
    model.start()
    model.session.array = cut(n).copy()
    return model


@cache
def cut(n: int) -> MainArray:
    """The words of `grid`."""
    model = Model()
    model.property(1, density=2000, kn=1e9, ks=1e9, friction=0.5)
    side = isqrt(n)
    model.block(0, 0, 0, side, side, side, side, 0)
    for i in range(1, side):
        model.split(-1, i, side + 1, i)
    for i in range(1, side):
        model.split(i, -1, i, side + 1)
    model.fix(*ALL[:2], 0, 1)
    return model.array


def times(build: Callable[[int], Model], run: Callable[[Model], object], n: int) -> tuple[float, float]:
    """Processor time of `run` with models built for n and for 4n."""
    found = []
    for size in (n, 4 * n):
        model = build(size)
        state, best = model.array, float("inf")
        for _ in range(3):
            model.session.array = state.copy()
            start = process_time()
            run(model)
            best = min(best, process_time() - start)
        found.append(best)
    return found[0], found[1]


def held(n: int) -> Model:
    """The same, with two conditions on every block."""
    model = grid(n)
    model.boundary(*ALL, xvel=0.0)
    model.boundary(*ALL, xforce=1.0)
    return model


@pytest.mark.parametrize(
    ("build", "run", "n"),
    [
        (grid, lambda m: m.print("contacts"), 100),
        (grid, lambda m: [None for _ in dump(Atlas(m.array.h)).lines()], 100),
        (grid, lambda m: m.dump(1, int(m.h.ci[g.MFREE]) - 1), 100),
        (grid, lambda m: heap_map(Atlas(m.array.h)), 400),
        (grid, lambda m: m.boundary(*ALL, yvel=0.0), 400),
        (held, lambda m: m.boundary(*ALL[:2], 1, 1e6, xvel=1.0), 100),
        (held, lambda m: m.boundary(*ALL[:2], 1, 1e6, free=True), 400),
        (held, lambda m: m.free(*ALL), 100),
        (held, lambda m: m.delete(*ALL[:2], 1, 1e6), 100),
        (held, lambda m: m.change(*ALL[:2], 1, 1e6, type="fdef"), 100),
    ],
    ids=[
        "PRINT",
        "dump",
        "DUMP",
        "map",
        "BOUNDARY",
        "BOUNDARY again",
        "BOUNDARY FREE",
        "FREE",
        "DELETE",
        "CHANGE",
    ],
)
def test_commands(build: Callable[[int], Model], run: Callable[[Model], object], n: int) -> None:
    small, large = times(build, run, n)
    assert large < WORSE * small, (small, large)


@pytest.mark.parametrize("upright", [False, True])
def test_block(upright: bool) -> None:
    """Saw blades of 250 and 1000 corners."""

    def saw(model: Model, n: int) -> None:
        teeth = [(float(i), 10.0 + i % 2) for i in range(n - 2)]
        corners = [(0.0, 0.0), *teeth, (n - 3.0, 0.0)]
        if upright:
            corners = [(-y, x) for x, y in corners]
        model.block(*(number for corner in corners for number in corner))

    found = []
    for n in (250, 1000):
        best = float("inf")
        for _ in range(3):
            model = Model()
            model.start()
            start = process_time()
            saw(model, n)
            best = min(best, process_time() - start)
        found.append(best)
    assert found[1] < WORSE * found[0], found


def test_explaining_the_time_step_is_cheap_beside_cycles() -> None:
    """What a deck's CYCLE line does more than Python's: it took as long as a hundred cycles."""
    model = grid(1600)
    model.cycle(2)
    explained, cycles = [], []
    for _ in range(5):
        start = process_time()
        describe_step(model.array, bound(model.array))
        between = process_time()
        model.cycle(30)
        explained.append(between - start)
        cycles.append(process_time() - between)
    assert min(explained) < min(cycles)


def test_a_picture_names_the_domains_that_can_be_read() -> None:
    """Names take a picture's time. Those of the domains between small blocks covered each other."""
    for n, named in ((9, True), (900, False)):
        frame = Frame("deck")
        frame.add(snapshot(grid(n).h, domains=True), What(domains=True))
        axes = frame.figure().axes[0]
        inner = {str(domain.address) for domain in frame.states[0].domains if not domain.outer}
        shown = {text.get_text() for text in axes.texts} & inner
        assert bool(shown) == named
