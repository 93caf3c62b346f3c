"""AccuracyStudy lists of models that can be solved by hand, and digits that are lost on the way.

A block that falls freely from rest has moved by g dt^2 n(n + 1)/2 after n cycles, as velocities are those
of half steps: 1 + 1/n times g t^2/2. The error goes with the step itself, and is 1/n.
"""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.layout import offsets as g
from udec_ia.studies.accuracy_report import answer, half_step, table_rows
from udec_ia.studies.accuracy_study import AccuracyStudy, Row, recommended, study_accuracy
from udec_ia.studies.deck_rewriting import Deck, list_changes
from udec_ia.studies.setting_runner import Options, SettingRunner
from udec_ia.studies.settings import Fraction, Numbers, Setting
from udec_ia.studies.significant_digits import Ensemble, PerturbedRun, blame_fields, measure_digits
from udec_ia.studies.study_run import ENDED, RunResult
from udec_ia.studies.survey_run import read_segments
from udec_ia.studies.worker_pool import RUNS, run_all

PROPERTIES = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 FRICTION=0.5\n"
FALL = (
    f"{PROPERTIES}BLOCK 0 0 0 1 1 1 1 0\nGRAVITY 0 -10\nFRAC 0.1\n"
    "CYCLE 120\nPRINT BLOCKS\nCYCLE 80\nSTOP\nEND\n"
)
FELL = ("way = block(0.5, 0.5).YDISPLACEMENT",)
STEP = 0.1 * 2 * math.sqrt(2000 / 1e8)
WALL = (
    f"{PROPERTIES}BLOCK 0 0 0 3 3 3 3 0\nSPLIT -1 1 4 1\nSPLIT 1 0.5 1 4\nSPLIT 2 0.5 2 4\nROUND 0.1\n"
    "FIX 0 3 0 1\nGRAVITY 0 -10\nFRAC 0.1\nDAMP 0.5 10 MASS\n"
)


def priced(text: str, folder: Path, **named: object) -> AccuracyStudy:
    options = Options(builds=("i32r64",), jobs=0, **named)  # type: ignore[arg-type]
    return study_accuracy(text, "x.dat", {}, folder, options)


@pytest.fixture(scope="module")
def fall(tmp_path_factory: pytest.TempPathFactory) -> AccuracyStudy:
    return priced(FALL, tmp_path_factory.mktemp("fall"), quantities=FELL)


def test_the_reference_is_the_exact_way(fall: AccuracyStudy) -> None:
    limit = fall.references["way"]
    assert limit.value == pytest.approx(-0.5 * 10 * (200 * STEP) ** 2, rel=1e-9)
    assert limit.order == pytest.approx(1, abs=1e-6)


def test_errors_are_those_of_the_formula(fall: AccuracyStudy) -> None:
    ran = [row for row in fall.rows if row.result and row.ran]
    assert len(ran) > 8
    for row in ran:
        assert row.result is not None
        n, time = row.result.cycles, row.result.time / (200 * STEP)
        assert abs(time - 1) * n <= 0.5 + 1e-9  # half a step of what the deck has
        assert row.error == pytest.approx(abs(time**2 * (1 + 1 / n) - 1), abs=1e-9)


def test_the_cheapest_within_the_tolerance_is_recommended(fall: AccuracyStudy) -> None:
    best = fall.best
    assert best is not None
    assert best.result is not None
    assert best.error <= 1e-3
    assert 1000 <= best.result.cycles <= 1000 * 2**0.5 * 1.06
    lines = answer(fall)
    heads = [line.partition(":")[0] for line in lines]
    assert heads == ["to change", "cost", "accuracy", "loading path", "unknown"]
    assert "line 5: FRAC 0.1 -> FRACTION" in lines[0]
    assert "power 1.00" in lines[2]


@pytest.mark.parametrize(
    ("narrow", "wide", "taken"),
    [
        (0.010, 0.029, "i32r64"),  # by less than a process can tell
        (1.00, 1.20, "i32r64"),
        (1.00, 1.30, "i32r32"),
        (1.00, math.inf, "i32r32"),  # too wrong with 64 bits
        (1.30, 1.00, "i32r64"),
    ],
)
def test_short_reals_are_recommended_where_they_save_time(narrow: float, wide: float, taken: str) -> None:
    rows = [
        Row(
            Setting(build), Numbers(), cost, RunResult("", {}, ENDED), cost, {"way": 0.0 if cost < 9 else 1.0}
        )
        for build, cost in (("i32r32", narrow), ("i32r64", wide))
    ]
    best = recommended([row for row in rows if row.errors["way"] < 1e-3])
    assert best is not None
    assert best.setting.build == taken


def test_the_lines_to_change_make_the_recommended_run(fall: AccuracyStudy, tmp_path: Path) -> None:
    assert fall.best is not None
    assert fall.best.result is not None
    lines = FALL.splitlines()
    for change in list_changes(fall.deck, fall.best.setting, fall.best.numbers, fall.fraction)[1:]:
        where, new = change.removeprefix("line ").split(": ", 1)
        lines[int(where) - 1] = new.split(" -> ")[1]
    model = Model(out=tmp_path)
    model.run("\n".join(lines))
    way = model.table("block")["KY"][0] - 0.5
    assert way == pytest.approx(fall.best.result.quantities["way"], rel=1e-12)


def test_the_survey_knows_the_time_steps(fall: AccuracyStudy) -> None:
    (found,) = (row.segments for row in fall.rows if row.setting == Setting())
    assert [one.asked for one in found] == [120, 80]
    assert [one.step for one in found] == pytest.approx([STEP] * 2)
    assert found[1].began == pytest.approx(120 * STEP)


def test_half_the_step(tmp_path: Path) -> None:
    found = priced(FALL, tmp_path, quantities=FELL, half_step=True)
    assert len(found.rows) == 2
    (line,) = half_step(found)
    assert "off by 2.5e-03" in line  # 1/200 and 1/400
    assert "TOO LARGE" in line


def test_rest_is_sought_more_closely(tmp_path: Path) -> None:
    force = ("force = sum contact.KCFN",)
    found = priced(f"{WALL}SOLVE 1E-2\n", tmp_path, quantities=force, tolerance=1e-2)
    limit = found.references["force"]
    assert limit.value == pytest.approx(
        2 * 3 * 2000 * 10, rel=1e-3
    )  # the weight of six blocks above the joint
    assert found.best is not None


def test_a_budget_that_is_too_small_says_so(tmp_path: Path) -> None:
    found = priced(FALL, tmp_path, quantities=FELL, budget=1e-6)
    assert found.best is None
    assert [row.setting for row in found.rows if row.result] == [Setting()]
    assert "budget" in found.notes[0]


def test_a_deck_that_fails_is_a_result(tmp_path: Path) -> None:
    found = priced(FALL.replace("CYCLE 80", "DELETE 0 1 0 1"), tmp_path, quantities=FELL)
    assert "gives nothing to compare" in answer(found)[-1]


# ---- digits


def noisy(folder: Path, name: str, **named: object) -> float:
    run = PerturbedRun(name, f"{WALL}CYCLE 50\n", quantities=("x = mean block.KY",), cycles=50, **named)  # type: ignore[arg-type]
    (result,) = run_all([run], folder, jobs=0)
    assert result.status == "ended"
    return result.quantities["x"]


def test_noise_is_in_the_last_digits_and_repeats_itself(tmp_path: Path) -> None:
    plain, one, two = (noisy(tmp_path, f"s{seed}", seed=seed) for seed in (0, 1, 2))
    assert len({plain, one, two}) == 3
    assert noisy(tmp_path, "again", seed=1) == one
    # fifty kicks of a unit of numbers below 4, passed on by a motion that is damped
    assert max(abs(one - plain), abs(two - plain)) < 50 * 4 * 2.0**-52 * 10
    assert noisy(tmp_path, "nowhere", seed=1, fields=("zone.KZS11",)) == plain


def test_rounding_takes_the_same_digits_of_words_of_any_length(tmp_path: Path) -> None:
    quantities = ("x = mean block.KY", "force = max contact.KCFN")
    deck, options = Deck(f"{WALL}CYCLE 100\n", "x.dat"), Options(quantities=quantities, jobs=0)
    with SettingRunner(deck, options, tmp_path) as runner:
        check_rounding(measure_digits(runner, 6))


def check_rounding(found: Ensemble) -> None:
    wide, narrow = (found.digits(build, "force") for build in found.results)
    assert wide is not None
    assert narrow is not None
    assert wide.digits - narrow.digits == pytest.approx(29 * math.log10(2), abs=1.5)
    assert "rounding takes" in str(found.rows()[1][-1])
    _, rows = blame_fields(found, "force")
    shares = {str(row[0]): float(str(row[2])) for row in rows}
    assert max(shares.values()) > 0.3
    assert {name.partition(".")[0] for name in shares} <= {"block", "corner", "contact", "domain"}
    assert [*shares.values()] == sorted(shares.values(), reverse=True)


# ---- command line


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "fall.dat"
    deck.write_text(FALL)
    out = tmp_path / "out"
    asked = ["--quantity", FELL[0], "--builds", "i32r64", "--jobs", "0", "--out", str(out)]
    assert main(["trade", str(deck), *asked]) == 0
    told = capsys.readouterr().out
    assert told.startswith("to change:\n    line 5: FRAC 0.1 -> FRACTION")
    assert sum(not line.startswith(" ") for line in told.splitlines()) == 6
    names = {f"fall-trade.{kind}" for kind in ("csv", "png", "svg")}
    assert {path.name for path in out.glob("fall-trade.*")} == names
    assert main(["trade", str(deck), *asked, "--half-step"]) == 0
    assert "TOO LARGE" in capsys.readouterr().out
    assert main(["trade", str(deck), "--tolerance", "0"]) == 2


def test_what_was_not_run_has_no_numbers(fall: AccuracyStudy) -> None:
    setting, numbers = fall.rows[0].setting, fall.rows[0].numbers
    (row,) = table_rows(replace(fall, rows=[Row(setting, numbers, predicted=2.0)]))
    assert row == (setting.name, "", "", "", 0, "not run: beyond the budget")


MILD = (
    f"{PROPERTIES}BLOCK 0 0 0 3 4 3 4 0\nSPLIT -1 1 5 1\nFIX 0 4 0 1\nROUND 0.1\nGRAVITY 0 -10\n"
    "SOLVE 1E-5 STATIC\n"
)


def test_a_deck_that_begins_with_static_keeps_its_own_step_afterwards(tmp_path: Path) -> None:
    """STATIC has a time-step for itself alone: the deck as it is is the deck, bit for bit."""
    text = f"{MILD}GRAVITY 3 -10\nDAMPING 0.3 8\nCYCLE 200\nSTOP\nEND\n"
    m = Model(out=tmp_path)
    m.run(text.replace("STOP\nEND\n", ""))
    price = priced(text, tmp_path, quantities=("way = mean block.DISPLACEMENT",))
    own = next(row for row in price.rows if row.setting == Setting())
    assert own.result is not None
    assert own.result.time == float(m.h.cd[g.TIME])
    runs = read_segments(tmp_path / RUNS / own.setting.name)
    assert [one.static for one in runs] == [False, False]  # a file does not say so
    assert runs[1].step == float(m.h.cr[g.TDEL])
    assert price.fraction == Fraction(0.1)
    assert {1.0, 0.5} <= {row.setting.step for row in price.rows}


def test_steps_are_not_tried_where_static_is_all(tmp_path: Path) -> None:
    price = priced(MILD, tmp_path, quantities=("way = mean block.DISPLACEMENT",))
    assert {(row.setting.step, row.setting.safe, row.setting.static) for row in price.rows} == {(1, 0, False)}
    assert price.best is not None
    best = price.best
    assert "FRACTION" not in " ".join(list_changes(price.deck, best.setting, best.numbers, price.fraction))
    assert not any("power" in line for line in answer(price))


@pytest.mark.parametrize("fraction", [(0.05, ""), (0.8, " SAFE"), (0.8, " SCALED")])
def test_a_deck_that_goes_on_from_a_file_keeps_its_fraction(
    fraction: tuple[float, str], tmp_path: Path
) -> None:
    m = Model(out=tmp_path)
    m.run(f"{WALL}FRACTION {fraction[0]}{fraction[1]}\nCYCLE 10\nSAVE a.h5\n")
    price = study_accuracy(
        "RESTART a.h5\nCYCLE 60\n",
        "x.dat",
        {},
        tmp_path / "out",
        Options(builds=("i32r64",), jobs=0),
        tmp_path,
    )
    assert price.fraction == fraction
    for name in (Setting().name, Setting(step=0.5).name):
        runs = read_segments(tmp_path / "out" / RUNS / name)
        assert (runs[0].safe, runs[0].scaled) == (bool(fraction[1]), fraction[1] == " SCALED")
        same = 1e-3 if fraction[1] else 1e-12  # the safe bound is found anew: contacts are not what they were
        step = float(m.h.cr[g.TDEL]) * (1 if name == Setting().name else 0.5)
        assert runs[0].step == pytest.approx(step, rel=same)
    assert all(row.ran for row in price.rows if row.result is not None)


def test_a_scaled_step_is_not_tried_beyond_the_safe_bound(tmp_path: Path) -> None:
    """FRACTION takes no more than 1 SAFE or SCALED."""
    text = WALL.replace("FRAC 0.1", "FRACTION 0.9 SCALED") + "DAMPING LOCAL 0.5\nSOLVE 1E-3\n"
    price = priced(text, tmp_path, quantities=("way = mean block.DISPLACEMENT",))
    assert all(row.ran for row in price.rows if row.result is not None)
    assert max(row.setting.step for row in price.rows) == 1
