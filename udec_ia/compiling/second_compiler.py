"""A second process compiles what the first run on a machine needs later, while this one compiles the rest.

It runs `udec cache warm`, which plays a small scene with interpreted kernels, to find out which ones Python
calls. It compiles the large ones that come late first, then the others from the last to the first. A kernel
that is being compiled is locked (code_cache.py), so none is compiled twice. UDEC_AHEAD=0 in the environment
switches it off.
"""

from __future__ import annotations

import os
import subprocess
import sys
from multiprocessing import parent_process
from typing import Any

from udec_ia.compiling.build_choice import CHECKED, DISABLED, load
from udec_ia.compiling.cache_folder import warm_mark
from udec_ia.compiling.interpreted_kernels import interpreted

SWITCH = "UDEC_AHEAD"
LARGE_KERNELS = "change_map", "cut_path", "run_with_records"  # which a run needs late
Calls = list[tuple[Any, tuple[Any, ...]]]


class _Second:
    """The second process of this one, once it has been started."""

    process: subprocess.Popen[bytes] | None = None


def compile_ahead(scheme: str) -> None:
    """Start the second process, once, for the words of `scheme`, unless they are known to have been compiled.

    Not in the processes of a sweep, which are several anyway, nor in the checked build.
    """
    unwanted = os.environ.get(SWITCH) == "0" or CHECKED or DISABLED or parent_process() is not None
    mark = warm_mark(scheme)
    if unwanted or _Second.process or (os.cpu_count() or 1) < 2 or mark.exists():
        return
    try:
        mark.parent.mkdir(parents=True, exist_ok=True)
    except OSError:
        return
    if not os.access(mark.parent, os.W_OK):  # nothing could be stored
        return
    command = [sys.executable, "-m", "udec_ia", "cache", "warm", "--build", scheme, "--rigid"]
    _Second.process = subprocess.Popen(
        command,
        env={**os.environ, SWITCH: "0"},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # Ctrl-C is not for it, and it may end later
    )


def find_kernels(action: Any) -> Calls:
    """The kernels that Python calls in `action`, which is executed with interpreted ones; with arguments."""
    calls: Calls = []
    with interpreted(calls):
        action()
    return calls


def compile_kernels(calls: Calls) -> int:
    """Compile what `find_kernels` has found; returns how many were compiled.

    Those that are on disk, or that another process is compiling, are left out.
    """
    load()
    wanted = list(dict.fromkeys((kernel, tuple(map(_type_of, args))) for kernel, args in reversed(calls)))
    wanted.sort(key=lambda one: one[0].py_func.__name__ not in LARGE_KERNELS)
    done = 0
    for kernel, types in wanted:
        dispatcher = kernel.dispatcher
        if dispatcher._cache.is_needed(types, dispatcher.targetctx):
            dispatcher.compile(types)
            done += 1
    return done


def _type_of(value: Any) -> Any:
    """The type that numba gives to an argument; a kernel among them is an address when it is compiled."""
    from numba import typeof

    def compiled(one: Any) -> Any:
        if isinstance(one, tuple) and type(one) is tuple:
            return tuple(map(compiled, one))
        return 0 if hasattr(one, "py_func") else one

    return typeof(compiled(value))
