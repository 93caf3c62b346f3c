"""Where the machine code of a kernel is kept: one file for each kernel and types of its arguments.

numba numbers such files and keeps an index of them. Two processes that compile at the same time, for two word
schemes perhaps, may take the same number, and what one of them has compiled is then found under the name of
the other. Here a file is named by the types, and says for which types it is.

numba also keeps apart what was compiled in different folders. Our cache is named by the sources themselves
(kernel.py), so two copies of the same sources share what is in it.
"""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from numba.core.caching import IndexDataCacheFile


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


def keep_code(dispatcher: Any, folder: Path) -> None:
    """Have numba keep the machine code of `dispatcher` in files of our kind in `folder`."""
    cache = dispatcher._cache
    cache._impl.locator._cache_path = str(folder)
    cache._cache_file = KeptCode(str(folder), cache._impl.filename_base, None)
