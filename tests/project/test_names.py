"""Names keep to docs/names.md, as far as a machine can tell."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "udec_ia"
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
BARE = {  # participles and verbs without their object, and everyday nouns for technical things
    *("ahead", "alone", "apart", "aside", "bearing", "bends", "beside", "clock", "drawn", "grazes", "kept"),
    *("lent", "meant", "noted", "obeying", "once", "openings", "parting", "patience", "planted", "renewal"),
    *("said", "shop", "sparing", "stage", "standing", "steady", "strides", "surveyed", "told", "unrest"),
    *("ways", "wreck", "wrecks"),
}
AMBIGUOUS = {"bounds", "convert", "extremes", "kinds", "limit", "model"}  # words with another common meaning
THE_MODEL = PACKAGE / "model" / "model.py"  # which has the class that users know as Model
SAME_SUBJECT: set[str] = set()  # names of files that two folders of the package may have
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


def public(tree: ast.Module) -> Iterator[ast.FunctionDef | ast.ClassDef]:
    """The public functions, classes and methods of a source."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef):
            for one in node.body:
                if isinstance(one, ast.FunctionDef | ast.ClassDef) and not one.name.startswith("_"):
                    yield one


def unclear(path: Path, tree: ast.Module) -> Iterator[str]:
    """Names of a file, of its classes and of its public functions that the lists of words exclude."""
    if path.stem in BARE | AMBIGUOUS and path != THE_MODEL:
        yield f"{path.relative_to(ROOT)}"
    for node in public(tree):
        excluded = BARE | AMBIGUOUS if isinstance(node, ast.ClassDef) else BARE
        if node.name.lower() in excluded and path != THE_MODEL:
            yield f"{path.relative_to(ROOT)}: {node.name}"


def test_files_classes_and_functions_have_plain_names() -> None:
    sources = [path for folder in (PACKAGE, ROOT / "tests", ROOT / "tools") for path in folder.rglob("*.py")]
    assert [name for path in sorted(sources) for name in unclear(path, ast.parse(path.read_text()))] == []


def test_no_two_files_have_one_name() -> None:
    found = Counter(path.stem for path in SOURCES if path.stem != "__init__")
    assert {name for name, count in found.items() if count > 1} - SAME_SUBJECT == set()


def test_the_rules_find_what_breaks_them() -> None:
    assert NOT_OF_THE_FIELD.search("at_least")
    assert NOT_OF_THE_FIELD.search("MOST_ZONES")
    assert not NOT_OF_THE_FIELD.search("almost")
    assert QUESTION.match("_is_twin")
    assert not QUESTION.match("island")
    source = ast.parse(
        "class Shop:\n    def told(self): ...\nclass Limit: ...\ndef limit(): ...\ndef _told(): ..."
    )
    found = [*unclear(ROOT / "udec_ia" / "aside.py", source)]
    assert [name.rpartition(" ")[2] for name in found] == ["udec_ia/aside.py", "Shop", "Limit", "told"]
