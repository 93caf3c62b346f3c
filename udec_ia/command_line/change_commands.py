"""Commands that make a new restart file out of one, sound or damaged.

udec convert FILE TO --build i64r64        udec renumber FILE TO        udec patch FILE TO 'FRAC = 0.1'

Deck, laws and recorded histories are copied, and the deck notes the change. TO is written as SAVE writes:
completely or not at all, and it may replace only a restart file, but never FILE itself. A state that has
become unsound is written only with --force.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command, file
from udec_ia.errors import UdecError
from udec_ia.printable_text import folded, printable

if TYPE_CHECKING:
    from udec_ia.checker import Violation
    from udec_ia.heap.main_array import MainArray
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart.restart_reader import Restored

VERBS = ("convert", "renumber", "patch")
MOVED = "addresses differ from here on"  # comment in the deck


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    from udec_ia.layout.field_table import SCHEMES

    parsers = [
        call_command(commands, verb, f"write a restart file {text}", partial(_call, verb))
        for verb, text in (
            ("convert", "in another word scheme"),
            ("renumber", "with its groups in the order of their lists"),
            ("patch", "with other values of some words"),
        )
    ]
    for parser in parsers:
        file(parser)
        parser.add_argument("to", type=Path, metavar="TO", help="the restart file to be written")
    converts, _, patches = parsers
    converts.add_argument(
        "--build", required=True, choices=SCHEMES, help="widths of integers and reals in bits"
    )
    patches.add_argument(
        "assignments",
        nargs="+",
        metavar="ASSIGNMENT",
        help="'block@88.KXD = 0', 'zone@9.KZG(2) = 412', 'FRAC = 0.1' or '1234 = 7'",
    )
    for parser in (converts, patches):
        parser.add_argument("--force", action="store_true", help="write it even if it is unsound")


def _call(verb: str, args: argparse.Namespace) -> Call:
    given = [args.build] if verb == "convert" else vars(args).get("assignments", [])
    named = {"force": True} if vars(args).get("force") else {}
    return Call(f"command_line.change_commands.{verb}", (str(args.file), str(args.to), *given), named)


def convert(source: str | Path, to: str | Path, build: str, *, force: bool = False) -> Listing:
    """Write the state in the restart file `source` to the file `to`, in the words of the scheme `build`."""
    from udec_ia.heap.word_scheme import scheme
    from udec_ia.heap_tools.convert_word_scheme import prove
    from udec_ia.heap_tools.rewrite_heap import rewrite
    from udec_ia.reader.printed_listing import Listing

    state = _read(source, to)
    fresh = rewrite(state.array, scheme(build))
    state = state._replace(array=fresh.array)  # the former one is not needed any more, and takes memory
    made = prove(fresh)
    line = f"* udec convert --build {build}: {MOVED}"
    return _write(state, made.array, to, line, Listing(made.head), made.broken, force)


def renumber(source: str | Path, to: str | Path) -> Listing:
    """Write the state in the restart file `source` to the file `to`, groups in the order of their lists."""
    from udec_ia.heap_tools.renumber_groups import renumber

    state = _read(source, to)
    return _write(state, state.array, to, f"* udec renumber: {MOVED}", renumber(state.array))


def patch(source: str | Path, to: str | Path, *assignments: str, force: bool = False) -> Listing:
    """Write the state in the restart file `source` to the file `to`, with other values of some words."""
    from udec_ia.heap_tools.patch_words import patch
    from udec_ia.reader.printed_listing import Listing

    state = _read(source, to)
    done = patch(state.array, *assignments, force=True)
    rows: list[tuple[Any, ...]] = [(one.what, one.value, one.now) for one in done.former]
    listing = Listing([f"values given: {len(rows)}"], ("what", "before", "now"), rows)
    command = "* udec patch --force:" if force else "PATCH"  # a deck cannot execute what had to be forced
    line = " ".join([command, *", ".join(assignments).split()])
    return _write(state, state.array, to, line, listing, done.broken, force)


def _read(source: str | Path, to: str | Path) -> Restored:
    """All that `source` holds. Error 31 if `to` is the same file."""
    from udec_ia.restart import load_to_change

    if os.path.exists(to) and os.path.exists(source) and os.path.samefile(source, to):
        advice = "give TO another name, and move the file afterwards"
        raise UdecError(31, f"{to} is the file that is read", advice)
    return load_to_change(source)


def _write(
    state: Restored,
    array: MainArray,
    to: str | Path,
    line: str,
    listing: Listing,
    broken: Sequence[Violation] = (),
    force: bool = False,
) -> Listing:
    """Write `to` with `line` at the end of its deck; an unsound state only by `force`."""
    from udec_ia.checker import in_short
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart import save_changed

    name = printable(str(to))
    if broken and not force:
        head = [f"NOT written: {name}, which would not be sound; --force writes it", *listing.head]
        return Listing(head, ("violation",), [(str(one),) for one in broken], 1)
    save_changed(state, array, to, line, [str(one) for one in broken])
    faults = folded(f"NOT SOUND: {in_short(broken)}").splitlines() if broken else []
    return listing._replace(head=[f"written: {name}", *faults, *listing.head])
