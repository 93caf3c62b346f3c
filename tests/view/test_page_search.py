"""The page in a browser: what is searched for is found, and a list is put in order."""

from __future__ import annotations

from support.headless_browser import Browser
from support.view_page import ViewCase, arrived, needs_browser

from udec_ia.layout import offsets as g

pytestmark = needs_browser


def ask(browser: Browser, query: str) -> None:
    browser.js("document.activeElement.blur()")
    browser.key("/")
    browser.js("document.querySelector('#query').value = ''")
    browser.write(query)
    browser.key("Enter")


def test_the_search(browser: Browser, viewed: ViewCase) -> None:
    block = int(viewed.now["block"]["address"][2])
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
        float(viewed.model.h.cr[g.DTOL])
    )


def test_a_list_is_put_in_order(browser: Browser, viewed: ViewCase) -> None:
    ask(browser, "KYD")
    order = (
        "[...document.querySelectorAll('#found tbody tr')].map((r) =>"
        "[r.querySelector('a').dataset.address, r.cells[1].textContent].map(Number))"
    )
    rows = viewed.now["block"]
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
