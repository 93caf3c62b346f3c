"""A command as a method of Python and as a line of a deck makes the same words."""

from __future__ import annotations

import inspect
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from udec_ia.deck.calls_as_lines import BY_NAME, spell
from udec_ia.deck.command_forms import SEVERAL, Command, Word
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import statements
from udec_ia.deck.lines_and_calls import parse
from udec_ia.errors import UdecError
from udec_ia.layout.offsets import MFREE
from udec_ia.model import Model

REALS = st.floats(allow_nan=False, allow_infinity=False, width=64)
TEXTS = st.lists(st.from_regex(r"[a-z@(.)0-9]+ = [0-9.]+", fullmatch=True), min_size=1).map(", ".join)

FILES = st.from_regex(r"[a-z/]+( [a-z,;=#]+)*[.]csv", fullmatch=True)


def number(name: str) -> st.SearchStrategy[Any]:
    """A number of the kind that its name tells."""
    return st.integers(-(10**9), 10**9) if name.strip("[]")[0] in "ijklmn" else REALS


def tuples(names: str) -> st.SearchStrategy[Any]:
    return st.tuples(*map(number, names.split()))


def value(word: Word) -> st.SearchStrategy[Any]:
    """What a word may set its argument to."""
    if word.text:
        return FILES
    if word.repeated:
        return st.lists(tuples(word.values), min_size=1, max_size=9)
    if word.values:
        return tuples(word.values) if len(word.values.split()) > 1 else number(word.values)
    return st.just(word.keyword.lower() if word.sets else True)


@st.composite
def calls(draw: st.DrawFn, command: Command) -> tuple[list[Any], dict[str, Any]]:
    """Arguments that the parser may make for a command."""
    names = command.numbers.split() + command.optional.split()
    replaced = [word for word in command.words if word.replaces and draw(st.booleans())]
    positional = [draw(number(name)) for name in names if command.list or not replaced]
    if replaced:
        words = {word.argument: draw(value(word)) for word in replaced}
        return positional, words
    if command.list:
        positional += [
            n for row in draw(st.lists(tuples(command.list), min_size=1, max_size=30)) for n in row
        ]
    words = {command.text: draw(TEXTS)} if command.text else {}
    for word in draw(st.permutations([word for word in command.words if not word.replaces])):
        if word.argument == SEVERAL:
            positional.append(word.keyword.lower())
        elif word.argument not in words and (word.argument == command.first or draw(st.booleans())):
            words[word.argument] = draw(value(word))
    return positional, words


def plain(method: Any, positional: list[Any], named: dict[str, Any]) -> dict[str, Any]:
    """The arguments by name, those left off as the method has them, and numbers as equal ones."""
    bound = inspect.signature(method).bind(None, *positional, **named)
    bound.apply_defaults()
    return {name: flat(one) for name, one in bound.arguments.items()}


def flat(one: Any) -> Any:
    return (
        np.asarray(one, float).ravel().tolist()
        if isinstance(one, list | tuple) and one and not isinstance(one[0], str)
        else one
    )


@pytest.mark.parametrize("command", BY_NAME.values(), ids=BY_NAME)
@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_a_call_that_is_spelt_is_read_as_the_same_call(command: Command, data: st.DataObject) -> None:
    """Whatever its numbers and words; and every line is short, but for a text that cannot be cut."""
    method = getattr(Model, command.name)
    positional, named = data.draw(calls(command))
    lines = spell(method, positional, named)
    is_whole = command.text or any(word.text and word.argument in named for word in command.words)
    assert is_whole or max(map(len, lines)) <= 79
    (statement,) = [one for one in statements(iter([*lines, ""]), "spelt") if one.tokens]
    call = parse(statement)
    assert call.command is command
    assert plain(method, call.positional, call.named) == plain(method, positional, named)


def test_all_commands_are_said_but_those_on_files_and_the_session() -> None:
    assert {command.name for command in COMMANDS} - set(BY_NAME) == {
        "save",
        "restart",
        "stop",
        "end",
        "help",
        "default",
        "call",
        "stage",
    }
    assert spell(Model.balance, (), {}) == []


def session(folder: Path) -> Model:
    """Blocks of all types, made and run in Python; one command is refused, one is a line of a deck."""
    m = Model(out=folder)
    m.block(0, 0, 0, 4, 1, 4, 1, 0)
    m.split(-1, 1, 2, y2=1)
    m.split(-1, 2, 2, 2)
    m.property(material=1, density=2000, kn=1e8, ks=np.float64(1e8), friction=0.1 + 0.2, bulk=1e9, g=5e8)
    m.fix(0, 1, 0, 1)
    m.gravity(0, -10)
    m.change(0, 1, 1, 2, type="fdef")
    m.generate(0, 1, 1, 2, "manual", [(0, 1), (0, 2), (1, 2), (1, 1)], zones=[(1, 2, 3), (1, 3, 4)])
    m.boundary(-1, 2, 2.9, 3.1, yforce=-5, sine=(1.0, 2))
    with pytest.raises(UdecError):
        m.split(0, 0, 0, 0)
    m.damping(0.1, 5, only="mass")
    m.energy()
    m.history(10, "KYD", at=(0.5, 3))
    for _ in range(5):
        m.cycle(np.int64(10))
    m.save(folder / "half")
    m.run("* a remark\nGRAVITY 1 -10 ; to the right\nCYCLE 7\nCYCLE 3\n")
    m.solve(1e-3, limit=50)
    m.print("blocks", "contacts")
    return m


def words(model: Model) -> bytes:
    h = model.array.h
    return b"".join(part.tobytes() for part in (h.ia[: int(h.ci[MFREE]) - 1], h.cr, h.cd))


def test_the_deck_of_a_session_makes_the_same_words(tmp_path: Path) -> None:
    """And of a model that was saved and restored, and of a deck itself."""
    first = session(tmp_path)
    deck = first.deck()
    assert "CYCLE 50\n" in deck
    assert "CYCLE 7\nCYCLE 3\n" in deck  # as they stand in the deck
    assert "SPLIT 0" not in deck
    second = Model(out=tmp_path / "again")
    second.run(deck)
    assert words(second) == words(first)
    assert second.deck() == deck
    restored = Model.restore(first.save(tmp_path / "end"))
    assert restored.deck() == deck
    restored.free(0, 1, 0, 1)
    assert restored.deck() == deck + "FREE 0 1 0 1\n"


def test_a_run_that_was_ended_is_said_as_long_as_it_was(tmp_path: Path) -> None:
    m = session(tmp_path)

    def full(text: str) -> None:
        raise MemoryError(text)

    before, m.inform, m.explain_step = m.deck(), full, True
    with pytest.raises(MemoryError):
        m.cycle(5)
    assert m.deck() == before
    m.inform, m.explain_step = lambda text: None, False
    m.boundary(-1, 2, 2.9, 3.1, yvel=-1e6)
    with pytest.raises(UdecError, match="error 15"):
        m.cycle(1000)
    last = m.deck().splitlines()[-1]
    assert last.startswith("CYCLE ")
    assert 0 < int(last.split()[1]) < 1000
    second = Model(out=tmp_path / "again")
    with pytest.raises(UdecError, match="error 15"):
        second.run(m.deck())


def test_what_was_given_may_be_changed_afterwards() -> None:
    """The deck says what it was; and that of many CYCLEs is one line."""
    m = Model()
    m.block(0, 0, 0, 4, 1, 4, 1, 0)
    m.change(0, 1, 0, 4, type="fdef")
    points, zones = [[0.0, 0.0], [0.0, 4.0], [1.0, 4.0], [1.0, 0.0]], [[1, 2, 3], [1, 3, 4]]
    m.generate(0, 1, 0, 4, "manual", gridpoints=points, zones=zones)
    points[0][0] = 17.0
    m.property(1, density=1, bulk=1, g=1)
    for _ in range(3):
        m.cycle(n=2)
    lines = m.session.log.lines
    assert lines[3:] == [
        "GENERATE 0 1 0 4 MANUAL GRIDPOINTS 0,0 0,4 1,4 1,0 ZONES 1,2,3 1,3,4",
        "PROPERTY MATERIAL 1 BULK 1 DENSITY 1 G 1",
        "CYCLE 6",
    ]
    m.gravity(0, 0)
    m.cycle(0)
    assert m.session.log.lines == [*lines, "GRAVITY 0 0", "CYCLE 0"]
