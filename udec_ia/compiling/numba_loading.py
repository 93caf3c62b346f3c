"""numba, which is loaded when the first kernel is to run compiled, and not before.

To load it takes longer than to look into a restart file. So what numba has to know of a function of ours, as
how `iget` is compiled, stands in a file of its own, and `numba_form` names it.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

T = TypeVar("T")
_pending: list[tuple[str, Any]] = []


def numba_form(by: str) -> Callable[[T], T]:
    """Decorator of a function or class that is compiled in a form of its own.

    by: "module:function" that registers the form with numba; it is called when numba is loaded.
    """

    def decorator(one: T) -> T:
        _pending.append((by, one))
        return one

    return decorator


def load() -> None:
    """Register all forms with numba that are not yet registered."""
    while _pending:
        by, one = _pending[0]
        module, _, register = by.partition(":")
        getattr(import_module(module), register)(one)
        _pending.pop(0)  # not before: an interrupt may come between
