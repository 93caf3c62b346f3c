"""Conditions on groups, such as `block where KXD > 0.1 and KMAT == 2`: parsed, checked and evaluated.

The part after `where` has the form of a Python expression of fields of the kind, KZG(2) for an element,
`address`, numbers, names of codes, comparisons, and, or, not, + - * / and abs(). It is never run as Python:
each node of its tree gives a number or a truth value for each group, as one NumPy array.
"""

from __future__ import annotations

import ast
import operator
import re
import warnings
from collections.abc import Callable
from difflib import get_close_matches
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from udec_ia.reader.word_map import KINDS, TABLE, Atlas, Word

LONGEST = 500  # characters of a condition: so deep it can be
ADDRESS = "address"
CONSTANTS = {head.name: head.value for head in TABLE.heads} | {code.name: code.value for code in TABLE.codes}
SUMS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
ORDERS = ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE
OPERATORS = operator.eq, operator.ne, operator.lt, operator.le, operator.gt, operator.ge
COMPARISONS: dict[type[ast.AST], Callable[[Any, Any], Any]] = dict(zip(ORDERS, OPERATORS, strict=True))
ALLOWED = "fields, address, numbers, comparisons, and, or, not, + - * /, abs()"
FORM = re.compile(r"\s*(\S+)(?:\s+(\S+)(.*))?", re.DOTALL)


class Wrong(ValueError):
    """A condition that cannot be understood: what is wrong, the text, and a caret below the place."""

    def __init__(self, text: str, column: int, reason: str) -> None:
        self.column = column
        line = re.sub(r"\s", " ", text)
        super().__init__(f"{reason}\n    {line}\n    {' ' * column}^")


class MatchingGroups(NamedTuple):
    """Groups of a kind, by address (n,), that a condition is true for, and the fields that it names (n,)."""

    kind: str
    at: Any
    columns: dict[str, Any]


def satisfying(atlas: Atlas, text: str) -> MatchingGroups:
    """The groups that a condition is true for; a kind alone is all of them. Raises Wrong, a ValueError."""
    if len(text) > LONGEST:
        raise ValueError(f"the condition is longer than {LONGEST} characters: shorten it")
    given = FORM.match(text)
    if given is None:
        raise ValueError("give a kind of group and a condition, as in: block where KXD > 0.1")
    kind, where, rest = given.groups()
    if kind not in KINDS:
        raise Wrong(text, given.start(1), _no_kind(kind))
    at = atlas.groups[kind]
    if where is None:
        return MatchingGroups(kind, at, {})
    if where != "where":
        reason = f"after the kind of group write: where, and a condition of {ALLOWED}"
        raise Wrong(text, given.start(2), reason)
    condition = _ConditionEvaluator(atlas, kind, text, given.start(3))
    with np.errstate(all="ignore"):
        true = condition.truth(condition.tree(rest))
    return MatchingGroups(kind, at[true], {name: values[true] for name, values in condition.columns.items()})


def _no_kind(word: str) -> str:
    """The message about a word that is not a kind of group; often it is a field of one."""
    has = next((kind.name for kind in TABLE.groups for field in kind.fields if field.name == word), None)
    close = get_close_matches(word, KINDS, 1)
    advice = f"write {has} where {word} ..." if has else f"did you mean {close[0]}?" if close else ""
    return f"{word!r} is not a kind of group: {advice or 'there are ' + ', '.join(KINDS)}"


class _ConditionEvaluator:
    """Evaluates one condition for all groups of a kind. columns: values of the fields that it names."""

    def __init__(self, atlas: Atlas, kind: str, text: str, start: int) -> None:
        self.atlas, self.kind, self.text, self.start = atlas, kind, text, start
        self.words: dict[str, Word] = {word.name: word for word in atlas.shapes[kind]}
        self.columns: dict[str, Any] = {}

    def tree(self, rest: str) -> ast.expr:
        """The expression after `where`, in Python's own form."""
        plain = re.sub(r"\s", " ", rest)
        source = plain.lstrip()
        self.start += len(plain) - len(source)
        if not source:
            raise Wrong(self.text, len(self.text), f"after where write a condition of {ALLOWED}")
        try:
            with warnings.catch_warnings(action="ignore"):
                return ast.parse(source, mode="eval").body
        except SyntaxError as error:
            column = min(max((error.offset or 1) - 1, 0), len(source))
            hint = "; for equal write ==" if source[column : column + 2] in ("= ", "=") else ""
            raise Wrong(self.text, self.start + column, f"this cannot be understood{hint}") from None
        except (ValueError, RecursionError, MemoryError) as error:
            raise Wrong(self.text, self.start, f"this cannot be understood: {error}") from None

    def wrong(self, node: ast.AST, reason: str) -> Wrong:
        """An error at a node; columns of a tree count bytes."""
        before = self.text[self.start :].encode()[: getattr(node, "col_offset", 0)]
        return Wrong(self.text, self.start + len(before.decode(errors="ignore")), reason)

    def truth(self, node: ast.expr) -> Any:
        """A part that is true or false, for each group."""
        match node:
            case ast.BoolOp(op=ast.And(), values=parts):
                return np.logical_and.reduce([self.truth(part) for part in parts])
            case ast.BoolOp(values=parts):
                return np.logical_or.reduce([self.truth(part) for part in parts])
            case ast.UnaryOp(op=ast.Not(), operand=part):
                return ~self.truth(part)
            case ast.Compare():
                return self._compared(node)
        self.number(node)  # may have more to complain of
        raise self.wrong(node, "this is a number, neither true nor false: compare it, such as with != 0")

    def _compared(self, node: ast.Compare) -> Any:
        if any(type(op) not in COMPARISONS for op in node.ops):
            raise self.wrong(node, f"no such comparison: there are {ALLOWED}")
        sides = [self.number(side) for side in (node.left, *node.comparators)]
        true = np.ones(len(self.atlas.groups[self.kind]), bool)
        for op, (left, right) in zip(node.ops, pairwise(sides), strict=True):
            true &= COMPARISONS[type(op)](left, right)
        return true

    def number(self, node: ast.expr) -> Any:
        """A part that is a number, for each group or for all of them; sums are of 64-bit reals."""
        match node:
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                return value if abs(value) < 2**63 else float(str(value))
            case ast.Name(id=name):
                return self._named(node, name)
            case ast.Call(func=ast.Name(id="abs"), args=[part], keywords=[]):
                return np.abs(self._real(part))
            case ast.Call(func=ast.Name(id=name), args=[part], keywords=[]):
                return self._named(node, f"{name}({ast.unparse(part)})")
            case ast.UnaryOp(op=ast.USub(), operand=part):
                return -self.number(part)
            case ast.UnaryOp(op=ast.UAdd(), operand=part):
                return self.number(part)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in SUMS:
                return SUMS[type(op)](self._real(left), self._real(right))
            case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
                raise self.wrong(node, "this is true or false, and no number")
        raise self.wrong(node, f"this is not allowed in a condition: there are {ALLOWED}")

    def _real(self, node: ast.expr) -> Any:
        return np.asarray(self.number(node), np.float64)

    def _named(self, node: ast.expr, name: str) -> Any:
        """The address, a field, or a code."""
        if name == ADDRESS:
            return self.atlas.groups[self.kind]
        if name in CONSTANTS:
            return CONSTANTS[name]
        if name not in self.words:
            raise self.wrong(node, self._no_field(name))
        if name not in self.columns:
            values = self.atlas.gather(self.words[name], self.atlas.groups[self.kind])
            self.columns[name] = values.astype(np.float64) if self.words[name].field.real else values
        return self.columns[name]

    def _no_field(self, name: str) -> str:
        several = [one for one in self.words if one.partition("(")[0] == name.partition("(")[0]]
        if several:
            return f"there is no {name}, but {several[0]} to {several[-1]}"
        known = [*self.words, *CONSTANTS]
        close = get_close_matches(name, known, 1) or get_close_matches(name.upper(), known, 1)
        advice = f"did you mean {close[0]}?" if close else f"it has {', '.join(self.words)}"
        return f"a {self.kind} has no field {name}: {advice}"
