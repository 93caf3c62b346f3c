"""The files of the histories: a table for any program (CSV), and the numbers bit for bit (HDF5).

NAME-history.csv has a line for every cycle at which something was recorded, and a column for each history: a
field is empty where a history was not due, and `nan` once its group has gone. NAME-history.h5 has a group
for each history. After every CYCLE the new numbers are added to a copy, which replaces the file in one step.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.file_replacement import put_in_place
from udec_ia.running.history_series import Series

Counts = tuple[int, ...]  # numbers of each history
LIBRARY = "v108", "v108"  # format of HDF5


class HistoryFiles:
    """The two files of the histories of a run, base.csv and base.h5."""

    def __init__(self, base: Path) -> None:
        self.place = base.absolute()
        self.paths = [base.with_name(f"{base.name}.{kind}") for kind in ("csv", "h5")]
        self._written: dict[Path, tuple[Any, ...]] = {}  # stamp of a file, what its histories are, and counts

    def write(self, series: Sequence[Series]) -> list[Path]:
        """Bring both files up to date; returns their paths. Error 31 if that cannot be done."""
        described = [(one, one.title, one.place, one.lost) for one in series]
        counts = tuple(one.count for one in series)
        for path, extended in zip(self.paths, (_extended_csv, _extended_hdf5), strict=True):
            stamp, *before = self._written.get(path, (None,))
            if stamp is None or stamp != _stamp(path) or before[0] != described:
                before = [described, ()]
            if before[1] != counts:
                try:
                    content = path.read_bytes() if before[1] else b""
                except OSError as error:
                    raise UdecError(31, f"{path}: {error.strerror or error}") from error
                put_in_place(path, extended(content, series, before[1]), force=False)
                self._written[path] = _stamp(path), described, counts
        return self.paths


def _stamp(path: Path) -> tuple[int, ...] | None:
    """Identity of a file and whether it has been written to; None if there is no file."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns


def _extended_csv(content: bytes, series: Sequence[Series], before: Counts) -> bytes:
    """The table `content`, which has the first `before` numbers of each history, with the others added."""
    if before:
        return content + _lines([one.rows_after(n) for one, n in zip(series, before, strict=True)])
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


def _extended_hdf5(content: bytes, series: Sequence[Series], before: Counts) -> bytes:
    """The same for the other file."""
    import h5py

    from udec_ia.restart.stored_histories import extend, write_histories

    image = io.BytesIO(content)
    with h5py.File(image, "r+" if before else "w", libver=LIBRARY) as file:
        if before:
            extend(file, series, before)
        else:
            write_histories(file, series, growing=True)
    return image.getvalue()
