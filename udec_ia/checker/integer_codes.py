"""Invariant 2 for what is no pointer: codes, material numbers and counts are in the table's ranges."""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import TABLE, allowed, in_words

COMMON_INTEGERS = [
    (field, getattr(g, field.name))
    for field in TABLE.common
    if not field.real and field.target is None and field.allowed
]


def check_codes(state: State) -> None:
    """Every integer that routines take as it is, in the groups and in the common block."""
    for kind, addresses in state.address.items():
        for field in TABLE.group(kind).fields:
            if field.real or field.target is not None or not field.allowed or not len(addresses):
                continue
            values = state.read(addresses, field.name)
            for row in np.flatnonzero(~allowed(field, values)):
                state.report(
                    2, f"{field.name} of {kind}@{addresses[row]} is {values[row]}, not {in_words(field)}"
                )
    values = state.h.ci.tolist()
    for field, place in COMMON_INTEGERS:
        if not allowed(field, values[place]):
            state.report(2, f"{field.name} is {values[place]}, not {in_words(field)}")
