"""What the tests of studies share: a short deck with a variable, laws that kill, and a sweep as a process."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from time import monotonic, sleep

from udec_ia.studies.study_run import RunResult, StudyRun

ROOT = Path(__file__).parents[2]
PILE = """START
DEFAULT F=0.5 N=200
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=$F
BLOCK 0,0 0,3 2,3 2,0
SPLIT -1,0.9 3,1.1
SPLIT -1,2.1 3,1.9
FIX 0,2 0,1
GRAVITY 3 -10
HISTORY 10 KYD AT 1,2.5
CYCLE $N
"""
KILLS = "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n"
KILLS_ONCE = """import os, pathlib, signal
mark = pathlib.Path(__file__).with_suffix(".mark")
if not mark.exists():
    mark.touch()
    os.kill(os.getpid(), signal.SIGKILL)
def clj2(fn, fs, dun, dus, un, us, m):
    return -m.kn * dun, -m.ks * dus
"""

WAITS = """import pathlib, time
here = pathlib.Path(__file__).parent
ends = time.monotonic() + 120
while len([*here.rglob("result.json")]) >= 2 and not (here / "go").exists() and time.monotonic() < ends:
    time.sleep(0.02)
def clj2(fn, fs, dun, dus, un, us, m):
    return -m.kn * dun, -m.ks * dus
"""  # runs that begin when two have ended wait for a file "go"


def piles(*frictions: float, cycles: int = 200) -> list[StudyRun]:
    """A run of PILE for each friction."""
    return [StudyRun(f"F={f}", PILE, "pile.dat", {"F": f, "N": cycles}) for f in frictions]


def outcome(result: RunResult) -> str:
    """All of a result that does not depend on the machine."""
    return repr(replace(result, seconds=0.0, limit=None))


def started(*arguments: str, cwd: Path) -> subprocess.Popen[str]:
    """The command `udec` with these arguments, in a process and a process group of its own."""
    return subprocess.Popen(
        [sys.executable, "-m", "udec_ia", *arguments],
        cwd=cwd,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def wait_until(there: Callable[[], bool], seconds: float = 120) -> None:
    """Wait until something is there."""
    end = monotonic() + seconds
    while not there():
        assert monotonic() < end, "it has not come"
        sleep(0.02)
