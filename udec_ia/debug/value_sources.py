"""The numbers that a value was computed from, among all that a routine has read: `why`.

    nx, ny, overlap = coord(h, ic)      1 step away: its reads count as well
    fn = kn * overlap                   the statement that writes names kn and overlap
    putr(h, ic, KCFN, fn)               the write

The statement that writes the value names variables. The statements that assign these name others, and so on,
in the routine and in those that called it. What was read in these statements, or by functions that they call,
counts as an operand, the nearer the fewer statements lie between. The order of the statements and branches
are not considered: so there may be operands too many, and numbers that only chose a branch are left out.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import CodeType
from typing import NamedTuple

from udec_ia.printable_text import printable

Call = tuple[CodeType, int]  # a routine, and the line of it that is being executed
Calls = tuple[Call, ...]  # from the pass down to the routine that reads or writes
NOT_VALUES = {"h", "g"}  # memory and offsets: names that every statement has
LINE = 120  # characters of a statement that are shown
Statement = ast.Assign | ast.AugAssign | ast.AnnAssign | ast.For | ast.Expr | ast.Return


class Source(NamedTuple):
    """A statement that a value was computed in. steps: statements between it and the one that writes."""

    text: str
    file: str
    line: int
    steps: int

    @property
    def place(self) -> str:
        """File and line."""
        return f"{self.file}:{self.line}"


def find_sources(calls: Calls) -> dict[Call, Source]:
    """The statements that the value written in these calls comes from, by each of their lines."""
    found: dict[Call, Source] = {}
    arguments: set[int] | None = None  # numbers of the arguments that count, of the call at hand
    callee = ""
    for above, (code, line) in enumerate(reversed(calls)):
        statements = _statements(code)
        start = next((one for one in statements if line in _lines(one)), None)
        if start is None:
            break
        names = _names(start) if arguments is None else _arguments(start, callee, arguments)
        pending, done = [(start, above)], set[str]()
        while pending:
            statement, steps = pending.pop(0)
            source = Source(_text(statement), Path(code.co_filename).name, statement.lineno, steps)
            for number in _lines(statement):
                found.setdefault((code, number), source)
            names |= _names(statement) if statement is not start else set()
            new_names, done = names - done, done | names
            pending += [
                (one, steps + 1) for one in statements if one is not start and _assigned(one) & new_names
            ]
        parameters = code.co_varnames[: code.co_argcount]
        arguments = {k for k, name in enumerate(parameters) if name in done}
        callee = code.co_name
        if not arguments:
            break
    return found


def match_source(read: Calls, written: Calls, found: dict[Call, Source]) -> Source | None:
    """The statement of `found` for a number that was read in some calls; None if it does not count."""
    k = 0
    while k < min(len(read), len(written)) and read[k] == written[k]:
        k += 1
    within = k < min(len(read), len(written)) and read[k][0] is written[k][0]
    place = k if within else k - 1
    return found.get(read[place]) if place >= 0 else None


@cache
def _tree(path: str) -> ast.Module | None:
    try:
        return ast.parse(Path(path).read_text("utf-8"))
    except (OSError, ValueError, SyntaxError):
        return None


@cache
def _statements(code: CodeType) -> list[Statement]:
    """The statements of a routine that assign, call or return."""
    tree = _tree(code.co_filename)
    for node in ast.walk(tree) if tree else ():
        if isinstance(node, ast.FunctionDef) and node.name == code.co_name:
            first = min([node.lineno, *(one.lineno for one in node.decorator_list)])
            if first <= code.co_firstlineno <= node.lineno:
                return [one for one in ast.walk(node) if isinstance(one, Statement)]
    return []


def _lines(statement: Statement) -> range:
    """The lines of a statement; of a loop those of its head."""
    end = statement.iter if isinstance(statement, ast.For) else statement
    return range(statement.lineno, (end.end_lineno or statement.lineno) + 1)


def _parts(statement: Statement) -> Iterator[ast.expr]:
    """Targets of a statement and what it computes; not what stands in a loop."""
    return (one for one in ast.iter_child_nodes(statement) if isinstance(one, ast.expr))


def _names(statement: Statement) -> set[str]:
    """Variables that a statement computes with."""
    nodes = (node for part in _parts(statement) for node in ast.walk(part) if isinstance(node, ast.Name))
    added = isinstance(statement, ast.AugAssign)
    return {node.id for node in nodes if added or isinstance(node.ctx, ast.Load)} - NOT_VALUES


def _assigned(statement: Statement) -> set[str]:
    """Variables that a statement assigns."""
    nodes = (node for part in _parts(statement) for node in ast.walk(part) if isinstance(node, ast.Name))
    return {node.id for node in nodes if isinstance(node.ctx, ast.Store)}


def _arguments(statement: Statement, callee: str, arguments: set[int]) -> set[str]:
    """Variables in the arguments of a call; arguments: numbers of those that count."""
    for node in ast.walk(statement):
        name = getattr(node.func, "id", getattr(node.func, "attr", "")) if isinstance(node, ast.Call) else ""
        if isinstance(node, ast.Call) and name == callee:
            given = [one for k, one in enumerate(node.args) if k in arguments]
            names = {leaf.id for one in given for leaf in ast.walk(one) if isinstance(leaf, ast.Name)}
            return names - NOT_VALUES
    return _names(statement)


def _text(statement: Statement) -> str:
    """A statement on one line; of a loop its head."""
    if isinstance(statement, ast.For):
        return f"for {ast.unparse(statement.target)} in {ast.unparse(statement.iter)}"
    return printable(ast.unparse(statement), LINE)
