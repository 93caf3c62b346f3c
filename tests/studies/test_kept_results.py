"""Results that were kept: damaged ones, and those of failures that were not of the deck, are done again."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support.study_decks import outcome, piles

from udec_ia.studies.execute_run import execute
from udec_ia.studies.study_run import RunResult, StudyRun, kept_result, write_result

HUGE = 10**400
DAMAGED = [
    ("quantities", None),
    ("quantities", []),
    ("quantities", {"time": 1.0}),
    ("quantities", {"time": None, "displacement": 1.0, "force": 1.0, "ratio": 1.0}),
    ("quantities", {"time": 1.0, "displacement": 1.0, "force": "much", "ratio": 1.0}),
    ("quantities", {"time": 1.0, "displacement": 1.0, "force": HUGE, "ratio": 1.0}),
    ("made_of", None),
    ("made_of", []),
    ("made_of", {"deck": 1}),
    ("values", None),
    ("values", {"F": "0.1"}),
    ("values", {"F": [0.1], "N": 1}),
    ("values", {"F": 0.2, "N": 1}),
    ("name", "F=0.2"),
    ("status", "foo"),
    ("status", []),
    ("cycles", "x"),
    ("cycles", 1.5),
    ("cycles", -1),
    ("cycles", HUGE),
    ("error", True),
    ("seconds", None),
    ("seconds", HUGE),
    ("time", float("nan")),
    ("words", None),
    ("message", 5),
    ("remarks", "text"),
    ("remarks", [1]),
    ("warnings", None),
    ("limit", "1"),
    ("limit", 0),
    ("of_system", 0),
    ("more", 1),
]


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> tuple[StudyRun, RunResult, dict[str, Any]]:
    """A run, its result, and the file that it has left."""
    folder = tmp_path_factory.mktemp("left")
    (run,) = piles(0.1, cycles=1)
    result = execute(run, folder)
    return run, result, json.loads((folder / run.name / "result.json").read_text())


def found(run: StudyRun, folder: Path, content: object) -> tuple[RunResult | None, str]:
    """What is taken of a file with that content."""
    (folder / run.name).mkdir()
    (folder / run.name / "result.json").write_text(json.dumps(content))
    return kept_result(run, folder)


@pytest.mark.parametrize(("field", "value"), DAMAGED)
def test_what_the_program_does_not_write_cannot_be_read(
    field: str, value: object, left: tuple[StudyRun, RunResult, dict[str, Any]], tmp_path: Path
) -> None:
    run, _, content = left
    assert found(run, tmp_path, content | {field: value}) == (None, "the result cannot be read")


@pytest.mark.parametrize("content", [None, [], 5, "text", {}, {"name": "F=0.1"}])
def test_nor_can_what_is_no_result(
    content: object, left: tuple[StudyRun, RunResult, dict[str, Any]], tmp_path: Path
) -> None:
    assert found(left[0], tmp_path, content) == (None, "the result cannot be read")


def test_deep_nesting_and_bytes_that_are_no_text(
    left: tuple[StudyRun, RunResult, dict[str, Any]], tmp_path: Path
) -> None:
    run = left[0]
    (tmp_path / run.name).mkdir()
    for content in (b"[" * 100_000, b"\xff\xfe", b""):
        (tmp_path / run.name / "result.json").write_bytes(content)
        assert kept_result(run, tmp_path) == (None, "the result cannot be read")


def test_what_is_whole_is_taken(left: tuple[StudyRun, RunResult, dict[str, Any]], tmp_path: Path) -> None:
    run, result, content = left
    assert found(run, tmp_path, content) == (result, "")


@pytest.mark.parametrize(
    ("result", "why"),
    [
        (RunResult("", {}, "died", of_system=True), "the system had failed"),
        (RunResult("", {}, "error", 31, of_system=True), "the system had failed"),
        (RunResult("", {}, "error", 1, of_system=True), "the system had failed"),
        (RunResult("", {}, "error", 0, of_system=True), "the system had failed"),
    ],
)
def test_failures_that_were_not_of_the_deck_are_done_again(
    result: RunResult, why: str, left: tuple[StudyRun, RunResult, dict[str, Any]], tmp_path: Path
) -> None:
    run, whole, _ = left
    same = {"name": run.name, "values": whole.values, "quantities": whole.quantities}
    (tmp_path / run.name).mkdir()
    write_result(replace(result, made_of=run.made_of, **same), tmp_path / run.name)  # type: ignore[arg-type]
    assert kept_result(run, tmp_path) == (None, why)


def broken(error: Exception) -> Any:
    def method(*_: object, **__: object) -> None:
        raise error

    return method


@pytest.mark.parametrize(
    ("error", "number", "taken"),
    [
        (OSError(27, "File too large"), 31, False),
        (MemoryError(), 1, False),
        (RuntimeError("can't start new thread"), 0, False),
    ],
)
def test_what_ends_a_run_and_is_not_of_the_deck(
    error: Exception, number: int, taken: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (run,) = piles(0.1, cycles=1)
    with monkeypatch.context() as patched:
        patched.setattr("udec_ia.model.Model.gravity", broken(error))
        result = execute(run, tmp_path)
    assert (result.status, result.error, result.of_system) == ("error", number, not taken)
    assert kept_result(run, tmp_path)[0] is None


def test_an_error_of_the_deck_is_taken(tmp_path: Path) -> None:
    (run,) = piles(-1)
    result = execute(run, tmp_path)
    assert (result.status, result.error, result.of_system) == ("error", 28, False)
    again, why = kept_result(run, tmp_path)
    assert why == ""
    assert again is not None
    assert outcome(again) == outcome(result)
