"""The series of numbers that histories record, and the runs of cycles that fill them.

A compiled loop fills an array of rows (kernels.drive.cycle). Between two pieces of a run the rows are added
to the series. Rows that a series has already are ignored, so Ctrl-C in between loses and doubles nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.cycle import change_is_due, passes, run_with_records
from udec_ia.kernels.drive.history_recording import measures, record
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.history_definitions import Definition, definitions, places
from udec_ia.reader.group_tables import import_pandas

if TYPE_CHECKING:
    from pandas import DataFrame

ROWS = 1024  # rows that a compiled piece can fill
SOLVE_LIMIT = 100_000  # cycles after which SOLVE gives up
NEVER = -1.0  # a force ratio that no run reaches
NO_MARKS = np.zeros(0, np.uint8)
NO_PLACES, NO_ROWS = np.zeros((0, 2), np.int64), np.zeros((1, 2))


def run_unwatched(h: Memory, n: int, laws: Any) -> int:
    """Up to `n` cycles without recording; returns their number. laws: as in run_with_records."""
    called = passes(h, laws[0], (), NEVER, False, NO_MARKS)
    return int(run_with_records(h, n, laws, NEVER, *nothing_recorded(), NO_MARKS, called)[0])


def nothing_recorded() -> tuple[Any, Any, Any]:
    """Arguments of run_with_records for a run without recording: places, rows and count."""
    return NO_PLACES, NO_ROWS, np.zeros(1, np.int64)


class Series:
    """The numbers of one history.

    name, unit, text: of the field. group: kind and last address of its group, or "". place: of the group when
    it was selected by a point, else "". lost: the group has disappeared, and the user was warned.
    """

    def __init__(self, number: int, definition: Definition, place: str = "") -> None:
        field = definition.what.field
        self.number = number
        self.name, self.unit, self.text = field.name, "" if field.unit == "-" else field.unit, field.text
        self.group = ""
        self.place = place
        self.every = definition.every
        self.lost = False
        self.count = 0  # numbers recorded
        self._parts = [np.zeros((0, 3))]
        self.set_address(definition)

    def set_address(self, definition: Definition) -> None:
        """Take the present address of the group; a deleted group keeps its last name."""
        if definition.address:
            self.group = f"{definition.what.group}@{definition.address}"

    @property
    def title(self) -> str:
        """The history in a few words."""
        return f"{self.number}: {self.name}" + (f" of {self.group}" if self.group else "")

    def __str__(self) -> str:
        place = f" at {self.place}" if self.place else ""
        cycles = "cycle" if self.every == 1 else f"{self.every} cycles"
        return f"history {self.title}{place}, every {cycles}: {self.text}"

    @property
    def numbers(self) -> Any:
        """Shape (n, 3): cycle, time in s, value."""
        self._parts = [np.concatenate(self._parts)]
        return self._parts[0]

    def rows_after(self, n: int) -> Any:
        """The rows of `numbers` after the first `n`, without joining the earlier ones."""
        parts, missing = [np.zeros((0, 3))], self.count - n
        for part in reversed(self._parts):
            if missing <= 0:
                break
            parts.append(part[-missing:])
            missing -= len(parts[-1])
        return np.concatenate(parts[::-1])

    @property
    def last_cycle(self) -> int:
        """The last cycle that was recorded; -1 before the first one."""
        last = next((part for part in reversed(self._parts) if len(part)), None)
        return -1 if last is None else int(last[-1, 0])

    def truncate_after(self, cycle: int) -> None:
        """Remove the rows after that cycle."""
        self._parts = [self.numbers[self.numbers[:, 0] <= cycle]]
        self.count = len(self._parts[0])

    def add(self, rows: Any) -> None:
        """Add rows of cycle, time and value that are later than the last one."""
        new = rows[rows[:, 0] > self.last_cycle]
        if len(new):
            self._parts.append(new)
            self.count += len(new)


def frame_of(series: Sequence[Series]) -> DataFrame:
    """Histories as a data frame of pandas: a row for each cycle in which one was recorded, by its time (s).

    Columns: `cycle`, and the title of each; NaN where it was not recorded. attrs: "names" in words, "units".
    ModuleNotFoundError without pandas.
    """
    pandas = import_pandas()
    numbers = {one.title: one.numbers for one in series}
    times = {int(cycle): time for rows in numbers.values() for cycle, time in rows[:, :2].tolist()}
    cycles = sorted(times)
    columns: dict[str, Any] = {"cycle": np.array(cycles, np.int64)}
    for title, rows in numbers.items():
        columns[title] = np.full(len(cycles), np.nan)
        columns[title][np.searchsorted(columns["cycle"], rows[:, 0])] = rows[:, 2]
    found = pandas.DataFrame(columns, index=pandas.Index([times[one] for one in cycles], dtype=float))
    found.index.name = "time"
    found.attrs["names"] = {"cycle": "cycle"} | {one.title: str(one) for one in series}
    found.attrs["units"] = {"cycle": ""} | {one.title: one.unit for one in series}
    return found


Marks = Callable[[Memory, int], Any]  # returns the marks of contacts for a run of so many cycles


class Recording:
    """Runs cycles of `array` and records histories in `series`.

    ratio: force ratio at which the run ends. mean: of the mean unbalanced force, not of the greatest. marks:
    of contacts that open and close (kernels.drive.cycle). reached: the model was at rest after a cycle of
    this run; before the first one forces are not yet those of the present properties, loads and laws. lost:
    histories whose groups have disappeared.
    """

    def __init__(
        self,
        array: MainArray,
        series: list[Series],
        ratio: float = NEVER,
        mean: bool = False,
        marks: Marks = lambda h, n: NO_MARKS,
    ) -> None:
        self.array = array
        self.series = series
        self.ratio = float(ratio)  # the kernel is compiled for a float
        self.mean = mean
        self.reached = False
        self.lost: list[Series] = []
        self._marks = marks
        self._last = 0  # last cycle of the run
        self._rows, self._count = np.empty((0, 2)), np.zeros(1, np.int64)

    def begin(self, n: int) -> None:
        """Record the state before the first of `n` cycles."""
        self._last = int(self.array.h.ci[g.MCTOT]) + n
        self.update_definitions()
        self._places = places(self.array)
        self._rows = np.empty((ROWS, 2 + len(self.series)))
        if len(self._places):
            record(self.array.h, self._places, self._rows, self._count, measures(self.array.h))
        self.flush_rows()

    def renew(self) -> None:
        """Groups have disappeared in the run: record what is left."""
        self.flush_rows()
        self.update_definitions()
        self._places = places(self.array)

    def run(self, n: int, laws: Any) -> int:
        """Up to `n` cycles, fewer after an error or at the ratio. Returns their number."""
        h, done, full = self.array.h, 0, True
        recorded = self._places, self._rows, self._count
        marks = self._marks(h, self._last - int(h.ci[g.MCTOT]))
        called = passes(h, laws[0], recorded if len(self._places) else (), self.ratio, self.mean, marks)
        while done < n and full:
            try:
                completed, self.reached = run_with_records(
                    h, n - done, laws, self.ratio, *recorded, marks, called
                )
            finally:
                full = self.flush_rows() == ROWS
            done += int(completed)
            if full and change_is_due(h):
                break
        return done

    def update_definitions(self) -> None:
        """Update the series with the present addresses of their groups, and `lost`."""
        for number, definition in enumerate(definitions(self.array), 1):
            if number > len(self.series):
                self.series.append(Series(number, definition))
            series = self.series[number - 1]
            series.set_address(definition)
            if definition.lost and not series.lost:
                series.lost = True
                self.lost.append(series)

    def flush_rows(self) -> int:
        """Add the filled rows to the series; returns the number of rows."""
        if self._count[0] == 0:
            return 0
        rows = self._rows[: self._count[0]].copy()
        for i, series in enumerate(self.series):
            due = rows[:, 0] % series.every == 0
            series.add(rows[due][:, [0, 1, 2 + i]])
        self._count[0] = 0
        return len(rows)
