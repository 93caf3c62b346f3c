"""Docstrings of the public interface: sections of numpydoc, all parameters, and examples that run."""

from __future__ import annotations

import doctest
import inspect
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from support.typed_script import main

import udec_ia
from udec_ia import Model
from udec_ia.export import export
from udec_ia.kernels.drive.damping_modes import MODES
from udec_ia.layout.material import JointProperties, Properties, StructuralProperties
from udec_ia.model.cut_commands import OfCut
from udec_ia.ops.commands.outside_conditions import OutsideWater

WITHOUT_EXAMPLES = {"end", "summary"}  # the same as `stop`
METHODS = {name: one for name, one in inspect.getmembers(Model, callable) if not name.startswith("_")}
TOGETHER: dict[str, list[str]] = {  # described as one
    "words": [*OfCut.__annotations__],
    "values": [
        *Properties.__annotations__,
        *JointProperties.__annotations__,
        *StructuralProperties.__annotations__,
    ],
    "water": [*OutsideWater.__annotations__],
    "modes": [one.argument for one in MODES],
}
PUBLIC: dict[str, Callable[..., Any]] = METHODS | {
    "Model class": Model,
    "sweep function": udec_ia.sweep,
    "export function": export,
}


def two_blocks(folder: Path) -> Model:
    """Two blocks of 2 m by 1 m, one on the other; the lower one is fixed."""
    m = Model(out=folder)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.gravity(0, -10)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    m.fix(0, 2, 0, 1)
    return m


def section(text: str, title: str) -> str:
    """The lines under a title, "" without it."""
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\S[^\n]*\n-+$|\Z)", text, re.MULTILINE | re.DOTALL)
    return found[1] if found else ""


@pytest.mark.parametrize("name", PUBLIC)
def test_sections(name: str) -> None:
    """All parameters, what is returned, and an example."""
    one = PUBLIC[name]
    text, signature = inspect.getdoc(one) or "", inspect.signature(one)
    assert re.match(r"[^\n]{10,}\.(\n\n|$)", text)
    described = {
        word.strip()
        for line in section(text, "Parameters").splitlines()
        if line and not line.startswith(" ")
        for word in line.split(",")
    }
    described |= {name for word in described & {*TOGETHER} for name in TOGETHER[word]}
    assert {*signature.parameters} - {"self"} <= described
    if name != "Model class" and signature.return_annotation not in ("None", None):
        assert section(text, "Returns")
    if name not in WITHOUT_EXAMPLES:
        assert ">>> " in section(text, "Examples")


@pytest.mark.parametrize("name", PUBLIC)
def test_examples(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if name == "frame":
        pytest.importorskip("pandas")
    monkeypatch.chdir(tmp_path)
    given = {"Model": Model, "udec_ia": udec_ia, "export": export, "folder": tmp_path}
    given["m"] = two_blocks(tmp_path)
    examples = doctest.DocTestParser().get_doctest(inspect.getdoc(PUBLIC[name]) or "", given, name, None, 0)
    printed: list[str] = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(examples, out=printed.append)
    assert "".join(printed) == ""


def test_the_script_of_a_user_runs(tmp_path: Path) -> None:
    """mypy reads it with the package."""
    assert main(tmp_path) > 0
