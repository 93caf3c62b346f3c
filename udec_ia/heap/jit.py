"""The one decorator that compiles a kernel, and where its compiled form is kept.

numba's cache on disk looks at the kernel's own file only: change an offset, or a function that the
kernel calls, and it would go on running the old machine code. So the cache lives in a directory
named by a hash of the field table and of every source file of the package: any change starts afresh.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba
from numba.core import config
from platformdirs import user_cache_dir

from udec_ia.heap.checked import CHECKED, named
from udec_ia.heap.guarding import Guarded
from udec_ia.heap.plain import plain_kernel, wanted
from udec_ia.layout import offsets as g

if not wanted():
    from udec_ia.heap.linking import Kernel

F = TypeVar("F", bound=Callable[..., Any])
PACKAGE = Path(__file__).parent.parent


def _cache_home() -> Path:
    return Path(os.environ.get("UDEC_CACHE", user_cache_dir("udec_ia", appauthor=False)))


def source_digest() -> str:
    """Hash of the field table and of the sources that compiled kernels can depend on."""
    digest = hashlib.sha256(g.DIGEST.encode())
    for folder in ("layout", "heap", "kernels"):
        for path in sorted((PACKAGE / folder).rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()


BUILD = ("-plain" if wanted() else "") + ("-checked" if CHECKED else "")
CACHE = _cache_home() / f"{source_digest()[:16]}-numba{numba.__version__}{BUILD}"


def kernel(function: F, inline: bool = False, apart: bool = False) -> F:
    """Compile `function` on first use, for the word scheme of the arrays it is called with.

    No fastmath and no contraction, so that compiled and interpreted runs agree bit for bit; division
    follows IEEE 754 instead of raising.
    """
    if CHECKED:
        own, number = named(function)
        return cast(F, Guarded(_compiled(own, inline, apart), own, number))
    return cast(F, _compiled(function, inline, apart))


def _compiled(function: Callable[..., Any], inline: bool, apart: bool) -> Any:
    if config.DISABLE_JIT:
        return function
    layer = Path(function.__code__.co_filename).parent.name  # two of them may have a file of the same name
    kept = config.CACHE_DIR
    config.CACHE_DIR = str(CACHE)
    try:
        if wanted():
            return plain_kernel(function, CACHE / layer, error_model="numpy", forceinline=inline)
        return Kernel(function, CACHE / layer, apart, error_model="numpy", forceinline=inline)
    finally:
        config.CACHE_DIR = kept


def inlined(function: F) -> F:
    """A kernel that becomes a part of its callers: for what the cycle does once for every contact."""
    return kernel(function, inline=True)


def apart(function: F) -> F:
    """A kernel that is not taken in by others, which call it where it is: see heap/apart.py."""
    return kernel(function, apart=True)
