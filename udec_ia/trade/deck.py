"""The deck that a setting makes of the user's deck: other numbers in some of its statements (writing.py).

The lines stay where they are, as far as can be, so that numbers of lines mean the same in both. What only
shows or saves is left out as a comment: it takes as long at any setting.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from udec_ia.deck.command_forms import Kind
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import Statement, statements
from udec_ia.deck.deck_variables import Values, Variables
from udec_ia.deck.lines_and_calls import command_of, parse
from udec_ia.trade import writing
from udec_ia.trade.levers import Fraction, Numbers, Setting
from udec_ia.trade.writing import Piece

SHOWS = {one.name for one in COMMANDS if one.kind is Kind.SHOWS}  # left out
FILLED = "default"  # its values are in the lines
RUNS = {one.name for one in COMMANDS if one.kind is Kind.RUNS}
WRITES = {one.name for one in COMMANDS if one.writes_words or one.begins}  # may set what makes a time-step
ENDS = {one.name for one in COMMANDS if one.ends}


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
        ends = [k for k, command in enumerate(self.commands) if command in ENDS]
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
        runs = ((one, name) for one, name in self._named() if name in RUNS)
        return [name == "solve" and bool(parse(one).named.get("static")) for one, name in runs]

    @property
    def is_stepped(self) -> bool:
        """True if the time-step that FRACTION gives matters to a CYCLE or SOLVE."""
        return not all(self.statics)

    @property
    def histories(self) -> int:
        """Number of statements HISTORY."""
        return self.commands[: self.obeyed].count("history")

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

    def pieces(
        self, setting: Setting, numbers: Numbers | None = None, fraction: Fraction | None = None
    ) -> list[Piece]:
        """The deck for `setting`, as many pieces for any of the same types, in the order of its lines.

        fraction: what it begins with, where no line says so; None: it stays so.
        """
        numbers = numbers or Numbers()
        told = "fraction" in self._until_run() or not self.is_stepped
        found: list[Piece] = []
        run = last = 0  # CYCLEs and SOLVEs, and number of the last line, until here
        for k, (one, name) in enumerate(zip(self.statements, self.commands, strict=True)):
            obeyed = k < self.obeyed
            if obeyed and name in RUNS and run == 0:
                found.append(Piece(None, last, writing.types(setting)))
            lines = self._lines(one, name, setting, numbers, run) if obeyed else writing.as_it_is(one)
            first = one.tokens[0].line if one.tokens else one.lines[0]
            found.append(Piece(one, first.number, lines))
            last = one.lines[-1].number
            if obeyed and name in ("start", "restart") and not told and fraction is not None:
                found.append(Piece(None, last, [writing.fraction(setting, numbers, fraction)]))
            run += name in RUNS
        return found

    def written(
        self, setting: Setting, numbers: Numbers | None = None, fraction: Fraction | None = None
    ) -> str:
        """The same as a text."""
        return writing.written(self.pieces(setting, numbers, fraction))

    def setter(self, run: int) -> str:
        """What may have set the time-step of a CYCLE or SOLVE past FRACTION; "" for nothing.

        The last PATCH of FRAC before it, or else the last line that writes words or begins anew. run: number
        of CYCLEs and SOLVEs before it.
        """
        ends = [k for k, name in enumerate(self.commands[: self.obeyed]) if name in RUNS]
        before = [*zip(self.statements, self.commands, strict=True)][: ends[run]]
        writes = [one for one, name in before if name in WRITES]
        patches = [one for one in writes if any("FRAC" in word.text.upper() for word in one.tokens)]
        if not writes:
            return ""
        one = (patches or writes)[-1]
        return f"line {one.tokens[0].line.number}: {' '.join(line.text.strip() for line in one.lines)}"

    def _until_run(self) -> list[str]:
        found = self.commands[: self.obeyed]
        ends = [k for k, name in enumerate(found) if name in RUNS]
        return found[: ends[0]] if ends else found

    def _lines(self, one: Statement, name: str, setting: Setting, numbers: Numbers, run: int) -> list[str]:
        """The lines of a statement that is obeyed. run: CYCLEs and SOLVEs before it."""
        if name in SHOWS or name == FILLED or (name == "save" and not self._saves):
            return writing.left_out(one)
        if name == "restart" and not self._saves:
            path = (self.folder / str(parse(one).named.get("path", "restart.h5"))).absolute()
            return writing.instead(one, f'RESTART "{path}"') if path.is_file() else writing.as_it_is(one)
        return writing.changed(one, name, setting, numbers, writing.place(numbers, run))


def _command(statement: Statement) -> str:
    """Name of the command of a statement, "" for comments."""
    command = command_of(statement)
    if statement.tokens and command is None:
        parse(statement)  # raises error 2
    return command.name if command else ""
