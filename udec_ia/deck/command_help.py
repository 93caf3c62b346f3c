"""HELP, and the text of docs/commands.md: what the table of commands says, for readers.

python -m udec_ia.deck.command_help > docs/commands.md
"""

from __future__ import annotations

import sys
import textwrap

from udec_ia.deck.command_forms import Command, match
from udec_ia.deck.command_table import COMMANDS
from udec_ia.deck.deck_statements import quoted
from udec_ia.deck.keyword_suggestions import with_suggestion
from udec_ia.errors import ADVICE, MESSAGES, UdecError

WIDTH = 96

INTRODUCTION = """\
# Commands

A deck is a text file with one command to a line. The language is that of the report's Appendix I-1.

- Upper-case letters of a command or word must be typed. The others may be omitted from the end. Case does not
  matter: `PROperty` is `PROP`, `Print Blocks` is `P B`. If two keywords fit, the first one below is taken.
- Lower-case parameters are numbers. Those that begin with i, j, k, l, m or n must be integers. The others are
  reals, which may be given as integers. `0.5`, `.5`, `5.`, `1.E08` and `1D8` are reals.
- `[ ]` encloses optional parts, `|` separates alternatives, `...` means that more of the same may follow.
- Parameters are separated by blanks or any of `= ( ) , /`.
- In place of a range `x1 x2 y1 y2` words may stand, or `RANGE` and words behind all others: see Ranges, at
  the end of this page.
- A line that begins with `*`, `;`, `#` or `!` is a comment. In other lines `;`, `#` and `!` begin a comment;
  in file names only behind a blank and outside quotes.
- A line that begins with `+` continues the one before it. Numbers of a pair or triple must be on one line.
- At a terminal a command is executed when its line ends; a `+` at the end of the line continues it. Commands
  with `...` in their form continue until an empty line or the next command. If a line continues them with a
  word that is also a command, it needs a `+` before it: `G` is GRAVITY, `GRID` is not.
- The first command is START or RESTART. Lines after STOP are ignored.
"""

RANGES = """\
## Ranges

A range selects blocks by their centroids, grid-points and contacts by their places, edges by both ends, and
domains by their middles. It is a rectangle `x1 x2 y1 y2`, whose limits are outside it, or it is in words:

    DELETE CIRCLE 20,15 5
    FIX BELOW 0,2 60,2
    CHANGE MATERIAL=2 RANGE POLYGON 0,0 20,0 30,10 0,10 NOT MATERIAL 3
    DELETE AREA < 0.05
    BOUNDARY OUTSIDE STRESS -1E6 0 -2E6

All parts must hold; NOT before a part means that it must not. A word that the command has itself, such as
MATERIAL of CHANGE, is that of the range behind RANGE only. In Python words are the first argument:
`m.delete("CIRCLE 20 15 5")`.

| part | selects |
|---|---|
| RANGE x1 x2 y1 y2 | what lies in the rectangle |
| CIRCLE x y r | what lies in the circle |
| ANNULUS x y r1 r2 | what lies between two circles |
| POLYGON x y x y x y ... | what lies in the polygon |
| ABOVE x1 y1 x2 y2, BELOW x1 y1 x2 y2 | what lies above or below the line through two points |
| MATERIAL n | blocks of material n |
| JMATERIAL n, JOINT n | contacts with joint material n, or on joint n; else the blocks at them |
| OUTSIDE | edges, grid-points and blocks on the outline of all blocks together |
| AREA < a | blocks smaller than a (m2) |
| GROUP name | blocks that were in the range of GROUP when it was given, wherever they are now |
| WHERE condition | blocks that meet a condition on their fields ([tools](workshop.md)); it ends the line |
| ALL | all |
"""


def meaning(command: Command, width: int, indent: str = "") -> str:
    """The help of a command, in lines of at most `width` characters."""
    return textwrap.fill(command.help, width, initial_indent=indent, subsequent_indent=indent)


def summary() -> str:
    """What HELP prints: the forms of all commands."""
    forms = [
        textwrap.fill(command.form, WIDTH, subsequent_indent=" " * 12, break_on_hyphens=False)
        for command in COMMANDS
    ]
    return "\n".join([*forms, "", "HELP COMMAND explains one of them."])


def explain(typed: str) -> str:
    """What HELP COMMAND prints. Raises UdecError 2 if there is no such command."""
    command = match(COMMANDS, typed)
    if command is None:
        raise UdecError(2, quoted(typed), with_suggestion(typed, (c.keyword for c in COMMANDS), ADVICE[2]))
    return f"{command.form}\n{meaning(command, WIDTH, '    ')}\n    Example: {command.example}"


def reference() -> str:
    """The text of docs/commands.md."""
    parts = [INTRODUCTION]
    for command in COMMANDS:
        parts.append(f"## {command.name.upper()}\n\n    {command.form}\n\n{meaning(command, 110)}\n")
        if command.ours:
            parts.append(f"Not in Appendix I-1: {command.ours}.\n")
        parts.append(f"    {command.example}\n")
    parts.append(RANGES)
    rows = [f"| {number} | {text} | {ADVICE[number]} |" for number, text in MESSAGES.items()]
    parts.append("\n".join(["## Errors\n", "| number | message | what to do |", "|---|---|---|", *rows]))
    return "\n".join(parts) + "\n"


if __name__ == "__main__":
    sys.stdout.write(reference())
