"""Conditions, paths, forces of contacts and colours of the page, against Python and in a browser."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.headless_browser import BROWSER, Browser
from support.view_page import ViewCase, addresses, arrived, inked, on_picture
from test_page_search import ask
from test_scripts import NODE, kinds, rubble, run

from udec_ia import Model
from udec_ia.heap_tools.heap_search import find
from udec_ia.output.drawn_outlines import contact_forces
from udec_ia.reader.place_grammar import find_number
from udec_ia.reader.word_map import Atlas

__all__ = ["rubble"]  # a fixture
in_node = pytest.mark.skipif(not NODE, reason="there is no node (Node.js): the page's scripts are not run")
in_browser = pytest.mark.skipif(BROWSER is None, reason="needs Chromium or Chrome")

CONDITIONS = [
    "block where KX > 2 and not KMAT == 2",
    "contacts where KB1.KX > KB2.KX or KCFN - 2 * abs(KCFS) >= 1e3",
    "corner where KNB.KMAT == 1 and KL.KXP > 1",
    "corners where not KL.KXP > 1",
    "grid-points where KXG + -KYG < .5 <= KXG",
    "zone where KZG(1).KXG + KZG(2).KXG <= 2 * KZG(3).KXG and address > 10",
    "contact where KCCOD == CORNER_EDGE or (KCCOD != VIRTUAL and KYC < 2)",
    "block where KBEX.KS111 != 0 or KBEX == 0 and HEAD == MRIG",
    "domain where KPP / KUMAX != KPP / KUMAX or KDLOOP.KB1.KP.KYP > +0",
    "block where 0 < KX <= 3 != 7",
]


@in_node
@pytest.mark.parametrize("build", ["i32r64", "i64r64", "i16r32"])
def test_conditions_are_those_of_find(build: str) -> None:
    m = kinds(build)
    code = """
    return also.map((query) => {
      const { list, note } = find(heaps[0], query);
      const text = (value) => value === undefined ? "" : String(value);
      return note ?? [list.words.map((one) => one.name), rows(heaps[0], list, 0, false)
        .map(({ address, values }) => [address, ...values.map(text)])];
    });
    """
    for text, found in zip(CONDITIONS, run(code, [m.array], CONDITIONS), strict=True):
        expected = find(Atlas(m.array.h), text)
        columns, rows = found
        assert sorted(columns) == sorted(expected.columns[2:]), text
        assert [row[0] for row in rows] == [row[0] for row in expected.rows], text
        order = [expected.columns.index(name) for name in columns]
        for row, wanted in zip(rows, expected.rows, strict=True):
            assert [number(text) for text in row[1:]] == [number(wanted[k]) for k in order], text


def number(text: Any) -> Any:
    """A number, or "" for none."""
    return text if text == "" else float(text)


@in_node
def test_what_is_wrong_with_a_condition() -> None:
    wrong = {
        "blok where KX > 1": "blok is not a kind of group",
        "block where KX": "this is a number",
        "block where KX > 1)": "this cannot be understood, at: )",
        "block where (KX > 1": "a bracket is not closed, at: (KX > 1",
        "block where KXDD > 1": "a block has no field KXDD, at: KXDD > 1",
        "block where KX.KY > 1": "KX is not a pointer",
        "block where KX > (KY > 1)": "this is true or false",
        "block where KX = 1": "this cannot be understood, at: = 1",
        "block where KX >": "here is a field or a number missing, at the end",
        "block where KB. > 1": "after the point give a field",
        "block where abs KX > 1": "abs needs a bracket",
        "block where " + "(" * 99 + "1" + ")" * 99 + " > 0": "nested too deep",
        "block where constructor > 1": "no field constructor",
        "block where address.KXD > 1": "no field address",
    }
    array = kinds().array
    notes = run("return also.map((query) => find(heaps[0], query).note)", [array], [*wrong])
    for note, (query, text) in zip(notes, wrong.items(), strict=True):
        assert text in note
        if "nested" not in text:  # Python reads deeper
            with pytest.raises(ValueError, match="\\^"):
                find(Atlas(array.h), query)


@in_node
def test_paths_lead_where_python_says() -> None:
    m = kinds()
    atlas = Atlas(m.array.h)
    block, zone = int(atlas.groups["block"][0]), int(atlas.groups["zone"][0])
    queries = [
        f"block@{block}.KP.KXP",
        f"blocks@{block}.kb",
        f"zone@{zone}.KZG(2).KXG",
        f"block@{block}.KP.KL.KXP",
    ]
    found = run(
        "return also.map((query) => find(heaps[0], query))", [m.array], [*queries, f"block@{block}.KX.KY"]
    )
    for query, one in zip(queries, found[:-1], strict=True):
        place = find_number(atlas, query)
        assert one == {"go": place.at * (2 if place.part == "ra" else 1) + 1, "note": ""}
    assert found[-1]["note"].startswith("KX is not a pointer")


@in_node
def test_forces_of_contacts(rubble: Model) -> None:
    """They are those that PLOT draws; contacts of all codes."""
    found = run(
        "return new Shapes(heaps[0]).of('contact').map((one) => [one.address, one.force ?? null])",
        [rubble.array],
    )
    expected = contact_forces(rubble.h)
    by_address = dict(
        zip(expected.address.tolist(), zip(expected.force, expected.virtual, strict=True), strict=True)
    )
    codes = {int(row["address"]): int(row["KCCOD"]) for row in rubble.table("contact")}
    assert {*codes.values()} >= {1, 2, 3}
    scale = np.abs(expected.force).max()
    assert scale > 0
    for address, force in found:
        wanted, virtual = by_address[address]
        assert (force is None) == virtual
        if force is not None:
            assert np.allclose(force, wanted, rtol=1e-12, atol=1e-12 * scale)


@in_node
def test_scales_of_fields() -> None:
    """The least and the greatest value of the tables have the ends of the scale, others what is between."""
    m = kinds()
    code = """
    const heap = heaps[0];
    const shapes = new Shapes(heap);
    return also.map(([kind, name]) => {
      const scale = new Scale(heap, kind, name);
      const drawn = ["block", "zone", "domain"].filter((one) => scale.isFor(one));
      const areas = drawn.flatMap((one) => shapes.of(one));
      const of = (one) => [one.address, scale.value(one), scale.colour(one) ?? ""];
      return [scale.low, scale.high, areas.map(of)];
    });
    """
    fields = [("block", "KX"), ("block", "KMAT"), ("zone", "KZS11"), ("domain", "KPP"), ("sdef", "KS111")]
    for (kind, name), (low, high, areas) in zip(fields, run(code, [m.array], fields), strict=True):
        rows = m.table(kind)
        assert (low, high) == (rows[name].min(), rows[name].max())
        owner = m.table("block") if kind == "sdef" else rows
        values = dict(zip(rows["address"].tolist(), rows[name].tolist(), strict=True))
        key = owner["KBEX"] if kind == "sdef" else owner["address"]
        wanted = {int(at): values.get(int(k)) for at, k in zip(owner["address"], key, strict=True)}
        assert {address: value for address, value, _ in areas} == wanted
        shades = {value: colour for _, value, colour in areas if value is not None}
        assert all(colour == "" for _, value, colour in areas if value is None)
        assert shades[low] == "#30408f"
        assert high == low or shades[high] == "#a5122a"
    assert run("return colourings(heaps[0].table).map(({ kind }) => kind)", [m.array]) == [
        *("block", "sdef", "fdef", "zone", "domain")
    ]


@in_browser
def test_blocks_are_coloured_and_forces_drawn(browser: Browser, viewed: ViewCase) -> None:
    rows = viewed.now["block"]
    low = int(rows["address"][rows["KX"].argmin()])
    x, y = on_picture(browser, low)
    at = f"""(([x, y]) => {{ const box = document.querySelector('#picture canvas').getBoundingClientRect();
      return [...document.querySelector('#picture canvas').getContext('2d')
        .getImageData(x - box.x, y - box.y + 14, 1, 1).data] }})([{x}, {y}])"""
    before = browser.js(at)
    browser.js(
        "(s => { s.value = 'block.KX'; s.dispatchEvent(new Event('change')) })"
        "(document.querySelector('#colour'))"
    )
    inked(browser, "#picture")
    assert browser.js(at) == [0x30, 0x40, 0x8F, 255] != before
    assert browser.js("document.querySelector('#range .high').textContent").endswith(" m")
    plain = browser.js("document.querySelector('#picture canvas').toDataURL()")
    browser.click_on("#forces")
    inked(browser, "#picture")
    assert browser.js("document.querySelector('#picture canvas').toDataURL()") != plain


@in_browser
def test_states_are_played(browser: Browser, viewed: ViewCase) -> None:
    browser.open(viewed.path, "#state=1")
    browser.click_on("#play")
    browser.wait("app.shown === 3 && !app.playing")
    browser.js("document.activeElement.blur()")
    browser.key("p")
    browser.wait("app.shown === 1")
    browser.key("p")
    assert not browser.js("app.playing")


@in_browser
def test_the_picture_comes_to_the_selection(browser: Browser, viewed: ViewCase) -> None:
    block = addresses(viewed, "block")[1]
    browser.js(f"location.hash = 'at={block}&state=2'")
    arrived(browser, block)
    scale = browser.js("app.picture.eye.scale")
    browser.click_on("#picture [data-zoom=chosen]")
    assert browser.js("app.picture.eye.scale") > scale
    x, y = browser.js(f"app.picture.eye.pixel(...centre(app.shapes.at.get({block})))")
    width, height = browser.js("[app.picture.eye.width, app.picture.eye.height]")
    assert (x, y) == pytest.approx((width / 2, height / 2))
    corners = browser.js(
        f"app.shapes.at.get({block}).corners.map((one) => app.picture.eye.pixel(one.px, one.py))"
    )
    assert all(0 < x < width and 0 < y < height for x, y in corners)


@in_browser
def test_what_a_condition_finds_is_listed_and_ringed(browser: Browser, viewed: ViewCase) -> None:
    rows = viewed.now["block"]
    middle = float(np.median(rows["KX"]))
    ask(browser, f"blocks where KX > {middle!r}")
    found = browser.js("app.picture.found.map((one) => one.address)")
    assert sorted(found) == sorted(rows["address"][rows["KX"] > middle].tolist())
    assert browser.js("document.querySelectorAll('#found tbody tr').length") == len(found)
    browser.click_on("#before")
    browser.wait("app.shown === 1")
    assert browser.js("app.picture.found.length") == len(found)
    browser.click_on("#found h2 button")
    assert browser.js("app.picture.found.length") == 0
    ask(browser, "block where KX >")
    assert "missing" in browser.js("document.querySelector('#message').textContent")
