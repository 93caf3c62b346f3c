"""What a price list says beside its numbers: of quantities without a limit, of SOLVE, and of samples."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from udec_ia.cli import main
from udec_ia.trade.deck import Deck
from udec_ia.trade.judge import tells
from udec_ia.trade.levers import Setting
from udec_ia.trade.limit import Limit
from udec_ia.trade.model import COLUMNS, refine
from udec_ia.trade.report import half_step, sentences, shown
from udec_ia.trade.shop import Options, Shop
from udec_ia.trade.trade import Price, trade

HEAD = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 FRICTION=0.5\n"
FALL = f"{HEAD}BLOCK 0 0 0 1 1 1 1 0\nGRAVITY 0 -10\nHISTORY 50 KINETIC\nCYCLE 120\n"
WAY, FORCE = "way = block(0.5, 0.5).YDISPLACEMENT", "force = sum contact.KCFN"
MESHED = (
    f"{HEAD.replace('FRICTION', 'BULK=1E8 G=1E8 COHESION=100 FRICTION')}BLOCK 0 0 0 2 1 2 1 0\n"
    "SPLIT -1 1 2 1\nFIX 0 1 0 1\nROUND 0.05\nGEN 0 1 1 2 AUTO EDGE 0.5\nGRAVITY 0 -10\nCYCLE 5\n"
)


def priced(text: str, folder: Path, *quantities: str, **named: object) -> Price:
    options = Options(quantities, builds=("i32r64",), jobs=0, **named)  # type: ignore[arg-type]
    return trade(text, "x.dat", {}, folder, options)


def test_what_is_the_same_at_all_steps_recommends_nothing_alone(tmp_path: Path) -> None:
    price = priced(FALL, tmp_path, WAY, FORCE, tolerance=1e-14)
    told = sentences(price)
    assert price.best is None
    assert "way: converges to" in told[0]
    assert "too little for a tolerance of 1e-14" in told[0]
    assert told[1] == "force: 0, the same at all these steps"
    assert told[-1].startswith("no recommendation: way has no limit that is known well enough")
    assert "force is the same at all of them" in told[-1]
    assert not any("within" in str(row[-1]) for row in shown(price))
    (said,) = sentences(replace(price, levels=price.levels[:1], parted=None, rows=price.rows[:1]))
    assert said.startswith("no recommendation: no run with half the time-step has ended")


def test_a_recommendation_says_what_it_does_not_hold_for(tmp_path: Path) -> None:
    price = priced(FALL, tmp_path, WAY, FORCE, "cycles", tolerance=1e-2)
    (line,) = [one for one in sentences(price) if one.startswith("recommended")]
    assert "holds for way and force only: cycles has no limit that is known well enough" in line


def test_which_quantities_are_enough_to_choose_by() -> None:
    same, moves = Limit(0.0, 0.0), Limit(1.0, 1e-6, 1.0)
    assert tells({"a": moves}, ["a"])
    assert tells({"a": moves, "b": None}, ["a"])
    assert not tells({"a": same}, ["a"])
    assert not tells({"a": same, "b": None}, ["a"])
    assert not tells({"a": moves}, [])


def test_what_solve_says_stands_beside_the_recommendation(tmp_path: Path) -> None:
    text = (
        f"{HEAD}BLOCK 0 0 0 3 3 3 3 0\nSPLIT -1 1 4 1\nROUND 0.1\nFIX 0 3 0 1\nGRAVITY 0 -10\n"
        "DAMP 0.5 10 MASS\nSOLVE 1E-2 LIMIT 100\n"
    )
    price = priced(text, tmp_path, "force = max contact.KCFN", tolerance=0.9)
    assert "NOT REACHED" in price.solved
    (said,) = [one for one in sentences(price) if "SOLVE says in the deck as it is" in one]
    assert price.solved in said
    slipped = replace(price, solved="SOLVE 0.01 reached, but: joints slipped")
    (said,) = [one for one in sentences(slipped) if "joints have slipped" in one]
    assert "another way may differ by more" in said


def test_samples_may_be_what_differs(tmp_path: Path) -> None:
    price = priced(FALL, tmp_path / "a", "top = max history 1", half_step=True)
    assert price.sampled == {"top": 50}
    (said,) = half_step(price)
    assert "ITS SAMPLES, every 50 cycles" in said
    assert "HISTORY 1 before a smaller FRACTION" in said
    assert "TOO LARGE" not in said
    every = priced(
        FALL.replace("HISTORY 50", "HISTORY 1"), tmp_path / "b", "top = max history 1", half_step=True
    )
    assert every.sampled == {}
    assert "TOO LARGE" in half_step(every)[0]
    price = priced(FALL, tmp_path / "a", "top = last history 1", tolerance=1e-14)
    assert "its samples, every 50 cycles, may be what differs" in sentences(price)[0]


def test_finer_zones_leave_joints_as_stiff_as_they_are(tmp_path: Path) -> None:
    shop = Shop(Deck(MESHED, "x.dat"), Options((FORCE,), jobs=0), tmp_path)
    shop.look()
    said, rows = refine(shop, "zones")
    contacts = [row[COLUMNS.index("contacts")] for row in rows]
    assert contacts == sorted({*contacts})  # type: ignore[type-var]
    assert "EDGE times 0.5 has" in said[0]
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


def test_levers_and_laws_are_looked_at_before_anything_runs(
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
    assert "recommended for 0.01" in capsys.readouterr().out
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
