"""Interrupts anywhere: whatever ends a command, the model is as after it or exactly as before it, and sound.

    python tools/interrupts.py --lines 2000 --signals 500 --kills 200 --seed 1

First KeyboardInterrupt (Ctrl-C that does not wait) or MemoryError is raised at random lines of Python inside
every command of a model with blocks of all types, conditions, histories and pictures, typed, in Python, and
two of them obeyed as one. Words, common block and what the model holds in Python are compared with those
before and after bit for bit; a CYCLE may also have ended between two cycles. Lines of signals.py are left
out: what holds interrupts back is not interrupted itself.

Then SIGINT or SIGTERM is sent to processes that run random decks, at random moments. The restart file that
they name has to be sound, and the exit status true.

At last processes that SAVE two states by turns under one name are killed at random moments (SIGKILL, which
nothing can hold back): the name must stand for one of the two, whole. Failures are printed; with one the exit
status is 1.
"""

from __future__ import annotations

import argparse
import sys
import warnings

from interrupted.commands import interrupt_lines
from interrupted.processes import interrupt_processes
from interrupted.saves import kill_saves


def main() -> int:
    """Run the command line; returns the exit status."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--lines", type=int, default=2000)
    parser.add_argument("--signals", type=int, default=500)
    parser.add_argument("--kills", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=3600.0, help="time for each part")
    args = parser.parse_args()
    warnings.simplefilter("ignore")
    failures = interrupt_lines(args.lines, args.seed, args.seconds)
    failures += interrupt_processes(args.signals, args.seed, args.seconds)
    failures += kill_saves(args.kills, args.seed, args.seconds)
    tried = f"{args.lines} lines, {args.signals} signals, {args.kills} kills"
    print(f"{tried}, seed {args.seed}: {len(failures)} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
