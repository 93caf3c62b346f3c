"""The answer of a study of accuracy, and what stands beside its numbers."""

from __future__ import annotations

import csv
import math
from dataclasses import replace
from pathlib import Path

import pytest

from udec_ia.cli import main
from udec_ia.studies.accuracy_report import answer, study_table, table_rows
from udec_ia.studies.accuracy_study import AccuracyStudy, path_differences, study_accuracy
from udec_ia.studies.deck_rewriting import Deck
from udec_ia.studies.extrapolation import Extrapolation
from udec_ia.studies.model_levers import COLUMNS, vary_lever
from udec_ia.studies.setting_runner import Options, SettingRunner
from udec_ia.studies.settings import Setting

HEAD = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 FRICTION=0.5\n"
FALL = f"{HEAD}BLOCK 0 0 0 1 1 1 1 0\nGRAVITY 0 -10\nHISTORY 50 KINETIC\nCYCLE 120\n"
WAY, FORCE = "way = block(0.5, 0.5).YDISPLACEMENT", "force = sum contact.KCFN"
MESHED = (
    f"{HEAD.replace('FRICTION', 'BULK=1E8 G=1E8 COHESION=100 FRICTION')}BLOCK 0 0 0 2 1 2 1 0\n"
    "SPLIT -1 1 2 1\nFIX 0 1 0 1\nROUND 0.05\nGEN 0 1 1 2 AUTO EDGE 0.5\nGRAVITY 0 -10\nCYCLE 5\n"
)
PILE = (
    f"{HEAD}BLOCK 0 0 0 3 3 3 3 0\nSPLIT -1 1 4 1\nROUND 0.1\nFIX 0 3 0 1\nGRAVITY 0 -10\nDAMP 0.5 10 MASS\n"
)
CHANGE, COST, ACCURACY, PATH, UNKNOWN = range(5)


def studied(text: str, folder: Path, *quantities: str, **named: object) -> AccuracyStudy:
    options = Options(quantities, builds=("i32r64",), jobs=0, **named)  # type: ignore[arg-type]
    return study_accuracy(text, "x.dat", {}, folder, options)


def test_what_is_the_same_at_all_steps_recommends_nothing_alone(tmp_path: Path) -> None:
    study = studied(FALL, tmp_path, WAY, FORCE, tolerance=1e-14)
    lines = answer(study)
    assert study.best is None
    assert study.known == ["force"]
    assert lines[CHANGE].startswith(
        "to change: no recommendation: without a reference that is known well enough: way"
    )
    assert "way converges, " in lines[ACCURACY]
    assert "force is 0 at all these steps" in lines[ACCURACY]
    assert not any("within" in str(row[-1]) for row in table_rows(study))
    one = replace(study, levels=study.levels[:1], rows=study.rows[:1])
    assert "no run with half the time-step has ended" in answer(one)[CHANGE]


def test_an_answer_has_five_lines_and_names_what_it_does_not_hold_for(tmp_path: Path) -> None:
    study = studied(FALL, tmp_path, WAY, FORCE, "cycles", tolerance=1e-2)
    lines = answer(study)
    assert len(lines) == 5
    assert study.known == ["way", "force"]
    assert "known well enough: cycles" in lines[UNKNOWN]


@pytest.mark.parametrize(
    ("known", "enough"), [(["moves"], True), (["same", "moves"], True), (["same"], False), ([], False)]
)
def test_which_quantities_are_enough_to_choose_by(known: list[str], enough: bool) -> None:
    references = {"same": Extrapolation(0.0, 0.0), "moves": Extrapolation(1.0, 1e-6, 1.0)}
    study = AccuracyStudy(Deck(FALL, "x.dat"), 1e-3, references=references, known=known)
    assert study.can_recommend == enough


def test_a_run_that_did_not_reach_its_ratio_is_no_reference(tmp_path: Path) -> None:
    """Neither is it mixed into statistics: there is nothing to compare, and the answer says why."""
    study = studied(f"{PILE}SOLVE 1E-2 LIMIT 100\n", tmp_path, "force = max contact.KCFN", tolerance=0.9)
    assert (study.rows, study.levels, study.best) == ([], [], None)
    assert "did not reach the force ratio" in answer(study)[0]


def test_a_setting_that_did_not_reach_its_ratio_is_not_compared(tmp_path: Path) -> None:
    """With LIMIT 700 the deck as it is comes to rest, and closer to rest it does not."""
    study = studied(f"{PILE}SOLVE 1E-2 LIMIT 900\n", tmp_path, "force = max contact.KCFN", tolerance=0.1)
    assert study.levels
    for row in study.rows:
        assert row.result is None or row.compared == (row.ran and row.result.at_rest)
    compared = [row.result.quantities["force"] for row in study.rows if row.result and row.compared]
    assert study.values("force") == compared


def test_whether_the_result_depends_on_the_loading_path(tmp_path: Path) -> None:
    way = "way = max block.DISPLACEMENT"
    study = studied(f"{PILE}SOLVE 1E-3\n", tmp_path, way, tolerance=1e-2)
    assert answer(study)[PATH].startswith("loading path: does not depend on it")
    found = path_differences(study)
    assert 0 <= found["way"] < 0.1
    slipped = replace(study, solved="SOLVE 0.01 reached, but: joints slipped")
    line = answer(slipped)[PATH]
    assert line.startswith("loading path: depends on it")
    assert f"way by {found['way']:.2g}" in line
    fall = studied(FALL, tmp_path / "fall", WAY)
    assert path_differences(fall) == {}
    assert "without SOLVE" in answer(fall)[PATH]


def test_the_table_has_the_value_and_error_of_every_quantity_at_every_setting(tmp_path: Path) -> None:
    study = studied(FALL, tmp_path, WAY, FORCE, tolerance=1e-2)
    file = study_table(study).write(tmp_path / "x")
    with file.open(newline="") as text:
        rows = {row["run"]: row for row in csv.DictReader(text)}
    assert {*rows} == {row.setting.name for row in study.rows}
    reference = study.references["way"]
    for row in study.rows:
        assert row.result is not None
        assert float(rows[row.setting.name]["value of way"]) == row.result.quantities["way"]
        error = float(rows[row.setting.name]["error of way"])
        assert error == pytest.approx(abs(row.result.quantities["way"] / reference.value - 1), abs=1e-12)
        assert float(rows[row.setting.name]["error of force"]) == 0


def test_a_quantity_that_tends_to_0_has_no_relative_error(tmp_path: Path) -> None:
    """The displacement of a block on springs goes with one over their stiffness: it tends to 0."""
    deck = Deck(f"{PILE}CYCLE 2000\n", "x.dat")
    with SettingRunner(deck, Options(("way = max block.DISPLACEMENT",), jobs=0), tmp_path) as runner:
        runner.run_own_deck()
        _, rows = vary_lever(runner, "stiffness")
    off = [row[COLUMNS.index("off its limit")] for row in rows]
    assert off == pytest.approx([1, 0.5, 0.25], rel=0.05)
    assert all("tends to 0" in str(row[-1]) for row in rows)


def test_types_of_blocks_are_compared_with_those_of_the_deck(tmp_path: Path) -> None:
    with SettingRunner(Deck(MESHED, "x.dat"), Options((FORCE,), jobs=0), tmp_path) as runner:
        runner.run_own_deck()
        assert runner.own.result is not None
        own = runner.own.result.quantities["force"]
        _, rows = vary_lever(runner, "types")
    assert [row[COLUMNS.index("times")] for row in rows] == ["", "rigid", "sdef"]
    values, off = ([row[COLUMNS.index(name)] for row in rows] for name in ("value", "off its limit"))
    assert values[0] == own
    assert len({*values}) == 3
    assert off == [abs(value - own) / own for value in values]  # type: ignore[operator]
    for name, zones, soft in (("", 1, 0), (",rigid", 0, 0), (",sdef", 0, 1)):
        deck = (tmp_path / "runs" / f"model,i32r64,step=1{name}" / "deck.dat").read_text().splitlines()
        assert sum(line.startswith("GEN") for line in deck) == zones
        assert sum(line.endswith("SDEF") for line in deck) == soft


def test_finer_zones_leave_joints_as_stiff_as_they_are(tmp_path: Path) -> None:
    with SettingRunner(Deck(MESHED, "x.dat"), Options((FORCE,), jobs=0), tmp_path) as runner:
        runner.run_own_deck()
        notes, rows = vary_lever(runner, "zones")
    contacts = [row[COLUMNS.index("contacts")] for row in rows]
    assert contacts == sorted({*contacts})  # type: ignore[type-var]
    assert "EDGE times 0.5 has" in notes[0]
    decks = [path.read_text() for path in sorted((tmp_path / "runs").glob("model*/deck.dat"))]
    stiff = {float(deck.split("KN=")[1].split()[0]) / 1e8 for deck in decks}
    bound = {float(deck.split("COHESION=")[1].split()[0]) / 100 for deck in decks}
    assert stiff == bound == {float(f"{contacts[0] / one:.4g}") for one in contacts}  # type: ignore[operator]


@pytest.mark.parametrize(
    "option", ["--tolerance=inf", "--tolerance=nan", "--tolerance=-1", "--tolerance=x", "--builds="]
)
def test_what_cannot_be_asked_for_is_refused(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck = tmp_path / "x.dat"
    deck.write_text(FALL)
    assert main(["trade", str(deck), option, "--out", str(tmp_path / "out")]) == 2
    assert option.partition("=")[0] in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_levers_and_laws_are_checked_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck, out = tmp_path / "x.dat", ["--out", str(tmp_path / "out")]
    deck.write_text(FALL)
    assert main(["trade", str(deck), "--levers", "", *out]) == 2
    assert main(["trade", str(deck), "--constitutive", "nosuch.py", *out]) == 1
    assert "nosuch.py cannot be read" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_tolerance_in_per_cent(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    deck = tmp_path / "x.dat"
    deck.write_text(FALL)
    asked = ["--quantity", WAY, "--builds", "i32r64", "--jobs", "0", "--out", str(tmp_path / "out")]
    assert main(["trade", str(deck), "--tolerance", "1%", *asked]) == 0
    told = capsys.readouterr().out
    assert "for a tolerance of 0.01)\n" in told
    assert sum(not line.startswith(" ") for line in told.splitlines()) == 6
    assert main(["trade", str(deck), "--tolerance", "1%", "--table", *asked]) == 0
    assert len(capsys.readouterr().out.splitlines()) > len(told.splitlines()) + 4
    assert Setting().name in {path.name for path in (tmp_path / "out" / "runs").iterdir()}


def test_a_file_of_somebody_else_is_seen_before_anything_runs(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck, out = tmp_path / "deck.dat", tmp_path / "out"
    deck.write_text(FALL)
    out.mkdir()
    (out / "deck-trade.csv").write_text("mine")
    assert main(["trade", str(deck), "--out", str(out), "--jobs", "0"]) == 1
    assert "error 31" in capsys.readouterr().err
    assert [one.name for one in out.iterdir()] == ["deck-trade.csv"]
    assert (out / "deck-trade.csv").read_text() == "mine"


def test_a_zero_has_no_share() -> None:
    assert Extrapolation(0.0, 1e-3, 1.0).is_zero
    assert Extrapolation(1e-4, 1e-3).is_zero
    assert not Extrapolation(0.0, 0.0).is_zero
    assert not Extrapolation(1.0, 1e-3).is_zero
    assert not Extrapolation(1.0, math.inf).is_zero
