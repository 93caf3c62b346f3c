"""Names keep to docs/names.md, as far as a machine can tell."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "udec_ia"
KERNELS = {path: ast.parse(path.read_text()) for path in sorted((PACKAGE / "kernels").rglob("*.py"))}
SOURCES = {path: ast.parse(path.read_text()) for path in sorted(PACKAGE.rglob("*.py"))}
ADDRESSES = {
    "ib",
    "jb",
    "ic",
    "jc",
    "ip",
    "iq",
    "jp",
    "ia",
    "idm",
    "ie",
    "ig",
    "iz",
    "iu",
    "ju",
    "item",
    "iad",
}
QUESTION = re.compile(r"_?(is|has|in|lies)_")
NOT_OF_THE_FIELD = re.compile(r"(^|_)(most|least|lean)(_|$)", re.IGNORECASE)  # limit, largest, smallest
LIST_HEAD = re.compile(r"g\.I[A-Z]+PNT")


def functions(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    """The functions of a source."""
    return (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))


def names(tree: ast.Module) -> Iterator[str]:
    """All names that a source gives: of functions, parameters and variables."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id


def test_the_memory_comes_first() -> None:
    for path, tree in KERNELS.items():
        for function in functions(tree):
            given = [argument.arg for argument in function.args.args]
            assert "h" not in given[1:], f"{path}: {function.name}"


def test_names_of_addresses_are_integers() -> None:
    for path, tree in KERNELS.items():
        for function in functions(tree):
            for argument in function.args.args:
                if argument.arg in ADDRESSES and argument.annotation is not None:
                    assert ast.unparse(argument.annotation) == "int", f"{path}: {function.name}"


def test_questions_are_answered_by_true_or_false() -> None:
    for path, tree in KERNELS.items():
        for function in functions(tree):
            if QUESTION.match(function.name) and function.returns is not None:
                answer = ast.unparse(function.returns)
                assert answer == "bool" or answer.startswith("Callable"), f"{path}: {function.name}"


def test_what_ends_in_all_goes_through_a_list() -> None:
    for path, tree in KERNELS.items():
        for function in functions(tree):
            if function.name.endswith("_all"):
                assert LIST_HEAD.search(ast.unparse(function)), f"{path}: {function.name}"


def test_words_are_those_of_the_field() -> None:
    found = {name for tree in SOURCES.values() for name in names(tree) if NOT_OF_THE_FIELD.search(name)}
    assert found == set()


def test_the_rules_find_what_breaks_them() -> None:
    assert NOT_OF_THE_FIELD.search("at_least")
    assert NOT_OF_THE_FIELD.search("MOST_ZONES")
    assert not NOT_OF_THE_FIELD.search("almost")
    assert QUESTION.match("_is_twin")
    assert not QUESTION.match("island")
