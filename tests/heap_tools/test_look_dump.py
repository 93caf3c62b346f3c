"""udec dump: every word, under the name of its field and group, against tables and plain walks."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from naive.names import names as naive_names
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.heap.accessors import iget
from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.heap_tools.heap_dump import common, dump
from udec_ia.heap_tools.heap_lookup import what
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table
from udec_ia.output.word_dump import dump as plain_dump
from udec_ia.output.word_dump import raw
from udec_ia.reader import word_map as names
from udec_ia.reader.word_map import KINDS, Atlas

Row = dict[str, Any]


@pytest.fixture(scope="module", params=ALL_SCHEMES)
def scene(request: pytest.FixtureRequest) -> Model:
    """Groups of every kind, and some junk."""
    return every_kind(request.param)


def rows(listing: Any) -> list[Row]:
    return [dict(zip(listing.columns, row, strict=True)) for row in listing.rows]


def in_heap(listing: Any) -> list[Row]:
    return [row for row in rows(listing) if row["group"] != "common block"]


def words_of(found: list[Row], radix: int = 10) -> dict[int, int]:
    """Address -> word, as they are read back."""
    words: dict[int, int] = {}
    for row in found:
        given = [int(word, radix) for word in row["words"].split()]
        if row["meaning"].startswith("the same to "):
            given *= int(row["meaning"].split()[-1]) - row["address"] + 1
        for k, word in enumerate(given):
            assert row["address"] + k not in words
            words[row["address"] + k] = word
    return words


def check_words(m: Model, words: dict[int, int], first: int, last: int, radix: int) -> None:
    """All words from `first` to `last` are there but those that no field has, which are 0."""
    bits = m.array.h.ia.itemsize * 8
    for address in range(first, last + 1):
        word = int(m.array.h.ia[address - 1])
        assert words.pop(address, 0) == (word if radix == 10 else word % 2**bits), address
    assert not words


@pytest.mark.parametrize("radix", [8, 10, 16])
def test_every_word_is_there_once(scene: Model, radix: int) -> None:
    found = in_heap(dump(Atlas(scene.array.h), radix=radix))
    check_words(scene, words_of(found, radix), 1, len(scene.array.h.ia), radix)


def test_every_window_has_its_words(scene: Model) -> None:
    atlas, rng = Atlas(scene.array.h), np.random.default_rng(3)
    used = int(scene.h.ci[g.MFREE]) - 1
    for _ in range(40):
        first = int(rng.integers(1, used))
        last = int(rng.integers(first, min(first + 60, used) + 1))
        found = in_heap(dump(atlas, first, last))
        assert all(max(words_of([row])) >= first and row["address"] <= last for row in found)
        words = {iad: word for iad, word in words_of(found).items() if first <= iad <= last}
        check_words(scene, words, first, last, 10)


def test_every_field_under_its_group(scene: Model) -> None:
    """Names, values, units and what pointers lead to, as tables and walks have them."""
    called = naive_names(scene)
    fields: dict[str, dict[str, Row]] = {}
    for row in in_heap(dump(Atlas(scene.array.h))):
        fields.setdefault(row["group"], {})[row["field"]] = row
    for group in GROUPS:
        for table_row in scene.table(group.name):
            shown = fields.pop(called[int(table_row["address"])])
            for field in group.fields:
                for k, value in enumerate(np.atleast_1d(table_row[field.name]).tolist()):
                    row = shown.pop(field.name + (f"({k + 1})" if field.count > 1 else ""))
                    assert (row["value"], row["unit"]) == (value, field.unit.strip("-"))
                    if field.target:
                        assert row["meaning"] == (called[value] if value else "nothing")
                    elif field.real:
                        assert row["meaning"] == field.text
            assert shown == {}
    assert all(name.startswith(("junk@", "unused ")) for name in fields)


def test_junk_has_its_place(scene: Model) -> None:
    """Along the chains, by hand."""
    h, shown = scene.array.h, {}
    for row in in_heap(dump(Atlas(h))):
        shown.setdefault(row["group"], row)
    chain = int(h.ci[g.JUNK])
    assert chain
    while chain:
        groups, iad = [], chain
        while iad:
            groups.append(iad)
            iad = iget(h, iad, JNEXT)
        for k, iad in enumerate(groups, 1):
            name = f"junk@{iad}, number {k} of {len(groups)} of {iget(h, iad, JSIZE)} words"
            assert (shown[name]["address"], shown[name]["field"]) == (iad, "JNEXT")
        chain = iget(h, chain, JSIZES)


def test_the_common_block(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    found = rows(common(atlas))
    assert found == [row for row in rows(dump(atlas)) if row["group"] == "common block"]
    views = {"int": scene.array.h.ci, "real": scene.array.h.cr, "double": scene.array.h.cd}
    for field in read_table().common:
        elements: dict[int, Any] = {}
        for row in found:
            name, _, place = row["field"].partition("(")
            if name == field.name:
                first = int(place.rstrip(")") or 1)
                last = re.search(rf"; the same to {name}\((\d+)\)$", row["meaning"])
                elements |= dict.fromkeys(range(first, int(last[1] if last else first) + 1), row["value"])
        first = getattr(g, field.name)
        wanted = views[field.type][first : first + field.count].tolist()
        assert [elements[k] for k in range(1, field.count + 1)] == wanted
    heads = {row["field"]: row["meaning"] for row in found}
    assert heads["IBPNT"] == f"block@{scene.h.ci[g.IBPNT]}"


def test_what_is_wrong_is_said() -> None:
    m = every_kind()
    h, layout = m.array.h, Atlas(m.array.h)
    contact, corner, block = (int(m.table(kind)["address"][-1]) for kind in ("contact", "corner", "block"))

    def put(iad: int, field: str, value: int) -> int:
        kind = next(kind for kind in KINDS if iad in layout.groups[kind])
        (word,) = (word for word in layout.shapes[kind] if word.name == field)
        h.ia[iad + word.first - 1] = value
        return iad + word.first

    printed = {
        put(contact, "KB1", corner): f"corner@{corner} of no block, no block",
        put(contact, "KL1", 99999): "outside IA(), no corner or contact",
        put(contact, "KCP1", 0): "nothing, no corner",
        put(contact, "KCM", 51): "not allowed, 1 to 50: material number",
        put(corner, "KNB", block + 2): f"word 3 of block@{block}, no block",
    }
    shown = {row["address"]: row for row in in_heap(dump(Atlas(h)))}
    for address, meaning in printed.items():
        assert shown[address]["meaning"] == meaning
    assert shown[contact]["group"].startswith(f"contact@{contact} of no block and block@")


def test_codes_have_their_names() -> None:
    m = every_kind()
    blocks = m.table("block")["address"]
    layout = Atlas(m.array.h)
    (word,) = (word for word in layout.shapes["block"] if word.name == "KBFIX")
    for block, value in zip(blocks, (0, 1, 2, 6, 3), strict=False):
        m.array.h.ia[block + word.first - 1] = value
    text = next(field.text for field in read_table().group("block").fields if field.name == "KBFIX")
    told = [row[5] for block in blocks[:5] for row in what(layout, int(block)).rows if row[2] == "KBFIX"]
    given = ["GIVEN_X: its x velocity is given", "GIVEN_Y: its y velocity is given"]
    wrong = f"not allowed, 0 to 2 or 4 or 6 or 8 or 10 or 12 or 14: {text}"
    assert told == [text, "FIXED: fixed", given[0], ", ".join(given), wrong]


def test_words_that_nothing_leads_to_and_groups_in_each_other() -> None:
    m = every_kind()
    h = m.array.h
    head = int(h.ci[g.IHPNT])  # a history; the list of them begins in the middle of a zone now
    zone = int(m.table("zone")["address"][0])
    h.ci[g.IHPNT] = h.ci[g.ISMPNT] = 0
    found = in_heap(dump(Atlas(h)))
    lost = {row["group"] for row in found if row["group"].startswith("not linked")}
    assert any(one.split()[2] <= str(head) <= one.split()[4] for one in lost)
    check_words(m, words_of(found), 1, len(h.ia), 10)
    h.ia[zone - 1 + 4] = 7
    h.ci[g.IHPNT] = zone + 4
    found = in_heap(dump(Atlas(h)))
    assert any("cut short by history@" in row["group"] for row in found)
    check_words(m, words_of(found), 1, len(h.ia), 10)


def test_the_plain_dump_is_that_of_the_deck(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    assert raw(atlas, 7, 300).as_text() == plain_dump(scene.array.h, 7, 300) == scene.dump(7, 300)
    assert raw(atlas).as_text() == scene.dump(1, len(scene.array.h.ia))


def test_names_are_those_that_walks_give(scene: Model) -> None:
    called = naive_names(scene)
    atlas = Atlas(scene.array.h)
    assert names.names(atlas, np.array([*called])) == [*called.values()]


def test_what_cannot_be_dumped(scene: Model) -> None:
    atlas = Atlas(scene.array.h)
    for first, last in ((0, 5), (5, 3), (1, len(scene.array.h.ia) + 1)):
        with pytest.raises(IndexError, match="IA\\(\\) has the addresses 1 to"):
            dump(atlas, first, last)
    with pytest.raises(ValueError, match="choose one of 8, 10, 16"):
        dump(atlas, radix=2)
