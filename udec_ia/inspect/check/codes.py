"""Invariant 2 for what is no pointer: codes, material numbers and counts are in the table's ranges."""

from __future__ import annotations

import numpy as np

from udec_ia.inspect.check.groups import State
from udec_ia.inspect.reading import TABLE, Numbers
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Field

COMMON = [
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
    for field, place in COMMON:
        if not allowed(field, values[place]):
            state.report(2, f"{field.name} is {values[place]}, not {in_words(field)}")


def allowed(field: Field, values: Numbers) -> Numbers:
    """True for each of `values` that the field may hold."""
    good = np.asarray(not field.allowed)
    for low, high in field.allowed:
        good = good | (values >= low if high is None else (values >= low) & (values <= high))
    return good


def in_words(field: Field) -> str:
    """What the field may hold: "0 to 2, 4 or 6"."""
    parts = [
        f"{low} or more" if high is None else f"{low} to {high}" if high > low else f"{low}"
        for low, high in field.allowed
    ]
    return " or ".join([", ".join(parts[:-1]), parts[-1]] if parts[:-1] else parts)
