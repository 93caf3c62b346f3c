"""The heap workshop on the command line: to look into a restart file, sound or not, word by word.

    udec what FILE 412        udec who FILE 412        udec walk FILE block 88        udec junk FILE

Each command is one function of inspect/look/, which works the same on a model that runs; --python prints how
to call it. The commands change nothing.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from udec_ia.inspect.look.atlas import Atlas
    from udec_ia.inspect.look.listing import Listing

ADDRESS: dict[str, Any] = {"type": int, "metavar": "ADDRESS", "help": "address of a word of IA()"}
MISUSE = 2


def add_commands(commands: Any) -> None:
    """Add the workshop's commands to those of `udec`."""
    what = _command(commands, "what", "say what a word is, and show the group that it is part of")
    what.add_argument("address", **ADDRESS)
    who = _command(commands, "who", "list all words that point to the group of a word")
    who.add_argument("address", **ADDRESS)
    walk = _command(commands, "walk", "follow a list: block, contact, ..., block ADDRESS, KR ADDRESS, ...")
    walk.add_argument("along", metavar="LIST", help="kind of group, or the field that links the list")
    walk.add_argument("start", nargs="?", **ADDRESS)
    _command(commands, "junk", "say how full the memory is: kinds of groups, junk by sizes, lost words")


def _command(commands: Any, name: str, text: str) -> argparse.ArgumentParser:
    parser: argparse.ArgumentParser = commands.add_parser(name, help=text)
    parser.add_argument("file", type=Path, help="a restart file")
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--python", action="store_true", help="print the same in Python, and do nothing")
    parser.set_defaults(action=_look, look=name)
    return parser


def _look(args: argparse.Namespace) -> int:
    numbers = [value for key in ("along", "address", "start") if (value := vars(args).get(key)) is not None]
    given = ", ".join(map(repr, numbers))
    if args.python:
        print(
            "from udec_ia.inspect.look import Atlas, "
            f"{args.look}\nfrom udec_ia.restart import look_into\n\n"
            f"atlas = Atlas(look_into({str(args.file)!r}).h)  # of a model: Atlas(model.h)\n"
            f"print({args.look}(atlas{', ' if given else ''}{given}).as_text())"
        )
        return 0
    from udec_ia.inspect import look
    from udec_ia.restart import look_into

    function: Callable[..., Listing] = getattr(look, args.look)
    atlas: Atlas = look.Atlas(look_into(args.file).h)
    try:
        listing = function(atlas, *numbers)
    except (IndexError, ValueError) as error:
        print(f"udec {args.look}: {error}", file=sys.stderr)
        return MISUSE
    print(listing.as_json() if args.json else listing.as_text(), end="\n" if args.json else "")
    return 0
