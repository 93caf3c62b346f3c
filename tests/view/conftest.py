"""What the tests of the page share: the page of a model, and a browser that shows it."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.headless_browser import Browser
from support.view_page import ViewCase


@pytest.fixture(scope="module")
def viewed(tmp_path_factory: pytest.TempPathFactory) -> ViewCase:
    return ViewCase(tmp_path_factory.mktemp("view"))


@pytest.fixture(scope="module")
def running() -> Iterator[Browser]:
    browser = Browser()
    yield browser
    browser.close()


@pytest.fixture
def browser(running: Browser, viewed: ViewCase) -> Iterator[Browser]:
    """A browser that shows the second state. Nothing may go wrong in it, and nothing be fetched."""
    running.size(1280, 800)
    running.scheme("light")
    running.open(viewed.path, "#state=2")
    yield running
    assert running.faults() == []
    assert running.requests() == [viewed.path.absolute().as_uri()] * len(running.requests())
