"""Arithmetic in braces of a deck: numbers, + - * / **, sqrt, pi, and sin, cos, tan of degrees."""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from typing import Any

OPERATIONS: dict[type, Callable[[float, float], Any]] = {
    **{ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul},
    **{ast.Div: operator.truediv, ast.Pow: math.pow},
}
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "sqrt": math.sqrt,
    "sin": lambda degrees: math.sin(math.radians(degrees)),
    "cos": lambda degrees: math.cos(math.radians(degrees)),
    "tan": lambda degrees: math.tan(math.radians(degrees)),
}


def calculate(text: str) -> float:
    """The value of an expression. ValueError for anything else, ArithmeticError without a value."""
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except SyntaxError as error:
        raise ValueError(f"{text.strip()} is no arithmetic") from error
    value = _value_of(tree)
    if not math.isfinite(value):
        raise ValueError(f"it is {value}")
    return value


def _value_of(node: ast.expr) -> float:
    if (
        isinstance(node, ast.Constant)
        and isinstance(node.value, int | float)
        and not isinstance(node.value, bool)
    ):
        return float(node.value)
    if isinstance(node, ast.Name) and node.id.lower() == "pi":
        return math.pi
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
        return _value_of(node.operand) * (-1.0 if isinstance(node.op, ast.USub) else 1.0)
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATIONS:
        return float(OPERATIONS[type(node.op)](_value_of(node.left), _value_of(node.right)))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and len(node.args) == 1:
        function = FUNCTIONS.get(node.func.id.lower())
        if function is not None and not node.keywords:
            return function(_value_of(node.args[0]))
    raise ValueError(f"{ast.unparse(node)} is not known")
