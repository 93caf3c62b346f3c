"""What the runs of a study were warned of, in a few lines however many runs there are.

Warnings that differ in their numbers only are one: the first is shown, with the run that it is of.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from udec_ia.printable import MESSAGE, counted, printable
from udec_ia.study.runs import Result

NUMBER = re.compile(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?")
SHOWN = 3  # of those that most runs were given


def warned(results: Iterable[Result], log: str) -> list[str]:
    """Sentences on the warnings of `results`, none if there are none. log: the file that has them all."""
    runs = [*results]
    first: dict[str, tuple[str, str]] = {}
    given: dict[str, int] = {}
    for run in runs:
        kinds = {NUMBER.sub("#", text): text for text in reversed(run.warnings)}
        for kind, text in kinds.items():
            first.setdefault(kind, (text, run.name))
            given[kind] = given.get(kind, 0) + 1
    often = sorted(given, key=lambda kind: -given[kind])
    found = []
    for kind in often[:SHOWN]:
        text, name = first[kind]
        many = f"{given[kind]} of {counted(len(runs), 'run')} {'was' if given[kind] == 1 else 'were'} warned"
        found.append(printable(f"{many}: {text} ({name}, in {log})", MESSAGE))
    if len(often) > SHOWN:
        found.append(f"{counted(len(often) - SHOWN, 'other warning')}: see warnings in the table, and {log}")
    return found
