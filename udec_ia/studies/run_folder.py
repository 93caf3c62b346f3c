"""Folders of runs: hidden while a run goes on, renamed to the run's name when complete, locked for one study.

A folder with the name of a run is complete. Only folders with a result in them, and empty ones, are replaced.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from udec_ia.errors import UdecError
from udec_ia.printable_text import MESSAGE, printable

RESULT = "result.json"  # in the folder of a run; no folder gets the name of a run without it
UNNAMED = ".run-"  # how the name of such a folder begins
HIDDEN = re.compile(rf"{re.escape(UNNAMED)}.*~[0-9a-f]{{8}}", re.DOTALL)
LOCK = ".lock"
OTHER = "give another folder (--out, or out=... in Python)"


@contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Make `folder`, clear incomplete runs, and keep other studies out. Error 31 if that cannot be done."""
    from filelock import FileLock, Timeout

    lock = FileLock(folder / LOCK)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with suppress(NotImplementedError):  # a file system without locks
            lock.acquire(timeout=0)
        clear(folder)
    except Timeout:
        what = f"{printable(str(folder), MESSAGE)} is in use by another study"
        raise UdecError(31, what, f"wait until it has ended, or {OTHER}") from None
    except OSError as error:
        raise UdecError(31, f"{folder}: {error.strerror or error}") from error
    try:
        yield
    finally:
        lock.release()


def new_folder(folder: Path, name: str) -> Path:
    """A new hidden folder for the run `name` in `folder`."""
    here = folder / f"{UNNAMED}{name}~{secrets.token_hex(4)}"
    here.mkdir()
    return here


def publish(here: Path, there: Path) -> None:
    """Give the folder of a run its name. Error 31; FileNotFoundError if another process has cleared it."""
    check_replaceable(there)
    here.stat()  # raises FileNotFoundError
    if there.is_dir():
        old = new_folder(there.parent, there.name)
        os.replace(there, old)
        shutil.rmtree(old)
    os.replace(here, there)


def check_replaceable(there: Path) -> None:
    """Error 31 unless a run may get the folder `there`: nothing is there, or what the program has made."""
    try:
        is_folder = there.is_dir() and not there.is_symlink()
        ours = is_folder and ((there / RESULT).is_file() or not any(there.iterdir()))
        if ours or not os.path.lexists(there):
            return
        what = f"was not made by this program: it is no folder with {RESULT} in it"
    except OSError as error:
        what = f"cannot be read: {error.strerror or error}"
    place = f"{printable(str(there), MESSAGE)}, the place of a run,"
    raise UdecError(31, f"{place} {what}", f"move it away, or {OTHER}")


def incomplete(name: str, folder: Path) -> list[Path]:
    """Folders in which the run `name`, "" for any, was begun and not completed."""
    hidden = [path for path in folder.glob(f"{UNNAMED}*") if HIDDEN.fullmatch(path.name)]
    return [path for path in hidden if not name or path.name.startswith(f"{UNNAMED}{name}~")]


def clear(folder: Path) -> None:
    """Remove the incomplete runs in `folder`; a process that still works on one cannot publish it."""
    for path in incomplete("", folder):
        shutil.rmtree(path, ignore_errors=True)
