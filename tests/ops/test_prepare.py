"""Masses and time-step are found when a command has come, and only then: CYCLE 7 and 13 make CYCLE 20."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout.offsets import LREADY, MFREE, NCYC, TDEL
from udec_ia.model import Model

# A column under a load that shortens it by some per cent, so that the time-step of its blocks changes.
DECK = """START
PROPERTY MAT=1 DENSITY=2000 KN=1E9 KS=1E9 FRICTION=0.5 BULK=1E7 G=5E6
BLOCK 0 0 0 4 1 4 1 0
SPLIT -1 1 2 1
SPLIT -1 2 2 2
SPLIT -1 3 2 3
FIX 0 1 0 1
ROUND 0.02
GRAVITY 0 -10
DAMPING 0.1 5 MASS
CHANGE 0 1 1 2 SDEF
CHANGE 0 1 2 3 FDEF
GENERATE 0 1 2 3 AUTO EDGE 0.6
BOUNDARY 0 1 3.4 3.6 YFORCE -4E5
CYCLE 20
"""

Between = Callable[[Model, Path], Model]


def column(build: str) -> Model:
    model = Model(build)
    model.run(DECK)
    return model


def words(model: Model) -> bytes:
    """IA() and the common block, but for the number of cycles last asked for."""
    h = model.array.h
    numbers = h.ci.copy()
    numbers[NCYC] = 0
    return b"".join(part.tobytes() for part in (h.ia[: int(h.ci[MFREE]) - 1], numbers, h.cr, h.cd))


def nothing(model: Model, folder: Path) -> Model:
    return model


def look(model: Model, folder: Path) -> Model:
    model.print("blocks")
    model.scale(3)
    model.scale(0)
    assert not model.check()
    return model


def save_and_restore(model: Model, folder: Path) -> Model:
    return Model.restore(model.save(folder / "half"))


@pytest.mark.parametrize("between", [nothing, look, save_and_restore])
@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_cycles_in_two_pieces_are_those_in_one(build: str, between: Between, tmp_path: Path) -> None:
    """Bit for bit, blocks of all types straining meanwhile."""
    whole, parts = column(build), column(build)
    whole.cycle(200)
    parts.cycle(70)
    parts = between(parts, tmp_path)
    parts.cycle(130)
    assert words(parts) == words(whole)


def test_a_command_has_the_time_step_found_anew() -> None:
    """From the strained shapes of now; and a number that somebody changes does so, too."""
    model = column("i32r64")
    model.cycle(500)
    step = float(model.h.cr[TDEL])
    model.cycle(1)
    assert float(model.h.cr[TDEL]) == step
    model.gravity(0, -10)
    assert model.array.h.ci[LREADY] == 0
    model.cycle(1)
    anew = float(model.h.cr[TDEL])
    assert 0.9 * step < anew < step  # zones and blocks have become shorter
    model.property(1, kn=4e11, ks=4e11)
    model.cycle(1)
    assert float(model.h.cr[TDEL]) < 0.2 * anew
    step = float(model.h.cr[TDEL])
    model.h.cr[TDEL] *= 2
    model.cycle(1)
    assert float(model.h.cr[TDEL]) == pytest.approx(step, rel=1e-3)


def test_a_command_that_is_taken_back_changes_no_digit() -> None:
    """Neither do those before it, which are obeyed once more."""
    model, other = column("i32r64"), column("i32r64")
    for one in (model, other):
        one.gravity(0, -9)
    with pytest.raises(ValueError, match="none left"):
        model.whole(lambda: (model.property(1, kn=2e9), model.delete(0, 1, 3, 4), broken()))
    assert words(model) == words(other)
    for one in (model, other):
        one.cycle(10)
    assert words(model) == words(other)
    model.cycle(10)
    assert np.any(model.array.h.ia != other.array.h.ia)


def broken() -> None:
    raise ValueError("none left")
