"""The page in a browser: from state to state, also of other words, damaged, or left out in part."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.headless_browser import Browser
from support.view_page import HOSTILE, ViewCase, arrived, needs_browser, selected

from udec_ia import Model
from udec_ia.layout import offsets as g
from udec_ia.view import Page, view_page

pytestmark = needs_browser


def hash_of(browser: Browser) -> dict[str, str]:
    return dict(browser.js("[...new URLSearchParams(location.hash.slice(1))]"))


def test_the_selection_stays_from_state_to_state(browser: Browser, viewed: ViewCase) -> None:
    block = next(row for row in viewed.now["block"] if row["KYD"] != 0)
    address = int(block["address"])
    was = viewed.before["block"][viewed.before["block"]["address"] == address]["KYD"][0]
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


def test_the_last_word_counts(browser: Browser, viewed: ViewCase) -> None:
    """A state that takes its time does not come up when another one has been asked for since."""
    browser.open(viewed.path, "#state=1")
    browser.js("(app.turn(3), app.turn(1))")
    browser.js("app.open(3).then(() => new Promise((done) => setTimeout(done, 50)))")
    assert (browser.js("app.shown"), hash_of(browser)["state"]) == (1, "1")


def test_a_damaged_state(browser: Browser, viewed: ViewCase) -> None:
    """What the checker says stands at the groups that it names, and the rest can be looked at."""
    first, second = viewed.now["block"]["address"][1:3].tolist()
    browser.open(viewed.path, f"#at={first}&state=3")
    browser.wait("document.querySelector('#chosen .fault')")
    faults = browser.js("[...document.querySelectorAll('#chosen .fault')].map((one) => one.textContent)")
    assert any("is no corner" in fault or "KP of block" in fault for fault in faults)
    assert browser.js("document.querySelector('#about summary').textContent").startswith("The checker finds ")
    assert browser.js("app.map.faults.size") > 1
    assert browser.js("app.picture.faults.length") > 1
    browser.js("location.hash = 'at=1&state=3'")
    arrived(browser, 1)
    browser.click_on("#about summary")
    browser.click_on("#about .fault a")
    browser.wait("!location.hash.includes('at=1&')")
    browser.js(f"location.hash = 'at={second}&state=3'")
    browser.wait(f"document.querySelector('#chosen h2').textContent === 'block@{second}'")
    row = "[...document.querySelectorAll('#chosen tr')].find((r) => r.cells[0].textContent.startsWith('KX'))"
    assert browser.js(f"{row}.querySelector('.number').firstChild.data") == "NaN"


def test_whatever_the_words_say_the_page_shows_it(browser: Browser, viewed: ViewCase, tmp_path: Path) -> None:
    """Random words: every state is drawn, every group can be looked at, and nothing goes wrong."""
    rng, pages = np.random.default_rng(4), Page()
    used = int(viewed.model.h.ci[g.MFREE]) - 1
    for k in range(6):
        array = viewed.model.array.copy()
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
    browser.open(viewed.path)


def test_what_is_left_out_is_said(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, viewed: ViewCase
) -> None:
    monkeypatch.setattr(view_page, "LIMIT", 1000)
    pages = Page()
    pages.add(viewed.model.array, "cut")
    cut = pages.write(tmp_path / "cut.html")
    browser.open(cut, "#at=1200")
    assert "left out" in browser.js("document.querySelector('#about .fault').textContent")
    assert browser.js("document.querySelector('#chosen').textContent") == "1200 is left out of this page"
    browser.open(viewed.path)


def test_all_word_schemes_and_none_in_common(browser: Browser, tmp_path: Path, viewed: ViewCase) -> None:
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
    browser.open(viewed.path)


# ---- what others wrote


def test_text_of_others_stays_text(browser: Browser, viewed: ViewCase) -> None:
    browser.open(viewed.path, "#at=1&state=3")
    assert browser.js("document.querySelector('#name').textContent") == f"damaged{HOSTILE}"
    assert browser.js("document.querySelector('#about pre').textContent") == HOSTILE
    assert browser.js("document.images.length") == 0
    assert browser.js("typeof pwned") == "undefined"


def test_the_policy_holds(running: Browser, viewed: ViewCase) -> None:
    """A script that got into the page would not run, nor would anything be fetched."""
    running.open(viewed.path)
    running.js(
        "document.body.append(Object.assign(document.createElement('script'), {textContent: 'pwned = 4'}))"
    )
    assert running.js("typeof pwned") == "undefined"
    assert running.js("fetch('data:,x').then(() => 'fetched', () => 'refused')") == "refused"
