"""docs/words.md shows what tools/studies/words.py prints."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def test_the_page_shows_what_the_tool_prints(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "tools" / "studies")
    monkeypatch.delitem(sys.modules, "words", raising=False)
    import words

    page = (ROOT / "docs" / "words.md").read_text()
    assert [table for table in words.report().strip().split("\n\n") if table not in page] == []
