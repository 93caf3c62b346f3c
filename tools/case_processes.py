"""Random cases in processes of their own: a crash or a hang costs one case and not the search.

A process prints a row as JSON before and after each of its cases.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, NamedTuple

FIRST_CASE, NEXT_CASE = 600.0, 180.0  # seconds of silence after which a process hangs; any may compile
ROOM = 2**30  # bytes of addresses that a process may take beyond those that it begins with


class CaseRow(NamedTuple):
    """One case. label: what it is about. ended: how it ended, "" before it begins. faults: what failed."""

    case: int
    label: Any
    ended: str
    faults: list[str]


def print_rows(rows: Iterable[CaseRow]) -> None:
    """What a process does: print its rows, whatever else becomes of standard output."""
    for row in rows:
        print(json.dumps(row), file=sys.__stdout__, flush=True)


def run_batch(
    arguments: list[str],
    case: int,
    last: int,
    report: Callable[[CaseRow], None],
    environment: dict[str, str] | None = None,
) -> int:
    """Run the cases from `case` to before `last` in one process. Returns the case to continue with.

    arguments: of Python. report: called with each row.
    """
    process = subprocess.Popen(
        [sys.executable, *arguments], stdout=subprocess.PIPE, text=True, env=environment
    )
    assert process.stdout is not None
    row, silence = CaseRow(case, "", "", []), FIRST_CASE
    while True:
        guard = threading.Timer(silence, process.kill)
        guard.start()
        line = process.stdout.readline()
        guard.cancel()
        if not line:
            break
        row = CaseRow(*json.loads(line))
        report(row)
        if row.ended:
            silence = NEXT_CASE
    if process.wait() == 0:
        return last
    report(CaseRow(row.case, row.label, "", [f"the process ended with status {process.returncode}"]))
    return row.case + 1


def peak_memory() -> int:
    """The most memory in use since the last call, in bytes."""
    lines = Path("/proc/self/status").read_text().splitlines()
    (line,) = [one for one in lines if one.startswith("VmHWM")]
    Path("/proc/self/clear_refs").write_text("5")
    return int(line.split()[1]) * 1024


def limit_memory() -> None:
    """Let this process take no more than ROOM beyond what it has."""
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + ROOM, size + ROOM))
