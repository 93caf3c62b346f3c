"""The numbers of histories in HDF5: a group for each history, by its number, with what explains it.

NAME-history.h5 has these groups, and so has a restart file, under /recorded: a run that is restarted anywhere
continues with the numbers that it had.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import h5py
import numpy as np

from udec_ia.heap.accessors import iget
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.history_definitions import Definition, definitions
from udec_ia.reader.list_walks import Unsound, groups
from udec_ia.reader.recordable_numbers import HISTORY, by_codes
from udec_ia.restart.file_seal import RefusedError
from udec_ia.restart.file_tables import text
from udec_ia.restart.hdf5_contents import Contents
from udec_ia.running.history_series import Series

TYPES = {"cycle": "<i8", "time": "<f8", "value": "<f8"}  # of the datasets, in the order of Series.numbers
CHUNK = 512  # numbers in one piece of a dataset that grows
RECORDED = "recorded"  # group of the restart file
ADDRESS = re.compile(r"[0-9]{1,19}")
NUMBER = "[-+.0-9a-z]{1,12}"
PLACE = re.compile(rf"|\({NUMBER}, {NUMBER}\)|x {NUMBER} to {NUMBER}, y {NUMBER} to {NUMBER}")


def has_readable_histories(array: MainArray) -> bool:
    """True if `array`, which may be unsound, says what its histories are of."""
    h = array.h
    try:
        return all((iget(h, ih, g.KHK), iget(h, ih, g.KHF)) in by_codes() for ih in groups(h, HISTORY))
    except Unsound:
        return False


def complete_series(array: MainArray, series: Sequence[Series]) -> Sequence[Series]:
    """`series`, and an empty one for each other history of `array`."""
    if not has_readable_histories(array):
        return series
    found = {one.number: one for one in series}
    return [found.get(n, Series(n, one)) for n, one in enumerate(definitions(array), 1)]


def write_histories(parent: h5py.Group, series: Sequence[Series], growing: bool = False) -> None:
    """Write one group for each of `series` into `parent`; growing: so that `extend` can add to them."""
    layout = {"maxshape": (None,), "chunks": (CHUNK,)} if growing else {}
    for one in series:
        group = parent.create_group(str(one.number))
        for (name, kind), column in zip(TYPES.items(), one.numbers.T, strict=True):
            group.create_dataset(name, data=column.astype(kind), **layout)
        for name in ("name", "group", "place", "unit", "text"):
            group.attrs[name] = text(getattr(one, name))
        group.attrs["every"] = np.int64(one.every)
        group.attrs["lost"] = np.int8(one.lost)


def extend(parent: h5py.Group, series: Sequence[Series], before: Sequence[int]) -> None:
    """Add what was recorded after the first `before` numbers of each of `series`, which are there."""
    for one, n in zip(series, before, strict=True):
        for (name, kind), column in zip(TYPES.items(), one.rows_after(n).T, strict=True):
            dataset = parent[f"{one.number}/{name}"]
            dataset.resize((n + len(column),))
            dataset[n:] = column.astype(kind)


def read_histories(file: Contents, array: MainArray, forced: bool) -> list[Series]:
    """What a restart file, which holds `array`, has recorded. RefusedError if it contradicts itself.

    forced: the file was saved by force, which leaves out what a broken list of histories has recorded.
    """
    _, minor = file.attribute_numbers("", "format_version", "<i4", (2,))
    may_lack = forced or minor == 0  # format 1.0 had none
    return [_read_history(file, number, one, may_lack) for number, one in enumerate(definitions(array), 1)]


def _read_history(file: Contents, number: int, definition: Definition, may_lack: bool) -> Series:
    where = f"{RECORDED}/{number}"
    series = Series(number, definition)
    if not (file.has(RECORDED) and file.has(where)):
        if may_lack:
            return series
        raise RefusedError(f"is damaged: /{where} is not there, though there is such a history")
    columns = [file.numbers(f"{where}/{name}", kind, None) for name, kind in TYPES.items()]
    cycles = columns[0]
    if len({len(one) for one in columns}) > 1 or (np.diff(cycles, prepend=-1) <= 0).any():
        raise RefusedError(f"is damaged: /{where} does not hold numbers as a history does")
    series.add(np.column_stack(columns))
    group, place = (file.attribute(where, name).decode() for name in ("group", "place"))
    kind, _, address = group.partition("@")
    known = not group or (kind == definition.what.group and ADDRESS.fullmatch(address))
    if not (known and PLACE.fullmatch(place)):
        raise RefusedError(f"is damaged: /{where} does not say of what it is the history")
    series.place = place
    if not definition.address:  # else it is known where the group is now
        series.group = group
    series.lost = bool(file.attribute_numbers(where, "lost", "i1"))
    return series
