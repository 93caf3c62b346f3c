"""Speed, measured in processor time: of cycles, commands, large files, compiling and the debugger.

    python tools/bench.py COMMAND [OPTIONS]

    passes     parts of a run: cycles and zones against a structure of arrays, SPLIT, proofs, laws, the ball
    loose      blocks that fly, collide and pile up, against a packed slab
    commands   every command of the deck language, at models of growing size
    scale      the commands that read and write restart files, at models of growing size
    first      the first run of each feature, which compiles it, and the second one
    gains      what each part of the compilation of kernels gains
    pictures   those of the ball, and of a slab with many blocks
    debugger   recording a run and going back in it

`python tools/bench.py COMMAND --help` lists the options.
"""

from __future__ import annotations

import sys

import subcommands

COMMANDS = {
    "passes": "speed.cycle_speed",
    "loose": "speed.loose_blocks",
    "commands": "speed.command_speed",
    "scale": "speed.large_files",
    "first": "speed.first_runs",
    "gains": "speed.compiling_gains",
    "pictures": "speed.picture_speed",
    "debugger": "speed.debugger_speed",
}

if __name__ == "__main__":
    sys.exit(subcommands.run(__doc__ or "", COMMANDS))
