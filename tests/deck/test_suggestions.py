"""Suggestions: made only where the suggested keyword fits the spelling and the rest of the line."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from udec_ia.deck.command_forms import match
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import UdecError

# Lines as users of other programs type them: the command that they are, or the error and its suggestion.
TYPED = [
    tuple(part.strip() for part in line.split("|", 1))
    for line in (Path(__file__).parent / "typed_lines.txt").read_text().splitlines()
]


def answer(line: str) -> str:
    """The command that `line` is, or the number of the error and the keyword that it suggests."""
    (statement,) = statements([line], "typed")
    try:
        return parse(statement).command.name.upper()
    except UdecError as error:
        suggested = re.match(r"did you mean (.*)\?", error.advice)
        return f"{error.number} {suggested[1]}" if suggested else str(error.number)


@pytest.mark.parametrize(("expected", "line"), TYPED)
def test_the_answer_to_a_typed_line(expected: str, line: str) -> None:
    assert answer(line) == expected


def test_a_suggested_command_can_be_put_in_the_place_of_the_first_words() -> None:
    for expected, line in TYPED:
        if expected.startswith("2 "):
            name = expected.removeprefix("2 ")
            rest = line.split(maxsplit=1)[1] if " " in line else ""
            command = match(COMMANDS, name)
            assert command is not None
            assert answer(f"{name} {rest}") == name or answer(rest) == name


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("GRAVTY 0 -10", "2 GRAVITY"),
        ("GRAVITYY 0 -10", "2 GRAVITY"),
        ("GRAVTY", "2"),
        ("DEF F=0.5", "DEFAULT"),
        ("DEF F", "DEFAULT"),
        ("RESTRAT slope.h5", "2 RESTART"),
        ("RESTRAT slowly", "2"),
        ("HALP SPLIT", "2 HELP"),
        ("HALP ME", "2"),
        ("FIX 0 1 0 1 DENS", "10"),
        ("PLOT BLOKS", "10"),
        ("PROP MAT=1 DENSITEE=1", "10 DENSITY"),
        ("PROP MAT=1 DENSITEE=high", "10"),
    ],
)
def test_spelling_and_form_decide(line: str, expected: str) -> None:
    assert answer(line) == expected
