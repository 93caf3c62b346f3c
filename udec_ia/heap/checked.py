"""The checked build: kernels that look at what stands at an address before they read or write there.

It is chosen by UDEC_CHECKED=1 in the environment, or `udec --checked`, before the kernels are loaded. An
offset is then a longer tuple. After the three offsets come the kind of the group that has the field, how many
words or reals the field has, the number of its name, and the number of the kernel in whose source it stands:
what the accessors need to look (guarding.py), and to say what is wrong. In an ordinary build nothing of this
is there.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table

CHECKED = os.environ.get("UDEC_CHECKED", "") not in ("", "0")
TABLE = read_table()
NOTHING = 0  # no group begins at an address
WITH_HEAD, WHATEVER = -1, -2  # kinds of group that a field may be of: one with a head code, or any at all
KINDS = ("", *(group.name for group in TABLE.groups), "junk group")  # by their number
SPARE = len(KINDS) - 1  # a group that was given back
HEADED = sum(1 << KINDS.index(name) for name in {head.group for head in TABLE.heads})
KIND, COUNT, FIELD, ROUTINE = 3, 4, 5, 6  # places in a longer tuple
NAMES = ["a field"]  # of fields and sizes, by their number
UNNAMED = 0
ROUTINES = ["a routine"]  # by their number; 0 is what Python hands over


def offset(name: str, words: tuple[int, ...], kind: int, count: int = 1) -> Any:
    """The offsets `words` of the field `name` as kernels of this build take them."""
    if not CHECKED:
        return words
    NAMES.append(name)
    return (*words, kind, count, len(NAMES) - 1, 0)


def _at_offset(k: int, kind: int, own: Any) -> Any:
    """Field `k` of groups of kind `kind`, counted from 1, for the routine that has the offset `own`."""
    return k, k, k


def _checked_at_offset(k: int, kind: int, own: Any) -> Any:
    return k, k, k, kind, 1, UNNAMED, own[ROUTINE]


at_offset = _checked_at_offset if CHECKED else _at_offset


def _lengthen() -> None:
    """Every offset and size of the table, in its place."""
    for kind, group in enumerate(TABLE.groups, 1):
        setattr(g, group.size_name, offset(group.size_name, getattr(g, group.size_name), kind))
        for field in group.fields:
            if field.role != "head":
                setattr(g, field.name, offset(field.name, getattr(g, field.name), kind, field.count))


class _Names(dict[str, Any]):
    """The names that a kernel knows: those of its module, which may still grow, and a few of its own."""

    def __init__(self, module: dict[str, Any], own: dict[str, Any]) -> None:
        super().__init__(own, __builtins__=module["__builtins__"], __name__=module["__name__"])
        self.module = module

    def __missing__(self, name: str) -> Any:
        return self.module[name]


def of_routine(value: Any, number: int) -> Any:
    """An offset as routine `number` has it, or tuples of them; all else as it is."""
    if not isinstance(value, tuple) or not value:
        return value
    if len(value) == ROUTINE + 1 and all(isinstance(word, int) for word in value):
        return (*value[:ROUTINE], number) if 0 <= value[FIELD] < len(NAMES) else value
    return tuple(of_routine(one, number) for one in value) if type(value) is tuple else value


def named(function: Callable[..., Any]) -> tuple[Any, int]:
    """`function`, with offsets that say that they are its own, and its number."""
    code = function.__code__
    path = Path(code.co_filename)
    ROUTINES.append(f"{function.__name__} ({path.parent.name}/{path.name})")
    number, module = len(ROUTINES) - 1, function.__globals__
    own = {name: of_routine(module[name], number) for name in code.co_names if name in module}
    if own.get("g") is g:
        own["g"] = ModuleType(g.__name__)
        own["g"].__dict__.update({name: of_routine(value, number) for name, value in vars(g).items()})
    changed = {name: value for name, value in own.items() if value is not module[name]}
    same = FunctionType(code, _Names(module, changed), function.__name__, function.__defaults__)
    for name in ("__module__", "__qualname__", "__doc__", "__kwdefaults__", "__annotations__"):
        setattr(same, name, getattr(function, name))
    return same, number


if CHECKED:
    _lengthen()
