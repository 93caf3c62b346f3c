"""The checked build: the same words, and error 20 with routine, address and field for a wrong pointer."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from numba.core import config

from udec_ia.layout import offsets as g

ROOT = Path(__file__).parents[2]
TESTS = ROOT / "tests"
EVERY = 7  # of the wrong pointers where kernels are interpreted
ASTRAY = re.compile(
    r"(\w+@\d+\.\w+) (.+): error 20: internal error, the main array is damaged: "
    r"\w+ \(\w+/\w+\.py\) (?:reads|writes|gives back) .* at (-?\d+): that is (.+)"
)
THERE = {"a block": "a block", "junk": "a group that was given back", "in a block": "a word of block@"}
CHOSEN = """
import udec_ia.cli
udec_ia.cli.main(["--checked", "a.dat"])
from udec_ia.compiling.build_choice import CHECKED
print(CHECKED)
"""


def run(*args: str, cwd: Path = ROOT, **more: str) -> subprocess.CompletedProcess[str]:
    """Python with `args`, in an environment that chooses no build but by `more`."""
    env = {key: value for key, value in os.environ.items() if key != "UDEC_CHECKED"}
    env |= {"PYTHONPATH": os.pathsep.join([str(ROOT), str(TESTS)]), **more}
    command = [sys.executable, *args]
    return subprocess.run(command, env=env, cwd=cwd, capture_output=True, text=True, timeout=500, check=False)


def walk_planted(every: int, **more: str) -> list[str]:
    """The lines of tests/support/planted_pointers.py."""
    done = run(str(TESTS / "support" / "planted_pointers.py"), str(every), **more)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


@pytest.fixture(scope="module")
def interpreted() -> list[str]:
    """Of some wrong pointers, interpreted."""
    return walk_planted(EVERY, UDEC_CHECKED="1", NUMBA_DISABLE_JIT="1")


def proven(lines: list[str]) -> set[str]:
    """Prove what the checked build says of wrong pointers; the fields of which it says something."""
    named = set()
    for line in lines[3:]:
        assert "it has changed words" not in line
        if "error 20" in line and ": before: " not in line:
            printed = ASTRAY.fullmatch(line)
            assert printed, line
            named.add(printed[1].partition("@")[0] + "." + printed[1].partition(".")[2])
            if printed[2] in THERE:
                assert printed[4].startswith(THERE[printed[2]]), line
    return named


def test_the_words_are_those_of_the_ordinary_build(interpreted: list[str]) -> None:
    """And the kinds of groups that FIND and LOSE have noted are those that a census finds."""
    assert walk_planted(1, NUMBA_DISABLE_JIT="1") == interpreted[:3]
    assert interpreted[2] == "True"


def test_wrong_pointers_are_named_where_kernels_are_interpreted(interpreted: list[str]) -> None:
    assert {"block.KB", "corner.KR", "contact.KC"} <= proven(interpreted)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_compiled_kernels_say_the_same(interpreted: list[str]) -> None:
    """And come to the same bits. Of all pointers of all kinds; none ends the process, or goes in a circle."""
    lines = walk_planted(1, UDEC_CHECKED="1")
    assert lines[:3] == interpreted[:3]
    assert lines[3::EVERY] == interpreted[3:]
    assert len(lines) > 500
    assert {"block.KP", "contact.KB1", "contact.KCP1", "zone.KZG", "gridpoint.KG"} <= proven(lines)


@pytest.mark.parametrize("first", ["", "m.displacements();"])
def test_a_block_with_zones_is_cut(first: str) -> None:
    """Grid-points, which have no head code, are copied, and the displacements behind them."""
    cut = f"""
from udec_ia import Model
m = Model(); {first} m.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=5e7)
m.block(0, 0, 0, 2, 4, 2, 4, 0); m.split(-1, 1, 5, 1); m.round(0.05); m.fix(0, 4, 0, 1)
m.generate(0, 4, 1, 2, edge=0.8); m.cycle(1); m.split(2.2, 0.5, 2.3, 3)
print(len(m.table("block")), m.check())
"""
    done = run("-c", cut, UDEC_CHECKED="1", NUMBA_DISABLE_JIT="1")
    assert done.stdout.splitlines()[-1:] == ["3 []"], done.stderr


def test_water_may_come_without_joint_materials() -> None:
    """Contacts and domains are lengthened twice, for joints and for water."""
    wet = """
from udec_ia import Model
m = Model(); m.property(1, density=1000, kn=1e8, ks=1e8); m.block(0, 0, 0, 3, 4, 3, 4, 0)
m.split(-1, 1, 5, 1); m.split(-1, 2, 5, 2); m.round(0.05); m.fluid(kw=1e7)
print(len(m.table("water")) > 0, m.check())
"""
    done = run("-c", wet, UDEC_CHECKED="1", NUMBA_DISABLE_JIT="1")
    assert done.stdout.splitlines()[-1:] == ["True []"], done.stderr


def test_it_is_chosen_on_the_command_line(tmp_path: Path) -> None:
    """Where the name of a deck alone is enough."""
    (tmp_path / "a.dat").write_text("START\nSTOP\n")
    done = run("-c", CHOSEN, cwd=tmp_path)
    assert done.stdout.splitlines()[-1] == "True", done.stderr


def test_it_is_too_late_once_kernels_are_loaded() -> None:
    done = run("-c", "import udec_ia.model, udec_ia.cli; exit(udec_ia.cli.main(['--checked', 'info', 'x']))")
    assert done.returncode == 2
    assert "kernels are already loaded: set UDEC_CHECKED=1" in done.stderr


def test_chatter_is_looked_for_in_both_builds() -> None:
    """A size has more numbers behind it in the checked build: words that share a mark are as many as ever."""
    import_it = "from udec_ia.kernels.drive.cycle import STRIDE; print(STRIDE)"
    assert {run("-c", import_it, UDEC_CHECKED=build).stdout for build in "01"} == {f"{min(g.NVCN[:3])}\n"}
