"""The files of the histories: a table for any program (CSV), and the numbers bit for bit (HDF5).

NAME-history.csv has a line for every cycle at which something was recorded, and a column for each history: a
field is empty where a history was not due, and `nan` once its group has gone. NAME-history.h5 has a group
for each history. Both are extended after every CYCLE, and are whole at every moment (GrowingFile).
"""

from __future__ import annotations

import io
import os
import weakref
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.file_replacement import FRONT, check_name, hidden, keep_rights, status
from udec_ia.running.history_series import Series

Stamp = tuple[int, int, int, int] | None
State = tuple[Stamp, Any]  # of a copy: its stamp, and the mark that it has come to
Whole = Callable[[], bytes]
Extend = Callable[[Path, Any], None]


class GrowingFile:
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
    """Identity of a file and whether it has been written to; None if there is no file."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


Counts = tuple[int, ...]  # numbers of each history


class Files:
    """The two files of the histories of a run."""

    def __init__(self, base: Path) -> None:
        self.place = base.absolute()
        self.paths = [base.with_name(f"{base.name}.{kind}") for kind in ("csv", "h5")]
        self._turns = [GrowingFile(path) for path in self.paths]
        self._described: list[Any] = []

    def write(self, series: Sequence[Series]) -> list[Path]:
        """Bring base.csv and base.h5 up to date; returns both paths. Error 31 if that cannot be done."""
        described = [(one, one.title, one.place, one.lost) for one in series]
        if described != self._described:
            self._described = described
            for turns in self._turns:
                turns.start_anew()
        counts = tuple(one.count for one in series)
        csv, hdf5 = self._turns
        ways = (
            (csv, lambda: _csv(series), lambda path, before: _extend_csv(path, series, before)),
            (hdf5, lambda: _hdf5(series), lambda path, before: _extend_hdf5(path, series, before)),
        )
        for path, (turns, whole, extend) in zip(self.paths, ways, strict=True):
            try:
                turns.put(counts, whole, extend)
            except OSError as error:
                raise UdecError(31, f"{path}: {error.strerror or error}") from error
        return self.paths

    def close(self) -> None:
        """Leave nothing but the two files."""
        for turns in self._turns:
            turns.close()


def _csv(series: Sequence[Series]) -> bytes:
    titles = [one.title + (f" ({one.unit})" if one.unit else "") for one in series]
    return ",".join(["cycle", "time (s)", *titles]).encode() + b"\n" + _lines([one.numbers for one in series])


def _lines(numbers: Sequence[Any]) -> bytes:
    """A line for every cycle for which one of the histories has a row of cycle, time and value."""
    every = np.concatenate(numbers)
    cycles, first = np.unique(every[:, 0], return_index=True)
    columns = [list(map(str, cycles.astype(int).tolist())), list(map(repr, every[first, 1].tolist()))]
    for rows in numbers:
        column = [""] * len(cycles)
        for row, value in zip(np.searchsorted(cycles, rows[:, 0]).tolist(), rows[:, 2].tolist(), strict=True):
            column[row] = repr(value)
        columns.append(column)
    return "".join(f"{','.join(cells)}\n" for cells in zip(*columns, strict=True)).encode()


def _extend_csv(path: Path, series: Sequence[Series], before: Counts) -> None:
    """Add the lines of what was recorded after the first `before` numbers of each history."""
    with path.open("ab") as file:
        file.write(_lines([one.since(n) for one, n in zip(series, before, strict=True)]))


def _hdf5(series: Sequence[Series]) -> bytes:
    import h5py

    from udec_ia.restart.stored_histories import write_histories

    image = io.BytesIO()
    with h5py.File(image, "w", libver=("v108", "v108")) as file:
        write_histories(file, series, growing=True)
    return image.getvalue()


def _extend_hdf5(path: Path, series: Sequence[Series], before: Counts) -> None:
    """The same for the other file."""
    import h5py

    from udec_ia.restart.stored_histories import extend

    with h5py.File(path, "r+", libver=("v108", "v108")) as file:
        extend(file, series, before)
