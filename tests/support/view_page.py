"""The page of some states of one model in a browser, and where things are in it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from support.every_group_kind import every_kind
from support.headless_browser import BROWSER, Browser
from udec_ia.heap.main_array import MainArray
from udec_ia.layout import offsets as g
from udec_ia.view import Page

needs_browser = pytest.mark.skipif(BROWSER is None, reason="needs Chromium or Chrome")
HOSTILE = "</script><script>pwned=1</script><img src=x onerror=pwned=2>"


class ViewCase:
    """The states of the page: one model, before and after it ran, and a damaged copy; and the page."""

    def __init__(self, folder: Path) -> None:
        self.model = every_kind()
        self.model.out = folder
        self.model.cycle(5)
        self.before = {
            kind: self.model.table(kind) for kind in ("block", "corner", "contact", "domain", "zone")
        }
        pages = Page()
        pages.add(self.model.array, "before", self.model.session.log.lines)
        self.model.cycle(20)
        self.now = {kind: self.model.table(kind) for kind in self.before}
        pages.add(self.model.array, "after", self.model.session.log.lines)
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


def addresses(told: ViewCase, kind: str) -> list[int]:
    return [int(address) for address in told.now[kind]["address"]]


def selected(browser: Browser) -> str:
    """The heading of what is selected."""
    return str(browser.js("document.querySelector('#chosen h2')?.textContent ?? ''"))


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
