"""The wheel and the sdist: built, and used where there is no checkout.

A wheel is built from the sdist and unpacked into a folder of its own; from a third folder a deck is run
with nothing but that folder on the path. So whatever the program needs must be in the wheel, and it must
not write beside its own sources. The dependencies are those of the running Python. Last, tools/start.py
must get so far on an old Python that it can say what is wrong, and it must install releases that
pyproject.toml allows.
"""

from __future__ import annotations

import ast
import os
import runpy
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from functools import partial
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

import udec_ia

ROOT = Path(__file__).parents[2]
START = ROOT / "tools" / "start.py"
DECK = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5
BLOCK 0,0 0,2 2,2 2,0
SPLIT -1,1 3,1
FIX 0,2 0,1
GRAVITY 0 -10
CYCLE 10
PRINT BLOCKS CONTACTS
SAVE
STOP
"""


def run(*arguments: str, cwd: Path, **environment: str) -> str:
    """Output of this Python with `arguments`, run in `cwd` with `environment` added to its own."""
    inherited = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=cwd,
        env=inherited | environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The sdist, and the wheel built from what is in it."""
    folder = tmp_path_factory.mktemp("dist")
    run("-m", "build", "--no-isolation", "--outdir", str(folder), str(ROOT), cwd=folder)
    (sdist,), (wheel,) = folder.glob("*.tar.gz"), folder.glob("*.whl")
    return sdist, wheel


@pytest.fixture(scope="module")
def installed(built: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, unpacked."""
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(built[1]) as wheel:
        wheel.extractall(folder)
    return folder


def away(installed: Path) -> dict[str, str]:
    """What makes Python use the unpacked wheel, and keep its own files out of it."""
    return {"PYTHONPATH": str(installed), "PYTHONDONTWRITEBYTECODE": "1"}


def files(folder: Path) -> dict[str, int]:
    """Every file below `folder` and when it was written."""
    return {
        str(path.relative_to(folder)): path.stat().st_mtime_ns for path in folder.rglob("*") if path.is_file()
    }


def test_what_is_in_the_wheel(built: tuple[Path, Path]) -> None:
    with zipfile.ZipFile(built[1]) as wheel:
        names = set(wheel.namelist())
    sources = {
        str(path.relative_to(ROOT))
        for path in (ROOT / "udec_ia").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    examples = {
        f"udec_ia/{path.relative_to(ROOT)}"
        for pattern in ("*.dat", "verify/*.py")
        for path in (ROOT / "examples").glob(pattern)
    }
    info = f"udec_ia-{udec_ia.__version__}.dist-info/"
    assert {name for name in names if not name.startswith(info)} == sources | examples
    assert {"udec_ia/layout/groups.table", "udec_ia/layout/offsets.py", "udec_ia/py.typed"} <= names
    assert {info + "entry_points.txt", info + "licenses/LICENSE"} <= names


def test_what_is_in_the_sdist(built: tuple[Path, Path]) -> None:
    with tarfile.open(built[0]) as sdist:
        names = {name.partition("/")[2] for name in sdist.getnames()}
    for name in (
        "README.md",
        "LICENSE",
        "pyproject.toml",
        "tools/start.py",
        "tools/constraints.txt",
        "docs/map.md",
        "offsets/groups.table",
    ):
        assert name in names
    for folder in ("tests", "examples", "docs/images"):
        there = {
            str(path.relative_to(ROOT))
            for path in (ROOT / folder).rglob("*.*")
            if path.is_file() and "__pycache__" not in path.parts
        }
        assert len(there) > 0
        assert there <= names


def test_a_deck_runs_away_from_the_checkout(installed: Path, tmp_path: Path) -> None:
    """Uncompiled, which saves a minute and takes the same way through the sources."""
    before = files(installed)
    (tmp_path / "two.dat").write_text(DECK)
    udec = partial(run, "-m", "udec_ia", cwd=tmp_path, NUMBA_DISABLE_JIT="1", **away(installed))
    assert udec("--version").split() == ["udec_ia", udec_ia.__version__]
    output = udec("run", "two.dat", "--out", "results")
    assert "10 cycles" in output
    assert "2 blocks" in output
    assert udec("check", "results/restart.h5").strip().endswith("sound")
    assert {path.name for path in tmp_path.iterdir()} == {"two.dat", "results"}
    assert files(installed) == before


def test_the_problems_come_with_the_wheel(installed: Path, tmp_path: Path) -> None:
    before = files(installed)
    verify = partial(run, "-m", "udec_ia", "verify", cwd=tmp_path, NUMBA_DISABLE_JIT="1", **away(installed))
    listed = verify("--list").splitlines()[1:]
    there = {path.stem for path in (ROOT / "examples" / "verify").glob("*.py")}
    assert {line.split()[0] for line in listed} == there
    assert "1 case, all within tolerance" in verify("eccentric", "--blocks", "rigid")
    assert files(installed) == before


def test_the_examples_come_with_the_wheel(installed: Path, tmp_path: Path) -> None:
    run("-m", "udec_ia", "examples", "--to", "decks", cwd=tmp_path, **away(installed))
    decks = {path.name: path.read_bytes() for path in (ROOT / "examples").glob("*.dat")}
    assert {path.name: path.read_bytes() for path in (tmp_path / "decks").iterdir()} == decks


def test_compiled_kernels_are_kept_outside_the_package(installed: Path, tmp_path: Path) -> None:
    before = files(installed)
    find = (
        "from udec_ia.heap import accessors, find_lose, main_array, word_scheme\n"
        "from udec_ia.layout.offsets import NVCR\n"
        "h = main_array.MainArray(word_scheme.scheme('i32r64')).h\n"
        "print(accessors.__file__, find_lose.find(h, NVCR))"
    )
    cache = tmp_path / "cache"
    output = run("-c", find, cwd=tmp_path, UDEC_CACHE=str(cache), **away(installed)).split()
    assert Path(output[0]).is_relative_to(installed)
    assert output[1:] == ["1"]
    assert any(cache.rglob("*.nbc"))
    assert files(installed) == before


def test_an_old_python_is_told_so(monkeypatch: pytest.MonkeyPatch) -> None:
    ast.parse(START.read_text(), feature_version=(3, 5))
    monkeypatch.setattr(sys, "version_info", (3, 9, 2))
    monkeypatch.setattr(sys, "version", "3.9.2 (main)")
    with pytest.raises(SystemExit, match=r"^Python 3\.11 or later is needed, this is 3\.9\.2"):
        runpy.run_path(str(START))


def releases(name: str, python: str) -> dict[str, Version]:
    """The releases that a file in tools/ names for a Python."""
    lines = (ROOT / "tools" / name).read_text().splitlines()
    given = [Requirement(line) for line in lines if not line.startswith("#")]
    taken = [one for one in given if one.marker is None or one.marker.evaluate({"python_version": python})]
    found = {canonicalize_name(one.name): Version(str(one.specifier).removeprefix("==")) for one in taken}
    assert len(found) == len(taken)
    return found


@pytest.mark.parametrize("python", ["3.11", "3.12", "3.13"])
def test_what_start_installs_is_what_the_package_allows(python: str) -> None:
    """The oldest releases are the lower bounds themselves, where they were built for this Python."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    wanted = [
        Requirement(line) for line in project["dependencies"] + project["optional-dependencies"]["test"]
    ]
    pinned, oldest = releases("constraints.txt", python), releases("oldest.txt", python)
    for one in wanted:
        name = canonicalize_name(one.name)
        assert one.specifier.contains(pinned[name])
        least = [part.version for part in one.specifier if part.operator == ">="]
        assert (name in oldest) == bool(least)
        for version in least:
            assert oldest[name] == Version(version) or (python > "3.11" and oldest[name] > Version(version))


def test_whatever_is_installed_is_pinned() -> None:
    """Also what the packages of this environment ask for in turn."""
    pinned, seen = releases("constraints.txt", f"{sys.version_info[0]}.{sys.version_info[1]}"), set()
    if any(Version(metadata.version(name)) != pinned[name] for name in ("numpy", "numba", "pytest")):
        pytest.skip("these are the newest or the oldest releases")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    left = [*project["dependencies"], *project["optional-dependencies"]["test"]]
    while left:
        one = Requirement(left.pop())
        name = canonicalize_name(one.name)
        if name in seen or (one.marker is not None and not one.marker.evaluate({"extra": ""})):
            continue
        seen.add(name)
        assert name in pinned
        left += metadata.requires(name) or []
