"""What was recorded, as files: a table to be read by anything (CSV), and the numbers bit for bit (HDF5).

NAME-history.csv has a line for every cycle at which something was recorded, and a column for each history: a
field is empty where a history was not due, and `nan` once its group has gone. NAME-history.h5 has a group
for each history. Both are written anew after every CYCLE and put in the place of the old ones in one step, so
that whatever happens they are whole.
"""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.files import put_in_place
from udec_ia.ops.watch import Series


def write(series: Sequence[Series], base: Path) -> list[Path]:
    """Write base.csv and base.h5; returns both paths. Error 31 if that cannot be done."""
    paths = [base.with_name(f"{base.name}.{kind}") for kind in ("csv", "h5")]
    for path, content in zip(paths, (_csv(series), _hdf5(series)), strict=True):
        try:
            put_in_place(path, content, force=False)
        except OSError as error:
            raise UdecError(31, f"{path}: {error.strerror or error}") from error
    return paths


def _csv(series: Sequence[Series]) -> bytes:
    numbers = [one.numbers for one in series]
    every = np.concatenate(numbers)
    cycles, first = np.unique(every[:, 0], return_index=True)
    columns = [list(map(str, cycles.astype(int).tolist())), list(map(repr, every[first, 1].tolist()))]
    for rows in numbers:
        column = [""] * len(cycles)
        for row, value in zip(np.searchsorted(cycles, rows[:, 0]).tolist(), rows[:, 2].tolist(), strict=True):
            column[row] = repr(value)
        columns.append(column)
    titles = [one.title + (f" ({one.unit})" if one.unit else "") for one in series]
    lines = [",".join(cells) for cells in (["cycle", "time (s)", *titles], *zip(*columns, strict=True))]
    return "\n".join([*lines, ""]).encode()


def _hdf5(series: Sequence[Series]) -> bytes:
    import h5py

    from udec_ia.restart.recorded import store

    image = io.BytesIO()
    with h5py.File(image, "w", libver=("v108", "v108")) as file:
        store(file, series)
    return image.getvalue()
