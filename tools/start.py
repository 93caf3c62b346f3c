"""One command from a fresh checkout to a result: `python3 tools/start.py run` or `... test`.

Needs git (for the checkout) and Python 3.11 or later with venv and pip, nothing else. Everything is
installed into .venv inside the checkout; a second run installs nothing unless pyproject.toml has changed.

    run  [OPTIONS]   run the main job, examples/ball-rolling.dat, into out/; OPTIONS go to `udec run`
    test [OPTIONS]   run the tests, ruff, mypy and the check of generated files; OPTIONS go to pytest

This file uses the standard library only, and no syntax newer than Python 3.5, so that an older Python
can read it and say what is wrong.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

OLDEST = (3, 11)
NEWER = ("python3.14", "python3.13", "python3.12", "python3.11")

if sys.version_info < OLDEST:
    found = [name for name in NEWER if shutil.which(name)]
    sys.exit(
        "Python 3.11 or later is needed, this is "
        + sys.version.split()[0]
        + ("\ntry: " + " ".join([found[0], *sys.argv]) if found else "")
    )

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
STAMP = VENV / "installed"  # what the last complete installation was made from
PYTHON = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
DECK = ROOT / "examples" / "ball-rolling.dat"
OUT = ROOT / "out"
WORKERS = 2


def main() -> int:
    """Obey the command line; returns the exit status."""
    command, options = (sys.argv[1:2] or [""])[0], sys.argv[2:]
    if command not in ("run", "test"):
        print(__doc__)
        return 0 if command in ("-h", "--help") else 2
    install("test" if command == "test" else "")
    return run(options) if command == "run" else test(options)


def install(extra: str) -> None:
    """Have the package with its dependencies, and those of `extra`, in .venv."""
    where = str(ROOT) + " " + sys.version[:4]
    digest = hashlib.sha256((ROOT / "pyproject.toml").read_bytes()).hexdigest()
    before = STAMP.read_text().split("\n") if STAMP.exists() else ["", "", ""]
    if not PYTHON.exists() or before[0] != where:
        make_venv()
    elif before[1] == digest and extra in ("", before[2]):
        return
    print("installing into " + str(VENV) + ", once, a minute or two ...", flush=True)
    package = str(ROOT) + ("[" + extra + "]" if extra else "")
    pip = [PYTHON, "-m", "pip", "--disable-pip-version-check", "install", "--quiet", "--editable", package]
    if subprocess.run(pip, check=False).returncode:
        sys.exit("the installation failed: see pip's message above; is the network there?")
    STAMP.write_text("\n".join([where, digest, extra]))


def make_venv() -> None:
    """A new .venv; exits with advice where Python has been packaged without venv or pip."""
    made = subprocess.run(
        [sys.executable, "-m", "venv", "--clear", VENV], check=False, capture_output=True, text=True
    )
    if made.returncode:
        shutil.rmtree(VENV, ignore_errors=True)
        sys.exit(
            made.stdout + made.stderr + "\nPython's venv or pip is missing. "
            "On Debian or Ubuntu: apt install python3-venv python3-pip; on Fedora: dnf install python3-pip."
        )


def run(options: list[str]) -> int:
    """Run the main job and say where its files are."""
    started = time.time()
    status = step("-m", "udec_ia", "run", str(DECK), "--out", str(OUT), *options)
    written = sorted(path for path in OUT.glob("*") if path.stat().st_mtime >= started - 1)
    if written:
        print("\n" + "\n    ".join(["The files are in " + str(OUT) + ":", *(path.name for path in written)]))
    return status


def test(options: list[str]) -> int:
    """Run the tests and the static checks; all of them, even when one fails."""
    statuses = [
        step("-m", "pytest", "-n", str(WORKERS), *options),
        step("-m", "ruff", "check", "."),
        step("-m", "ruff", "format", "--check", "."),
        step("-m", "mypy"),
        step("-m", "offsets", "--check"),
    ]
    return 1 if any(statuses) else 0


def step(*arguments: str) -> int:
    """Run .venv's Python in the checkout; returns the exit status."""
    print("$ " + " ".join(["python", *arguments]), flush=True)
    return subprocess.run([PYTHON, *arguments], check=False, cwd=ROOT).returncode


if __name__ == "__main__":
    sys.exit(main())
