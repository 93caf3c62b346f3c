"""A user who waits for a kernel to compile gets a message, and the rate of a run leaves the time out."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numba.core import config
from support.handmade_map import two_blocks

from udec_ia.compiling import compile_duration
from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.model import Model
from udec_ia.output.run_progress import RunProgress

SAYS = "compiling once for this machine, up to a minute ..."


def thrice(x: Any) -> Any:
    return x * 3


@contextmanager
def compiling() -> Iterator[None]:
    """A kernel is compiled inside, and another one for it."""
    compile_duration.begin_compiling()
    compile_duration.begin_compiling()
    try:
        yield
    finally:
        compile_duration.end_compiling()
        compile_duration.end_compiling()


@pytest.fixture
def quiet(monkeypatch: pytest.MonkeyPatch) -> type:
    """The account, as if nothing had ever been compiled."""

    class Account(compile_duration._Account):
        seconds = 0.0

    monkeypatch.setattr(compile_duration, "_Account", Account)
    Account.ended = float("-inf")
    return Account


@pytest.fixture
def fake_time(monkeypatch: pytest.MonkeyPatch, quiet: type) -> list[float]:
    """A clock that the test advances."""
    now = [100.0]
    monkeypatch.setattr(compile_duration, "monotonic", lambda: now[0])
    return now


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_what_is_compiled_is_told_and_what_is_found_on_disk_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, quiet: type
) -> None:
    """Once for all that is compiled one after the other, and again after a while without."""
    monkeypatch.setattr("udec_ia.compiling.cache_folder.cache_folder", lambda: tmp_path)
    first: Any = kernel(thrice)
    assert [first(x) for x in (np.int32(2), np.float64(2), np.int32(3))] == [6, 6, 9]
    assert caplog.messages == [SAYS]
    spent = compile_duration.compile_seconds()
    assert spent > 0
    quiet.ended -= 2 * compile_duration.STRETCH  # type: ignore[attr-defined]
    again: Any = kernel(thrice)
    assert [again(x) for x in (np.int32(2), np.float64(2))] == [6, 6]
    assert (caplog.messages, compile_duration.compile_seconds()) == ([SAYS], spent)
    assert again(np.float32(2)) == 6
    assert caplog.messages == [SAYS, SAYS]
    assert compile_duration.compile_seconds() > spent


def test_the_clock_of_a_run_stands_still_meanwhile(fake_time: list[float]) -> None:
    start = compile_duration.working_time()
    fake_time[0] += 1
    with compiling():
        fake_time[0] += 30
        assert compile_duration.working_time() - start == 1
    with suppress(KeyboardInterrupt), compiling():
        fake_time[0] += 5
        raise KeyboardInterrupt
    fake_time[0] += 2
    assert compile_duration.working_time() - start == 3
    assert compile_duration.compile_seconds() == 35


def test_the_rate_is_that_of_the_cycles(fake_time: list[float]) -> None:
    h, out = two_blocks().h, io.StringIO()
    report = RunProgress(lambda: h, 4000, out, None)
    with compiling():
        fake_time[0] += 60
    fake_time[0] += 4
    report(4000)
    report.close()
    assert out.getvalue().startswith("cycle 4000 of 4000: 1,000 cycles/s, ")


def test_the_summary_says_what_went_into_compiling(fake_time: list[float]) -> None:
    with compiling():
        fake_time[0] += 7
    model = Model()
    assert "compiling" not in model.summary()
    with compiling():
        fake_time[0] += 12.34
    assert model.summary().endswith(" s, 12.3 s of it compiling")
