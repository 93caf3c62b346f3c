"""Writes docs/stability.md anew: its tables and pictures are what the commands on it make.

    python docs/studies/stability_page.py [SECTION ...]

runs the command of each section, by default of all (hours; the random scenes go on where they were cut off),
from the top of the repository, and puts the tables that it prints in the place of those in the section.
Pictures the command writes itself. The words around them are for people to write: read them again then.
SECTION: a heading of the page, or the beginning of one.
"""

from __future__ import annotations

import argparse
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from time import monotonic

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "stability.md"
COMMAND = re.compile(r"^    python (.+)$", re.MULTILINE)
TABLE = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)


def sections(page: str) -> dict[str, str]:
    """The text of each section of a page that names a command, by its heading."""
    parts = re.split(r"^## (.+)\n", page, flags=re.MULTILINE)
    return {head: text for head, text in zip(parts[1::2], parts[2::2], strict=True) if COMMAND.search(text)}


def tables(text: str) -> list[str]:
    """The tables in a text."""
    return TABLE.findall(text)


def renewed(text: str, run: Callable[[str], str]) -> str:
    """A section with the tables that its command prints. run: gives what a command prints.

    ValueError if the command prints more or fewer tables than the section has.
    """
    command = COMMAND.search(text)
    assert command, "sections() gives none without"
    old, new = tables(text), tables(run(command[1]))
    if len(old) != len(new):
        raise ValueError(f"prints {len(new)} tables, where the page has {len(old)}: {command[1]}")
    printed = iter(new)
    return TABLE.sub(lambda _: next(printed), text)


def run(command: str) -> str:
    """What `python COMMAND` prints. CalledProcessError if it fails."""
    start = monotonic()
    print(f"python {command}", file=sys.stderr, flush=True)
    done = subprocess.run(
        [sys.executable, *shlex.split(command)], cwd=ROOT, stdout=subprocess.PIPE, text=True, check=True
    )
    print(f"{monotonic() - start:.0f} s", file=sys.stderr, flush=True)
    return done.stdout


def main() -> None:
    """Write the page after each section, so that one that fails costs only itself."""
    known = list(sections(PAGE.read_text()))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("sections", nargs="*", metavar="SECTION", default=known)
    asked = parser.parse_args().sections
    for name in asked:
        if not any(head.startswith(name) for head in known):
            parser.error(
                f"no section of {PAGE.name} that begins with {name!r} has a command: {', '.join(known)}"
            )
    for head in known:
        if head.startswith(tuple(asked)):
            page = PAGE.read_text()
            text = sections(page)[head]
            PAGE.write_text(page.replace(text, renewed(text, run)))


if __name__ == "__main__":
    main()
