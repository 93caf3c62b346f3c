"""Random searches for crashes, hangs, unsound states, missed contacts and broken interrupts.

    python tools/robustness.py COMMAND [OPTIONS]

    fuzz        random and mutated decks and restart files
    impacts     impacts of blocks that the program misses, and errors 15 without a reason
    interrupts  exceptions, signals and kills at any moment

`python tools/robustness.py COMMAND --help` lists the options. The exit status is 1 if anything failed.
"""

from __future__ import annotations

import sys

import subcommands

COMMANDS = {
    "fuzz": "trials.input_fuzzer",
    "impacts": "trials.impact_search",
    "interrupts": "trials.interrupted_processes",
}

if __name__ == "__main__":
    sys.exit(subcommands.run(__doc__ or "", COMMANDS))
