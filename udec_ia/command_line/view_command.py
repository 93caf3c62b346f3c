"""The command that shows restart files in a browser.

udec view FILE ... --out view.html
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing

VERBS = ("view",)
TEXT = "write a page for a browser that shows IA() beside the blocks, for one state or several"


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    view = call_command(commands, "view", TEXT, _view)
    view.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a restart file, sound or damaged")
    view.add_argument(
        "--out",
        type=Path,
        default=Path("view.html"),
        metavar="PAGE",
        help="the page to be written (default: %(default)s)",
    )


def _view(args: argparse.Namespace) -> Call:
    return Call("command_line.view_command.write_page", (str(args.out), *map(str, args.files)))


def write_page(out: str | Path, *paths: str | Path) -> Listing:
    """Write the page `out` that shows the states in some restart files."""
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart import deck_in, look_into
    from udec_ia.view import Page

    page = Page()
    for path in paths:
        page.add(look_into(path), Path(path).name, deck_in(path))
    return Listing([f"{page.write(out)}: open it in a browser", *page.left_out()])
