"""The command that runs two decks, word schemes or states side by side, and finds where they differ first.

udec diverge DECK OTHER        udec diverge DECK --builds i32r64,i32r32
udec diverge A.h5 B.h5 --cycles 500
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from udec_ia.command_line.command_options import command, given, variables
from udec_ia.errors import UdecError
from udec_ia.printable_text import counted, printable

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.divergence import Divergence, SteppedRun

VERBS = ("diverge",)
TEXT = "run two decks, word schemes or restart files side by side, and find where they differ first"
COLUMNS = ("group", "field", "first", "second", "share")


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "diverge", TEXT, _diverge, _script)
    parser.add_argument("file", type=Path, metavar="DECK", help="a deck, or with --cycles a restart file")
    parser.add_argument(
        "other", type=Path, nargs="?", metavar="OTHER", help="the other one (default: the same deck)"
    )
    variables(parser)
    for option, metavar, text in (
        ("--other-set", "NAME=VALUE", "value for the second run, if it is another"),
        ("--constitutive", "LAW", "as for udec run"),
        ("--other-constitutive", "LAW", "laws of the second run, if they are others"),
    ):
        parser.add_argument(option, action="append", default=[], metavar=metavar, help=text)
    for option, kind, metavar, text in (
        ("--builds", str, "A,B", "word schemes of the two decks (default: i32r64)"),
        ("--cycles", int, "N", "continue from two restart files for this many cycles"),
        ("--tolerance", float, "SHARE", "ignore differences up to this share of the greatest of the unit"),
    ):
        parser.add_argument(option, type=kind, metavar=metavar, help=text)
    text = "files for the two states after that cycle (default: DECK-first.h5 and DECK-second.h5 here)"
    parser.add_argument("--keep", nargs=2, type=Path, metavar=("A.h5", "B.h5"), help=text)


class _Input(NamedTuple):
    """The input of one of the two runs."""

    path: str
    build: str
    laws: list[str] | None
    values: dict[str, str]


def _inputs(args: argparse.Namespace) -> list[_Input]:
    """The input of both runs. ValueError for wrong arguments."""
    from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME

    if args.cycles is None:
        others = args.other, args.builds, args.other_constitutive, args.other_set
        if not any(others):
            raise ValueError(
                "give a second deck, --builds A,B, --other-set NAME=VALUE or --other-constitutive LAW"
            )
    elif args.builds or args.other is None or args.cycles < 0 or args.set or args.other_set:
        raise ValueError(
            "--cycles N, of 0 or more, takes two restart files and no --builds or --set: the files have these"
        )
    builds = args.builds.split(",") if args.builds else [DEFAULT_SCHEME] * 2
    if len(builds) != 2 or not {*builds} <= {*ALL_SCHEMES}:
        raise ValueError(f"--builds {args.builds}: give two of {', '.join(ALL_SCHEMES)}, as in i32r64,i32r32")
    if args.tolerance is not None and not args.tolerance >= 0:
        raise ValueError(f"--tolerance {args.tolerance}: give a share, 0 or more")
    paths = args.file, args.other or args.file
    laws = args.constitutive or None, args.other_constitutive or args.constitutive or None
    values = given(args.set), given(args.set) | given(args.other_set)
    return [*map(_Input, map(str, paths), builds, laws, values)]


def _run(one: _Input, cycles: int | None, out: str) -> SteppedRun:
    """A run whose files go to the folder `out`."""
    from udec_ia.model import Model
    from udec_ia.studies.divergence import of_deck
    from udec_ia.studies.study_run import read_deck

    path = Path(one.path)
    if cycles is not None:
        return of_deck(Model.restore(path, out=out, constitutive=one.laws), f"CYCLE {cycles}", "")
    model = Model(build=one.build, out=out, name=path.stem, constitutive=one.laws)
    return of_deck(model, read_deck(path), path.name, one.values, (Path(), path.parent))


def _diverge(args: argparse.Namespace) -> Listing:
    """Files of the decks go to temporary folders. What ends a run is a ValueError: exit status 2."""
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.divergence import compare_settings, find_divergence, take_first_states

    inputs = _inputs(args)
    with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
        try:
            runs = [_run(one, args.cycles, out) for one, out in zip(inputs, (first, second), strict=True)]
            states, runs = take_first_states(*runs)
            settings = compare_settings(states[0], states[1], args.tolerance) if states[1:] else []
            found = find_divergence(runs[0], runs[1], args.tolerance)
        except OSError as error:
            raise ValueError(f"{printable(str(error.filename))}: {error.strerror}") from error
        except UdecError as error:
            raise ValueError(str(error)) from error
        rows: list[tuple[Any, ...]] = [tuple(one) for one in settings]
        before = [f"before any cycle they differ in {counted(len(rows), 'variable')}"] if rows else []
        if isinstance(found, int):
            none = f"no {'other ' if rows else ''}difference in {counted(found, 'cycle')}"
            return Listing([*before, none], COLUMNS, rows, 1 if rows else 0)
        files = " and ".join(printable(str(path)) for path in _keep(args, runs, found))
        head = [*before, _place(found), f"saved: both states after it, {files}"]
        return Listing(head, COLUMNS, [*rows, tuple(found.off)], 1)


def _place(found: Divergence) -> str:
    """Where the runs differ first, as a sentence."""
    when = f"in cycle {found.cycle}"
    if not found.in_pass:
        by = "by commands" if found.line else "before any of these"
        when = f"after {counted(found.cycle, 'cycle')}, {by}"
    where = f", after the pass {found.in_pass}" if found.in_pass else ""
    line = f" of {printable(found.line)}" if found.line else ""
    return f"they differ first {when}{line}{where}"


def _keep(args: argparse.Namespace, runs: list[SteppedRun], found: Divergence) -> list[Path]:
    """Write both states; into the current folder, as `udec run` does."""
    paths = args.keep or [Path(f"{args.file.stem}-{which}.h5") for which in ("first", "second")]
    for path, run, state in zip(paths, runs, found.states, strict=True):
        run.model.session.return_to(state, run.model.session.log.lines)
        run.model.save(path.absolute(), force=True)
    return [*paths]


def _script(args: argparse.Namespace) -> str:
    if args.cycles is None:
        made = "of_deck(Model(build=build, constitutive=laws), Path(path).read_text(), path, values)"
    else:
        made = f"of_deck(Model.restore(path, constitutive=laws), 'CYCLE {args.cycles}', '')"
    return (
        "from pathlib import Path\n\nfrom udec_ia import Model\n"
        "from udec_ia.studies.divergence import find_divergence, compare_settings\n"
        "from udec_ia.studies.divergence import take_first_states, of_deck\n\n"
        f"given = {[tuple(one) for one in _inputs(args)]}\n"
        f"runs = [{made} for path, build, laws, values in given]\n"
        "states, runs = take_first_states(*runs)\n"
        f"for one in compare_settings(*states, {args.tolerance}) if states[1:] else []:\n"
        "    print(*one)\n"
        f"found = find_divergence(*runs, {args.tolerance})\n"
        "print(found if isinstance(found, int) else (found.cycle, found.in_pass, found.line, *found.off))"
    )
