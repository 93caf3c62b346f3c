"""Commands that report on restart files as a whole: their contents, their soundness, how two of them differ.

udec info FILE        udec info FILE --cost        udec check FILE
udec diff FILE OTHER --only contact.KCFN --tolerance m=1e-6 N/m=1 --limit 50
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command, file, options_given, seconds
from udec_ia.errors import UdecError
from udec_ia.printable_text import counted, printable

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing, Tables

VERBS = ("info", "check", "diff")


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    text = "show what is in a restart file, which facilities its state uses, and what has no effect"
    parser = call_command(commands, "info", text, _info)
    file(parser)
    parser.add_argument("--cost", action="store_true", help="measure what each facility costs, on a copy")
    parser.add_argument("--budget", metavar="TIME", help="time for measuring, as in 60s or 5m (default: 20s)")
    parser.add_argument(
        "--constitutive", action="append", metavar="LAW", help="laws that the state was calculated with"
    )
    text = "prove that a restart file holds a sound block system, or list all faults"
    file(call_command(commands, "check", text, _check))
    text = "compare two restart files by meaning; exit status 0 if nothing differs, 1 if something does"
    parser = call_command(commands, "diff", text, _diff)
    file(parser)
    file(parser, "other")
    parser.add_argument("--raw", action="store_true", default=None, help="compare words by address")
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
    parser.add_argument("--limit", type=int, metavar="N", help="rows of a table to show (default: 20)")


def _info(args: argparse.Namespace) -> Call:
    named = options_given(args, "constitutive")
    if args.budget:
        named["budget"] = seconds("--budget", args.budget)
    if named and not args.cost:
        raise ValueError("--budget and --constitutive go with --cost")
    function = "measure_costs" if args.cost else "describe_file"
    return Call(f"command_line.report_commands.{function}", (str(args.file),), named)


def _check(args: argparse.Namespace) -> Call:
    return Call("command_line.report_commands.check_file", (str(args.file),))


def _diff(args: argparse.Namespace) -> Call:
    named = options_given(args, "raw", "only", "tolerance", "limit")
    if args.raw and (args.only or args.tolerance):
        raise ValueError("--raw compares all words, bit by bit: give it without --only and --tolerance")
    return Call("command_line.report_commands.compare_files", (str(args.file), str(args.other)), named)


def measure_costs(
    path: str | Path, constitutive: Sequence[str] | None = None, budget: float = 20.0
) -> Listing:
    """What each facility of the state in a restart file costs; budget: seconds for measuring."""
    from udec_ia.facilities.facility_costs import costs
    from udec_ia.model import Model

    model = Model.restore(path, constitutive)
    return costs(model.array, model.session.laws, seconds=budget)


def describe_file(path: str | Path) -> Tables:
    """The header of a restart file, and which facilities its state uses, if its words can be read."""
    from udec_ia.facilities.facilities_in_use import facilities, facilities_without_effect
    from udec_ia.reader.printed_listing import Listing, Tables
    from udec_ia.restart import info, look_into

    parts = {"file": Listing(info(path).splitlines())}
    try:
        array = look_into(path)
    except UdecError:  # its words are those of another program, as `info` has reported
        return Tables(parts)
    return Tables(parts | {"facilities": facilities(array), "idle": facilities_without_effect(array)})


def check_file(path: str | Path) -> Listing:
    """All violations in a restart file, sound or not, and what was not checked."""
    from udec_ia.checker import check, unchecked_parts
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart import read_stored_state

    seen = read_stored_state(path)
    found = check(seen.array)
    many = counted(len(found), "violation")
    head = [f"{printable(str(path))}: {many if found else 'sound'}", *seen.notes]
    rows: list[tuple[Any, ...]] = [(one.invariant, one.message) for one in found]
    columns = "invariant", "what is wrong"
    return Listing([*head, *unchecked_parts(seen.array, found)], columns, rows, int(bool(found)))


def compare_files(first: str | Path, second: str | Path, raw: bool = False, **given: Any) -> Listing | Tables:
    """How the states in two restart files differ. given: as for comparison_report.diff.

    raw: word by word, by address. ValueError if one of them cannot be read.
    """
    from udec_ia.heap_tools import comparison_report
    from udec_ia.restart import read_stored_state

    try:
        one, two = read_stored_state(first), read_stored_state(second)
    except UdecError as error:
        raise ValueError(str(error)) from error
    names = Path(first).name, Path(second).name
    called = printable(names[0]), printable(names[1])
    if names[0] == names[1]:
        called = printable(str(first)), printable(str(second))
    compare = comparison_report.raw if raw else comparison_report.diff
    notes = [f"{name}: {text}" for seen, name in zip((one, two), called, strict=True) for text in seen.notes]
    found: Listing | Tables = compare(one.array, two.array, called=called, **given)
    return found.with_head(notes)
