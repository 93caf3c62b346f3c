"""Following the lists of the heap from Python: main lists, lists around blocks, and loops around domains.

Every walk is bounded and every address is tested before it is used, so that a damaged heap ends in Unsound
and never in a hang.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, size_of
from udec_ia.layout import offsets as g
from udec_ia.layout.table import read_table

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
SIZES: dict[str, Offset] = {kind: getattr(g, TABLE.group(kind).size_name) for kind in HEADS}


class Unsound(UdecError):
    """Error 20: the heap contradicts itself; the message names both ends of the broken relation."""

    def __init__(self, relation: str) -> None:
        super().__init__(20, relation)


def kind_of(h: Memory, iad: int) -> str | None:
    """Kind of the group at `iad` by its head code; None if the code is none of the known ones."""
    end = min(int(h.ci[g.MFREE]) - 1, len(h.ia))
    if not 1 <= iad <= end:
        return None
    code = iget(h, iad, HEAD)
    kind = next((kind for kind, codes in HEADS.items() if code in codes), None)
    return kind if kind is not None and iad + size_of(h, SIZES[kind]) - 1 <= end else None


def expect(h: Memory, iad: int, kinds: tuple[str, ...], source: str) -> int:
    """`iad` if it is the address of a group of one of `kinds`, else Unsound naming `source`."""
    if (iad - 1) % (h.ra.itemsize // h.ia.itemsize) or kind_of(h, iad) not in kinds:
        raise Unsound(f"{source} points to {iad}, which is no {' or '.join(kinds)}")
    return iad


def inside(h: Memory, iad: int, size: Offset, source: str) -> int:
    """`iad` if a group of this size, which has no head code, can stand there, else Unsound for `source`."""
    within = 1 <= iad <= int(h.ci[g.MFREE]) - size_of(h, size)
    if not within or (iad - 1) % (h.ra.itemsize // h.ia.itemsize):
        raise Unsound(f"{source} points to {iad}, where no such group can be")
    return iad


def extension(h: Memory, block: int) -> int:
    """The extension of deformable block `block`."""
    size = g.NVSD if iget(h, block, HEAD) == g.MSDEF else g.NVFD
    return inside(h, iget(h, block, g.KBEX), size, f"KBEX of block@{block}")


def _bounded(h: Memory, what: str, first: int, step: Callable[[int], int], stop: int) -> Iterator[int]:
    """first, step(first), ... until `stop`; Unsound if more items than the heap has words."""
    iad = first
    for _ in range(int(h.ci[g.MFREE])):
        yield iad
        iad = step(iad)
        if iad == stop:
            return
    raise Unsound(f"{what} does not come to an end")


def groups(h: Memory, kind: str) -> Iterator[int]:
    """Addresses of all blocks, contacts, domains or histories, in list order."""
    index, offset = LISTS[kind]
    first = int(h.ci[index])
    if first == 0:
        return
    expect(h, first, (kind,), f"the head of the {kind} list")

    def step(iad: int) -> int:
        following = iget(h, iad, offset)
        return following and expect(h, following, (kind,), f"the list link of {kind}@{iad}")

    yield from _bounded(h, f"the {kind} list", first, step, 0)


def members(h: Memory, block: int, kind: str) -> Iterator[int]:
    """Addresses of the zones or grid-points of `block`, in list order; none if it has no zones."""
    if iget(h, block, HEAD) != g.MFDEF:
        return
    head, link, size = {"gridpoint": (g.KFG, g.KG, g.NVGP), "zone": (g.KFZ, g.KZ, g.NVZO)}[kind]
    first = iget(h, extension(h, block), head)
    if first == 0:
        return
    inside(h, first, size, f"the head of the {kind} list of block@{block}")

    def step(iad: int) -> int:
        following = iget(h, iad, link)
        return following and inside(h, following, size, f"the list link of {kind}@{iad}")

    yield from _bounded(h, f"the {kind} list of block@{block}", first, step, 0)


def next_item(h: Memory, block: int, iad: int) -> int:
    """The item after `iad` in the clockwise list of `block` (NEXTCP)."""
    if kind_of(h, iad) == "corner":
        following = iget(h, iad, g.KL)
    elif iget(h, iad, g.KB1) == block:
        following = iget(h, iad, g.KL1)
    elif iget(h, iad, g.KB2) == block:
        following = iget(h, iad, g.KL2)
    else:
        raise Unsound(f"contact@{iad} stands in the list of block@{block} but names it neither KB1 nor KB2")
    return expect(h, following, ("corner", "contact"), f"the clockwise link of item@{iad} of block@{block}")


def boundary(h: Memory, block: int) -> Iterator[int]:
    """Corners and contacts of `block`, clockwise, from the corner KP on."""
    first = expect(h, iget(h, block, g.KP), ("corner",), f"KP of block@{block}")
    yield from _bounded(
        h, f"the clockwise list of block@{block}", first, lambda iad: next_item(h, block, iad), first
    )


def corners(h: Memory, block: int) -> list[int]:
    """Corners of `block`, clockwise, from the corner KP on."""
    return [iad for iad in boundary(h, block) if kind_of(h, iad) == "corner"]


def reverse(h: Memory, block: int) -> Iterator[int]:
    """Corners of `block` along the reverse list, anticlockwise, from the corner KP on."""
    first = expect(h, iget(h, block, g.KP), ("corner",), f"KP of block@{block}")

    def step(iad: int) -> int:
        return expect(h, iget(h, iad, g.KR), ("corner",), f"KR of corner@{iad}")

    yield from _bounded(h, f"the reverse list of block@{block}", first, step, first)


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
    block = iget(h, contact, g.KB2) if iget(h, contact, g.KD1) == domain else iget(h, contact, g.KB1)
    start = (contact, block)
    here = start
    for _ in range(2 * int(h.ci[g.MFREE])):
        yield here
        item, block = here
        following = next_item(h, block, item)
        if kind_of(h, following) == "contact":
            block = other_block(h, following, block)
        here = (following, block)
        if here == start:
            return
    raise Unsound(f"the loop around domain@{domain} does not close")


def other_block(h: Memory, contact: int, block: int) -> int:
    """The block on the other side of `contact`, seen from `block`."""
    one, two = iget(h, contact, g.KB1), iget(h, contact, g.KB2)
    if block not in (one, two):
        raise Unsound(
            f"contact@{contact} stands in the list of block@{block} but names it neither KB1 nor KB2"
        )
    return two if block == one else one


def point(h: Memory, iad: int, kx: Offset, ky: Offset) -> tuple[Any, Any]:
    """The two reals (kx, ky) of the group at `iad`, as floats."""
    return float(getr(h, iad, kx)), float(getr(h, iad, ky))
