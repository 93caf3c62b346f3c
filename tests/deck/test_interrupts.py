"""Signals wait where they would do harm; a run that they end leaves the model sound, and saved."""

from __future__ import annotations

import io
import os
import pty
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from select import select

import pytest
from support.mechanics_scenes import side_by_side
from trials.interrupted_commands import SCENE, state

from udec_ia import Model, UdecError
from udec_ia.deck.command_monitor import run_deck
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import Terminated, allow_signals, dealt_with, defer_signals, poll, terminate
from udec_ia.layout.offsets import MCTOT
from udec_ia.model.undo import Undo

ROOT = Path(__file__).parents[2]


def interrupt() -> None:
    """Ctrl-C."""
    os.kill(os.getpid(), signal.SIGINT)


# ---- signals that wait


def test_a_signal_waits_for_the_end_of_a_hold_and_a_second_one_does_not() -> None:
    former, done = signal.getsignal(signal.SIGINT), []
    with pytest.raises(KeyboardInterrupt), defer_signals():  # noqa: PT012
        interrupt()
        with defer_signals():
            done.append("still held")
    assert done == ["still held"]
    assert signal.getsignal(signal.SIGINT) is former
    with pytest.raises(KeyboardInterrupt), defer_signals():  # noqa: PT012
        interrupt()
        interrupt()
        done.append("never")
    with pytest.raises(KeyboardInterrupt), defer_signals(also_second=True):  # noqa: PT012
        interrupt()
        interrupt()
        done.append("firm")
    assert done == ["still held", "firm"]
    poll()  # nothing is left


def test_a_signal_comes_at_once_where_it_is_let_through() -> None:
    for let_through in (poll, lambda: allow_signals().__enter__()):
        done = False
        with pytest.raises(KeyboardInterrupt), defer_signals():  # noqa: PT012
            interrupt()
            let_through()  # type: ignore[operator]
            done = True
        assert not done
    with defer_signals(), pytest.raises(KeyboardInterrupt), allow_signals():  # noqa: PT012
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
    with pytest.raises(KeyboardInterrupt), defer_signals():  # noqa: PT012
        with allow_signals():
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

    with pytest.raises(KeyboardInterrupt) as caught, defer_signals(), allow_signals():
        library()
    assert isinstance(caught.value.__cause__, ValueError)
    with pytest.raises(ValueError, match="of its own"), defer_signals(), allow_signals():
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
    with suppress(KeyboardInterrupt), defer_signals():
        with allow_signals():
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

    with defer_signals():
        left = sys.unraisablehook
    sys.unraisablehook = left
    with defer_signals():
        Loses()
    assert len(told) == 1
    assert sys.unraisablehook == told.append


def test_a_handler_that_raises_is_called_once_for_a_signal() -> None:
    calls = []

    def leave(number: int, frame: object) -> None:
        calls.append(number)
        raise SystemExit

    former = signal.signal(signal.SIGTERM, leave)
    try:
        with pytest.raises(SystemExit), defer_signals(), allow_signals():
            os.kill(os.getpid(), signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, former)
    assert calls == [signal.SIGTERM]


def test_other_threads_hold_nothing() -> None:
    found = []

    def run() -> None:
        with defer_signals(), allow_signals():
            found.append(side_by_side().cycle(1))

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    assert found == [1]


# ---- runs that they end


@pytest.mark.parametrize("line", ["SPLIT 2.5 0.5 2.5 4", "SAVE", "GENERATE 0 2 1 3 AUTO EDGE 1"])
def test_ctrl_c_in_a_short_command_ends_the_run_after_it(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    side_by_side(tmp_path).run(line)  # where a command has to wait for the compiler, Ctrl-C ends it at once
    m, make = side_by_side(tmp_path), Undo.save_words

    def keep(self: Undo, array: MainArray) -> None:
        interrupt()
        make(self, array)

    monkeypatch.setattr(Undo, "save_words", keep)
    if line == "SAVE":
        monkeypatch.setattr(
            "udec_ia.restart.restart_writer._now", lambda: interrupt() or "2000-01-01T00:00:00Z"
        )
    with pytest.raises(KeyboardInterrupt, match=r"rescue\.h5") as caught:
        run_deck(m, f"{line}\nCYCLE 10\n", io.StringIO())
    monkeypatch.undo()
    assert m.session.log.lines[-1] == line
    other = Model.restore(str(caught.value))
    assert other.session.log.lines == m.session.log.lines
    assert state(other)["words"] == state(m)["words"]
    assert m.array.h.ci[MCTOT] == 0


def test_ctrl_c_stops_a_run_between_two_pieces(tmp_path: Path) -> None:
    m = side_by_side(tmp_path)
    m.history(10, "unbalanced")
    m.progress = stream = io.StringIO()
    stream.write = lambda _: interrupt()  # type: ignore[method-assign,assignment,return-value]
    with pytest.raises(KeyboardInterrupt):
        m.cycle(10**7)
    assert 0 < m.h.ci[MCTOT] < 10**7
    assert m.check() == []
    assert m.histories()[0].last_cycle == m.h.ci[MCTOT] // 10 * 10


def test_ctrl_c_stops_an_animated_run_as_soon(tmp_path: Path) -> None:
    m = side_by_side(tmp_path)
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
    printed = [line for line in err if line and not line.startswith("compiling")]
    told = f"interrupted: the results so far are saved in {tmp_path}/rescue.h5"
    unproved = "interrupted"  # it says on standard output that the file was not proved
    assert (run.returncode, printed) in [(status, [told])] + [(status, [unproved])] * (times > 1)
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
    from udec_ia.deck.interactive_session import converse

    m, lines = Model(out=tmp_path), iter(["START", "BLOCK 0 0 0 1 1 1 1 0", ""])

    def ask(_: str) -> str:
        line = next(lines, None)
        return line if line is not None else terminate(signal.SIGTERM, None) or ""  # type: ignore[func-returns-value]

    with pytest.raises(Terminated, match=r"rescue\.h5"):
        converse(m, io.StringIO(), ask)
    assert len(Model.restore(tmp_path / "rescue.h5").table("block")) == 1


def test_a_run_that_is_ended_by_system_exit_leaves_a_rescue_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = side_by_side(tmp_path)

    def leave(*_: object) -> None:
        raise SystemExit

    monkeypatch.setattr("udec_ia.ops.commands.model_settings.set_gravity", leave)
    with pytest.raises(SystemExit) as caught:
        m.run("CYCLE 5\nGRAVITY 0 -5\n")
    (note,) = caught.value.__notes__
    assert note == f"the results so far are saved in {tmp_path / 'rescue.h5'}"
    assert Model.restore(tmp_path / "rescue.h5").h.ci[MCTOT] == 5


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


@pytest.mark.parametrize("is_dealt_with", [True, False])
def test_an_interrupt_is_handed_on_unless_it_was_dealt_with(is_dealt_with: bool) -> None:
    """As where a debugger asks within a command: Ctrl-C ends a line that is typed, and not the command."""

    def ask() -> None:
        with defer_signals(), allow_signals():
            try:
                signal.raise_signal(signal.SIGINT)
            except KeyboardInterrupt as error:
                if is_dealt_with:
                    dealt_with(error)

    if is_dealt_with:
        ask()
    else:
        with pytest.raises(KeyboardInterrupt):
            ask()


def test_the_command_after_an_interrupt_at_the_prompt_is_executed(tmp_path: Path) -> None:
    mine, its = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "udec_ia", "run", "--out", str(tmp_path)],
        stdin=its,
        stdout=its,
        stderr=its,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # it may be ignored where tests run
    )
    os.close(its)
    seen = ""

    def is_read(text: str, seconds: float = 60) -> bool:
        nonlocal seen
        end = time.monotonic() + seconds
        while text not in seen and time.monotonic() < end:
            if select([mine], [], [], 0.2)[0]:
                seen += os.read(mine, 4096).decode()
        if text not in seen:
            return False
        seen = seen.partition(text)[2]
        return True

    try:
        assert is_read("> ")
        os.write(mine, b"START\n")
        assert is_read("> ")
        for _ in range(20):  # Python misses one that comes before it waits for a key
            process.send_signal(signal.SIGINT)
            if is_read("interrupted", 2):
                break
        assert is_read("> ")
        os.write(mine, b"HELP STOP\n")
        assert is_read("Example: STOP")
        os.write(mine, b"STOP\n")
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait()
        os.close(mine)
