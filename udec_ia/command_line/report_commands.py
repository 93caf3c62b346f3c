"""Commands that report on restart files as a whole: their contents, their soundness, how two of them differ.

udec info FILE        udec info FILE --cost        udec check FILE
udec diff FILE OTHER --only contact.KCFN --tolerance m=1e-6 N/m=1 --limit 50
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, file, seconds
from udec_ia.errors import UdecError
from udec_ia.printable_text import counted, printable

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing, Tables

VERBS = ("info", "check", "diff")
INFO = """\
from udec_ia.facilities.facilities_in_use import facilities
from udec_ia.facilities.facilities_in_use import facilities_without_effect
from udec_ia.restart import info, look_into

array = look_into({file!r})  # of a model: model.array
print(info({file!r}))
print(facilities(array).as_text() + facilities_without_effect(array).as_text(), end="")"""
COST = """\
from udec_ia import Model
from udec_ia.facilities.facility_costs import costs

model = Model.restore({file!r}{laws})
print(costs(model.array, model.session.laws{seconds}).as_text(), end="")"""
CHECK = """\
from udec_ia.checker import check, unjudged
from udec_ia.restart import read_stored_state

seen = read_stored_state({file!r})  # of a model: model.check()
found = check(seen.array)
print(*seen.notes, *(found or ["sound"]), *unjudged(seen.array, found), sep="\\n")"""


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    text = "show what is in a restart file, which facilities its state uses, and what has no effect"
    parser = command(commands, "info", text, _info, _info_script)
    file(parser)
    parser.add_argument("--cost", action="store_true", help="measure what each facility costs, on a copy")
    parser.add_argument("--budget", metavar="TIME", help="time for measuring, as in 60s or 5m (default: 20s)")
    parser.add_argument(
        "--constitutive", action="append", metavar="LAW", help="laws that the state was calculated with"
    )
    text = "prove that a restart file holds a sound block system, or list all faults"
    file(command(commands, "check", text, _check, lambda args: CHECK.format(file=str(args.file))))
    _add_diff(commands)


def _info(args: argparse.Namespace) -> Listing | Tables:
    if args.cost:
        from udec_ia.facilities.facility_costs import costs
        from udec_ia.model import Model

        model = Model.restore(args.file, args.constitutive)
        return costs(model.array, model.session.laws, **_budget(args))
    if args.budget or args.constitutive:
        raise ValueError("--budget and --constitutive go with --cost")
    return _known(args)


def _known(args: argparse.Namespace) -> Tables:
    """What the file says about itself, and what its words show, if they can be read here."""
    from udec_ia.facilities.facilities_in_use import facilities, facilities_without_effect
    from udec_ia.reader.printed_listing import Listing, Tables
    from udec_ia.restart import info, look_into

    parts = {"file": Listing(info(args.file).splitlines())}
    try:
        array = look_into(args.file)
    except UdecError:  # its words are those of another program: said above
        return Tables(parts)
    return Tables(parts | {"facilities": facilities(array), "idle": facilities_without_effect(array)})


def _budget(args: argparse.Namespace) -> dict[str, float]:
    return {"seconds": seconds("--budget", args.budget)} if args.budget else {}


def _info_script(args: argparse.Namespace) -> str:
    if not args.cost:
        return INFO.format(file=str(args.file))
    laws = f", {args.constitutive!r}" if args.constitutive else ""
    given = "".join(f", {name}={value!r}" for name, value in _budget(args).items())
    return COST.format(file=str(args.file), laws=laws, seconds=given)


def _check(args: argparse.Namespace) -> Listing:
    """All violations in a file, sound or not, and what was not judged."""
    from udec_ia.checker import check, unjudged
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart import read_stored_state

    seen = read_stored_state(args.file)
    found = check(seen.array)
    many = counted(len(found), "violation")
    said = [f"{printable(str(args.file))}: {many if found else 'sound'}"]
    rows: list[tuple[Any, ...]] = [(one.invariant, one.message) for one in found]
    return Listing(
        said + seen.notes + unjudged(seen.array, found),
        ("invariant", "what is wrong"),
        rows,
        int(bool(found)),
    )


def _add_diff(commands: Any) -> None:
    text = "compare two restart files by meaning; exit status 0 if nothing differs, 1 if something does"
    parser = command(commands, "diff", text, _diff, _diff_script)
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


def _diff_script(args: argparse.Namespace) -> str:
    function = "raw" if args.raw else "diff"
    named = "".join(f", {name}={value!r}" for name, value in _given(args).items())
    return (
        f"from udec_ia.heap_tools.comparison_report import {function}\n"
        "from udec_ia.restart import look_into\n\n"
        f"one = look_into({str(args.file)!r})  # of a model: model.array\n"
        f"two = look_into({str(args.other)!r})\n"
        f"print({function}(one, two{named}).as_text(), end='')"
    )
