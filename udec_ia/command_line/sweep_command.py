"""`udec sweep DECK --set F=0.3:0.9:20`: run a deck for many values of its variables."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, given, seconds, word_scheme
from udec_ia.printable import counted

if TYPE_CHECKING:
    from udec_ia.reader.listing import Listing

VERBS = ("sweep",)
TEXT = "run a deck for all combinations of values of its variables: a table with a row for each run"
REPEATED = (
    (
        "--set",
        "NAME=VALUES",
        "values of a variable: 0.3:0.9:20 (first:last:number), 1e6:1e9:4:log, or 0.1,0.2",
    ),
    ("--quantity", "QUANTITY", 'column of the table, as in "force = max contact.KCFN"'),
    ("--stop", "RULE", 'a run ends when this holds, as in "max block.KXD > 1"'),
    ("--constitutive", "LAW", "as for udec run"),
)
SHOWN = ("status", "cycles", "seconds", "warnings", "message")  # columns printed beside the others


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "sweep", TEXT, _sweep, _script)
    parser.add_argument("deck", type=Path, metavar="DECK", help="file of commands with variables ($F)")
    for option, metavar, text in REPEATED:
        parser.add_argument(option, action="append", default=[], metavar=metavar, help=f"{text}; repeatable")
    parser.add_argument(
        "--every", type=int, metavar="N", help="cycles from one check of the rules to the next (default: 100)"
    )
    parser.add_argument(
        "--limit", metavar="TIME", help="processor time after which a run is ended: 60s, 5m, 1h"
    )
    word_scheme(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for all files (default: NAME-sweep)")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes (default: one for each processor)")
    parser.add_argument("--dask", default="", metavar="ADDRESS", help="run on the workers of this scheduler")


def _sweep(args: argparse.Namespace) -> Listing:
    from udec_ia.reader.listing import Listing
    from udec_ia.studies.study_run import DIED, ERROR
    from udec_ia.studies.sweep import grid, sweep

    values, options = given(args.set), _options(args)
    stream = sys.stderr if args.json else sys.stdout
    counts = [f"{len(grid({name: text}))} of {name}" for name, text in values.items()]
    of = ", ".join(counts) or "the deck as it is"
    print(f"{counted(len(grid(values)), 'run')}: {of}", file=stream, flush=True)
    found = sweep(args.deck, values, stream=stream, **options)
    columns = [
        name for name in found.table.columns if name in values or name in SHOWN or name in _asked(found)
    ]
    rows = zip(*(found.table.column(name) for name in columns), strict=True)
    written = f"written: {', '.join(str(path) for path in found.files)}"
    failed = all(result.status in (ERROR, DIED) for result in found.results)
    return Listing([*found.summary, written], tuple(columns), [*rows], status=int(failed))


def _asked(found: Any) -> set[str]:
    """Names of the quantities."""
    return {name for result in found.results for name in result.quantities}


def _options(args: argparse.Namespace) -> dict[str, Any]:
    """What `sweep` is given, but for what it takes by itself."""
    options: dict[str, Any] = {
        "quantities": args.quantity,
        "stop": args.stop,
        "every": args.every,
        "limit": None if args.limit is None else seconds("--limit", args.limit),
        "build": args.build,
        "constitutive": args.constitutive,
        "out": args.out,
        "jobs": args.jobs,
        "dask": args.dask,
    }
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
