"""Stiff contacts under each kind of damping: do they open and close again and again, and does the slope hold?

    python docs/studies/chatter_by_damping.py [--cycles 6000]

Courses of bricks, 3 m long and 1 m high, on a slope of 30 degrees, whose friction would hold them at 45. KN
is 1e10 N/m2, and a brick swings on two such contacts at about 260 Hz. Nothing bears a force at first; the
weight comes at once. FRACTION 0.5 SAFE. In the last 1000 cycles:

- changes: contacts that open or close from one cycle to the next, in the mean. They bear a force or do not.
- closed: contacts that bear a force in the last cycle.
- chatter: the share of contacts that chatter by the program's own monitor, and, if it has warned of chatter, the
  cycle by which it first did.
- ratio: the greatest unbalanced force over the mean of those that are carried, in the last cycle.
- moved: the longest way of a brick since the beginning, in m.

Warnings go to standard error.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from support.brick_slope import slope
from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

LAST = 1000  # cycles that are looked at one by one
KINDS: dict[str, dict[str, Any]] = {
    "none": {},
    "MASS, 0.5 at 1 Hz": {"fcrit": 0.5, "freq": 1, "only": "mass"},
    "MASS, 0.5 at 260 Hz": {"fcrit": 0.5, "freq": 260, "only": "mass"},
    "STIFFNESS, 0.5 at 260 Hz": {"fcrit": 0.5, "freq": 260, "only": "stiffness"},
    "both, 0.5 at 260 Hz": {"fcrit": 0.5, "freq": 260},
    "LOCAL 0.8": {"local": 0.8},
    "COMBINED 0.8": {"combined": 0.8},
    "KINETIC": {"kinetic": True},
    "ADAPTIVE 0.7": {"adaptive": 0.7},
}


def closed(m: Model) -> set[int]:
    """Contacts that bear a force."""
    rows = m.table("contact")
    return set(rows["address"][rows["KCFN"] > 0].tolist())


def look(kind: str, cycles: int) -> list[str]:
    """The cells of the row."""
    m, told = slope("/tmp"), [0]
    m.fraction(0.5, safe=True)

    def tell(text: str) -> None:
        if text.startswith("contacts chatter"):
            told.append(int(m.h.ci[g.MCTOT]))
        print(f"{kind}: {text}", file=sys.stderr)

    m.tell, m.inform = tell, lambda _: None
    if KINDS[kind]:
        m.damping(**KINDS[kind])
    (ratio,) = m.history(LAST, "RATIO")
    places = np.array([m.table("block")[k] for k in ("KX", "KY")])
    m.cycle(cycles - LAST)
    before, changes = closed(m), []
    for _ in range(LAST):
        m.cycle(1)
        now = closed(m)
        changes.append(len(now ^ before))
        before = now
    moved = float(np.hypot(*(np.array([m.table("block")[k] for k in ("KX", "KY")]) - places)).max())
    share = f"{m.session.monitors.chatter.share:.2f}" + (f", warned by {told[1]}" if told[1:] else "")
    return [
        f"{np.mean(changes):.2f}",
        str(len(before)),
        share,
        f"{ratio.numbers[-1][-1]:.1e}",
        f"{moved:.1e}",
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--cycles", type=int, default=6000)
    given = parser.parse_args()
    print("| damping | changes | closed | chatter | ratio | moved, m |\n|---|---|---|---|---|---|")
    for kind in KINDS:
        try:
            cells = look(kind, given.cycles)
        except UdecError as error:
            print(f"{kind}: {error}", file=sys.stderr)
            cells = [f"error {error.number}", *"----"]
        print(f"| {kind} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
