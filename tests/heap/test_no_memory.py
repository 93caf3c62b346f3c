"""Memory that ends is an error, says what is kept, and hides no other error of the same cycle."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from support.mechanics_scenes import side_by_side

from udec_ia import Model, UdecError
from udec_ia.deck.command_monitor import run_deck
from udec_ia.heap.find_lose import room
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import scheme
from udec_ia.layout.offsets import JPHASE, MCTOT, NERR, NWANT
from udec_ia.running import history_series


def test_no_memory_left_is_an_error_of_the_deck(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none_left(*_: object) -> None:
        raise MemoryError

    m, out = Model(out=tmp_path), io.StringIO()
    monkeypatch.setattr("udec_ia.ops.commands.function_command._make_signal", none_left)
    with pytest.raises(UdecError) as caught:
        run_deck(m, "START\nBLOCK 0 0 0 1 1 1 1 0\nFUNCTION 1 0 0 1 1\n", out)
    assert (caught.value.number, caught.value.line, m.session.log.lines[1:]) == (
        1,
        3,
        ["BLOCK 0 0 0 1 1 1 1 0"],
    )
    assert Model.check_file(caught.value.saved or "") == []


def test_no_memory_left_in_a_run_does_not_say_that_nothing_was_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    m = side_by_side(tmp_path)

    def none_left(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr("udec_ia.running.history_series.run_with_records", none_left)
    with pytest.raises(UdecError, match="the results so far are kept") as caught:
        m.run("CYCLE 5\n")
    assert caught.value.number == 1


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
    m = side_by_side(mtop=mtop)
    m.cycle(3)
    run, calls = history_series.run_with_records, []

    def run_short(h: object, n: int, *given: object) -> tuple[int, bool]:
        calls.append(n)
        if len(calls) > 1:
            return run(h, n, *given)  # type: ignore[arg-type, no-any-return]
        m.array.h.ci[NERR], m.array.h.ci[JPHASE] = 15, 3
        room(m.array.h, len(m.array.h.ia) + 1)
        return 0, False

    monkeypatch.setattr(history_series, "run_with_records", run_short)
    with pytest.raises(UdecError) as caught:
        m.cycle(5)
    assert caught.value.number == 15
    assert len(calls) == (2 if mtop is None else 1)
    assert int(m.h.ci[MCTOT]) == (4 if mtop is None else 3)
