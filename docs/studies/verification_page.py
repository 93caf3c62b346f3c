"""Writes docs/verification.md and its pictures: the results of problems with exact answers.

python docs/studies/verification_page.py docs
"""

from __future__ import annotations

import argparse
import io
import re
import sys
from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.file_replacement import put_in_place
from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.output.block_drawing import INK, title
from udec_ia.output.history_graph import COLOURS
from udec_ia.studies.verification import (
    BLOCKS,
    Case,
    ProblemResult,
    find_problem,
    problem_names,
    solve_problems,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PAGE, IMAGES = "verification.md", "images/verify"
SIZE = (7.2, 3.4)  # inches of a graph
DPI = 90
SHADES, KMEANS = 64, 4  # colours of a file, and how often they are improved
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
    figures = (_figure(one.case) for one in part)
    return next((_png(figure) for figure in figures if figure is not None), None)


def _figure(case: Case) -> Figure | None:
    """What a problem has drawn: a graph, or else its blocks; None if nothing."""
    if case.curves is not None:
        return _graph(case.name, *case.curves)
    return None if case.frame is None else case.frame.figure()


def _line(part: list[ProblemResult]) -> str:
    """The row of a problem in the table of all."""
    problem, answers = part[0].problem, [a for one in part for a in one.answers]
    share = max((abs(a.error) / a.tolerance for a in answers if a.tolerance), default=0.0)
    types = ", ".join(dict.fromkeys(one.case.blocks for one in part))
    verdict = f"{100 * share:.0f} %" if all(one.holds for one in part) else "**fails**"
    anchor = re.sub(r"[^\w -]", "", problem.title.lower()).replace(" ", "-")
    return f"| [{problem.name}](#{anchor}) | {problem.title} | {types} | {len(answers)} | {verdict} |\n"


def _section(part: list[ProblemResult]) -> str:
    """Text, picture and table of a problem."""
    problem = part[0].problem
    body = problem.text.partition("\n")[2].strip("\n")
    link = f"[{problem.name}.py](../examples/verify/{problem.name}.py)"
    lines = [f"\n## {problem.title}\n", f"{link}\n", body, ""]
    if any(one.case.curves or one.case.frame for one in part):
        lines += [f"![{problem.title}]({IMAGES}/{problem.name}.png)", ""]
    builds = len({one.case.build for one in part}) > 1
    heads = ["blocks", *["build"] * builds, "what", "computed", "exact", "error", "tolerance", "why"]
    lines += [_cells(heads), "|---" * len(heads) + "|"]
    for one in part:
        case = [one.case.blocks, *[one.case.build] * builds]
        for a in one.answers:
            what = f"{a.what} ({a.unit})" if a.unit else a.what
            off = a.share(a.error) + ("" if a.holds else " **too much**")
            numbers = [f"{a.computed:.6g}", f"{a.exact:.6g}", off, a.share(a.tolerance)]
            lines.append(_cells([*case, what, *numbers, a.why]))
        if one.failure:
            lines.append(_cells([*case, f"**ended**: {one.failure}", *[""] * (len(heads) - len(case) - 1)]))
    return "\n".join(lines) + "\n"


def _cells(cells: list[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


# ---- pictures


def _graph(name: str, x: str, y: str, exact: Mapping[str, Any], computed: Sequence[Any]) -> Figure:
    """Curves over one pair of axes: `exact` as lines, `computed` as points in the same order of colours."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(SIZE, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    title(axes, name)
    for colour, (label, points) in zip(COLOURS, exact.items(), strict=False):
        axes.plot(*points, color=colour, linewidth=1.2, label=label)
    for k, points in enumerate(computed):
        style: dict[str, Any] = {"markersize": 3.5, "markerfacecolor": "white", "markeredgewidth": 0.9}
        label = "computed" if k == 0 else "_"  # once in the legend
        axes.plot(*points, "o", color=COLOURS[k % len(COLOURS)], label=label, **style)
    axes.set_xlabel(x, fontsize=9, color=INK)
    axes.set_ylabel(y, fontsize=9, color=INK)
    axes.grid(color="#e4e0d8", linewidth=0.6)
    axes.tick_params(labelsize=8, colors=INK, width=0.6)
    for spine in axes.spines.values():
        spine.set(linewidth=0.6, color="#8a857c")
    figure.legend(loc="outside right upper", fontsize=8, frameon=False)
    return figure


def _png(figure: Figure) -> bytes:
    """The picture as a small PNG."""
    from PIL import Image

    whole, small = io.BytesIO(), io.BytesIO()
    figure.savefig(whole, format="png", dpi=DPI)
    with Image.open(whole) as image:
        image.convert("RGB").quantize(SHADES, kmeans=KMEANS).save(small, "png", optimize=True)
    return small.getvalue()


def main() -> int:
    """Run the problems and write the page into a folder."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="problems (default: all)")
    parser.add_argument("--build", default=DEFAULT_SCHEME, help="word schemes, with commas")
    args = parser.parse_args()
    problems = [find_problem(name) for name in args.names or problem_names()]
    results = []
    for result in solve_problems(problems, args.build.split(","), BLOCKS):
        print(result.line(), flush=True)
        results.append(result)
    print(write_page(results, args.folder, " ".join(["python", *sys.argv])))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
