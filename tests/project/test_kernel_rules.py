"""Rules that the kernels' sources keep, so that one source serves five word schemes and two ways to run.

A bare float is a real of 64 bits: one of them in a sum of 32-bit reals makes the compiled sum another one
than the interpreted. So a number is `real(h, 0.5)`, of the scheme's width, but where a file counts in 64 bits
in every scheme on purpose. A power is left to the compiler's library, whose last digit is not NumPy's. And
the array is indexed in heap/ only: what reads and writes it can be exchanged there.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).parents[2] / "udec_ia"
SOURCES = sorted(PACKAGE.rglob("*.py"))
KERNELS = [path for path in SOURCES if "kernels" in path.parts]
IN_DOUBLES = {  # they sum up over a run, or judge, or solve for what is the same in every scheme
    "audit/outline_intersections.py",
    "audit/outline_arrays.py",
    "audit/contact_positions.py",
    "body/boundary_conditions.py",
    "body/turned_blocks.py",
    "detect/block_segments.py",
    "detect/large_domains.py",
    "detect/passage_through_block.py",
    "drive/critical_stiffness.py",
    "drive/kinetic_damping.py",
    "drive/damped_forces.py",
    "drive/reactions.py",
    "drive/unbalanced_force.py",
    "drive/structure_pass.py",
    "drive/structure_stiffness.py",
    "energy/stored_energy.py",
    "energy/work_account.py",
    "geometry/block_grid.py",
    "geometry/point_distance.py",
    "map/domain_water.py",
    "structures/attached_points.py",
    "structures/beams.py",
    "structures/bolts.py",
    "water/domain_outline.py",
    "water/wall_forces.py",
    "water/water_flow.py",
    "water/water_outside.py",
    "water/water_pressure.py",
}
LINES_OF_A_FUNCTION, LINES_OF_A_FILE = 60, 500


def parsed(text: str) -> ast.Module:
    """A source with, at each node, the node that it is part of (`above`)."""
    tree = ast.parse(text)
    for node in ast.walk(tree):
        for part in ast.iter_child_nodes(node):
            part.above = node  # type: ignore[attr-defined]
    return tree


def is_float(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, float)


def constants(tree: ast.Module) -> set[str]:
    """Names of the numbers with a fraction that a file defines."""
    return {
        name.id
        for node in tree.body
        if isinstance(node, ast.Assign) and any(map(is_float, ast.walk(node.value)))
        for name in node.targets
        if isinstance(name, ast.Name)
    }


def bare_floats(tree: ast.Module, named: set[str]) -> Iterator[int]:
    """Lines within functions where a float stands, or one of those `named`, that is no argument of `real`."""
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        for node in ast.walk(function):
            if is_float(node) or (isinstance(node, ast.Name) and node.id in named):
                above = node.above  # type: ignore[attr-defined]
                if isinstance(above, ast.UnaryOp):
                    above = above.above  # type: ignore[attr-defined]
                if not (isinstance(above, ast.Call) and ast.unparse(above.func) == "real"):
                    yield node.lineno


def powers(tree: ast.Module) -> Iterator[int]:
    """Lines with a power."""
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            yield node.lineno
        if isinstance(node, ast.Call) and ast.unparse(node.func) in ("pow", "np.power", "math.pow"):
            yield node.lineno


def views(tree: ast.Module) -> Iterator[int]:
    """Lines that take a view of the array in hand, to index it or to hand it on, or are handed one."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and node.attr in ("ia", "ra"):
            yield node.lineno
        if isinstance(node, ast.FunctionDef):
            given = [one.arg for one in node.args.args]
            if given[:1] != ["h"] and {*given} & {"words", "reals"}:  # as heap/ calls them
                yield node.lineno


def test_the_rules_find_what_breaks_them() -> None:
    lines = ("A = 1.5", "def f(words, x):", " y = 0.5 * x", " z = x**2 + real(h, -0.5)", " w = h.ia")
    tree = parsed("\n".join([*lines, " return w[3] * A + pow(x, 2) + real(h, A)"]))
    assert [*bare_floats(tree, constants(tree))] == [3, 6]
    assert [*powers(tree)] == [4, 6]
    assert sorted(views(tree)) == [2, 5]


def test_numbers_are_as_wide_as_the_scheme_says() -> None:
    kernels = {str(path.relative_to(PACKAGE / "kernels")): parsed(path.read_text()) for path in KERNELS}
    named = set[str]().union(*map(constants, kernels.values()))
    assert {name for name, tree in kernels.items() if [*bare_floats(tree, named)]} == IN_DOUBLES
    assert {name for name, tree in kernels.items() if [*powers(tree)]} == set()


def test_kernels_do_not_index_the_array() -> None:
    assert {path.name for path in KERNELS if [*views(parsed(path.read_text()))]} == set()


def test_joint_properties_are_read_in_one_file() -> None:
    """Nothing else knows which material a contact has, and what that makes of it."""
    named = {"AKN", "AKS", "AMU", "COH", "KCM"}
    readers = {
        path.name
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Attribute) and node.attr in named and ast.unparse(node.value) == "g"
    }
    assert readers == {"joint_properties.py", "material.py"}  # the latter is generated


def lines_of_docstring(node: ast.FunctionDef) -> int:
    """Lines of the docstring of a function, which sections of numpydoc make long."""
    first = node.body[0]
    return (first.end_lineno or 0) - first.lineno + 1 if ast.get_docstring(node) else 0


def test_a_function_fits_a_screen_and_a_file_a_reader() -> None:
    """A function without its docstring."""
    for path in SOURCES:
        text = path.read_text()
        if path.name != "offsets.py":  # generated
            assert text.count("\n") <= LINES_OF_A_FILE, path
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.FunctionDef):
                length = (node.end_lineno or node.lineno) - node.lineno + 1 - lines_of_docstring(node)
                assert length <= LINES_OF_A_FUNCTION, f"{path}: {node.name} has {length} lines"
