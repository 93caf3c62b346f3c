"""Decks that are wrong in one place each: the numbered errors, raised where the deck itself says.

The first line of a deck says what to expect: `* expect LINE:COLUMN error NUMBER`, and `with mtop=N` where
the size of the main array matters, `without PACKAGE` where a package must be missing.
"""

import io
import re
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

from udec_ia import Model, UdecError
from udec_ia.deck.command_monitor import run_deck
from udec_ia.errors import DAMAGED

DECKS = sorted((Path(__file__).parents[1] / "decks").glob("err*.dat"))
EXPECT = re.compile(r"\* expect (\d+):(\d+) error (\d+)(?: with mtop=(\d+))?(?: without (\w+))?")
NOTHING_TO_SAVE = {"err02-nothing-to-continue", "err03", "err29"}  # not started
OF_1980 = {*range(1, 27)} - {17, 21}  # those of 1980; SPLIT and DELETE take fully-deformable blocks


class Expected(NamedTuple):
    line: int
    column: int
    number: int
    mtop: int | None
    missing: str | None


def expected(deck: Path) -> Expected:
    found = EXPECT.fullmatch(deck.read_text().split("\n", 1)[0])
    assert found is not None, f"{deck.name} does not say what to expect"
    line, column, number, mtop, missing = found.groups()
    return Expected(int(line), int(column), int(number), int(mtop) if mtop else None, missing)


def test_there_is_a_deck_for_every_error() -> None:
    assert {expected(deck).number for deck in DECKS} >= OF_1980


@pytest.mark.parametrize("deck", DECKS, ids=lambda deck: deck.stem)
def test_a_wrong_deck_ends_in_its_error(deck: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = expected(deck)
    if wanted.missing:
        monkeypatch.setitem(sys.modules, wanted.missing, None)
    model = Model(mtop=wanted.mtop, out=tmp_path)
    with pytest.raises(UdecError) as caught:
        run_deck(model, deck, io.StringIO())
    error = caught.value
    assert (error.number, error.line, error.column) == (wanted.number, wanted.line, wanted.column)
    place, source, caret, *advice = str(error).split("\n")
    assert place.startswith(f"{deck}:{wanted.line}:{wanted.column}: error {wanted.number}: ")
    assert source == "    " + deck.read_text().split("\n")[wanted.line - 1]
    assert caret.index("^") == 4 + wanted.column - 1
    assert advice[0]
    if deck.stem in NOTHING_TO_SAVE:
        assert error.saved is None
    else:
        assert error.saved is not None
        damaged = error.number == DAMAGED
        assert Model.restore(error.saved, force=damaged).session.log.lines == model.session.log.lines
