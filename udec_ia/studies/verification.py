"""Problems with exact or published answers: `udec verify`. Finds, executes and judges them.

The problems are Python files, in examples/verify of the checkout or of the package. One has

    a docstring   its title; the problem, its formula and why the tolerance is what it is; its source
    BLOCKS        the types of blocks that it makes sense for: "rigid", "sdef", "fdef"
    REALS         64, if what it measures is lost in reals of 32 bits; it may be left out
    solve(case)   builds and runs models, and yields an Answer for each number that is known

The file of a user is run by its path: `udec verify mine.py`. verification_tools.py has what problems share.
"""

from __future__ import annotations

import runpy
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from inspect import cleandoc
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import scheme
from udec_ia.model import Model
from udec_ia.printable_text import MESSAGE, printable

if TYPE_CHECKING:
    from udec_ia.output.plot_frames import Frame


@dataclass(frozen=True)
class Answer:
    """A number with its tolerance, the sum of `within`: reasons for an error, and how large it can be."""

    what: str
    unit: str
    computed: float
    exact: float
    within: Mapping[str, float]

    @property
    def error(self) -> float:
        """Computed less exact, in the unit."""
        return self.computed - self.exact

    @property
    def tolerance(self) -> float:
        """In the unit."""
        return sum(self.within.values())

    @property
    def holds(self) -> bool:
        """False also if a number is NaN."""
        return isfinite(self.computed) and abs(self.error) <= self.tolerance

    @property
    def why(self) -> str:
        """The parts of the tolerance, the largest first, without those below a thousandth of it."""
        parts = sorted(self.within.items(), key=lambda part: -part[1])
        return "; ".join(
            f"{self.share(size)} {name}" for name, size in parts if size >= 1e-3 * self.tolerance
        )

    def share(self, part: float) -> str:
        """A difference as a share of the exact number, or with its unit where that is 0."""
        if self.exact != 0:
            return f"{100 * part / abs(self.exact):.2g} %"
        return f"{part:.2g} {self.unit}".rstrip()


BLOCKS = ("rigid", "sdef", "fdef")
CROSS = [(1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]  # four zones about grid-point 5


class Case:
    """One run of a problem.

    build: the word scheme. blocks: the type of the blocks in question. out: folder for files of models.
    """

    def __init__(self, name: str, build: str, blocks: str, out: str | Path = ".") -> None:
        self.name, self.build, self.blocks, self.out = name, build, blocks, out
        self.frame: Frame | None = None
        self.curves: tuple[str, str, Mapping[str, Any], Sequence[Any]] | None = None

    @property
    def last_digit(self) -> float:
        """Half the last digit of a real, as a share of it."""
        return float(np.finfo(scheme(self.build).real_type).eps) / 2

    def model(self, law: Any = None) -> Model:
        """An empty model in the words of this case. law: of constitutive number 2."""
        return Model(build=self.build, out=self.out, constitutive=law, name=self.name)

    def deform(self, m: Model, x1: float, x2: float, y1: float, y2: float) -> None:
        """Make the rectangular block x1 x2 y1 y2 one of the type in question; fdef: four zones."""
        if self.blocks == "sdef":
            m.change(x1, x2, y1, y2, type="sdef")
        elif self.blocks == "fdef":
            points = [((x1 + x2) / 2, (y1 + y2) / 2), (x2, y1), (x2, y2), (x1, y2), (x1, y1)]
            m.generate(x1, x2, y1, y2, "manual", points, CROSS)

    def draw(self, m: Model, **what: Any) -> None:
        """Draw the blocks as they stand into `frame`, over those drawn before; `what` as for Model.plot."""
        from udec_ia.output.plot_frames import Frame, What, state_of

        asked = What(**what)
        if self.frame is None:
            self.frame = Frame(self.name)
        self.frame.add(state_of(m.h, asked), asked)

    def graph(self, x: str, y: str, exact: Mapping[str, Any], computed: Sequence[Any]) -> None:
        """Keep curves, each x and y, for a graph with the axes x and y: exact ones by name, computed ones."""
        self.curves = x, y, exact, computed


HERE = Path(__file__).parent
FOLDERS = [HERE.parents[k] / "examples" / "verify" for k in (0, 1)]  # installed, in a checkout
PARTS = "a docstring, BLOCKS and solve(case): see the problems that udec verify --list names"


@dataclass(frozen=True)
class Problem:
    """One file. text: its docstring. blocks: their types. solve: runs it. reals: least bits of a real."""

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


def problem_folder() -> Path:
    """Where the problems that come with the program are."""
    return next(one for one in FOLDERS if one.is_dir())


def problem_names() -> list[str]:
    """Of all problems that come with the program."""
    return sorted(path.stem for path in problem_folder().glob("*.py"))


def find_problem(name: str) -> Problem:
    """The problem called `name`, or the one in the file of that path. ValueError if there is none."""
    path = problem_folder() / f"{name}.py" if name in problem_names() else Path(name)
    if path.suffix != ".py" or not path.is_file():
        raise ValueError(f"there is no problem {printable(name)}: udec verify --list names them all")
    try:
        space = runpy.run_path(str(path))
        text, blocks, solve = space["__doc__"], tuple(space.get("BLOCKS", ())), space.get("solve")
        if not text or not blocks or not {*blocks} <= {*BLOCKS} or not callable(solve):
            raise ValueError(f"it needs {PARTS}")
    except Exception as error:
        why = printable(f"{type(error).__name__}: {error}", MESSAGE)
        raise ValueError(f"{printable(str(path))} is not a problem: {why}") from error
    return Problem(path, cleandoc(text), blocks, solve, space.get("REALS", 32))


@dataclass
class ProblemResult:
    """The result of one case. failure: what ended it, or ""."""

    problem: Problem
    case: Case
    answers: list[Answer] = field(default_factory=list)
    failure: str = ""
    seconds: float = 0.0

    @property
    def holds(self) -> bool:
        """True if there are answers, and all are within their tolerances."""
        return not self.failure and bool(self.answers) and all(one.holds for one in self.answers)

    def line(self) -> str:
        """One line."""
        case = f"{self.problem.name}, {self.case.blocks}, {self.case.build}"
        if self.failure:
            return f"{case}: {self.failure}"
        good = sum(one.holds for one in self.answers)
        worst = max((abs(one.error) / one.tolerance for one in self.answers if one.tolerance), default=0.0)
        return (
            f"{case}: {good} of {len(self.answers)} within tolerance, at most {100 * worst:.0f} % of it, "
            f"{self.seconds:.1f} s"
        )


def solve_problems(
    problems: Iterable[Problem], builds: Sequence[str], blocks: Sequence[str]
) -> Iterator[ProblemResult]:
    """All cases of the problems: each word scheme and type of blocks that the problem makes sense for."""
    for problem in problems:
        for build in builds:
            for kind in problem.blocks:
                if kind in blocks and scheme(build).real_bits >= problem.reals:
                    yield solve_case(problem, build, kind)


def solve_case(problem: Problem, build: str, blocks: str) -> ProblemResult:
    """One case. Whatever it raises, but an interrupt, becomes the `failure`. No file of a model remains."""
    text = ""
    with TemporaryDirectory() as folder:
        result, start = ProblemResult(problem, Case(problem.name, build, blocks, folder)), perf_counter()
        try:
            result.answers.extend(problem.solve(result.case))
            text = "" if result.answers else "it gives no answer"
        except UdecError as error:
            text = str(error)
        except Exception as error:
            place = traceback.extract_tb(error.__traceback__)[-1]
            text = f"{type(error).__name__}: {error}, in line {place.lineno} of {place.filename}"
    result.failure, result.seconds = printable(" ".join(text.split()), MESSAGE), perf_counter() - start
    return result
