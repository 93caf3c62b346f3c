"""Commands that look into one restart file.

udec what FILE 412        udec dump FILE 412-500    udec find FILE 'block where KXD > 0.1'
udec who FILE block@88    udec junk FILE            udec map FILE --out map.png
udec walk FILE block 88                             udec graph FILE 412 --depth 2 --out graph.svg
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from importlib import import_module
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from udec_ia.command_line.command_options import command, file

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing

VERBS = ("what", "who", "walk", "junk", "dump", "find", "map", "graph")
PLACE: dict[str, Any] = {
    "metavar": "PLACE",
    "help": "an address, or a name as in block@88.KXD",
}
OUT: dict[str, Any] = {"metavar": "PICTURE", "help": "file to draw to, .png or .svg"}
LIMIT: dict[str, Any] = {"type": int, "metavar": "N", "help": "show so many rows at most"}


class Call(NamedTuple):
    """The function of the library that does the work of a command, and what it is given after its subject."""

    module: str
    function: str
    given: tuple[Any, ...] = ()
    named: dict[str, Any] = {}  # noqa: RUF012  never changed
    subject: str = "atlas"  # or the whole "array"

    def on(self, path: Path) -> Listing:
        """What it finds in a restart file."""
        from udec_ia.reader.word_map import Atlas
        from udec_ia.restart import look_into

        array = look_into(path)
        function: Callable[..., Listing] = getattr(import_module(f"udec_ia.{self.module}"), self.function)
        return function(Atlas(array.h) if self.subject == "atlas" else array, *self.given, **self.named)

    def script(self, path: Path) -> str:
        """The same in Python."""
        named = (f"{name}={_literal(one)}" for name, one in self.named.items())
        given = [self.subject, *map(_literal, self.given), *named]
        return (
            f"from udec_ia.{self.module} import {self.function}\nfrom udec_ia.reader.word_map import Atlas\n"
            f"from udec_ia.restart import look_into\n\n"
            f"array = look_into({str(path)!r})  # of a model: model.array\natlas = Atlas(array.h)\n"
            f"print({self.function}({', '.join(given)}).as_text(), end='')"
        )


def _place(text: str) -> int | str:
    """The argument PLACE: an integer, or text for udec_ia.reader.place_grammar."""
    return int(text) if re.fullmatch(r"[+-]?\d+", text) else text


def _literal(value: Any) -> str:
    """A value as Python reads it."""
    return f"float('{value}')" if isinstance(value, float) and not isfinite(value) else repr(value)


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    what = _look(
        commands, "what", "say what a word is, show the group that it is part of, and where it lies", _what
    )
    what.add_argument("place", type=_place, **PLACE)
    what.add_argument("--out", **OUT)
    who = _look(commands, "who", "list all words that point to the group of a word", _who)
    who.add_argument("place", type=_place, **PLACE)
    walk = _look(commands, "walk", "follow a list: block, contact, ..., block PLACE, KR PLACE, ...", _walk)
    walk.add_argument("along", metavar="LIST", help="kind of group, or the field that links the list")
    walk.add_argument("start", nargs="?", type=_place, **PLACE)
    walk.add_argument("--field", metavar="FIELD", help="show this field of each group that has it")
    walk.add_argument("--limit", **LIMIT)
    _look(commands, "junk", "say how full the memory is: kinds of groups, junk by sizes, lost words", _junk)
    _add_dump(commands)
    _add_find(commands)
    a_map = _look(
        commands, "map", "show the heap by kind of group, as text or as a picture beside the blocks", _map
    )
    a_map.add_argument("--out", **OUT)
    graph = _look(commands, "graph", "show the pointers around a group, as a list or as a picture", _graph)
    graph.add_argument("place", type=_place, **PLACE)
    graph.add_argument("--depth", type=int, default=1, metavar="N", help="pointers to follow (default: 1)")
    graph.add_argument("--out", metavar="PICTURE", help="file to draw to, .png, .svg or .dot")


def _add_dump(commands: Any) -> None:
    dump = _look(
        commands, "dump", "show words field by field: all, or PLACE, PLACE-PLACE, PLACE/WORDS", _dump
    )
    dump.add_argument(
        "words",
        nargs="?",
        metavar="WORDS",
        help="412, 412-500 (to 500), 412/20 (20 words), block@88 or common (default: all)",
    )
    form = dump.add_mutually_exclusive_group()
    form.add_argument("--raw", action="store_true", help="as DUMP of 1980 does: several words to a line")
    form.add_argument(
        "--radix",
        type=int,
        choices=(8, 10, 16),
        default=10,
        help="base in which words are shown (default: 10)",
    )


def _add_find(commands: Any) -> None:
    find = _look(
        commands, "find", "find groups by a condition, numbers by value, pointers by where they lead", _find
    )
    wanted = find.add_mutually_exclusive_group(required=True)
    wanted.add_argument("condition", nargs="?", help="such as 'block where KXD > 0.1 and KMAT == 2'")
    wanted.add_argument("--value", type=float, metavar="X", help="find all numbers that are X")
    wanted.add_argument("--points-to", type=_place, metavar="PLACE", help="find all pointers to this place")
    find.add_argument(
        "--tolerance",
        type=float,
        metavar="SHARE",
        help="share of X by which numbers may differ (default: 1e-6)",
    )
    find.add_argument("--limit", **LIMIT)


def _look(
    commands: Any, verb: str, text: str, call: Callable[[argparse.Namespace], Call]
) -> argparse.ArgumentParser:
    """A command that prints what a function of the library finds in FILE."""
    parser = command(
        commands, verb, text, lambda args: call(args).on(args.file), lambda args: call(args).script(args.file)
    )
    file(parser)
    return parser


def _named(args: argparse.Namespace, *names: str) -> dict[str, Any]:
    """Those of some options that were given."""
    return {name: vars(args)[name] for name in names if vars(args)[name] is not None}


def _what(args: argparse.Namespace) -> Call:
    if args.out is not None:
        return Call("output.place_picture", "draw", (args.place, args.out))
    return Call("heap_tools.heap_lookup", "what", (args.place,))


def _who(args: argparse.Namespace) -> Call:
    return Call("heap_tools.heap_lookup", "who", (args.place,))


def _walk(args: argparse.Namespace) -> Call:
    start = () if args.start is None else (args.start,)
    return Call("heap_tools.heap_lookup", "walk", (args.along, *start), _named(args, "field", "limit"))


def _junk(_: argparse.Namespace) -> Call:
    return Call("heap_tools.memory_use", "junk")


def _dump(args: argparse.Namespace) -> Call:
    from udec_ia.heap_tools.heap_dump import ALONE

    radix = {} if args.radix == 10 else {"radix": args.radix}
    if args.words == ALONE and not args.raw and not radix:
        return Call("heap_tools.heap_dump", "common")
    given = () if args.words is None else (args.words,)
    if args.raw:
        return Call("output.word_dump", "raw", given)
    return Call("heap_tools.heap_dump", "dump", given, radix)


def _find(args: argparse.Namespace) -> Call:
    limit = _named(args, "limit")
    if args.tolerance is not None and args.value is None:
        raise ValueError("--tolerance goes with --value")
    if args.value is not None:
        return Call("heap_tools.heap_search", "find_value", (args.value,), _named(args, "tolerance", "limit"))
    if args.points_to is not None:
        return Call("heap_tools.heap_search", "find_pointers", (args.points_to,), limit)
    return Call("heap_tools.heap_search", "find", (args.condition,), limit)


def _map(args: argparse.Namespace) -> Call:
    if args.out is None:
        return Call("heap_tools.memory_use", "heap_map")
    return Call("output.heap_picture", "draw", (args.out, args.file.name), subject="array")


def _graph(args: argparse.Namespace) -> Call:
    if args.out is None:
        return Call("heap_tools.pointer_graph", "graph", (args.place, args.depth))
    return Call("output.pointer_picture", "draw", (args.place, args.out, args.depth))
