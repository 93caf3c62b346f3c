"""Whatever ends a command, the model is as after it or as before it.

The same holds for several commands that are obeyed as one.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from support.mechanics_scenes import side_by_side
from trials.interrupted_commands import interrupt_lines, state

from udec_ia import Model, UdecError
from udec_ia.model.undo import Undo

ROOT = Path(__file__).parents[2]


def test_what_ends_a_command_at_any_line_leaves_it_whole_or_undone() -> None:
    assert interrupt_lines(40, seed=3, seconds=120) == []


@pytest.mark.parametrize("repeated", [0.0, 1e9])
def test_a_command_is_taken_back_also_by_repeating_others(
    repeated: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After an array has grown, too, and with a copy that is many commands old."""
    monkeypatch.setattr("udec_ia.model.undo.REPEATED", repeated)
    m = Model()
    m.block(0, 0, 0, 30, 40, 30, 40, 0)
    for x in range(1, 40):
        m.split(x, -1, x, 31)
    assert len(m.session.undo.steps) == (0 if repeated == 0 else 39)
    before, size = state(m), len(m.array.h.ia)

    def fail(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("udec_ia.model.model_session.log.warning", fail)

    def split_and_fail() -> None:
        for y in range(1, 30):
            m.split(-1, y, 41, y)
        assert len(m.array.h.ia) > size
        fail()

    with pytest.raises(ZeroDivisionError):
        m.whole(split_and_fail)
    assert state(m) == before
    assert m.check() == []
    assert m.split(-1, 5, 41, 5) == 40


def test_an_error_in_a_function_of_the_users_takes_the_command_back(tmp_path: Path) -> None:
    m = side_by_side(tmp_path)
    m.boundary(0, 4, 1, 3, xforce=1.0)
    before = state(m)

    def tell(_: str) -> None:
        raise ZeroDivisionError

    m.tell = tell
    with pytest.raises(ZeroDivisionError):
        m.change(0, 4, 1, 3, type="fdef")  # tells that boundary conditions are lost
    assert state(m) == before
    assert len(m.table("bound")) == 2


def test_a_command_within_a_command_is_taken_back_with_it() -> None:
    """A function that is told something gives commands of its own."""
    m = side_by_side()
    m.boundary(0, 4, 1, 3, xforce=1.0)
    before = state(m)

    def tell(_: str) -> None:
        m.fix(0, 4, 0, 3)
        raise ZeroDivisionError

    m.tell = tell
    with pytest.raises(ZeroDivisionError):
        m.change(0, 4, 1, 3, type="fdef")
    assert state(m) == before
    m.tell = lambda _: m.free(0, 4, 0, 3)  # type: ignore[assignment,return-value]
    m.change(0, 4, 1, 3, type="fdef")
    after = state(m)
    with pytest.raises(ZeroDivisionError):
        m.whole(lambda: (m.fix(0, 4, 0, 3), 1 / 0))
    assert state(m) == after


def test_a_run_ends_between_two_cycles_with_an_interpreted_law(tmp_path: Path) -> None:
    """An interrupt comes in the midst of a cycle, which is taken back."""
    code = (
        "from trials.interrupted_commands import state\n"
        "from udec_ia import Model\n"
        "class Law:\n"
        "    calls = 0\n"
        "law = Law()\n"
        "def clj2(fn, fs, dun, dus, un, us, m):\n"
        "    law.calls += 1\n"
        "    if law.calls == FAILS: raise KeyboardInterrupt\n"
        "    return m.kn * dun, m.ks * dus\n"
        "def model():\n"
        "    m = Model(constitutive={'clj2': clj2})\n"
        "    m.property(1, density=2000, kn=1e8, ks=1e8); m.gravity(0, -10); m.energy()\n"
        "    m.block(0, 0, 0, 3, 4, 3, 4, 0, constitutive=2); m.split(-1, 1, 5, 1); m.round(0.1)\n"
        "    m.fix(0, 4, 0, 1); m.history(1, 'unbalanced')\n"
        "    return m\n"
        "FAILS = 63\n"
        "m = model()\n"
        "try: m.cycle(1000)\n"
        "except KeyboardInterrupt: print('failed')\n"
        "FAILS = 0\n"
        "twin = model(); twin.cycle(int(m.h.ci[MCTOT]))\n"
        "m.array.h.ci[NCYC] = twin.array.h.ci[NCYC]\n"
        "print(m.check(), 0 < m.h.ci[MCTOT] < 63, state(m)['words'] == state(twin)['words'],\n"
        "      state(m)['integers'] == state(twin)['integers'], state(m)['reals'] == state(twin)['reals'],\n"
        "      state(m)['series'] == state(twin)['series'])\n"
    )
    code = "from udec_ia.layout.offsets import MCTOT, NCYC\n" + code
    path = os.pathsep.join(map(str, (ROOT, ROOT / "tools")))
    env = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": path}
    command = [sys.executable, "-W", "ignore", "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, env=env, cwd=tmp_path, check=False)
    assert done.stdout + done.stderr == "failed\n[] True True True True True\n"


@pytest.mark.parametrize("k", range(11))
def test_an_interrupt_while_a_command_is_noted(k: int, tmp_path: Path) -> None:
    """At line `k` of that: the command is taken back with its line of the log, or stays with it."""
    m, twin = side_by_side(tmp_path), side_by_side(tmp_path)
    for one in (m, twin):
        one.fix(-9, 9, -9, 9)
    before, left = state(m), k

    def trace(frame: FrameType, event: str, arg: object) -> Any:
        nonlocal left
        if frame.f_code is not Undo._end.__code__:
            return trace if event == "call" else None
        if event == "line":
            left -= 1
            if left < 0:
                sys.settrace(None)
                raise KeyboardInterrupt
        return trace

    old = sys.gettrace()
    sys.settrace(trace)
    try:
        m.free(-9, 9, -9, 9)
    except KeyboardInterrupt:
        left = -1
    finally:
        sys.settrace(old)
    twin.free(-9, 9, -9, 9)
    assert state(m) in ([before, state(twin)] if left < 0 else [state(twin)])
    for one in (m, twin):  # and what follows is taken back as far as to there
        one.free(-9, 9, -9, 9)
    with pytest.raises(KeyError):
        m.whole(lambda: (m.fix(-9, 9, -9, 9), {}["nothing"]))
    assert state(m)["words"] == state(twin)["words"]


# ---- several commands obeyed as one


def words(m: Model) -> tuple[object, ...]:
    return state(m)["words"], state(m)["integers"], state(m)["reals"]


def test_commands_before_one_that_is_refused_are_taken_back() -> None:
    m = side_by_side()
    m.free(0, 4, 0, 1)
    before = words(m)
    with pytest.raises(UdecError) as caught:
        m.whole(lambda: (m.fix(0, 4, 0, 1), m.block(0, 0, 0, 0)))
    assert caught.value.number == 5
    assert words(m) == before


def test_commands_after_a_run_are_taken_back_to_its_end(tmp_path: Path) -> None:
    m, twin = side_by_side(tmp_path), side_by_side(tmp_path)
    twin.cycle(5)

    def action() -> None:
        m.cycle(5)
        m.change(0, 4, 1, 4, type="sdef")
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        m.whole(action)
    assert m.check() == []
    assert words(m) == words(twin)


def test_split_finds_the_blocks_that_were_taken_back() -> None:
    """It keeps the boxes of all blocks, also of those that came and went in between."""
    m, twin = side_by_side(), side_by_side()

    def action() -> None:
        m.delete(0, 2, 1, 3)
        m.split(3, 0.5, 3, 4)
        raise ZeroDivisionError

    for one in (m, twin):
        one.cycle(0)
    with pytest.raises(ZeroDivisionError):
        m.whole(action)
    assert m.split(1, 0.5, 1, 4) == twin.split(1, 0.5, 1, 4) == 1
    assert words(m) == words(twin)


def test_many_commands_that_change_numbers_only_leave_no_long_list() -> None:
    m = side_by_side()
    m.session.undo.copy_seconds = 0.0
    for n in range(50):
        m.gravity(0, -n)
    assert len(m.session.undo.steps) < 3


def test_numbers_that_were_changed_before_words_are_taken_back_with_them() -> None:
    m = side_by_side()
    before = words(m)

    def action() -> None:
        m.energy("on")
        m.gravity(1, 2)
        m.split(-1, 2, 5, 2.1)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        m.whole(action)
    assert words(m) == before
    assert m.split(-1, 2, 5, 2.1) == 2


def test_a_restart_and_what_follows_it_are_taken_back(tmp_path: Path) -> None:
    m, other = side_by_side(), Model()
    other.block(0, 0, 0, 1, 1, 1, 1, 0)
    path, before = other.save(tmp_path / "other.h5"), words(m)

    def action() -> None:
        m.restart(path)
        m.split(-1, 0.4, 2, 0.5)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        m.whole(action)
    assert words(m) == before
    assert m.check() == []


def test_a_refused_command_gives_relaxations_back() -> None:
    """They are lost before GENERATE finds no block; their words are on the junk list in between."""
    m = Model()
    m.tell = lambda _: None
    m.block(0, 0, 0, 10, 14, 10, 14, 0)
    m.property(1, density=2500, kn=1e9, ks=1e9, friction=0.5)
    m.split(-1, 5, 15, 5.5)
    m.split(7, -1, 7.2, 11)
    m.gravity(0, -9.81)
    m.fix(-1, 15, 0, 5)
    m.fraction(0.5, safe=True, scaled=True)
    m.cycle(48)
    m.delete(8, 14, 5, 10)
    m.cycle(7)
    with pytest.raises(UdecError):
        m.generate(30, 31, 30, 31, mode="automatic", edge=2)
    assert m.check() == []
