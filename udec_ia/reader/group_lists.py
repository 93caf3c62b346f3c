"""Which groups stand in the lists of the table, in list order: for tables of groups, and for the checker.

A block, contact or domain is in use if it stands in its main list; a corner, if it stands in the clockwise or
the reverse list of a block in use; any other group, if a group in use points to it, or to the first of a list
in which it stands. Every address is tested before it is used and every walk is bounded. A list that breaks,
and a group that only the census (heap/group_census.py) finds, raises Unsound; the checker goes on.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.heap.group_census import SOFT, census, one_of
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.untrusted_lists import chains
from udec_ia.reader.block_rings import Boundaries, boundaries
from udec_ia.reader.field_reading import KIND_CODE, LISTED, TABLE, TARGETS, Numbers, Reading, names
from udec_ia.reader.list_walks import HEADS

CHAINS = InterpretWhenSmall(chains, 2e7)  # places where a group could begin


class Pointers(NamedTuple):
    """The field `name` of groups of `kind` at the addresses `at`: what it holds, and whose the groups are."""

    name: str
    kind: str
    at: Numbers
    values: Numbers
    owner: Numbers


class Lists(Reading):
    """The groups of one main array by the lists that they stand in, each kind followed when it is asked for.

    address[kind]: addresses of the groups in use, in list order, of the kinds followed so far. owner[kind]:
    for corners, grid-points and zones the block that each belongs to, for other groups without a list in the
    common block the group that points to them. boundaries: the lists around blocks, as corners are found.
    kind_at: KIND_CODE of what begins at each real, 0 for nothing.
    """

    boundaries: Boundaries | None = None

    def __init__(self, array: MainArray) -> None:
        super().__init__(array)
        self.address: dict[str, Numbers] = {}
        self.owner: dict[str, Numbers] = {}
        self.kind_at = np.zeros((self.free - 1) // self.ratio + 1, np.int8)

    def addresses(self, kind: str) -> Numbers:
        """Addresses of all groups of `kind` in use, in list order; corners and extensions block by block."""
        if kind not in self.address:
            if kind in LISTED:
                found = self._main_list(kind)
            elif kind == "corner":
                self.boundaries = boundaries(self, self.addresses("block"))
                found, self.owner[kind] = self.boundaries.corner, self.boundaries.owner
            elif host := TABLE.group(kind).behind:
                self.owner[kind] = self.addresses(host)[: None if self.common(TABLE.group(kind).flag) else 0]
                found = self.owner[kind] + self.layout[host].size
            else:
                found, self.owner[kind] = self._owned_groups(kind)
            self._enter(kind, found)
        return self.address[kind]

    def invalid_pointers(
        self, kind: str, name: str, i: int, targets: Sequence[str], optional: bool
    ) -> list[tuple[int, int]]:
        """Row and value of the pointers of groups of `kind` to none of `targets`. optional: 0 is allowed."""
        values = self.h.ia[self.address[kind] + (self.offset[name] + i - 1)]
        good = self.are_groups(values, targets) | (optional & (values == 0))
        rows = np.flatnonzero(~good)
        return list(zip(rows.tolist(), values[rows].tolist(), strict=True))

    def are_groups(self, at: Numbers, kinds: Sequence[str]) -> Numbers:
        """True for each of the numbers `at` where a group of the kinds `kinds` followed so far begins."""
        found = self.kind_at[self.place_or_end(at)]
        return np.asarray(one_of(found, [KIND_CODE[kind] for kind in kinds]))

    def report_lost(self, *kinds: str) -> None:
        """Report groups of these kinds that the census knows, but no list leads to."""
        known = census(self.h)
        for kind in kinds:
            if len(known[kind]) > len(self.addresses(kind)):
                lost = known[kind][~np.isin(known[kind], self.address[kind])]
                more = f" and {len(lost) - 1} more are" if len(lost) > 1 else " is"
                self.report(2, f"{kind}@{lost[0]}{more} in no list, but pointers lead there")

    def _enter(self, kind: str, at: Numbers) -> None:
        """Groups of `kind` are in use at the addresses `at`, all different."""
        self.address[kind] = at
        self.kind_at[self.place(at)] = KIND_CODE[kind]

    def _main_list(self, kind: str) -> Numbers:
        """Addresses along a main list: taken as they come, then tested all at once."""
        head = TABLE.group(kind).list_head
        assert head is not None
        (link,) = names(kind, "next")
        at, _ = self._chains(kind, link, np.array([self.common(head)]))
        ends = not len(at) or at[-1] != 0
        at = at if ends else at[:-1]
        good = one_of(self.h.ia[at - 1], HEADS[kind])
        wrong = len(at) if good.all() else int(np.argmin(good))
        again = _first_repeated(at[:wrong])
        if ends and again == len(at):
            return at
        source = f"{link} of {kind}@{at[again - 1]}" if again else head
        end = self.get(int(at[again - 1]), link) if again else self.common(head)
        if again < wrong:
            self.report(2, f"{source} leads back to {kind}@{end}: the {kind} list is a circle")
        else:
            self.report(2, f"{source} points to {end}, which is no {kind}")
        return at[:again]

    def _owned_groups(self, kind: str) -> tuple[Numbers, Numbers]:
        """The groups of `kind`, which others own, and their owners; one by one if a pointer is invalid."""
        link = next(iter(names(kind, "next")), None)
        pointers = list(self._pointers_to(kind))
        parts: list[tuple[Numbers, Numbers]] = [(np.empty(0, np.int64),) * 2]
        for one in pointers:
            at, many = self._chains(kind, link, one.values) if link else (one.values, 1)
            parts.append((at, np.repeat(one.owner, many)))
        at, owner = (np.concatenate(found) for found in zip(*parts, strict=True))
        if self._stand(kind, at) and len(np.unique(at)) == len(at):
            return at, owner
        return self._owned_groups_one_by_one(kind, link, pointers)

    def _chains(self, kind: str, link: str, firsts: Numbers) -> tuple[Numbers, Numbers]:
        """Addresses along the lists of `kind` that begin at `firsts`, and how many each list has.

        Where one breaks stands 0. A circle is walked until it has more groups than there can be.
        """
        at, many = np.empty(len(self.kind_at) + 1, np.int64), np.zeros(len(firsts), np.int64)
        step, last = self.offset[link] - 1, self.last(kind)
        found = CHAINS(len(at), self.h.ia, firsts, step, last, self.ratio, at, many)
        return at[:found].copy(), many

    def _stand(self, kind: str, at: Numbers) -> bool:
        """True if groups of `kind` can stand at all addresses `at`: there, and no group of another kind."""
        if not ((at >= 1) & (at <= self.last(kind)) & ((at - 1) % self.ratio == 0)).all():
            return False
        coded = kind not in HEADS or one_of(self.h.ia[at - 1], HEADS[kind]).all()
        return bool(coded and not self.kind_at[self.place(at)].any())

    def _owned_groups_one_by_one(
        self, kind: str, link: str | None, pointers: list[Pointers]
    ) -> tuple[Numbers, Numbers]:
        """The same, and what breaks is reported."""
        last, ratio, words, known = self.last(kind), self.ratio, self.words, self.kind_at
        codes, step = HEADS.get(kind, ()), self.offset[link] - 1 if link else 0
        found: dict[int, int] = {}
        for one in pointers:
            for host, iad, owner in zip(
                one.at.tolist(), one.values.tolist(), one.owner.tolist(), strict=True
            ):
                name, source = one.name, (one.kind, host)
                while iad not in found:
                    there = 0 < iad <= last and not (iad - 1) % ratio and not known[(iad - 1) // ratio]
                    if not there or (codes and words[iad - 1] not in codes):
                        self.report_invalid_pointer(f"{name} of {source[0]}@{source[1]}", iad, kind)
                        break
                    found[iad] = owner
                    name, source, iad = link or "", (kind, iad), words[iad + step] if link else 0
                    if iad == 0:
                        break
                else:
                    what = "two lists of the kind meet, or one is a circle" if link else "it has an owner"
                    self.report(2, f"{name} of {source[0]}@{source[1]} leads back to {kind}@{iad}: {what}")
        return np.fromiter(found, np.int64), np.fromiter(found.values(), np.int64)

    def _pointers_to(self, kind: str) -> Iterator[Pointers]:
        """All pointers to groups of `kind`, or to the first of a list of them, but for those that are 0."""
        for group in TABLE.groups:
            for field in group.fields:
                if field.role not in ("extension", "first") or kind not in TARGETS.get(str(field.target), ()):
                    continue
                at = self.addresses(group.name)
                values = self.read(at, field.name)
                if field.target == "soft":  # the head code of the block says what it is
                    (code,) = (code for code, soft in SOFT.items() if soft == kind)
                    chosen = self.h.ia[at - 1] == code
                else:
                    chosen = values != 0
                owner = self.owner.get(group.name, at)
                yield Pointers(field.name, group.name, at[chosen], values[chosen], owner[chosen])


def _first_repeated(at: Numbers) -> int:
    """Where in `at` an address stands for the second time; its length if none does."""
    order = np.argsort(at, kind="stable")
    again = order[1:][at[order[1:]] == at[order[:-1]]]
    return int(again.min()) if len(again) else len(at)
