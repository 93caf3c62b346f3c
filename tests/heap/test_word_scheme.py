"""docs/words.md shows what docs/studies/word_scheme_costs.py prints."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def test_the_page_shows_what_the_tool_prints(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "docs" / "studies")
    monkeypatch.delitem(sys.modules, "word_scheme_costs", raising=False)
    import word_scheme_costs

    page = (ROOT / "docs" / "words.md").read_text()
    assert [table for table in word_scheme_costs.report().strip().split("\n\n") if table not in page] == []
