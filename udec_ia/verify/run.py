"""Problems are run, one case after the other; what goes wrong in one is told and does not end the others."""

from __future__ import annotations

import traceback
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from time import perf_counter

from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import scheme
from udec_ia.printable import MESSAGE, printable
from udec_ia.verify.answer import Answer
from udec_ia.verify.case import Case
from udec_ia.verify.catalogue import Problem


@dataclass
class Result:
    """What came of one case. failure: what ended it, or "". picture: PNG, if one was drawn."""

    problem: Problem
    build: str
    blocks: str
    answers: list[Answer] = field(default_factory=list)
    failure: str = ""
    picture: bytes | None = None
    seconds: float = 0.0

    @property
    def holds(self) -> bool:
        """True if there are answers, and all are within their tolerances."""
        return not self.failure and bool(self.answers) and all(one.holds for one in self.answers)

    def said(self) -> str:
        """One line."""
        case = f"{self.problem.name}, {self.blocks}, {self.build}"
        if self.failure:
            return f"{case}: {self.failure}"
        good = sum(one.holds for one in self.answers)
        worst = max((abs(one.error) / one.tolerance for one in self.answers if one.tolerance), default=0.0)
        return (
            f"{case}: {good} of {len(self.answers)} within tolerance, at most {100 * worst:.0f} % of it, "
            f"{self.seconds:.1f} s"
        )


def run(problems: Iterable[Problem], builds: Sequence[str], blocks: Sequence[str]) -> Iterator[Result]:
    """All cases of the problems: in the words of each of `builds`, with those of `blocks` that make sense.

    Words whose reals are too short for a problem make no sense for it either.
    """
    for problem in problems:
        for build in builds:
            for kind in problem.blocks:
                if kind in blocks and scheme(build).real_bits >= problem.reals:
                    yield run_case(problem, build, kind)


def run_case(problem: Problem, build: str, blocks: str) -> Result:
    """One case. Whatever it raises, but an interrupt, becomes the `failure`."""
    case, result, start = Case(problem.name, build, blocks), Result(problem, build, blocks), perf_counter()
    try:
        result.answers.extend(problem.solve(case))
        result.picture = case.picture()
        if not result.answers:
            result.failure = "it gives no answer"
    except UdecError as error:
        result.failure = printable(" ".join(str(error).split()), MESSAGE)
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        text = f"{type(error).__name__}: {error}, in line {place.lineno} of {place.filename}"
        result.failure = printable(" ".join(text.split()), MESSAGE)
    result.seconds = perf_counter() - start
    return result
