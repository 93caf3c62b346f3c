"""Reads quantities and rules to stop at as users write them; wrong ones are errors with a caret.

    time, cycles, KINETIC, WFRIC              of the whole model: what HISTORY can record without a place
    block(5, 5).KY, contact(2, 1).KCFN        a field of the group at a place (quantities.py)
    block(5, 5).DISPLACEMENT                  since the first cycle; XDISPLACEMENT, YDISPLACEMENT
    max contact.KCFN where KCM == 2           or min, mean, sum, with a condition or without (condition.py)
    count block where KXD > 0.1
    last history 1                            or max, min, mean
    energy.friction                           a line of the account of the energy
    solve.reached, solve.ratio, solve.cycles, solve.motion, solve.fallen      of the last SOLVE

NAME = QUANTITY gives it a name of its own. A rule is a quantity, a comparison and a number.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from typing import NamedTuple

from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.ops.commands.energy_account import Balance
from udec_ia.reader.atlas import KINDS, Atlas
from udec_ia.reader.conditions import Wrong, satisfying
from udec_ia.reader.recordable_numbers import recordable
from udec_ia.studies import quantities as forms
from udec_ia.studies.quantities import DISPLACEMENTS, OF_SERIES, OVER, PLACES, Quantity, State

NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
FIELD = r"([A-Za-z]\w*(?:\(\d+\))?)"
NAMED = re.compile(r"\s*([A-Za-z][\w ./-]*?)\s*=(?!=)\s*(?=\S)")
AT_PLACE = re.compile(rf"(\w+)\s*\(\s*({NUMBER})\s*,\s*({NUMBER})\s*\)\s*\.\s*{FIELD}\s*")
OVER_ALL = re.compile(rf"(\w+)\s+(\w+)\s*\.\s*{FIELD}\s*(?:(\w+)(\s.*)?)?", re.DOTALL)
COUNT = re.compile(r"count\s+(\w+)\s*(?:(\w+)(\s.*)?)?", re.DOTALL)
HISTORY = re.compile(r"(\w+)\s+history\s+(\d+)\s*")
OF = re.compile(r"(energy|solve)\s*\.\s*(\w+)\s*")
RULE = re.compile(rf"(.*\S)\s*(<=|>=|==|!=|<|>)\s*({NUMBER})\s*", re.DOTALL)
COMPARISONS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}
OTHER_NAMES = {"time": "TIME", "cycles": "MCTOT"}
SOLUTION = ("reached", "ratio", "cycles", "motion", "fallen")
ENERGIES = (*Balance._fields, "strain", "residual", "throughput")
FORMS = (
    "write time, block(5, 5).KY, max contact.KCFN where ..., count block where ..., last history 1, "
    "energy.friction or solve.ratio"
)
DEFAULTS = (
    "time",
    "displacement = max block.DISPLACEMENT",
    "force = max contact.KCFN",
    "ratio = RATIO",
)


class Named(NamedTuple):
    """A quantity and the name of its column."""

    name: str
    quantity: Quantity


class Rule(NamedTuple):
    """A rule to stop at. text: as it was written."""

    text: str
    quantity: Quantity
    comparison: str
    number: float

    def holds(self, state: State) -> bool:
        """True if a run is to stop in this state. Raises NoValue."""
        return COMPARISONS[self.comparison](self.quantity.value(state), self.number)


def read_quantities(texts: Iterable[str]) -> list[Named]:
    """The quantities in `texts`, with their names. ValueError, with a caret, for a wrong one."""
    found: list[Named] = []
    for text in texts:
        given = NAMED.match(text)
        one = Named(given[1] if given else text.strip(), _quantity(text, given.end() if given else 0))
        if one.name in (other.name for other in found):
            raise ValueError(
                f"two quantities are called {one.name}: give one of them a name, as in NAME = time"
            )
        found.append(one)
    return found


def read_rule(text: str) -> Rule:
    """The rule in `text`. ValueError, with a caret, for a wrong one."""
    found = RULE.fullmatch(text)
    if found is None:
        raise Wrong(text, len(text), "a rule ends with a comparison and a number, as in max block.KXD > 1")
    return Rule(text.strip(), _quantity(found[1], 0), found[2], _number(text, found, 3))


def _quantity(text: str, start: int) -> Quantity:
    """The quantity that `text` is from the column `start` on."""
    start += len(text[start:]) - len(text[start:].lstrip())
    if found := AT_PLACE.fullmatch(text, start):
        kind = _kind(text, found, 1)
        x, y = (_number(text, found, part) for part in (2, 3))
        return forms.at_place(kind, x, y, _field(text, found, 4, kind))
    if found := HISTORY.fullmatch(text, start):
        number = int(_number(text, found, 2))
        if number < 1:
            raise Wrong(text, found.start(2), "histories count from 1")
        return forms.of_history(_one_of(text, found, 1, OF_SERIES), number)
    if found := COUNT.fullmatch(text, start):
        kind = _kind(text, found, 1)
        return forms.count(kind, _where(text, found, 2, kind))
    if found := OVER_ALL.fullmatch(text, start):
        how, kind = _one_of(text, found, 1, OVER), _kind(text, found, 2)
        return forms.over_groups(how, kind, _field(text, found, 3, kind), _where(text, found, 4, kind))
    if found := OF.fullmatch(text, start):
        if found[1] == "energy":
            return forms.of_energy(_one_of(text, found, 2, ENERGIES))
        return forms.of_solve(_one_of(text, found, 2, SOLUTION))
    return _of_model(text, start)


def _number(text: str, found: re.Match[str], part: int) -> float:
    value = float(found[part])
    if not math.isfinite(value):
        raise Wrong(text, found.start(part), "this is too large a number")
    return value


def _of_model(text: str, start: int) -> Quantity:
    """The variable or quantity of the whole model that `text` names."""
    typed = text[start:].strip()
    what = recordable().get(OTHER_NAMES.get(typed.lower(), typed.upper()))
    if what is None:
        known = [*OTHER_NAMES, *(name for name, one in recordable().items() if not one.group)]
        raise Wrong(text, start, f"this is not a quantity: {_suggestion(typed, known) or FORMS}")
    if what.group:
        name = what.field.name
        advice = f"write {what.group}(x, y).{name}, or max {what.group}.{name}"
        raise Wrong(text, start, f"{name} of which {what.group}? {advice}")
    return forms.of_model(what)


def _kind(text: str, found: re.Match[str], part: int) -> str:
    return _one_of(text, found, part, KINDS, "no kind of group is called so")


def _field(text: str, found: re.Match[str], part: int, kind: str) -> str:
    known = [word.name for word in _empty().shapes[kind]] + [*(DISPLACEMENTS if kind in PLACES else ())]
    return _one_of(text, found, part, known, f"a {kind} has no field {found[part]}")


def _one_of(
    text: str, found: re.Match[str], part: int, known: Iterable[str], what: str = "this is not known here"
) -> str:
    """The one of `known` that is written there, in upper or lower case."""
    names = {name.upper(): name for name in known}
    typed = found[part].upper()
    if typed not in names:
        advice = _suggestion(typed, names.values()) or f"there are {', '.join(names.values())}"
        raise Wrong(text, found.start(part), f"{what}: {advice}")
    return names[typed]


def _where(text: str, found: re.Match[str], part: int, kind: str) -> str:
    """The condition behind `where`, tried on a model without groups; "" if there is none."""
    if found[part] is None:
        return ""
    if found[part] != "where":
        raise Wrong(text, found.start(part), "the text after it must begin with: where")
    condition, begin = found[part + 1] or "", f"{kind} where"
    try:
        satisfying(_empty(), begin + condition)
    except Wrong as wrong:
        raise Wrong(
            text, wrong.column - len(begin) + found.end(part), str(wrong).partition("\n")[0]
        ) from None
    return condition.strip()


def _empty() -> Atlas:
    """A model without groups, which knows all fields."""
    return Atlas(MainArray(scheme(DEFAULT_SCHEME)).h)


def _suggestion(typed: str, known: Iterable[str]) -> str:
    """`did you mean`, if one of `known` is nearly what was typed."""
    by_case = {name.upper(): name for name in known}
    near = get_close_matches(typed.upper(), by_case, 1)
    return f"did you mean {by_case[near[0]]}?" if near else ""
