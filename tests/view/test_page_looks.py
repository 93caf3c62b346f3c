"""The page in a browser: it fits its window, and blocks are drawn where they are."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from support.headless_browser import Browser
from support.view_page import ViewCase, addresses, inked, needs_browser, on_picture, selected

pytestmark = needs_browser


def test_it_fits_its_window(browser: Browser, viewed: ViewCase) -> None:
    block = addresses(viewed, "block")[0]
    for width, height in ((1280, 800), (1920, 1080), (900, 700), (390, 800)):
        browser.size(width, height)
        browser.open(viewed.path, f"#at={block}&state=2")
        assert browser.js("document.scrollingElement.scrollWidth") <= width
        if width > 900:
            assert browser.js("document.scrollingElement.scrollHeight") <= height
        for part in ("#picture canvas", "#heap canvas", "#panel"):
            box = browser.js(
                f"(b => [b.width, b.height])(document.querySelector('{part}').getBoundingClientRect())"
            )
            assert min(box) > 200, (part, width)


def test_light_and_dark(browser: Browser, viewed: ViewCase) -> None:
    colours: dict[str, Any] = {}
    for scheme in ("light", "dark"):
        browser.scheme(scheme)
        browser.open(viewed.path)
        colours[scheme] = browser.js("[getComputedStyle(document.body).color, colours(app.table).paper]")
    assert colours["light"] == ["rgb(28, 27, 25)", "#ffffff"]
    assert colours["dark"][1] == "#17181a"


def test_blocks_are_drawn_where_they_are(browser: Browser, viewed: ViewCase) -> None:
    """Inside a block, away from its outline, its points and its name, there is nothing but its colour."""
    browser.open(viewed.path, "#state=2")
    inked(browser, "#picture")  # it has been drawn by now
    rng = np.random.default_rng(2)
    rows = {int(row["address"]): row for row in viewed.now["block"]}
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


def test_zooming(browser: Browser, viewed: ViewCase) -> None:
    """Wheel, mouse, buttons and keys; what lay under the mouse stays there."""
    block = addresses(viewed, "block")[3]
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
