"""The keys of remarks: each is in docs/python.md, and the page has no other."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
OF_NO_WARNING = {"damping", "undamped"}  # lines that explain a run


def test_the_page_has_all_keys() -> None:
    sources = "".join(path.read_text() for path in (ROOT / "udec_ia").rglob("*.py"))
    keys = {*re.findall(r'(?:Remark\(\s*|"key": )"([a-z-]+)"', sources)} - OF_NO_WARNING
    page = (ROOT / "docs" / "python.md").read_text().partition("## Warnings")[2].partition("\n## ")[0]
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| `")]
    assert keys == {*re.findall(r"`([a-z-]+)`", "".join(rows))}


def test_no_warning_is_plain_text() -> None:
    plain = [
        path for path in (ROOT / "udec_ia").rglob("*.py") if re.search(r'\btell\(\s*f?"', path.read_text())
    ]
    assert plain == []
