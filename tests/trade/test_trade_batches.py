"""Settings run in batches, so that what they really take keeps to the budget."""

from __future__ import annotations

from pathlib import Path

import pytest

from udec_ia.study.runs import ENDED, Result
from udec_ia.trade.batches import batch, foresee, hopeless
from udec_ia.trade.cost import Rates, cycles_of
from udec_ia.trade.deck import Deck
from udec_ia.trade.digits import measure
from udec_ia.trade.judge import Row
from udec_ia.trade.levers import Numbers, Setting
from udec_ia.trade.report import sentences
from udec_ia.trade.shop import Options, Shop
from udec_ia.trade.surveyed import Segment, Surveyed
from udec_ia.trade.trade import trade

LAST = "SOLVE 0.0001 NOT REACHED (0.009)"
WARNING = "the last digit of coordinates, 2e-06 m with 32-bit reals, is a force of ..."
FINE = (  # a slice that 32-bit reals are too short for
    "START\nPROP MAT=1 DENS=2000 KN=1E11 KS=1E11 FRICTION=0.5\nBLOCK 0 0 0 4 60 4 60 0\nSPLIT -1 1 61 1\n"
    "SPLIT 10 -1 10 5\nSPLIT 10.05 -1 10.05 5\nROUND 0.01\nFIX 0 60 0 1\nGRAVITY 0 -9.81\nCYCLE 20\n"
)
ASKED = ("way = mean block.DISPLACEMENT",)


def row(setting: Setting, predicted: float, seconds: float = 0.0, message: str = "") -> Row:
    result = Result("", {}, ENDED, message=message, seconds=seconds, warnings=(WARNING,)) if seconds else None
    return Row(setting, Numbers(), predicted, result)


def test_a_word_scheme_that_has_not_run_begins_with_one_run() -> None:
    ahead = [row(Setting("i32r32", step), 3 / step) for step in (1, 2, 3)]
    ahead += [row(Setting("i32r32", static=True), 4.0), row(Setting("i32r64"), 0.1)]
    assert batch(ahead, "i32r32", 5.0, 1, tried=False) == [ahead[3]]  # STATIC first
    assert batch(ahead, "i32r32", 5.5, 1, tried=True) == [ahead[3], ahead[2]]
    assert batch(ahead, "i32r32", 0.1, 2, tried=True) == [ahead[3], ahead[2]]  # one for each process
    assert len(batch(ahead, "i32r32", 60.0, 1, tried=False)) == 4  # they are cheap


def test_what_takes_longer_is_predicted_anew() -> None:
    ahead = [row(Setting("i32r32"), 2.0), row(Setting("i32r64"), 2.0)]
    foresee(ahead, [row(Setting("i32r32", 2.0), 1.0, 1.5)])
    assert [one.predicted for one in ahead] == [2.0, 2.0]
    foresee(ahead, [row(Setting("i32r32", 2.0), 1.0, 4.0)])
    assert [one.predicted for one in ahead] == [8.0, 2.0]


def test_words_that_allow_no_smaller_ratio_are_not_tried_again() -> None:
    ahead = [row(Setting("i32r32", ratio=ratio), 1.0) for ratio in (10.0, 1.0, 0.1)]
    ahead.append(row(Setting("i32r64"), 1.0))
    done = [row(Setting("i32r32", static=True), 1.0, 5.0, LAST)]
    alike, why = hopeless(ahead, done, "")
    assert alike == ahead[1:3]
    assert why.startswith(f"i32r32,static ends with {LAST}")
    assert hopeless(ahead, done, LAST) == ([], "")


class Slow(Shop):
    """Every run takes ten times what was predicted."""

    def results(self, runs: list[Surveyed]) -> list[Result]:
        """See Shop."""
        if self.surveyed is None or len(self.survey) == 0:
            return super().results(runs)
        message = LAST if runs[0].build == "i32r32" else ""
        return [
            Result(run.name, {}, ENDED, message=message, seconds=10.0, warnings=(WARNING,)) for run in runs
        ]


@pytest.fixture
def slow(tmp_path: Path) -> Slow:
    text = "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0 0 0 1 1 1 1 0\nGRAVITY 0 -10\nCYCLE 9\n"
    shop = Slow(Deck(text, "x.dat"), Options(ASKED, budget=40.0, jobs=0), tmp_path)
    shop.look()
    shop.rates = {build: Rates(0.0, (0.1,)) for build in shop.builds}
    return shop


def test_a_budget_is_overrun_by_one_batch_at_most(slow: Slow) -> None:
    rows = [row(Setting("i32r64", step), 1.0) for step in range(1, 21)]
    dropped = slow.do(rows)
    ran = [one for one in rows if one.result]
    assert len(ran) + len(dropped) == 20
    assert len(ran) * 10 <= 40 + 2 * 10  # two of them are a batch
    assert all(not one.why for one in dropped)


def test_what_cannot_come_to_rest_is_said_and_not_run(slow: Slow) -> None:
    rows = [row(Setting("i32r32", step), 1.9 + step / 10) for step in range(1, 6)]
    slow.do(rows)
    assert [one.result is not None for one in rows] == [True, False, False, False, False]
    assert "its reals allow no smaller ratio; not run: i32r32,step=2" in slow.said[0]
    assert all(LAST in one.why for one in rows[1:])


def test_static_is_expected_to_take_fewer_cycles() -> None:
    solve, safe = (Segment(0, True, 0, 1, 0.1, safe, 1, 1, done=2100) for safe in (False, True))
    found = cycles_of([solve, safe], Numbers(1, (None, None), (1, 1)), Setting(static=True))
    assert found == pytest.approx([600, 1000])


def test_words_that_cannot_run_a_deck_are_left_out(tmp_path: Path) -> None:
    price = trade(FINE, "x.dat", {}, tmp_path / "a", Options(ASKED, jobs=0))
    assert {one.setting.build for one in price.rows} == {"i32r64"}
    assert any(
        "i32r32 is left out, as it cannot run the deck: x.dat:6:1: error 27" in one
        for one in sentences(price)
    )
    found = measure(FINE, "x.dat", {}, tmp_path / "b", Options(ASKED, jobs=0), 3)
    assert any("i32r32 is left out" in one for one in found.said)
    ((_, value, own, _, short, _, step, why),) = found.rows()
    assert isinstance(own, float)
    assert (short, value != "", isinstance(step, float)) == ("", True, True)
    assert "as no run has shorter reals" in str(why)
