"""Folders of runs: hidden while a run goes on, renamed to the run's name when complete, locked for one study.

A folder with the name of a run is complete, whatever happened to the process. Only folders that the program
has made are replaced: those with a result in them, and empty ones.
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
BEGUN = "begun"  # file in the folder of a run that is not complete
UNNAMED = ".run-"  # how the name of such a folder begins
HIDDEN = re.compile(rf"{re.escape(UNNAMED)}.*~[0-9a-f]{{8}}", re.DOTALL)
LOCK = ".lock"
OTHER = "give another folder (--out, or out=... in Python)"


@contextmanager
def lock_folder(folder: Path) -> Iterator[None]:
    """Make `folder`, clear incomplete runs, and keep other studies out until the end.

    The system releases the lock when the process ends, however it ends. Error 31 if another study uses the
    folder or if it cannot be written.
    """
    from filelock import FileLock, Timeout

    lock = FileLock(folder / LOCK)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with suppress(NotImplementedError):  # a file system without locks
            lock.acquire(timeout=0)
        clear(folder)
    except Timeout:
        name = printable(str(folder), MESSAGE)
        raise UdecError(
            31, f"{name} is in use by another study", f"wait until it has ended, or {OTHER}"
        ) from None
    except OSError as error:
        raise UdecError(31, f"{folder}: {error.strerror or error}") from error
    try:
        yield
    finally:
        lock.release()


def new_folder(folder: Path, name: str) -> Path:
    """A new hidden folder for the run `name` in `folder`."""
    here = folder / f"{_hidden(name)}{secrets.token_hex(4)}"
    here.mkdir()
    return here


def publish(here: Path, there: Path) -> None:
    """Give the folder of a run its name. FileNotFoundError if another process has cleared it meanwhile.

    Error 31 if something that the program has not made is there by now.
    """
    check_replaceable(there)
    (here / BEGUN).unlink()
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
    raise UdecError(
        31, f"{printable(str(there), MESSAGE)}, the place of a run, {what}", f"move it away, or {OTHER}"
    )


def incomplete(name: str, folder: Path) -> list[Path]:
    """Folders in which the run `name` was begun and not completed."""
    return [path for path in _all_incomplete(folder) if path.name.startswith(_hidden(name))]


def clear(folder: Path) -> None:
    """Remove the incomplete runs in `folder`; a process that still works on one cannot publish it."""
    for path in _all_incomplete(folder):
        shutil.rmtree(path, ignore_errors=True)


def _all_incomplete(folder: Path) -> list[Path]:
    return [path for path in folder.glob(f"{UNNAMED}*") if HIDDEN.fullmatch(path.name)]


def _hidden(name: str) -> str:
    return f"{UNNAMED}{name}~"
