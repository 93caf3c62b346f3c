"""Which groups are in use: the first thing that the checker finds out, and all else stands on it.

A block, contact or domain is in use if it stands in its main list; a corner, if it stands in the
clockwise or the reverse list of a block in use; an extension, if a group in use points to it. A word
of IA() has no type of its own, so nothing else can tell a group from a heap of numbers. Every address
is tested before it is used and every walk is bounded, whatever the words say.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from udec_ia.heap.array import MainArray
from udec_ia.heap.slack import give_back
from udec_ia.inspect.census import CHOICES
from udec_ia.inspect.walk import HEADS, SOFT, follow, one_of
from udec_ia.layout import offsets as g
from udec_ia.layout.table import layouts, read_table

Numbers = NDArray[Any]

TABLE = read_table()
FIELDS = {field.name: field for group in TABLE.groups for field in group.fields}
LISTED = [group.name for group in TABLE.groups if group.list_head]
KIND_OF_HEAD = {code: kind for kind, codes in HEADS.items() for code in codes}
KIND_CODE = {group.name: code for code, group in enumerate(TABLE.groups, 1)}
TARGETS: dict[str, tuple[str, ...]] = {kind: (kind,) for kind in KIND_CODE}
SHORT = 64  # items of a list that is walked together with others
INDEX = np.int32  # of the index into a list: as many items as that would take a heap of 80 GB
STRETCH = 256  # places in which groups are counted by a byte
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


LOST = "are in no group"  # what is said of words that no list leads to


@dataclass(frozen=True)
class Violation:
    """One broken relation: the number of the invariant, and a message that names both its ends."""

    invariant: int
    message: str

    def __str__(self) -> str:
        return f"invariant {self.invariant}: {self.message}"

    @property
    def misleads(self) -> bool:
        """False for words that no list leads to: they are lost, and no routine will ever come to them."""
        return not self.message.endswith(LOST)


@dataclass(frozen=True)
class Rings:
    """The clockwise lists that close, block after block; arrays with one element for each item of a list.

    block: addresses of the blocks; first, count: where their items stand. item: address; owner: index into
    `block`; contact: True for a contact; row: row among the contacts or corners in use, -1 for none; side: 0
    if the block is KB1 of the contact, 1 if it is KB2. before, after: index of the neighbours; corner: index
    of the first corner at or after the item. at: two rows, the index of each contact in use in the list of
    its block KB1 and of its block KB2; -1 where it does not stand there.
    """

    block: Numbers
    first: Numbers
    count: Numbers
    item: Numbers
    owner: Numbers
    contact: Numbers
    row: Numbers
    side: Numbers
    before: Numbers
    after: Numbers
    corner: Numbers
    at: Numbers


class State:
    """One look at a main array: what is in use there, and the violations found so far.

    free: first unused address, as far as it can be believed. address[kind]: addresses of the groups in
    use, in list order. owner[kind]: for corners, grid-points and zones the block that each belongs to, for
    other groups without a list in the common block the group that points to them. rings: the clockwise lists.
    """

    def __init__(self, array: MainArray) -> None:
        self.h = array.h
        self.ratio = array.scheme.ratio
        self.layout = layouts(self.ratio)
        self.offset = {name: at for layout in self.layout.values() for name, at in layout.offset.items()}
        self.words = memoryview(self.h.ia)
        self.found: list[Violation] = []
        self._shift = self.ratio.bit_length() - 1  # groups begin on reals: an address as the place of a real
        self.free = min(max(int(self.h.ci[g.MFREE]), 1), len(self.h.ia) + 1)
        self.address: dict[str, Numbers] = {}
        self.owner: dict[str, Numbers] = {}
        self._columns: dict[str, Numbers] = {}
        places = (self.free - 1) // self.ratio + 1  # groups begin on reals: at these places, from 0
        self._kind_at = np.zeros(places, np.int8)
        self._nth_at = np.zeros(places, np.uint8)  # among the groups of its kind that begin in the stretch
        self._before: dict[str, Numbers] = {}  # by kind: groups that begin before each stretch
        self._row: dict[str, Numbers] = {}  # by kind: row of the groups in the order of their addresses
        for kind in LISTED:
            self._enter(kind, self._main_list(kind))
        self.rings = self._take_rings()
        for group in TABLE.groups:
            if group.name not in self.address:
                self._take_extensions(group.name)

    def report(self, invariant: int, message: str) -> None:
        """Add a violation."""
        self.found.append(Violation(invariant, message))

    def violations(self) -> list[Violation]:
        """What was found, each violation once, in the order of the invariants."""
        return sorted(dict.fromkeys(self.found), key=lambda violation: violation.invariant)

    def common(self, name: str) -> int:
        """An integer of the common block."""
        return int(self.h.ci[getattr(g, name)])

    def tolerance(self, name: str) -> float:
        """A real of the common block."""
        return float(self.h.cr[getattr(g, name)])

    def get(self, iad: int, name: str) -> int:
        """The integer `name` of the group in use at `iad`."""
        return int(self.words[iad + self.offset[name] - 1])

    def read(self, addresses: Numbers, name: str, i: int = 0) -> Numbers:
        """Field `name` of groups in use, as 64-bit numbers; `i` counts along an array field."""
        k = self.offset[name] + i - 1
        if FIELDS[name].real:
            return np.asarray(self.h.ra[k:].take((addresses - 1) >> self._shift), np.float64)
        return np.asarray(self.h.ia.take(addresses + k), np.int64)

    def column(self, kind: str, name: str, i: int = 0) -> Numbers:
        """The same of all groups of `kind` in use; it is read once and kept."""
        key = f"{name}+{i}"
        if key not in self._columns:
            self._columns[key] = self.read(self.address[kind], name, i)
        return self._columns[key]

    def forget(self) -> None:
        """Keep no column: what comes now needs others, and room."""
        self._columns.clear()
        give_back()

    def leave_lists(self) -> None:
        """Keep no list either: what comes now looks at none."""
        del self.rings
        self.forget()

    def rows(self, kind: str, addresses: Numbers) -> Numbers:
        """Row of each address among the groups of `kind` in use; -1 where it is no such group."""
        if not len(addresses):
            return np.empty(addresses.shape, INDEX)
        place = self._places(addresses)
        there = self._kind_at.take(place) == KIND_CODE[kind]
        if not there.any():
            return np.full(addresses.shape, -1, INDEX)
        nth = self._before[kind].take(place // STRETCH) + self._nth_at.take(place)
        return np.where(there, self._row[kind].take(nth, mode="clip"), INDEX(-1))

    def holds(self, kinds: Sequence[str], addresses: Numbers) -> Numbers:
        """True for each address at which a group in use of one of the `kinds` begins."""
        codes = [KIND_CODE[kind] for kind in kinds]
        return np.asarray(one_of(self._kind_at.take(self._places(addresses)), codes))

    def _places(self, addresses: Numbers) -> Numbers:
        """Where in `_kind_at` each address stands; the last place, which is of no group, for nonsense."""
        before, last = addresses - 1, len(self._kind_at) - 1
        place = before >> self._shift
        astray = (before < 0) | (place > last) | (before & (self.ratio - 1) != 0)
        return np.where(astray, last, place)

    def _enter(self, kind: str, at: Numbers) -> None:
        """Groups of `kind` are in use at the addresses `at`, all different."""
        self.address[kind] = at
        place = (at - 1) // self.ratio
        order = np.argsort(place, kind="stable")
        in_order = place[order]
        before = np.searchsorted(in_order, np.arange(0, len(self._kind_at), STRETCH)).astype(INDEX)
        self._kind_at[place] = KIND_CODE[kind]
        self._nth_at[in_order] = np.arange(len(at)) - before[in_order // STRETCH]
        self._before[kind], self._row[kind] = before, order.astype(INDEX)

    def _kind(self, iad: int) -> str | None:
        """Kind of the group at `iad` by head code, if a whole group of that kind can stand there."""
        if not 1 <= iad < self.free or (iad - 1) % self.ratio:
            return None
        kind = KIND_OF_HEAD.get(self.words[iad - 1])
        return kind if kind and iad + self.layout[kind].size <= self.free else None

    def _main_list(self, kind: str) -> Numbers:
        """Addresses along a main list, and the check of its links back if it has any."""
        head = TABLE.group(kind).list_head
        assert head is not None
        (link,) = names(kind, "next")
        last = self.free - self.layout[kind].size
        listed, iad = follow(self.words, self.common(head), self.offset[link] - 1, last, self.ratio)
        at = np.array(listed, np.int64)
        good = one_of(self.h.ia[at - 1], HEADS[kind])
        wrong = int(np.argmin(good)) if not good.all() else len(at)
        again = _first_repeated(at[:wrong])
        end = iad if again == len(at) else listed[again]
        at = at[:again]

        def source(row: Any) -> str:
            return f"{link} of {kind}@{at[row - 1]}" if row else head

        if end != 0 and again < wrong:
            self.report(2, f"{source(again)} leads back to {kind}@{end}: the {kind} list is a circle")
        elif end != 0:
            self.report(2, f"{source(again)} points to {end}, which is no {kind}")
        for back in names(kind, "back"):
            before, noted = np.concatenate(([0], at[:-1])), self.read(at, back)
            for row in np.flatnonzero(noted != before[: len(at)]):
                text = f"{back} of {kind}@{at[row]} is {noted[row]}"
                self.report(2, f"{text}, but {source(row)} leads here from {before[row]}")
        return at

    def _take_rings(self) -> Rings:
        """The clockwise lists, and the corners in use: those of all lists, reverse lists included."""
        blocks = self.address["block"]
        last = (self.free - self.layout[kind].size for kind in ("corner", "contact"))
        self._steps = (*last, *(self.offset[name] - 1 for name in (KL, *HOSTS, *FORWARD)))
        row, item = self._short_rings(blocks)
        left = self.free  # every step of a sound walk is paid for by at least one word of the heap
        rows, items = [row], [item]
        broken: list[int] = []
        for k in np.flatnonzero(np.bincount(row, minlength=len(blocks)) == 0).tolist():
            ring, closed = self._ring(int(blocks[k]), left)
            left -= len(ring)
            if closed:
                rows.append(np.full(len(ring), k))
                items.append(np.array(ring, np.int64))
            else:
                broken.append(int(blocks[k]))
        row, item = np.concatenate(rows), np.concatenate(items)
        order = np.argsort(row, kind="stable")
        count = np.bincount(row, minlength=len(blocks))
        rings = self._lay_out(blocks[count > 0], count[count > 0], item[order])
        corners, owners = [rings.item[~rings.contact]], [rings.block[rings.owner[~rings.contact]]]
        turned = self.read(corners[0], KR) != rings.item[corner_before(rings)]
        for block in [*broken, *np.unique(owners[0][turned]).tolist()]:
            found = self._ring_corners(block, left) + self._reverse(block, left)
            left -= len(found)
            corners.append(np.array(found, np.int64))
            owners.append(np.full(len(found), block))
        at, owner = np.concatenate(corners), np.concatenate(owners)
        there = np.zeros(len(self._kind_at), bool)
        there[(at - 1) >> self._shift] = True
        if np.count_nonzero(there) < len(at):  # the first list that a corner stands in has it
            once = np.sort(np.unique(at, return_index=True)[1])
            at, owner = at[once], owner[once]
        self._enter("corner", at)
        self.owner["corner"] = owner
        rings.row[~rings.contact] = self.rows("corner", rings.item[~rings.contact])
        return rings

    def _lay_out(self, block: Numbers, count: Numbers, item: Numbers) -> Rings:
        """The lists as arrays; the rows of corners are still to come."""
        end = np.cumsum(count, dtype=INDEX)
        first = (end - count).astype(INDEX)
        owner = np.repeat(np.arange(len(block), dtype=INDEX), count)
        here = np.arange(len(item), dtype=INDEX)
        contact = self.h.ia[item - 1] == g.MCON
        row = np.where(contact, self.rows("contact", item), -1)
        side = np.zeros(len(item), np.int8)
        side[contact] = self.read(item[contact], HOSTS[0]) != block[owner[contact]]
        at = np.full((2, len(self.address["contact"])), -1, INDEX)
        listed = contact & (row >= 0)
        at[side[listed], row[listed]] = here[listed]
        corner = np.where(contact, INDEX(len(item)), here)
        corner = np.minimum.accumulate(corner[::-1])[::-1]
        return Rings(
            block=block,
            first=first,
            count=count,
            item=item,
            owner=owner,
            contact=contact,
            row=row,
            side=side,
            before=np.where(here == first[owner], end[owner] - 1, here - 1),
            after=np.where(here == end[owner] - 1, first[owner], here + 1),
            corner=np.where(corner < end[owner], corner, first[owner]),  # a list begins with a corner
            at=at,
        )

    def _short_rings(self, blocks: Numbers) -> tuple[Numbers, Numbers]:
        """Row of the block and item, for the lists that close in a few steps; all are walked at a time.

        The items of a block stand in the order of its list. What does not close is left to `_ring`.
        """
        ia, (last_corner, last_contact, along, one, two, over_one, over_two) = self.h.ia, self._steps
        live = np.arange(len(blocks))
        first = here = self.read(blocks, KP)
        closed = np.zeros(len(blocks), bool)
        rows, items = [], []
        for k in range(SHORT if last_corner > 0 else 0):
            at = np.where((here > 0) & (here <= last_corner) & ((here - 1) % self.ratio == 0), here, 0)
            head = np.where(at > 0, ia[at - 1], 0)
            contact = (head == g.MCON) & (at <= last_contact) & (k > 0)
            at = np.where(contact, at, 1)
            left = contact & (ia[at + one] == blocks[live])
            right = contact & ~left & (ia[at + two] == blocks[live])
            good = (head == g.MCOR) | left | right
            step = np.select([left, right], [over_one, over_two], along)[good]
            here, live = here[good], live[good]
            rows.append(live)
            items.append(here)
            here = ia[here + step].astype(np.int64)
            back = here == first[live]
            closed[live[back]] = True
            here, live = here[~back], live[~back]
            if not len(live):
                break
        row, item = (np.concatenate([np.empty(0, np.int64), *parts]) for parts in (rows, items))
        kept = closed[row]
        return row[kept], item[kept]

    def _ring(self, block: int, steps: int) -> tuple[list[int], bool]:
        """Clockwise list of `block` as far as it can be followed, and whether it closes."""
        words, ratio = self.words, self.ratio
        last_corner, last_contact, along, one, two, over_one, over_two = self._steps
        first = iad = self.get(block, KP)
        ring: dict[int, None] = {}
        while iad not in ring and 0 < iad <= last_corner and not (iad - 1) % ratio and len(ring) < steps:
            head = words[iad - 1]
            if head == g.MCOR:
                step = along
            elif head != g.MCON or iad > last_contact or not ring:
                break
            elif words[iad + one] == block:
                step = over_one
            elif words[iad + two] == block:
                step = over_two
            else:
                break
            ring[iad] = None
            iad = words[iad + step]
        if iad == first and ring:
            return list(ring), True
        before = list(ring)[-1:]
        source = self.link(block, before[0]) if before else f"{KP} of block@{block}"
        if iad in ring:
            kind = self._kind(iad)
            what = f"{source} leads back to {kind}@{iad} and not to {KP} of block@{block}, {first}"
        elif len(ring) >= steps:
            what = f"the clockwise list of block@{block} is longer than the heap"
        else:
            what = f"{source} leads to {iad}, which is no item of the list of block@{block}"
        self.report(3, what)
        return list(ring), False

    def link(self, block: int, iad: int) -> str:
        """The clockwise link of the item at `iad` on `block`, in words."""
        if self._kind(iad) == "corner":
            return f"{KL} of corner@{iad}"
        return f"{FORWARD[self.hosts(iad).index(block)]} of contact@{iad}"

    def _ring_corners(self, block: int, steps: int) -> list[int]:
        """Corners of a clockwise list that does not close; nothing is reported again."""
        known = len(self.found)
        ring, _ = self._ring(block, steps)
        del self.found[known:]
        return [iad for iad in ring if self._kind(iad) == "corner"]

    def _reverse(self, block: int, steps: int) -> list[int]:
        """Corners along the reverse list of `block` as far as it can be followed."""
        first = iad = self.get(block, KP)
        corners: dict[int, None] = {}
        for _ in range(steps):
            if self._kind(iad) != "corner" or iad in corners:
                break
            corners[iad] = None
            iad = self.get(iad, KR)
        if iad != first or not corners:
            self.report(3, f"the reverse list of block@{block} leads to {iad} and not back to {KP}, {first}")
        return list(corners)

    def hosts(self, contact: int) -> tuple[int, int]:
        """The two blocks that the contact names."""
        one, two = HOSTS
        return self.get(contact, one), self.get(contact, two)

    def _take_extensions(self, kind: str) -> None:
        """Enter the groups of `kind`, which stand in no list of the common block but hang on another."""
        last, ratio, words, known = self.free - self.layout[kind].size, self.ratio, self.words, self._kind_at
        link = next(iter(names(kind, "next")), None)
        step = self.offset[link] - 1 if link else 0
        found: dict[int, int] = {}
        for name, owner, iad in self._owners(kind):
            source = name
            while 0 < iad <= last and not (iad - 1) % ratio and not known[(iad - 1) // ratio]:
                if iad in found:
                    what = "two lists of the kind meet, or one is a circle" if link else "it has an owner"
                    self.report(2, f"{source} leads back to {kind}@{iad}: {what}")
                    break
                found[iad] = owner
                source, iad = link or "", words[iad + step] if link else 0
        self._enter(kind, np.fromiter(found, np.int64))
        self.owner[kind] = np.fromiter(found.values(), np.int64)

    def _owners(self, kind: str) -> Iterator[tuple[str, int, int]]:
        """Field, owner and value of each pointer to a group of `kind`, or to the first of a list of them."""
        for group, at in list(self.address.items()):
            owner = self.owner.get(group, at)
            for field in TABLE.group(group).fields:
                if field.role in ("extension", "first") and kind in TARGETS.get(field.target or "", ()):
                    values = self.column(group, field.name)
                    if field.target == "soft":  # the head code of the block says what it is
                        (code,) = (code for code, soft in SOFT.items() if soft == kind)
                        chosen = np.flatnonzero(self.h.ia[at - 1] == code)
                    else:
                        chosen = np.flatnonzero(values)
                    for host, value in zip(owner[chosen].tolist(), values[chosen].tolist(), strict=True):
                        yield field.name, host, value


def _first_repeated(at: Numbers) -> int:
    """Where in `at` an address stands for the second time; its length if none does."""
    order = np.argsort(at, kind="stable")
    again = order[1:][at[order[1:]] == at[order[:-1]]]
    return int(again.min()) if len(again) else len(at)


def corner_before(rings: Rings) -> Numbers:
    """For each corner of the lists the index of the corner before it, clockwise."""
    corner = np.flatnonzero(~rings.contact)
    number = np.cumsum(~rings.contact) - 1  # of the corner, among all
    first = number[rings.first][rings.owner[corner]]
    count = np.add.reduceat(~rings.contact, rings.first, dtype=np.int64) if len(corner) else rings.count
    here = np.arange(len(corner))
    return corner[np.where(here == first, first + count[rings.owner[corner]] - 1, here - 1)]
