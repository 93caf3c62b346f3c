"""The command that runs two decks, word schemes or states side by side, and finds where they part.

udec diverge DECK OTHER        udec diverge DECK --builds i32r64,i32r32
udec diverge A.h5 B.h5 --cycles 500
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

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
    parser.add_argument("--builds", metavar="A,B", help="word schemes of the two decks (default: i32r64)")
    parser.add_argument("--constitutive", action="append", metavar="LAW", help="as for udec run")
    parser.add_argument(
        "--other-constitutive",
        action="append",
        metavar="LAW",
        help="laws of the second run, if they are others",
    )
    variables(parser)
    parser.add_argument(
        "--other-set",
        action="append",
        metavar="NAME=VALUE",
        help="value for the second run, if it is another",
    )
    parser.add_argument(
        "--cycles", type=int, metavar="N", help="continue from two restart files for this many cycles"
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        metavar="SHARE",
        help="ignore differences up to this share of the greatest number of the same unit",
    )
    parser.add_argument(
        "--keep",
        nargs=2,
        type=Path,
        metavar=("A.h5", "B.h5"),
        help="files for the two states after that cycle (default: DECK-first.h5 and DECK-second.h5, in the "
        "current folder)",
    )


def _builds(args: argparse.Namespace) -> list[str]:
    """The word schemes of the first and the second. ValueError for what is none."""
    from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME

    if args.cycles is not None and (
        args.builds or args.other is None or args.cycles < 0 or args.set or args.other_set
    ):
        raise ValueError(
            "--cycles N, of 0 or more, takes two restart files and no --builds or --set: the files have these"
        )
    others = args.builds or args.other_constitutive or args.other_set
    if args.cycles is None and args.other is None and not others:
        raise ValueError(
            "give a second deck, --builds A,B, --other-set NAME=VALUE or --other-constitutive LAW"
        )
    builds = args.builds.split(",") if args.builds else [DEFAULT_SCHEME] * 2
    if len(builds) != 2 or not {*builds} <= {*ALL_SCHEMES}:
        raise ValueError(f"--builds {args.builds}: give two of {', '.join(ALL_SCHEMES)}, as in i32r64,i32r32")
    if args.tolerance is not None and not args.tolerance >= 0:
        raise ValueError(f"--tolerance {args.tolerance}: give a share, 0 or more")
    return builds


def _laws(args: argparse.Namespace) -> tuple[list[str] | None, list[str] | None]:
    """Files of laws of the first and the second."""
    return args.constitutive, args.other_constitutive or args.constitutive


def _values(args: argparse.Namespace) -> tuple[dict[str, str], dict[str, str]]:
    """Values of the variables of the first and the second."""
    return given(args.set), given(args.set) | given(args.other_set or [])


def _run(
    args: argparse.Namespace,
    path: Path,
    build: str,
    laws: list[str] | None,
    values: dict[str, str],
    out: str,
) -> SteppedRun:
    from udec_ia.model import Model
    from udec_ia.studies.divergence import of_deck, of_state
    from udec_ia.studies.study_run import read_deck

    if args.cycles is not None:
        return of_state(Model.restore(path, out=out, constitutive=laws), args.cycles)
    model = Model(build=build, out=out, name=path.stem, constitutive=laws)
    return of_deck(model, read_deck(path), path.name, values, (Path(), path.parent))


def _diverge(args: argparse.Namespace) -> Listing:
    """What a deck writes goes to a folder that is taken away. An error of a run is trouble: ValueError."""
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.divergence import find_divergence

    builds, paths = _builds(args), (args.file, args.other or args.file)
    with tempfile.TemporaryDirectory() as first, tempfile.TemporaryDirectory() as second:
        try:
            each = zip(paths, builds, _laws(args), _values(args), (first, second), strict=True)
            runs = [_run(args, *one) for one in each]
            found = find_divergence(runs[0], runs[1], args.tolerance)
        except OSError as error:
            raise ValueError(f"{printable(str(error.filename))}: {error.strerror}") from error
        except UdecError as error:
            raise ValueError(str(error)) from error
        if isinstance(found, int):
            return Listing([f"no difference in {counted(found, 'cycle')}"])
        return Listing(_sentences(found, _keep(args, runs, found)), COLUMNS, [tuple(found.off)], 1)


def _sentences(found: Divergence, kept: list[Path]) -> list[str]:
    from udec_ia.printable_text import printable

    when = f"in cycle {found.cycle}"
    if not found.in_pass:
        by = "by commands" if found.line else "before any of these"
        when = f"after {counted(found.cycle, 'cycle')}, {by}"
    where = f", after the pass {found.in_pass}" if found.in_pass else ""
    line = f" of {printable(found.line)}" if found.line else ""
    names = " and ".join(printable(str(path)) for path in kept)
    return [f"they differ first {when}{line}{where}", f"kept: both states after it, {names}"]


def _keep(args: argparse.Namespace, runs: list[SteppedRun], found: Divergence) -> list[Path]:
    """Write both states; into the current folder, as `udec run` does."""
    paths = args.keep or [Path(f"{args.file.stem}-{which}.h5") for which in ("first", "second")]
    for path, run, state in zip(paths, runs, found.states, strict=True):
        run.model.session.return_to(state.array(), run.model.session.log.lines)
        run.model.save(path.absolute(), force=True)
    return [Path(path) for path in paths]


def _script(args: argparse.Namespace) -> str:
    builds, paths = _builds(args), [str(args.file), str(args.other or args.file)]
    if args.cycles is None:
        made = "of_deck(Model(build=build, constitutive=laws), Path(path).read_text(), path, values)"
    else:
        made = f"of_state(Model.restore(path, constitutive=laws), {args.cycles})"
    return (
        "from pathlib import Path\n\nfrom udec_ia import Model\n"
        "from udec_ia.studies.divergence import find_divergence, of_deck, of_state\n\n"
        f"given = zip({paths}, {builds}, {_laws(args)}, {_values(args)})\n"
        f"runs = [{made} for path, build, laws, values in given]\n"
        f"found = find_divergence(*runs, {args.tolerance})\n"
        "print(found if isinstance(found, int) else (found.cycle, found.in_pass, found.line, *found.off))"
    )
