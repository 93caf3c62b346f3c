"""A browser without a window, led by its own protocol over two pipes: real clicks, keys and pictures.

Only the standard library is used. Chromium (or Chrome) must be there; BROWSER is None if it is not.
"""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

if sys.platform != "win32":
    import fcntl

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
BROWSER = None if sys.platform == "win32" else next(filter(None, map(shutil.which, NAMES)), None)
PATIENCE = 30.0  # seconds that an answer may take
KEYS = {"Enter": 13, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Tab": 9}


class Browser:
    """A running browser with one page. events: what it has told unasked."""

    def __init__(self) -> None:
        assert BROWSER is not None
        self.folder = tempfile.mkdtemp()
        theirs_in, self.out = os.pipe()
        self.inn, theirs_out = os.pipe()
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (theirs_in, theirs_out)]
        self.process = subprocess.Popen(
            [
                BROWSER,
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--no-first-run",
                "--disable-background-networking",
                "--disable-component-update",
                "--disable-sync",
                "--remote-debugging-pipe",
                f"--user-data-dir={self.folder}",
                "about:blank",
            ],
            preexec_fn=lambda: [os.dup2(end, 3 + k) for k, end in enumerate(ends)],
            pass_fds=(3, 4),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for end in (theirs_in, theirs_out, *ends):
            os.close(end)
        self.number, self.rest, self.events, self.session = 0, b"", list[dict[str, Any]](), ""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.ask(f"{domain}.enable")
        self.size(1280, 800)

    def close(self) -> None:
        """End it."""
        self.process.kill()
        self.process.wait()
        os.close(self.out)
        os.close(self.inn)
        shutil.rmtree(self.folder, ignore_errors=True)

    def ask(self, method: str, **params: Any) -> Any:
        """Call a method of the protocol; its result."""
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        message |= {"sessionId": self.session} if self.session else {}
        os.write(self.out, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + PATIENCE
        while True:
            answer = self._read(deadline)
            if answer.get("id") == self.number:
                assert "error" not in answer, (method, answer)
                return answer["result"]
            self.events.append(answer)

    def _read(self, deadline: float) -> Any:
        while b"\0" not in self.rest:
            ready, _, _ = select.select([self.inn], [], [], max(deadline - time.monotonic(), 0))
            assert ready, "the browser does not answer"
            self.rest += os.read(self.inn, 2**20)
        line, _, self.rest = self.rest.partition(b"\0")
        return json.loads(line)

    def open(self, path: Path, fragment: str = "") -> None:
        """Go to a file, and wait until its state is shown and all is in its place."""
        self.ask("Page.navigate", url="about:blank")
        self.events.clear()
        self.ask("Page.navigate", url=path.absolute().as_uri() + fragment)
        self.wait("typeof app === 'object' && app.shown > 0")
        self.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    def js(self, expression: str) -> Any:
        """The value of an expression in the page."""
        found = self.ask("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def wait(self, expression: str) -> None:
        """Wait until an expression is true."""
        deadline = time.monotonic() + PATIENCE
        while not self.js(f"Boolean({expression})"):
            assert time.monotonic() < deadline, f"never true: {expression}"
            time.sleep(0.02)

    def click(self, x: float, y: float) -> None:
        """Click at a pixel of the window."""
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.ask("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def drag(self, x: float, y: float, to_x: float, to_y: float) -> None:
        """Draw something aside with the mouse."""
        places = [
            ("mouseMoved", x, y),
            ("mousePressed", x, y),
            ("mouseMoved", to_x, to_y),
            ("mouseReleased", to_x, to_y),
        ]
        for kind, px, py in places:
            held = 0 if kind == "mouseReleased" or (px, py, kind) == (x, y, "mouseMoved") else 1
            self.ask(
                "Input.dispatchMouseEvent", type=kind, x=px, y=py, button="left", buttons=held, clickCount=1
            )

    def click_on(self, choice: str, dx: float | None = None, dy: float | None = None) -> None:
        """Click on an element, in the middle of its first line or at an offset from its upper left corner."""
        self.js(f"document.querySelector({choice!r}).scrollIntoView({{block: 'nearest'}})")
        box = self.js(
            f"(b => [b.x, b.y, b.width, b.height])(document.querySelector({choice!r}).getClientRects()[0])"
        )
        x, y, width, height = box
        self.click(x + (width / 2 if dx is None else dx), y + (height / 2 if dy is None else dy))

    def key(self, key: str) -> None:
        """Press a key: a letter, or one of KEYS."""
        text = {"text": "\r" if key == "Enter" else key} if len(key) == 1 or key == "Enter" else {}
        code = {"windowsVirtualKeyCode": KEYS[key]} if key in KEYS else {}
        self.ask("Input.dispatchKeyEvent", type="keyDown", key=key, **text, **code)
        self.ask("Input.dispatchKeyEvent", type="keyUp", key=key, **code)

    def back(self) -> None:
        """Go back as the browser's own button does."""
        places = self.ask("Page.getNavigationHistory")
        self.ask("Page.navigateToHistoryEntry", entryId=places["entries"][places["currentIndex"] - 1]["id"])

    def write(self, text: str) -> None:
        """Type a text into what has the focus."""
        self.ask("Input.insertText", text=text)

    def size(self, width: int, height: int) -> None:
        """Give the window a size in CSS pixels."""
        self.ask(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def scheme(self, name: str) -> None:
        """Ask for a light or a dark page."""
        self.ask("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": name}])

    def picture(self, path: Path) -> None:
        """Take a picture of the window."""
        path.write_bytes(base64.b64decode(self.ask("Page.captureScreenshot")["data"]))

    def faults(self) -> list[str]:
        """What has gone wrong in the page: exceptions, and what the browser has noted as an error."""
        self.js("0")
        thrown = [one["params"] for one in self.events if one["method"] == "Runtime.exceptionThrown"]
        noted = [one["params"]["entry"] for one in self.events if one["method"] == "Log.entryAdded"]
        return [json.dumps(one) for one in thrown] + [one["text"] for one in noted if one["level"] == "error"]

    def requests(self) -> list[str]:
        """The addresses that the page has asked for."""
        self.js("0")
        asked = [
            one["params"]["request"]["url"]
            for one in self.events
            if one["method"] == "Network.requestWillBeSent"
        ]
        return [url for url in asked if url != "about:blank"]
