"""The answers of the restart-file tools: against plain walks, in sound heaps and in damaged ones."""

from __future__ import annotations

import re

import numpy as np
import pytest
from naive.census import census as naive_census
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.heap.accessors import iget, puti
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.heap_tools.heap_lookup import walk, what, who
from udec_ia.heap_tools.memory_use import junk
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import layouts
from udec_ia.reader.list_walks import boundary, groups, loop, members
from udec_ia.reader.word_map import JUNK, UNUSED, Atlas

BUILDS = ["i16r32", "i32r64", "i64r64"]


@pytest.fixture(params=BUILDS)
def scene(request: pytest.FixtureRequest) -> Model:
    """Groups of every kind, and some junk."""
    return every_kind(request.param)


def junk_groups(m: Model) -> dict[int, int]:
    """Size of each junk group by address, along the chains."""
    h, found = m.array.h, {}
    chain = int(h.ci[g.JUNK])
    while chain:
        iad = chain
        while iad:
            found[iad] = iget(h, iad, JSIZE)
            iad = iget(h, iad, JNEXT)
        chain = iget(h, chain, JSIZES)
    return found


def test_every_word_is_in_one_span(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    sizes = layouts(scene.array.scheme.ratio)
    expected = {iad: (kind, sizes[kind].size) for kind, at in naive_census(scene.array).items() for iad in at}
    expected |= {iad: (JUNK, size) for iad, size in junk_groups(scene).items()}
    assert any(kind == JUNK for kind, _ in expected.values())
    at = 1
    for span in atlas.spans():
        assert span.first == at
        at = span.last + 1
        if span.kind == UNUSED:
            assert span.first == scene.h.ci[g.MFREE]
        else:
            assert expected.pop(span.first) == (span.kind, span.last - span.first + 1)
    assert expected == {}
    assert at == len(scene.array.h.ia) + 1


def test_every_field_of_every_group(scene: Model) -> None:
    """By each of its words, with the value that the tables give."""
    atlas = Atlas(scene.array.h)
    for group in GROUPS:
        for row in scene.table(group.name):
            span = atlas.span(int(row["address"]))
            for field in group.fields:
                for element, value in enumerate(np.atleast_1d(row[field.name]).tolist()):
                    word = atlas.word(span, field, element)
                    assert atlas.value(word) == value
                    for address in (word.first, word.last):
                        assert atlas.word_at(address) == (span, word)


def test_owners(scene: Model) -> None:
    h, atlas = scene.array.h, Atlas(scene.array.h)
    for block in groups(h, "block"):
        assert atlas.owners(atlas.span(block)) == [block]
        for kind in ("zone", "gridpoint"):
            assert all(atlas.owners(atlas.span(iad)) == [block] for iad in members(h, block, kind))
    corners = scene.table("corner")
    assert [atlas.owners(atlas.span(int(iad))) for iad in corners["address"]] == [[b] for b in corners["KNB"]]
    assert not any(atlas.owners(atlas.span(int(iad))) for iad in scene.table("domain")["address"])


def test_who_points_to_a_group(scene: Model) -> None:
    """Every pointer of every group, brute force."""
    h, atlas = scene.array.h, Atlas(scene.array.h)
    pointers: dict[int, set[tuple[int, str]]] = {}
    for group in GROUPS:
        for row in scene.table(group.name):
            span = atlas.span(int(row["address"]))
            for word in atlas.words(span):
                if word.field.target and (value := int(atlas.value(word))):
                    pointers.setdefault(value, set()).add((word.first, word.name))
    lists = g.IBPNT, g.ICPNT, g.IDPNT, g.IODPNT, g.IBNPNT, g.ISGPNT, g.IHPNT, g.IRXPNT, g.IFWPNT, g.ISMPNT
    lists = *lists, g.IOUPNT, g.ICKPNT, g.IMBPNT, g.IBRPNT, g.IFRPNT, g.IBTPNT, g.INDPNT, g.IELPNT
    heads = {int(h.ci[index]) for index in lists}
    for address in [iad for at in atlas.groups.values() for iad in at.tolist()]:
        rows = who(atlas, address).rows
        assert {(row[0], row[2]) for row in rows if row[1] != "common block"} == pointers.get(address, set())
        assert any(row[1] == "common block" for row in rows) == (address in heads)


def test_walks(scene: Model) -> None:
    h, atlas = scene.array.h, Atlas(scene.array.h)

    def addresses(along: str, start: int | None = None) -> list[int]:
        return [row[1] for row in walk(atlas, along, start).rows]

    for kind in ("block", "contact", "domain", "history"):
        assert addresses(kind) == [*groups(h, kind)]
    for block in groups(h, "block"):
        assert addresses("block", block) == [*boundary(h, block)]
        points = [*members(h, block, "gridpoint")]
        if points:
            assert addresses("KG", points[0]) == points
    for domain in groups(h, "domain"):
        assert addresses("domain", domain) == [item for item, _ in loop(h, domain)]
    with pytest.raises(ValueError, match="no list KXD from 1: there are block, contact"):
        walk(atlas, "KXD", 1)
    with pytest.raises(ValueError, match="is corner@"):
        walk(atlas, "block", int(scene.table("corner")["address"][0]))


def test_a_field_beside_each_group(scene: Model) -> None:
    atlas, block = Atlas(scene.array.h), int(scene.table("block")["address"][0])
    places = {int(row["address"]): float(row["KXP"]) for row in scene.table("corner")}
    around = walk(atlas, "block", block, field="KXP")
    assert around.columns[-1] == "KXP"
    assert [row[3] for row in around.rows] == [places.get(iad, "") for iad in boundary(scene.array.h, block)]
    short = walk(atlas, "block", block, "KXP", limit=2)
    assert short.rows == around.rows[:2]
    assert short.head == [f"{around.head[0]}; the first 2:"]
    assert walk(atlas, "block", block, limit=1000).head == around.head
    zone = scene.table("zone")[0]
    (first, *_) = walk(atlas, "KZ", int(zone["address"]), "KZG(2)").rows
    assert first[3] == zone["KZG"][1]
    for field, says in (
        ("KZG", "did you mean KZG(1) or KZG(2) or KZG(3)"),
        ("KXPP", "did you mean KXP"),
        ("qqq", "no group has"),
    ):
        with pytest.raises(ValueError, match=re.escape(says)):
            walk(atlas, "block", field=field)
    with pytest.raises(ValueError, match="1 or more"):
        walk(atlas, "block", limit=0)


def test_a_walk_ends_where_it_has_been() -> None:
    """A main list, the list around a block and the one around a domain that run into themselves."""
    m = every_kind()
    h, blocks = m.array.h, m.table("block")["address"]
    puti(h, int(blocks[4]), g.KB, int(blocks[2]))
    (printed,) = (listing := walk(Atlas(h), "block")).head
    assert "5 groups, and then it breaks" in printed
    assert f"the list link of block@{blocks[4]} leads back to block@{blocks[2]}" in printed
    assert len(listing.rows) == 5
    m = every_kind()
    h, block = m.array.h, int(m.table("block")["address"][1])
    items = list(boundary(h, block))
    corner = next(iad for iad in items[3:] if iad in m.table("corner")["address"])
    puti(h, corner, g.KL, items[1])
    (printed,) = walk(Atlas(h), "block", block).head
    assert f"{items.index(corner) + 1} groups, and then it breaks" in printed


def test_what_says_what_the_value_means() -> None:
    m = every_kind()
    atlas, contact = Atlas(m.array.h), m.table("contact")[0]
    words = {word.name: word.first for word in atlas.words(atlas.span(int(contact["address"])))}
    printed = {name: what(atlas, first).head[1] for name, first in words.items()}
    block = contact["KB1"]
    assert printed["KB1"] == f"KB1, first block involved: {block}, block@{block}"
    assert printed["KCM"] == "KCM, material number: 1"
    assert printed["HEAD"] == "HEAD, MCON: 5, MCON: contact"
    assert printed["KCCOD"].endswith(": 3, EDGE_CORNER: an edge of block KB1 and an arc of block KB2")


def test_junk_counts_all_words(scene: Model) -> None:
    listing = junk(Atlas(scene.array.h))
    used = int(scene.h.ci[g.MFREE]) - 1
    assert sum(row[3] for row in listing.rows) == used
    assert sum(row[4] for row in listing.rows) == pytest.approx(100, abs=0.5)
    given = sum(junk_groups(scene).values())
    printed = "\n".join(listing.head)
    assert f"high water: {used} of {len(scene.array.h.ia)} words" in printed
    assert f"junk: {given} words" in printed
    assert f"in use: {used - given} words" in printed


def test_fragmentation() -> None:
    """Runs of junk: two groups side by side, one alone."""
    h = Model().array.h
    one, *_ = [find(h, g.NVCR) for _ in range(6)]
    size = layouts(2)["corner"].size
    for k in (0, 1, 3):
        lose(h, one + k * size, g.NVCR)
    printed = junk(Atlas(h)).head
    assert printed[2] == f"junk: {3 * size} words, 50.0% of those, in 1 size"
    assert printed[3] == f"the junk lies in 2 runs, the longest of {2 * size} words"
    assert printed[4].startswith(f"not linked: {3 * size} words, 50.0% of those")
    assert junk(Atlas(Model().array.h)).head[-1] == "junk: none"


def test_where_it_lies(scene: Model) -> None:
    """Centroid and corners of the blocks, from the tables."""
    atlas = Atlas(scene.array.h)
    blocks = {int(row["address"]): row for row in scene.table("block")}
    corners = scene.table("corner")
    contact = scene.table("contact")[2]
    printed = what(atlas, int(contact["address"])).head[2:]
    assert len(printed) == 2
    for block, line in zip((int(contact["KB1"]), int(contact["KB2"])), printed, strict=True):
        own = corners[corners["KNB"] == block]
        x, y = (float(blocks[block][name]) for name in ("KX", "KY"))
        assert line.startswith(f"block@{block}: centroid ({x:.6g}, {y:.6g}) m, {len(own)} corners in ")
        assert line.endswith(
            f"x {own['KXP'].min():.6g} to {own['KXP'].max():.6g} m, y {own['KYP'].min():.6g} to "
            f"{own['KYP'].max():.6g} m"
        )
    for kind, many in (("domain", 2), ("zone", 1), ("signal", 0)):
        assert len(what(atlas, int(scene.table(kind)["address"][0])).head) == 2 + many


def test_a_wrong_pointer_is_told(scene: Model) -> None:
    contact = scene.table("contact")[0]
    word = int(contact["address"]) + g.KB1[0]
    corner = int(scene.table("corner")["address"][3])
    scene.array.h.ia[word - 1] = corner
    (row,) = (row for row in what(Atlas(scene.array.h), word).rows if row[2] == "KB1")
    assert row[5].startswith(f"corner@{corner} of block@")
    assert row[5].endswith(", no block")
