"""Conditions on groups, such as `block where KXD > 0.1 and KMAT == 2`: parsed, checked and evaluated.

The part after `where` has the form of a Python expression of fields of the kind, KZG(2) for an element,
`address`, numbers, names of codes, comparisons, and, or, not, + - * / and abs(). `KB1.KXD` is the field KXD
of the group that KB1 leads to; a comparison with what a pointer does not lead to is false. Nothing is run as
Python: each node of the tree gives a number or a truth value for each group, as one NumPy array.

An expression of single numbers, such as `block@88.KXD - block@274.KXD`, is evaluated in the same way.
"""

from __future__ import annotations

import ast
import operator
import re
import warnings
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from udec_ia.reader.place_grammar import PlaceError, find_number
from udec_ia.reader.word_map import KINDS, TABLE, Atlas, choices, kind_named

LONGEST = 500  # characters of a condition: so deep it can be
ADDRESS = "address"
CONSTANTS = {head.name: head.value for head in TABLE.heads} | {code.name: code.value for code in TABLE.codes}
SUMS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}
ORDERS = ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE
OPERATORS = operator.eq, operator.ne, operator.lt, operator.le, operator.gt, operator.ge
COMPARISONS: dict[type[ast.AST], Callable[[Any, Any], Any]] = dict(zip(ORDERS, OPERATORS, strict=True))
ALLOWED = "fields, address, numbers, comparisons, and, or, not, + - * /, abs()"
FORM = re.compile(r"\s*(\S+)(?:\s+(\S+)(.*))?", re.DOTALL)
ELEMENT = r"[A-Za-z]\w*(?:\(\d+\))?"
PLACE = re.compile(
    rf"(?<![\w.])(?:(?:grid-)?[A-Za-z]+@\d+(?:\.{ELEMENT})*|(?!abs\b){ELEMENT}(?:\.{ELEMENT})*)"
)
WORDS = ("and", "or", "not")


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
    typed, where, rest = given.groups()
    kind = kind_named(typed)
    if kind is None:
        raise Wrong(text, given.start(1), _no_kind(typed))
    at = atlas.groups[kind]
    if where is None:
        return MatchingGroups(kind, at, {})
    if where != "where":
        reason = f"after the kind of group write: where, and a condition of {ALLOWED}"
        raise Wrong(text, given.start(2), reason)
    condition = _ConditionEvaluator(atlas, kind, text, given.start(3))
    with np.errstate(all="ignore"):
        true = condition.truth(condition.tree(rest))
    return MatchingGroups(kind, at[true], {name: one.shown[true] for name, one in condition.columns.items()})


def evaluate(atlas: Atlas, text: str) -> float | bool:
    """The value of an expression of places, a number or a truth value. Raises Wrong, a ValueError."""
    if len(text) > LONGEST:
        raise ValueError(f"the expression is longer than {LONGEST} characters: shorten it")
    if not text.strip():
        raise ValueError("give a word or an expression, as in block@88.KXD or block@88.KXD > 0.1")
    places: dict[int, str] = {}

    def replaced(found: re.Match[str]) -> str:  # by a name as long that Python can read
        if found[0] in WORDS:
            return found[0]
        places[found.start()] = found[0]
        return "p" * len(found[0])

    expression = _PlaceEvaluator(atlas, text, 0, 1)
    expression.places = places
    with np.errstate(all="ignore"):
        tree = expression.tree(PLACE.sub(replaced, text))
        if not places:
            raise ValueError("the expression names no word: write block@88.KXD, FRAC, or 412 alone")
        negated = isinstance(tree, ast.UnaryOp) and isinstance(tree.op, ast.Not)
        if negated or isinstance(tree, ast.BoolOp | ast.Compare):
            return bool(np.all(expression.truth(tree)))
        return float(expression.number(tree))


def _no_kind(word: str) -> str:
    """The message about a word that is not a kind of group; often it is a field of one."""
    has = next((kind.name for kind in TABLE.groups for field in kind.fields if field.name == word), None)
    close = get_close_matches(word, KINDS, 1)
    advice = f"write {has} where {word} ..." if has else f"did you mean {close[0]}?" if close else ""
    return f"{word!r} is not a kind of group: {advice or 'there are ' + ', '.join(KINDS)}"


class _Evaluator:
    """Evaluates one expression for `many` groups, or for one number. start: where it begins in the text.

    absent: for each group, True if a pointer in the comparison at hand does not lead to what was named.
    """

    def __init__(self, atlas: Atlas, text: str, start: int, many: int) -> None:
        self.atlas, self.text, self.start, self.many = atlas, text, start, many
        self.absent = np.zeros(many, bool)

    def tree(self, rest: str) -> ast.expr:
        """The expression in Python's own form."""
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
        """An error at a node."""
        return Wrong(self.text, self.column(getattr(node, "col_offset", 0)), reason)

    def column(self, offset: int) -> int:
        """The column of the text for an offset of a tree, which counts bytes."""
        before = self.text[self.start :].encode()[:offset]
        return self.start + len(before.decode(errors="ignore"))

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
        self.absent = np.zeros(self.many, bool)
        sides = [self.number(side) for side in (node.left, *node.comparators)]
        true = ~self.absent
        for op, (left, right) in zip(node.ops, pairwise(sides), strict=True):
            true &= COMPARISONS[type(op)](left, right)
        return true

    def number(self, node: ast.expr) -> Any:
        """A part that is a number, for each group or for all of them; sums are of 64-bit reals."""
        match node:
            case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
                return value if abs(value) < 2**63 else float(str(value))
            case ast.Call(func=ast.Name(id="abs"), args=[part], keywords=[]):
                return np.abs(self._real(part))
            case ast.UnaryOp(op=ast.USub(), operand=part):
                return -self.number(part)
            case ast.UnaryOp(op=ast.UAdd(), operand=part):
                return self.number(part)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in SUMS:
                return SUMS[type(op)](self._real(left), self._real(right))
            case ast.Compare() | ast.BoolOp() | ast.UnaryOp(op=ast.Not()):
                raise self.wrong(node, "this is true or false, and no number")
        if steps := self.steps(node):
            return self.named(steps)
        raise self.wrong(node, f"this is not allowed in a condition: there are {ALLOWED}")

    def _real(self, node: ast.expr) -> Any:
        return np.asarray(self.number(node), np.float64)

    def steps(self, node: ast.expr) -> list[tuple[str, int]]:
        """The fields of a path with the column of each, KB1 and KXD of KB1.KXD; none for what is no path."""
        match node:
            case ast.Name(id=name):
                return [(name, self.column(node.col_offset))]
            case ast.Call(func=ast.Name() | ast.Attribute() as of, args=[part], keywords=[]):
                *before, (name, column) = self.steps(of) or [("", 0)]
                return [*before, (f"{name}({ast.unparse(part)})", column)] if name else []
            case ast.Attribute(value=of, attr=name) if before := self.steps(of):
                return [*before, (name, self.column((node.end_col_offset or 0) - len(name.encode())))]
        return []

    def named(self, steps: list[tuple[str, int]]) -> Any:
        """What a name or a path stands for."""
        raise NotImplementedError


class _Column(NamedTuple):
    """Values of a path for groups (n,). there: False for those whose pointers do not lead so far."""

    values: Any
    there: Any

    @property
    def shown(self) -> Any:
        """The values, "" where there is none."""
        return self.values if self.there.all() else np.where(self.there, self.values.astype(object), "")


class _ConditionEvaluator(_Evaluator):
    """Evaluates a condition for all groups of a kind. columns: of the fields and paths that it names."""

    def __init__(self, atlas: Atlas, kind: str, text: str, start: int) -> None:
        super().__init__(atlas, text, start, len(atlas.groups[kind]))
        self.kind = kind
        self.columns: dict[str, _Column] = {}

    def named(self, steps: list[tuple[str, int]]) -> Any:
        """The address, a code, a field, or a field of another group."""
        name = ".".join(step for step, _ in steps)
        if name == ADDRESS:
            return self.atlas.groups[self.kind]
        if name in CONSTANTS:
            return CONSTANTS[name]
        if name not in self.columns:
            self.columns[name] = self._followed(steps)
        self.absent |= ~self.columns[name].there
        return self.columns[name].values

    def _followed(self, steps: list[tuple[str, int]]) -> _Column:
        """The values at the end of a path."""
        kinds: tuple[str, ...] = (self.kind,)
        at = self.atlas.groups[self.kind]
        there = np.ones(self.many, bool)
        for k, (name, column) in enumerate(steps):
            words = {kind: word for kind in kinds for word in self.atlas.shapes[kind] if word.name == name}
            if not words:
                raise Wrong(self.text, column, self._no_field(kinds, name))
            real = any(word.field.real for word in words.values())
            values, found = np.zeros(self.many, np.float64 if real else np.int64), ~there
            for kind, word in words.items():
                here = there & self.atlas.holding(kind, at) if k else there
                values[here] = self.atlas.gather(word, at[here])
                found |= here
            there &= found
            if k + 1 < len(steps):
                targets = [word.field.target for word in words.values() if word.field.target]
                if not targets:
                    raise Wrong(self.text, column, f"{name} is not a pointer: nothing can follow it")
                kinds, at = tuple(dict.fromkeys(kind for one in targets for kind in choices(one))), values
        return _Column(values, there)

    def _no_field(self, kinds: Sequence[str], name: str) -> str:
        """The message about a name that no field of these kinds has."""
        words = {word.name: word for kind in kinds for word in self.atlas.shapes[kind]}
        several = [one for one in words if one.partition("(")[0] == name.partition("(")[0]]
        if several:
            return f"there is no {name}, but {several[0]} to {several[-1]}"
        known = [*words, *CONSTANTS]
        close = get_close_matches(name, known, 1) or get_close_matches(name.upper(), known, 1)
        advice = f"did you mean {close[0]}?" if close else f"it has {', '.join(words)}"
        return f"a {' or '.join(kinds)} has no field {name}: {advice}"


class _PlaceEvaluator(_Evaluator):
    """Evaluates an expression of places. places: by the column at which each begins."""

    places: dict[int, str]

    def named(self, steps: list[tuple[str, int]]) -> Any:
        """The number at a place, or a code."""
        (name, column), *_ = steps
        text = self.places.get(column, "")
        if len(steps) > 1 or not text or name != "p" * len(text):
            reason = "this is no name of a word, such as block@88.KXD, FRAC or AKN(2)"
            raise Wrong(self.text, column, reason)
        if text in CONSTANTS:
            return CONSTANTS[text]
        try:
            value = find_number(self.atlas, text).value(self.atlas.h)
        except PlaceError as error:
            raise Wrong(self.text, column + error.column, f"{error.detail}: {error.advice}") from None
        if value is None:
            raise Wrong(self.text, column, "this word is not in use")
        return value
