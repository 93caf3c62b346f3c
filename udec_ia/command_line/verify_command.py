"""The command that runs problems with exact answers.

udec verify        udec verify incline toppling --blocks rigid,fdef --build i32r64,i32r32
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, names
from udec_ia.printable_text import counted

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.verification import ProblemResult

VERBS = ("verify",)
COLUMNS = (
    *("problem", "blocks", "build", "what", "unit"),
    *("computed", "exact", "error", "tolerance", "verdict", "why"),
)
TEXT = "run problems with exact or published answers; exit status 1 if an error is above its tolerance"


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "verify", TEXT, _verify, _script)
    text = "a problem, or a Python file with one (default: all problems)"
    parser.add_argument("names", nargs="*", metavar="NAME", help=text)
    parser.add_argument("--build", metavar="A,B", help="word schemes (default: i32r64)")
    parser.add_argument("--blocks", metavar="A,B", help="types of blocks (default: rigid,sdef,fdef)")
    parser.add_argument("--list", action="store_true", help="list the problems without running them")


def _cases(args: argparse.Namespace) -> tuple[list[str], list[str]]:
    """Word schemes and types of blocks."""
    from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME
    from udec_ia.studies.verification import BLOCKS

    builds = names("--build", args.build, ALL_SCHEMES) or [DEFAULT_SCHEME]
    return builds, names("--blocks", args.blocks, BLOCKS) or [*BLOCKS]


def _verify(args: argparse.Namespace) -> Listing:
    from udec_ia.heap.word_scheme import scheme
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.verification import find_problem, problem_names, solve_problems

    problems = [find_problem(name) for name in args.names or problem_names()]
    builds, blocks = _cases(args)
    if args.list:
        rows = [(one.name, ", ".join(one.blocks), one.reals, one.title) for one in problems]
        return Listing([], ("problem", "blocks", "bits of a real", "what is asked"), rows)
    results = []
    for result in solve_problems(problems, builds, blocks):
        print(result.line(), file=sys.stderr, flush=True)
        results.append(result)
    if not results:
        raise ValueError(
            f"none of these problems makes sense for {', '.join(blocks)} in {', '.join(builds)}: "
            "choose other --blocks or --build, as --list shows"
        )
    wrong = sum(not one.holds for one in results)
    verdict = f"{wrong} not within tolerance" if wrong else "all within tolerance"
    lines = [f"{counted(len(results), 'case')}, {verdict}"]
    short = [one.name for one in problems if any(scheme(build).real_bits < one.reals for build in builds)]
    if short:
        lines.append(f"not run with 32-bit reals, which are too coarse for them: {', '.join(short)}")
    return Listing(lines, COLUMNS, [*_result_rows(results)], int(wrong > 0))


def _result_rows(results: Sequence[ProblemResult]) -> Iterator[tuple[Any, ...]]:
    """One for each answer, and one for what was ended: the COLUMNS."""
    for one in results:
        case = one.problem.name, one.case.blocks, one.case.build
        for a in one.answers:
            verdict = "holds" if a.holds else "FAILS"
            yield (*case, a.what, a.unit, a.computed, a.exact, a.error, a.tolerance, verdict, a.why)
        if one.failure:
            yield (*case, *[""] * 6, "FAILS", one.failure)


def _script(args: argparse.Namespace) -> str:
    builds, blocks = _cases(args)
    return (
        "from udec_ia.studies.verification import find_problem, problem_names, solve_problems\n\n"
        f"problems = map(find_problem, {args.names or 'problem_names()'})\n"
        f"for result in solve_problems(problems, {builds}, {blocks}):\n"
        "    print(result.line())\n    for answer in result.answers:\n"
        "        print('   ', answer.what, answer.computed, answer.exact, answer.tolerance, answer.why)"
    )
