"""Whatever ends a command, the model is as after it or as before it. Signals wait where they do harm."""

from __future__ import annotations

import io
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from interrupts import SCENE, interrupt_lines, state

from udec_ia import Model, UdecError
from udec_ia.deck.monitor import run_deck
from udec_ia.heap.array import MainArray
from udec_ia.heap.memory import room
from udec_ia.heap.words import scheme
from udec_ia.layout import offsets as g
from udec_ia.layout.offsets import JPHASE, KX, MCTOT, MTOP, NERR, NWANT, TDEL
from udec_ia.ops.run import cycle as running
from udec_ia.signals import Terminated, hold, passing, poll, terminate
from udec_ia.transaction import Undo

ROOT = Path(__file__).parents[2]


def blocks(out: Path | None = None, **named: object) -> Model:
    """A square cut in four on a fixed base."""
    m = Model(out=out or ".", **named)  # type: ignore[arg-type]
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.gravity(0, -10)
    m.block(0, 0, 0, 3, 4, 3, 4, 0)
    m.split(-1, 1, 5, 1)
    m.split(2, 0.5, 2, 4)
    m.round(0.1)
    m.fix(0, 4, 0, 1)
    return m


# ---- every command, at any line of Python


def test_what_ends_a_command_at_any_line_leaves_it_whole_or_undone() -> None:
    assert interrupt_lines(40, seed=3, seconds=120) == []


@pytest.mark.parametrize("repeated", [0.0, 1e9])
def test_a_command_is_taken_back_also_by_repeating_others(
    repeated: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After an array has grown, too, and with a copy that is many commands old."""
    monkeypatch.setattr("udec_ia.transaction.REPEATED", repeated)
    m = Model()
    m.block(0, 0, 0, 30, 40, 30, 40, 0)
    for x in range(1, 40):
        m.split(x, -1, x, 31)
    assert len(m.undo.since) == (0 if repeated == 0 else 39)
    before, size = state(m), len(m.array.h.ia)

    def fail(*_: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("udec_ia.session.log.warning", fail)

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
    m = blocks(tmp_path)
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
    m = blocks()
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
        "from interrupts import state\n"
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


def test_no_memory_left_is_an_error_of_the_deck(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none_left(*_: object) -> None:
        raise MemoryError

    m, out = Model(out=tmp_path), io.StringIO()
    monkeypatch.setattr("udec_ia.ops.commands.function._make_signal", none_left)
    with pytest.raises(UdecError) as caught:
        run_deck(m, "START\nBLOCK 0 0 0 1 1 1 1 0\nFUNCTION 1 0 0 1 1\n", out)
    assert (caught.value.number, caught.value.line, m.deck_log[1:]) == (1, 3, ["BLOCK 0 0 0 1 1 1 1 0"])
    assert Model.check_file(caught.value.saved or "") == []


# ---- signals


def interrupt() -> None:
    """Ctrl-C."""
    os.kill(os.getpid(), signal.SIGINT)


def test_a_signal_waits_for_the_end_of_a_hold_and_a_second_one_does_not() -> None:
    former, done = signal.getsignal(signal.SIGINT), []
    with pytest.raises(KeyboardInterrupt), hold():  # noqa: PT012
        interrupt()
        with hold():
            done.append("still held")
    assert done == ["still held"]
    assert signal.getsignal(signal.SIGINT) is former
    with pytest.raises(KeyboardInterrupt), hold():  # noqa: PT012
        interrupt()
        interrupt()
        done.append("never")
    with pytest.raises(KeyboardInterrupt), hold(firm=True):  # noqa: PT012
        interrupt()
        interrupt()
        done.append("firm")
    assert done == ["still held", "firm"]
    poll()  # nothing is left


def test_a_signal_comes_at_once_where_it_is_let_through() -> None:
    for let_through in (poll, lambda: passing().__enter__()):
        done = False
        with pytest.raises(KeyboardInterrupt), hold():  # noqa: PT012
            interrupt()
            let_through()  # type: ignore[operator]
            done = True
        assert not done
    with hold(), pytest.raises(KeyboardInterrupt), passing():  # noqa: PT012
        interrupt()
        poll()


def test_an_interrupt_that_is_swallowed_comes_again() -> None:
    """Python ignores what is raised in a `__del__`; what was let through there is not lost."""

    class Swallows:
        def __del__(self) -> None:
            with suppress(KeyboardInterrupt):
                interrupt()
                poll()

    done = []
    with pytest.raises(KeyboardInterrupt), hold():  # noqa: PT012
        with passing():
            Swallows()
            done.append("went on")
        done.append("to the end of the hold")
    assert done == ["went on", "to the end of the hold"]
    poll()


def test_an_interrupt_that_a_library_turns_into_an_error_of_its_own_is_one() -> None:
    """As class bodies do with __set_name__, and C++ that converts arguments: it does not say by what."""

    def library() -> None:
        with suppress(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)
        raise ValueError("invalid bounding box")

    with pytest.raises(KeyboardInterrupt) as caught, hold(), passing():
        library()
    assert isinstance(caught.value.__cause__, ValueError)
    with pytest.raises(ValueError, match="of its own"), hold(), passing():
        raise ValueError("of its own")


@pytest.mark.parametrize("error", [None, ValueError("told")])
def test_that_an_interrupt_was_lost_on_the_way_is_not_told(
    error: Exception | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What else is lost where Python cleans up is told as it was before."""
    told: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", told.append)

    class Loses:
        def __del__(self) -> None:
            if error is not None:
                raise error
            interrupt()
            poll()

    done = []
    with suppress(KeyboardInterrupt), hold():
        with passing():
            Loses()
            done.append("went on")
        done.append("to the end of the hold")
    assert done == ["went on", "to the end of the hold"]
    assert len(told) == (error is not None)
    assert sys.unraisablehook == told.append


def test_a_signal_within_the_first_lines_of_a_hold_leaves_the_next_one_sound(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It leaves what tells of lost exceptions in place, which is not put in place once more then."""
    told: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", told.append)

    class Loses:
        def __del__(self) -> None:
            raise ValueError

    with hold():
        left = sys.unraisablehook
    sys.unraisablehook = left
    with hold():
        Loses()
    assert len(told) == 1
    assert sys.unraisablehook == told.append


def test_other_threads_hold_nothing() -> None:
    found = []

    def run() -> None:
        with hold(), passing():
            found.append(blocks().cycle(1))

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert found == [1]


@pytest.mark.parametrize("line", ["SPLIT 2.5 0.5 2.5 4", "SAVE", "GENERATE 0 2 1 3 AUTO EDGE 1"])
def test_ctrl_c_in_a_short_command_ends_the_run_after_it(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocks(tmp_path).run(line)  # where a command has to wait for the compiler, Ctrl-C ends it at once
    m, make = blocks(tmp_path), Undo.keep

    def keep(self: Undo, array: MainArray) -> None:
        interrupt()
        make(self, array)

    monkeypatch.setattr(Undo, "keep", keep)
    if line == "SAVE":
        monkeypatch.setattr("udec_ia.restart.writer._now", lambda: interrupt() or "2000-01-01T00:00:00Z")
    with pytest.raises(KeyboardInterrupt, match=r"rescue\.h5") as caught:
        run_deck(m, f"{line}\nCYCLE 10\n", io.StringIO())
    monkeypatch.undo()
    assert m.deck_log[-1] == line
    other = Model.restore(str(caught.value))
    assert other.deck_log == m.deck_log
    assert state(other)["words"] == state(m)["words"]
    assert m.array.h.ci[MCTOT] == 0


def test_ctrl_c_stops_a_run_between_two_pieces(tmp_path: Path) -> None:
    m = blocks(tmp_path)
    m.history(10, "unbalanced")
    m.progress = stream = io.StringIO()
    stream.write = lambda _: interrupt()  # type: ignore[method-assign,assignment,return-value]
    with pytest.raises(KeyboardInterrupt):
        m.cycle(10**7)
    assert 0 < m.h.ci[MCTOT] < 10**7
    assert m.check() == []
    assert m.histories()[0].last_cycle == m.h.ci[MCTOT] // 10 * 10


@pytest.mark.parametrize(
    ("number", "status", "times"),
    [(signal.SIGTERM, 143, 30), (signal.SIGINT, 130, 1), (signal.SIGINT, 130, 30)],
)
def test_a_run_that_signals_end_is_saved_however_many_there_are(
    tmp_path: Path, number: int, status: int, times: int
) -> None:
    deck = f"{SCENE}\nCYCLE 1\nPRINT ENERGY\nPLOT\nCYCLE 9999999\n"
    command = [sys.executable, "-m", "udec_ia", "run", "--out", str(tmp_path)]
    pipe, env = subprocess.PIPE, {**os.environ, "PYTHONPATH": str(ROOT)}
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe, text=True, env=env) as run:
        assert run.stdin is not None
        assert run.stdout is not None
        run.stdin.write(deck)
        run.stdin.close()
        assert any("> CYCLE 9999999" in line for line in iter(run.stdout.readline, ""))
        for _ in range(times):
            run.send_signal(number)
            time.sleep(0.003)
        run.stdout.read()
        err = run.stderr.read().splitlines() if run.stderr else []
    said = [line for line in err if line and not line.startswith("compiling")]
    told = f"interrupted: the results so far are saved in {tmp_path}/rescue.h5"
    unproved = "interrupted"  # it says on standard output that the file was not proved
    assert (run.returncode, said) in [(status, [told])] + [(status, [unproved])] * (times > 1)
    assert Model.check_file(tmp_path / "rescue.h5") == []


def test_ctrl_c_while_the_program_is_loaded_ends_it_quietly() -> None:
    code = (
        "import sys\n"
        "class Slow:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name in ('numpy', 'numba', 'h5py', 'matplotlib'): raise KeyboardInterrupt\n"
        "sys.meta_path.insert(0, Slow())\n"
        "from udec_ia.cli import main\n"
        "sys.exit(main(['run', 'deck.dat']))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=False)
    assert (done.returncode, done.stderr) == (130, "\ninterrupted\n")


def test_sigterm_ends_a_conversation_too(tmp_path: Path) -> None:
    from udec_ia.deck.interactive import converse

    m, lines = Model(out=tmp_path), iter(["START", "BLOCK 0 0 0 1 1 1 1 0", ""])

    def ask(_: str) -> str:
        line = next(lines, None)
        return line if line is not None else terminate(signal.SIGTERM, None) or ""  # type: ignore[func-returns-value]

    with pytest.raises(Terminated, match=r"rescue\.h5"):
        converse(m, io.StringIO(), ask)
    assert len(Model.restore(tmp_path / "rescue.h5").table("block")) == 1


def test_a_rescue_file_that_cannot_be_read_again_is_not_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_: object) -> None:
        raise UdecError(29, "is damaged")

    monkeypatch.setattr(Model, "check_file", staticmethod(refuse))
    out = io.StringIO()
    with pytest.raises(UdecError) as caught:
        run_deck(Model(out=tmp_path), "START\nBLOK\n", out)
    assert caught.value.saved is None
    assert "the state could not be saved: error 29: " in out.getvalue()


# ---- writing to the array


@pytest.mark.parametrize(
    "write",
    [
        lambda m: m.h.ia.__setitem__(slice(0, 40), 7),
        lambda m: np.add.at(m.h.ia, [4, 5, 6, 7], 1000),
        lambda m: m.h.ci.__setitem__(MTOP, 10**9),
        lambda m: m.h.ci.__setitem__(JPHASE, 9),
        lambda m: m.h.ra[2:60:3].__setitem__(Ellipsis, np.nan),
    ],
)
def test_words_that_were_damaged_in_python_are_found_before_they_are_followed(
    write: Callable[[Model], None],
) -> None:
    m = blocks()
    m.cycle(5)
    kept = m.array.h.ia.copy(), m.array.h.ci.copy()
    held = m.h
    write(m)
    for follow in (
        lambda: m.cycle(1),
        lambda: m.split(-1, 2, 5, 2),
        lambda: m.save("never.h5"),
        lambda: m.property(1, density=1.0),
        lambda: m.print("energy"),
    ):
        with pytest.raises(UdecError) as caught:
            follow()
        assert caught.value.number == 20
    held.ia[:], held.ci[:] = kept
    assert m.cycle(1) == 1
    assert not Path("never.h5").exists()


def test_what_is_written_soundly_stays_and_reading_costs_no_proof(monkeypatch: pytest.MonkeyPatch) -> None:
    m = blocks()
    m.cycle(5)
    proofs = []
    monkeypatch.setattr(Model, "_prove", lambda self: proofs.append(1) or setattr(self, "_touched", False))
    for _ in range(3):
        m.cycle(int(1 + 0 * m.h.cr[TDEL] + m.h.ia[:5].sum() * 0))
    assert proofs == []
    m.h.cr[TDEL] *= 2
    m.h.ra[int(m.table("block")["address"][0]) // 2 + KX[1]] += 0.0
    m.cycle(1)
    assert proofs == [1]


def test_other_ways_to_write_are_refused() -> None:
    h = blocks().h
    for write in (lambda: h.ia.fill(0), lambda: np.copyto(h.cr, 1.0), lambda: np.asarray(h.ci).sort()):
        with pytest.raises(ValueError, match="read-only"):
            write()
    own = h.ia.copy()
    own[:] = 0
    assert h.ia.any()


# ---- two errors in one cycle


def test_a_wish_for_memory_does_not_hide_an_error() -> None:
    array = MainArray(scheme("i32r64"))
    array.h.ci[NERR] = 15
    assert not room(array.h, len(array.h.ia) + 1)
    assert (int(array.h.ci[NERR]), int(array.h.ci[NWANT])) == (15, len(array.h.ia) + 1)
    assert array.grow()
    assert (int(array.h.ci[NERR]), int(array.h.ci[NWANT])) == (15, 0)


@pytest.mark.parametrize("mtop", [None, 3000])
def test_an_error_of_a_cycle_that_runs_out_of_memory_is_raised(
    mtop: int | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After the cycle was completed with more memory, or at once if there is none."""
    m = blocks(mtop=mtop)
    m.cycle(3)
    run, calls = running.run_unwatched, []

    def run_short(h: object, n: int, *given: object) -> int:
        calls.append(n)
        if len(calls) > 1:
            return run(h, n, *given)  # type: ignore[arg-type]
        m.array.h.ci[NERR], m.array.h.ci[JPHASE] = 15, 3
        room(m.array.h, len(m.array.h.ia) + 1)
        return 0

    monkeypatch.setattr(running, "run_unwatched", run_short)
    with pytest.raises(UdecError) as caught:
        m.cycle(5)
    assert caught.value.number == 15
    assert len(calls) == (2 if mtop is None else 1)
    assert int(m.h.ci[MCTOT]) == (4 if mtop is None else 3)


# ---- several commands obeyed as one


def words(m: Model) -> tuple[object, ...]:
    return state(m)["words"], state(m)["integers"], state(m)["reals"]


def test_commands_before_one_that_is_refused_are_taken_back() -> None:
    m = blocks()
    m.free(0, 4, 0, 1)
    before = words(m)
    with pytest.raises(UdecError) as caught:
        m.whole(lambda: (m.fix(0, 4, 0, 1), m.block(0, 0, 0, 0)))
    assert caught.value.number == 18
    assert words(m) == before


def test_commands_after_a_run_are_taken_back_to_its_end(tmp_path: Path) -> None:
    m, twin = blocks(tmp_path), blocks(tmp_path)
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
    m, twin = blocks(), blocks()

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


def test_what_is_written_among_commands_is_proved_before_it_is_followed() -> None:
    m = blocks()
    place = int(m.table("corner")["address"][0]) - 1 + g.KL[1]

    def action() -> None:
        m.h.ia[place] = 10**8
        m.round(0.1)

    with pytest.raises(UdecError) as caught:
        m.whole(action)
    assert caught.value.number == 20
    with pytest.raises(UdecError) as caught:
        m.why_none("split", 0, 0, 1, 1)
    assert caught.value.number == 20


def test_many_commands_that_change_numbers_only_leave_no_long_list() -> None:
    m = blocks()
    m.undo.cost = 0.0
    for n in range(50):
        m.gravity(0, -n)
    assert len(m.undo.since) < 3


def test_a_run_that_is_ended_by_system_exit_leaves_a_rescue_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = blocks(tmp_path)

    def leave(*_: object) -> None:
        raise SystemExit

    monkeypatch.setattr("udec_ia.ops.commands.settings.set_gravity", leave)
    with pytest.raises(SystemExit) as caught:
        m.run("CYCLE 5\nGRAVITY 0 -5\n")
    (note,) = caught.value.__notes__
    assert note == f"the results so far are saved in {tmp_path / 'rescue.h5'}"
    assert Model.restore(tmp_path / "rescue.h5").h.ci[MCTOT] == 5


def test_a_handler_that_raises_is_called_once_for_a_signal() -> None:
    calls = []

    def leave(number: int, frame: object) -> None:
        calls.append(number)
        raise SystemExit

    former = signal.signal(signal.SIGTERM, leave)
    try:
        with pytest.raises(SystemExit), hold(), passing():
            os.kill(os.getpid(), signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, former)
    assert calls == [signal.SIGTERM]


def test_no_memory_left_in_a_run_does_not_say_that_nothing_was_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = blocks(tmp_path)

    def none_left(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr("udec_ia.ops.run.cycle.run_unwatched", none_left)
    with pytest.raises(UdecError, match="the results so far are kept") as caught:
        m.run("CYCLE 5\n")
    assert caught.value.number == 1


def test_ctrl_c_stops_an_animated_run_as_soon(tmp_path: Path) -> None:
    m = blocks(tmp_path)
    m.animate = True
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    former = signal.signal(signal.SIGALRM, lambda *_: os.kill(os.getpid(), signal.SIGINT))
    start = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            m.cycle(10**8)
    finally:
        signal.signal(signal.SIGALRM, former)
    assert time.monotonic() - start < 10
    assert m.check() == []


def test_numbers_that_were_changed_before_words_are_taken_back_with_them() -> None:
    m = blocks()
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
    m, other = blocks(), Model()
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


@pytest.mark.parametrize("k", range(11))
def test_an_interrupt_while_a_command_is_noted(k: int, tmp_path: Path) -> None:
    """At line `k` of that: the command is taken back with its line of the log, or stays with it."""
    m, twin = blocks(tmp_path), blocks(tmp_path)
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
