"""Commands that make a new restart file out of one, sound or damaged.

udec convert FILE TO --build i64r64        udec renumber FILE TO        udec patch FILE TO 'FRAC = 0.1'

Deck, laws and what was recorded go along, and the deck says what was done. TO is written as SAVE writes:
whole or not at all, over nothing but a restart file, and never over FILE itself, which stays until somebody
takes it away. A state that a command has made unsound is written only if --force says so.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Look, Script, command, file
from udec_ia.errors import UdecError
from udec_ia.printable_text import folded, printable

if TYPE_CHECKING:
    from udec_ia.checker import Violation
    from udec_ia.heap.main_array import MainArray
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart.restart_reader import Restored

VERBS = ("convert", "renumber", "patch")
MOVED = "addresses differ from here on"  # what the deck says of them
SCRIPT = """\
{imports}
from udec_ia.restart import load_to_change, save_changed

state = load_to_change({file!r})
{change}
save_changed(state, {array}, {to!r}, {line!r})"""


def add_commands(commands: Any) -> None:
    """Add them to those of `udec`."""
    from udec_ia.layout.field_table import SCHEMES

    text = "write a restart file in another word scheme"
    convert = _change(commands, "convert", text, _convert, _convert_script)
    convert.add_argument(
        "--build", required=True, choices=SCHEMES, help="widths of integers and reals in bits"
    )
    text = "write a restart file with its groups in the order of their lists"
    _change(commands, "renumber", text, _renumber, _renumber_script)
    text = "write a restart file with other values of some words"
    patch = _change(commands, "patch", text, _patch, _patch_script)
    patch.add_argument(
        "assignments",
        nargs="+",
        metavar="ASSIGNMENT",
        help="'block@88.KXD = 0', 'zone@9.KZG(2) = 412', 'FRAC = 0.1' or '1234 = 7'",
    )
    for parser in (convert, patch):
        parser.add_argument("--force", action="store_true", help="write it even if it is unsound")


def _change(commands: Any, verb: str, text: str, look: Look, script: Script) -> argparse.ArgumentParser:
    """A command that reads FILE and writes TO."""
    parser = command(commands, verb, text, look, script)
    file(parser)
    parser.add_argument("to", type=Path, metavar="TO", help="the restart file to be written")
    return parser


def _convert(args: argparse.Namespace) -> Listing:
    from udec_ia.heap.word_scheme import scheme
    from udec_ia.heap_tools.convert_word_scheme import prove
    from udec_ia.heap_tools.rewrite_heap import rewrite
    from udec_ia.reader.printed_listing import Listing

    state = _read(args)
    fresh = rewrite(state.array, scheme(args.build))
    state = state._replace(array=fresh.array)  # the former one is not needed any more, and takes memory
    made = prove(fresh)
    return _write(args, state, made.array, _convert_line(args), Listing(made.said), made.broken)


def _convert_line(args: argparse.Namespace) -> str:
    return f"* udec convert --build {args.build}: {MOVED}"


def _convert_script(args: argparse.Namespace) -> str:
    imports = (
        "from udec_ia.heap.word_scheme import scheme\n"
        "from udec_ia.heap_tools.convert_word_scheme import convert"
    )
    proof = "print(made.broken)" if args.force else "assert made.broken == []"
    change = f"made = convert(state.array, scheme({args.build!r}))\nprint(*made.said, sep='\\n')\n{proof}"
    return _script(args, imports, change, "made.array", _convert_line(args))


def _renumber(args: argparse.Namespace) -> Listing:
    from udec_ia.heap_tools.renumber_groups import renumber

    state = _read(args)
    return _write(args, state, state.array, f"* udec renumber: {MOVED}", renumber(state.array))


def _renumber_script(args: argparse.Namespace) -> str:
    imports = "from udec_ia.heap_tools.renumber_groups import renumber"
    change = "print(renumber(state.array).as_text())"
    return _script(args, imports, change, "state.array", f"* udec renumber: {MOVED}")


def _patch(args: argparse.Namespace) -> Listing:
    from udec_ia.heap_tools.patch_words import patch
    from udec_ia.reader.printed_listing import Listing

    state = _read(args)
    done = patch(state.array, *args.assignments, force=True)
    rows: list[tuple[Any, ...]] = [(one.what, one.value, one.now) for one in done.former]
    listing = Listing([f"values given: {len(rows)}"], ("what", "before", "now"), rows)
    return _write(args, state, state.array, _patch_line(args), listing, done.broken)


def _patch_line(args: argparse.Namespace) -> str:
    """A deck could not obey what had to be forced."""
    command = "* udec patch --force:" if args.force else "PATCH"
    return " ".join([command, *", ".join(args.assignments).split()])


def _patch_script(args: argparse.Namespace) -> str:
    given = ", ".join(map(repr, args.assignments))
    change = (
        f"done = patch(state.array, {given}{', force=True' if args.force else ''})\n"
        "print(*(f'{one.what}: {one.value} -> {one.now}' for one in done.former), *done.broken, sep='\\n')"
    )
    return _script(
        args, "from udec_ia.heap_tools.patch_words import patch", change, "state.array", _patch_line(args)
    )


def _script(args: argparse.Namespace, imports: str, change: str, array: str, line: str) -> str:
    _check_other(args)
    file, to = str(args.file), str(args.to)
    return SCRIPT.format(imports=imports, file=file, change=change, array=array, to=to, line=line)


def _read(args: argparse.Namespace) -> Restored:
    """All that FILE holds."""
    from udec_ia.restart import load_to_change

    _check_other(args)
    return load_to_change(args.file)


def _check_other(args: argparse.Namespace) -> None:
    """Error 31 if TO is FILE."""
    if args.to.exists() and args.file.exists() and os.path.samefile(args.file, args.to):
        raise UdecError(
            31, f"{args.to} is the file that is read", "give TO another name, and move the file afterwards"
        )


def _write(
    args: argparse.Namespace,
    state: Restored,
    array: MainArray,
    line: str,
    listing: Listing,
    broken: Sequence[Violation] = (),
) -> Listing:
    """TO, unless the state is not sound: then only if it is forced."""
    from udec_ia.checker import in_short
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart import save_changed

    to = printable(str(args.to))
    if broken and not args.force:
        said = [f"NOT written: {to}, which would not be sound; --force writes it", *listing.said]
        return Listing(said, ("violation",), [(str(one),) for one in broken], 1)
    save_changed(state, array, args.to, line, [str(one) for one in broken])
    faults = folded(f"NOT SOUND: {in_short(broken)}").splitlines() if broken else []
    written = [f"written: {to}", *faults]
    return listing._replace(said=[*written, *listing.said])
