"""Sweep: runs one deck for all combinations of values of its variables (docs/sweep.md).

The steps of a range are calculated in fractions and rounded once, so 0.3:0.9:7 contains 0.4, and not
0.39999999999999997. A range of integers with integers only gives integers.
"""

from __future__ import annotations

import hashlib
import io
import os
import re
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple, TextIO

from udec_ia.deck.command_monitor import names_a_file
from udec_ia.deck.deck_variables import NAME, Value, Variables, spelt
from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.printable_text import MESSAGE, counted, printable
from udec_ia.studies.execute_run import LOG
from udec_ia.studies.quantities import DEFAULTS, OF_SAFETY, read_quantities
from udec_ia.studies.study_run import EVERY, RunResult, StudyRun, check_deck_text, kept_result, read_deck
from udec_ia.studies.study_table import (
    BEHIND,
    StudyTable,
    check_outputs,
    draw_table,
    output_paths,
    picture_axes,
)
from udec_ia.studies.worker_pool import StudyProgress, WorkerPool, processes

LONGEST = 120  # characters of the name of a folder
NUMBER = re.compile(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")
SHOWN = 3  # warnings that are shown
DIGITS = 12  # of the values of a logarithmic range between its ends
VALUE_COUNT = 1_000_000  # values of a range
FORM = "a range is first:last:number, as in 0.3:0.9:7, or first:last:number:log; a list has commas"
GREATEST = int(sys.float_info.max)
Given = Value | Iterable[Value]


class Sweep(NamedTuple):
    """Results of all runs, a table with a line for each, the files, and sentences on how the runs ended."""

    results: list[RunResult]
    table: StudyTable
    files: list[Path]
    summary: list[str]


def sweep(
    deck: str | Path,
    values: Mapping[str, Given],
    *,
    quantities: Iterable[str] = DEFAULTS,
    stop: Iterable[str] = (),
    every: int = EVERY,
    limit: float | None = None,
    build: str = DEFAULT_SCHEME,
    constitutive: Iterable[str] = (),
    out: str | Path | None = None,
    jobs: int | None = None,
    dask: str = "",
    stream: TextIO | None = None,
) -> Sweep:
    """Run a deck for all combinations of values of its variables: a folder and a line of a table each.

    A run that fails is a result. Ctrl-C leaves the table of the completed runs.

    Parameters
    ----------
    deck
        A path or a text.
    values
        Of the variables of the deck, by name: a number or word, several, or a text such as "0.3:0.9:7".
    quantities, stop, every, limit, build, constitutive
        Of each run (StudyRun); the limit is in s.
    out
        Folder of all files, by default NAME-sweep; results that it contains are used if their input is the
        same.
    jobs, dask
        Processes, or the address of a cluster (WorkerPool).
    stream
        Shows the progress.

    Returns
    -------
    Sweep
        `results`, `table` (a column for each variable and quantity), `files` and `summary`.

    Raises
    ------
    ValueError
        For wrong arguments.
    UdecError
        7 and 10 for variables of the deck, 31 if a file cannot be written, is not of the program, would be
        written by two runs, or is in use by another study.

    Examples
    --------
    >>> deck = "START\\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=$F\\nBLOCK 0,0 0,1 1,1 1,0\\nSTOP\\n"
    >>> found = udec_ia.sweep(deck, {"F": [0.3, 0.6]}, quantities=["n = count block"], jobs=0)
    >>> found.table.column("F"), found.table.column("n")
    ([0.3, 0.6], [1.0, 1.0])
    """
    text, file = _deck(deck)
    stem = Path(file).stem if file else "deck"
    folder = Path(f"{stem}-sweep" if out is None else out)
    base, points, asked = folder / stem, grid(values), tuple(quantities)
    Variables(points[0]).check(text.splitlines(), file or "text")
    laws, rules = tuple(constitutive), tuple(stop)
    run = StudyRun(stem, text, file, points[0], asked, build, laws, rules, every, limit)
    if asked == DEFAULTS and any(run.calls("fos")):
        run = replace(run, quantities=(*asked, OF_SAFETY))
    names = [*read_quantities(run.quantities)]
    _check_names(points[0], names)
    runs = [replace(run, name=folder_name(point) or stem, values=point) for point in points]
    axes = picture_axes(points, names)
    check_outputs(base)
    progress = StudyProgress(stream or io.StringIO(), len(runs))

    def write(results: list[RunResult]) -> Sweep:
        table = StudyTable.of(results)
        for path in output_paths(base)[1:]:  # an earlier picture would show other runs than the table
            path.unlink(missing_ok=True)
        files = [table.write(base)]
        files += draw_table(table, axes, names, stem, base) if axes else []
        return Sweep(results, table, files, [*progress.summary, *summarise_warnings(results, LOG)])

    pool = WorkerPool(folder, jobs=processes(jobs, runs), dask=dask)
    try:
        with pool:
            return write(pool.results(runs, progress.show))
    except KeyboardInterrupt as interrupt:  # the processes have ended: no result follows
        with suppress(Exception):
            found = (kept_result(run, pool.folder)[0] for run in runs)
            write([one for one in found if one is not None])
        raise type(interrupt)(str(folder)) from None


def folder_name(values: Mapping[str, Value]) -> str:
    """The name of the folder of a run with these values, "" if there are none."""
    name = ",".join(f"{variable}={value}" for variable, value in values.items())
    if len(name) <= LONGEST:
        return name
    return f"{name[:LONGEST]}~{hashlib.sha256(name.encode()).hexdigest()[:12]}"


def summarise_warnings(results: Iterable[RunResult], log: str) -> list[str]:
    """A few lines on the most frequent warnings, alike but for their numbers. log: the file with all."""
    runs = [*results]
    first: dict[str, str] = {}
    given = Counter[str]()
    for run in runs:
        kinds = {NUMBER.sub("#", text): text for text in reversed(run.warnings)}
        given.update([*kinds])
        first = {kind: f"{text} ({run.name}, in {log})" for kind, text in kinds.items()} | first
    found = [
        printable(f"warning in {many} of {counted(len(runs), 'run')}: {first[kind]}", MESSAGE)
        for kind, many in given.most_common(SHOWN)
    ]
    if len(given) > SHOWN:
        found.append(f"{counted(len(given) - SHOWN, 'other warning')}: see warnings in the table, and {log}")
    return found


def _check_names(point: Mapping[str, Value], quantities: list[str]) -> None:
    """ValueError if a column of the table would have the name of another."""
    taken = ["run", *point, *BEHIND]
    for name in quantities:
        if name in taken:
            raise ValueError(f"the table has another column {name}: give the quantity a name, as in X={name}")


def _deck(deck: str | Path) -> tuple[str, str]:
    """The text of a deck and its name, "" if it is given as text."""
    if isinstance(deck, Path) or os.path.isfile(deck) or names_a_file(deck):
        return read_deck(Path(deck)), Path(deck).name
    check_deck_text(deck, "the deck")
    return deck, ""


def values_of(name: str, given: Given) -> list[Value]:
    """The values of the variable `name`: one, several, or a text as above. ValueError for wrong ones."""
    if not (isinstance(name, str) and NAME.fullmatch(name)):
        raise ValueError(f"{name!r} is not the name of a variable: use a letter, then letters, digits and _")
    found: list[Value]
    if isinstance(given, str):
        texts = [part.strip() for part in given.split(",")]
        found = _range(name, given) if ":" in given else [_read(text) for text in texts]
    else:
        several = given if isinstance(given, Iterable) else [given]
        found = [one.item() if hasattr(one, "item") else one for one in several]
    if any(isinstance(one, int) and abs(one) > GREATEST for one in found):
        raise ValueError(f"{name} cannot be greater than {float(GREATEST):.2g}, which no real number is")
    try:
        spellings = [spelt(name, value) for value in found]
    except UdecError as error:
        raise ValueError(f"{error.detail}: {error.advice}") from error
    if not found:
        raise ValueError(f"{name} has no value")
    seen: set[Value] = set()
    for value, spelling in zip(found, spellings, strict=True):
        if value in seen or spelling in seen:  # 1000000 and 1e6 are one
            raise ValueError(f"{name} has the value {spelling} twice")
        seen |= {value, spelling}
    return found


def grid(values: Mapping[str, Given]) -> list[dict[str, Value]]:
    """All combinations of the values of several variables, the last of which changes first."""
    columns = [values_of(name, given) for name, given in values.items()]
    names = [name.upper() for name in values]
    if len({*names}) < len(names):
        raise ValueError(f"a variable is given twice: {', '.join(names)}")
    return [dict(zip(names, row, strict=True)) for row in product(*columns)]


def _range(name: str, text: str) -> list[Value]:
    first, *others = (part.strip() for part in text.split(":"))
    how = others.pop() if len(others) == 3 else ""
    try:
        last, number = others
        a, b, n = Fraction(first), Fraction(last), int(number)
        float(a), float(b)
    except (ValueError, OverflowError):
        raise ValueError(f"{name}={text}: {FORM}") from None
    if how not in ("", "log"):
        raise ValueError(f"{name}={text}: {how!r} is not a kind of range (log is one); {FORM}")
    if not 2 <= n <= VALUE_COUNT:
        raise ValueError(f"{name}={text}: a range has 2 to {VALUE_COUNT} values, not {n}")
    if how == "log":
        if not (a > 0 and b > 0):
            raise ValueError(f"{name}={text}: a logarithmic range begins and ends above 0")
        ends = float(a), float(b)
        inner = (ends[0] * (ends[1] / ends[0]) ** (k / (n - 1)) for k in range(1, n - 1))
        return [ends[0], *(float(f"{value:.{DIGITS}g}") for value in inner), ends[1]]
    steps = [a + (b - a) * k / (n - 1) for k in range(n)]
    is_whole = isinstance(_read(first), int) and isinstance(_read(last), int)
    whole = is_whole and all(step.denominator == 1 for step in steps)
    return [int(step) if whole else float(step) for step in steps]


def _read(text: str) -> Any:
    """A number as such, anything else as it is."""
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text
