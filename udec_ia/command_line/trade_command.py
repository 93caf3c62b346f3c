"""The command that measures what accuracy costs for a deck: `udec trade DECK`.

udec trade DECK        udec trade DECK --table --tolerance 1e-2
udec trade DECK --half-step        udec trade DECK --digits        udec trade DECK --levers round,zones
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, given, names, seconds, study_options, variables

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing, Tables
    from udec_ia.studies.setting_runner import Options, SettingRunner

VERBS = ("trade",)
TEXT = "find the cheapest time-step and word scheme that keep the results of a deck to a tolerance"
VALUES = (  # options with a value, and their defaults
    ("--tolerance", "1e-3", "SHARE", "greatest relative error, as 1e-3 or 0.1%% (default: 1e-3)"),
    ("--budget", "5m", "TIME", "time for all runs: 60s, 5m, 1h (default: 5m)"),
    ("--builds", None, "A,B", "word schemes to try (default: the one with 32-bit reals)"),
)
INSTEAD = (  # what to do instead
    ("--half-step", "only compare the deck with half its time-step (report 4.6)"),
    ("--digits", "show how many digits of each quantity the deck determines"),
    ("--blame", "the same, and the fields in which the other digits are lost"),
)


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "trade", TEXT, _trade, _script)
    parser.add_argument("deck", type=Path, metavar="DECK", help="file of commands")
    variables(parser)
    study_options(parser, "quantity that must be right", "NAME-trade")
    for option, default, metavar, text in VALUES:
        parser.add_argument(option, default=default, metavar=metavar, help=text)
    parser.add_argument("--table", action="store_true", help="print a line for each setting as well")
    what = parser.add_mutually_exclusive_group()
    for option, text in INSTEAD:
        what.add_argument(option, action="store_true", help=text)
    what.add_argument(
        "--levers", metavar="A,B", help="vary and refine the model instead: round,zones,stiffness,types"
    )
    parser.add_argument(
        "--runs", type=int, default=16, metavar="N", help="perturbed runs for --digits and --blame"
    )


def _trade(args: argparse.Namespace) -> Listing | Tables:
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies import accuracy_report as report
    from udec_ia.studies.accuracy_study import study_accuracy
    from udec_ia.studies.study_run import read_deck
    from udec_ia.studies.study_table import check_outputs

    if args.digits or args.blame:
        return _digits(args)
    if args.levers is not None:
        return _levers(args)
    base, options = _folder(args) / f"{args.deck.stem}-trade", _options(args)
    if not args.half_step:
        check_outputs(base)
    text, values = read_deck(args.deck), given(args.set)
    study = study_accuracy(text, args.deck.name, values, _folder(args), options, args.deck.parent)
    if args.half_step:
        return Listing(report.half_step(study), status=int(len(study.levels) < 2))
    if not study.rows:
        return Listing(report.answer(study), status=1)
    files = [report.study_table(study).write(base)]
    files += report.draw_costs(study, f"{args.deck.name}: what accuracy costs", base)
    lines = [*report.answer(study), f"written: {', '.join(map(str, files))}"]
    rows = report.table_rows(study) if args.table or args.json else []
    return Listing(lines, report.COLUMNS, rows)


def _runner(args: argparse.Namespace) -> SettingRunner:
    from udec_ia.studies.deck_rewriting import Deck
    from udec_ia.studies.setting_runner import SettingRunner
    from udec_ia.studies.study_run import read_deck

    deck = Deck(read_deck(args.deck), args.deck.name, given(args.set), args.deck.parent)
    return SettingRunner(deck, _options(args), _folder(args))


def _digits(args: argparse.Namespace) -> Listing | Tables:
    from udec_ia.reader.printed_listing import Listing, Tables
    from udec_ia.studies import significant_digits

    if args.runs < significant_digits.FEWEST:
        raise ValueError(f"--runs {args.runs}: give {significant_digits.FEWEST} or more")
    with _runner(args) as runner:
        found = significant_digits.measure_digits(runner, args.runs)
        if not found.results:
            return Listing(found.notes, status=1)
        listing = Listing(found.notes, significant_digits.COLUMNS, found.rows())
        if not args.blame:
            return listing
        line, rows = significant_digits.blame_fields(found)
        return Tables({"digits": listing, "blame": Listing([line], significant_digits.FIELD_COLUMNS, rows)})


def _levers(args: argparse.Namespace) -> Listing:
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.studies.model_levers import COLUMNS, LEVERS, vary_lever

    levers = names("--levers", args.levers, LEVERS)
    with _runner(args) as runner:
        why = runner.run_own_deck()
        if why:
            return Listing([why], status=1)
        found = [vary_lever(runner, lever) for lever in levers]
    notes, rows = ([one for part in parts for one in part] for parts in zip(*found, strict=True))
    return Listing(notes, COLUMNS, rows)


def _folder(args: argparse.Namespace) -> Path:
    return args.out or Path(f"{args.deck.stem}-trade")


def _options(args: argparse.Namespace) -> Options:
    from udec_ia.heap.word_scheme import ALL_SCHEMES
    from udec_ia.studies.setting_runner import QUANTITIES, Options

    return Options(
        quantities=tuple(args.quantity) or QUANTITIES,
        tolerance=_share(args.tolerance),
        budget=seconds("--budget", args.budget),
        build=args.build,
        builds=tuple(names("--builds", args.builds, ALL_SCHEMES)),
        constitutive=tuple(args.constitutive),
        jobs=args.jobs,
        half_step=args.half_step,
        stream=sys.stderr,
    )


def _share(text: str) -> float:
    """The share that is written as a number or in per cent. ValueError for a wrong one."""
    number, percent = text.strip().removesuffix("%"), text.strip().endswith("%")
    try:
        share = float(number) / (100 if percent else 1)
    except ValueError:
        share = math.nan
    if not 0 < share < math.inf:
        raise ValueError(f"--tolerance {text}: give a relative error above 0, as in 1e-3 or 0.1%")
    return share


def _script(args: argparse.Namespace) -> str:
    options = _options(args)
    where = f"{given(args.set)!r}, Path({str(_folder(args))!r}), options"
    return (
        "from pathlib import Path\n\n"
        "from udec_ia.studies.accuracy_report import answer\n"
        "from udec_ia.studies.accuracy_study import study_accuracy\n"
        "from udec_ia.studies.setting_runner import Options\n\n"
        f"options = Options({options.quantities!r}, {options.tolerance!r}, {options.budget!r})\n"
        f"deck = Path({str(args.deck)!r})\n"
        f"study = study_accuracy(deck.read_text(), deck.name, {where}, deck.parent)\n"
        "print(*answer(study), sep='\\n')"
    )
