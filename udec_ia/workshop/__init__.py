"""The heap workshop on the command line: to look into a restart file word by word, and to change it.

Each file here holds the commands of one kind. A command is one function of `udec_ia.inspect`, which works the
same on a model that runs; --python prints how to call it, --json prints what programs can read.
"""

from __future__ import annotations

from typing import Any

from udec_ia.workshop import change, check, compare, debug, diverge, info, look, sweep, trade, verify, view

PARTS = (info, check, look, compare, change, debug, diverge, sweep, trade, view, verify)
VERBS = tuple(verb for part in PARTS for verb in part.VERBS)
LOOKS = tuple(verb for part in (check, look, compare, change) for verb in part.VERBS)  # which run nothing


def add_commands(commands: Any) -> None:
    """Add the workshop's commands to those of `udec`."""
    for part in PARTS:
        part.add_commands(commands)
