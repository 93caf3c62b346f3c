"""The size of IA(): what is refused for want of words changes nothing, and nothing is refused too early.

The size belongs to the run and not to the state: a restart file goes on in an array of any size that holds
it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from support.mechanics_scenes import colliding

from udec_ia import Model, UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import AT_BLOCKS, JPHASE, MCTOT, MFREE, MTOP, NSPARE

CYCLES = 2000
SCENE = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=6E8
BLOCK 0,0 0,4 6,4 6,0
SPLIT -1 1 7 1
SPLIT -1 2 7 2
SPLIT 2 1 2 4
SPLIT 4 1 4 4
FIX 0 6 0 1
FUNCTION 1 0 0 0.1 5
BOUNDARY -1 4 1 5 XVEL=1 FUNCTION 1
"""
POINTS = [(1.0, 1.5), (0.0, 2.0), (0.0, 1.0), (2.0, 1.0), (2.0, 2.0)]
ZONES = [(1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]
COMMANDS: dict[str, Callable[[Model], object]] = {
    "split": lambda m: m.split(-1, 3.2, 7, 3.3),
    "change": lambda m: m.change(0, 6, 1, 4, "sdef"),
    "generate": lambda m: m.generate(0, 2, 1, 2, "manual", gridpoints=POINTS, zones=ZONES, mixed=True),
    "boundary": lambda m: m.boundary(0, 6, 0, 4, stress=(1e5, 0.0, 1e5)),
    "function": lambda m: m.function(2, 0, 0, 1, 1, 2, 0),
    "history": lambda m: m.history(1, "KX", at=[(1, 1.5), (3, 3), (5, 3)]),
    "round": lambda m: m.round(0.05),
}


def state_of(array: MainArray) -> list[bytes]:
    """The words below MFREE and the common blocks, but for what says how large the array is."""
    common = np.delete(array.h.ci, [MTOP, NSPARE])
    words = array.h.ia[: int(array.h.ci[MFREE]) - 1]
    return [part.tobytes() for part in (words, common, array.h.cr, array.h.cd)]


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
@pytest.mark.parametrize("command", COMMANDS)
def test_with_any_number_of_words_a_command_is_obeyed_or_changes_nothing(command: str, build: str) -> None:
    """With every number that an array can have; for SPLIT, which takes longest, and where a real is one
    word, with every fifth."""
    model = Model(build)
    model.run(SCENE)
    before = model.array.copy()
    COMMANDS[command](model)
    obeyed, refusals = state_of(model.array), set()
    ratio = before.scheme.ratio
    first, step = int(before.h.ci[MFREE]) - 1, ratio * (5 if command == "split" or ratio == 1 else 1)
    for words in range(first, len(before.h.ia), step):
        model = Model(build)
        model.start()
        model.session.array = before.copy()
        assert model.array.refit(words)
        try:
            COMMANDS[command](model)
        except UdecError as error:
            refusals.add(error.number)
            assert state_of(model.array) == state_of(before)
            assert model.check() == []
        else:
            break
    assert refusals <= {1}
    assert state_of(model.array) == obeyed
    assert model.check() == []


@pytest.mark.parametrize("build", ["i16r32", "i16r64"])
def test_an_array_that_grows_holds_as_much_as_a_fixed_one_of_the_greatest_size(build: str) -> None:
    def blocks_that_fit(mtop: int | None) -> int:
        model = Model(build, mtop)
        model.block(0, 0, 0, 50, 50, 50, 50, 0)
        lines = [line for n in range(1, 50) for line in ((-1, n, 51, n), (n, -1, n, 51))]
        with pytest.raises(UdecError) as caught:
            for _ in (model.split(*line) for line in lines):
                pass
        assert caught.value.number == 1
        assert model.check() == []
        return len(model.table("block"))

    assert blocks_that_fit(None) == blocks_that_fit(32767)


def test_what_was_computed_before_the_memory_ended_goes_on_without_mtop(tmp_path: Path) -> None:
    short = Model(mtop=1000, out=tmp_path)
    with pytest.raises(UdecError) as caught:
        short.run("START\nBLOCK 0 0 0 10 10 10 10 0\nSPLIT -1 5 11 5\nSPLIT 5 -1 5 11\nSPLIT 2 -1 2 11\n")
    assert caught.value.number == 1
    assert caught.value.saved is not None
    on = Model(out=tmp_path)
    on.run(f"RESTART {Path(caught.value.saved).name}\nSPLIT 5 -1 5 11\nSPLIT 2 -1 2 11\n")
    assert len(on.table("block")) == 6
    assert not on.array.fixed
    assert Model.restore(caught.value.saved).split(5, -1, 5, 11) == 2


def test_a_cycle_that_stops_half_way_leaves_a_sound_state(tmp_path: Path) -> None:
    """Blocks have moved and their contacts have not: that is no violation, and with memory it goes on."""

    whole = colliding(tmp_path)
    start, used = whole.save(), int(whole.h.ci[MFREE]) - 1
    whole.cycle(CYCLES)
    phases = set()
    for more in range(0, 400, 40):
        m = Model(mtop=used + more, out=tmp_path)
        m.restart(start)
        with pytest.raises(UdecError, match="error 1:"):
            m.cycle(CYCLES)
        phases.add(int(m.h.ci[JPHASE]))
        assert m.check() == []
        saved = m.save(tmp_path / "half.h5")
        assert Model.check_file(saved) == []
    assert phases - {AT_BLOCKS}
    on = Model.restore(saved)
    on.cycle(CYCLES - int(on.h.ci[MCTOT]))
    assert np.array_equal(on.table("block")["KX"], whole.table("block")["KX"])


def test_a_restart_file_takes_the_size_that_the_run_fixes(tmp_path: Path) -> None:
    model = Model(out=tmp_path)
    model.run(SCENE)
    used = int(model.h.ci[MFREE]) - 1
    model.save()
    fixed = Model(mtop=used + 2, out=tmp_path)
    fixed.restart()
    assert (fixed.array.fixed, int(fixed.h.ci[MTOP])) == (True, used + 2)
    for mtop in (used - 2, 1):
        small = Model(mtop=mtop, out=tmp_path)
        with pytest.raises(UdecError) as caught:
            small.restart()
        assert caught.value.number == 1
        assert f"{used} words are in use" in caught.value.detail
        assert not small.session.started


def test_start_goes_back_to_the_words_of_the_run(tmp_path: Path) -> None:
    Model("i16r32", out=tmp_path).run("START\nBLOCK 0 0 0 1 1 1 1 0\nSAVE\nSTOP\n")
    model = Model("i64r64", out=tmp_path)
    assert "i16r32, as saved; --build applies to START" in str(model.run("RESTART\n"))
    assert model.array.scheme.name == "i16r32"
    model.start()
    assert model.array.scheme.name == "i64r64"
    again = Model.restore(tmp_path / "restart.h5")
    again.start()
    assert again.array.scheme.name == "i16r32"
