"""`udec debug DECK`: run a deck under the debugger. `udec debug --replay FILE`: look at a recording of it."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from udec_ia.command_line.command_options import MISUSE, given, variables, word_scheme
from udec_ia.deck.deck_statements import read_deck
from udec_ia.printable_text import visible

VERBS = ("debug",)


def add_commands(commands: Any) -> None:
    """Add it to those of `udec`."""
    text = "run a deck under the debugger: stop it, look at every word, go back"
    parser = commands.add_parser("debug", help=text, description=text)
    parser.add_argument("deck", nargs="?", type=Path, help="file of commands")
    word_scheme(parser)
    parser.add_argument("--out", type=Path, default=Path(), help="folder for the files of the deck")
    parser.add_argument("--constitutive", action="append", metavar="LAW", help="as for udec run")
    parser.add_argument(
        "--commands",
        type=Path,
        metavar="FILE",
        help="take the debugger's commands from a file, and end after them",
    )
    parser.add_argument("--replay", type=Path, metavar="FILE", help="look at what `record FILE` has written")
    variables(parser)
    parser.set_defaults(action=_debug)


def _debug(args: argparse.Namespace) -> int:
    from udec_ia.debug import debug, read_recording, replay
    from udec_ia.heap.word_scheme import DEFAULT_SCHEME
    from udec_ia.model import Model

    try:
        values = given(args.set)
        if (args.deck is None) == (args.replay is None):
            raise ValueError("give a deck, or --replay FILE")
        if args.replay is not None and (values or args.build != DEFAULT_SCHEME):
            raise ValueError("a recording has its own variables and words: omit --set and --build")
    except ValueError as error:
        print(f"udec debug: {visible(str(error))}", file=sys.stderr)
        return MISUSE
    script = None if args.commands is None else read_deck(args.commands).splitlines()
    if args.replay is not None:
        recording = read_recording(args.replay)
        model = Model(build=recording.build, out=args.out, constitutive=args.constitutive)
        replay(model, recording, sys.stdout, script)
        return 0
    model = Model(build=args.build, out=args.out, constitutive=args.constitutive, name=args.deck.stem)
    text = read_deck(args.deck)
    debug(model, text, sys.stdout, script, str(args.deck), values)
    return 0
