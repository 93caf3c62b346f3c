"""The hand-made block system agrees with the walks: what the other tests build on is sound."""

from __future__ import annotations

import pytest
from support.handmade_map import two_blocks

from udec_ia.heap.accessors import Memory, iget
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.reader.list_walks import boundary, corners, groups, kind_of, loop, reverse

SCHEMES = tuple(ALL_SCHEMES)


def clockback(h: Memory, block: int, item: int) -> int:
    if kind_of(h, item) == "corner":
        return iget(h, item, g.KLB)
    return iget(h, item, g.KLB1 if iget(h, item, g.KB1) == block else g.KLB2)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_handmade_lists(scheme: str) -> None:
    h = two_blocks(scheme).h
    counts = [len(list(groups(h, kind))) for kind in ("block", "contact", "domain")]
    assert counts == [2, 2, 2] == [h.ci[g.NBLK], h.ci[g.NCON], h.ci[g.NDOM]]
    for block in groups(h, "block"):
        ring = list(boundary(h, block))
        kinds = "".join("c" if kind_of(h, item) == "contact" else "p" for item in ring)
        assert kinds in ("pcpcpp", "pppcpc")
        assert [clockback(h, block, item) for item in ring] == [ring[-1], *ring[:-1]]
        clockwise = corners(h, block)
        assert list(reverse(h, block)) == [clockwise[0], *clockwise[:0:-1]]
        assert all(iget(h, corner, g.KNB) == block for corner in clockwise)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_handmade_domains(scheme: str) -> None:
    """The inner loop passes one corner of each block, the outer loop the other three of each."""
    h = two_blocks(scheme).h
    inner, outer = groups(h, "domain")
    assert outer == h.ci[g.IODPNT]
    for domain, passed in ((inner, 2), (outer, 6)):
        items = [item for item, _ in loop(h, domain)]
        assert set(groups(h, "contact")) <= set(items)
        assert len(items) == 2 + passed


def test_handmade_sets_every_1980_pointer() -> None:
    """A pointer that is never 0 by the table is not 0."""
    h = two_blocks().h
    for group in read_table().groups[:4]:
        if group.name == "corner":
            addresses = [corner for block in groups(h, "block") for corner in corners(h, block)]
        else:
            addresses = list(groups(h, group.name))
        for field in group.fields:
            if field.target and field.allowed[0][0] == 1:
                assert all(iget(h, iad, getattr(g, field.name)) for iad in addresses), field.name
