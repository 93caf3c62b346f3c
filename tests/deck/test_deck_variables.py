"""Variables of a deck: where values are substituted, in which scope, and what a missing value reports."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.call_recorder import Recorder

from udec_ia import Model, UdecError
from udec_ia.cli import main
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.deck_variables import Values, Variables

PILE = """START
DEFAULT F=0.5 N=3
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=$F
BLOCK 0,0 0,2 2,2 2,0
SPLIT -1,1 3,1
FIX 0,2 0,1
CYCLE $N
"""
SLIP = "PROP MAT=1 F=$F\n"


def obeyed_calls(
    deck: str, values: Values | None = None
) -> list[tuple[str, tuple[object, ...], dict[str, object]]]:
    """The calls that a deck makes, behind START."""
    model = Recorder()
    run_deck(model, "START\n" + deck, io.StringIO(), values)
    return [call for call in model.calls[1:] if call[0] not in ("stop", "summary")]


def refused(deck: str, values: Values | None = None) -> UdecError:
    with pytest.raises(UdecError) as caught:
        run_deck(Recorder(), "START\n" + deck, io.StringIO(), values, "deck.dat")
    return caught.value


@pytest.mark.parametrize(
    ("deck", "values", "friction"),
    [
        ("DEFAULT F 0.5\n" + SLIP, {}, 0.5),
        ("DEFAULT F 0.5\n" + SLIP, {"F": 0.25}, 0.25),
        ("default f=.5\n" + SLIP, {}, 0.5),
        (SLIP, {"f": "1D-1"}, 0.1),
        ("PROP MAT=1 F=${ F }\n", {"F": 1}, 1),
        ("PROP MAT=1 F=${f}5\n", {"F": "0.0"}, 0.05),
        ("PROP MAT=1 F=-$f\n", {"F": 0.5}, -0.5),
        ("PROP MAT=1\n* $G\n+ F=$F ; not $H\n", {"F": 0.5}, 0.5),
        ("PROP MAT=1 $WHAT 0.5\n", {"WHAT": "FRICTION"}, 0.5),
    ],
)
def test_values_are_put_in(deck: str, values: Values, friction: float) -> None:
    assert obeyed_calls(deck, values) == [("property", (), {"material": 1, "friction": friction})]


@pytest.mark.parametrize(
    ("line", "path"),
    [
        ("SAVE f$F.h5", "f7.h5"),
        ("SAVE f#$F.h5", "f#7.h5"),
        ("SAVE f$F.h5 # $G", "f7.h5"),
        ("SAVE 'f # $F.h5' # $G", "f # 7.h5"),
        ("SAVE = $5$.h5", "$5$.h5"),
    ],
)
def test_values_are_put_into_names_of_files(line: str, path: str) -> None:
    assert obeyed_calls(f"{line}\nFRAC $F\n", {"F": 7})[0] == ("save", (), {"path": Path("results") / path})


@pytest.mark.parametrize(
    ("deck", "values", "number", "line", "column", "advice"),
    [
        (SLIP, {}, 7, 2, 14, "give it with --set F=..., or by DEFAULT F=... before this line"),
        ("DEFAULT FF 1\n" + SLIP, {}, 7, 3, 14, "did you mean FF?"),
        (SLIP + "DEFAULT F 1\n", {}, 7, 2, 14, "give it"),
        ("PROP MAT=1\n+ F=${1}\n", {}, 10, 3, 5, "a name is a letter"),
        (SLIP, {"F": "word"}, 10, 2, 14, "the form is"),
        ("PROP MAT=$M F=$G X\n", {"M": 1, "G": 0.25}, 10, 2, 18, "the form is"),
        ("GRAVITY $A $B X\n", {"A": 123456, "B": 1}, 10, 2, 15, "the form is"),
        ("GRAVITY $LONG\n", {"LONG": 1}, 7, 2, 14, "the form is"),
        ("DEFAULT\n", {}, 7, 2, 8, "the form is"),
        ("DEFAULT F\n", {}, 7, 2, 10, "the form is"),
        ("DEFAULT $F 1\n", {}, 10, 2, 9, "write the name without $ here"),
        ("DEFAULT 5 1\n", {}, 10, 2, 9, "the form is"),
        ("DEFAULT F +x\n", {}, 10, 2, 11, "a value is a number"),
        ("DEFAULT F 1\nDEFAULT G=2 F=3\n", {}, 10, 3, 13, "HELP"),
    ],
)
def test_the_place_is_that_of_the_line_as_written(
    deck: str, values: Values, number: int, line: int, column: int, advice: str
) -> None:
    error = refused(deck, values)
    assert (error.number, error.file, error.line, error.column) == (number, "deck.dat", line, column)
    assert error.source == ("START\n" + deck).splitlines()[line - 1]
    assert advice in error.advice


@pytest.mark.parametrize(
    ("deck", "values", "detail", "advice"),
    [
        (SLIP, {"F": 1, "FX": 2}, "deck.dat has no $FX", "did you mean F?"),
        (SLIP, {"F": 1, "DAMP": 2}, "deck.dat has no $DAMP", "the variables of the deck are $F"),
        ("DEFAULT F 1\n", {"F": 2}, "deck.dat has no $F", "the deck has no variables"),
        ("STOP\n" + SLIP, {"F": 2}, "deck.dat has no $F", "the deck has no variables"),
        (SLIP, {"F": "a b"}, 'F cannot be "a b"', "a value is a number"),
        (SLIP, {"F": float("nan")}, 'F cannot be "nan"', "a value is a number"),
        (SLIP, {"F": True}, 'F cannot be "True"', "a value is a number"),
        (SLIP, {"1F": 2}, '"1F" is not the name of a variable', "a name is a letter"),
    ],
)
def test_values_that_cannot_be_given(deck: str, values: Values, detail: str, advice: str) -> None:
    error = refused(deck, values)
    assert (error.number, error.line, error.detail) == (10, None, detail)
    assert advice in error.advice


def test_variables_are_looked_at_before_the_first_command() -> None:
    model = Recorder()
    with pytest.raises(UdecError, match="7"):
        run_deck(model, "START\nCYCLE 5\n" + SLIP, io.StringIO())
    assert model.calls == []


def test_the_log_has_the_values_and_runs_alone() -> None:
    m, again = Model(), Model()
    m.run(PILE, values={"F": 0.3})
    assert "F=0.3" in m.deck()
    assert "$" not in m.deck()
    assert "DEFAULT" not in m.deck()
    again.run(m.deck())
    assert (m.h.ia == again.h.ia).all()


def test_the_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("pile.dat").write_text(PILE)
    assert main(["run", "pile.dat", "--set", "N=2", "--set", "f=0.25"]) == 0
    printed = capsys.readouterr().out
    assert "> CYCLE 2\n" in printed
    assert "F=0.25\n" in printed
    assert main(["pile.dat", "--set", "M=2"]) == 1
    assert "error 10: unrecognised parameter: pile.dat has no $M" in capsys.readouterr().err
    for wrong in (["N"], ["N=1", "--set", "n=2"]):
        assert main(["pile.dat", "--set", *wrong]) == 2
    assert main(["diverge", "pile.dat", "--other-set", "F=0.1", "--set", "N=2"]) == 1
    assert "no other difference in 2 cycles" in capsys.readouterr().out  # nothing slides there
    Path("go.txt").write_text("continue\n")
    assert main(["debug", "pile.dat", "--set", "N=2", "--commands", "go.txt"]) == 0
    assert "CYCLE 2" in capsys.readouterr().out


NUMBERS = st.integers(-9, 9).map(str) | st.floats(-1e9, 1e9).map(repr)


@given(
    st.lists(st.tuples(NUMBERS, st.booleans()), min_size=2, max_size=2), st.sampled_from([" ", ",", " = "])
)
def test_a_deck_with_variables_is_the_deck_with_their_values(
    numbers: list[tuple[str, bool]], between: str
) -> None:
    """Whether a number stands in the line or is a variable there makes no difference, and places agree."""
    names = [f"${'XY'[k]}" if variable else text for k, (text, variable) in enumerate(numbers)]
    values = {"XY"[k]: text for k, (text, variable) in enumerate(numbers) if variable}
    line, plain = between.join(["GRAVITY", *names]), between.join(["GRAVITY", *(one for one, _ in numbers)])
    assert obeyed_calls(line, values) == obeyed_calls(plain)
    one, two = refused(line + " BAD", values), refused(plain + " BAD")
    assert one.column - len(line) == two.column - len(plain)


@pytest.mark.parametrize(
    ("line", "values", "number"),
    [
        ("PROP MAT=1 KN=0.5$KN", {"KN": "1E8"}, "0.51E8"),
        ("PROP MAT=1 KN=$KN.5", {"KN": 2}, "2.5"),
        ("PROP MAT=1 KN=1E-$N", {"N": 8}, "1E-8"),
        ("PROP MAT=1 KN=1$E", {"E": "E8"}, "1E8"),
        ("CYCLE $A$B", {"A": 1, "B": 2}, "12"),
        ("PATCH FRAC=0.5$F", {"F": 1}, "0.51"),
    ],
)
def test_a_value_beside_a_number_makes_no_other_number(
    line: str, values: dict[str, int | str], number: str
) -> None:
    with pytest.raises(UdecError) as caught:
        list(Variables(values).filled(statements([line], "deck.dat")))
    error = caught.value
    assert (error.number, error.column) == (10, line.index("$") + 1)
    assert number in error.message


@pytest.mark.parametrize(
    ("line", "values", "filled"),
    [
        ("GRAVITY 0 -$G", {"G": 10}, "GRAVITY 0 -10"),
        ("SAVE run-$F.h5", {"F": 0.5}, "SAVE run-0.5.h5"),
        ("PATCH block@$N.KXD=$V", {"N": 88, "V": -1}, "PATCH block@88.KXD=-1"),
        ("SPLIT -1,$Y 7,$Y", {"Y": 2}, "SPLIT -1,2 7,2"),
        ("PLOT S$I", {"I": 11}, "PLOT S11"),
        ("PROP MAT=1 KN=${KN}e3", {"KN": 2}, "PROP MAT=1 KN=2e3"),
    ],
)
def test_a_value_may_be_part_of_a_word_or_have_a_sign(
    line: str, values: dict[str, int | float], filled: str
) -> None:
    (statement,) = Variables(values).filled(statements([line], "deck.dat"))
    assert [one.text for one in statement.lines] == [filled]
