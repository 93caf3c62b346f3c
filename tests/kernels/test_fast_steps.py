"""A cycle that stops, because the search for what has gone through is not compiled, goes on all the same."""

from __future__ import annotations

import pytest

from udec_ia import Model, UdecError
from udec_ia.compiling.non_inlined_calls import entry
from udec_ia.heap.accessors import putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.kernels.detect.passage_through_block import detect_passages
from udec_ia.kernels.drive import cycle as passes
from udec_ia.layout import offsets as g
from udec_ia.running import history_series

BUILDS = list(ALL_SCHEMES)


def thrown(build: str, steps: float) -> Model:
    """Two blocks on a fixed one; the upper one moves along it by so many ETOL a step."""
    m = Model(build=build)
    m.property(1, density=2000, kn=1e7, ks=1e7, friction=0.1)
    m.gravity(0, -10)
    m.block(0, 0, 0, 3, 8, 3, 8, 0)
    m.split(-1, 1, 9, 1)
    m.split(-1, 2, 9, 2)
    m.fix(0, 8, 0, 1)
    m.cycle(5)
    top = m.table("block")
    ib = int(top["address"][top["KY"] > 2][0])
    putr(m.h, ib, g.KXD, m.h.cr.dtype.type(steps * m.h.cr[g.ETOL] / m.h.cr[g.TDEL]))
    return m


def runs_of(monkeypatch: pytest.MonkeyPatch, found: bool) -> list[int]:
    """The values of JPHASE with which pieces of runs begin. found: whether all have the search at hand."""
    phases: list[int] = []
    find = passes.passes

    def told(h, *others):
        phases.append(int(h.ci[g.JPHASE]))
        these = list(find(h, *others))
        wanted = found or phases[-1] == g.AT_WAYS
        these[passes.TUNNELLING] = entry(detect_passages, h) if wanted else 0
        return tuple(these)

    monkeypatch.setattr(history_series, "passes", told)
    return phases


@pytest.mark.parametrize("build", BUILDS)
@pytest.mark.parametrize("steps", [0.2, 3.0])
def test_a_fast_step_stops_before_the_search_and_goes_on(
    build: str, steps: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A slow one does not."""
    words = []
    for found in (True, False):
        m = thrown(build, steps)
        phases = runs_of(monkeypatch, found)
        m.cycle(4)
        monkeypatch.undo()
        assert (g.AT_WAYS in phases) == (steps > 1 and not found)
        assert m.check() == []
        words.append((m.h.ia.tobytes(), m.h.ci.tobytes(), m.h.cr.tobytes(), m.h.cd.tobytes()))
    assert words[0] == words[1]


def test_an_error_of_a_fast_step_is_raised_when_its_cycle_is_complete() -> None:
    """The block has flown away (error 36) in the step that asks for the search."""
    m = thrown("i32r64", 1e25)
    with pytest.raises(UdecError, match="error 36"):
        m.cycle(3)
    assert (m.h.ci[g.JPHASE], m.h.ci[g.MCTOT]) == (g.AT_BLOCKS, 6)
