"""What was recorded, as files: a table to be read by anything (CSV), and the numbers bit for bit (HDF5).

NAME-history.csv has a line for every cycle at which something was recorded, and a column for each history: a
field is empty where a history was not due, and `nan` once its group has gone. NAME-history.h5 has a group
for each history. Both are extended after every CYCLE, and whole at every moment (turns.py).
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.output.turns import Turns
from udec_ia.running.history_series import Series

Counts = tuple[int, ...]  # numbers of each history


class Files:
    """The two files of the histories of a run."""

    def __init__(self, base: Path) -> None:
        self.place = base.absolute()
        self.paths = [base.with_name(f"{base.name}.{kind}") for kind in ("csv", "h5")]
        self._turns = [Turns(path) for path in self.paths]
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

    from udec_ia.restart.recorded import store

    image = io.BytesIO()
    with h5py.File(image, "w", libver=("v108", "v108")) as file:
        store(file, series, growing=True)
    return image.getvalue()


def _extend_hdf5(path: Path, series: Sequence[Series], before: Counts) -> None:
    """The same for the other file."""
    import h5py

    from udec_ia.restart.recorded import extend

    with h5py.File(path, "r+", libver=("v108", "v108")) as file:
        extend(file, series, before)
