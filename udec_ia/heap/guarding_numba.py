"""The checked build's looks, compiled (guarding.py)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba.extending import overload, register_jitable, typeof_impl

from udec_ia.heap.checked import CHECKED, KIND, SPARE
from udec_ia.heap.guarding import Guarded, begins, ends, judge, look

register_jitable(judge)


@overload(look)
def _compiled_look(h: Any, iad: Any, k: Any, i: Any, writes: Any) -> Callable[..., None]:
    def impl(h: Any, iad: Any, k: Any, i: Any, writes: Any) -> None:
        judge(h, iad, k, i, writes)

    return impl


@overload(begins)
def _begins(h: Any, iad: Any, nv: Any) -> Callable[..., None]:
    def checked(h: Any, iad: Any, nv: Any) -> None:
        h.kinds[iad - 1] = nv[KIND]

    def nothing(h: Any, iad: Any, nv: Any) -> None:
        pass

    return checked if CHECKED else nothing


@overload(ends)
def _ends(h: Any, iad: Any, nv: Any) -> Callable[..., None]:
    def checked(h: Any, iad: Any, nv: Any) -> None:
        judge(h, iad, nv, 0, 1)
        h.kinds[iad - 1] = SPARE

    def nothing(h: Any, iad: Any, nv: Any) -> None:
        pass

    return checked if CHECKED else nothing


@typeof_impl.register(Guarded)
def _type_of(kernel: Guarded, context: Any) -> Any:
    """To other kernels it is what it guards."""
    return typeof_impl(kernel.made, context)
