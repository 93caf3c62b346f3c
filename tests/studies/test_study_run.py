"""One run of a study: what comes of it, what is in its folder, and when a result is taken again."""

from __future__ import annotations

import json
import logging
import math
import os
import re
from dataclasses import replace
from pathlib import Path

import pytest
from support.study_decks import outcome

from udec_ia import Model, UdecError
from udec_ia.layout.offsets import MCTOT, MFREE
from udec_ia.studies.execute_run import execute, rehearse
from udec_ia.studies.quantities import read_quantities
from udec_ia.studies.run_folder import LOCK
from udec_ia.studies.study_run import RunResult, StudyRun, kept_result, write_result
from udec_ia.studies.worker_pool import RUNS, run_all

SLIDE = (Path(__file__).parents[2] / "examples" / "incline.dat").read_text().replace("PLOT 0 CONTACTS\n", "")
SLIDE = SLIDE.replace("HISTORY 20", "HISTORY 10")  # so the last cycle is among those that are recorded
SLOW = "START\nBLOCK 0,0 0,1 1,1 1,0\nPROP MAT=1 DENS=1 KN=1 KS=1\nSPLIT 0.5,-1 0.5,2\nCYCLE 100000000\n"
LAW = "def clj2(fn, fs, dun, dus, un, us, m):\n    return -m.kn * dun, -m.ks * dus\n"


def of(values: dict[str, float], **others: object) -> StudyRun:
    run = StudyRun("run", SLIDE, "incline.dat", values, quantities=("v = block(6, 5).KXD", "time"))
    return replace(run, **others)  # type: ignore[arg-type]


def test_a_run_is_the_one_that_udec_run_makes(tmp_path: Path) -> None:
    """Watched or not, bit for bit: numbers, histories and the restart file's words."""
    deck = SLIDE.replace("STOP", "SAVE end.h5\nSTOP")
    result = execute(of({"F": 0.25}, deck=deck, stop=("time > 1e9",), every=7), tmp_path)
    model = Model(out=tmp_path, name="incline")
    model.run(deck, values={"F": 0.25})
    again, free = Model.restore(tmp_path / "run" / "end.h5"), model.h.ci[MFREE]
    assert (again.h.ia[: free - 1] == model.h.ia[: free - 1]).all()
    assert result.status == "ended"
    assert (result.cycles, result.words) == (model.h.ci[MCTOT], free - 1)
    assert result.quantities["time"] == model.histories()[0].numbers[-1, 1]
    assert result.quantities["v"] == model.histories()[0].numbers[-1, 2]
    assert (tmp_path / "run" / "incline-history.csv").read_text() == (
        tmp_path / "incline-history.csv"
    ).read_text()


def test_the_deck_in_the_folder_runs_alone(tmp_path: Path) -> None:
    result = execute(of({"F": 0.25}), tmp_path)
    model = Model(out=tmp_path)
    model.run(tmp_path / "run" / "deck.dat")
    assert model.histories()[0].numbers[-1, 2] == result.quantities["v"]


def test_nothing_says_where_it_was_run(tmp_path: Path) -> None:
    """Neither the log nor the result has a name of the folder, and both are the same wherever it was."""
    found = []
    for place in ("one", "two"):
        (tmp_path / place).mkdir()
        result = execute(of({"F": 0.25}, deck=SLIDE + "CYCLE 1 2\n"), tmp_path / place)
        log = (tmp_path / place / "run" / "log.txt").read_text()
        assert str(tmp_path) not in log + str(result)
        found.append(
            (outcome(result), re.sub(r"; [\d.]+ s(, .* compiling)?$|[\d,]+ cycles/s", "", log, flags=re.M))
        )
    assert found[0] == found[1]
    assert not [*(tmp_path / "one").glob(".*")]


def test_an_error_is_a_result(tmp_path: Path) -> None:
    result = execute(of({"F": -1}), tmp_path)
    assert (result.status, result.error) == ("error", 28)
    assert result.message == "incline.dat:19:21: error 28: value out of range: friction is -1"
    assert math.isnan(result.quantities["v"])
    assert result.cycles > 0
    assert "                    ^" in (tmp_path / "run" / "log.txt").read_text()


@pytest.mark.parametrize(
    ("others", "number", "message"),
    [
        ({"values": {"G": 1}}, 10, "incline.dat has no $G"),
        ({"deck": "START\nCYCLE $N\n", "values": {}}, 7, "incline.dat:2:7: error 7"),
        ({"deck": "START\nCYCLE $N\n", "values": {}, "file": ""}, 7, "deck.dat:2:7: error 7"),
        ({"constitutive": ("nowhere.py",)}, 34, "nowhere.py cannot be read"),
    ],
)
def test_whatever_is_wrong_with_a_run(
    others: dict[str, object], number: int, message: str, tmp_path: Path
) -> None:
    result = execute(replace(of({"F": 0.1}), **others), tmp_path)  # type: ignore[arg-type]
    assert (result.status, result.error) == ("error", number)
    assert message in result.message


def test_an_exception_of_ours_is_a_result_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError("in the program")

    monkeypatch.setattr("udec_ia.studies.execute_run.StudyObserver.begin", broken)
    result = execute(of({}), tmp_path)
    assert (result.status, result.message) == ("error", "ZeroDivisionError: in the program")
    assert "Traceback" in (tmp_path / "run" / "log.txt").read_text()


def test_a_rule_stops_a_run_at_the_first_look_at_which_it_holds(tmp_path: Path) -> None:
    """The same values are in the history of the whole run: there it holds at that cycle, and not before."""
    result = execute(of({"F": 0.1}, stop=("block(6, 5).KXD < -1", "time > 1e9"), every=10), tmp_path)
    assert (result.status, result.message) == ("stopped", "block(6, 5).KXD < -1")
    model = Model(out=tmp_path)
    model.run(SLIDE, values={"F": 0.1})
    cycles, _, speeds = model.histories()[0].numbers.T
    assert result.cycles == cycles[speeds < -1][0]


def test_a_rule_without_a_value_does_not_hold(tmp_path: Path) -> None:
    assert execute(of({"F": 0.1}, stop=("last history 7 > 1",)), tmp_path).status == "ended"


def test_a_limit_ends_a_run(tmp_path: Path) -> None:
    result = execute(StudyRun("run", SLOW, limit=0.5), tmp_path)
    assert (result.status, result.message) == ("timed out", "after 0.5 s")
    assert 0.5 < result.seconds < 3
    assert 0 < result.cycles < 100_000_000


def test_a_rehearsal_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    rehearse(StudyRun("run", SLOW))
    assert [*tmp_path.iterdir()] == []


def test_the_log_of_the_program_is_that_of_the_run(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    law = tmp_path / "law.py"
    law.write_text("import logging\nlogging.getLogger('udec_ia').warning('from the law')\n" + LAW)
    execute(of({}, constitutive=(str(law),)), tmp_path)
    assert "from the law" in (tmp_path / "run" / "log.txt").read_text()
    assert "from the law" not in caplog.text
    assert logging.getLogger("udec_ia").propagate


@pytest.mark.parametrize(
    ("others", "why"),
    [
        ({}, ""),
        ({"deck": SLIDE + "*\n"}, "deck changed"),
        ({"values": {"F": 0.2}}, "values changed"),
        ({"build": "i32r32", "quantities": ("time",)}, "build and quantities changed"),
        ({"stop": ("time > 1",)}, "rule to stop changed"),
        ({"limit": 9.0}, ""),
        ({"file": "other.dat"}, ""),
    ],
)
def test_a_result_is_taken_if_it_is_made_of_the_same(
    others: dict[str, object], why: str, tmp_path: Path
) -> None:
    run = of({"F": 0.1})
    (tmp_path / "run").mkdir()
    result = RunResult(
        "run", {"F": 0.1}, "ended", quantities={"v": math.inf, "time": 0.1}, made_of=run.made_of
    )
    write_result(result, tmp_path / "run")
    found = kept_result(replace(run, **others), tmp_path)  # type: ignore[arg-type]
    assert found == ((None, why) if why else (result, ""))


def test_laws_restart_files_and_limits_count_too(tmp_path: Path) -> None:
    law, state = tmp_path / "law.py", tmp_path / "a.h5"
    law.write_text(LAW)
    state.write_text("one")
    (tmp_path / "run").mkdir()
    run = StudyRun("run", f"RESTART {state}\n", constitutive=(str(law),), limit=5.0)
    found = dict.fromkeys(read_quantities(run.quantities), 0.5)
    late = RunResult("run", {}, "timed out", quantities=found, made_of=run.made_of, limit=5.0)
    write_result(late, tmp_path / "run")
    assert kept_result(run, tmp_path) == (late, "")
    assert kept_result(replace(run, limit=4.0), tmp_path) == (late, "")
    assert kept_result(replace(run, limit=6.0), tmp_path) == (None, "limit changed")
    assert kept_result(replace(run, limit=None), tmp_path) == (None, "limit changed")
    law.write_text(LAW + "\n")
    state.write_text("two")
    assert kept_result(run, tmp_path) == (None, "input files and laws changed")
    (tmp_path / "run" / "result.json").write_text("{")
    assert kept_result(run, tmp_path) == (None, "the result cannot be read")


def test_what_cannot_be_a_run() -> None:
    for wrong in (
        {"every": 0},
        {"limit": 0.0},
        {"limit": math.nan},
        {"limit": math.inf},
        {"build": "i9r9"},
        {"stop": ("time",)},
        {"quantities": ("x",)},
    ):
        with pytest.raises(ValueError, match=r"."):
            of({}, **wrong)
    with pytest.raises(ValueError, match="two runs are called run"):
        run_all([of({}), of({})], ".", jobs=0)
    with pytest.raises(ValueError, match="-1 jobs"):
        run_all([of({})], ".", jobs=-1)


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(UdecError, match="31"):
        run_all([of({})], tmp_path / "file", jobs=0)


def test_an_interrupted_run_leaves_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("udec_ia.studies.execute_run.StudyObserver.begin", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_all([of({})], tmp_path, jobs=0)
    assert os.listdir(tmp_path / RUNS) == [LOCK]


def test_the_result_in_the_folder_is_plain_json(tmp_path: Path) -> None:
    execute(of({"F": 0.1}), tmp_path)
    text = (tmp_path / "run" / "result.json").read_text()
    assert json.loads(text)["quantities"]["time"] > 0
    assert "NaN" not in text
