"""Groups of one kind as a table: a structured NumPy array with the field table's own names.

The lists are followed for the addresses only; then each field is gathered from all groups at once. That
takes the array's two views as wholes, so this file repeats the accessors' rule from address to index.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from udec_ia.heap.array import MainArray
from udec_ia.inspect.walk import HEADS, LISTS, SOFT, Unsound, follow, groups, one_of
from udec_ia.layout import offsets as g
from udec_ia.layout.table import Group, layouts, read_table


def table(array: MainArray, kind: str) -> Any:
    """All groups of `kind` that the lists reach, one row each, as a copy.

    kind: block, corner, contact, domain, sdef, fdef, zone, gridpoint, jointext, bound, signal or tabpoint.
    Rows stand in list order; corners block by block, clockwise from KP; extensions in the order of their
    blocks or domains, zones and grid-points block by block.
    Fields: `address`, then those of the field table by name and in its units, integers as int64, reals
    in the type of the word scheme; a triple is a field of three. Raises ValueError for an unknown kind
    and Unsound if the lists are broken.
    """
    kinds = [group.name for group in read_table().groups]
    if kind not in kinds:
        raise ValueError(f"unknown kind of group {kind!r}: choose one of {', '.join(kinds)}")
    return _Reader(array).rows(kind)


def addresses(array: MainArray, kind: str) -> Any:
    """Addresses of all groups of `kind` in the order of the rows of their table. Raises as `table` does."""
    return _Reader(array).addresses(kind)


def all_addresses(array: MainArray) -> dict[str, Any]:
    """The same of every kind."""
    reader = _Reader(array)
    return {kind: reader.addresses(kind) for kind in reader.groups}


class _Reader:
    """Reads one field of many groups at a time."""

    def __init__(self, array: MainArray) -> None:
        self.h = array.h
        self.scheme = array.scheme
        self.groups: dict[str, Group] = {group.name: group for group in read_table().groups}
        self.layouts = layouts(array.scheme.ratio)
        self.found: dict[str, Any] = {}  # addresses by kind: lists hang on lists

    def rows(self, kind: str) -> Any:
        """The table of all groups of `kind`."""
        addresses = self.addresses(kind)
        fields = self.groups[kind].fields
        types: list[Any] = [("address", np.int64)]
        for field in fields:
            base = self.scheme.real_type if field.real else np.dtype(np.int64)
            types.append((field.name, base, field.count) if field.count > 1 else (field.name, base))
        rows = np.empty(len(addresses), types)
        rows["address"] = addresses
        for field in fields:
            rows[field.name] = self.field(kind, field.name, addresses)
        return rows

    def field(self, kind: str, name: str, addresses: Any) -> Any:
        """The field `name` of the groups of `kind` at `addresses`: shape (n,), or (n, count)."""
        field = next(field for field in self.groups[kind].fields if field.name == name)
        offset = self.layouts[kind].offset[name]
        if field.real:
            view, first = self.h.ra, (addresses - 1) // self.scheme.ratio + offset - 1
        else:
            view, first = self.h.ia, addresses + offset - 1
        return view[first] if field.count == 1 else view[first[:, np.newaxis] + np.arange(field.count)]

    def addresses(self, kind: str) -> Any:
        """Addresses of all groups of `kind`, in list order; those of blocks block by block."""
        if kind not in self.found:
            self.found[kind] = self.reached(kind)
        return self.found[kind]

    def reached(self, kind: str) -> Any:
        """The same, found along the lists."""
        if kind in LISTS:
            return self.main_list(kind)
        if kind == "corner":
            return self.corners()
        heads = np.concatenate([np.empty(0, np.int64), *self.heads(kind)])
        links = [field.name for field in self.groups[kind].fields if field.role == "next"]
        return self.chains(kind, links[0], heads) if links else heads

    def heads(self, kind: str) -> Iterator[Any]:
        """Addresses of groups of `kind` that pointers of other groups lead to, of the first ones of lists."""
        targets = (kind, "soft") if kind in SOFT.values() else (kind,)
        for group in self.groups.values():
            for field in group.fields:
                if field.role not in ("extension", "first") or field.target not in targets:
                    continue
                owners = self.addresses(group.name)
                if field.target == "soft":  # the head code of the block says what it is
                    codes = [code for code, name in SOFT.items() if name == kind]
                    owners = owners[np.isin(self.field(group.name, "HEAD", owners), codes)]
                found = self.field(group.name, field.name, owners)
                some = slice(None) if field.target == "soft" else found != 0
                yield self.sound(kind, found[some], f"{field.name} of {group.name}", owners[some])

    def main_list(self, kind: str) -> Any:
        """Addresses along a main list: taken as they come, then tested all at once.

        If that has led astray, the list is followed again with care, which says where it breaks.
        """
        index, _ = LISTS[kind]
        (link,) = (field.name for field in self.groups[kind].fields if field.role == "next")
        step, words = self.layouts[kind].offset[link] - 1, memoryview(self.h.ia)
        found, end = follow(words, int(self.h.ci[index]), step, self.last_address(kind), self.scheme.ratio)
        at = np.array(found, np.int64)
        if end != 0 or not one_of(self.h.ia[at - 1], HEADS[kind]).all():
            return np.fromiter(groups(self.h, kind), np.int64)
        return at

    def chains(self, kind: str, link: str, heads: Any) -> Any:
        """Addresses of the groups of `kind` in the lists that begin at `heads`, linked by `link`."""
        step, last = self.layouts[kind].offset[link] - 1, self.last_address(kind)
        words = memoryview(self.h.ia)
        found: list[int] = []
        for head in heads.tolist():
            part, end = follow(words, head, step, last, self.scheme.ratio)
            found += part
            if end or len(found) > last:
                self.sound(kind, np.array([end or head]))
                raise Unsound(f"the list through {kind}@{end or head} does not come to an end")
        if len({*found}) < len(found):
            raise Unsound(f"two lists of {kind}s meet")
        return self.sound(kind, np.array(found, np.int64))

    def corners(self) -> Any:
        """Addresses of all corners: round all blocks at once along the reverse lists, then turned about."""
        blocks = self.addresses("block")
        start = here = self.sound("corner", self.field("block", "KP", blocks), "KP of block", blocks)
        owner = np.arange(len(blocks))
        found, owners = [here], [owner]
        seen = np.zeros(int(self.h.ci[g.MFREE]), bool)
        while len(here):
            here = self.sound("corner", self.field("corner", "KR", here), "KR of corner", here)
            if seen[here].any():
                raise Unsound(f"the reverse list through corner@{here[seen[here]][0]} does not close")
            seen[here] = True
            going = here != start[owner]
            here, owner = here[going], owner[going]
            found.append(here)
            owners.append(owner)
        turned = np.concatenate([found[0], *reversed(found[1:])])
        owners_turned = np.concatenate([owners[0], *reversed(owners[1:])])
        return turned[np.argsort(owners_turned, kind="stable")]

    def last_address(self, kind: str) -> int:
        """The last address that a group of `kind` can have."""
        return int(self.h.ci[g.MFREE]) - self.layouts[kind].size

    def sound(self, kind: str, addresses: Any, field: str = "a pointer", owners: Any = None) -> Any:
        """`addresses` as int64, if all of them are addresses of groups of `kind`; else Unsound.

        field: what they stand in, of the groups at the addresses `owners`.
        """
        addresses = addresses.astype(np.int64)
        good = (addresses >= 1) & (addresses <= self.last_address(kind))
        good &= (addresses - 1) % self.scheme.ratio == 0
        if kind in HEADS and good.all():
            good = np.isin(self.field(kind, "HEAD", addresses), HEADS[kind])
        if not good.all():
            source = field if owners is None else f"{field}@{owners[~good][0]}"
            raise Unsound(f"{source} points to {addresses[~good][0]}, which is no {kind}")
        return addresses
