"""How a statement of a deck is written for a setting: the same lines, with other numbers in them.

A statement keeps the number of its lines, so that numbers of lines mean the same in both decks.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from udec_ia.deck.command_forms import match
from udec_ia.deck.deck_statements import Line, Statement, Token
from udec_ia.deck.lines_and_calls import parse
from udec_ia.trade.levers import Fraction, Numbers, Setting

LIMIT = 100_000  # of SOLVE if none is given
EVERYWHERE = "-1E30 1E30 -1E30 1E30"
OF_CONTACTS = ("KN", "KS", "Cohesion", "RCohesion")  # properties of one contact, however long its joint is


class Piece(NamedTuple):
    """Some lines as they are written. one: the statement that they are, None for lines that are put in.

    number: of the first line that holds a word of it, or of the line that lines are put in behind.
    """

    one: Statement | None
    number: int
    lines: list[str]


@dataclass(frozen=True)
class Place:
    """Where a statement stands. longer: time-step of the deck over the new one there. cycles: of a CYCLE.

    last: limit of a SOLVE; None for both: as they are.
    """

    longer: float = 1.0
    cycles: int | None = None
    last: int | None = None


def written(pieces: Iterable[Piece]) -> str:
    """The text of a deck in pieces."""
    return "".join(f"{line}\n" for piece in pieces for line in piece.lines)


def place(numbers: Numbers, run: int) -> Place:
    """Of a statement with so many CYCLEs and SOLVEs before it."""
    return Place(
        numbers.longer[run] if run < len(numbers.longer) else 1.0,
        numbers.cycles[run] if run < len(numbers.cycles) else None,
        numbers.limits[run] if run < len(numbers.limits) else None,
    )


def changed(one: Statement, name: str, setting: Setting, numbers: Numbers, at: Place) -> list[str]:
    """The lines of a statement of the command `name` for a setting."""
    if name == "fraction":
        call = parse(one)
        words = "".join(f" {word.upper()}" for word in ("safe", "scaled") if call.named.get(word))
        return instead(one, fraction(setting, numbers, Fraction(call.positional[0], words)))
    if name == "cycle":
        same = at.cycles in (None, parse(one).positional[0])
        return as_it_is(one) if same else instead(one, f"CYCLE {at.cycles}")
    if name == "solve":
        return instead(one, _solve(one, setting, at))
    if name == "history":
        every = max(1, round(parse(one).positional[0] * at.longer))
        return _put(one, {one.tokens[1]: str(every)})
    if name == "round":
        return _times(one, one.tokens[1:2], setting.rounding)
    if name == "property":
        return _property(one, setting)
    if name == "generate" and setting.edge != 1:
        return _times(one, _after(one, "Edge"), setting.edge)
    if setting.types and _makes_soft(one, name):
        return left_out(one)
    return as_it_is(one)


def as_it_is(one: Statement) -> list[str]:
    """The lines of a statement."""
    return [line.text for line in one.lines]


def left_out(one: Statement) -> list[str]:
    """The lines of a statement as comments."""
    words = {token.line for token in one.tokens}
    return [f"* {line.text}" if line in words else line.text for line in one.lines]


def instead(one: Statement, text: str) -> list[str]:
    """The lines of a statement, `text` in the place of the first with its words, the others as comments."""
    first = one.tokens[0].line
    return [text if line == first else old for line, old in zip(one.lines, left_out(one), strict=True)]


def fraction(setting: Setting, numbers: Numbers, own: Fraction) -> str:
    """FRACTION. own: what the deck has."""
    value = (setting.safe or own.value * setting.step) * numbers.fit
    safe = " SAFE" if setting.safe and "SAFE" not in own.words else ""
    return f"FRACTION {value:.10g}{safe}{own.words}"


def types(setting: Setting) -> list[str]:
    """What makes the blocks of a deck other ones, before its first cycle."""
    return [f"CHANGE {EVERYWHERE} {setting.types.upper()}"] if setting.types == "sdef" else []


def _solve(one: Statement, setting: Setting, at: Place) -> str:
    call = parse(one)
    limit = round(call.named.get("limit", LIMIT) * max(at.longer, 1.0) / min(setting.ratio, 1.0))
    limit = min(limit, at.last or limit)
    static = " STATIC" if setting.static or call.named.get("static") else ""
    mean = " MEAN" if call.named.get("criterion") == "mean" else ""
    return f"SOLVE {call.positional[0] * setting.ratio:.10g} LIMIT {limit}{static}{mean}"


def _property(one: Statement, setting: Setting) -> list[str]:
    if setting.contact != 1:
        return _times(one, _after(one, *OF_CONTACTS), setting.contact)
    return _times(one, _after(one, "KN", "KS"), setting.stiffness)


def _makes_soft(one: Statement, name: str) -> bool:
    return name == "generate" or (name == "change" and parse(one).named.get("type") is not None)


def _put(one: Statement, texts: dict[Token, str]) -> list[str]:
    """The lines of a statement with other texts in the place of some of its words."""
    found: list[str] = []
    for line in one.lines:
        text = line.text
        for token in sorted(_on(texts, line), key=lambda token: -token.column):
            text = text[: token.column - 1] + texts[token] + text[token.end - 1 :]
        found.append(text)
    return found


def _on(tokens: dict[Token, str], line: Line) -> list[Token]:
    return [token for token in tokens if token.line == line]


def _times(one: Statement, tokens: Sequence[Token], factor: float) -> list[str]:
    """The lines of a statement with some of its numbers times a factor."""
    if factor == 1:
        return as_it_is(one)
    numbers = {token: float(token.text.upper().replace("D", "E")) for token in tokens}
    return _put(one, {token: f"{value * factor:.10g}" for token, value in numbers.items()})


def _after(one: Statement, *keywords: str) -> list[Token]:
    """The numbers of keywords."""
    words = parse(one).command.words
    found = []
    for word, number in zip(one.tokens[1:], one.tokens[2:], strict=False):
        known = match(words, word.text)
        if known is not None and known.keyword in keywords:
            found.append(number)
    return found
