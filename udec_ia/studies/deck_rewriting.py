"""Rewrites the user's deck for a setting: the same lines with other numbers, and the list of these changes.

Lines keep their numbers, as far as possible, so that they mean the same in both decks. Commands that only
show or save something become comments: they take as long at any setting.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import takewhile, zip_longest
from pathlib import Path
from typing import NamedTuple

from udec_ia.deck.command_forms import Kind, match
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import Statement, Token, statements
from udec_ia.deck.deck_variables import Values, Variables
from udec_ia.deck.lines_and_calls import Call, command_of, parse
from udec_ia.running.history_series import SOLVE_LIMIT
from udec_ia.studies.settings import Fraction, Numbers, Setting

SHOWS = {one.name for one in COMMANDS if one.kind is Kind.SHOWS}  # become comments
FILLED = "default"  # its values are in the lines
RUNS = {one.name for one in COMMANDS if one.kind is Kind.RUNS}
ENDS = {one.name for one in COMMANDS if one.ends}
EVERYWHERE = "-1E30 1E30 -1E30 1E30"
STIFFNESSES = ("KN", "KS", "KNMIN", "KNMAX", "KSMIN", "KSMAX")
OF_CONTACTS = ("KN", "KS", "Cohesion", "RCohesion")  # properties of one contact, however long its joint is


class Piece(NamedTuple):
    """Lines of a rewritten deck. one: their statement, None for lines added behind the line `number`."""

    one: Statement | None
    lines: list[str]
    number: int = 0


class _Change(NamedTuple):
    """longer: time-step of the deck over the new one. cycles: of a CYCLE, None as they are."""

    setting: Setting
    numbers: Numbers
    longer: float
    cycles: int | None


class Deck:
    """A deck, called `name` in errors, with values of its variables. folder: of its input files."""

    def __init__(
        self, text: str, name: str, values: Values | None = None, folder: Path | None = None
    ) -> None:
        self.text, self.name, self.folder = text, name, folder or Path()
        variables = Variables(values)
        variables.check(text.splitlines(), name)
        self.statements = [*variables.filled(statements(text.splitlines(), name))]
        self.commands = [found.name if (found := command_of(one)) else "" for one in self.statements]
        ends = [k for k, command in enumerate(self.commands) if command in ENDS]
        self.executed = ends[0] if ends else len(self.commands)  # statements before STOP
        for one in self.statements[: self.executed]:
            if one.tokens:
                parse(one)
        self._saves = "restart" in self.commands[1:]

    def has(self, *commands: str) -> bool:
        """True if one of these is in it."""
        return any(one in commands for one in self.commands[: self.executed])

    def calls(self, *commands: str) -> list[Call]:
        """Its statements of these commands, in order."""
        executed = zip(self.statements[: self.executed], self.commands, strict=False)
        return [parse(one) for one, name in executed if name in commands]

    @property
    def rests(self) -> bool:
        """True if it only seeks rest: SOLVE, and no CYCLE of more than 0."""
        return self.has("solve") and all(call.positional == [0] for call in self.calls("cycle"))

    @property
    def statics(self) -> list[bool]:
        """Of each CYCLE and SOLVE, in order: whether it is SOLVE ... STATIC, whose step is its own."""
        return [bool(call.named.get("static")) for call in self.calls(*RUNS)]

    @property
    def is_stepped(self) -> bool:
        """True if the time-step that FRACTION gives matters to a CYCLE or SOLVE."""
        return not all(self.statics)

    def pieces(
        self, setting: Setting, numbers: Numbers | None = None, fraction: Fraction | None = None
    ) -> list[Piece]:
        """The deck for `setting`, as many pieces for all settings of the same types, in the order of lines.

        fraction: that of the deck, where no line states it; None: it stays so.
        """
        numbers = numbers or Numbers()
        before_run = takewhile(lambda name: name not in RUNS, self.commands[: self.executed])
        stated = "fraction" in before_run or not self.is_stepped
        found: list[Piece] = []
        counts = dict(enumerate(zip_longest(numbers.longer, numbers.cycles)))
        run = 0  # CYCLEs and SOLVEs until here
        for k, (one, name) in enumerate(zip(self.statements, self.commands, strict=True)):
            is_executed = k < self.executed
            if is_executed and name in RUNS and run == 0 and setting.types == "sdef":
                found.append(Piece(None, [f"CHANGE {EVERYWHERE} SDEF"]))
            longer, cycles = counts.get(run, (None, None))
            change = _Change(setting, numbers, longer or 1.0, cycles)
            lines = self._lines(one, name, change) if is_executed else _unchanged(one)
            found.append(Piece(one, lines))
            if is_executed and name in ("start", "restart") and not stated and fraction is not None:
                found.append(Piece(None, [_fraction(setting, numbers, fraction)], one.lines[-1].number))
            run += name in RUNS
        return found

    def written(
        self, setting: Setting, numbers: Numbers | None = None, fraction: Fraction | None = None
    ) -> str:
        """The same as a text."""
        pieces = self.pieces(setting, numbers, fraction)
        return "".join(f"{line}\n" for piece in pieces for line in piece.lines)

    def _lines(self, one: Statement, name: str, change: _Change) -> list[str]:
        """The lines of a statement that is executed."""
        if name in SHOWS or name == FILLED or (name == "save" and not self._saves):
            return _as_comment(one)
        if name == "restart" and not self._saves:
            path = (self.folder / str(parse(one).named.get("path", "restart.h5"))).absolute()
            return _replaced(one, f'RESTART "{path}"') if path.is_file() else _unchanged(one)
        if name == "function" and "path" in (call := parse(one)).named:
            path = (self.folder / str(call.named["path"])).absolute()
            return _replaced(one, f'FUNCTION {call.positional[0]} FILE "{path}"')
        return _changed(one, name, change)


def _changed(one: Statement, name: str, change: _Change) -> list[str]:
    """The lines of a statement of the command `name` for a setting."""
    setting = change.setting
    if name == "fraction":
        call = parse(one)
        words = "".join(f" {word.upper()}" for word in ("safe", "scaled") if call.named.get(word))
        return _replaced(one, _fraction(setting, change.numbers, Fraction(call.positional[0], words)))
    if name == "cycle":
        own = parse(one).positional  # none of CYCLE TIME, which lasts as long with any step
        same = not own or change.cycles in (None, own[0])
        return _unchanged(one) if same else _replaced(one, f"CYCLE {change.cycles}")
    if name == "solve":
        return _replaced(one, _solve(one, change))
    if name == "history":
        every = max(1, round(parse(one).positional[0] * change.longer))
        return _with_texts(one, {one.tokens[1]: str(every)})
    if name == "round":
        return _multiplied(one, one.tokens[1:2], setting.rounding)
    if name == "property":
        numbers = _numbers_after(one, *(OF_CONTACTS if setting.contact != 1 else STIFFNESSES))
        return _multiplied(one, numbers, setting.contact * setting.stiffness)
    if name == "jproperty":
        if setting.contact != 1 and parse(one).named.get("unit") == "contact":
            return _multiplied(one, _numbers_after(one, *OF_CONTACTS), setting.contact)
        return _multiplied(one, _numbers_after(one, *STIFFNESSES), setting.stiffness)
    if name == "generate" and setting.edge != 1:
        return _multiplied(one, _numbers_after(one, "Edge"), setting.edge)
    makes_soft = name == "generate" or (name == "change" and parse(one).named.get("type") is not None)
    return _as_comment(one) if setting.types and makes_soft else _unchanged(one)


def _fraction(setting: Setting, numbers: Numbers, own: Fraction) -> str:
    """FRACTION. own: that of the deck."""
    value = (setting.safe or own.value * setting.step) * numbers.fit
    safe = " SAFE" if setting.safe and "SAFE" not in own.words else ""
    return f"FRACTION {value:.10g}{safe}{own.words}"


def _solve(one: Statement, change: _Change) -> str:
    call, setting = parse(one), change.setting
    limit = round(call.named.get("limit", SOLVE_LIMIT) * max(change.longer, 1.0) / min(setting.ratio, 1.0))
    static = " STATIC" if setting.static or call.named.get("static") else ""
    mean = " MEAN" if call.named.get("criterion") == "mean" else ""
    return f"SOLVE {call.positional[0] * setting.ratio:.10g} LIMIT {limit}{static}{mean}"


def _unchanged(one: Statement) -> list[str]:
    return [line.text for line in one.lines]


def _as_comment(one: Statement) -> list[str]:
    words = {token.line for token in one.tokens}
    return [f"* {line.text}" if line in words else line.text for line in one.lines]


def _replaced(one: Statement, text: str) -> list[str]:
    """`text` in the place of the first line with words of a statement, the others as comments."""
    first = one.tokens[0].line
    return [text if line == first else old for line, old in zip(one.lines, _as_comment(one), strict=True)]


def _with_texts(one: Statement, texts: dict[Token, str]) -> list[str]:
    """The lines of a statement with other texts in the place of some of its words."""
    found: list[str] = []
    for line in one.lines:
        text = line.text
        on_line = [token for token in texts if token.line == line]
        for token in sorted(on_line, key=lambda token: -token.column):
            text = text[: token.column - 1] + texts[token] + text[token.end - 1 :]
        found.append(text)
    return found


def _multiplied(one: Statement, tokens: Sequence[Token], factor: float) -> list[str]:
    """The lines of a statement with some of its numbers times a factor."""
    if factor == 1:
        return _unchanged(one)
    numbers = {token: float(token.text.upper().replace("D", "E")) for token in tokens}
    return _with_texts(one, {token: f"{value * factor:.10g}" for token, value in numbers.items()})


def _numbers_after(one: Statement, *keywords: str) -> list[Token]:
    """The numbers of keywords."""
    words = parse(one).command.words
    found = []
    for word, number in zip(one.tokens[1:], one.tokens[2:], strict=False):
        known = match(words, word.text)
        if known is not None and known.keyword in keywords:
            found.append(number)
    return found


def list_changes(deck: Deck, setting: Setting, numbers: Numbers, fraction: Fraction | None) -> list[str]:
    """--build and the lines of the user's deck to change for a setting."""
    before = deck.pieces(Setting(setting.build), None, fraction)
    after = deck.pieces(setting, numbers, fraction)
    found = [f"--build {setting.build}"]
    own = deck.text.splitlines()
    for old, new in zip(before, after, strict=True):
        if old.lines == new.lines:
            continue
        if new.one is None:
            found += [f"after line {new.number}: {line}" for line in new.lines]
            continue
        for line, text in zip(new.one.lines, new.lines, strict=True):
            if text != line.text:
                found.append(f"line {line.number}: {own[line.number - 1].strip()} -> {text.strip()}")
    return found
