"""The laws of a model: those that its user has given, and those that a restart file says it was made with."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numba import config

from udec_ia.errors import UdecError
from udec_ia.heap.array import MainArray
from udec_ia.kernels.lawcall import ARRAYS, Laws, Material
from udec_ia.kernels.laws import BLOCKS, CONTACTS, numbers_in_use
from udec_ia.ops.lawfile import NUMBERS, RESULTS, Given, read_laws
from udec_ia.ops.limits import NCONS, NMAT

Record = dict[str, tuple[str, str]]  # name of a law: name of its file, SHA-256 of the text of the file


class LawBook:
    """The laws of one model, by name.

    recorded: those that the model was calculated with before it was saved.
    """

    def __init__(self, given: Given | Iterable[Given] | None = None) -> None:
        self.given = read_laws(given)
        self.recorded: Record = {}
        self._calls = np.zeros(len(RESULTS), np.int64)
        self._materials = np.zeros((NMAT, len(ARRAYS)))

    def record(self) -> Record:
        """What a restart file says of the laws."""
        return self.recorded | {name: (law.origin, law.digest) for name, law in self.given.items()}

    def note(self, recorded: Mapping[str, tuple[str, str]]) -> list[str]:
        """Take note of the laws that a state was made with. Returns a warning for each that has changed."""
        self.recorded = dict(recorded)
        return [
            f"{name} of {self.given[name].origin} has another text than {name} of {origin}, "
            "which the restart file was made with"
            for name, (origin, digest) in recorded.items()
            if name in self.given and self.given[name].digest != digest
        ]

    def bind(self, array: MainArray) -> Laws:
        """The laws as kernels take them, with the materials as they are now.

        They are valid as long as this object lives, and until the next call.

        Error 9 if a constitutive number is in use for which there is no law, or not the one it was used with.
        """
        first = np.zeros((2, NCONS + 1), np.int64)
        numbers_in_use(array.h, first)
        for n in NUMBERS:
            for row, kind, law in ((BLOCKS, "block", f"cl{n}"), (CONTACTS, "contact", f"clj{n}")):
                if first[row, n]:
                    self._demand(n, f"{kind}@{first[row, n]}", law, int(first[row, n]))
        rows = np.asarray(array.h.cr[np.add.outer(np.arange(NMAT), ARRAYS)], np.float64)
        calls: list[Any] = [self.given[name].call if name in self.given else 0 for name in RESULTS]
        if config.DISABLE_JIT:
            return Laws(tuple(calls), [Material(*row) for row in rows])
        self._calls[:], self._materials[:] = calls, rows
        return Laws(self._calls.ctypes.data, self._materials.ctypes.data)

    def _demand(self, n: int, who: str, law: str, group: int) -> None:
        """Error 9 unless `who` can follow constitutive number `n`: by `law`, or number 1 beside the other."""
        if law in self.given:
            return
        if law in self.recorded:
            origin = self.recorded[law][0]
            detail = f"{who} follows {law} of {origin}, which is not given"
            raise UdecError(
                9, detail, f"run with --constitutive {origin}, in Python constitutive=", group=group
            )
        if not {f"cl{n}", f"clj{n}"} & self.given.keys():
            detail = f"{who} has number {n}, for which there is no law"
            advice = f"use number 1, or give a file with a function {law}: --constitutive law.py"
            raise UdecError(9, detail, advice, group=group)
