"""The page, one HTML file with states, field table, style and scripts.

Nothing in it is taken from elsewhere, and its policy forbids the browser to. Only the style and the script
that stand in it may work, which it knows by their checksums: what a file or a deck says is shown as text, and
were it to find a way into the page, it would still not run.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from udec_ia.file_replacement import put_in_place
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import MFREE
from udec_ia.printable_text import printable
from udec_ia.view.view_data import state, tables

WEB = Path(__file__).with_name("web")
SCRIPTS = (  # each builds on those before it
    "numbers.js",
    "heap.js",
    "words.js",
    "changes.js",
    "conditions.js",
    "find.js",
    "shapes.js",
    "rows.js",
    "eye.js",
    "drawing.js",
    "scale.js",
    "painter.js",
    "picture.js",
    "heapmap.js",
    "panel.js",
    "main.js",
)
MARK = b"<!doctype html>\n<!-- A view of IA(), written by udec_ia."
LIMIT = 2**24  # words of all states together
EXPORT = re.compile(r"^export (?=const|class|function|async)", re.MULTILINE)
IMPORT = re.compile(r"^import [^;]*;\n", re.MULTILINE)


class _State(NamedTuple):
    """One state of the page: a copy of the array, what it is called, and the deck that led to it."""

    array: MainArray
    name: str
    lines: list[str]


class Page:
    """States of one model or of several, one after the other, to be looked at in a browser."""

    def __init__(self) -> None:
        self.states: list[_State] = []

    def add(self, array: MainArray, name: str, lines: Sequence[str] = ()) -> None:
        """Take a copy of `array`, sound or not. name: of the state; lines: of the deck that led to it."""
        self.states.append(_State(array.copy(), name, list(lines)))

    def write(self, path: str | Path) -> Path:
        """Write the page `path`, which may replace another page only. Error 31 if it cannot be written.

        ValueError if there is no state to be shown.
        """
        target = Path(path)
        put_in_place(target, self.text().encode(), _judge, force=False)
        return target

    def text(self) -> str:
        """The page."""
        if not self.states:
            raise ValueError("a page shows at least one state: add one")
        style, program = (WEB / "style.css").read_text("utf-8"), script(SCRIPTS)
        parts = {
            "policy": f"default-src 'none'; style-src {_digest(style)}; script-src {_digest(program)}",
            "title": html.escape(", ".join(printable(one.name) for one in self.states[:3])),
            "style": style,
            "table": _json(tables({one.array.scheme.ratio for one in self.states})),
            "states": "\n".join(
                f'<script type="application/json" class="state">{_json(state(*one, self._room))}</script>'
                for one in self.states
            ),
            "script": program,
        }
        template = (WEB / "page.html").read_text("utf-8")
        return re.sub(r"\{\{(\w+)\}\}", lambda place: parts[place[1]], template)

    def left_out(self) -> list[str]:
        """A sentence on each state that the page has no room for as a whole."""
        used = [(printable(one.name), int(one.array.h.ci[MFREE]) - 1) for one in self.states]
        return [
            f"{name} has {words} words in use: those beyond {self._room} are left out"
            for name, words in used
            if words > self._room
        ]

    @property
    def _room(self) -> int:
        """Words that the page has room for in each state."""
        return LIMIT // len(self.states)


def script(names: Sequence[str]) -> str:
    """These files of web/ as one script: each imports from those before it only."""
    texts = [(WEB / name).read_text("utf-8") for name in names]
    return "\n" + "\n".join(EXPORT.sub("", IMPORT.sub("", text)) for text in texts)


def _json(value: Any) -> str:
    """JSON that cannot end the HTML element around it."""
    text = json.dumps(value, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _digest(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _judge(front: bytes, _: int) -> str:
    return "" if front.startswith(MARK) else "exists, but is not a view written by this program"
