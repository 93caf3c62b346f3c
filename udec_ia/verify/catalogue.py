"""Where the problems are, and what one of them is."""

from __future__ import annotations

import runpy
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from inspect import cleandoc
from pathlib import Path

from udec_ia.printable import MESSAGE, printable
from udec_ia.verify.answer import Answer
from udec_ia.verify.case import BLOCKS, Case

HERE = Path(__file__).parent
FOLDERS = (HERE / "problems", HERE.parents[1] / "examples" / "verify")  # of an installation, of a checkout
PARTS = "a docstring, BLOCKS and solve(case): see the problems that udec verify --list names"


@dataclass(frozen=True)
class Problem:
    """One file. text: its docstring. blocks: types of blocks that it makes sense for. solve: runs it.

    reals: bits that a real must have at least.
    """

    path: Path
    text: str
    blocks: tuple[str, ...]
    solve: Callable[[Case], Iterator[Answer]]
    reals: int = 32

    @property
    def name(self) -> str:
        return self.path.stem

    @property
    def title(self) -> str:
        """The first line of its text, without the full stop."""
        return self.text.partition("\n")[0].rstrip(".")


def folder() -> Path:
    """Where the problems that come with the program are."""
    return next(one for one in FOLDERS if one.is_dir())


def names() -> list[str]:
    """Of all problems that come with the program."""
    return sorted(path.stem for path in folder().glob("*.py"))


def find(name: str) -> Problem:
    """The problem called `name`, or the one in the file of that path. ValueError if there is none."""
    if name in names():
        return load(folder() / f"{name}.py")
    if name.endswith(".py") and Path(name).is_file():
        return load(Path(name))
    near = get_close_matches(name, names(), n=1)
    advice = f"did you mean {near[0]}?" if near else "udec verify --list names them all"
    raise ValueError(f"there is no problem {printable(name)}: {advice}")


def load(path: Path) -> Problem:
    """The problem in the file `path`. ValueError if it is none, or cannot be read as Python."""
    try:
        space = runpy.run_path(str(path))
    except Exception as error:
        text = f"{type(error).__name__}: {error}"
        raise ValueError(f"{printable(str(path))} is not a problem: {printable(text, MESSAGE)}") from error
    text, blocks, solve = space["__doc__"], space.get("BLOCKS", ()), space.get("solve")
    if not text or not blocks or not {*blocks} <= {*BLOCKS} or not callable(solve):
        raise ValueError(f"{printable(str(path))} is not a problem: it needs {PARTS}")
    return Problem(path, cleandoc(text), tuple(blocks), solve, space.get("REALS", 32))
