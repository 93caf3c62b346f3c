"""Settings, and the deck that a setting makes of the user's deck: other numbers in some of its lines.

The lines stay where they are, as far as can be, so that numbers of lines mean the same in both. What only
shows or saves is left out as a comment: it takes as long at any setting.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from udec_ia.deck.language import COMMANDS, match
from udec_ia.deck.parser import parse
from udec_ia.deck.reader import Line, Statement, Token, statements
from udec_ia.deck.variables import Values, Variables
from udec_ia.heap.words import DEFAULT_SCHEME

SHOWS = ("plot", "print", "dump", "scale", "help")  # left out
FILLED = "default"  # its values are in the lines
LIMIT = 100_000  # of SOLVE if none is given
EVERYWHERE = "-1E30 1E30 -1E30 1E30"


@dataclass(frozen=True)
class Setting:
    """What a run is made with.

    build: word scheme. step: times the time-step of the deck. safe: fraction of the safe bound instead, 0 for
    none. ratio: times the ratio of SOLVE. static: SOLVE ... STATIC. rounding, edge, stiffness: times the
    lengths of ROUND and of GENERATE ... EDGE, and KN and KS. types: "" as they are, "rigid" or "sdef".
    """

    build: str = DEFAULT_SCHEME
    step: float = 1.0
    safe: float = 0.0
    ratio: float = 1.0
    static: bool = False
    rounding: float = 1.0
    edge: float = 1.0
    stiffness: float = 1.0
    types: str = ""

    @property
    def name(self) -> str:
        """What it is called, and its folder."""
        parts = [self.build]
        if self.safe:
            parts.append(f"safe={self.safe:.3g}")
        elif not self.static:
            parts.append(f"step={self.step:.4g}")
        times = {
            "ratio": self.ratio,
            "round": self.rounding,
            "edge": self.edge,
            "stiffness": self.stiffness,
        }
        parts += [f"{what}={factor:.3g}" for what, factor in times.items() if factor != 1]
        parts += ["static"] if self.static else []
        parts += [self.types] if self.types else []
        return ",".join(parts)


@dataclass(frozen=True)
class Numbers:
    """What a setting puts into the lines that count cycles.

    fit: times the fraction that is asked for, a little below 1. cycles: of each CYCLE and SOLVE, in order;
    None as they are. longer: of each of these, time-step of the deck over the new one. limits: cycles of each
    SOLVE, after which it gives up; None as it is.
    """

    fit: float = 1.0
    cycles: tuple[int | None, ...] = ()
    longer: tuple[float, ...] = ()
    limits: tuple[int | None, ...] = ()


class Fraction(NamedTuple):
    """What FRACTION says. words: " SAFE" or " SCALED", "" for a fraction of the estimate."""

    value: float
    words: str = ""


class Deck:
    """A deck with the values of its variables, as far as levers go. Raises UdecError for what is no deck.

    name: what errors call it. folder: where the names of its restart files begin.
    """

    def __init__(
        self, text: str, name: str, values: Values | None = None, folder: Path | None = None
    ) -> None:
        self.text, self.name, self.folder = text, name, folder or Path()
        variables = Variables(values)
        variables.check(text.splitlines(), name)
        self.statements = [*variables.filled(statements(text.splitlines(), name))]
        self.commands = [_command(one) for one in self.statements]
        ends = [k for k, command in enumerate(self.commands) if command in ("stop", "end")]
        self.obeyed = ends[0] if ends else len(self.commands)  # statements before STOP
        for k in range(self.obeyed):
            if self.commands[k]:
                parse(self.statements[k])
        self._saves = "restart" in self.commands[1:]

    def has(self, *commands: str) -> bool:
        """True if one of these is in it."""
        return any(one in commands for one in self.commands[: self.obeyed])

    @property
    def rests(self) -> bool:
        """True if it seeks nothing but rest: SOLVE, and no CYCLE of more than nothing."""
        calls = (parse(one) for one, name in self._named() if name == "cycle")
        return self.has("solve") and all(call.positional[0] == 0 for call in calls)

    @property
    def statics(self) -> list[bool]:
        """Of each CYCLE and SOLVE, in order: whether it is SOLVE ... STATIC, whose step is its own."""
        runs = ((one, name) for one, name in self._named() if name in ("cycle", "solve"))
        return [name == "solve" and bool(parse(one).named.get("static")) for one, name in runs]

    @property
    def is_stepped(self) -> bool:
        """True if the time-step that FRACTION gives matters to a CYCLE or SOLVE."""
        return not all(self.statics)

    @property
    def histories(self) -> int:
        """Number of statements HISTORY."""
        return self.commands[: self.obeyed].count("history")

    def fractions(self) -> list[tuple[int, float]]:
        """Line and number of each FRACTION."""
        return [
            (one.tokens[0].line.number, float(parse(one).positional[0]))
            for one, name in self._named()
            if name == "fraction"
        ]

    def has_edges(self) -> bool:
        """True if GENERATE ... AUTOMATIC makes zones of a size."""
        return any(
            parse(one).named.get("edge") is not None for one, name in self._named() if name == "generate"
        )

    def has_moduli(self) -> bool:
        """True if a material can be deformable."""
        calls = (parse(one) for one, name in self._named() if name == "property")
        return any(call.named.get("bulk") or call.named.get("g") for call in calls)

    def _named(self) -> Iterator[tuple[Statement, str]]:
        yield from zip(self.statements[: self.obeyed], self.commands[: self.obeyed], strict=True)

    # ---- written anew

    def written(
        self, setting: Setting, numbers: Numbers | None = None, fraction: Fraction | None = None
    ) -> str:
        """The deck for `setting`. fraction: what it begins with, where no line says so; None: it stays so."""
        numbers = numbers or Numbers()
        lines: list[str] = []
        run = 0  # CYCLEs and SOLVEs until here
        told = "fraction" in self._until_run() or not self.is_stepped
        for k, (one, name) in enumerate(zip(self.statements, self.commands, strict=True)):
            if k >= self.obeyed:
                lines += [line.text for line in one.lines]
                continue
            if name in ("cycle", "solve") and setting.types and run == 0:
                lines += _types(setting.types)
            lines += self._line(one, name, setting, numbers, run)
            if name in ("start", "restart") and not told and fraction is not None:
                lines.append(_fraction(setting, numbers, *fraction))
            run += name in ("cycle", "solve")
        return "".join(f"{line}\n" for line in lines)

    def _until_run(self) -> list[str]:
        found = self.commands[: self.obeyed]
        ends = [k for k, name in enumerate(found) if name in ("cycle", "solve")]
        return found[: ends[0]] if ends else found

    def _line(self, one: Statement, name: str, setting: Setting, numbers: Numbers, run: int) -> list[str]:
        """The lines of a statement. run: CYCLEs and SOLVEs before it."""
        longer = numbers.longer[run] if run < len(numbers.longer) else 1.0
        if name in SHOWS or name == FILLED or (name == "save" and not self._saves):
            return _left_out(one)
        if name == "fraction":
            call = parse(one)
            words = "".join(f" {word.upper()}" for word in ("safe", "scaled") if call.named.get(word))
            return _instead(one, _fraction(setting, numbers, call.positional[0], words))
        if name == "cycle":
            cycles = numbers.cycles[run] if run < len(numbers.cycles) else None
            return _instead(one, f"CYCLE {cycles}") if cycles is not None else _lines(one)
        if name == "solve":
            last = numbers.limits[run] if run < len(numbers.limits) else None
            return _instead(one, _solve(one, setting, longer, last))
        if name == "history":
            every = max(1, round(parse(one).positional[0] * longer))
            return _put(one, {one.tokens[1]: str(every)})
        if name == "restart" and not self._saves:
            return self._restart(one)
        if name == "round":
            return _times(one, one.tokens[1:2], setting.rounding)
        if name == "property" and setting.stiffness != 1:
            return _times(one, _after(one, "KN", "KS"), setting.stiffness)
        if name == "generate" and setting.edge != 1:
            return _times(one, _after(one, "Edge"), setting.edge)
        if setting.types and name in ("generate", "change") and _makes_soft(one, name):
            return _left_out(one)
        return _lines(one)

    def _restart(self, one: Statement) -> list[str]:
        path = (self.folder / str(parse(one).named.get("path", "restart.h5"))).absolute()
        return _instead(one, f'RESTART "{path}"') if path.is_file() else _lines(one)


def _command(statement: Statement) -> str:
    """Name of the command of a statement, "" for comments."""
    command = match(COMMANDS, statement.tokens[0].text) if statement.tokens else None
    if statement.tokens and command is None:
        parse(statement)  # raises error 2
    return command.name if command else ""


def _lines(one: Statement) -> list[str]:
    return [line.text for line in one.lines]


def _left_out(one: Statement) -> list[str]:
    """The lines of a statement as comments."""
    words = {token.line for token in one.tokens}
    return [f"* {line.text}" if line in words else line.text for line in one.lines]


def _instead(one: Statement, text: str) -> list[str]:
    """The lines of a statement, `text` in the place of those with its words."""
    first = one.tokens[0].line
    words = {token.line for token in one.tokens}
    return [text if line == first else line.text for line in one.lines if line == first or line not in words]


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
        return _lines(one)
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


def _fraction(setting: Setting, numbers: Numbers, own: float, words: str) -> str:
    """FRACTION. own: what the deck has, with these words."""
    fraction = (setting.safe or own * setting.step) * numbers.fit
    safe = " SAFE" if setting.safe and "SAFE" not in words else ""
    return f"FRACTION {fraction:.10g}{safe}{words}"


def _solve(one: Statement, setting: Setting, longer: float, last: int | None) -> str:
    """SOLVE. last: cycles, if that is less than what the deck allows."""
    call = parse(one)
    limit = round(call.named.get("limit", LIMIT) * max(longer, 1.0) / min(setting.ratio, 1.0))
    limit = min(limit, last or limit)
    static = " STATIC" if setting.static or call.named.get("static") else ""
    mean = " MEAN" if call.named.get("criterion") == "mean" else ""
    return f"SOLVE {call.positional[0] * setting.ratio:.10g} LIMIT {limit}{static}{mean}"


def _types(types: str) -> list[str]:
    return [f"CHANGE {EVERYWHERE} {types.upper()}"] if types == "sdef" else []


def _makes_soft(one: Statement, name: str) -> bool:
    return name == "generate" or parse(one).named.get("type") is not None
