"""One command from a fresh checkout to a result: `python3 tools/start.py run` or `... test`.

Needs git (for the checkout) and Python 3.11 or later with venv and pip, nothing else. Everything is
installed into .venv inside the checkout, in the releases that tools/constraints.txt names; a second run
installs nothing unless these or pyproject.toml have changed.

    run    [OPTIONS]   run the main job, examples/ball-rolling.dat, into out/; OPTIONS go to `udec run`
    test   [OPTIONS]   run the tests, ruff, mypy and the check of generated files; OPTIONS go to pytest
    newest [OPTIONS]   the same with the newest releases that pyproject.toml allows, in .venv-newest
    oldest [OPTIONS]   the tests with the oldest releases that it allows (tools/oldest.txt), in .venv-oldest

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
PLACES = {  # what each command installs into, and what says which releases of other packages it takes
    "run": (".venv", "constraints.txt"),
    "test": (".venv", "constraints.txt"),
    "newest": (".venv-newest", ""),
    "oldest": (".venv-oldest", "oldest.txt"),
}
DECK = ROOT / "examples" / "ball-rolling.dat"
OUT = ROOT / "out"
WORKERS = 2


def main() -> int:
    """Obey the command line; returns the exit status."""
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # else each of hundreds of processes compiles it all
    command, options = (sys.argv[1:2] or [""])[0], sys.argv[2:]
    if command not in PLACES:
        print(__doc__)
        return 0 if command in ("-h", "--help") else 2
    folder, releases = PLACES[command]
    python = install(ROOT / folder, releases, "" if command == "run" else "test")
    if command == "run":
        return run(python, options)
    return test(python, options, typed=command != "oldest")


def install(venv: Path, releases: str, extra: str) -> Path:
    """Have the package with its dependencies, and those of `extra`, in `venv`. Returns the Python there.

    releases: file in tools/ with the releases to take; "" for the newest, which are looked for every time.
    """
    python = venv / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    stamp = venv / "installed"  # what the last complete installation was made from
    where = str(ROOT) + " " + sys.version[:4]
    wanted = (ROOT / "pyproject.toml").read_bytes()
    environment = dict(os.environ)
    newest = ["--upgrade", "--upgrade-strategy", "eager"]
    if releases:
        newest = []
        wanted += (ROOT / "tools" / releases).read_bytes()
        for name in ("PIP_CONSTRAINT", "PIP_BUILD_CONSTRAINT"):  # the latter for what builds the package
            environment[name] = "tools/" + releases  # pip would take a blank in a whole path for an end
    digest = hashlib.sha256(wanted).hexdigest()
    before = stamp.read_text().split("\n") if stamp.exists() else ["", "", ""]
    if not python.exists() or before[0] != where:
        make_venv(venv)
    elif releases and before[1] == digest and extra in ("", before[2]):
        return python
    print("installing into " + str(venv) + ", a minute or two ...", flush=True)
    package = "." + ("[" + extra + "]" if extra else "")
    pip = [python, "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    pip += ["--no-compile", "--editable", package]  # Python compiles what is imported, and keeps it
    if subprocess.run(pip + newest, check=False, cwd=str(ROOT), env=environment).returncode:
        sys.exit("the installation failed: see pip's message above; is the network there?")
    stamp.write_text("\n".join([where, digest, extra]))
    return python


def make_venv(venv: Path) -> None:
    """A new environment; exits with advice where Python has been packaged without venv or pip."""
    made = subprocess.run(
        [sys.executable, "-m", "venv", "--clear", venv], check=False, capture_output=True, text=True
    )
    if made.returncode:
        shutil.rmtree(venv, ignore_errors=True)
        sys.exit(
            made.stdout + made.stderr + "\nPython's venv or pip is missing. "
            "On Debian or Ubuntu: apt install python3-venv python3-pip; on Fedora: dnf install python3-pip."
        )


def run(python: Path, options: list[str]) -> int:
    """Run the main job and say where its files are."""
    started = time.time()
    status = step(python, "-m", "udec_ia", "run", str(DECK), "--out", str(OUT), *options)
    written = sorted(path for path in OUT.glob("*") if path.stat().st_mtime >= started - 1)
    if written:
        print("\n" + "\n    ".join(["The files are in " + str(OUT) + ":", *(path.name for path in written)]))
    return status


def test(python: Path, options: list[str], typed: bool) -> int:
    """Run the tests and the static checks; all of them, even when one fails.

    typed: mypy too. The stubs of the oldest NumPy and matplotlib say less than those of today.
    """
    if not options:  # all tests: what they need is compiled once, and not by each of the workers
        step(python, "tools/compile_for_tests.py", str(WORKERS + 1))  # five tasks in two turns
    statuses = [
        step(python, "-m", "pytest", "-n", str(WORKERS), "--dist", "worksteal", *options),
        step(python, "-m", "ruff", "check", "."),
        step(python, "-m", "ruff", "format", "--check", "."),
        step(python, "-m", "mypy") if typed else 0,
        step(python, "-m", "offsets", "--check"),
    ]
    return 1 if any(statuses) else 0


def step(python: Path, *arguments: str) -> int:
    """Run `python` in the checkout; returns the exit status."""
    print("$ " + " ".join(["python", *arguments]), flush=True)
    return subprocess.run([python, *arguments], check=False, cwd=ROOT).returncode


if __name__ == "__main__":
    sys.exit(main())
