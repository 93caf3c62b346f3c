"""The command that compares two restart files.

udec diff FILE OTHER --only contact.KCFN --tolerance m=1e-6 N/m=1 --limit 50
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, file
from udec_ia.errors import UdecError

if TYPE_CHECKING:
    from udec_ia.reader.listing import Listing, Tables

VERBS = ("diff",)
TEXT = "compare two restart files by meaning; exit status 0 if nothing differs, 1 if something does"


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = command(commands, "diff", TEXT, _diff, _script)
    file(parser)
    file(parser, "other")
    parser.add_argument("--raw", action="store_true", help="compare words by address")
    parser.add_argument(
        "--only",
        nargs="+",
        metavar="KIND.FIELD",
        help="compare only these: contact, contact.KCFN, common.FRAC",
    )
    parser.add_argument(
        "--tolerance",
        nargs="+",
        metavar="UNIT=NUMBER",
        help="ignore smaller differences: m=1e-6, N/m=1, relative=1e-9, ulp=4",
    )
    parser.add_argument(
        "--limit",
        type=int,
        metavar="N",
        help="rows of a table to show (default: 20)",
    )


def _given(args: argparse.Namespace) -> dict[str, Any]:
    """What the function of the library is given beside the states."""
    if args.raw and (args.only or args.tolerance):
        raise ValueError("--raw compares all words, bit by bit: give it without --only and --tolerance")
    named = {
        name: vars(args)[name] for name in ("only", "tolerance", "limit") if vars(args)[name] is not None
    }
    return named | {"called": _called(args)}


def _called(args: argparse.Namespace) -> tuple[str, str]:
    """Names of the files, by which they can be told apart."""
    from udec_ia.printable import printable

    names = args.file.name, args.other.name
    one, two = names if names[0] != names[1] else (str(args.file), str(args.other))
    return printable(one), printable(two)


def _diff(args: argparse.Namespace) -> Listing | Tables:
    from udec_ia.heap_tools.comparison_report import diff, raw
    from udec_ia.restart import read_stored_state

    given = _given(args)
    try:
        seen = [read_stored_state(path) for path in (args.file, args.other)]
    except UdecError as error:
        raise ValueError(str(error)) from error
    found = (raw if args.raw else diff)(seen[0].array, seen[1].array, **given)
    said = [f"{name}: {text}" for one, name in zip(seen, given["called"], strict=True) for text in one.notes]
    return found.with_said(said)


def _script(args: argparse.Namespace) -> str:
    module, function = ("word_comparison", "raw") if args.raw else ("comparison_report", "diff")
    named = "".join(f", {name}={value!r}" for name, value in _given(args).items())
    return (
        f"from udec_ia.heap_tools.{module} import {function}\nfrom udec_ia.restart import look_into\n\n"
        f"one = look_into({str(args.file)!r})  # of a model: model.array\n"
        f"two = look_into({str(args.other)!r})\n"
        f"print({function}(one, two{named}).as_text(), end='')"
    )
