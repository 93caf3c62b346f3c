"""A folder of runs belongs to one process at a time, or each would clear away what another has begun.

The system itself keeps the lock and lets go of it when the process ends, however it ends: so a study that was
killed keeps nobody out. A process keeps the folder between several calls for it, until it turns to another
one or lets go. Where the system, or the file system, has no such locks, nobody is kept out.
"""

from __future__ import annotations

import atexit
import os
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from udec_ia.errors import UdecError
from udec_ia.printable import MESSAGE, printable

try:
    import fcntl
except ImportError:  # not a system of the family of Unix
    fcntl = None  # type: ignore[assignment]

LOCK = ".lock"  # file in the folder of runs, which says who holds it
WAIT = "wait until that has ended, or give another folder (--out, or out=... in Python)"


class _Holder:
    """What this process holds. one: at a time. locks: open files, by folder. busy: folders in use."""

    def __init__(self) -> None:
        self.one = threading.Lock()
        self.locks: dict[Path, BinaryIO] = {}
        self.busy: set[Path] = set()


_ours = _Holder()


@atexit.register
def _let_go_of_all() -> None:
    for lock in _ours.locks.values():
        lock.close()


@contextmanager
def held(folder: Path) -> Iterator[None]:
    """Nobody else uses `folder` inside. Error 31 if another process or thread does. OSError."""
    key = folder.resolve()
    with _ours.one:
        if key in _ours.busy:
            raise _refused(folder, "this process")
        for other in [*_ours.locks]:
            if other not in _ours.busy and (other != key or not _is_there(other)):
                _ours.locks.pop(other).close()
        if key not in _ours.locks:
            _ours.locks[key] = _locked(folder)
        _ours.busy.add(key)
    try:
        yield
    finally:
        with _ours.one:
            _ours.busy.discard(key)


def let_go(folder: Path) -> None:
    """Others may have `folder` again, if this process is not using it."""
    key = folder.resolve()
    with _ours.one:
        if key in _ours.locks and key not in _ours.busy:
            _ours.locks.pop(key).close()


def _locked(folder: Path) -> BinaryIO:
    """The lock of `folder`, with the name of this process in it."""
    file = (folder / LOCK).open("ab+", buffering=0)
    try:
        if fcntl is not None:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        file.seek(0)
        who = printable(file.read(200).decode(errors="replace").strip()) or "another process"
        file.close()
        raise _refused(folder, who) from None
    except OSError:  # a file system without locks
        return file
    file.truncate(0)
    file.write(f"process {os.getpid()} on {socket.gethostname()}\n".encode())
    return file


def _is_there(folder: Path) -> bool:
    """True if the lock is still the file of that name: not if the folder was removed meanwhile."""
    try:
        return os.path.samestat((folder / LOCK).stat(), os.fstat(_ours.locks[folder].fileno()))
    except OSError:
        return False


def _refused(folder: Path, who: str) -> UdecError:
    return UdecError(31, f"{printable(str(folder), MESSAGE)} is in use by {who}", WAIT)
