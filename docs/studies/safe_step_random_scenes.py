"""The safe time-step over random scenes, against the true limit of their matrices.

    python docs/studies/safe_step_random_scenes.py [--first 0] [--count 5000] [--kinds rigid deformable]
                                                     [--file FILE] [--out PICTURE]

Looks at COUNT scenes of each kind from seed FIRST on and notes them in FILE, where a search that was cut off
goes on; then prints a table of all that are in FILE. --out: draws how many scenes have a bound, and an
estimate, of what share of the limit.
"""

from __future__ import annotations

import argparse
import logging
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from safe_step_picture import draw
from support.safe_step_search import LIMITS, read, search, summary

HEAD = (
    "kind|layout|scenes|bound: least|1 of 100|median|greatest|estimate: least|median|greatest|above 1|too low"
)


def main() -> None:
    """Search, and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=5000)
    parser.add_argument("--kinds", nargs="+", choices=list(LIMITS), default=list(LIMITS))
    parser.add_argument("--file", type=Path, default=Path("random_scenes.csv"))
    parser.add_argument("--out", type=Path)
    given = parser.parse_args()
    logging.disable(logging.CRITICAL)
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
