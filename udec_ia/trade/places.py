"""Errors of a run name lines of the deck that a setting has made; its user knows those of another one."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from udec_ia.study.runs import Result
from udec_ia.trade.surveyed import Surveyed
from udec_ia.trade.writing import Piece


def own_lines(pieces: Sequence[Piece]) -> tuple[int, ...]:
    """The number in the user's deck of each line of these pieces, or of the line before what was put in."""
    found: list[int] = []
    for one, number, lines in pieces:
        found += [line.number for line in one.lines] if one else [number] * len(lines)
    return tuple(found)


def at_own_line(result: Result, run: Surveyed) -> Result:
    """The same with the line of the user's deck in its message."""

    def own(found: re.Match[str]) -> str:
        k = int(found[2])
        return f"{found[1]}{run.lines[k - 1] if 0 < k <= len(run.lines) else k}"

    place = re.compile(rf"^({re.escape(run.file)}:)(\d+)")
    return replace(result, message=place.sub(own, result.message))
