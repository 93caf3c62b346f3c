"""Reading a heap without trusting it: fields of groups by name, and what the table says of lists."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.accessors import gather
from udec_ia.heap.group_census import CHOICES
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field, layouts, read_table
from udec_ia.reader.list_walks import Unsound

Numbers = NDArray[Any]
INDEX = np.int32  # of the index into a list: as many items as that would take a heap of 80 GB

TABLE = read_table()
FIELDS = {field.name: field for group in TABLE.groups for field in group.fields}
LISTED = [group.name for group in TABLE.groups if group.list_head]
KIND_CODE = {group.name: code for code, group in enumerate(TABLE.groups, 1)}
TARGETS: dict[str, tuple[str, ...]] = {kind: (kind,) for kind in KIND_CODE}
TARGETS |= CHOICES | {"any": tuple(KIND_CODE)}


@cache
def names(kind: str, role: str) -> tuple[str, ...]:
    """The fields of `kind` that the table gives the role `role`, in table order: those of 1980 come first."""
    return tuple(field.name for field in TABLE.group(kind).fields if field.role == role)


KP, *_ = names("block", "member")
KBEX, *_ = names("block", "extension")
KL, *_ = names("corner", "clockwise")
KR, *_ = names("corner", "anticlockwise")
HOSTS = names("contact", "host")[:2]
FORWARD = names("contact", "clockwise")[:2]


class Reading:
    """One look at a main array, which may end in Unsound. free: first unused address, if credible."""

    def __init__(self, array: MainArray) -> None:
        self.h = array.h
        self.ratio = array.scheme.ratio
        self.layout = layouts(self.ratio)
        self.offset = {name: at for layout in self.layout.values() for name, at in layout.offset.items()}
        self.words = memoryview(self.h.ia)
        self.free = min(max(int(self.h.ci[g.MFREE]), 1), len(self.h.ia) + 1)
        self._shift = self.ratio.bit_length() - 1  # groups begin on reals: an address as the place of a real

    def report(self, invariant: int, message: str) -> None:
        """What is done about a relation that is broken."""
        raise Unsound(message)

    def report_invalid_pointer(self, source: str, iad: int, kind: str) -> None:
        """What is done about an invalid pointer: it leads to `iad`, where no group of `kind` can be."""
        raise Unsound(f"{source} points to {iad}, which is no {kind}")

    def last(self, kind: str) -> int:
        """The last address that a group of `kind` can have."""
        return self.free - self.layout[kind].size

    def place(self, at: Numbers) -> Numbers:
        """The places of groups at the addresses `at`, counted in reals from 0."""
        return (at - 1) >> self._shift

    def place_or_end(self, at: Numbers) -> Numbers:
        """The same for any numbers `at`; the place at MFREE, where no group begins, where none can."""
        place = self.place(at)
        good = (at >= 1) & (at < self.free) & (place << self._shift == at - 1)
        return np.where(good, place, (self.free - 1) >> self._shift)

    def common(self, name: str) -> int:
        """An integer of the common block."""
        return int(self.h.ci[getattr(g, name)])

    def get(self, iad: int, name: str) -> int:
        """The integer `name` of the group in use at `iad`."""
        return int(self.words[iad + self.offset[name] - 1])

    def read(self, addresses: Numbers, name: str, i: int = 0) -> Numbers:
        """Field `name` of groups in use, as 64-bit numbers; `i` counts along an array field."""
        k = self.offset[name] + i
        if FIELDS[name].real:
            with np.errstate(invalid="ignore"):  # of 32 bits, which may be signalling NaNs
                return np.asarray(gather(self.h, addresses, (k - 1) * self.ratio, True), np.float64)
        return np.asarray(gather(self.h, addresses, k, False))


def allowed(field: Field, values: Numbers) -> Numbers:
    """True for each of `values` that the field may hold."""
    good = np.asarray(not field.allowed)
    for low, high in field.allowed:
        good = good | (values >= low if high is None else (values >= low) & (values <= high))
    return good


def in_words(field: Field) -> str:
    """What the field may hold: "0 to 2 or 4 or 6"."""
    return " or ".join(
        f"{low} or more" if high is None else f"{low} to {high}" if high > low else f"{low}"
        for low, high in field.allowed
    )


ROOM = 100  # rows that are expected


def kernel_rows(kernel: InterpretWhenSmall, groups: int, columns: int, *args: Any, of: type = int) -> Numbers:
    """The rows that `kernel` finds with `args`. groups: how many it goes through; of: int or float."""
    found = room = ROOM
    while found >= room:  # once more, if there are more than had room
        room = found + 1
        rows: Numbers = np.empty((room, columns), of)
        found = kernel(groups, *args, rows)
    return rows[:found]
