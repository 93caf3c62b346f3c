"""The page in a browser: clicked on, typed into, and looked at."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import BROWSER, Browser
from kinds import every_kind

from udec_ia import Model
from udec_ia.heap.array import MainArray
from udec_ia.inspect.look import Atlas, who
from udec_ia.layout import offsets as g
from udec_ia.view import Page, page

pytestmark = pytest.mark.skipif(
    BROWSER is None, reason="there is no chromium (or Chrome): the page is not tried"
)

HOSTILE = "</script><script>pwned=1</script><img src=x onerror=pwned=2>"


class Told:
    """The states of the page: one model, before and after it ran, and a damaged copy; and the page."""

    def __init__(self, folder: Path) -> None:
        self.model = every_kind()
        self.model.out = folder
        self.model.cycle(5)
        self.before = {
            kind: self.model.table(kind) for kind in ("block", "corner", "contact", "domain", "zone")
        }
        pages = Page()
        pages.add(self.model.array, "before", self.model.deck_log)
        self.model.cycle(20)
        self.now = {kind: self.model.table(kind) for kind in self.before}
        pages.add(self.model.array, "after", self.model.deck_log)
        self.damaged = self.damage()
        pages.add(self.damaged, f"damaged{HOSTILE}", [HOSTILE])
        self.path = pages.write(folder / "page.html")

    def damage(self) -> MainArray:
        """A block that names no corner of its own, and one at no place."""
        array = self.model.array.copy()
        first, second = self.now["block"]["address"][1:3].tolist()
        array.h.ia[first - 1 + g.KP[1]] = int(self.now["domain"]["address"][0])
        array.h.ra[(second - 1) // 2 + g.KX[1] - 1] = np.nan
        return array


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> Told:
    return Told(tmp_path_factory.mktemp("view"))


@pytest.fixture(scope="module")
def running() -> Iterator[Browser]:
    browser = Browser()
    yield browser
    browser.close()


@pytest.fixture
def browser(running: Browser, told: Told) -> Iterator[Browser]:
    """A browser that shows the second state. Nothing may go wrong in it, and nothing be fetched."""
    running.size(1280, 800)
    running.scheme("light")
    running.open(told.path, "#state=2")
    yield running
    assert running.faults() == []
    assert running.requests() == [told.path.absolute().as_uri()] * len(running.requests())


def selected(browser: Browser) -> str:
    """The heading of what is selected."""
    return str(browser.js("document.querySelector('#chosen h2')?.textContent ?? ''"))


def hash_of(browser: Browser) -> dict[str, str]:
    return dict(browser.js("[...new URLSearchParams(location.hash.slice(1))]"))


def arrived(browser: Browser, address: int) -> None:
    """Wait until an address is selected."""
    at = "app.map.word || app.heap.first[app.map.chosen]"
    browser.wait(
        f"new URLSearchParams(location.hash.slice(1)).get('at') === '{address}' && ({at}) === {address}"
    )


def on_picture(browser: Browser, address: int) -> tuple[float, float]:
    """The pixel of the window where the picture has a group."""
    shape = f"app.shapes.at.get({address})"
    x, y = browser.js(f"app.picture.eye.pixel(...centre({shape}))")
    left, top = browser.js(
        "(b => [b.x, b.y])(document.querySelector('#picture canvas').getBoundingClientRect())"
    )
    return left + x, top + y


def on_map(browser: Browser, address: int) -> tuple[float, float]:
    """The pixel of the window where the heap map has a word."""
    ((x, y, width),) = browser.js(f"app.map.rows.pieces({address}, {address}).map(p => [p.x, p.y, p.width])")
    left, top = browser.js(
        "(b => [b.x, b.y])(document.querySelector('#heap canvas').getBoundingClientRect())"
    )
    return left + x + width / 2, top + y + 3 - browser.js("app.map.box.scrollTop")


def inked(browser: Browser, part: str) -> int:
    """Black pixels of a canvas, when it has been drawn: rings and outlines are of these."""
    drawn = browser.js(
        f"""new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {{
          const canvas = document.querySelector('{part} canvas');
          const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
          let n = 0;
          for (let k = 0; k < data.length; k += 4) {{
            n += data[k] + data[k + 1] + data[k + 2] < 99 && data[k + 3] > 200;
          }}
          done(n);
        }})))"""
    )
    return int(drawn)


def addresses(told: Told, kind: str) -> list[int]:
    return [int(address) for address in told.now[kind]["address"]]


# ---- selecting


def test_a_click_on_the_picture_lights_up_the_words(browser: Browser, told: Told) -> None:
    inner = [at for at in addresses(told, "domain") if at != told.model.h.ci[g.IODPNT]]
    block = int(told.now["block"]["address"][-1])
    corner = next(
        int(row["address"]) for row in told.now["corner"] if row["KYP"] == told.now["corner"]["KYP"].min()
    )
    contact = addresses(told, "contact")[0]
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


def test_a_click_on_a_domain(browser: Browser, told: Told) -> None:
    """The outer one: outside all blocks."""
    browser.click_on("#picture canvas", 8, 8)
    outer = int(told.model.h.ci[g.IODPNT])
    arrived(browser, outer)
    assert selected(browser) == f"domain@{outer}"


def test_a_second_click_takes_what_lies_below(browser: Browser, told: Told) -> None:
    zone = int(told.now["zone"]["address"][0])
    place = on_picture(browser, zone)
    browser.click(*place)
    browser.wait("app.map.chosen >= 0")
    assert selected(browser).startswith("block@")
    browser.click(*place)
    browser.wait("app.heap.kind(app.map.chosen) === 'zone'")
    assert selected(browser).startswith("zone@")


def test_a_click_on_a_word_lights_up_its_group(browser: Browser, told: Told) -> None:
    """And marks its field in the panel."""
    plain = inked(browser, "#picture")
    for kind, name in (("block", "KXD"), ("corner", "KYP"), ("contact", "KCFN"), ("domain", "KUMAX")):
        address = addresses(told, kind)[2]
        word = address + 2 * (getattr(g, name)[1] - 1) + 1  # the second one of a real
        browser.click(*on_map(browser, word))
        arrived(browser, word)
        assert selected(browser).startswith(f"{kind}@{address}")
        assert browser.js("document.querySelector('tr.word th').textContent").startswith(name)
        shown = browser.js("document.querySelector('tr.word .number').firstChild.data")
        assert float(shown) == told.now[kind][name][2]
        assert browser.js("app.picture.chosen.map((one) => one.address)") == [address]
        assert inked(browser, "#picture") != plain


def test_a_click_on_a_word_further_down(browser: Browser, told: Told) -> None:
    """The map comes to what is selected elsewhere, and what is clicked on is what is seen."""
    for _ in range(8):
        browser.click_on("#heap [data-zoom=in]")
    last = addresses(told, "zone")[-1]
    browser.js(f"location.hash = 'at={last}&state=2'")
    arrived(browser, last)
    assert browser.js("app.map.box.scrollTop") > 1000
    browser.click(*on_map(browser, last + 2))
    arrived(browser, last + 2)
    assert selected(browser).startswith(f"zone@{last} of block@")


def test_what_is_shown_of_a_group(browser: Browser, told: Told) -> None:
    """All fields of a contact against its table, and who points there against `udec who`."""
    row = told.now["contact"][3]
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
    expected = who(Atlas(told.model.array.h), int(row["address"])).rows
    assert [(name, group) for name, _, group in tables[1]] == [(field, group) for _, group, field in expected]


def test_following_pointers_and_going_back(browser: Browser, told: Told) -> None:
    block = int(told.now["block"]["address"][0])
    corner, after = int(told.now["block"]["KP"][0]), int(told.now["block"]["KB"][0])
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


def test_keys(browser: Browser, told: Told) -> None:
    """Arrows in both pictures; the focus is seen."""
    browser.js("document.querySelector('#heap canvas').focus()")
    browser.key("ArrowRight")
    arrived(browser, 1)
    second = [span.first for span in Atlas(told.model.array.h).spans()][1]
    browser.key("ArrowRight")
    arrived(browser, second)
    browser.key("ArrowDown")
    arrived(browser, second + browser.js("app.map.perRow"))
    browser.js("document.querySelector('#picture canvas').focus()")
    base = int(told.now["block"]["address"][-1])
    browser.js(f"location.hash = 'at={base}&state=2'")
    browser.wait(f"app.picture.chosen[0]?.address === {base}")
    browser.key("ArrowUp")
    browser.wait(f"app.picture.chosen[0].address !== {base}")
    above = browser.js("app.picture.chosen[0].box[1]")
    assert above == pytest.approx(0, abs=0.01)
    browser.key("Tab")
    assert browser.js("getComputedStyle(document.activeElement).outlineStyle") == "solid"


# ---- states


def test_the_selection_stays_from_state_to_state(browser: Browser, told: Told) -> None:
    block = next(row for row in told.now["block"] if row["KYD"] != 0)
    address = int(block["address"])
    was = told.before["block"][told.before["block"]["address"] == address]["KYD"][0]
    browser.js(f"location.hash = 'at={address}&state=2'")
    browser.wait("document.querySelector('tr.changed')")
    row = "[...document.querySelectorAll('#chosen tr')].find((r) => r.cells[0].textContent === 'KYD')"
    assert float(browser.js(f"{row}.querySelector('.number').firstChild.data")) == block["KYD"]
    assert float(browser.js(f"{row}.querySelector('.was').textContent").removeprefix("was ")) == was
    unchanged = "[...document.querySelectorAll('#chosen tr')].find((r) => r.cells[0].textContent === 'KB')"
    assert not browser.js(f"{unchanged}.classList.contains('changed')")
    places = browser.js("history.length")
    browser.click_on("#before")
    browser.wait("app.shown === 1")
    assert selected(browser) == f"block@{address}"
    assert not browser.js("document.querySelector('tr.changed')")
    assert float(browser.js(f"{row}.querySelector('.number').firstChild.data")) == was
    assert hash_of(browser) == {"at": str(address), "state": "1"}
    browser.js("document.activeElement.blur()")
    browser.key("]")
    browser.wait("app.shown === 2")
    browser.js("document.querySelector('#slider').focus()")
    browser.key("ArrowLeft")
    browser.wait("app.shown === 1")
    assert browser.js("document.querySelector('#state').textContent").startswith("1 of 3: cycle 5,")
    assert browser.js("history.length") == places  # the slider leaves no trail
    changed = browser.js(
        "(async () => { const [a, b] = [(await app.open(1)).heap, (await app.open(2)).heap];"
        "const all = Array.from({length: b.state.shown}, (_, k) => k + 1);"
        "return all.filter((k) => changed(b, a, k, k)).length })()"
    )
    assert changed > 100


def test_the_last_word_counts(browser: Browser, told: Told) -> None:
    """A state that takes its time does not come up when another one has been asked for since."""
    browser.open(told.path, "#state=1")
    browser.js("(app.turn(3), app.turn(1))")
    browser.js("app.open(3).then(() => new Promise((done) => setTimeout(done, 50)))")
    assert (browser.js("app.shown"), hash_of(browser)["state"]) == (1, "1")


def test_a_damaged_state(browser: Browser, told: Told) -> None:
    """What the checker says stands at the groups that it names, and the rest can be looked at."""
    first, second = told.now["block"]["address"][1:3].tolist()
    browser.open(told.path, f"#at={first}&state=3")
    browser.wait("document.querySelector('#chosen .fault')")
    faults = browser.js("[...document.querySelectorAll('#chosen .fault')].map((one) => one.textContent)")
    assert any("is no corner" in fault or "KP of block" in fault for fault in faults)
    assert browser.js("document.querySelector('#about summary').textContent").startswith("The checker finds ")
    assert browser.js("app.map.faults.size") > 1
    assert browser.js("app.picture.faults.length") > 1
    browser.click_on("#about summary")
    browser.click_on("#about .fault a")
    browser.wait(f"!location.hash.includes('at={first}&')")
    browser.js(f"location.hash = 'at={second}&state=3'")
    browser.wait(f"document.querySelector('#chosen h2').textContent === 'block@{second}'")
    row = "[...document.querySelectorAll('#chosen tr')].find((r) => r.cells[0].textContent.startsWith('KX'))"
    assert browser.js(f"{row}.querySelector('.number').firstChild.data") == "NaN"


# ---- the search


def ask(browser: Browser, query: str) -> None:
    browser.js("document.activeElement.blur()")
    browser.key("/")
    browser.js("document.querySelector('#query').value = ''")
    browser.write(query)
    browser.key("Enter")


def test_the_search(browser: Browser, told: Told) -> None:
    block = int(told.now["block"]["address"][2])
    ask(browser, "40")
    arrived(browser, 40)
    ask(browser, f"block@{block}")
    arrived(browser, block)
    ask(browser, "rubbish")
    assert "no address, group, kind or field is called rubbish" in browser.js(
        "document.querySelector('#message').textContent"
    )
    ask(browser, "KYD")
    assert browser.js("document.querySelector('#message').hidden")
    ask(browser, "DTOL")
    browser.wait("document.querySelector('tr.word')")
    assert browser.js("document.querySelector('tr.word .number').firstChild.data") == str(
        float(told.model.h.cr[g.DTOL])
    )


def test_a_list_is_put_in_order(browser: Browser, told: Told) -> None:
    ask(browser, "KYD")
    order = (
        "[...document.querySelectorAll('#found tbody tr')].map((r) =>"
        "[r.querySelector('a').dataset.address, r.cells[1].textContent].map(Number))"
    )
    rows = told.now["block"]
    by_address = sorted(zip(rows["address"].tolist(), rows["KYD"].tolist(), strict=True))
    assert [tuple(row) for row in browser.js(order)] == by_address
    browser.click_on("#found th:nth-child(2) button")
    assert [row[1] for row in browser.js(order)] == sorted(rows["KYD"].tolist())
    browser.click_on("#found th:nth-child(2) button")
    assert [row[1] for row in browser.js(order)] == sorted(rows["KYD"].tolist(), reverse=True)
    first = browser.js(order)[0][0]
    browser.click_on("#found tbody a")
    arrived(browser, first)
    assert browser.js("document.querySelector('#found table') !== null")  # the list stays
    browser.click_on("#found h2 button")
    assert browser.js("document.querySelector('#found table') === null")
    browser.click_on("#legend button")
    assert browser.js("document.querySelectorAll('#found tbody tr').length") == len(rows)


# ---- the address of the page


def test_the_selection_is_in_the_address(browser: Browser, told: Told) -> None:
    contact = addresses(told, "contact")[1]
    browser.open(told.path, f"#at={contact}&state=1")
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
def test_an_address_that_means_nothing(browser: Browser, told: Told, given: str) -> None:
    browser.open(told.path, given)
    browser.wait("/^(Click on|There is no)/.test(document.querySelector('#chosen').textContent)")
    assert browser.js("typeof pwned") == "undefined"
    assert browser.js("document.querySelector('#chosen img') === null")


# ---- what others wrote


def test_text_of_others_stays_text(browser: Browser, told: Told) -> None:
    browser.open(told.path, "#at=1&state=3")
    assert browser.js("document.querySelector('#name').textContent") == f"damaged{HOSTILE}"
    assert browser.js("document.querySelector('#about pre').textContent") == HOSTILE
    assert browser.js("document.images.length") == 0
    assert browser.js("typeof pwned") == "undefined"


def test_the_policy_holds(running: Browser, told: Told) -> None:
    """A script that got into the page would not run, nor would anything be fetched."""
    running.open(told.path)
    running.js(
        "document.body.append(Object.assign(document.createElement('script'), {textContent: 'pwned = 4'}))"
    )
    assert running.js("typeof pwned") == "undefined"
    assert running.js("fetch('data:,x').then(() => 'fetched', () => 'refused')") == "refused"


# ---- looks


def test_it_fits_its_window(browser: Browser, told: Told) -> None:
    block = addresses(told, "block")[0]
    for width, height in ((1280, 800), (1920, 1080), (900, 700), (390, 800)):
        browser.size(width, height)
        browser.open(told.path, f"#at={block}&state=2")
        assert browser.js("document.scrollingElement.scrollWidth") <= width
        if width > 900:
            assert browser.js("document.scrollingElement.scrollHeight") <= height
        for part in ("#picture canvas", "#heap canvas", "#panel"):
            box = browser.js(
                f"(b => [b.width, b.height])(document.querySelector('{part}').getBoundingClientRect())"
            )
            assert min(box) > 200, (part, width)


def test_light_and_dark(browser: Browser, told: Told) -> None:
    colours: dict[str, Any] = {}
    for scheme in ("light", "dark"):
        browser.scheme(scheme)
        browser.open(told.path)
        colours[scheme] = browser.js("[getComputedStyle(document.body).color, colours(app.table).paper]")
    assert colours["light"] == ["rgb(28, 27, 25)", "#ffffff"]
    assert colours["dark"][1] == "#17181a"


def test_what_is_left_out_is_said(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, told: Told
) -> None:
    monkeypatch.setattr(page, "LIMIT", 1000)
    pages = Page()
    pages.add(told.model.array, "cut")
    cut = pages.write(tmp_path / "cut.html")
    browser.open(cut, "#at=1200")
    assert "left out" in browser.js("document.querySelector('#about .fault').textContent")
    assert browser.js("document.querySelector('#chosen').textContent") == "1200 is left out of this page"
    browser.open(told.path)


def test_all_word_schemes_and_none_in_common(browser: Browser, tmp_path: Path, told: Told) -> None:
    """One block in each; from one to the next nothing is compared."""
    pages = Page()
    for build in ("i16r32", "i32r32", "i16r64", "i32r64", "i64r64"):
        m = Model(build)
        m.block(0, 0, 0, 1, 1.5, 1, 1.5, 0)
        pages.add(m.array, build)
    schemes = pages.write(tmp_path / "schemes.html")
    for k in range(5):
        browser.open(schemes, f"#at=1&state={k + 1}")
        browser.wait("document.querySelector('#chosen tr')")
        row = "[...document.querySelectorAll('#chosen tr')].find((r) => r.cells[0].textContent === 'KX')"
        assert browser.js(f"{row}.querySelector('.number').firstChild.data") == "0.75"
        assert browser.js("document.querySelectorAll('tr.changed').length") == 0
        assert ("not compared" in browser.js("document.querySelector('#state').textContent")) == (k > 0)
    browser.open(told.path)


def test_blocks_are_drawn_where_they_are(browser: Browser, told: Told) -> None:
    """Inside a block, away from its outline, its points and its name, there is nothing but its colour."""
    browser.open(told.path, "#state=2")
    inked(browser, "#picture")  # it has been drawn by now
    rng = np.random.default_rng(2)
    rows = {int(row["address"]): row for row in told.now["block"]}
    soft = {1: "block", 2: "sdef"}
    blocks = {at: soft[row["HEAD"]] for at, row in rows.items() if row["HEAD"] in soft}
    assert {*blocks.values()} == {"block", "sdef"}
    for address, kind in blocks.items():
        x1, y1, x2, y2 = browser.js(f"app.shapes.at.get({address}).box")
        share = rng.uniform(0.2, 0.8, (60, 2))
        share = share[np.abs(share - 0.5).max(axis=1) > 0.25]
        places = [(x1 + s * (x2 - x1), y1 + t * (y2 - y1)) for s, t in share.tolist()]
        found = browser.js(
            f"""{json.dumps(places)}.map(([x, y]) => {{
              const [px, py] = app.picture.eye.pixel(x, y).map(Math.round);
              const pen = document.querySelector('#picture canvas').getContext('2d');
              const [r, g, b] = pen.getImageData(px, py, 1, 1).data;
              return '#' + [r, g, b].map((part) => part.toString(16).padStart(2, '0')).join('');
            }})"""
        )
        colour = browser.js(f"(c => mixed(c.{kind}, c.paper, 0.28))(colours(app.table))")
        assert {*found} == {colour}, address


def test_whatever_the_words_say_the_page_shows_it(browser: Browser, told: Told, tmp_path: Path) -> None:
    """Random words: every state is drawn, every group can be looked at, and nothing goes wrong."""
    rng, pages = np.random.default_rng(4), Page()
    used = int(told.model.h.ci[g.MFREE]) - 1
    for k in range(6):
        array = told.model.array.copy()
        for _ in range(20 * (k + 1)):
            array.h.ia[int(rng.integers(used))] = rng.choice(
                [0, -1, int(rng.integers(used)), int(rng.integers(-(2**31), 2**31))]
            )
        pages.add(array, f"damaged {k}")
    browser.open(pages.write(tmp_path / "damaged.html"), "#at=1&state=1")
    for k in range(6):
        browser.js(f"app.turn({k + 1})")
        browser.wait(f"app.shown === {k + 1}")
        looked = browser.js(
            """(() => {
              let all = 0;
              for (const kind of Object.keys(app.table.kinds)) {
                for (const at of app.heap.groups[kind].slice(0, 4)) {
                  app.mark(at); app.panel.choose(at); app.picture.drawNow(); app.map.drawNow(); all += 1;
                }
              }
              return all;
            })()"""
        )
        assert looked > 5
    assert browser.faults() == []
    browser.open(told.path)


def test_zooming(browser: Browser, told: Told) -> None:
    """Wheel, mouse, buttons and keys; what lay under the mouse stays there."""
    block = addresses(told, "block")[3]
    x, y = on_picture(browser, block)
    scale = browser.js("app.picture.eye.scale")
    browser.ask("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-100)
    browser.wait(f"app.picture.eye.scale > 1.2 * {scale}")
    assert on_picture(browser, block) == pytest.approx((x, y), abs=0.5)
    browser.drag(x, y, x + 40, y - 30)
    assert on_picture(browser, block) == pytest.approx((x + 40, y - 30), abs=1)
    assert selected(browser) == ""  # that was no click
    browser.click_on("#picture [data-zoom=fit]")
    assert browser.js("app.picture.eye.scale") == scale
    words = browser.js("app.map.perRow")
    browser.click_on("#heap [data-zoom=in]")
    fewer = browser.js("app.map.perRow")
    assert fewer < words
    browser.js("document.querySelector('#heap canvas').focus()")
    for _ in range(10):
        browser.key("+")
    assert browser.js("app.map.perRow") == 6  # fields with their values are drawn
    browser.js("app.map.drawNow()")
    browser.key("0")
    assert browser.js("app.map.perRow") == words
