"""A sweep: one deck, run for all combinations of values of its variables."""

from __future__ import annotations

import io
import os
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, TextIO

from udec_ia.deck.command_monitor import names_a_file
from udec_ia.deck.deck_statements import read_deck
from udec_ia.deck.deck_variables import Value, Variables
from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.study import standing
from udec_ia.study.holding import let_go
from udec_ia.study.keeping import kept
from udec_ia.study.many import RUNS, run_all
from udec_ia.study.obeying import LOG
from udec_ia.study.pictures import axes_of, draw, pictures_of
from udec_ia.study.progress import Told
from udec_ia.study.ranges import Given, grid
from udec_ia.study.reading import DEFAULTS, read
from udec_ia.study.runs import EVERY, Result, Run
from udec_ia.study.table import BEFORE, BEHIND, Table, files_of
from udec_ia.study.warned import warned

LONGEST = 120  # characters of the name of a folder


class Sweep(NamedTuple):
    """What a sweep gives. results: of all runs, in the order of the grid. table: a line for each.

    files: the table and its picture. said: sentences on what became of the runs and what they were warned of.
    """

    results: list[Result]
    table: Table
    files: list[Path]
    said: list[str]


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
    """Run `deck`, a path or a text, for all combinations of `values`: a folder and a line of a table each.

    values: of the variables of the deck, by name: a number or word, several, or a text such as "0.3:0.9:7"
    (ranges.py); without any there is one run, of the deck as it is. quantities, stop, every, limit (s),
    build, constitutive: of each run (runs.Run). out: folder of it all, by default NAME-sweep in the working
    directory; results that are there and made of the same are taken. jobs, dask: who runs it
    (many.run_all). stream: takes how it is going.
    A run that fails is a result. Raises ValueError for what is given wrongly, UdecError 7 and 10 for
    variables of the deck, 31 if something cannot be written, stands there and is not of the program, or is
    in use by another sweep: before any run, as far as it can be known. Ctrl-C leaves the table of what is
    done.
    """
    text, file = _read(deck)
    stem = Path(file).stem if file else "deck"
    folder = Path(f"{stem}-sweep" if out is None else out)
    base, points, asked = folder / stem, grid(values), tuple(quantities)
    names = [one.name for one in read(asked)]
    _check_names(points[0], names)
    Variables(points[0]).check(text.splitlines(), file or "text")
    laws, rules = tuple(constitutive), tuple(stop)
    run = Run(stem, text, file, {}, asked, build, laws, rules, every, limit)
    runs = [replace(run, name=name_of(point) or stem, values=point) for point in points]
    axes = axes_of(points, names)
    standing.check([*files_of(base), *(pictures_of(base) if axes else ())])
    earlier = standing.drawn_before(base)
    told = Told(stream or io.StringIO(), len(runs))

    def put(results: list[Result]) -> Sweep:
        table = Table.of(results, points[0], names)
        files = table.write(base, {"deck": text, "quantities": "\n".join(asked)})
        files += draw(table, axes, names, stem, base) if axes else []
        said = [*told.said, *warned(results, LOG), *_removed(earlier, files)]
        return Sweep(results, table, files, said)

    try:
        return put(run_all(runs, folder, jobs=jobs, dask=dask, told=told))
    except KeyboardInterrupt as interrupt:
        with suppress(Exception):
            put(_done(runs, folder, told.results))
        raise type(interrupt)(str(folder)) from None
    finally:
        told.close()
        let_go(folder / RUNS)


def _done(runs: list[Run], folder: Path, told: list[Result]) -> list[Result]:
    """The results that there are, in the order of the runs; some may have come without being told."""
    known = {one.name: one for one in told}
    found = (known.get(run.name) or kept(run, folder / RUNS)[0] for run in runs)
    return [one for one in found if one is not None]


def _removed(earlier: list[Path], files: list[Path]) -> list[str]:
    """Take away the pictures of an earlier sweep that are not of this one, and say so."""
    old = [path for path in earlier if path not in files]
    for path in old:
        path.unlink(missing_ok=True)
    return [f"removed, as of an earlier sweep: {', '.join(map(str, old))}"] if old else []


def name_of(values: Mapping[str, Value]) -> str:
    """The name of the folder of a run with these values, "" if there are none."""
    name = ",".join(f"{variable}={value}" for variable, value in values.items())
    if len(name) <= LONGEST:
        return name
    import hashlib

    return f"{name[:LONGEST]}~{hashlib.sha256(name.encode()).hexdigest()[:12]}"


def _check_names(point: Mapping[str, Value], quantities: list[str]) -> None:
    """ValueError if a column of the table would have the name of another."""
    taken = [*BEFORE, *point, *BEHIND]
    for name in quantities:
        if name in taken:
            raise ValueError(f"the table has another column {name}: give the quantity a name, as in X={name}")


def _read(deck: str | Path) -> tuple[str, str]:
    """The text of a deck and its name, "" if it is given as text."""
    if isinstance(deck, Path) or os.path.isfile(deck) or names_a_file(deck):
        return read_deck(deck), Path(deck).name
    return deck, ""
