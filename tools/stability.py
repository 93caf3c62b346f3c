"""The safe time-step over random scenes, against the true limit of their matrices: docs/stability.md.

    python tools/stability.py [--first 0] [--count 5000] [--kinds rigid deformable] [--file FILE] [--table]
                              [--out PICTURE]

looks at COUNT scenes of each kind from seed FIRST on (tools/studies/safe_steps), notes them in FILE, where a
search that was cut off goes on, and prints the table of the page. --table: only the table. --out: draws how
many scenes have a bound, and an estimate, of what share of the limit.
"""

from __future__ import annotations

import argparse
import logging
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "studies"))
sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from safe_steps.picture import draw
from safe_steps.search import LIMITS, read, search, summary

HEAD = (
    "kind|layout|scenes|bound: least|1 of 100|median|greatest|estimate: least|median|greatest|above 1|too low"
)


def main() -> None:
    """Search, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--kinds", nargs="+", choices=list(LIMITS), default=list(LIMITS))
    parser.add_argument("--file", type=Path, default=Path("stability.csv"))
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    logging.disable(logging.CRITICAL)
    if not given.table:
        search(given.kinds, given.first, given.count, given.file)
    found = list(read(given.file))
    if given.out:
        draw(found, given.out)
    names = HEAD.split("|")
    print("|", " | ".join(names), "|")
    print("|" + "---|" * len(names))
    for row in summary(found):
        print("|", " | ".join(row), "|")


if __name__ == "__main__":
    main()
