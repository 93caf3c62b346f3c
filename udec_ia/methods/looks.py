"""What shows a model and changes nothing: tables, printouts, dumps, pictures, pages, the checker."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from udec_ia.checker import check, unjudged
from udec_ia.errors import UdecError
from udec_ia.layout.offsets import MCTOT
from udec_ia.methods.state import State
from udec_ia.ops.common.number_limits import whole
from udec_ia.output.dump import dump
from udec_ia.output.printout import printout
from udec_ia.reader.group_tables import table
from udec_ia.transaction import looking


class Looks(State):
    """What they return or write is all that they do."""

    def table(self, kind: str) -> Any:
        """One row a group: `address`, then the fields by the names of the table (reader/group_tables.py)."""
        return table(self.array, kind)

    def check(self) -> list[Any]:
        """All violations of the invariants of the map; empty when it is sound."""
        for sentence in unjudged(self.array):
            self.inform(sentence)
        return list(check(self.array))

    @staticmethod
    def check_file(path: str | Path) -> list[Any]:
        """All violations in the restart file `path`, also if RESTART refuses it for them.

        Error 29 if it is not what SAVE wrote.
        """
        from udec_ia.restart import look_into

        return list(check(look_into(path)))

    @looking
    def print(self, *what: str) -> str:
        """PRINT: "blocks", "contacts", "corners", "domains", "list", "dlist", "energy", "histories"."""
        if any(word.lower() == "energy" for word in what):
            self._ready()
        return printout(self.array.h, *(word.lower() for word in what), series=self._recorder.series)

    @looking
    def dump(self, n: int, m: int) -> str:
        """DUMP: the words from address n to address m."""
        return dump(self.array.h, whole(n=n), whole(m=m))

    @looking
    def plot(
        self,
        n: int | None = None,
        *,
        contacts: bool = False,
        domains: bool = False,
        addresses: bool = False,
        stresses: bool = False,
        velocities: bool = False,
        displacements: bool = False,
        contour: str = "",
        history: bool = False,
        window: tuple[float, float, float, float] | None = None,
    ) -> list[Path]:
        """PLOT: start a frame (0, also if n is left off) or draw over the last one (1); the files written.

        contour: a key of field.CONTOURS. window: range x1, x2, y1, y2 (m) that is shown, or all blocks. With
        `history`, which stands alone, what was recorded is drawn instead. A frame of more than ten states is
        written when it has grown by a quarter, and when it ends: at `plot(0)` or `stop()`.
        """
        from udec_ia.output.plot import What

        what = What(
            contacts, domains, addresses, stresses, velocities, displacements, contour.lower(), window
        )
        if history:
            if n is not None or what != What():
                advice = "use PLOT HISTORY for histories, PLOT 0 for blocks"
                raise UdecError(
                    10, "histories and blocks are not plotted together", advice, parameter="history"
                )
            return self.draw_histories()
        self._ready()
        return self.draw(self.array, n or 0, what)

    @looking
    def view(self, path: str | Path) -> Path:
        """Write the page `path` that shows the array beside the blocks, in a browser. Returns its name.

        Of several states make a `udec_ia.view.Page`. Error 31 if something else stands there, or it cannot be
        written.
        """
        from udec_ia.view import Page

        page = Page()
        page.add(self.array, f"{self.name}, cycle {self.array.h.ci[MCTOT]}", self.deck_log)
        return page.write(path)
