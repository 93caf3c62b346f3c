"""Arguments that follow from the field table: a method that takes them says so like any other."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar, get_type_hints

P = ParamSpec("P")
R = TypeVar("R")


def takes(names: type) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """The method's **values are the keys of the TypedDict `names`, all optional. TypeError for any other."""

    def described(method: Callable[P, R]) -> Callable[P, R]:
        """`method` with the names in its signature, and looked at when it is called."""
        plain = inspect.signature(method)
        fixed = [one for one in plain.parameters.values() if one.kind is not one.VAR_KEYWORD]
        named = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind)
            for name, kind in get_type_hints(names).items()
        ]
        signature = plain.replace(parameters=[*fixed, *named])

        @wraps(method)
        def checked(*args: P.args, **values: P.kwargs) -> R:
            try:
                signature.bind(*args, **values)
            except TypeError as error:
                raise TypeError(f"{method.__name__}() {error}") from None
            return method(*args, **values)

        checked.__signature__ = signature  # type: ignore[attr-defined]
        return checked

    return described
