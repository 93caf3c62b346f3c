"""Recording while cycles run: what the histories in IA() ask for is gathered into series of numbers.

A compiled loop fills a block of rows (kernels.drive.watch); between two pieces of a run the rows are handed
on to the series. Rows that were handed on before are passed over, so nothing is lost or doubled when Ctrl-C
comes between the two.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.cycle import has_to_judge
from udec_ia.kernels.drive.passes import passes
from udec_ia.kernels.drive.recording import measures, record
from udec_ia.kernels.drive.watch import run_watched
from udec_ia.ops.commands.history_definitions import Definition, definitions, places
from udec_ia.ops.run.unrest import Unrest

ROWS = 1024  # rows that a compiled piece can fill
SOLVE_LIMIT = 100_000  # cycles after which SOLVE gives up
FAR = 1 << 60  # cycles that no run has
NEVER = -1.0  # force ratio that is never reached
NO_MARKS = np.zeros(0, np.uint8)
NO_PLACES, NO_ROWS = np.zeros((0, 2), np.int64), np.zeros((1, 2))


def run_unwatched(h: Memory, n: int, laws: Any, marks: Any = NO_MARKS) -> int:
    """Up to `n` cycles that nobody watches, by the same machine code; returns how many were completed.

    laws, marks: see kernels.drive.watch.run_watched.
    """
    called = passes(h, laws[0], (), NEVER, False, marks)
    return int(run_watched(h, n, laws, NEVER, *nothing_recorded(), marks, called)[0])


def nothing_recorded() -> tuple[Any, Any, Any]:
    """What run_watched is given where nothing is recorded: places, rows and count."""
    return NO_PLACES, NO_ROWS, np.zeros(1, np.int64)


class Series:
    """The numbers of one history.

    number: of the history. name, unit, text: of the field. group: kind and last address of its group, "" if
    there is none. place: where the group was when it was chosen by a point, else "". lost: True once the
    group has gone and the user has been told so.
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
        self.follow(definition)

    def follow(self, definition: Definition) -> None:
        """Take the address that the group has now; one that has gone keeps its last name."""
        if definition.address:
            self.group = f"{definition.what.group}@{definition.address}"

    @property
    def title(self) -> str:
        """What is recorded, in a few words."""
        return f"{self.number}: {self.name}" + (f" of {self.group}" if self.group else "")

    def __str__(self) -> str:
        place = f" at {self.place}" if self.place else ""
        cycles = "cycle" if self.every == 1 else f"{self.every} cycles"
        return f"history {self.title}{place}, every {cycles}: {self.text}"

    @property
    def numbers(self) -> Any:
        """All that was recorded, one row each: cycle, time in s, value."""
        self._parts = [np.concatenate(self._parts)]
        return self._parts[0]

    def since(self, n: int) -> Any:
        """What was recorded after the first `n` numbers, as rows of `numbers`."""
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

    def until(self, cycle: int) -> None:
        """Forget what was recorded after that cycle."""
        self._parts = [self.numbers[self.numbers[:, 0] <= cycle]]
        self.count = len(self._parts[0])

    def add(self, rows: Any) -> None:
        """Take in rows of cycle, time and value that were recorded later than all others."""
        new = rows[rows[:, 0] > self.last_cycle]
        if len(new):
            self._parts.append(new)
            self.count += len(new)


class Watch:
    """Runs cycles of `array` and hands what is recorded to `series`.

    ratio: to within which there must be rest to stop. reached: True when there was, after a cycle of this
    run: forces are those of the properties, loads and laws of now only when the contacts have been passed
    through with them. lost: those of `series` whose groups were found to have gone since they were last
    looked at. mean: the mean unbalanced force counts, not the greatest. unrest: notes what moves on the way.
    """

    def __init__(
        self,
        array: MainArray,
        series: list[Series],
        ratio: float = NEVER,
        mean: bool = False,
        unrest: Unrest | None = None,
    ) -> None:
        self.array = array
        self.series = series
        self.ratio = float(ratio)  # a kernel is compiled for one type
        self.mean = mean
        self.unrest = unrest
        self.reached = False
        self.lost: list[Series] = []
        self._rows, self._count = np.empty((0, 2)), np.zeros(1, np.int64)

    def begin(self) -> None:
        """Look at the state before the first cycle, groups being where they will stay."""
        self.look()
        self._places = places(self.array)
        self._rows = np.empty((ROWS, 2 + len(self.series)))
        if len(self._places):
            record(self.array.h, self._places, self._rows, self._count, measures(self.array.h))
        self.hand_on()
        if self.unrest is not None:
            self.unrest.begin(self.array)

    def ahead(self) -> int:
        """Cycles until something is to be noted that no compiled loop notes."""
        return FAR if self.unrest is None else self.unrest.ahead(self.array.h)

    def run(self, n: int, laws: Any, marks: Any = NO_MARKS) -> int:
        """Up to `n` cycles; returns how many were completed. Stops early for an error and at the ratio.

        laws, marks: see kernels.drive.watch.run_watched.
        """
        h, done, full = self.array.h, 0, True
        recorded = self._places, self._rows, self._count
        called = passes(h, laws[0], recorded if len(self._places) else (), self.ratio, self.mean, marks)
        while done < n and full:
            try:
                completed, self.reached = run_watched(h, n - done, laws, self.ratio, *recorded, marks, called)
            finally:
                full = self.hand_on() == ROWS
            done += int(completed)
            if full and has_to_judge(h):
                break
        if self.unrest is not None:
            self.unrest.note(self.array)
        return done

    def look(self) -> None:
        """See where the groups are now, and which have gone."""
        for number, definition in enumerate(definitions(self.array), 1):
            if number > len(self.series):
                self.series.append(Series(number, definition))
            series = self.series[number - 1]
            series.follow(definition)
            if definition.lost and not series.lost:
                series.lost = True
                self.lost.append(series)

    def hand_on(self) -> int:
        """Let the series have the rows that are filled, if they have not; returns the number of rows."""
        if self._count[0] == 0:
            return 0
        rows = self._rows[: self._count[0]].copy()
        for i, series in enumerate(self.series):
            due = rows[:, 0] % series.every == 0
            series.add(rows[due][:, [0, 1, 2 + i]])
        self._count[0] = 0
        return len(rows)


class Around(Watch):
    """A watch of which only `run` is another's: all else is done, and known, by `inner`."""

    def __init__(self, inner: Watch) -> None:
        self.inner = inner

    def __getattr__(self, name: str) -> Any:
        return getattr(self.inner, name)

    def begin(self) -> None:
        self.inner.begin()

    def look(self) -> None:
        self.inner.look()

    def hand_on(self) -> int:
        return self.inner.hand_on()
