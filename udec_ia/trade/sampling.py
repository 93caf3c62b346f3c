"""How far apart the samples are that a quantity is made of.

HISTORY records in cycles whose number is a multiple of its interval. So the samples of two runs with other
time-steps are not of the same times, and the greatest of them differs even where the motion does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from udec_ia.study.quantities import OfHistory
from udec_ia.study.reading import read


def samples(quantities: Sequence[str], folder: Path) -> dict[str, int]:
    """Cycles between two samples of each quantity that is made of a history, if there are several.

    folder: of a run that has recorded them. Raises ValueError for what is no quantity.
    """
    made = {one.name: one.quantity.number for one in read(quantities) if isinstance(one.quantity, OfHistory)}
    every = _intervals(folder) if made else {}
    return {name: every[number] for name, number in made.items() if every.get(number, 1) > 1}


def _intervals(folder: Path) -> dict[int, int]:
    """Cycles between two samples of each history of the run in a folder."""
    import h5py

    found: dict[int, int] = {}
    for path in folder.glob("*-history.h5"):
        with h5py.File(path) as file:
            found |= {int(number): int(group.attrs["every"]) for number, group in file.items()}
    return found
