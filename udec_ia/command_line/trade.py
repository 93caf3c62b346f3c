"""`udec trade DECK`: what accuracy costs, for this deck; with --digits, how many digits it determines."""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, given, seconds, variables, word_scheme
from udec_ia.deck.deck_statements import read_deck

if TYPE_CHECKING:
    from udec_ia.reader.listing import Listing, Tables
    from udec_ia.trade.shop import Options
    from udec_ia.trade.trade import Price

VERBS = ("trade",)
TEXT = "find the cheapest time-step and word scheme that keep the results of a deck to a tolerance"
REPEATED = (
    ("--quantity", "QUANTITY", 'quantity that must be right, as in "max contact.KCFN"'),
    ("--constitutive", "LAW", "as for udec run"),
)


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "trade", TEXT, _trade, _script)
    parser.add_argument("deck", type=Path, metavar="DECK", help="file of commands")
    variables(parser)
    for name, form, text in REPEATED:
        parser.add_argument(name, action="append", default=[], metavar=form, help=f"{text}; repeatable")
    parser.add_argument(
        "--tolerance", metavar="SHARE", help="greatest relative error, as 1e-3 or 0.1%% (default: 1e-3)"
    )
    parser.add_argument(
        "--budget", default="5m", metavar="TIME", help="time for all runs: 60s, 5m, 1h (default: 5m)"
    )
    word_scheme(parser)
    parser.add_argument(
        "--builds", metavar="A,B", help="word schemes to try (default: the one with 32-bit reals)"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for all files (default: NAME-trade)")
    parser.add_argument("--jobs", type=int, metavar="N", help="processes (default: one for each processor)")
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        "--half-step", action="store_true", help="only compare the deck with half its time-step (report 4.6)"
    )
    what.add_argument(
        "--digits", action="store_true", help="show how many digits of each quantity the deck determines"
    )
    what.add_argument(
        "--blame", action="store_true", help="the same, and the fields in which the other digits are lost"
    )
    what.add_argument(
        "--levers",
        metavar="A,B",
        help="vary and refine the model instead: round,zones,stiffness,types",
    )
    parser.add_argument(
        "--runs", type=int, metavar="N", help="perturbed runs for --digits and --blame (default: 16)"
    )


def _trade(args: argparse.Namespace) -> Listing | Tables:
    from udec_ia.reader.listing import Listing
    from udec_ia.study import standing
    from udec_ia.study.pictures import pictures_of
    from udec_ia.study.table import files_of
    from udec_ia.trade.report import COLUMNS, half_step, sentences, shown, without
    from udec_ia.trade.trade import trade

    if args.digits or args.blame:
        return _digits(args)
    if args.levers is not None:
        return _levers(args)
    if not args.half_step:
        standing.check([*files_of(_base(args)), *pictures_of(_base(args))])
    price = trade(
        _text(args), args.deck.name, given(args.set), _folder(args), _options(args), args.deck.parent
    )
    if args.half_step:
        if len(price.levels) < 2:
            return Listing([*price.said, *without(price)], status=1)
        return Listing(half_step(price))
    files = _files(price, args)
    written = [f"written: {', '.join(map(str, files))}"] if files else []
    return Listing([*sentences(price), *written], COLUMNS, shown(price), 0 if price.rows else 1)


def _text(args: argparse.Namespace) -> str:
    return read_deck(args.deck)


def _digits(args: argparse.Namespace) -> Listing | Tables:
    from udec_ia.reader.listing import Listing, Tables
    from udec_ia.trade import blame
    from udec_ia.trade.digits import COLUMNS, ENSEMBLE, measure

    runs, options = args.runs if args.runs is not None else ENSEMBLE, _options(args)
    if runs < 3:
        raise ValueError(f"--runs {runs}: give 3 or more")
    found = measure(
        _text(args), args.deck.name, given(args.set), _folder(args), options, runs, args.deck.parent
    )
    if not found.results:
        return Listing(found.said, status=1)
    listing = Listing(found.said, COLUMNS, found.rows())
    if not args.blame:
        return listing
    said, rows = blame.Blame(found).search()
    return Tables({"digits": listing, "blame": Listing(said, blame.COLUMNS, rows)})


def _levers(args: argparse.Namespace) -> Listing:
    from udec_ia.reader.listing import Listing
    from udec_ia.trade import model
    from udec_ia.trade.deck import Deck
    from udec_ia.trade.shop import Shop

    levers = _names("--levers", args.levers, model.LEVERS)
    deck = Deck(_text(args), args.deck.name, given(args.set), args.deck.parent)
    shop = Shop(deck, _options(args), _folder(args))
    result = shop.look()
    if result.status != "ended" or not shop.survey:
        return Listing([f"the deck as it is gives nothing to compare: {result.message}"], status=1)
    found = [model.refine(shop, lever) for lever in levers]
    said, rows = ([one for part in parts for one in part] for parts in zip(*found, strict=True))
    return Listing(said, model.COLUMNS, rows)


def _files(price: Price, args: argparse.Namespace) -> list[Path]:
    from udec_ia.study.table import Table
    from udec_ia.trade.picture import draw
    from udec_ia.trade.report import COLUMNS, table

    rows = table(price)
    if not rows:
        return []
    base = _base(args)
    columns = dict(zip(("run", *COLUMNS[1:]), zip(*rows, strict=True), strict=True))
    files = Table(columns).write(base, {"deck": price.deck.text})
    return files + draw(price, f"{args.deck.name}: what accuracy costs", base)


def _folder(args: argparse.Namespace) -> Path:
    return args.out or Path(f"{args.deck.stem}-trade")


def _base(args: argparse.Namespace) -> Path:
    """What the names of the table and its pictures begin with."""
    return _folder(args) / f"{args.deck.stem}-trade"


def _options(args: argparse.Namespace) -> Options:
    from udec_ia.heap.word_scheme import ALL_SCHEMES
    from udec_ia.trade.shop import Options

    builds = tuple(_names("--builds", args.builds, ALL_SCHEMES))
    named: dict[str, Any] = {
        "quantities": tuple(args.quantity),
        "tolerance": _share(args.tolerance),
        "budget": seconds("--budget", args.budget),
        "build": args.build,
        "builds": builds,
        "constitutive": tuple(args.constitutive),
        "jobs": args.jobs,
        "half_step": args.half_step,
        "stream": sys.stderr,
    }
    return Options(**{name: value for name, value in named.items() if value not in (None, ())})


def _share(text: str | None) -> float | None:
    """The share that is written as a number or in per cent; None without one. ValueError for what is none."""
    if text is None:
        return None
    number, percent = text.strip().removesuffix("%"), text.strip().endswith("%")
    try:
        share = float(number) / (100 if percent else 1)
    except ValueError:
        share = math.nan
    if not 0 < share < math.inf:
        raise ValueError(f"--tolerance {text}: give a relative error above 0, as in 1e-3 or 0.1%")
    return share


def _names(option: str, text: str | None, known: Collection[str]) -> list[str]:
    """The names that are written one after the other; [] without the option. ValueError for unknown ones."""
    if text is None:
        return []
    names = [one.strip() for one in text.split(",")]
    for name in names:
        if name not in known:
            raise ValueError(f"{option} {name or repr(text)}: choose from {', '.join(known)}")
    return [*dict.fromkeys(names)]


def _script(args: argparse.Namespace) -> str:
    asked = f", quantities={tuple(args.quantity)!r}" if args.quantity else ""
    where = f"{given(args.set)!r}, Path({str(_folder(args))!r}), options"
    return (
        "from pathlib import Path\n\n"
        "from udec_ia.trade.report import sentences\n"
        "from udec_ia.trade.shop import Options\n"
        "from udec_ia.trade.trade import trade\n\n"
        f"options = Options(tolerance={_share(args.tolerance) or 1e-3!r}{asked})\n"
        f"deck = Path({str(args.deck)!r})\n"
        f"price = trade(deck.read_text(), deck.name, {where}, deck.parent)\n"
        "print(*sentences(price), sep='\\n')"
    )
