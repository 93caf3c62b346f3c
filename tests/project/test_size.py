"""The program stays small: numbers of files and lines, and levels of imports between its packages."""

from __future__ import annotations

from graphlib import TopologicalSorter
from pathlib import Path

from test_layers import SOURCES, imports

ROOT = Path(__file__).parents[2]
FILES, LINES, TOOL_LINES, LEVELS = 400, 64_000, 5_430, 13


def lines(folder: str) -> dict[Path, int]:
    """Lines of each Python file of a folder."""
    return {path: path.read_text().count("\n") for path in (ROOT / folder).rglob("*.py")}


def package(name: str) -> str:
    """The folder of the package, or the file beside these, that a module belongs to."""
    return name.split(".")[1] if "." in name else name


def levels() -> dict[str, int]:
    """How many folders import one another, one below the other, from each folder or file down."""
    below: dict[str, set[str]] = {}
    for name in SOURCES:
        below.setdefault(package(name), set()).update(map(package, imports(name)))
    for name, others in below.items():
        others.discard(name)
    found: dict[str, int] = {}
    for name in TopologicalSorter(below).static_order():
        here = int((ROOT / "udec_ia" / name).is_dir())
        found[name] = here + max((found[other] for other in below[name]), default=0)
    return found


def test_files_and_lines_of_the_package() -> None:
    found = lines("udec_ia")
    assert len(found) <= FILES
    assert sum(found.values()) <= LINES


def test_lines_of_tools() -> None:
    assert sum(lines("tools").values()) <= TOOL_LINES


def test_levels_of_imports() -> None:
    found = levels()
    assert found["layout"] == 1
    assert found["heap"] < found["kernels"] < found["command_line"]
    assert max(found.values()) <= LEVELS
