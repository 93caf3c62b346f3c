"""Invariants 5, 7 and 9: what holds for each real alone."""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.heap.array import variable
from udec_ia.heap.interpreting import LOOKS, Sparing
from udec_ia.heap.reals import all_finite
from udec_ia.reader.field_reading import TABLE, allowed, in_words

COMMON_REALS = [field for field in TABLE.common if field.type != "int"]
FORCE_SUMS = ("KBFX", "KBFY", "KBFT")
ALL_FINITE = Sparing(all_finite, 4e5, LOOKS)  # groups


def check_numbers(state: State) -> None:
    """Invariants 5, 7 and 9: reals are finite; masses and areas, properties and dampings not negative."""
    for kind, addresses in state.address.items():
        finite = _all_finite(state, kind)
        for field in TABLE.group(kind).fields:
            if not field.real or (finite and not field.allowed) or not len(addresses):
                continue
            values = state.read(addresses, field.name)
            bad = ~np.isfinite(values)
            if field.allowed:
                bad |= ~allowed(field, values)
            for row in np.flatnonzero(bad):
                number = 9 if field.name in FORCE_SUMS else 7
                state.report(number, f"{field.name} of {kind}@{addresses[row]} is {values[row]}")
    for field in COMMON_REALS:
        values = variable(state.h, field)
        finite = np.isfinite(values)
        for i in np.flatnonzero(~(finite & allowed(field, values))):
            element = f"({i + 1})" if field.count > 1 else ""
            wanted = f", not {in_words(field)}" if finite[i] else ""
            state.report(5 if finite[i] else 7, f"{field.name}{element} is {values[i]:g}{wanted}")


def _all_finite(state: State, kind: str) -> bool:
    """Whether all reals of the groups of `kind` are, as they nearly always are."""
    reals = [state.offset[field.name] for field in TABLE.group(kind).fields if field.real]
    at = state.address[kind]
    return not reals or ALL_FINITE(len(at), state.h.ra, at, state.ratio, min(reals), max(reals))
