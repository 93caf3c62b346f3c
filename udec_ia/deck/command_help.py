"""The table of commands in words: what HELP prints, and docs/commands.md.

python -m udec_ia.deck.command_help > docs/commands.md
"""

from __future__ import annotations

import sys
import textwrap

from udec_ia.deck.command_table import COMMANDS, Command, match
from udec_ia.deck.deck_statements import quoted
from udec_ia.deck.keyword_suggestions import with_suggestion
from udec_ia.errors import ADVICE, MESSAGES, UdecError

WIDTH = 96

INTRODUCTION = """\
# Commands

A deck is a text file with one command to a line. The language is that of the report's Appendix I-1.

- Upper-case letters of a command or word below must be typed, the others may be left off from the end, and
  the case of what is typed does not matter: `PROperty` is `PROP`, `Print Blocks` is `P B`. Where two keywords
  fit, the first one below is meant.
- Lower-case parameters stand for numbers. Those that begin with i, j, k, l, m or n must be integers; the
  others are reals, which may be given as integers. `0.5`, `.5`, `5.`, `1.E08` and `1D8` are reals.
- `[ ]` encloses what may be left off, `|` separates alternatives, `...` means that more of the same follows.
- Parameters are separated by blanks or any of `= ( ) , /`.
- A line that begins with `*`, `;`, `#` or `!` is a comment, and so is what follows a `;`, `#` or `!` in any
  other line. In the name of a file these three belong to the name, unless a blank stands before them and the
  name is not in quotes.
- A line that begins with `+` continues the one before it, but the numbers of a pair or triple must stand on
  one line.
- At a terminal a command is obeyed when its line ends; a `+` at the end of the line continues it. Commands
  with `...` in their form ask for more by themselves, until an empty line or the next command. A line that
  continues them with a word that is a command, too, needs a `+` before it: `G` is GRAVITY, `GRID` is not.
- The first command is START or RESTART. Lines after STOP are ignored.
"""


def meaning(command: Command, width: int, indent: str = "") -> str:
    """What the command does, in lines of at most `width` characters."""
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
    rows = [f"| {number} | {text} | {ADVICE[number]} |" for number, text in MESSAGES.items()]
    parts.append("\n".join(["## Errors\n", "| number | message | what to do |", "|---|---|---|", *rows]))
    return "\n".join(parts) + "\n"


if __name__ == "__main__":
    sys.stdout.write(reference())
