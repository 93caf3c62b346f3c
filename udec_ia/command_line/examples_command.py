"""The command that lists the examples of decks, and copies them to a folder, where they run as they are.

udec examples        udec examples collapse opening        udec examples --to decks
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command
from udec_ia.errors import UdecError
from udec_ia.file_replacement import put_in_place

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing

VERBS = ("examples",)
PACKAGE = Path(__file__).parents[1]
FOLDERS = PACKAGE / "examples", PACKAGE.parent / "examples"  # installed, in a checkout
TEXT = "list the examples of decks, or copy them; a file that differs from its example is never replaced"


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    parser = call_command(commands, "examples", TEXT, _examples)
    parser.add_argument("names", nargs="*", metavar="NAME", help="an example (default with --to: all)")
    text = "copy to this folder (default with a NAME: the current one)"
    parser.add_argument("--to", metavar="FOLDER", help=text)


def _examples(args: argparse.Namespace) -> Call:
    if not args.names and args.to is None:
        return Call("command_line.examples_command.list_examples")
    return Call("command_line.examples_command.copy_examples", (args.to or ".", *args.names))


def examples() -> dict[str, Path]:
    """The decks by name."""
    folder = next(one for one in FOLDERS if one.is_dir())
    return {path.stem: path for path in sorted(folder.glob("*.dat"))}


def list_examples() -> Listing:
    """Names of all examples, and what they show."""
    from udec_ia.reader.printed_listing import Listing

    rows = [(name, _title(path.read_text())) for name, path in examples().items()]
    return Listing([], ("example", "what it shows"), rows)


def copy_examples(to: str | Path, *names: str) -> Listing:
    """Copy some examples, by default all, to the folder `to`. Existing files stay.

    ValueError for an unknown name. Error 31 if a file exists and differs; then nothing is copied.
    """
    from udec_ia.reader.printed_listing import Listing

    decks = examples()
    chosen = [name.removesuffix(".dat") for name in names] or [*decks]
    for name in chosen:
        if name not in decks:
            raise ValueError(f"there is no example {name}: choose from {', '.join(decks)}")
    new = _new_files(Path(to), [decks[name] for name in chosen])
    for path, content in new.items():
        put_in_place(path, content)
    return Listing([f"{path}" for path in new] or ["all of them are there already"])


def _new_files(folder: Path, decks: Sequence[Path]) -> dict[Path, bytes]:
    """The files that are not there yet. Error 31 if one exists and differs from its deck."""
    new = {}
    for deck in decks:
        path, content = folder / deck.name, deck.read_bytes()
        if not path.exists():
            new[path] = content
        elif not path.is_file() or path.read_bytes() != content:
            advice = "nothing was copied: give another folder (--to), or move that file"
            raise UdecError(31, f"{path} exists, and differs from the example", advice)
    return new


def _title(deck: str) -> str:
    """The first sentence of the first comment of a deck."""
    lines = deck.splitlines()
    first = next((i for i, line in enumerate(lines) if line.startswith("*")), len(lines))
    found: list[str] = []
    for line in lines[first:]:
        if not line.startswith("*") or not line.strip("* "):
            break
        found.append(line.strip("* "))
    return " ".join(found).partition(". ")[0].rstrip(".")
