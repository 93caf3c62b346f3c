"""The command that writes states for other programs.

udec export FILE ... OUT.vtkhdf
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import Call, call_command

if TYPE_CHECKING:
    from udec_ia.reader.printed_listing import Listing

VERBS = ("export",)
TEXT = "write states for other programs: .vtkhdf (ParaView, a series in time), .csv, .geojson or .svg"


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    export = call_command(commands, "export", TEXT, _export)
    export.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a restart file")
    export.add_argument("out", type=Path, metavar="OUT", help="the file to be written")


def _export(args: argparse.Namespace) -> Call:
    return Call("command_line.export_command.write_files", (str(args.out), *map(str, args.files)))


def write_files(out: str | Path, *paths: str | Path) -> Listing:
    """Write the file `out` from the states in some restart files."""
    from udec_ia.export import export
    from udec_ia.reader.printed_listing import Listing
    from udec_ia.restart import look_into

    return Listing([str(file) for file in export(out, map(look_into, paths))])
