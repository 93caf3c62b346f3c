"""Pointers lead to groups of their kind, codes are in range, reals are finite: invariants 1, 2, 5, 6, 7, 9.

The routines of the program take these words as they are, without a further test. So do the kernels with the
sizes and tolerances of the common block, and with what a history records.
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.compiling.interpreted_kernels import interpreted
from udec_ia.errors import MESSAGES
from udec_ia.heap.group_census import SOFT, one_of
from udec_ia.heap.main_array import variable
from udec_ia.kernels.geometry.tolerances import tolset
from udec_ia.layout import offsets as g
from udec_ia.reader.field_reading import KBEX, TABLE, TARGETS, allowed, in_words
from udec_ia.reader.recordable_numbers import HISTORY, by_codes

OPTIONAL = ((0, None),)  # what a pointer may be that is 0 at times


def check_pointers(state: State) -> None:
    """Invariants 2 and 6: every pointer is 0, where it may be, or the base of a group in use of its kind."""
    for kind, addresses in state.address.items():
        for field in TABLE.group(kind).fields if len(addresses) else ():
            targets, optional = TARGETS.get(str(field.target), ()), field.allowed == OPTIONAL
            number = 6 if field.role in ("backlink", "triple") else 2
            for i in range(field.count if targets else 0):
                for row, value in state.invalid_pointers(kind, field.name, i, targets, optional):
                    text = f"{field.name} of {kind}@{addresses[row]} points to {value}"
                    state.report(number, f"{text}, which is no {' or '.join(targets)} in use")
    _check_block_extensions(state)
    _check_heads(state)


def _check_block_extensions(state: State) -> None:
    blocks = state.address["block"]
    extension = state.column("block", KBEX)
    heads = state.h.ia[blocks - 1]
    for row in np.flatnonzero(one_of(heads, tuple(SOFT)) | (extension != 0)).tolist():
        kind = SOFT.get(int(heads[row]))
        if kind is None and extension[row] != 0:
            what = "but a rigid block has no extension"
        elif kind is not None and state.rows(kind, extension[row : row + 1])[0] < 0:
            what = f"which is no {kind} in use"
        else:
            continue
        state.report(2, f"{KBEX} of block@{blocks[row]} points to {extension[row]}, {what}")


def _check_heads(state: State) -> None:
    """Pointers of the common block to a group that is not the head of a list (the outer domain)."""
    heads = {group.list_head for group in TABLE.groups}
    for field in TABLE.common:
        if field.role != "head" or field.name in heads or field.target is None:
            continue
        value = state.common(field.name)
        needed = bool(len(state.address[field.target]))
        row = state.rows(field.target, np.array([value]))[0]
        if row < 0 and (value != 0 or needed):
            state.report(2, f"{field.name} points to {value}, which is no {field.target} in use")


def check_codes(state: State) -> None:
    """Every integer that routines take as it is, in the groups and in the common block."""
    for kind, addresses in state.address.items():
        for field in TABLE.group(kind).fields if len(addresses) else ():
            if not field.real and field.target is None and field.allowed:
                values = state.read(addresses, field.name)
                for row in np.flatnonzero(~allowed(field, values)):
                    text = f"{field.name} of {kind}@{addresses[row]} is {values[row]}"
                    state.report(2, f"{text}, not {in_words(field)}")
    for field in TABLE.common:
        if not field.real and field.target is None and field.allowed:
            values = variable(state.h, field)
            for i in np.flatnonzero(~allowed(field, values)):
                state.report(2, f"{field.name} is {values[i]}, not {in_words(field)}")


COMMON_REALS = [field for field in TABLE.common if field.type != "int"]
FORCE_SUMS = ("KBFX", "KBFY", "KBFT")


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
    offsets = [state.offset[field.name] for field in TABLE.group(kind).fields if field.real]
    base, last = (state.address[kind] - 1) // state.ratio - 1, max(offsets, default=0)
    return all(np.isfinite(state.h.ra[base + k]).all() for k in range(min(offsets, default=1), last + 1))


def check_common(state: State) -> None:
    """Tolerances and error of a run: invariant 5."""
    ci, cr = state.h.ci, state.h.cr
    d = cr[g.DTOL]
    tolerances = cr.copy()
    with interpreted():  # to load what is compiled takes longer
        tolset(state.h._replace(cr=tolerances), d)
    alike = np.allclose(tolerances, cr, rtol=4 * np.finfo(cr.dtype).eps, atol=0, equal_nan=True)
    if (ended := ci[g.NSPOIL]) > 0 and ended not in MESSAGES:
        state.report(5, f"NSPOIL is {ended}, which is not the number of an error")
    if not (0 <= d < np.inf and alike):
        state.report(5, f"tolerances do not follow from the rounding length, {d:g}")


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
