"""What a kernel is to the kernels that call it (kernel.py)."""

from __future__ import annotations

from typing import Any

from numba import types
from numba.extending import typeof_impl

from udec_ia.heap.kernel import Kernel


@typeof_impl.register(Kernel)
def _type_of(kernel: Kernel, context: Any) -> Any:
    found = typeof_impl(kernel.made, context)
    return found if found is not None else types.Dispatcher(kernel.made)
