"""From a call in Python back to the lines of a deck, as `Model.deck` writes them."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np

from udec_ia.deck.command_forms import SESSION, SEVERAL, Command
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import CONTINUATION

WIDTH = 79  # of a line
# Commands of the session do not change the state.
BY_NAME = {one.name: one for one in COMMANDS if one.kind is not SESSION}


def spell(method: Callable[..., Any], args: Sequence[Any], named: dict[str, Any]) -> list[str]:
    """The lines of a deck for method(model, *args, **named), a method of Model; none if it is no command."""
    command = BY_NAME.get(method.__name__)
    if command is None:
        return []
    given = _signature(method).bind(None, *args, **named).arguments
    if command.text:  # must be on one line
        last = [word.keyword.upper() for word in command.words if given.get(word.argument)]
        more = (str(one) for values in given.values() if isinstance(values, tuple) for one in values)
        return [" ".join([command.keyword.upper(), *str(given[command.text]).split(), *more, *last])]
    line = " ".join([command.keyword.upper(), *_parts(command, _signature(method), given)])
    if any(word.text and word.argument in given for word in command.words):
        return [line]
    indent = f"{CONTINUATION} "
    return textwrap.wrap(
        line, WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


@cache
def _signature(method: Callable[..., Any]) -> inspect.Signature:
    return inspect.signature(method)


def _parts(command: Command, signature: inspect.Signature, given: dict[str, Any]) -> Iterator[str]:
    """The parameters of `command` in the order of a deck: numbers, words, list."""
    _, *parameters = signature.parameters.values()
    numbers = len(command.numbers.split() + command.optional.split())
    for parameter in parameters[:numbers]:
        if (value := given.get(parameter.name)) is not None:
            yield value if isinstance(value, str) else _number(value)
    several: tuple[Any, ...] = ()
    for parameter in sorted(parameters[numbers:], key=lambda one: one.name != command.first):
        value = given.get(parameter.name, parameter.default)
        if parameter.kind is parameter.VAR_POSITIONAL:
            several = given.get(parameter.name, ())
        elif parameter.name == command.first or not _is_default(value, parameter.default):
            yield from _word(command, parameter.name, value)
    if any(word.argument == SEVERAL for word in command.words):
        yield from (str(one).upper() for one in several)
    else:
        yield from _tuples(several, command.list)


def _is_default(value: Any, default: Any) -> bool:
    """True if a parameter with this value can be omitted."""
    return value is None or value is False or np.array_equal(value, default)


def _word(command: Command, argument: str, value: Any) -> Iterator[str]:
    """The word that sets `argument` to `value`, and its numbers."""
    named = str(value).lower()
    words = [word for word in command.words if word.argument == argument]
    word = next(one for one in words if one.values or not one.sets or one.keyword.lower() == named)
    yield word.keyword.upper()
    if word.text:
        quote = "'" if '"' in str(value) else '"'
        yield f"{quote}{value}{quote}"
    elif word.repeated:
        yield from _tuples(value, word.values)
    elif word.values and value is not True:  # True: the word without its numbers
        yield from map(_number, np.atleast_1d(value).tolist())


def _tuples(values: Any, names: str) -> Iterator[str]:
    """Tuples of numbers, without a blank in a tuple."""
    for row in np.reshape(np.asarray(values), (-1, len(names.split()) or 1)).tolist():
        yield ",".join(map(_number, row))


def _number(value: Any) -> str:
    """The shortest text that is read as the same number."""
    if isinstance(value, int | np.integer):
        return str(int(value))
    short = f"{float(value):g}"
    return short if float(short) == float(value) else repr(float(value))
