"""Folders of runs: one is hidden until all is in it, and then gets the name of its run.

One that has the name of a run is whole, whatever has become of the process. Only what the program has made
is replaced: a folder with a result in it, or an empty one.
"""

from __future__ import annotations

import os
import re
import secrets
import shutil
from pathlib import Path

from udec_ia.errors import UdecError
from udec_ia.printable import MESSAGE, printable

RESULT = "result.json"  # in the folder of a run; no folder gets the name of a run without it
BEGUN = "begun"  # file in the folder of a run that is not whole yet
UNNAMED = ".run-"  # what the name of such a folder begins with
HIDDEN = re.compile(rf"{re.escape(UNNAMED)}.*~[0-9a-f]{{8}}", re.DOTALL)
LEAVE = "move it away, or give another folder (--out, or out=... in Python)"


def new(folder: Path, name: str) -> Path:
    """A new folder for the run `name` in `folder`, hidden yet."""
    here = folder / f"{_hidden(name)}{secrets.token_hex(4)}"
    here.mkdir()
    return here


def publish(here: Path, there: Path) -> None:
    """Give the folder of a run its name. FileNotFoundError if somebody has cleared it away meanwhile.

    Error 31 if something has come to stand there that is not ours.
    """
    check_replaceable(there)
    (here / BEGUN).unlink()
    if there.is_dir():
        old = new(there.parent, there.name)
        os.replace(there, old)
        shutil.rmtree(old)
    os.replace(here, there)


def check_replaceable(there: Path) -> None:
    """Error 31 unless a run may get the folder `there`: nothing is there, or what the program has made."""
    try:
        what = _foreign(there)
    except OSError as error:
        what = f"cannot be looked into: {error.strerror or error}"
    if what:
        raise UdecError(31, f"{printable(str(there), MESSAGE)}, the place of a run, {what}", LEAVE)


def _foreign(there: Path) -> str:
    """What is not ours in the place of a run, "" if nothing is."""
    if there.is_symlink():
        return "is a link"
    if not there.exists():
        return ""
    if not there.is_dir():
        return "is no folder"
    ours = (there / RESULT).is_file() or not any(there.iterdir())
    return "" if ours else f"is a folder that this program has not made: there is no {RESULT} in it"


def begun(name: str, folder: Path) -> list[Path]:
    """Folders in which the run `name` was begun and not ended."""
    return [path for path in _unfinished(folder) if path.name.startswith(_hidden(name))]


def clear(folder: Path) -> None:
    """Take away what was begun in `folder` and not ended; who is still at it will not publish it."""
    for path in _unfinished(folder):
        shutil.rmtree(path, ignore_errors=True)


def _unfinished(folder: Path) -> list[Path]:
    return [path for path in folder.glob(f"{UNNAMED}*") if HIDDEN.fullmatch(path.name)]


def _hidden(name: str) -> str:
    """What the name of a folder begins with before it gets the name of its run."""
    return f"{UNNAMED}{name}~"
