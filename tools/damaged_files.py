"""Damaged restart files: what RESTART, the checker and the commands make of them.

    python tools/damaged_files.py COMMAND [OPTIONS]

    words     single words changed: RESTART refuses what it cannot accept
    commands  damaged files given to every command that reads one
    hostile   files made to read other files, to take all memory or time, or to fool a terminal

`python tools/damaged_files.py COMMAND --help` lists the options. The exit status is 1 if anything failed.
"""

from __future__ import annotations

import sys

import subcommands

COMMANDS = {
    "words": "damage.changed_words",
    "commands": "damage.command_trials",
    "hostile": "damage.hostile_files",
}

if __name__ == "__main__":
    sys.exit(subcommands.run(__doc__ or "", COMMANDS))
