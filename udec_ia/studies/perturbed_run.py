"""Runs whose last digits are perturbed: every real that a cycle has changed is moved at random.

Between two cycles each real that has changed since the last kick is moved by xi units in the last place, xi
uniform in [-1, 1], and rounded to the nearest: as if the last rounding of each number were done once more, up
or down at random (Verrou and CADNA do that to every operation). Numbers that nothing changes stay.

To bound the cost there are KICKS at most. If a kick stands for k cycles it is sqrt(k) units high: random
steps, each as likely up as down, add up so.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts, read_table
from udec_ia.reader.group_tables import addresses as listed
from udec_ia.running.observer import between_cycles
from udec_ia.studies.execute_run import RunObserver
from udec_ia.studies.study_run import StudyRun

KICKS = 1000
STAYING = ("block", "corner", "gridpoint", "zone", "sdef")  # groups that come and go by commands only
PASSING = {"contact": (g.ICPNT, g.KC), "domain": (g.IDPNT, g.KD)}  # those of cycles: head and link
KINDS = (*STAYING, *PASSING)


@dataclass(frozen=True)
class PerturbedRun(StudyRun):
    """A perturbed run. seed: of the noise, 0 for none. fields: "block.KX" ..., all if there are none.

    cycles: of the whole run, about.
    """

    seed: int = 1
    fields: tuple[str, ...] = ()
    cycles: int = 0

    @property
    def made_of(self) -> dict[str, str]:
        return super().made_of | {"noise": f"{self.seed} {self.fields} {self.cycles}"}

    def observers(self, model: Any) -> list[RunObserver]:
        return [_Noise(model.array, self)] if self.seed else []


class _Noise(RunObserver):
    """Kicks the reals of a model, as `run` asks for."""

    def __init__(self, array: MainArray, run: PerturbedRun) -> None:
        self.every = max(1, run.cycles // KICKS)
        self._random = np.random.default_rng(run.seed)
        ratio = array.scheme.ratio
        shapes = {
            group.name: [
                layouts(ratio)[group.name].offset[field.name] - 1
                for field in group.fields
                if field.real and (not run.fields or f"{group.name}.{field.name}" in run.fields)
            ]
            for group in read_table().groups
            if group.name in KINDS
        }
        self._fields = {kind: np.array(found, np.int64) for kind, found in shapes.items() if found}
        self._staying = np.zeros(0, np.int64)
        self._before: Any = None

    def begin(self, array: MainArray, solves: bool) -> None:
        """See RunObserver: groups are where they will stay."""
        parts = [self._cells(array, kind, listed(array, kind)) for kind in self._fields if kind in STAYING]
        self._staying = np.concatenate([np.zeros(0, np.int64), *parts])

    def cycles_ahead(self, array: MainArray, n: int) -> int:
        """See RunObserver: until the next kick."""
        h = array.h
        self._before = h.ra[: int(h.ci[g.MFREE]) // array.scheme.ratio + 1].copy()
        return min(n, self.every - int(h.ci[g.MCTOT]) % self.every)

    def look(self, array: MainArray, cycles: int) -> None:
        if between_cycles(array.h) and array.h.ci[g.MCTOT] % self.every == 0:
            self._kick(array)

    def _kick(self, array: MainArray) -> None:
        """Move what has changed."""
        h = array.h
        parts = [
            self._cells(array, kind, addresses(h, int(h.ci[head]), link))
            for kind, (head, link) in PASSING.items()
            if kind in self._fields
        ]
        cells = np.concatenate([self._staying, *parts])
        cells = cells[cells < len(self._before)]
        now = h.ra[cells]
        moved = np.isfinite(now) & (now != self._before[cells]) & (now != 0)
        cells, now = cells[moved], now[moved]
        xi = self._random.uniform(-1, 1, len(now)) * self.every**0.5
        h.ra[cells] = now + (xi * np.spacing(np.abs(now))).astype(now.dtype)

    def _cells(self, array: MainArray, kind: str, at: Any) -> Any:
        """Where the reals of groups are, as numbers of reals."""
        first = (np.asarray(at, np.int64) - 1) // array.scheme.ratio
        return (first[:, None] + self._fields[kind]).ravel()
