"""Offsets that carry tags: kind of group, number of elements, name of the field, and routine that uses them.

In the checked build an offset is a longer tuple. After the three offsets come the kind of the group that has
the field, how many words or reals the field has, the number of its name, and the number of the kernel in
whose source it stands: what the accessors need to test an access (access_checks.py), and to name it.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

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


def tagged(name: str, words: tuple[int, ...], kind: str, count: int = 1) -> Any:
    """The offsets `words` of the field `name` of groups of a kind, with their tags."""
    NAMES.append(name)
    number = {"headed": WITH_HEAD, "any": WHATEVER}.get(kind) or KINDS.index(kind)
    return (*words, number, count, len(NAMES) - 1, 0)


def at_offset(k: int, kind: int, own: Any) -> Any:
    """Field `k` of groups of kind `kind`, counted from 1, for the routine that has the offset `own`."""
    return k, k, k, kind, 1, UNNAMED, own[ROUTINE]


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


def tag_routine(function: Callable[..., Any]) -> tuple[Any, int]:
    """`function`, with offsets that carry the tag of this routine, and its number."""
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


for _group in TABLE.groups:  # every offset and size of the table is exchanged, before kernels take it over
    setattr(g, _group.size_name, tagged(_group.size_name, getattr(g, _group.size_name), _group.name))
    for _field in _group.fields:
        if _field.role != "head":
            setattr(g, _field.name, tagged(_field.name, getattr(g, _field.name), _group.name, _field.count))
WANTED = {  # kind of the groups that have a field, by the number of its name
    value[FIELD]: value[KIND] for value in vars(g).values() if type(value) is tuple and len(value) > ROUTINE
}
