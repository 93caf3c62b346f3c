"""Results of verification problems as rows, and as a page with pictures."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from udec_ia.files import put_in_place
from udec_ia.studies.verification import Answer, ProblemResult

PAGE, IMAGES = "verification.md", "images/verify"
COLUMNS = (
    "problem",
    "blocks",
    "build",
    "what",
    "unit",
    "computed",
    "exact",
    "error",
    "tolerance",
    "verdict",
    "why",
)
HEAD = """# Verification

*This page and its pictures are written by a command; change the problems, not the page:*

    {command}

{many} problems that have an exact or a published answer, each a short Python file to read, to run and to
change: [examples/verify](../examples/verify). `udec verify` runs them all, `udec verify {name}` one of them,
and `udec verify mine.py` one of your own. `--blocks rigid,sdef,fdef` and `--build i32r64,i32r32` choose types
of blocks and word schemes; problems whose overlaps are lost in 32-bit reals are not run with these. The exit
status is 1 if an error is above its tolerance.

A tolerance is the sum of what is known to make a difference: a time-step, a rounding length, the size of
zones, an overlap, the last digit. The last column says what, and how much each adds. None is tuned. An error
that is nearly all of its tolerance is one that its reasons explain, as the longer period of a chain of zones.

| problem | what is asked | cases | answers | largest share of a tolerance |
|---|---|---|---|---|
"""


def result_rows(results: Sequence[ProblemResult]) -> Iterator[tuple[Any, ...]]:
    """One for each answer, and one for what was ended: the COLUMNS."""
    for one in results:
        case = one.problem.name, one.blocks, one.build
        for a in one.answers:
            yield (
                *case,
                a.what,
                a.unit,
                a.computed,
                a.exact,
                a.error,
                a.tolerance,
                "holds" if a.holds else "FAILS",
                a.why,
            )
        if one.failure:
            yield (*case, "", "", "", "", "", "", "FAILS", one.failure)


def brief_rows(results: Sequence[ProblemResult]) -> Iterator[tuple[Any, ...]]:
    """The same to be read: errors and tolerances as shares of what is exact."""
    for row in result_rows(results):
        *start, computed, exact, error, tolerance, verdict, why = row
        if isinstance(error, float):
            a = Answer("", start[-1], computed, exact, {})
            error, tolerance = a.share(error), a.share(tolerance)
        yield (*start, computed, exact, error, tolerance, verdict, why)


def write_page(results: Sequence[ProblemResult], folder: Path, command: str) -> Path:
    """Write the page and its pictures into `folder`; returns the page. Error 31 if that cannot be done."""
    parts = [list(part) for _, part in groupby(results, lambda one: one.problem.name)]
    for part in parts:
        picture = _picture(part)
        if picture is not None:
            put_in_place(folder / IMAGES / f"{part[0].problem.name}.png", picture, force=False)
    text = HEAD.format(command=command, many=len(parts), name=parts[0][0].problem.name)
    text += "".join(_line(part) for part in parts) + "".join(_section(part) for part in parts)
    put_in_place(folder / PAGE, text.encode(), force=False)
    return folder / PAGE


def _picture(part: list[ProblemResult]) -> bytes | None:
    return next((one.picture for one in part if one.picture is not None), None)


def _line(part: list[ProblemResult]) -> str:
    """The row of a problem in the table of all."""
    problem, answers = part[0].problem, [a for one in part for a in one.answers]
    share = max((abs(a.error) / a.tolerance for a in answers if a.tolerance), default=0.0)
    types = ", ".join(dict.fromkeys(one.blocks for one in part))
    verdict = f"{100 * share:.0f} %" if all(one.holds for one in part) else "**fails**"
    anchor = re.sub(r"[^\w -]", "", problem.title.lower()).replace(" ", "-")
    return f"| [{problem.name}](#{anchor}) | {problem.title} | {types} | {len(answers)} | {verdict} |\n"


def _section(part: list[ProblemResult]) -> str:
    """Text, picture and table of a problem."""
    problem = part[0].problem
    body = problem.text.partition("\n")[2].strip("\n")
    lines = [
        f"\n## {problem.title}\n",
        f"[{problem.name}.py](../examples/verify/{problem.name}.py)\n",
        body,
        "",
    ]
    if _picture(part) is not None:
        lines += [f"![{problem.title}]({IMAGES}/{problem.name}.png)", ""]
    builds = len({one.build for one in part}) > 1
    heads = ["blocks", *["build"] * builds, "what", "computed", "exact", "error", "tolerance", "why"]
    lines += [_cells(heads), "|---" * len(heads) + "|"]
    for one in part:
        case = [one.blocks, *[one.build] * builds]
        for a in one.answers:
            what = f"{a.what} ({a.unit})" if a.unit else a.what
            off = a.share(a.error) + ("" if a.holds else " **too much**")
            lines.append(
                _cells([*case, what, f"{a.computed:.6g}", f"{a.exact:.6g}", off, a.share(a.tolerance), a.why])
            )
        if one.failure:
            lines.append(_cells([*case, f"**ended**: {one.failure}", *[""] * (len(heads) - len(case) - 1)]))
    return "\n".join(lines) + "\n"


def _cells(cells: list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"
