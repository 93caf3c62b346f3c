"""Commands of the shell: runs, restart files, the debugger, studies, verification, examples and the cache.

Each file here holds the commands of one kind. A command of `call_command` is one function of the library,
which works the same on a model that runs; --python prints how to call it, --json prints what programs can
read.
"""

from __future__ import annotations

from typing import Any

from udec_ia.command_line import (
    cache_command,
    change_commands,
    completion_command,
    debug_command,
    diverge_command,
    examples_command,
    export_command,
    fos_command,
    look_commands,
    report_commands,
    sweep_command,
    trade_command,
    verify_command,
    view_command,
)

PARTS = (
    report_commands,
    look_commands,
    change_commands,
    debug_command,
    diverge_command,
    fos_command,
    sweep_command,
    trade_command,
    view_command,
    export_command,
    examples_command,
    verify_command,
    cache_command,
    completion_command,
)
VERBS = tuple(verb for part in PARTS for verb in part.VERBS)


def add_commands(commands: Any) -> None:
    """Add these commands to those of `udec`."""
    for part in PARTS:
        part.add_commands(commands)
