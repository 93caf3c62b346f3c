"""Commands that look into one restart file.

udec what FILE 412        udec who FILE 412        udec walk FILE block 88        udec junk FILE
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from udec_ia.workshop.common import command, file

if TYPE_CHECKING:
    from udec_ia.inspect.look.listing import Listing

VERBS = ("what", "who", "walk", "junk")
ADDRESS: dict[str, Any] = {"type": int, "metavar": "ADDRESS", "help": "address of a word of IA()"}


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    what = _look(commands, "what", "say what a word is, and show the group that it is part of")
    what.add_argument("address", **ADDRESS)
    who = _look(commands, "who", "list all words that point to the group of a word")
    who.add_argument("address", **ADDRESS)
    walk = _look(commands, "walk", "follow a list: block, contact, ..., block ADDRESS, KR ADDRESS, ...")
    walk.add_argument("along", metavar="LIST", help="kind of group, or the field that links the list")
    walk.add_argument("start", nargs="?", **ADDRESS)
    _look(commands, "junk", "say how full the memory is: kinds of groups, junk by sizes, lost words")


def _look(commands: Any, verb: str, text: str) -> argparse.ArgumentParser:
    """A command that is the function of inspect/look/ of the same name."""

    def look(args: argparse.Namespace) -> Listing:
        from udec_ia.inspect import look
        from udec_ia.restart import look_into

        found: Listing = getattr(look, verb)(look.Atlas(look_into(args.file).h), *_given(args))
        return found

    def script(args: argparse.Namespace) -> str:
        given = "".join(f", {value!r}" for value in _given(args))
        return (
            f"from udec_ia.inspect.look import Atlas, {verb}\nfrom udec_ia.restart import look_into\n\n"
            f"atlas = Atlas(look_into({str(args.file)!r}).h)  # of a model: Atlas(model.h)\n"
            f"print({verb}(atlas{given}).as_text())"
        )

    parser = command(commands, verb, text, look, script)
    file(parser)
    return parser


def _given(args: argparse.Namespace) -> list[Any]:
    """The arguments after FILE that are there."""
    return [value for key in ("along", "address", "start") if (value := vars(args).get(key)) is not None]
