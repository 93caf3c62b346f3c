"""The command that says what is in a restart file, and what the facilities cost that its state uses.

udec info FILE        udec info FILE --cost
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, file, seconds

if TYPE_CHECKING:
    from udec_ia.reader.listing import Listing, Tables

VERBS = ("info",)
SCRIPT = """\
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


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    text = "show what is in a restart file, which facilities its state uses, and what has no effect"
    parser = command(commands, "info", text, _look, _script)
    file(parser)
    parser.add_argument("--cost", action="store_true", help="measure what each facility costs, on a copy")
    parser.add_argument("--budget", metavar="TIME", help="time for measuring, as in 60s or 5m (default: 20s)")
    parser.add_argument(
        "--constitutive", action="append", metavar="LAW", help="laws that the state was calculated with"
    )


def _look(args: argparse.Namespace) -> Listing | Tables:
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
    from udec_ia.errors import UdecError
    from udec_ia.facilities.facilities_in_use import facilities, facilities_without_effect
    from udec_ia.reader.listing import Listing, Tables
    from udec_ia.restart import info, look_into

    parts = {"file": Listing(info(args.file).splitlines())}
    try:
        array = look_into(args.file)
    except UdecError:  # its words are those of another program: said above
        return Tables(parts)
    return Tables(parts | {"facilities": facilities(array), "idle": facilities_without_effect(array)})


def _budget(args: argparse.Namespace) -> dict[str, float]:
    return {"seconds": seconds("--budget", args.budget)} if args.budget else {}


def _script(args: argparse.Namespace) -> str:
    if not args.cost:
        return SCRIPT.format(file=str(args.file))
    laws = f", {args.constitutive!r}" if args.constitutive else ""
    given = "".join(f", {name}={value!r}" for name, value in _budget(args).items())
    return COST.format(file=str(args.file), laws=laws, seconds=given)
