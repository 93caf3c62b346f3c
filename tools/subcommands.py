"""Subcommands of the programs in tools/: the first word names a module, whose `main` reads the rest."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path


def run(text: str, modules: dict[str, str]) -> int:
    """Run the module that the command line names; returns its exit status.

    text: printed where the command is missing or unknown. modules: by the names of commands.
    """
    program, words = Path(sys.argv[0]).name, sys.argv[1:]
    if not words or words[0] not in modules:
        print(text)
        return 0 if words in (["-h"], ["--help"]) else 2
    sys.argv = [f"{program} {words[0]}", *words[1:]]
    return int(import_module(modules[words[0]]).main() or 0)
