"""Copies of a model, by pickle, copy and multiprocessing: they continue bit for bit, and are independent."""

from __future__ import annotations

import copy
import multiprocessing
import pickle
from collections.abc import Callable
from pathlib import Path

import pytest
from support.every_group_kind import every_kind
from trials.interrupted_commands import SCENE, state

from udec_ia import Model, UdecError
from udec_ia.layout.offsets import IBPNT

LAW = """
def clj2(fn, fs, dun, dus, un, us, m):
    return m.kn * dun, 0.5 * m.ks * dus
"""


def pickled(model: Model) -> Model:
    other: Model = pickle.loads(pickle.dumps(model))
    return other


WAYS = {"pickle": pickled, "copy": copy.copy, "deepcopy": copy.deepcopy}


@pytest.fixture(params=WAYS)
def copied(request: pytest.FixtureRequest) -> Callable[[Model], Model]:
    return WAYS[request.param]


def test_a_model_that_was_not_started(copied: Callable[[Model], Model]) -> None:
    m = copied(Model("i16r32", mtop=3000, name="run"))
    assert (m.name, m.array.scheme.name, len(m.array.h.ia)) == ("run", "i16r32", 3000)
    assert m.block(0, 0, 0, 1, 1, 1, 1, 0) == 1


def test_a_copy_continues_bit_for_bit(copied: Callable[[Model], Model], tmp_path: Path) -> None:
    """Words, histories, results, deck, open picture and what is known of the run."""
    m = Model(out=tmp_path)
    m.run(SCENE)
    m.plot(0)
    m.cycle(20)
    m.solve(1e-9, 10)
    other = copied(m)
    assert state(other) == state(m)
    for one in (m, other):
        one.out = tmp_path / str(one is m)
        one.cycle(20)
        one.gravity(0, -9)
        one.cycle(5)
        one.plot(1)
        one.stop()
    before, after = state(m), state(other)
    del before["files"], after["files"]
    assert after == before
    assert m.deck() == other.deck()


def test_a_copy_is_independent(copied: Callable[[Model], Model], tmp_path: Path) -> None:
    m = every_kind()
    m.out = tmp_path
    m.cycle(5)
    before = state(m)
    other = copied(m)
    other.cycle(5)
    other.h.cr[3] = 0.25
    other.fix(-100, 100, -100, 100)
    other.name = "other"
    assert state(m) == before
    assert m.name == "udec"


def test_words_that_were_written_are_proved_by_the_copy(
    copied: Callable[[Model], Model], tmp_path: Path
) -> None:
    m = every_kind()
    m.out = tmp_path
    m.h.ci[IBPNT] = 10**6
    with pytest.raises(UdecError) as caught:
        copied(m).cycle(1)
    assert caught.value.number == 20


def test_laws_go_with_a_copy(copied: Callable[[Model], Model], tmp_path: Path) -> None:
    file = tmp_path / "law.py"
    file.write_text(LAW)
    m = Model(out=tmp_path, constitutive=file)
    m.run("START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0,0 0,2 2,2 2,0\nSPLIT -1 1 3 1\nROUND 0.05\n")
    m.run("FIX 0 2 0 1\nGRAVITY 0 -10\nCHANGE 0 2 0 2 CONS=2\n")
    m.cycle(5)
    other = copied(m)
    m.cycle(20)
    other.cycle(20)
    assert state(other) == state(m)


def test_a_file_of_laws_that_has_changed_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "law.py"
    file.write_text(LAW)
    data = pickle.dumps(Model(out=tmp_path, constitutive=file))
    file.write_text(LAW.replace("0.5", "0.6"))
    with pytest.raises(UdecError) as caught:
        pickle.loads(data)
    assert caught.value.number == 34


def cycled(model: Model) -> Model:
    """Run in another process."""
    model.cycle(20)
    return model


def test_a_model_runs_in_another_process(tmp_path: Path) -> None:
    m = every_kind()
    m.out = tmp_path
    m.cycle(5)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        (other,) = pool.map(cycled, [m])
    m.cycle(20)
    assert state(other) == state(m)
