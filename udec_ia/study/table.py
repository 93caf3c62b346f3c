"""The table of a study: a line for each run, as CSV for anything that reads tables, and as HDF5 bit for bit.

In the HDF5 file the table is the dataset `table`, with a field for each column; the deck and the values of
its other variables are in its attributes.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from udec_ia.files import put_in_place
from udec_ia.study.runs import Result

BEFORE = ("run",)
BEHIND = (
    *("status", "error", "cycles", "seconds", "wall_seconds", "words", "peak_memory"),
    *("warnings", "message"),
)
GREATEST = 2**63  # in absolute value, of integers that are not
FIRST = b"run,"  # what a CSV file of ours begins with


class Table:
    """columns: names and values, in order. Numbers are NumPy arrays, words lists of text."""

    def __init__(self, columns: Mapping[str, Sequence[Any]]) -> None:
        self.columns = {name: _column(values) for name, values in columns.items()}

    @classmethod
    def of(cls, results: Sequence[Result], variables: Iterable[str], quantities: Iterable[str]) -> Table:
        """The results of runs with these variables and quantities."""
        columns: dict[str, list[Any]] = {"run": [one.name for one in results]}
        columns |= {name: [one.values[name] for one in results] for name in variables}
        columns |= {name: [one.quantities[name] for one in results] for name in quantities}
        columns |= {name: [getattr(one, name) for one in results] for name in BEHIND}
        columns["warnings"] = [len(one.warnings) for one in results]
        return cls(columns)

    def listed(self, name: str) -> list[Any]:
        """A column, with Python's numbers."""
        column = self.columns[name]
        return list(column.tolist() if isinstance(column, np.ndarray) else column)

    def rows(self) -> list[tuple[Any, ...]]:
        """The lines, with Python's numbers."""
        return [*zip(*map(self.listed, self.columns), strict=True)]

    def write(self, base: Path, attributes: Mapping[str, str]) -> list[Path]:
        """Write base.csv and base.h5, with attributes for the latter. Returns both names. UdecError 31."""
        files = files_of(base)
        put_in_place(files[0], self._csv(), _judge, force=False)
        put_in_place(files[1], self._hdf5(attributes), force=False)
        return files

    def _csv(self) -> bytes:
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows())
        return text.getvalue().encode()

    def _hdf5(self, attributes: Mapping[str, str]) -> bytes:
        import h5py

        types = [
            (name, column.dtype if isinstance(column, np.ndarray) else h5py.string_dtype())
            for name, column in self.columns.items()
        ]
        image = io.BytesIO()
        with h5py.File(image, "w", libver=("v108", "v108")) as file:
            table = file.create_dataset("table", data=np.array(self.rows(), np.dtype(types)))
            table.attrs.update(attributes)
        return image.getvalue()


def files_of(base: Path) -> list[Path]:
    """base.csv and base.h5."""
    return [base.with_name(f"{base.name}.{kind}") for kind in ("csv", "h5")]


def _column(values: Sequence[Any]) -> Any:
    """Integers as int64 if all can be, other numbers as 64-bit reals, anything else as text."""
    whole = all(isinstance(one, int | np.integer) and not isinstance(one, bool) for one in values)
    if whole and all(abs(one) < GREATEST for one in values):
        return np.array(values, np.int64)
    if all(isinstance(one, int | float | np.number) for one in values):
        return np.array(values, np.float64)
    return [str(one) for one in values]


def _judge(front: bytes, _: int) -> str:
    return "" if front.startswith(FIRST) else "exists, but is not a table of a study"
