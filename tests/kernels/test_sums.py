"""What is summed up over a whole run, and what follows from it: exact whatever the word scheme."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.heap.accessors import getr, iget
from udec_ia.kernels.body.boundary_conditions import _function, set_signals
from udec_ia.layout import offsets as g

EXACT = 1e-9
LATE = 12345 + 1 / 3  # s; no 32-bit real is nearer to it than 3e-4


def lone(build: str) -> Model:
    """One block of 1 m, and nothing else."""
    m = Model(build)
    m.property(1, density=1000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    return m


def signal(m: Model) -> int:
    return int(m.h.ci[g.ISGPNT])


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_the_time_of_a_million_cycles(build: str, tmp_path: Path) -> None:
    """And so the time at which a history is recorded, and TIME as a history."""
    m = lone(build)
    m.out = tmp_path
    m.fix(0, 1, 0, 1)
    (history,) = m.history(250_000, "TIME")
    m.cycle(1_000_000)
    exact = float(m.h.cr[g.TDEL]) * np.arange(0, 1_000_001, 250_000)
    assert history.numbers[:, 1] == pytest.approx(exact, rel=EXACT)
    assert np.array_equal(history.numbers[:, 1], history.numbers[:, 2])
    assert m.h.cd[g.TIME] == history.numbers[-1, 1]


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_a_work_that_is_always_the_same_is_summed_exactly(build: str) -> None:
    """A block falls at the speed at which mass damping holds it: every cycle takes the same energy."""
    m = lone(build)
    m.gravity(0, -10)
    m.damping(1.0, 2.0, "mass")
    m.energy("on")
    m.cycle(20_000)
    first = float(m.h.cd[g.WMASS])
    m.cycle(1)
    term = float(m.h.cd[g.WMASS]) - first
    assert term > 0
    m.cycle(50_000)
    assert float(m.h.cd[g.WMASS]) - first == pytest.approx(50_001 * term, rel=EXACT)


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_a_sine_that_begins_late_is_exact(build: str) -> None:
    m = lone(build)
    m.h.cd[g.TIME] = LATE
    m.boundary(0, 1, 0, 1, xvel=1.0, sine=(3.0, 100.0))
    m.cycle(2000)
    passed = (2000 - 0.5) * float(m.h.cr[g.TDEL])
    exact = m.h.cr.dtype.type(math.sin(2 * math.pi * 3.0 * passed))
    assert float(getr(m.h, signal(m), g.KTNOW)) == pytest.approx(exact, abs=1e-6)
    assert m.check() == []


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_a_function_is_exact_late(build: str) -> None:
    """A ramp of 2 s that begins at 12344 s, which 32-bit reals hold."""
    m = lone(build)
    m.h.cd[g.TIME] = LATE
    m.function(7, 12344, 0, 12346, 2)
    m.boundary(0, 1, 0, 1, xvel=1.0, function=7)
    m.cycle(100)
    exact = LATE - 12344 + 99.5 * float(m.h.cr[g.TDEL])
    assert float(getr(m.h, signal(m), g.KTNOW)) == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_signals_are_the_same_bits_compiled_and_interpreted(build: str) -> None:
    """Two sines of 32-bit reals differ in every tenth value or so; NumPy's of 64 bits may, too."""
    m = lone(build)
    m.boundary(0, 1, 0, 1, xvel=1.0, sine=(3.0, 1e9))
    m.function(1, 0, 0.1, 3000, 0.7, 9000, -2)
    m.boundary(0, 1, 0, 1, yvel=1.0, function=1)
    h = m.h
    signals = [signal(m), iget(h, signal(m), g.KT)]
    for t in np.random.default_rng(1).uniform(0, 1e4, 1000):
        h.cd[g.TIME] = t
        set_signals(h)
        compiled = [getr(h, isg, g.KTNOW) for isg in signals]
        getattr(set_signals, "__wrapped__", set_signals)(h)
        assert [getr(h, isg, g.KTNOW) for isg in signals] == compiled
        alone = getattr(_function, "__wrapped__", _function)(h, signals[0], float(t))
        assert alone == _function(h, signals[0], float(t))
