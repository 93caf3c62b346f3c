"""Invariants 2 and 6 for pointers: each leads to a group in use of the kind that the table gives it."""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.heap.census import SOFT, one_of
from udec_ia.reader.field_reading import KBEX, TABLE, TARGETS

OPTIONAL = ((0, None),)  # what a pointer may be that is 0 at times


def check_pointers(state: State) -> None:
    """Invariants 2 and 6: every pointer is 0, where it may be, or the base of a group in use of its kind."""
    for kind, addresses in state.address.items():
        for field in TABLE.group(kind).fields:
            if field.target is None or not len(addresses):
                continue
            targets = TARGETS[field.target]
            for i in range(field.count):
                optional = field.allowed == OPTIONAL
                for row, value in state.pointers_astray(kind, field.name, i, targets, optional):
                    state.report(
                        6 if field.role in ("backlink", "triple") else 2,
                        f"{field.name} of {kind}@{addresses[row]} points to {value}, "
                        f"which is no {' or '.join(targets)} in use",
                    )
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
