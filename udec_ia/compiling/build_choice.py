"""Which build of the kernels runs, compiled or interpreted, ordinary or checked; and when numba is loaded.

The environment decides: NUMBA_DISABLE_JIT=1 for Python, UDEC_CHECKED=1 (or `--checked`) for the checked
build, UDEC_LINK=plain for kernels without our own linking. numba is loaded when the first kernel is to run
compiled, as that takes longer than to look into a restart file. So the compiled form of a function such as
`iget` stands in a file of its own, and the decorator `numba_form` names it.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib import import_module
from typing import Any, TypeVar

T = TypeVar("T")
DISABLED = os.environ.get("NUMBA_DISABLE_JIT", "") not in ("", "0")  # as numba reads it: nothing is compiled
CHECKED = os.environ.get("UDEC_CHECKED", "") not in ("", "0")
TRIED = (0, 61), (0, 68)  # the first and the last release of numba on which kernel_linking.py was tried
JITABLE = "numba.extending:register_jitable"
_pending: list[tuple[str, Any]] = []  # forms that are not yet registered with numba


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


def plain_wanted() -> bool:
    """True if kernels are compiled without kernel_linking.py: on request, or as numba may have changed."""
    import numba

    release = tuple(int(part) for part in numba.__version__.split(".")[:2])
    return os.environ.get("UDEC_LINK") == "plain" or not TRIED[0] <= release <= TRIED[1]


def checked_build(part: str) -> Any:
    """A module of the checked build."""
    return import_module(f"udec_ia.checked_build.{part}")


def offset(name: str, words: tuple[int, ...], kind: str) -> Any:
    """The offsets `words` of a field that is not in the table, as kernels of this build take them.

    kind: of the groups that have it; "headed" for groups with a head code, "junk group", "any".
    """
    return checked_build("tagged_offsets").tagged(name, words, kind) if CHECKED else words


def forget_kinds(ia: Any) -> None:
    """Other groups have come to lie in `ia`: the checked build has to find their kinds anew."""
    if CHECKED:
        checked_build("access_checks").shadow(ia).known = False


def at_offset(k: int, kind: int, own: Any) -> Any:
    """Offset of number `k`, from 1, of groups of a kind.

    kind, own: used by the checked form only. own: an offset of the routine that calls this.
    """
    return k, k, k


if CHECKED:
    at_offset = checked_build("tagged_offsets").at_offset  # all offsets of the table are exchanged, too
numba_form(JITABLE)(at_offset)
