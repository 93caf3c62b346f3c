"""Studies of docs/studies: each is named by a page, and what it imports is there.

They made the figures of pages and take minutes to hours: so they are not run here, nor checked by ruff.
"""

from __future__ import annotations

import ast
from importlib import import_module
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
STUDIES = {path.stem: path for path in sorted((DOCS / "studies").glob("*.py"))}
PAGES = "".join(page.read_text() for page in DOCS.rglob("*.md"))


def imports(path: Path) -> dict[str, set[str]]:
    """Names that a source takes from each module."""
    found: dict[str, set[str]] = {}
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module:
            found.setdefault(node.module, set()).update(alias.name for alias in node.names)
    return found


@pytest.mark.parametrize("name", STUDIES)
def test_what_a_study_imports_is_there(name: str) -> None:
    for module, wanted in imports(STUDIES[name]).items():
        if module in STUDIES:
            nodes = [*ast.walk(ast.parse(STUDIES[module].read_text()))]
            given = {node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.ClassDef)}
            assigned = {node.id for node in nodes if isinstance(node, ast.Name)}
            assert wanted <= given | assigned
        elif module.split(".")[0] in ("udec_ia", "support", "naive"):
            there = import_module(module)
            for one in wanted:
                assert hasattr(there, one) or import_module(f"{module}.{one}"), f"{module}.{one}"


def test_each_study_is_named_by_a_page_or_used_by_another() -> None:
    used = {module for path in STUDIES.values() for module in imports(path)}
    assert {name for name in STUDIES if f"docs/studies/{name}.py" not in PAGES} <= used | {"stability_page"}
