"""The cache of machine code on disk: one file for each kernel and types of its arguments.

numba numbers its files, and two processes that compile at the same time may take the same number. Here a file
is named by the types, and contains for which types it is, and a checksum. cache_folder.py has the folder. In
a folder that cannot be written, what is there is used, and the rest is compiled in each run.
"""

from __future__ import annotations

import hashlib
import logging
import pickle
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, ClassVar
from zlib import crc32

from numba.core import event
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.runtime import rtsys

from udec_ia.compiling.cache_folder import cache_home
from udec_ia.compiling.compile_duration import begin_compiling, end_compiling

log = logging.getLogger("udec_ia")
NOT_STORED = (
    "machine code cannot be stored in %s (%s), so each run compiles it: set UDEC_CACHE to a folder that can "
    "be written"
)
CHECKSUM = 4  # bytes at the beginning of a file
LONGEST = 120.0  # seconds to wait for another process that compiles a kernel


class CodeFile(IndexDataCacheFile):
    """The files of one kernel. key: types of arguments, machine and hash of the kernel, as numba gives it."""

    def save(self, key: Any, data: Any) -> None:
        """Write `data`. Another process that reads at the same time finds all of it or nothing."""
        self._save_data(self._name(key), (key, data))

    def load(self, key: Any) -> Any:
        """What was saved for `key`, or None."""
        try:
            known, data = self._load_data(self._name(key))
        except OSError:
            return None
        return data if known == key else None

    def _save_data(self, name: str, data: Any) -> None:
        body = self._dump(data)
        with self._open_for_write(self._data_path(name)) as file:
            file.write(crc32(body).to_bytes(CHECKSUM) + body)

    def _load_data(self, name: str) -> Any:
        content = Path(self._data_path(name)).read_bytes()
        check, body = content[:CHECKSUM], content[CHECKSUM:]
        if not body or int.from_bytes(check) != crc32(body):
            raise OSError("a damaged file")
        return pickle.loads(body)

    def lock(self, key: Any) -> Any:
        """The lock of a process that makes what is saved for `key`."""
        from filelock import FileLock

        return FileLock(f"{self._data_path(self._name(key))}.lock")

    def _name(self, key: Any) -> str:
        return str(self._data_name(int(hashlib.sha256(str(key).encode()).hexdigest()[:12], 16)))


class _Place:
    """The folder of a kernel, for numba, which would refuse one that cannot be written."""

    def __init__(self, kernel: Callable[..., Any], folder: Path) -> None:
        self.kernel, self.folder = kernel, folder

    def from_function(self, *_: Any) -> _Place:
        """The locator that numba asks a class for."""
        return self

    def get_cache_path(self) -> str:
        """The folder."""
        return str(self.folder)

    def ensure_cache_path(self) -> None:
        """Make the folder. OSError if that cannot be done."""
        self.folder.mkdir(parents=True, exist_ok=True)

    def get_source_stamp(self) -> None:
        """Nothing: the name of the folder contains a hash of all sources."""

    def get_disambiguator(self) -> str:
        """A number that differs for kernels of the same name in a file: the first line."""
        return str(self.kernel.__code__.co_firstlineno)


class _Content(CompileResultCacheImpl):
    """What numba stores of a kernel."""

    def __init__(self, kernel: Callable[..., Any], folder: Path) -> None:
        self._locator_classes = [_Place(kernel, folder)]
        super().__init__(kernel)


class _Cache(FunctionCache):
    """Where numba looks for the machine code of a kernel before it compiles it. folder: of our files.

    What machine code needs to run, numba's memory for arrays, is prepared at once; what numba needs to
    compile, which takes longer than to read a dozen kernels, only if there is no file.

    A kernel is locked while it is compiled, so that a process that needs it, too, waits for the file. After
    an interrupt it stays locked until it is compiled again, or the process ends.
    """

    _lock: Any = None
    has_warned: ClassVar[bool] = False

    def __init__(self, kernel: Callable[..., Any], folder: Path) -> None:
        self._impl_class = partial(_Content, folder=folder)
        super().__init__(kernel)
        self._cache_file = CodeFile(str(folder), self._impl.filename_base, None)

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """What was saved for the types `sig`, or None."""
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            if found := self._load_overload(sig, target_context):
                return found
            self._acquire(sig, target_context)
            if self._lock and (found := self._load_overload(sig, target_context)):
                self.release()
                return found
        target_context.refresh()
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Save what has been compiled for the types `sig`."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            if not _Cache.has_warned:
                _Cache.has_warned = True
                log.warning(NOT_STORED, cache_home(), error.strerror, extra={"key": "code-not-stored"})
        self.release()

    def is_needed(self, sig: Any, target_context: Any) -> bool:
        """True if there is no file for the types `sig`, and no process that makes it."""
        key = self._index_key(sig, target_context.codegen())
        if self._cache_file.load(key) is not None:
            return False
        self._acquire(sig, target_context, 0.0)
        is_free = self._lock is not None
        self.release()
        return is_free

    def _acquire(self, sig: Any, target_context: Any, seconds: float = LONGEST) -> None:
        """Take the lock, unless another process has it for longer than that, or the folder can have none."""
        from filelock import Timeout

        self.release()
        lock = self._cache_file.lock(self._index_key(sig, target_context.codegen()))
        with suppress(OSError, Timeout, NotImplementedError):
            self._impl.locator.ensure_cache_path()
            lock.acquire(timeout=seconds, poll_interval=0.02)
            self._lock = lock

    def release(self) -> None:
        """The kernel has been compiled, or not."""
        if self._lock is not None:
            self._lock.release()
            self._lock = None


class _CompileListener(event.Listener):
    """Notices when numba compiles a kernel that was not on disk. User laws do not count."""

    def on_start(self, started: Any) -> None:
        if isinstance(started.data["dispatcher"]._cache, _Cache):
            begin_compiling()

    def on_end(self, ended: Any) -> None:
        if isinstance(ended.data["dispatcher"]._cache, _Cache):
            end_compiling()


event.register("numba:compile", _CompileListener())


def use_cache(dispatcher: Any, folder: Path) -> None:
    """Have numba store the machine code of `dispatcher` in files of our kind in `folder`."""
    dispatcher._cache = _Cache(dispatcher.py_func, folder)
