"""Forms of the methods of Model: functions of its session, and operations on its array, as methods."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import update_wrapper, wraps
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, TypeVar, get_type_hints

from udec_ia.heap.main_array import MainArray

if TYPE_CHECKING:
    from udec_ia.model.model_session import Session

P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")


class InSession(Generic[T]):
    """An attribute of a Model that its session holds under the same name."""

    def __set_name__(self, _: type, name: str) -> None:
        self.name = name

    def __get__(self, model: Any, _: type | None = None) -> T:
        value: Any = self if model is None else getattr(model.session, self.name)
        return value  # type: ignore[no-any-return]

    def __set__(self, model: Any, value: T) -> None:
        setattr(model.session, self.name, value)


def of_session(function: Callable[Concatenate[Session, P], R]) -> Callable[Concatenate[Any, P], R]:
    """`function` of a session as a method of Model with its other arguments, name and docstring."""

    def method(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
        return function(model.session, *args, **named)

    return _method_of_model(method, function)


def on_sound_outlines(op: Callable[Concatenate[MainArray, P], R]) -> Callable[Concatenate[Any, P], R]:
    """`op` as a method of the same arguments, for an operation that needs sound outlines."""

    def method(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
        model.session.ensure_ready(shapes=True)
        return op(model.array, *args, **named)

    return _method_of_model(method, op)


def _method_of_model(method: Callable[P, R], function: Callable[..., Any]) -> Callable[P, R]:
    """`method` with the name, docstring and parameters of `function`, whose first argument is the model."""
    update_wrapper(method, function)
    plain = inspect.signature(function)
    first, *others = plain.parameters.values()
    model = first.replace(name="self", annotation=inspect.Parameter.empty)
    method.__signature__ = plain.replace(parameters=[model, *others])  # type: ignore[attr-defined]
    return method


def takes_keywords(names: type) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """The method's **values are the keys of the TypedDict `names`, all optional. TypeError for any other."""

    def described(method: Callable[P, R]) -> Callable[P, R]:
        """`method` with the names in its signature, which are checked when it is called."""
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
