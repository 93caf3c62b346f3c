"""Variables of a deck, `$F` and `${F}`, and arithmetic in braces, `{$KN/2}`.

DEFAULT gives a variable a value, unless a value is given with the deck. Values replace variables before a
line is read as a command. So the log has values only, but an error points at the line with its variables.

A value is a number or a word. In comments, and without a name behind it, a `$` has no meaning.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from udec_ia.deck.arithmetic import calculate
from udec_ia.deck.command_forms import Command
from udec_ia.deck.deck_statements import (
    Line,
    Put,
    Statement,
    Token,
    at,
    quoted,
    statements,
    tokens,
    tokens_of,
    without_comment,
)
from udec_ia.deck.keyword_suggestions import with_suggestion
from udec_ia.deck.lines_and_calls import APART, NUMBER, QUOTED, command_of
from udec_ia.errors import UdecError

Value = int | float | str
Values = Mapping[str, Value]
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
USE = re.compile(rf"\$(?:\{{([^}}]*)\}}|({NAME.pattern}))")
CALCULATED = re.compile(
    rf"\$\{{[^}}]*\}}|\${NAME.pattern}|\{{((?:\$\{{[^}}]*\}}|[^{{}}])*)\}}"
)  # a use, or braces
PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,99}")  # a value that is no number
FORM = "the form is: DEFault name value ..., as in DEFAULT F=0.5"
IS_NAME = "a name is a letter, then letters, digits and _"
IS_VALUE = "a value is a number, or a word of letters, digits, _ . and -"


def spelt(name: str, value: object) -> str:
    """The value of a variable as text in a deck. Raises UdecError 10 for an unsuitable value."""
    if isinstance(value, str) and (NUMBER.fullmatch(value) or PLAIN.fullmatch(value)):
        return value
    if isinstance(value, int | np.integer) and not isinstance(value, bool):
        return str(int(value))
    if isinstance(value, float | np.floating) and math.isfinite(value):
        return repr(float(value))
    raise UdecError(10, f"{name} cannot be {quoted(str(value))}", IS_VALUE)


class Variables:
    """The variables of one deck. given: values that replace those of DEFAULT, by name in any case.

    used: names of the variables in the lines so far, in order. Raises UdecError 10 for unsuitable `given`.
    """

    def __init__(self, given: Values | None = None) -> None:
        for name in given or {}:
            if not NAME.fullmatch(name):
                raise UdecError(10, f"{quoted(name)} is not the name of a variable", IS_NAME)
        self.given = {name.upper(): spelt(name.upper(), value) for name, value in (given or {}).items()}
        self.defaults: dict[str, tuple[str, Token]] = {}
        self.used: dict[str, None] = {}

    def fill(self, statement: Statement) -> Statement:
        """`statement` with values for its variables; the values of a DEFAULT are stored.

        Raises UdecError 7 for a variable without a value, 10 for a wrong DEFAULT.
        """
        command = command_of(statement)
        if command is not None and command.name == "default":
            self._set_defaults(statement)
            return statement
        lines = [self._filled(line, command) for line in statement.lines]
        return Statement(lines, tokens_of(lines)) if lines != statement.lines else statement

    def filled(self, deck: Iterable[Statement]) -> Iterator[Statement]:
        """All statements of a deck with their values."""
        return map(self.fill, deck)

    def check(self, lines: Iterable[str], file: str) -> None:
        """Error 7 or 10 for a fault of the variables anywhere in a deck, or for a given value without use."""
        ahead = Variables(self.given)
        for statement in ahead.filled(statements(lines, file)):
            command = command_of(statement)
            if command is None and statement.tokens:
                return  # the run will end with an error here
            if command is not None and command.ends:
                break
        for name in self.given:
            if name not in ahead.used:
                known = ", ".join(f"${one}" for one in ahead.used)
                advice = f"the variables of the deck are {known}" if known else "the deck has no variables"
                raise UdecError(10, f"{file} has no ${name}", with_suggestion(name, ahead.used, advice))

    def _set_defaults(self, statement: Statement) -> None:
        """Store the values of a DEFAULT."""
        head, *rest = statement.tokens
        if not rest:
            place = Token("", head.line, head.end)
            raise at(UdecError(7, f"nothing follows {quoted(head.text)}", FORM), place)
        for name, value in zip(rest[::2], [*rest[1::2], None], strict=False):
            if not NAME.fullmatch(name.text):
                advice = "write the name without $ here" if name.text.startswith("$") else FORM
                raise at(UdecError(10, f"{quoted(name.text)} is not the name of a variable", advice), name)
            if value is None:
                place = Token("", name.line, name.end)
                raise at(UdecError(7, f"no value follows {quoted(name.text)}", FORM), place)
            if not (NUMBER.fullmatch(value.text) or PLAIN.fullmatch(value.text)):
                raise at(UdecError(10, f"{quoted(value.text)} is not a value of a variable", IS_VALUE), value)
            key = name.text.upper()
            if key in self.defaults:
                before = self.defaults[key][1].line.number
                raise at(UdecError(10, f"{key} already has a default, in line {before}"), name)
            self.defaults[key] = value.text, name

    def _filled(self, line: Line, command: Command | None) -> Line:
        """`line` with values."""
        text, put_in, end = "", list[Put](), 0
        for use in CALCULATED.finditer(line.text, 0, _end_of(line.text, command)):
            value = self._calculated(line, use) if use[0][0] == "{" else self._value_at(line, use)
            text += line.text[end : use.start()]
            put_in.append(Put(len(text) + 1, len(text) + len(value) + 1, use.start() + 1, use.end() + 1))
            text, end = text + value, use.end()
        filled = Line(line.file, line.number, text + line.text[end:], line, tuple(put_in))
        self._check_numbers(filled)
        return filled if put_in else line

    def _value_at(self, line: Line, place: re.Match[str]) -> str:
        """The value of the variable that is used at a place of `line`."""
        use = USE.match(line.text, place.start())
        assert use is not None
        return self._value(line, use)

    def _calculated(self, line: Line, braces: re.Match[str]) -> str:
        """The value of the arithmetic in braces. Error 10."""
        text = USE.sub(lambda use: self._value(line, use), braces[1])
        try:
            value = calculate(text)
            return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
        except (ValueError, ArithmeticError) as error:
            advice = "braces contain numbers, variables, + - * / ** ( ), sqrt, sin, cos, tan and pi"
            detail = f"{quoted(braces[0])}: {error}"
            raise at(UdecError(10, detail, advice), Token(braces[0], line, braces.start() + 1)) from None

    def _check_numbers(self, line: Line) -> None:
        """Error 10 if a value and the text beside it make another number: 0.5$KN would be 0.51E8.

        With braces, as in 0.5${KN}, this is accepted.
        """
        for token in tokens(line):
            for put in line.put_in:
                inside = token.column <= put.first and put.end <= token.end
                value = line.text[put.first - 1 : put.end - 1]
                if inside and token.text.lstrip("+-") != value.lstrip("+-") and NUMBER.fullmatch(token.text):
                    written = line.written or line
                    use = written.text[put.at - 1 : put.after - 1]
                    if use.startswith(("${", "{")):
                        continue
                    detail = f"{use} = {value} beside another number would make {token.text}"
                    advice = f"separate them by a blank, or calculate in braces, as in {{0.5*{use}}}"
                    raise at(UdecError(10, detail, advice), Token(use, written, put.at))

    def _value(self, line: Line, use: re.Match[str]) -> str:
        """The value of the variable at a place of `line`."""
        name = (use[1] if use[2] is None else use[2]).strip().upper()
        place = Token(use[0], line, use.start() + 1)
        if not NAME.fullmatch(name):
            raise at(UdecError(10, f"{quoted(use[0])} is not a variable", IS_NAME), place)
        self.used[name] = None
        if name in self.given:
            return self.given[name]
        if name in self.defaults:
            return self.defaults[name][0]
        cure = f"give it with --set {name}=..., or by DEFAULT {name}=... before this line"
        known = [one for one in self.given | self.defaults if one != name]
        raise at(UdecError(7, f"the variable {name} has no value", with_suggestion(name, known, cure)), place)


def _end_of(text: str, command: Command | None) -> int:
    """The end of a line without its comment; a file name may contain characters that begin comments."""
    whole = without_comment(text)
    if not whole.strip() or command is None or not command.text:
        return len(whole)
    head = len(text) - len(text.lstrip()) + len(text.split()[0])
    name = text[head:].lstrip(" \t=")
    named = QUOTED.match(name)
    return len(text) - len(name) + (named.end(1) if named else len(APART.split(name, maxsplit=1)[0]))
