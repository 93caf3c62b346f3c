"""Conversion of a statement to a call of the model, by the table (VAR, IVAR and RVAR, III-3).

An integer is accepted as a real, but not a real as an integer. A missing number is reported at the place
after the last parameter.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from itertools import cycle
from typing import Any

from udec_ia.deck.command_forms import LIMITS, SEVERAL, Command, Word, match
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import (
    COMMENTS,
    CONTINUATION,
    REMARK,
    Line,
    Statement,
    Token,
    at,
    quoted,
    without_comment,
)
from udec_ia.deck.keyword_suggestions import with_suggestion
from udec_ia.errors import ADVICE, UdecError
from udec_ia.reader.group_ranges import PARTS

INTEGER = re.compile(r"[+-]?[0-9]+")
NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([EeDd][+-]?[0-9]+)?")
QUOTED = re.compile(rf"""((['"]).*?\2)\s*([A-Za-z]*)\s*({REMARK.pattern}.*)?$""")
RANGE = "RANGE"  # begins a range in words behind other words
LAST = re.compile(r"(?:(.*\S)\s+)?(\S+)\s*")  # a text, and its last word
APART = re.compile(rf"(?<!\S)(?={REMARK.pattern})")  # where a comment begins behind the name of a file
INTEGER_NAMES = "ijklmn"
INTEGER_DIGITS = 18  # an integer of so many digits fits in 64 bits
RESTART_FILE = ["udec_ia", "restart", "file"]  # the first words of such a file
NO_DECK = "this is a restart file: udec info shows its contents, RESTART in a deck continues from it"
ALONE = "there is no command before this line to continue; at a terminal, end the line of the command with +"
NO_COMMENT = "a comment after a command begins with ; # or !; one with * needs a line of its own"
NO_WORD = "a line begins with a command, or with + if it continues the one before"
INCOMPLETE = {2: 8, 3: 26}  # error for an incomplete pair and triple


@dataclass
class Call:
    """The arguments for the method of Model that executes a command, and the place of each argument."""

    command: Command
    head: Token
    positional: list[Any] = field(default_factory=list)
    named: dict[str, Any] = field(default_factory=dict)
    places: dict[str, Token] = field(default_factory=dict)

    def place_of(self, error: UdecError) -> Token:
        """The place of the argument that `error` is about, else of the command's text or of the command."""
        return self.places.get(error.parameter or self.command.text, self.head)


def command_of(statement: Statement) -> Command | None:
    """The command that `statement` begins with; None for comments and unknown words."""
    return match(COMMANDS, statement.tokens[0].text) if statement.tokens else None


def parse(statement: Statement) -> Call:
    """The call of a statement. Raises UdecError 2, 7, 8, 10, 22, 26 or 28 at the place of the fault."""
    head = statement.tokens[0]
    command = match(COMMANDS, head.text)
    if command is not None:
        return _Parser(command, statement.tokens).parse()
    if head.text.startswith(CONTINUATION):
        advice = ALONE
    elif NUMBER.fullmatch(head.text):
        advice = NO_WORD
    elif [token.text for token in statement.tokens] == RESTART_FILE:
        advice = NO_DECK
    else:
        advice = _which_command(statement.tokens)
    raise at(UdecError(2, quoted(head.text), advice), head)


def _which_command(tokens: list[Token]) -> str:
    """Advice on an unknown command: one that is spelt alike, or the second word, if the line fits it."""
    if len(tokens) > 1 and (command := match(COMMANDS, tokens[1].text)) and _reads_as(command, tokens[1:]):
        return f"did you mean {command.name.upper()}? {ADVICE[2]}"
    by_name = {command.name.upper(): command for command in COMMANDS}
    return with_suggestion(tokens[0].text, by_name, ADVICE[2], lambda name: _reads_as(by_name[name], tokens))


def _reads_as(command: Command, tokens: list[Token]) -> bool:
    """True if `tokens` but the first have the form of `command`."""
    try:
        text = str(_Parser(command, tokens).parse().named.get(command.text, ""))
    except UdecError:
        return False
    if command.text == "assignments":
        return "=" in text
    if command.text == "command":
        return not text or match(COMMANDS, text) is not None
    return not text or "." in text  # the name of a file


def number(token: Token, name: str, advice: str) -> int | float:
    """The value of `token`, which is the number `name`. Raises UdecError 10 or 28 there."""
    if not NUMBER.fullmatch(token.text):
        raise at(UdecError(10, f"{quoted(token.text)} is not a number", advice), token)
    if name[0] in INTEGER_NAMES:
        if not INTEGER.fullmatch(token.text):
            detail = f"{quoted(token.text)} is not an integer"
            raise at(UdecError(10, detail, f"{name} must be an integer"), token)
        digits = token.text.lstrip("+-0") or "0"
        if len(digits) > INTEGER_DIGITS:
            raise at(UdecError(28, f"{quoted(token.text)} has more than {INTEGER_DIGITS} digits"), token)
        return -int(digits) if token.text.startswith("-") else int(digits)
    value = float(token.text.upper().replace("D", "E"))
    if math.isinf(value):
        raise at(UdecError(28, f"{quoted(token.text)} is too large a number"), token)
    return value


class _Parser:
    """Reads the tokens of a command in one pass."""

    def __init__(self, command: Command, tokens: list[Token]) -> None:
        self.command = command
        self.tokens = tokens
        self.read = 1  # tokens that are read
        self.call = Call(command, tokens[0])

    def parse(self) -> Call:
        """The call: numbers, then words, then the list."""
        command = self.command
        if command.text:
            self._text()
            return self.call
        for given in self.tokens[1:]:
            if given.text.startswith(COMMENTS[0]):
                raise at(UdecError(10, quoted(given.text), NO_COMMENT), given)
        replacing = [word for word in command.words if word.replaces]
        first = self._next()
        if command.list or first is None or match(replacing, first.text) is None:
            names = command.numbers.split()
            if command.has_range and self._range_first():
                names = names[len(LIMITS.split()) :]
            for name in names:
                self._positional(name)
        for name in command.optional.split():
            if self._at_number():
                self._positional(name)
        if command.first:
            self._check_first()
        while (token := self._next()) and not self._at_number():
            self._word(token)
        if command.list and not any(word.argument in self.call.named for word in replacing):
            self._list(command.list)
        if (token := self._next()) is not None:
            raise at(UdecError(10, self._surplus(token), self._advice()), token)
        if command.has_range and self.call.positional[0] is None and not command.of_all:
            raise at(UdecError(7, "number x1 is missing, and there is no RANGE", self._advice()), self._gap())
        return self.call

    def _range_first(self) -> bool:
        """Read a range in words where four limits may stand, or leave it for later; False for limits."""
        token = self._next()
        if self._at_number() and not self._numbers_are_no_limits():
            return False
        if token is None and not self.command.of_all:
            return False
        if token is None:
            self.call.positional += [None] * len(LIMITS.split())
            return True
        later = self.command.of_all or self._has_range_later()
        if not later and self._part_of_range(token, True) is None:
            return False
        self.call.positional += [None] * len(LIMITS.split())
        if self._part_of_range(token, True) is not None:
            self._range(True)
        return True

    def _has_range_later(self) -> bool:
        return any(one.text.upper() == RANGE for one in self.tokens[self.read :])

    def _numbers_are_no_limits(self) -> bool:
        """True if the numbers that come next are fewer than four limits, and a RANGE follows them."""
        behind = [NUMBER.fullmatch(one.text) is None for one in self.tokens[self.read :]]
        many = behind.index(True) if True in behind else len(behind)
        others = len(self.command.numbers.split()) - len(LIMITS.split()) + len(self.command.optional.split())
        return many <= others and many < len(LIMITS.split()) and self._has_range_later()

    def _part_of_range(self, token: Token, leads: bool) -> str | None:
        """The keyword of a part of a range; if it leads, not one that the command has itself."""
        word = token.text.upper()
        if word not in (RANGE, "NOT", *PARTS) or (
            leads and word != RANGE and match(self.command.words, word)
        ):
            return None
        return word

    def _range(self, leads: bool) -> None:
        """Read the words of a range, up to what is no part of it."""
        first = self.tokens[self.read]
        if self.call.positional[0] is not None:
            raise at(UdecError(10, "a second range", "give one range"), first)
        self.call.positional[0], self.call.places["x1"] = self._words_of_range(leads), first

    def _is_range_in_words(self) -> bool:
        """True unless four limits follow, and no more of a range."""
        token = self._next()
        if token is None or not self._at_number():
            return token is not None
        behind = self.tokens[self.read + len(LIMITS.split()) :]
        return bool(behind) and self._part_of_range(behind[0], True) is not None

    def _words_of_range(self, leads: bool) -> str:
        """The words up to what is no part of a range."""
        words: list[str] = []
        while (token := self._next()) is not None:
            word = self._part_of_range(token, leads and bool(words))
            if word == "WHERE":
                words.append(without_comment(token.line.text)[token.column - 1 :].strip())
                self.read = len(self.tokens)
                break
            if word is not None:
                words += [token.text] * (word != RANGE or bool(words))
                self.read += 1
            elif not self._at_number() or (words and words[-1].upper() not in ("NOT", RANGE)):
                break
            self._numbers_of(word, words)
        return " ".join(words)

    def _numbers_of(self, word: str | None, words: list[str]) -> None:
        """Read the name or numbers of the part `word` of a range, of a rectangle for None or RANGE."""
        if word == "GROUP" and (token := self._next()) is not None:
            words.append(token.text)
            self.read += 1
            return
        many = None if word == "POLYGON" else len((PARTS.get(word or "") or "").split())
        if word in (None, RANGE) or (word == "OUTSIDE" and self.command.name == "delete"):
            many = len(LIMITS.split()) if self._at_number() else 0
        while (token := self._next()) is not None and many != 0:
            if token.text != "<" and not self._at_number():
                break
            words.append(token.text)
            self.read += 1
            if many is not None and token.text != "<":
                many -= 1

    def _next(self) -> Token | None:
        return self.tokens[self.read] if self.read < len(self.tokens) else None

    def _at_number(self) -> bool:
        token = self._next()
        return token is not None and NUMBER.fullmatch(token.text) is not None

    def _gap(self) -> Token:
        """The place just after the last token that was read."""
        last = self.tokens[self.read - 1]
        return Token("", last.line, last.end)

    def _advice(self) -> str:
        return f"the form is: {self.command.form}"

    def _surplus(self, token: Token) -> str:
        """The detail of the error for `token`, at which the command should have ended."""
        if NUMBER.fullmatch(token.text):
            return f"{quoted(token.text)} is one number too many"
        if match(self.command.words, token.text):
            return f"{quoted(token.text)} must stand before the list {self.command.list} ..."
        return f"{quoted(token.text)} is not a number"

    def _text(self) -> None:
        """Take the rest of the line unchanged: names of files may contain separators."""
        line, end = self.tokens[0].line, self.tokens[0].end - 1
        rest = line.text[end:].lstrip(" \t=")
        text, behind = self._quoted(rest) if rest[:1] in ("'", '"') else self._unquoted(rest)
        if text is None:
            detail = f"{rest[0]} stands before the name; it must be the last word of the line"
            place = Token(rest[0], line, len(line.text) - len(rest) + 1)
            raise at(UdecError(10, detail, "put the whole name in quotes, or none of it"), place)
        place = Token(text.rstrip(), line, len(line.text) - len(rest) + 1)
        if not place.text.isprintable() or self.tokens[-1].line is not line:
            raise at(UdecError(10, f"{self.command.text} must be plain text on one line"), place)
        for last in behind:
            self.call.named[last.argument], self.call.places[last.argument] = True, self.tokens[-1]
        if self.command.needs_text and not place.text:
            raise at(UdecError(7, self.command.text, self._advice()), self._gap())
        if place.text:
            self.call.named[self.command.text] = place.text.strip("\"'")
            self.call.places[self.command.text] = place

    def _quoted(self, rest: str) -> tuple[str | None, list[Word]]:
        """A name with its quotes, and the word behind it; no name if anything else follows."""
        whole = QUOTED.match(rest)
        last = match(self.command.words, whole[3]) if whole and whole[3] else None
        return whole[1] if whole and (last or not whole[3]) else None, [last] if last else []

    def _unquoted(self, rest: str) -> tuple[str, list[Word]]:
        """A name, and the words behind it, each once."""
        text, words = APART.split(rest, maxsplit=1)[0], list[Word]()
        while found := LAST.fullmatch(text):
            last = match(self.command.words, found[2])
            if last is None or last in words:
                break
            text, words = found[1] or "", [*words, last]
        return text, words

    def _number(self, name: str, missing: int = 7, line: Line | None = None, advice: str = "") -> int | float:
        """Read the number `name`, on `line` if given. Error `missing` with `advice` if it is missing."""
        token = self._next()
        if token is None or match(self.command.words, token.text) or line not in (None, token.line):
            last = self.tokens[self.read - 1].text
            detail = f"number {name} is missing after {quoted(last)}"
            raise at(UdecError(missing, detail, advice if line else self._advice()), self._gap())
        self.read += 1
        return number(token, name, self._advice())

    def _positional(self, name: str) -> None:
        self.call.positional.append(self._number(name))
        self.call.places[name] = self.tokens[self.read - 1]

    def _list(self, names: str) -> None:
        """Read the tuples at the end of the command. The names of their numbers are x1, y1, x2, y2, ..."""
        first = self.read
        values = [value for values in self._tuples(names) for value in values]
        self.call.positional += values
        n = len(names.split())
        for k, (token, name) in enumerate(zip(self.tokens[first:], cycle(names.split()), strict=False)):
            self.call.places[f"{name}{k // n + 1}"] = token

    def _tuples(self, names: str) -> list[tuple[int | float, ...]]:
        """Read one tuple or more; the numbers of a tuple must be on one line."""
        first, *others = names.split()
        found: list[tuple[int | float, ...]] = []
        while not found or self._at_number():
            values = [self._number(first)]
            line = self.tokens[self.read - 1].line
            missing = INCOMPLETE[len(names.split())]
            advice = f"{first} and {others[0]} must be on one line" if missing == 8 else ""
            values += [self._number(name, missing, line, advice) for name in others]
            found.append(tuple(values))
        return found

    def _check_first(self) -> None:
        """The first word must set the argument `first` of the command."""
        token = self._next()
        if token is None:
            detail = f"nothing follows {quoted(self.tokens[self.read - 1].text)}"
            raise at(UdecError(7, detail, self._advice()), self._gap())
        allowed = [word for word in self.command.words if word.argument == self.command.first]
        if match(allowed, token.text) is not None:
            return
        if NUMBER.fullmatch(token.text) and allowed[0].values:
            detail = f"{quoted(token.text)} stands in place of {allowed[0].form}"
            raise at(UdecError(10, detail, self._advice()), token)
        if self.command.first_error == 10 and match(self.command.words, token.text) is not None:
            detail = f"{self.command.first.upper()} is missing before {quoted(token.text)}"
            raise at(UdecError(7, detail, self._advice()), self._gap())
        raise self._unrecognised(token, self.command.first_error, allowed)

    def _unrecognised(self, token: Token, error: int, allowed: list[Word] | tuple[Word, ...]) -> UdecError:
        by_name = {word.keyword.upper(): word for word in allowed}
        following = self.tokens[self.read + 1 : self.read + 2]
        has_number = bool(following) and NUMBER.fullmatch(following[0].text) is not None
        advice = with_suggestion(
            token.text, by_name, self._advice(), lambda name: bool(by_name[name].values) == has_number
        )
        return at(UdecError(error, quoted(token.text), advice), token)

    def _word(self, token: Token) -> None:
        """Read a word and its values, and set its argument."""
        if self.command.has_range and token.text.upper() == RANGE:
            self._range(False)
            return
        word = match(self.command.words, token.text)
        if word is None:
            raise self._unrecognised(token, 10, self.command.words)
        self.read += 1
        if word.argument == SEVERAL:
            self.call.positional.append(word.keyword.lower())
            return
        if word.argument in self.call.named:
            raise at(UdecError(10, f"{quoted(token.text)} sets {word.argument} twice"), token)
        if word.text:
            self._rest_of_line(word, token)
            return
        self.call.places[word.argument] = (self._next() if word.values else token) or token
        self.call.named[word.argument] = self._value(word)

    def _rest_of_line(self, word: Word, token: Token) -> None:
        """Read the name of a file, which may contain separators, and which ends the command."""
        rest = token.line.text[token.end - 1 :].lstrip(" \t=")
        whole = QUOTED.match(rest) if rest[:1] in ("'", '"') else None
        name = whole[1] if whole and not whole[3] else APART.split(rest, maxsplit=1)[0].rstrip()
        if not name:
            raise at(UdecError(7, word.values, self._advice()), self._gap())
        place = Token(name, token.line, len(token.line.text) - len(rest) + 1)
        if not name.isprintable() or self.tokens[-1].line is not token.line:
            raise at(UdecError(10, f"{word.values} must be plain text on one line"), place)
        self.call.named[word.argument], self.call.places[word.argument] = name.strip("\"'"), place
        self.read = len(self.tokens)

    def _value(self, word: Word) -> Any:
        """The value that `word` gives to its argument, read from the tokens after it."""
        if word.keyword == RANGE and self._is_range_in_words():
            return self._words_of_range(True)
        if word.repeated:
            return self._tuples(word.values)
        values = [
            self._number(name.strip("[]"))
            for name in word.values.split()
            if not name.startswith("[") or self._at_number()
        ]
        if len(values) > 1:
            return tuple(values)
        if values:
            return values[0]
        return word.keyword.lower() if word.sets else True
