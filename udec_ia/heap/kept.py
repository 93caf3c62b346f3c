"""Where the machine code of a kernel is kept: one file for each kernel and types of its arguments.

numba numbers such files and keeps an index of them. Two processes that compile at the same time, for two word
schemes perhaps, may take the same number, and what one of them has compiled is then found under the name of
the other. Here a file is named by the types, and says for which types it is.

numba also keeps apart what was compiled in different folders. Our cache is named by the sources themselves
(kernel.py), so two copies of the same sources share what is in it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from numba.core.caching import FunctionCache, IndexDataCacheFile
from numba.core.runtime import rtsys


class KeptCode(IndexDataCacheFile):
    """The files of one kernel. key: types of arguments, machine and hash of the kernel, as numba gives it."""

    def save(self, key: Any, data: Any) -> None:
        """Keep `data`. Whoever reads at the same time finds all of it or nothing."""
        self._save_data(self._name(key), (key, data))

    def load(self, key: Any) -> Any:
        """What was kept for `key`, or None."""
        try:
            known, data = self._load_data(self._name(key))
        except OSError:
            return None
        return data if known == key else None

    def _name(self, key: Any) -> str:
        return str(self._data_name(int(hashlib.sha256(str(key).encode()).hexdigest()[:12], 16)))


class _Cache(FunctionCache):
    """What numba asks for the machine code of a kernel before it compiles it. folder: where our files are.

    numba makes ready to compile before it asks, which takes longer than to read a dozen kernels. What machine
    code needs to run, which is numba's memory for arrays, is made ready here, and the rest if there is none.
    """

    def __init__(self, kernel: Callable[..., Any], folder: Path) -> None:
        super().__init__(kernel)
        self._impl.locator._cache_path = str(folder)
        self._cache_file = KeptCode(str(folder), self._impl.filename_base, None)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was kept for the types `sig`, or None."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            if kept := self._load_overload(sig, target_context):
                return kept
        target_context.refresh()
        return None


def keep_code(dispatcher: Any, folder: Path) -> None:
    """Have numba keep the machine code of `dispatcher` in files of our kind in `folder`."""
    dispatcher._cache = _Cache(dispatcher.py_func, folder)
