"""Which groups are in use: the first thing that the checker finds out, and all else stands on it.

A block, contact or domain is in use if it stands in its main list; a corner, if it stands in the
clockwise or the reverse list of a block in use; an extension, if a group in use points to it. A word
of IA() has no type of its own, so nothing else can tell a group from a heap of numbers. Every address
is tested before it is used and every walk is bounded, whatever the words say.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from offsets import RATIOS, generated, lay_out, read_table
from offsets.generated import MFREE
from udec_ia.heap.array import MainArray
from udec_ia.inspect.walk import HEADS, SOFT

Numbers = NDArray[Any]

TABLE = read_table()
LAYOUTS = {ratio: {group.name: lay_out(group, ratio) for group in TABLE.groups} for ratio in RATIOS}
FIELDS = {field.name: field for group in TABLE.groups for field in group.fields}
LISTED = [group.name for group in TABLE.groups if group.list_head]
KIND_OF_HEAD = {code: kind for kind, codes in HEADS.items() for code in codes}
KIND_CODE = {group.name: code for code, group in enumerate(TABLE.groups, 1)}
TARGETS: dict[str, tuple[str, ...]] = {kind: (kind,) for kind in KIND_CODE}
TARGETS |= {"item": ("corner", "contact"), "soft": ("sdef", "fdef"), "any": tuple(KIND_CODE)}


def names(kind: str, role: str) -> tuple[str, ...]:
    """The fields of `kind` that the table gives the role `role`, in table order."""
    return tuple(field.name for field in TABLE.group(kind).fields if field.role == role)


(KP,) = names("block", "member")
(KBEX,) = names("block", "extension")
(KL,) = names("corner", "clockwise")
(KR,) = names("corner", "anticlockwise")
HOSTS = names("contact", "host")
FORWARD = names("contact", "clockwise")


@dataclass(frozen=True)
class Violation:
    """One broken relation: the number of the invariant, and a message that names both its ends."""

    invariant: int
    message: str

    def __str__(self) -> str:
        return f"invariant {self.invariant}: {self.message}"


class State:
    """One look at a main array: what is in use there, and the violations found so far.

    free: first unused address, as far as it can be believed. address[kind]: addresses of the groups in
    use, in list order. rings[block]: corners and contacts of the clockwise list of each block whose list
    closes. is_contact[item]: True for a contact, False for a corner in such a list. reverse[block]: corners
    along the reverse list.
    """

    def __init__(self, array: MainArray) -> None:
        self.h = array.h
        self.ratio = array.scheme.ratio
        self.layout = LAYOUTS[self.ratio]
        self.offset = {name: at for layout in self.layout.values() for name, at in layout.offset.items()}
        self.words = memoryview(self.h.ia)
        self.found: list[Violation] = []
        self.free = min(max(int(self.h.ci[MFREE]), 1), len(self.h.ia) + 1)
        self.address: dict[str, Numbers] = {}
        self.rings: dict[int, list[int]] = {}
        self.is_contact: dict[int, bool] = {}
        self.reverse: dict[int, list[int]] = {}
        self._hosts: dict[int, tuple[int, int]] = {}
        self._columns: dict[str, Numbers] = {}
        self._kind_at = np.zeros(self.free, np.int8)
        self._row_at = np.zeros(self.free, np.int32)
        self._take_stock()

    def report(self, invariant: int, message: str) -> None:
        """Add a violation."""
        self.found.append(Violation(invariant, message))

    def violations(self) -> list[Violation]:
        """What was found, each violation once, in the order of the invariants."""
        return sorted(dict.fromkeys(self.found), key=lambda violation: violation.invariant)

    def common(self, name: str) -> int:
        """An integer of the common block."""
        return int(self.h.ci[getattr(generated, name)])

    def tolerance(self, name: str) -> float:
        """A real of the common block."""
        return float(self.h.cr[getattr(generated, name)])

    def get(self, iad: int, name: str) -> int:
        """The integer `name` of the group in use at `iad`."""
        return int(self.words[iad + self.offset[name] - 1])

    def column(self, kind: str, name: str, i: int = 0) -> Numbers:
        """Field `name` of all groups of `kind` in use, as 64-bit numbers; `i` counts along an array field."""
        key = f"{name}+{i}"
        if key not in self._columns:
            at, k = self.address[kind], self.offset[name] + i
            if FIELDS[name].real:
                self._columns[key] = self.h.ra[(at - 1) // self.ratio + k - 1].astype(np.float64)
            else:
                self._columns[key] = self.h.ia[at + k - 1].astype(np.int64)
        return self._columns[key]

    def rows(self, kind: str, addresses: Numbers) -> Numbers:
        """Row of each address among the groups of `kind` in use; -1 where it is no such group."""
        inside = (addresses > 0) & (addresses < self.free)
        at = np.where(inside, addresses, 0)
        return np.where(inside & (self._kind_at[at] == KIND_CODE[kind]), self._row_at[at], -1)

    def kind_at(self, iad: int) -> str | None:
        """Kind of the group at `iad` by head code, if a whole group of that kind can stand there."""
        if not 1 <= iad < self.free or (iad - 1) % self.ratio:
            return None
        kind = KIND_OF_HEAD.get(self.words[iad - 1])
        return kind if kind and iad + self.layout[kind].size <= self.free else None

    def _take_stock(self) -> None:
        for kind in LISTED:
            self._enter(kind, self._main_list(kind))
        corners: dict[int, None] = {}
        left = self.free  # every step of a sound walk is paid for by at least one word of the heap
        for block in self.address["block"].tolist():
            ring = self._ring(block, left)
            left -= len(ring)
            reverse = self._reverse(block, left)
            left -= len(reverse)
            corners.update((iad, None) for iad in ring if not self.is_contact[iad])
            corners.update(dict.fromkeys(reverse))
        self._enter("corner", corners)
        for group in TABLE.groups:
            if group.name not in self.address:
                self._enter(group.name, self._extensions(group.name))

    def _enter(self, kind: str, addresses: Iterable[int]) -> None:
        at = np.fromiter(addresses, np.int64)
        self.address[kind] = at
        self._kind_at[at] = KIND_CODE[kind]
        self._row_at[at] = np.arange(len(at))

    def _main_list(self, kind: str) -> dict[int, None]:
        """Addresses along a main list, and the check of its links back if it has any."""
        head = TABLE.group(kind).list_head
        assert head is not None
        (link,) = names(kind, "next")
        back = next(iter(names(kind, "back")), None)
        iad, source, before = self.common(head), head, 0
        seen: dict[int, None] = {}
        while iad != 0:
            if self.kind_at(iad) != kind:
                self.report(2, f"{source} points to {iad}, which is no {kind}")
                break
            if iad in seen:
                self.report(2, f"{source} leads back to {kind}@{iad}: the {kind} list is a circle")
                break
            if back is not None and self.get(iad, back) != before:
                self.report(
                    2,
                    f"{back} of {kind}@{iad} is {self.get(iad, back)}, but {source} leads here from {before}",
                )
            seen[iad] = None
            source, before, iad = f"{link} of {kind}@{iad}", iad, self.get(iad, link)
        return seen

    def _ring(self, block: int, steps: int) -> list[int]:
        """Clockwise list of `block` as far as it can be followed; kept in `rings` if it closes."""
        first = iad = self.get(block, KP)
        source = f"{KP} of block@{block}"
        ring: list[int] = []
        seen: set[int] = set()
        for _ in range(steps):
            kind = self.kind_at(iad)
            if iad in seen:
                self.report(
                    3, f"{source} leads back to {kind}@{iad} and not to {KP} of block@{block}, {first}"
                )
                return ring
            if kind == "corner":
                link = KL
            elif kind == "contact" and ring and block in (hosts := self.hosts(iad)):
                link = FORWARD[hosts.index(block)]
            else:
                self.report(3, f"{source} leads to {iad}, which is no item of the list of block@{block}")
                return ring
            ring.append(iad)
            seen.add(iad)
            self.is_contact[iad] = kind == "contact"
            source, iad = f"{link} of {kind}@{iad}", self.get(iad, link)
            if iad == first:
                self.rings[block] = ring
                return ring
        self.report(3, f"the clockwise list of block@{block} is longer than the heap")
        return ring

    def _reverse(self, block: int, steps: int) -> list[int]:
        """Corners along the reverse list of `block` as far as it can be followed."""
        first = iad = self.get(block, KP)
        corners: dict[int, None] = {}
        for _ in range(steps):
            if self.kind_at(iad) != "corner" or iad in corners:
                break
            corners[iad] = None
            iad = self.get(iad, KR)
        if iad != first or not corners:
            self.report(3, f"the reverse list of block@{block} leads to {iad} and not back to {KP}, {first}")
        else:
            self.reverse[block] = list(corners)
        return list(corners)

    def hosts(self, contact: int) -> tuple[int, int]:
        """The two blocks that the contact names."""
        if contact not in self._hosts:
            one, two = HOSTS
            self._hosts[contact] = self.get(contact, one), self.get(contact, two)
        return self._hosts[contact]

    def _extensions(self, kind: str) -> list[int]:
        """Addresses of the groups of `kind` that stand in no list but hang on a group in use."""
        pointers = [
            self._owned(owner, field.name, kind)
            for owner in self.address
            for field in TABLE.group(owner).fields
            if field.role in ("extension", "first") and kind in TARGETS.get(field.target or "", ())
        ]
        found: dict[int, None] = {}
        link = next(iter(names(kind, "next")), None)
        for iad in np.concatenate(pointers).tolist() if pointers else ():
            while self._free_for(iad, kind) and iad not in found:
                found[iad] = None
                iad = self.get(iad, link) if link else 0
            if iad and iad in found and link:
                self.report(
                    2, f"{link} leads back to {kind}@{iad}: two lists of the kind meet, or one is a circle"
                )
        return list(found)

    def _owned(self, owner: str, name: str, kind: str) -> Numbers:
        """Pointers in field `name` of all groups of `owner` that may lead to `kind`, by their head codes."""
        values = self.column(owner, name)
        if FIELDS[name].target != "soft":
            return values
        heads = self.h.ia[self.address[owner] - 1]
        return values[[SOFT.get(int(head)) == kind for head in heads]] if len(values) else values

    def _free_for(self, iad: int, kind: str) -> bool:
        """True if a group of `kind` can stand at `iad`, where none is known yet."""
        if not 0 < iad <= self.free - self.layout[kind].size or (iad - 1) % self.ratio:
            return False
        return bool(self._kind_at[iad] == 0)


def check_pointers(state: State) -> None:
    """Invariants 2 and 6: every pointer is 0, where it may be, or the base of a group in use of its kind."""
    for kind, addresses in state.address.items():
        for field in TABLE.group(kind).fields:
            if field.target is None or not len(addresses):
                continue
            targets = TARGETS[field.target]
            for i in range(field.count):
                values = state.column(kind, field.name, i)
                good = (values == 0) & ("never 0" not in field.text)
                for target in targets:
                    good |= state.rows(target, values) >= 0
                for row in np.flatnonzero(~good):
                    state.report(
                        6 if field.role in ("backlink", "triple") else 2,
                        f"{field.name} of {kind}@{addresses[row]} points to {values[row]}, "
                        f"which is no {' or '.join(targets)} in use",
                    )
    _check_block_extensions(state)
    _check_heads(state)


def _check_block_extensions(state: State) -> None:
    blocks = state.address["block"]
    extension = state.column("block", KBEX)
    for row, head in enumerate(state.h.ia[blocks - 1].tolist()):
        kind = SOFT.get(head)
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
