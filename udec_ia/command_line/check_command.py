"""The command that proves a state, or says all that is wrong with it.

udec check FILE
"""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from udec_ia.command_line.command_options import command, file
from udec_ia.printable import counted

if TYPE_CHECKING:
    from udec_ia.reader.listing import Listing

VERBS = ("check",)
COLUMNS = ("invariant", "what is wrong")
SCRIPT = """\
from udec_ia.checker import check, unjudged
from udec_ia.restart import read_stored_state

seen = read_stored_state({file!r})  # of a model: model.check()
found = check(seen.array)
print(*seen.notes, *(found or ["sound"]), *unjudged(seen.array, found), sep="\\n")"""


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    text = "prove that a restart file holds a sound block system, or list all faults"
    file(command(commands, "check", text, _look, lambda args: SCRIPT.format(file=str(args.file))))


def _look(args: argparse.Namespace) -> Listing:
    """All violations in a file, sound or not, and what was not judged."""
    from udec_ia.checker import check, unjudged
    from udec_ia.printable import printable
    from udec_ia.reader.listing import Listing
    from udec_ia.restart import read_stored_state

    seen = read_stored_state(args.file)
    found = check(seen.array)
    many = counted(len(found), "violation")
    said = [f"{printable(str(args.file))}: {many if found else 'sound'}"]
    rows: list[tuple[Any, ...]] = [(one.invariant, one.message) for one in found]
    return Listing(said + seen.notes + unjudged(seen.array, found), COLUMNS, rows, int(bool(found)))
