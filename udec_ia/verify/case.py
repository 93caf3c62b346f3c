"""What a problem is given to be run on: words, a type of blocks, and paper for one picture."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.heap.word_scheme import scheme
from udec_ia.model import Model

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from udec_ia.output.plot import Frame

BLOCKS = ("rigid", "sdef", "fdef")
CROSS = [(1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]  # four zones about grid-point 5


class Case:
    """One run of a problem: `build` is the word scheme, `blocks` the type of the blocks in question."""

    def __init__(self, name: str, build: str, blocks: str) -> None:
        self.name = name
        self.build = build
        self.blocks = blocks
        self._frame: Frame | None = None
        self._graph: Figure | None = None

    @property
    def last_digit(self) -> float:
        """Half the last digit of a real, as a share of it: what rounding can change it by."""
        return float(np.finfo(scheme(self.build).real_type).eps) / 2

    def model(self, law: Any = None) -> Model:
        """An empty model in the words of this case. law: of constitutive number 2."""
        return Model(build=self.build, constitutive=law, name=self.name)

    def deform(self, m: Model, x1: float, x2: float, y1: float, y2: float) -> None:
        """Make the rectangular block x1 x2 y1 y2 one of the type in question; fdef: four zones."""
        if self.blocks == "sdef":
            m.change(x1, x2, y1, y2, type="sdef")
        elif self.blocks == "fdef":
            points = [((x1 + x2) / 2, (y1 + y2) / 2), (x2, y1), (x2, y2), (x1, y2), (x1, y1)]
            m.generate(x1, x2, y1, y2, "manual", points, CROSS)

    def draw(self, m: Model, **what: Any) -> None:
        """Draw the blocks as they stand, over those drawn before; `what` as for Model.plot."""
        from udec_ia.output.outline import snapshot
        from udec_ia.output.plot import Frame, What

        asked = What(**what)
        if self._frame is None:
            self._frame = Frame(self.name)
        self._frame.add(snapshot(m.h, asked.contacts, asked.domains, inside=True), asked)

    def graph(self, x: str, y: str, exact: Mapping[str, Any], computed: Sequence[Any]) -> None:
        """Draw curves, each x and y: exact ones as lines, by their names, computed ones as points.

        x, y: what the axes show.
        """
        from udec_ia.verify.picture import graph

        self._graph = graph(self.name, x, y, exact, computed)

    def picture(self) -> bytes | None:
        """What was drawn, a PNG; None if nothing was."""
        from udec_ia.verify.picture import png

        if self._graph is not None:
            return png(self._graph)
        return None if self._frame is None else png(self._frame.figure())
