"""What a notebook shows of a model: nothing changes, nothing raises, and what is missing CYCLE refuses."""

from __future__ import annotations

import base64
import copy
import html
import re
from collections.abc import Callable
from math import isqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g

ALL = (-1.0, 1e6, -1.0, 1e6)


def wall(n: int, **properties: float) -> Model:
    """n blocks in a square; the lowest ones are fixed."""
    m = Model(name="a <wall>")
    m.property(1, **properties)
    side = isqrt(n)
    m.block(0, 0, 0, side, side, side, side, 0)
    for k in range(1, side):
        m.split(-1, k, side + 1, k)
    for k in range(1, side):
        m.split(k, -1, k, side + 1)
    m.fix(*ALL[:2], 0, 1)
    return m


def state(m: Model) -> tuple[Any, ...]:
    """Words, common block, and what the session holds, but for the undo copy."""
    own = {name: value for name, value in vars(m.session).items() if name not in ("_tracked",)}
    h = m.session.array.h
    return h.ia.tobytes(), h.ci.tobytes(), h.cr.tobytes(), h.cd.tobytes(), own, list(m.session.log.lines)


MADE: dict[str, Callable[[], Model]] = {
    "nothing": Model,
    "wall": lambda: wall(9),
    "all kinds": every_kind,
    "cycled": every_kind,
}


@pytest.mark.parametrize("made", MADE)
def test_showing_changes_nothing(made: str, tmp_path: Path) -> None:
    m = MADE[made]()
    m.out = tmp_path
    if made == "cycled":
        m.cycle(5)
    before = copy.deepcopy(state(m)[:4]), state(m)[4:]
    line, page = repr(m), m._repr_html_()
    assert (state(m)[:4], state(m)[4:]) == before
    assert "\n" not in line
    assert html.escape(line) in page
    assert "not shown" not in page


def test_a_damaged_model_is_shown_as_far_as_it_can_be() -> None:
    """Words written at random, with every kind of group, behind the back of the program; the words stay."""
    rng = np.random.default_rng(1)
    sound = every_kind()
    for _ in range(40):
        m = copy.copy(sound)
        h = m.array.h
        places = rng.integers(0, int(h.ci[g.MFREE]) - 1, 60)
        for place in places.tolist():
            h.ia[place] = int(rng.integers(-5, 2000))
        h.ci[int(rng.integers(0, len(h.ci)))] = int(rng.integers(0, 60))
        words = h.ia.tobytes()
        page = m._repr_html_()
        assert "the array is damaged" in page or "not shown" in page
        assert h.ia.tobytes() == words
        assert repr(m).startswith("<Model")


LACKS: dict[str, tuple[int, dict[str, float], str]] = {
    "density": (12, {"kn": 1e8, "ks": 1e8}, "property(1, density=...)"),
    "stiffness": (11, {"density": 2000.0}, "property(1, kn=..., ks=...)"),
    "shear stiffness": (11, {"density": 2000.0, "kn": 1e8}, "property(1, ks=...)"),
    "nothing": (0, {"density": 2000.0, "kn": 1e8, "ks": 1e8}, ""),
    "stiffness by moduli": (0, {"density": 2000.0, "bulk": 1e8, "g": 1e8}, ""),
}


@pytest.mark.parametrize("lack", LACKS)
def test_what_is_missing_is_what_cycle_refuses(lack: str, tmp_path: Path) -> None:
    number, properties, advice = LACKS[lack]
    m = wall(4, **properties)
    m.gravity(0, -10)
    page = m._repr_html_()
    assert advice in page
    assert ("Before it can run" in page) is bool(number)
    try:
        m.cycle(1)
        found = 0
    except UdecError as error:
        found = error.number
    assert found == number


def test_what_joints_lack() -> None:
    """Numbered joints have no stiffness of their own; a joint material has one, or a law that may lack."""
    m = Model()
    m.property(1, density=2000)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1, joint=1)
    stiff = {"kn": 1e8, "ks": 1e8}
    for number, advice, model in (
        (11, "property(1, kn=..., ks=...)", "jl2"),
        (9, "joint material 1 has model JL2", "coulomb"),
    ):
        assert advice in m._repr_html_()
        with pytest.raises(UdecError) as caught:
            m.cycle(1)
        assert caught.value.number == number
        m.jproperty(1, model=model, between=(1, 1), **stiff)
    assert "Before it can run" not in m._repr_html_()
    assert m.cycle(1) == 1


def test_what_deformable_blocks_lack() -> None:
    m = wall(4, density=2000, kn=1e8, ks=1e8)
    assert "there is no block" in Model()._repr_html_()
    m.change(0, 2, 1, 2, type="fdef")
    for advice, provide in (
        ("property(1, bulk=..., g=...)", lambda: m.property(1, bulk=1e8, g=1e8)),
        ("generate(", lambda: m.generate(*ALL, edge=1.0)),
    ):
        assert advice in m._repr_html_()
        with pytest.raises(UdecError, match="error 26"):
            m.cycle(1)
        provide()
        assert advice not in m._repr_html_()
    assert "nothing loads the blocks" in m._repr_html_()
    m.gravity(0, -10)
    assert m.cycle(1) == 1
    page = m._repr_html_()
    assert "nothing loads the blocks" not in page
    assert "there is no damping" in page
    assert re.search(r"largest unbalanced force.*\d N/m", page)


def test_the_picture_is_small_however_many_blocks() -> None:
    sizes = []
    for n in (4, 2500):
        page = wall(n)._repr_html_()
        found = re.search(r'base64,([^"]*)"', page)
        assert found
        assert base64.b64decode(found[1]).startswith(b"\x89PNG")
        sizes.append(len(page))
    assert max(sizes) < 60_000
