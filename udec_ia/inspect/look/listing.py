"""What a look into a heap gives: a few sentences and a table, for people, programs and Python alike."""

from __future__ import annotations

import json
from math import isfinite
from typing import Any, NamedTuple


class Listing(NamedTuple):
    """said: sentences. columns: names of the columns; rows: what stands in them, text or numbers.

    status: exit status of a command that prints this.
    """

    said: list[str]
    columns: tuple[str, ...] = ()
    rows: list[tuple[Any, ...]] = []  # noqa: RUF012  never changed
    status: int = 0

    def as_json(self) -> str:
        """One object: `said`, and `rows` as objects by the names of the columns; NaN and infinity as text."""
        rows = [dict(zip(self.columns, map(_plain, row), strict=True)) for row in self.rows]
        return json.dumps({"said": self.said, "rows": rows}, indent=1, allow_nan=False)

    def as_text(self) -> str:
        """The sentences, and the columns beside each other: numbers to the right, the rest to the left."""
        cells = [[_cell(value) for value in row] for row in self.rows]
        if not cells:
            return "".join(f"{line}\n" for line in self.said)
        widths = [max(map(len, column)) for column in zip(self.columns, *cells, strict=True)]
        right = [
            all(isinstance(value, int | float) for value in column) for column in zip(*self.rows, strict=True)
        ]
        lines = [
            "  ".join(f"{cell:{'>' if r else '<'}{w}}" for cell, w, r in zip(row, widths, right, strict=True))
            for row in (self.columns, *cells)
        ]
        return "".join(f"{line.rstrip()}\n" for line in [*self.said, *lines])


def _plain(value: Any) -> Any:
    value = value.item() if hasattr(value, "item") else value
    return str(value) if isinstance(value, float) and not isfinite(value) else value


def _cell(value: Any) -> str:
    return f"{value:.7g}" if isinstance(value, float) else str(value)
