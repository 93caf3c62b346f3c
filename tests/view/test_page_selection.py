"""The page in a browser: clicks, keys and pointers select, in both pictures, the panel and the address."""

from __future__ import annotations

import pytest
from support.headless_browser import Browser
from support.view_page import ViewCase, addresses, arrived, inked, needs_browser, on_map, on_picture, selected

from udec_ia.heap_tools.heap_lookup import who
from udec_ia.layout import offsets as g
from udec_ia.reader.word_map import Atlas

pytestmark = needs_browser


def test_a_click_on_the_picture_lights_up_the_words(browser: Browser, viewed: ViewCase) -> None:
    inner = [at for at in addresses(viewed, "domain") if at != viewed.model.h.ci[g.IODPNT]]
    block = int(viewed.now["block"]["address"][-1])
    corner = next(
        int(row["address"]) for row in viewed.now["corner"] if row["KYP"] == viewed.now["corner"]["KYP"].min()
    )
    contact = addresses(viewed, "contact")[0]
    plain = inked(browser, "#heap")
    assert inner
    for kind, address in (("block", block), ("corner", corner), ("contact", contact)):
        browser.click(*on_picture(browser, address))
        arrived(browser, address)
        assert selected(browser).startswith(f"{kind}@{address}")
        assert inked(browser, "#heap") > plain + 50
        border = browser.js(
            """(() => {
              const [{ x, y, width }] = app.map.pieces(app.map.chosen);
              const pen = document.querySelector('#heap canvas').getContext('2d');
              return [...pen.getImageData(x + width / 2, y - app.map.box.scrollTop, 1, 1).data];
            })()"""
        )
        assert max(border[:3]) < 100  # darker than any cell: it is ringed itself
        browser.js("history.back()")
        browser.wait("!location.hash.includes('at=')")


def test_a_click_on_a_domain(browser: Browser, viewed: ViewCase) -> None:
    """The outer one: outside all blocks."""
    browser.click_on("#picture canvas", 8, 8)
    outer = int(viewed.model.h.ci[g.IODPNT])
    arrived(browser, outer)
    assert selected(browser) == f"domain@{outer}"


def test_a_second_click_takes_what_lies_below(browser: Browser, viewed: ViewCase) -> None:
    zone = int(viewed.now["zone"]["address"][0])
    place = on_picture(browser, zone)
    browser.click(*place)
    browser.wait("app.map.chosen >= 0")
    assert selected(browser).startswith("block@")
    browser.click(*place)
    browser.wait("app.heap.kind(app.map.chosen) === 'zone'")
    assert selected(browser).startswith("zone@")


def test_a_click_on_a_word_lights_up_its_group(browser: Browser, viewed: ViewCase) -> None:
    """And marks its field in the panel."""
    plain = inked(browser, "#picture")
    for kind, name in (("block", "KXD"), ("corner", "KYP"), ("contact", "KCFN"), ("domain", "KUMAX")):
        address = addresses(viewed, kind)[2]
        word = address + 2 * (getattr(g, name)[1] - 1) + 1  # the second one of a real
        browser.click(*on_map(browser, word))
        arrived(browser, word)
        assert selected(browser).startswith(f"{kind}@{address}")
        assert browser.js("document.querySelector('tr.word th').textContent").startswith(name)
        shown = browser.js("document.querySelector('tr.word .number').firstChild.data")
        assert float(shown) == viewed.now[kind][name][2]
        assert browser.js("app.picture.chosen.map((one) => one.address)") == [address]
        assert inked(browser, "#picture") != plain


def test_a_click_on_a_word_further_down(browser: Browser, viewed: ViewCase) -> None:
    """The map comes to what is selected elsewhere, and what is clicked on is what is seen."""
    for _ in range(8):
        browser.click_on("#heap [data-zoom=in]")
    last = addresses(viewed, "zone")[-1]
    browser.js(f"location.hash = 'at={last}&state=2'")
    arrived(browser, last)
    assert browser.js("app.map.box.scrollTop") > 1000
    browser.click(*on_map(browser, last + 2))
    arrived(browser, last + 2)
    assert selected(browser).startswith(f"zone@{last} of block@")


def test_what_is_shown_of_a_group(browser: Browser, viewed: ViewCase) -> None:
    """All fields of a contact against its table, and who points there against `udec who`."""
    row = viewed.now["contact"][3]
    browser.js(f"location.hash = 'at={row['address']}&state=2'")
    browser.wait(f"document.querySelector('#chosen h2')?.textContent.startsWith('contact@{row['address']}')")
    tables = browser.js(
        "[...document.querySelectorAll('#chosen table')].map((t) => [...t.rows].map((r) => "
        "['th', '.number', 'a'].map((part) => r.querySelector(part)?.firstChild.data)))"
    )
    fields = {name.rstrip(" ●"): (value, to) for name, value, to in tables[0]}
    for name in row.dtype.names[1:]:
        assert float(fields[name][0]) == row[name]
    assert fields["KB1"][1] == f"block@{row['KB1']}"
    assert fields["KL1"][1].startswith(("corner@", "contact@"))
    expected = who(Atlas(viewed.model.array.h), int(row["address"])).rows
    assert [(name, group) for name, _, group in tables[1]] == [(field, group) for _, group, field in expected]


def test_following_pointers_and_going_back(browser: Browser, viewed: ViewCase) -> None:
    block = int(viewed.now["block"]["address"][0])
    corner, after = int(viewed.now["block"]["KP"][0]), int(viewed.now["block"]["KB"][0])
    browser.click(*on_map(browser, block))
    arrived(browser, block)
    browser.click_on(f"#chosen a[data-address='{corner}']")
    arrived(browser, corner)
    assert selected(browser) == f"corner@{corner} of block@{block}"
    assert browser.js("document.querySelector('#forward').disabled")
    browser.click_on("#back")
    arrived(browser, block)
    assert not browser.js("document.querySelector('#forward').disabled")
    browser.click_on("#forward")
    arrived(browser, corner)
    browser.back()
    arrived(browser, block)
    browser.js(f"document.querySelector('#chosen a[data-address=\"{after}\"]').focus()")
    assert browser.js(
        "app.map.pointed === app.heap.spanOf(" + str(after) + ")"
    )  # ringed while it has the focus
    browser.key("Enter")
    arrived(browser, after)
    assert browser.js("document.querySelector('#forward').disabled")


def test_keys(browser: Browser, viewed: ViewCase) -> None:
    """Arrows in both pictures; the focus is seen."""
    browser.js("document.querySelector('#heap canvas').focus()")
    browser.key("ArrowRight")
    arrived(browser, 1)
    second = [span.first for span in Atlas(viewed.model.array.h).spans()][1]
    browser.key("ArrowRight")
    arrived(browser, second)
    browser.key("ArrowDown")
    arrived(browser, second + browser.js("app.map.perRow"))
    browser.js("document.querySelector('#picture canvas').focus()")
    base = int(viewed.now["block"]["address"][-1])
    browser.js(f"location.hash = 'at={base}&state=2'")
    browser.wait(f"app.picture.chosen[0]?.address === {base}")
    browser.key("ArrowUp")
    browser.wait(f"app.picture.chosen[0].address !== {base}")
    above = browser.js("app.picture.chosen[0].box[1]")
    assert above == pytest.approx(0, abs=0.01)
    browser.key("Tab")
    assert browser.js("getComputedStyle(document.activeElement).outlineStyle") == "solid"


def test_the_selection_is_in_the_address(browser: Browser, viewed: ViewCase) -> None:
    contact = addresses(viewed, "contact")[1]
    browser.open(viewed.path, f"#at={contact}&state=1")
    browser.wait(f"document.querySelector('#chosen h2')?.textContent.startsWith('contact@{contact}')")
    assert browser.js("app.shown") == 1


@pytest.mark.parametrize(
    "given",
    [
        "#at=-5",
        "#at=1e300",
        "#at=NaN&state=99",
        "#at=99999999&state=0",
        "#at=<img src=x onerror=pwned=3>",
        "#%",
    ],
)
def test_an_address_that_means_nothing(browser: Browser, viewed: ViewCase, given: str) -> None:
    browser.open(viewed.path, given)
    browser.wait("/^(Click on|There is no)/.test(document.querySelector('#chosen').textContent)")
    assert browser.js("typeof pwned") == "undefined"
    assert browser.js("document.querySelector('#chosen img') === null")
