"""`udec sweep DECK --set F=0.3:0.9:20`: run a deck for many values of its variables."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, given, seconds, study_options
from udec_ia.printable_text import counted

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing

VERBS = ("sweep",)
TEXT = "run a deck for all combinations of values of its variables: a table with a row for each run"
SHOWN = ("status", "cycles", "seconds", "warnings", "message")  # columns printed beside the others


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "sweep", TEXT, _sweep, _script)
    parser.add_argument("deck", type=Path, metavar="DECK", help="file of commands with variables ($F)")
    for option, metavar, text in (
        ("--set", "NAME=VALUES", "values of a variable: 0.3:0.9:20, 1e6:1e9:4:log, or 0.1,0.2"),
        ("--stop", "RULE", 'a run ends when this holds, as in "max block.KXD > 1"'),
    ):
        parser.add_argument(option, action="append", default=[], metavar=metavar, help=f"{text}; repeatable")
    study_options(parser, "column of the table", "NAME-sweep")
    text = "cycles from one check of the rules to the next (default: 100)"
    parser.add_argument("--every", type=int, metavar="N", help=text)
    text = "processor time after which a run is ended: 60s, 5m, 1h"
    parser.add_argument("--limit", metavar="TIME", help=text)
    parser.add_argument("--dask", default="", metavar="ADDRESS", help="run on the workers of this scheduler")


def _sweep(args: argparse.Namespace) -> Listing:
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.study_run import DIED, ERROR
    from udec_ia.studies.sweep import grid, sweep

    values, options = given(args.set), _options(args)
    stream = sys.stderr if args.json else sys.stdout
    counts = [f"{len(grid({name: text}))} of {name}" for name, text in values.items()]
    of = ", ".join(counts) or "the deck as it is"
    print(f"{counted(len(grid(values)), 'run')}: {of}", file=stream, flush=True)
    found = sweep(args.deck, values, stream=stream, **options)
    shown = {*values, *SHOWN, *(name for result in found.results for name in result.quantities)}
    columns = [name for name in found.table.columns if name in shown]
    rows = zip(*(found.table.column(name) for name in columns), strict=True)
    written = f"written: {', '.join(str(path) for path in found.files)}"
    failed = all(result.status in (ERROR, DIED) for result in found.results)
    return Listing([*found.summary, written], tuple(columns), [*rows], status=int(failed))


def _options(args: argparse.Namespace) -> dict[str, Any]:
    """What `sweep` is given, but for what it takes by itself."""
    names = ("stop", "every", "build", "constitutive", "out", "jobs", "dask")
    options: dict[str, Any] = {name: getattr(args, name) for name in names}
    options["quantities"] = args.quantity
    options["limit"] = None if args.limit is None else seconds("--limit", args.limit)
    return {name: value for name, value in options.items() if value not in (None, [], "")}


def _script(args: argparse.Namespace) -> str:
    options = "".join(
        f", {name}={str(value) if isinstance(value, Path) else value!r}"
        for name, value in _options(args).items()
    )
    return (
        "from udec_ia import sweep\n\n"
        f"found = sweep({str(args.deck)!r}, {given(args.set)!r}{options})\n"
        "print(found.table.columns)"
    )
