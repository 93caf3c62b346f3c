"""What was done in Python, said as a deck says it: the way back from a call to its lines.

`parser.parse` makes of a line the call of a method of Model; `spell` makes of such a call a line, from the
same table. Numbers are written with as many digits as it takes to read the same ones again.
"""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np

from udec_ia.deck.language import COMMANDS, SESSION, SEVERAL, Command, Word
from udec_ia.deck.reader import CONTINUATION

WIDTH = 79  # of a line
WHOLE_WORDS: dict[str, Any] = {"break_long_words": False, "break_on_hyphens": False}
# Commands of the session are no part of what has made a state.
BY_NAME = {one.name: one for one in COMMANDS if one.kind is not SESSION}


def spell(method: Callable[..., Any], args: Sequence[Any], named: dict[str, Any]) -> list[str]:
    """The lines of a deck that have done what method(model, *args, **named) does; none if no deck can.

    method: of Model, by its name a command.
    """
    command = BY_NAME.get(method.__name__)
    if command is None:
        return []
    given = _signature(method).bind(None, *args, **named).arguments
    if command.text:
        return [
            " ".join([command.keyword.upper(), *given[command.text].split()])
        ]  # which no line may be cut in
    parts = [command.keyword.upper(), *_parts(command, _signature(method), given)]
    return textwrap.wrap(" ".join(parts), WIDTH, subsequent_indent=f"{CONTINUATION} ", **WHOLE_WORDS)


@cache
def _signature(method: Callable[..., Any]) -> inspect.Signature:
    return inspect.signature(method)


def _parts(command: Command, signature: inspect.Signature, given: dict[str, Any]) -> Iterator[str]:
    """The parameters of `command` in the order of a deck: numbers, words, and the list that ends it."""
    _, *parameters = signature.parameters.values()
    numbers = len(command.numbers.split() + command.optional.split())
    for parameter in parameters[:numbers]:
        if given.get(parameter.name) is not None:
            yield _number(given[parameter.name])
    several: tuple[Any, ...] = ()
    for parameter in sorted(parameters[numbers:], key=lambda one: one.name != command.first):
        value = given.get(parameter.name, parameter.default)
        if parameter.kind is parameter.VAR_POSITIONAL:
            several = given.get(parameter.name, ())
        elif parameter.name == command.first or not _by_itself(value, parameter.default):
            yield from _word(command, parameter.name, value)
    if any(word.argument == SEVERAL for word in command.words):
        yield from (str(one).upper() for one in several)
    else:
        yield from _tuples(several, command.list)


def _by_itself(value: Any, default: Any) -> bool:
    """True if a parameter has this value, or one that says as little, when it is left off."""
    return value is None or value is False or np.array_equal(value, default)


def _word(command: Command, argument: str, value: Any) -> Iterator[str]:
    """The word that sets `argument` to `value`, and what follows it."""
    word = next(word for word in command.words if word.argument == argument and _says(word, value))
    yield word.keyword.upper()
    if word.repeated:
        yield from _tuples(value, word.values)
    elif len(word.values.split()) > 1:
        yield from map(_number, value)
    elif word.values:
        yield _number(value)


def _tuples(values: Any, names: str) -> Iterator[str]:
    """Numbers in tuples, each of which stays on one line."""
    for row in np.reshape(np.asarray(values), (-1, len(names.split()) or 1)).tolist():
        yield ",".join(map(_number, row))


def _says(word: Word, value: Any) -> bool:
    return bool(word.values) or not word.sets or word.keyword.lower() == str(value).lower()


def _number(value: Any) -> str:
    """A number, as short as it is read as the same."""
    if isinstance(value, int | np.integer):
        return str(int(value))
    short = f"{float(value):g}"
    return short if float(short) == float(value) else repr(float(value))
