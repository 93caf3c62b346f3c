"""The table of commands: its keywords are told apart, its examples are right, its reference is current."""

from pathlib import Path

import pytest

from udec_ia.deck.command_forms import Command, match, matches, required
from udec_ia.deck.command_help import explain, reference, summary
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import MESSAGES, UdecError

SHARED = {"R": "restart", "FR": "fraction"}  # the abbreviations that two commands of the report share


def abbreviations(keyword: str) -> list[str]:
    """All spellings of `keyword`, from its required letters to the whole."""
    return [keyword[:n] for n in range(len(required(keyword)), len(keyword) + 1)]


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
def test_every_abbreviation_of_a_command_means_it(command: Command) -> None:
    for typed in abbreviations(command.keyword):
        meant = match(COMMANDS, typed)
        assert meant is not None
        assert meant.name == SHARED.get(typed.upper(), command.name)
        assert match(COMMANDS, typed.lower()) is match(COMMANDS, typed.upper()) is meant


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
def test_every_abbreviation_of_a_word_means_it(command: Command) -> None:
    for word in command.words:
        for typed in abbreviations(word.keyword):
            assert match(command.words, typed) is word


@pytest.mark.parametrize(
    ("keyword", "typed", "same"),
    [
        ("PROperty", "PRO", True),
        ("PROperty", "property", True),
        ("PROperty", "PR", False),
        ("PROperty", "PROPS", False),
        ("PROperty", "PROPERTYS", False),
        ("DAmping", "DAMP", True),
        ("DAmping", "DAMPER", False),
        ("KN", "K", False),
        ("KN", "kn", True),
        ("K", "K", True),
        ("Domains", "dl", False),
        ("SPlit", "\u017fplit", False),  # a long s, which upper() would make an S
    ],
)
def test_required_and_optional_letters(keyword: str, typed: str, same: bool) -> None:
    assert matches(keyword, typed) is same


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.name)
def test_the_example_of_a_command_is_one(command: Command) -> None:
    (statement,) = statements([command.example], "example")
    assert parse(statement).command is command


def test_help_names_every_command() -> None:
    assert all(command.keyword in summary() for command in COMMANDS)


def test_help_explains_a_command_by_any_abbreviation() -> None:
    assert explain("dam").startswith("DAmping [fcrit] [freq] [Mass | Stiffness | Internal] [Local f]")
    with pytest.raises(UdecError) as caught:
        explain("DAMPENING")
    assert caught.value.number == 2
    assert caught.value.advice.startswith("did you mean DAMPING?")


def test_the_reference_is_current() -> None:
    kept = Path(__file__).parents[2] / "docs" / "commands.md"
    assert kept.read_text() == reference(), "run: python -m udec_ia.deck.command_help > docs/commands.md"


def test_the_reference_names_every_error() -> None:
    assert all(f"| {number} | {text} |" in reference() for number, text in MESSAGES.items())
