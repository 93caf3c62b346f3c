"""What the histories have recorded, in HDF5: a group for each, by its number, with all that explains it.

It stands so in NAME-history.h5 and, under /recorded, in the restart file, so that a run that is restarted
anywhere goes on with the numbers that it had.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import h5py
import numpy as np

from udec_ia.heap.array import MainArray
from udec_ia.ops.history import Definition, definitions
from udec_ia.ops.watch import Series
from udec_ia.restart.layout import text
from udec_ia.restart.reader import attribute, opened
from udec_ia.restart.refusal import RefusedError, refusing

TYPES = {"cycle": "<i8", "time": "<f8", "value": "<f8"}  # of the datasets, in the order of Series.numbers
RECORDED = "recorded"  # group of the restart file


def store(parent: h5py.Group, series: Sequence[Series]) -> None:
    """Write one group for each of `series` into `parent`."""
    for one in series:
        group = parent.create_group(str(one.number))
        for (name, kind), column in zip(TYPES.items(), one.numbers.T, strict=True):
            group[name] = column.astype(kind)
        for name in ("name", "group", "place", "unit", "text"):
            group.attrs[name] = text(getattr(one, name))
        group.attrs["every"] = np.int64(one.every)
        group.attrs["lost"] = np.int8(one.lost)


def recall(path: str | Path, array: MainArray) -> list[Series]:
    """What the restart file `path`, which holds `array`, has recorded. Error 29 if it contradicts itself."""
    with refusing(Path(path)), opened(Path(path)) as file:
        return [_recall(file, number, one) for number, one in enumerate(definitions(array), 1)]


def _recall(file: h5py.File, number: int, definition: Definition) -> Series:
    place = f"{RECORDED}/{number}"
    series = Series(number, definition)
    columns = [np.asarray(file[f"{place}/{name}"]) for name in TYPES]
    if any(one.dtype != kind or one.ndim != 1 for one, kind in zip(columns, TYPES.values(), strict=True)):
        raise RefusedError(f"is damaged: /{place} does not hold numbers as a history does")
    series.add(np.column_stack(columns))
    series.group, series.place = (attribute(file, place, name) for name in ("group", "place"))
    series.lost = bool(file[place].attrs["lost"])
    return series
