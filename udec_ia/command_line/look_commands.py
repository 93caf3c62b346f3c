"""Commands that look into one restart file.

udec what FILE 412        udec dump FILE 412-500    udec find FILE 'block where KXD > 0.1'
udec who FILE block@88    udec junk FILE            udec map FILE --out map.png
udec walk FILE block 88                             udec graph FILE 412 --depth 2 --out graph.dot
udec telescope FILE block@88.KP -n 3
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command, file, options_given
from udec_ia.file_replacement import put_in_place

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.reader.word_map import Atlas

VERBS = ("what", "who", "walk", "junk", "dump", "find", "map", "graph", "telescope")
PLACE: dict[str, Any] = {
    "metavar": "PLACE",
    "help": "an address, or a name as in block@88.KXD or block@88.KP.KXP",
}
LIMIT: dict[str, Any] = {"type": int, "metavar": "N", "help": "show so many rows at most"}


def _place(text: str) -> int | str:
    """The argument PLACE: an integer, or text for udec_ia.reader.place_grammar."""
    return int(text) if re.fullmatch(r"[+-]?\d+", text) else text


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    text = "say what a word is, show the group that it is part of, and where it lies"
    _look(commands, "what", text, _what).add_argument("place", type=_place, **PLACE)
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
    text = "show the heap by kind of group, as text or as a picture beside the blocks"
    a_map = _look(commands, "map", text, _map)
    a_map.add_argument("--out", metavar="PICTURE", help="file to draw to, .png or .svg")
    graph = _look(commands, "graph", "show the pointers around a group, as a list or for Graphviz", _graph)
    graph.add_argument("place", type=_place, **PLACE)
    graph.add_argument("--depth", type=int, default=1, metavar="N", help="pointers to follow (default: 1)")
    graph.add_argument("--out", metavar="FILE", help="file for Graphviz, .dot")
    text = "follow the pointers of a group, and those of the groups that they lead to, some levels deep"
    telescope = _look(commands, "telescope", text, _telescope)
    telescope.add_argument("place", type=_place, **PLACE)
    telescope.add_argument("-n", dest="levels", type=int, metavar="LEVELS", help="levels (default: 2)")


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
    parser = call_command(commands, verb, text, lambda args: call(args)._replace(path=args.file))
    file(parser)
    return parser


def _what(args: argparse.Namespace) -> Call:
    return Call("heap_tools.heap_lookup.what", (args.place,))


def _who(args: argparse.Namespace) -> Call:
    return Call("heap_tools.heap_lookup.who", (args.place,))


def _walk(args: argparse.Namespace) -> Call:
    start = () if args.start is None else (args.start,)
    return Call("heap_tools.heap_lookup.walk", (args.along, *start), options_given(args, "field", "limit"))


def _junk(_: argparse.Namespace) -> Call:
    return Call("heap_tools.memory_use.junk")


def _dump(args: argparse.Namespace) -> Call:
    from udec_ia.heap_tools.heap_dump import ALONE

    radix = {} if args.radix == 10 else {"radix": args.radix}
    if args.words == ALONE and not args.raw and not radix:
        return Call("heap_tools.heap_dump.common")
    given = () if args.words is None else (args.words,)
    if args.raw:
        return Call("output.word_dump.raw", given)
    return Call("heap_tools.heap_dump.dump", given, radix)


def _find(args: argparse.Namespace) -> Call:
    named = options_given(args, "tolerance", "limit")
    if args.tolerance is not None and args.value is None:
        raise ValueError("--tolerance goes with --value")
    if args.value is not None:
        return Call("heap_tools.heap_search.find_value", (args.value,), named)
    if args.points_to is not None:
        return Call("heap_tools.heap_search.find_pointers", (args.points_to,), named)
    return Call("heap_tools.heap_search.find", (args.condition,), named)


def _map(args: argparse.Namespace) -> Call:
    if args.out is None:
        return Call("heap_tools.memory_use.heap_map")
    return Call("output.heap_picture.draw", (args.out, args.file.name), subject="array")


def _graph(args: argparse.Namespace) -> Call:
    if args.out is None:
        return Call("heap_tools.pointer_graph.graph", (args.place, args.depth))
    return Call("command_line.look_commands.write_dot", (args.place, args.out, args.depth))


def _telescope(args: argparse.Namespace) -> Call:
    return Call("heap_tools.pointer_graph.telescope", (args.place,), options_given(args, "levels"))


def write_dot(atlas: Atlas, place: int | str, out: str | Path, depth: int = 1) -> Listing:
    """Write the pointers around the group at a place to the file `out`, in the language of Graphviz.

    Raises as `pointer_graph.neighbourhood` does, and error 31 if the file cannot be written.
    """
    from udec_ia.heap_tools.pointer_graph import dot, neighbourhood, summary
    from udec_ia.reader.printed_listing import Listing

    found = neighbourhood(atlas, place, depth)
    put_in_place(Path(out), dot(found).encode(), force=False)
    return Listing([*summary(found), f"wrote {out}"])
