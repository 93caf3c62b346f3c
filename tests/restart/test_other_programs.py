"""Two programs with different field tables take turns with one run, and it is the run that one of them makes.

The other program is a copy of this one whose table was changed, with all that follows from it: new fields in
the middle of groups, a new kind of group, codes and head codes by other numbers, variables in another order.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from naive.relocate import differences, essence
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.layout.field_table import TABLE, read_table
from udec_ia.restart import read_stored_state

ROOT = Path(__file__).parents[2]
NEXT = read_table().layout + 1
NAIL = """\
GROUP  nail  NVNA  INAPNT  ours | one nail
HEAD   int   -     head  -  ours/{1} | MNAIL
KNA    int   nail  next  -  ours/{1} | next nail; 0 at the end of the list
"""
NAILS = "INAPNT  int  nail  head  -  ours/{1} | list of nails; 0 when there are none"
CHANGES = [
    ("LAYOUT  {0}\n", "LAYOUT  {1}\n"),
    ("\nKX     real", "\nKNEW   real*3  -  data  m  ours/{1} | new\nKX     real"),
    ("\nKHG    int", "\nKHNEW  int  -  data  -  ours/{1} | new\nKHG    int"),
    ("\nKLB    int", "\nKPNEW  int  block  data  -  ours/{1} | new; 0 for none\nKLB    int"),
    ("\nTIME    double", "\nTNEW    double  -  data  s  ours/{1} | new\nTIME    double"),
    ("\nGROUP  corner", f"\n{NAIL}\nGROUP  corner"),
    ("\nNBLK    int", f"\n{NAILS}\nNBLK    int"),
    ("HEAD  MCOR   4", "HEAD  MNAIL  92  nail  | nail\nHEAD  MCOR   93"),
    ("VIRTUAL        4 ", "VIRTUAL        5 "),
    ("KCCOD  int   1..4 ", "KCCOD  int   1..5 "),
    ("GIVEN_X  2 ", "GIVEN_X  4 "),
    ("GIVEN_Y  4 ", "GIVEN_Y  2 "),
]
SCRIPT = """
import sys
from udec_ia import Model
from udec_ia.layout import offsets as g

m = Model.restore(sys.argv[1], out=sys.argv[3])
assert m.check() == [], m.check()
m.cycle(3)
m.delete(0, 1, 0, 1)
m.cycle(2)
m.save(sys.argv[2])
print(g.MCOR, g.VIRTUAL, g.GIVEN_X, m.array.h.ci[g.MCTOT])
"""


def other_program(folder: Path) -> Path:
    """A copy of the program with another table."""
    for package in ("offsets", "udec_ia"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    table = TABLE.read_text()
    for old, new in CHANGES:
        old, new = old.format(NEXT - 1, NEXT), new.format(NEXT - 1, NEXT)
        assert table.count(old) == 1, old
        table = table.replace(old, new)
    (folder / "offsets" / "groups.table").write_text(table)
    layouts = folder / "offsets" / "layouts.txt"
    layouts.write_text(layouts.read_text().replace("  draft\n", "\n"))  # as if this program were released
    return folder


def run(tree: Path, *arguments: str) -> str:
    """What Python prints, run in the checkout `tree` without compiling."""
    environment = {**os.environ, "PYTHONPATH": str(tree), "NUMBA_DISABLE_JIT": "1", "UDEC_CACHE": str(tree)}
    command = [sys.executable, *arguments]
    done = subprocess.run(command, cwd=tree, env=environment, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_two_programs_take_turns(tmp_path: Path) -> None:
    one, tree = every_kind(), other_program(tmp_path / "tree")
    one.out = tmp_path
    one.history(1, "TIME")
    one.cycle(5)
    run(tree, "-m", "offsets")
    saved, theirs = one.save(tmp_path / "one.h5"), tmp_path / "theirs.h5"
    printed = run(tree, "-c", SCRIPT, str(saved), str(theirs), str(tmp_path / "other"))
    assert printed == "93 5 4 10\n"
    assert "known here, and 0" in read_stored_state(theirs).notes[0]
    two = Model.restore(theirs, out=tmp_path / "two")
    one.cycle(3)
    one.delete(0, 1, 0, 1)
    one.cycle(2)
    assert differences(essence(one.array), essence(two.array)) == []
    for m in (one, two):
        m.cycle(5)
    assert differences(essence(one.array), essence(two.array)) == []
    assert [s.numbers.tobytes() for s in one.histories()] == [s.numbers.tobytes() for s in two.histories()]
    assert two.check() == []
