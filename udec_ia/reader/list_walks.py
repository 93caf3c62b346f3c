"""Following the lists of the heap from Python: main lists, lists around blocks, and loops around domains.

`follow` is the walk that all share. Every address is tested before it is used and no item is passed twice, so
that a damaged heap ends in Unsound and never in a hang. `chain` is for commands, whose heap is sound.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, size_of
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

TABLE = read_table()
LISTS: dict[str, tuple[int, Offset]] = {  # kinds with a main list: its head, and the link to the next
    group.name: (getattr(g, group.list_head), getattr(g, one.name))
    for group in TABLE.groups
    for one in group.fields
    if group.list_head and one.role == "next"
}
HEADS: dict[str, tuple[int, ...]] = {  # kinds with a head code, and what it may be
    kind: tuple(head.value for head in TABLE.heads if head.group == kind)
    for kind in dict.fromkeys(head.group for head in TABLE.heads)
}
SIZES: dict[str, Offset] = {group.name: getattr(g, group.size_name) for group in TABLE.groups}
MEMBERS = {"gridpoint": ("KFG", "KG"), "zone": ("KFZ", "KZ")}  # lists of an fdef group: head and link
Item = TypeVar("Item", int, tuple[int, int])


class Unsound(UdecError):
    """Error 20: the heap contradicts itself; the message names both ends of the broken relation."""

    def __init__(self, relation: str) -> None:
        super().__init__(20, relation)


def follow(
    first: Item, step: Callable[[Item], Item], link: Callable[[Item], str], closed: bool = False
) -> Iterator[Item]:
    """`first`, step(first), ... until 0 or, along a `closed` list, until it comes back to `first`.

    link: names the link of an item, as "KL of corner@93". Raises Unsound where an item comes again.
    """
    seen: set[Item] = set()
    item = before = first
    while item and not (closed and seen and item == first):
        if item in seen:
            *_, name = link(item).split()
            raise Unsound(f"{link(before)} leads back to {name}, where the list did not begin")
        seen.add(item)
        yield item
        before, item = item, step(item)


def chain(h: Memory, first: int, link: Offset) -> Iterator[int]:
    """Groups of a sound list from `first` on along `link`; the group at hand may be given back meanwhile."""
    while first:
        following = iget(h, first, link)
        yield first
        first = following


def can_stand(h: Memory, iad: int, kind: str) -> bool:
    """True if a group of `kind` can stand at `iad`: in the words in use, and with a head code of the kind."""
    free = min(int(h.ci[g.MFREE]), len(h.ia) + 1)
    if not 1 <= iad <= free - size_of(h, SIZES[kind]) or (iad - 1) % (h.ra.itemsize // h.ia.itemsize):
        return False
    return kind not in HEADS or iget(h, iad, HEAD) in HEADS[kind]


def kind_of(h: Memory, iad: int) -> str | None:
    """Kind of the group at `iad` by its head code; None if no kind has that code."""
    return next((kind for kind in HEADS if can_stand(h, iad, kind)), None)


def expect(h: Memory, iad: int, kinds: tuple[str, ...], source: str) -> int:
    """`iad` if a group of one of `kinds` can stand there, else Unsound naming `source`."""
    if not any(can_stand(h, iad, kind) for kind in kinds):
        raise Unsound(f"{source} points to {iad}, which is no {' or '.join(kinds)}")
    return iad


def extension(h: Memory, block: int) -> int:
    """The extension of deformable block `block`."""
    kind = "sdef" if iget(h, block, HEAD) == g.MSDEF else "fdef"
    return expect(h, iget(h, block, g.KBEX), (kind,), f"KBEX of block@{block}")


def _listed(h: Memory, kind: str, first: int, link: Offset, source: str) -> Iterator[int]:
    """Groups of `kind` from `first` on, which `source` points to."""

    def in_words(iad: int) -> str:
        return f"the list link of {kind}@{iad}"

    def step(iad: int) -> int:
        following = iget(h, iad, link)
        return following and expect(h, following, (kind,), in_words(iad))

    yield from follow(first and expect(h, first, (kind,), source), step, in_words)


def groups(h: Memory, kind: str) -> Iterator[int]:
    """Addresses of all blocks, contacts, domains or histories, in list order."""
    head, link = LISTS[kind]
    yield from _listed(h, kind, int(h.ci[head]), link, f"the head of the {kind} list")


def members(h: Memory, block: int, kind: str) -> Iterator[int]:
    """Addresses of the zones or grid-points of `block`, in list order; none if it has no zones."""
    if iget(h, block, HEAD) == g.MFDEF:
        owner, (head, link) = extension(h, block), MEMBERS[kind]
        source = f"{head} of fdef@{owner}"
        yield from _listed(h, kind, iget(h, owner, getattr(g, head)), getattr(g, link), source)


def clockwise_link(h: Memory, block: int, iad: int) -> tuple[str, int]:
    """The clockwise link of the item at `iad` of `block`: name of the field, and where it leads."""
    if kind_of(h, iad) == "corner":
        return f"KL of corner@{iad}", iget(h, iad, g.KL)
    one, two = iget(h, iad, g.KB1), iget(h, iad, g.KB2)
    if block not in (one, two):
        raise Unsound(f"contact@{iad} is in the list of block@{block}, but its KB1 is {one} and KB2 is {two}")
    name = "KL1" if block == one else "KL2"
    return f"{name} of contact@{iad}", iget(h, iad, getattr(g, name))


def next_item(h: Memory, block: int, iad: int) -> int:
    """The item after `iad` in the clockwise list of `block` (NEXTCP)."""
    source, following = clockwise_link(h, block, iad)
    return expect(h, following, ("corner", "contact"), source)


def boundary(h: Memory, block: int) -> Iterator[int]:
    """Corners and contacts of `block`, clockwise, from the corner KP on."""
    first = expect(h, iget(h, block, g.KP), ("corner",), f"KP of block@{block}")

    def link(iad: int) -> str:
        return clockwise_link(h, block, iad)[0]

    yield from follow(first, lambda iad: next_item(h, block, iad), link, closed=True)


def corners(h: Memory, block: int) -> list[int]:
    """Corners of `block`, clockwise, from the corner KP on."""
    return [iad for iad in boundary(h, block) if kind_of(h, iad) == "corner"]


def reverse(h: Memory, block: int) -> Iterator[int]:
    """Corners of `block` along the reverse list, anticlockwise, from the corner KP on."""
    first = expect(h, iget(h, block, g.KP), ("corner",), f"KP of block@{block}")

    def link(iad: int) -> str:
        return f"KR of corner@{iad}"

    def step(iad: int) -> int:
        return expect(h, iget(h, iad, g.KR), ("corner",), link(iad))

    yield from follow(first, step, link, closed=True)


def loop(h: Memory, domain: int) -> Iterator[tuple[int, int]]:
    """(item, block) around `domain`, anticlockwise: each contact with the block that is walked after it.

    A contact that has the domain on both its sides (a bridge of the map) is passed twice.
    """
    contact = iget(h, domain, g.KDLOOP)
    if contact == 0:
        block = int(h.ci[g.IBPNT])
        if block:
            yield from ((iad, block) for iad in boundary(h, block))
        return
    expect(h, contact, ("contact",), f"KDLOOP of domain@{domain}")
    start = iget(h, contact, g.KB2) if iget(h, contact, g.KD1) == domain else iget(h, contact, g.KB1)

    def step(here: tuple[int, int]) -> tuple[int, int]:
        item, block = here
        following = next_item(h, block, item)
        if kind_of(h, following) == "contact":
            clockwise_link(h, block, following)  # raises Unsound unless the contact names the block
            one, two = iget(h, following, g.KB1), iget(h, following, g.KB2)
            block = two if block == one else one
        return following, block

    def link(here: tuple[int, int]) -> str:
        return clockwise_link(h, here[1], here[0])[0]

    yield from follow((contact, start), step, link, closed=True)


def point(h: Memory, iad: int, kx: Offset, ky: Offset) -> tuple[Any, Any]:
    """The two reals (kx, ky) of the group at `iad`, as floats."""
    return float(getr(h, iad, kx)), float(getr(h, iad, ky))
