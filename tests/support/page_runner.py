"""Runs the fenced blocks of a page, in their order, and compares what they print with what the page shows.

    ```deck title="floor.dat"     a file that is written into the folder, in any language
    ```deck                       lines that continue the first deck of the page, or begin a run of their own
    ```console                    commands behind `$ `, each followed by lines that it prints
    ```python                     Python, in one namespace for the page
    ```output                     lines that the Python before it prints

A shown line may leave off parts (`...`); between two shown lines others may be printed. Numbers agree to
0.5 %. Blocks of other languages, such as `sh` for the installation, are not run.
"""

from __future__ import annotations

import contextlib
import io
import math
import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from udec_ia import Model
from udec_ia.cli import main

FENCE = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d[\d,]*\.?\d*(?:[eE][-+]?\d+)?(?![\w.])")
CLOSE = 5e-3  # of a number that is shown


@dataclass
class FencedBlock:
    """A fenced block of a page: language, name of the file if it has one, and text."""

    language: str
    name: str
    text: str


def fenced_blocks(page: Path) -> list[FencedBlock]:
    """All fenced blocks of a page."""
    return [FencedBlock(*found) for found in FENCE.findall(page.read_text())]


def value(number: str) -> float:
    """The number that is written so."""
    return float(number.replace(",", ""))


def agrees(shown: str, printed: str) -> bool:
    """True if a line that the page shows is what was printed, but for the parts that it leaves off."""
    numbers = [value(one) for one in NUMBER.findall(shown)]
    pieces = []
    for part in re.split(r"(\.\.\.|\s+)", NUMBER.sub("\0", shown.strip())):
        if part == "...":
            pieces.append(".*")
        elif part.isspace():
            pieces.append(r"\s+")
        else:
            pieces.append(re.escape(part).replace(re.escape("\0"), f"({NUMBER.pattern})"))
    found = re.fullmatch("".join(pieces), printed.strip())
    return found is not None and all(
        math.isclose(value(one), number, rel_tol=CLOSE)
        for one, number in zip(found.groups(), numbers, strict=True)
    )


def missing_line(shown: str, printed: str) -> str:
    """The first line of a page that was not printed in its place; "" if all were."""
    lines = iter(printed.splitlines())
    for line in shown.splitlines():
        if line.strip() not in ("", "...") and not any(agrees(line, one) for one in lines):
            return line
    return ""


def commands(console: str) -> Iterator[tuple[str, str]]:
    """Each command of a console block, and what it shows."""
    for part in re.split(r"^\$ ", console, flags=re.MULTILINE)[1:]:
        command, _, shown = part.partition("\n")
        yield command, shown


def run_command(command: str) -> str:
    """What a command `udec ...` prints. AssertionError if it fails."""
    program, *arguments = shlex.split(command)
    assert program == "udec", command
    into = io.StringIO()
    with contextlib.redirect_stdout(into), contextlib.redirect_stderr(into):
        status = main(arguments)
    allowed = (0, 1) if arguments[0] == "diff" else (0,)  # it is 1 if the two differ, as of other programs
    assert status in allowed, f"{command}: {into.getvalue()[-2000:]}"
    return into.getvalue()


def run_page(page: Path, folder: Path) -> list[str]:
    """Lines that the page shows and that were not printed. `folder` is the working directory."""
    missing: list[str] = []
    namespace: dict[str, Any] = {}
    printed = base = ""
    for block in fenced_blocks(page):
        if block.name:
            (folder / block.name).write_text(block.text)
            if block.language == "deck" and block.text.startswith("START"):
                base = base or block.text
        elif block.language == "deck":
            text = block.text if block.text.startswith(("START", "RESTART")) else base + block.text
            Model(out=folder / "out").run(text, stream=io.StringIO())
        elif block.language == "console":
            missing += [missing_line(shown, run_command(command)) for command, shown in commands(block.text)]
        elif block.language == "python":
            into = io.StringIO()
            with contextlib.redirect_stdout(into):
                exec(compile(block.text, page.name, "exec"), namespace)
            printed = into.getvalue()
        elif block.language == "output":
            missing.append(missing_line(block.text, printed))
    return [line for line in missing if line]
