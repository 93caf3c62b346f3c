"""Invariant 2 for histories: each names a number that there is, in a group of the kind that has it.

The recording kernel takes these codes as they are.
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.reader.recordable_numbers import HISTORY, by_codes


def check_histories(state: State) -> None:
    """What is recorded, of which group and how often."""
    columns = (state.column(HISTORY, name).tolist() for name in ("KHK", "KHF", "KHG", "KHN"))
    for address, kind, number, group, every in zip(state.address[HISTORY].tolist(), *columns, strict=True):
        what = by_codes().get((kind, number))
        if what is None:
            state.report(2, f"KHK {kind} and KHF {number} of history@{address} name nothing that is recorded")
        elif group and (not what.group or state.rows(what.group, np.array([group]))[0] < 0):
            kind_wanted = what.group or "group at all"
            state.report(2, f"KHG of history@{address} points to {group}, which is no {kind_wanted} in use")
        if every < 1:
            state.report(2, f"KHN of history@{address} is {every}, not a number of cycles")
