"""Which build of the kernels runs: compiled or interpreted, ordinary or checked. The environment decides.

NUMBA_DISABLE_JIT=1 has all kernels run as Python. UDEC_CHECKED=1, or `udec --checked`, chooses the checked
build: its parts are in the package `checked_build`, which an ordinary build never imports. UDEC_LINK=plain
has kernels compiled without our own linking.
"""

from __future__ import annotations

import os
from importlib import import_module
from typing import Any

from udec_ia.compiling.numba_loading import numba_form

DISABLED = os.environ.get("NUMBA_DISABLE_JIT", "") not in ("", "0")  # as numba reads it: nothing is compiled
CHECKED = os.environ.get("UDEC_CHECKED", "") not in ("", "0")
TRIED = (0, 61), (0, 68)  # the first and the last release of numba on which linking.py was tried


def plain_wanted() -> bool:
    """True if kernels are to be compiled without linking.py: on request, or as numba may have changed."""
    import numba

    release = tuple(int(part) for part in numba.__version__.split(".")[:2])
    return os.environ.get("UDEC_LINK") == "plain" or not TRIED[0] <= release <= TRIED[1]


def checked_build(part: str) -> Any:
    """A module of the checked build."""
    return import_module(f"udec_ia.checked_build.{part}")


def offset(name: str, words: tuple[int, ...], kind: str, count: int = 1) -> Any:
    """The offsets `words` of a field that is not in the table, as kernels of this build take them.

    kind: of the groups that have it; "headed" for groups with a head code, "junk group", "any". count: of its
    elements. The last two are for the checked build.
    """
    return checked_build("tagged_offsets").tagged(name, words, kind, count) if CHECKED else words


def forget_kinds(ia: Any) -> None:
    """Other groups have come to lie in `ia`: the checked build has to find their kinds anew."""
    if CHECKED:
        checked_build("group_kinds").forget(ia)


def at_offset(k: int, kind: int, own: Any) -> Any:
    """Offset of number `k`, counted from 1, of groups of the kind with the number `kind`.

    own: an offset in the routine that calls this, from which the checked build takes the name of the routine.
    """
    return k, k, k


if CHECKED:
    at_offset = checked_build("tagged_offsets").at_offset  # all offsets of the table are exchanged, too
numba_form("numba.extending:register_jitable")(at_offset)
