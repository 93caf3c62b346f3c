"""Imports point downwards: from a layer to those below it, and nowhere in a circle."""

from __future__ import annotations

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "udec_ia"
FOLDERS = {  # of a layer, each of which imports from those before it and from files beside them only
    "kernels": (
        "links",
        "geometry",
        "audit",
        "constitutive",
        "map",
        "body",
        "structures",
        "detect",
        "energy",
        "contact",
        "water",
        "split",
        "crack",
        "drive",
    ),
    "ops": ("common", "laws", "commands", "cuts"),
}
BELOW = {  # layers that a layer imports
    "layout": set[str](),
    "compiling": {"errors", "layout", "interrupt_signals"},
    "heap": {"compiling", "errors", "layout"},
    "checked_build": {"compiling", "errors", "heap", "layout"},
    "kernels": {"errors", "compiling", "heap", "layout"},
    "reader": {"errors", "compiling", "heap", "kernels", "layout", "printable_text"},
    "ops": {
        "errors",
        "compiling",
        "heap",
        "kernels",
        "layout",
        "printable_text",
        "reader",
        "interrupt_signals",
    },
    "checker": {"errors", "compiling", "heap", "kernels", "layout", "reader", "printable_text"},
    "running": {
        "compiling",
        "errors",
        "heap",
        "kernels",
        "layout",
        "ops",
        "reader",
        "remark",
        "interrupt_signals",
        "printable_text",
    },
    "advice": {
        "errors",
        "heap",
        "kernels",
        "layout",
        "ops",
        "reader",
        "remark",
        "running",
        "printable_text",
    },
    "heap_tools": {
        "checker",
        "errors",
        "compiling",
        "heap",
        "kernels",
        "layout",
        "ops",
        "reader",
        "printable_text",
    },
    "facilities": {
        "advice",
        "errors",
        "heap",
        "heap_tools",
        "kernels",
        "layout",
        "ops",
        "reader",
        "running",
        "printable_text",
    },
    "restart": {
        "errors",
        "file_replacement",
        "compiling",
        "heap",
        "checker",
        "heap_tools",
        "reader",
        "layout",
        "ops",
        "printable_text",
        "running",
        "version",
    },
    "output": {
        "errors",
        "file_replacement",
        "interrupt_signals",
        "compiling",
        "heap",
        "checker",
        "heap_tools",
        "reader",
        "kernels",
        "layout",
        "ops",
        "printable_text",
        "running",
        "restart",
    },
    "export": {"checker", "errors", "file_replacement", "heap", "kernels", "layout", "reader"},
    "view": {
        "file_replacement",
        "compiling",
        "heap",
        "checker",
        "heap_tools",
        "reader",
        "layout",
        "printable_text",
    },
    "debug": {
        "deck",
        "errors",
        "file_replacement",
        "output",
        "version",
        "compiling",
        "heap",
        "checker",
        "heap_tools",
        "reader",
        "kernels",
        "layout",
        "ops",
        "printable_text",
        "running",
        "interrupt_signals",
    },
    "studies": {
        "debug",
        "deck",
        "errors",
        "file_replacement",
        "compiling",
        "heap",
        "checker",
        "heap_tools",
        "reader",
        "kernels",
        "layout",
        "model",
        "ops",
        "output",
        "printable_text",
        "running",
        "version",
    },
    "command_line": {
        "debug",
        "deck",
        "errors",
        "export",
        "file_replacement",
        "compiling",
        "facilities",
        "heap",
        "checker",
        "heap_tools",
        "reader",
        "layout",
        "model",
        "output",
        "printable_text",
        "restart",
        "studies",
        "view",
    },
    "model": {
        "advice",
        "remark",
        "running",
        "debug",
        "deck",
        "errors",
        "export",
        "file_replacement",
        "compiling",
        "heap",
        "checker",
        "heap_tools",
        "kernels",
        "reader",
        "layout",
        "ops",
        "output",
        "printable_text",
        "restart",
        "interrupt_signals",
        "view",
    },
    "deck": {
        "errors",
        "compiling",
        "heap",
        "kernels",
        "layout",
        "ops",
        "printable_text",
        "reader",
        "interrupt_signals",
    },
}


def module(path: Path) -> str:
    """The name of the module in the file `path`."""
    name = ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts)
    return name.removesuffix(".__init__")


SOURCES = {module(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def imports(name: str) -> set[str]:
    """The modules of the package that `name` imports, wherever in the file."""
    found = set()
    for node in ast.walk(ast.parse(SOURCES[name].read_text())):
        if isinstance(node, ast.ImportFrom) and node.module in SOURCES:
            inner = {f"{node.module}.{alias.name}" for alias in node.names}
            found |= {one for one in inner if one in SOURCES} or {node.module}
        elif isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names if alias.name in SOURCES}
    return found


def test_there_is_something_to_look_at() -> None:
    assert imports("udec_ia.kernels.drive.cycle") > {"udec_ia.heap.accessors", "udec_ia.kernels.contact.ford"}
    for layer, folders in FOLDERS.items():
        assert {path.parent.name for path in (PACKAGE / layer).glob("*/__init__.py")} == {*folders}


@pytest.mark.parametrize("layer", BELOW)
def test_imports_point_downwards(layer: str) -> None:
    for name in SOURCES:
        if name.startswith(f"udec_ia.{layer}."):
            assert {other.split(".")[1] for other in imports(name)} <= {layer} | BELOW[layer], name


@pytest.mark.parametrize(("layer", "folder"), [(layer, one) for layer in FOLDERS for one in FOLDERS[layer]])
def test_imports_point_downwards_within_a_layer(layer: str, folder: str) -> None:
    before = FOLDERS[layer][: FOLDERS[layer].index(folder) + 1]
    for name in SOURCES:
        if name.startswith(f"udec_ia.{layer}.{folder}."):
            parts = [other.split(".") for other in imports(name)]
            inside = {part[2] for part in parts if part[1] == layer and len(part) > 3}
            assert inside <= {*before}, name


def test_there_is_no_circle() -> None:
    assert list(TopologicalSorter({name: imports(name) for name in SOURCES}).static_order())
