"""Words that are given other values under the debugger: the run goes on as one of a deck with PATCH in it."""

from __future__ import annotations

import io
import re
from pathlib import Path

import pytest
from support.debugger_decks import PILE

from udec_ia import Model
from udec_ia.debug import debug
from udec_ia.layout import offsets as g

CHANGE = "FRAC = 0.07, GRAVX = 2"


def debugged(out: Path, *lines: str, deck: str = PILE) -> tuple[Model, str]:
    """The model after some commands, and what was printed."""
    model, output = Model(out=out), io.StringIO()
    debug(model, deck, output, lines)
    return model, output.getvalue()


def same(one: Model, two: Model) -> bool:
    """All words in use and the common block, but for NCYC: a run that goes on is one CYCLE more."""
    words = []
    for h in (one.array.h, two.array.h):
        counts = h.ci.copy()
        counts[g.NCYC] = 0
        words.append([part.tobytes() for part in (h.ia[: int(h.ci[g.MFREE]) - 1], counts, h.cr, h.cd)])
    return words[0] == words[1]


@pytest.mark.parametrize("at", [100, 101, 419])
def test_a_run_goes_on_with_it(tmp_path: Path, at: int) -> None:
    """As the deck would with the CYCLE cut in two; and where one goes back and patches once more."""
    plain = Model(out=tmp_path)
    plain.run(
        PILE.replace("CYCLE 360", f"CYCLE {at - 60}\nPATCH {CHANGE}\nCYCLE {420 - at}").replace("STOP\n", "")
    )
    model, output = debugged(tmp_path, f"goto {at}", f"patch {CHANGE}", "continue", "quit")
    assert "the deck has ended" in output
    assert same(model, plain)
    assert model.session.log.lines[:-1] == plain.session.log.lines
    again, _ = debugged(
        tmp_path,
        *[f"goto {at}", "patch GRAVY = -1", "step 5", "reverse-step 6", "resume", f"patch {CHANGE}"],
        *["step 9", "reverse-step 3", "resume", "continue", "quit"],
    )
    assert same(again, plain)


def test_it_is_an_event_like_others(tmp_path: Path) -> None:
    _, output = debugged(
        tmp_path,
        *["goto 100", "patch GRAVX = 2", "print GRAVX", "step 4", "reverse-continue GRAVX", "wrote GRAVX"],
        *["reverse-step", "print GRAVX", "goto 102", "print GRAVX", "quit"],
    )
    assert re.findall(r"^GRAVX = (\S+)", output, re.M) == ["2.0", "0.0", "2.0"]
    assert "after line 14: PATCH GRAVX = 2" in output


@pytest.mark.parametrize(
    ("asked", "told"),
    [
        ("block@88.KXYZ = 3", "KXYZ"),
        ("FRAC", "="),
        ("NBLK = 99", "error 28"),
        ("", "patch"),
    ],
)
def test_what_cannot_be_is_told_and_nothing_happens(tmp_path: Path, asked: str, told: str) -> None:
    model, output = debugged(tmp_path, "goto 100", f"patch {asked}", "continue", "quit")
    assert told in output
    plain = Model(out=tmp_path)
    plain.run(PILE.replace("STOP\n", ""))
    assert same(model, plain)


def test_the_past_is_not_patched(tmp_path: Path) -> None:
    _, output = debugged(tmp_path, "goto 100", "reverse-step 3", "patch GRAVX = 2", "print GRAVX", "quit")
    assert "the past cannot be changed" in output
    assert "GRAVX = 0.0" in output


def test_after_the_first_command_within_a_solve_and_after_the_last(tmp_path: Path) -> None:
    deck = PILE.replace("CYCLE 360", "SOLVE 1E-3 LIMIT 200")
    model, output = debugged(
        tmp_path,
        *[
            "patch FRAC = 0.05",
            "step 1",
            "patch FRAC = 0.05",
            "goto 100",
            "patch GRAVX = 2",
            "continue",
            "patch GRAVX = 1",
            "print GRAVX",
        ],
        *["continue", "quit"],
        deck=deck,
    )
    assert "the deck has not begun" in output
    assert re.findall(r"^GRAVX = (\S+)", output, re.M)[-1] == "1.0"
    log = [line.split()[0] for line in model.session.log.lines]
    assert log.count("PATCH") == 3
    assert log[log.index("SOLVE") - 2 : log.index("SOLVE") + 1] == ["CYCLE", "PATCH", "SOLVE"]
