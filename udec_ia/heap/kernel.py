"""A kernel: a function that is compiled when it is first called; and where its compiled form is kept.

numba's cache on disk looks at the kernel's own file only: change an offset, or a function that the
kernel calls, and it would go on running the old machine code. So the cache lives in a directory
named by a hash of the field table and of every source file of the package: any change starts afresh.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache, cached_property, update_wrapper
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar, cast

from udec_ia.heap.checked import CHECKED
from udec_ia.heap.interpreting import ObservedMemory, interpreted, mode
from udec_ia.heap.loading import DISABLED, has_numba_side, load
from udec_ia.layout import offsets as g

F = TypeVar("F", bound=Callable[..., Any])
PACKAGE = Path(__file__).parent.parent


def _cache_home() -> Path:
    if "UDEC_CACHE" in os.environ:
        return Path(os.environ["UDEC_CACHE"])
    from platformdirs import user_cache_dir

    return Path(user_cache_dir("udec_ia", appauthor=False))


def source_digest() -> str:
    """Hash of the field table and of the sources that compiled kernels can depend on."""
    digest = hashlib.sha256(g.DIGEST.encode())
    folders = (sorted((PACKAGE / folder).rglob("*.py")) for folder in ("layout", "heap", "kernels"))
    for path in [PACKAGE / "errors.py", *chain.from_iterable(folders)]:
        digest.update(path.read_bytes())
    return digest.hexdigest()


@cache
def cache_folder() -> Path:
    """Where what is compiled by these sources is kept."""
    import numba

    from udec_ia.heap.plain import wanted

    build = ("-plain" if wanted() else "") + ("-checked" if CHECKED else "")
    return _cache_home() / f"{source_digest()[:16]}-numba{numba.__version__}{build}"


class Kernel:
    """A kernel: compiled when it is first called, or run as Python where kernels are (interpreting.py).

    inline, apart: as jit.py says; lent: as `over_arrays` does.
    """

    def __init__(self, function: Callable[..., Any], inline: bool, apart: bool, lent: bool) -> None:
        update_wrapper(self, function)
        self.py_func, self.inline, self.apart, self.lent = function, inline, apart, lent

    def __call__(self, *args: Any) -> Any:
        if mode.python:
            return self.py_func(*args)
        if args and args[0].__class__ is ObservedMemory:
            with interpreted():
                return self.py_func(*args)
        return self.whole(*args)

    @cached_property
    def made(self) -> Any:
        """What numba makes of it, for each types of arguments when they first come.

        No fastmath and no contraction, so that compiled and interpreted runs agree bit for bit; division
        follows IEEE 754 instead of raising.
        """
        load()
        from numba.core import config

        from udec_ia.heap.plain import plain_kernel, wanted

        layer = Path(self.py_func.__code__.co_filename).parent.name  # two may have a file of the same name
        folder = cache_folder() / layer
        flags = {"error_model": "numpy", "forceinline": self.inline, "_nrt": not self.lent}
        kept, config.CACHE_DIR = config.CACHE_DIR, str(cache_folder())
        try:
            if wanted():
                return plain_kernel(self.py_func, folder, **flags)
            from udec_ia.heap.linking import Forms

            return Forms(self.py_func, folder, self.apart, **flags)
        finally:
            config.CACHE_DIR = kept

    @cached_property
    def whole(self) -> Any:
        """That which Python calls."""
        return getattr(self.made, "whole", self.made)


def over_arrays(function: F) -> F:
    """A kernel over arrays that its caller keeps: it makes none, and nobody counts who has one.

    To count takes ten times as long as to look at a corner, where arrays come by the dozen.
    """
    return function if DISABLED else cast(F, Kernel(function, False, False, True))


has_numba_side(__name__)
