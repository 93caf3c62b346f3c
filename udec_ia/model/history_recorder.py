"""Records of a session: the numbers of its histories, and the results of its SOLVEs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.ops.commands.history_definitions import define, define_sum, named
from udec_ia.ops.common.block_ranges import limits_turned
from udec_ia.ops.common.number_limits import reals
from udec_ia.reader.group_ranges import Range, Selection, read_range
from udec_ia.reader.reaction_rows import reactions_in
from udec_ia.reader.recordable_numbers import OF_REACTIONS, Recordable, over_summands
from udec_ia.remark import Remark
from udec_ia.running.history_series import Recording, Series
from udec_ia.running.solve_result import Solution

if TYPE_CHECKING:
    from udec_ia.output.history_files import HistoryFiles
    from udec_ia.output.history_graph import Wanted


class HistoryRecorder:
    """series: the numbers of all histories. solutions: results of all SOLVEs, in order.

    safety: of all FOS the factor, the greatest stable and the least failing one.
    """

    def __init__(self) -> None:
        self.series: list[Series] = []
        self.solutions: list[Solution] = []
        self.safety: list[tuple[float, float, float]] = []
        self.pictures = 0
        self._files: HistoryFiles | None = None

    def replace(self, series: list[Series]) -> None:
        """Continue with `series`, the numbers of which are not in the files."""
        self.series, self._files = series, None

    def add(
        self,
        array: MainArray,
        n: int,
        field: str,
        address: int | None,
        at: Sequence[Any],
        within: Sequence[float] | str,
    ) -> list[Series]:
        """New histories of `field`, every `n` cycles, of groups at an address or at points, or in a range."""
        from udec_ia.reader.group_positions import select_groups

        what = named(field)
        if len(within):
            if len(at) or address is not None:
                raise UdecError(10, "a range with an address or a point", parameter="within")
            where = read_range(within) if isinstance(within, str) else reals(4, within=within)
            return [self._add_sum(array, n, what, where)]
        chosen = select_groups(array, what.group, field, address, at)
        define(array, what, [one.address for one in chosen], n)
        first = len(self.series)
        Recording(array, self.series).update_definitions()
        for series, one in zip(self.series[first:], chosen, strict=True):
            series.place = one.place
        return self.series[first:]

    def _add_sum(self, array: MainArray, n: int, what: Recordable, where: Range) -> Series:
        """A new history of the sum of the reactions in a range."""
        word = next((one for one in OF_REACTIONS if one.upper() == what.field.name), None)
        if word is None:
            advice = "RANGE is for XREACTION, YREACTION and MREACTION"
            raise UdecError(10, f"{what.field.name} is no sum over a range", advice, parameter="within")
        held = reactions_in(array, where)
        if not len(held):
            advice = "PRINT REACTIONS shows the places of what is fixed or has a prescribed velocity"
            raise UdecError(24, limits_turned(where) or "nothing in it is held", advice, parameter="within")
        define_sum(array, over_summands(word), held, n)
        Recording(array, self.series).update_definitions()
        if isinstance(where, Selection):
            self.series[-1].place = where.text
        else:
            self.series[-1].place = "x {:.4g} to {:.4g}, y {:.4g} to {:.4g}".format(*where)
        return self.series[-1]

    def write(self, recording: Recording, base: Path, tell: Callable[[str], None]) -> list[Path]:
        """Write all histories to base.csv and base.h5, and report which groups do not exist any more."""
        if not self.series:
            return []
        from udec_ia.output.history_files import HistoryFiles

        recording.update_definitions()
        for one in recording.lost:
            text = f"history {one.number}: {one.group} was deleted; NaN is recorded from here on"
            tell(Remark("history-group-deleted", text))
        if self._files is None or self._files.place != base.absolute():
            self._files = HistoryFiles(base)
        return self._files.write(self.series)

    def plot(self, name: str, folder: Path, wanted: Wanted, after: int = 0) -> list[Path]:
        """Draw histories, with a number of the picture greater than `after`; returns the files.

        Error 26 if nothing was recorded yet, and those of history_graph.curves_of.
        """
        from udec_ia.output.history_graph import draw

        if not any(one.last_cycle >= 0 for one in self.series):
            raise UdecError(26, "nothing was recorded", "give HISTORY before CYCLE", parameter="history")
        number = max(self.pictures, after) + 1
        files = draw(self.series, name, folder / f"{name}-history-{number}", wanted)
        self.pictures = number
        return files
