"""A file that grows, and is whole whatever becomes of the program: two copies of it take turns.

One copy has the name. The other, a hidden file beside it, is what is written to: it gets what has come since
it had the name itself, and takes the name in one step; the copy that had it until then is the next to be
extended. So every addition costs what is added, twice, and not what is there. Where a file cannot have two
names, or somebody else has changed one of the copies, the whole is written anew, in the place of
a file of this kind or of none.
"""

from __future__ import annotations

import os
import weakref
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from udec_ia.errors import UdecError
from udec_ia.files import FRONT, check_name, hidden, keep_rights, status

Stamp = tuple[int, int, int, int] | None
State = tuple[Stamp, Any]  # of a copy: its stamp, and the mark that it has come to
Whole = Callable[[], bytes]
Extend = Callable[[Path, Any], None]


class Turns:
    """A growing file `path`.

    A mark says how far a copy has come: `extend(copy, mark)` adds what is missing after it, `whole()` is all.
    """

    def __init__(self, path: Path) -> None:
        try:
            status(path)
        except OSError as error:
            raise UdecError(31, f"{path}: {error.strerror or error}") from error
        self.path = path.resolve()
        self.spare = hidden(self.path)
        self._named: State | None = None  # None for a copy that is not there, or not known
        self._other: State | None = None
        self._tidy: Any = None

    def put(self, mark: Any, whole: Whole, extend: Extend) -> None:
        """Let the named copy come to `mark`. Raises OSError, or error 31 if another kind of file is there."""
        ours = self._named is not None and self._named[0] == _stamp(self.path)
        if ours and self._named is not None and self._named[1] == mark:
            return
        before, self._other = (self._other if ours else None), None
        try:
            self._bring(before, whole, extend)
            if not ours:
                with self.spare.open("rb") as file:
                    check_name(self.path, file.read(FRONT))
            self._swap(mark, ours)
        except BaseException:
            self.close()
            raise

    def start_anew(self) -> None:
        """Write the whole next time."""
        self._named = None

    def close(self) -> None:
        """Take the hidden copy away."""
        self._other = None
        if self._tidy is not None:
            self._tidy()
            self._tidy = None

    def _bring(self, before: State | None, whole: Whole, extend: Extend) -> None:
        """Make the hidden copy what the named one is to be."""
        if before is not None and before[0] == _stamp(self.spare):
            with suppress(OSError):  # it may be open elsewhere
                extend(self.spare, before[1])
                return
        self.path.parent.mkdir(parents=True, exist_ok=True)
        if self._tidy is None:
            self._tidy = weakref.finalize(self, _remove, self.spare)
        _remove(self.spare)
        self.spare.write_bytes(whole())

    def _swap(self, mark: Any, ours: bool) -> None:
        """Give the hidden copy the name, and hide the one that had it."""
        named, self._named = self._named, None
        last, there = hidden(self.path), status(self.path)
        if there is not None:
            keep_rights(self.spare, there)
        if ours:
            with suppress(OSError):
                os.link(self.path, last)
        self.spare.replace(self.path)
        self._named = _stamp(self.path), mark
        if ours and named is not None and last.exists():
            last.replace(self.spare)
            self._other = _stamp(self.spare), named[1]


def _stamp(path: Path) -> Stamp:
    """What tells a file from others, and whether it has been written to; None if there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()
