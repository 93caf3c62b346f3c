"""NaN and infinity planted in every real word of a small scene: is each noticed, and how soon?

    python docs/studies/planted_infinities.py [--build i32r64]

The scene: a rigid, a simply- and a fully-deformable block on a fixed one, with a load.
One real at a time is made NaN, then infinite: of every field of every kind of group, in the group that
stands last in its list, and of the common block. First the checker looks, as it does after RSET and before a
restart file is used: `named` counts the words that it names. Then one cycle is run all the same, as if the
word had come out of a computation. `noticed`: an error says so. `healed`: there is a number again, and the
state is that of a run without it, but for when domains are looked at next. `stays`: it is still there, and
nothing else differs: no pass has read it. Anything else has `spread`. What stays or spreads is listed.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from udec_ia import Model, UdecError
from udec_ia.checker import check
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import read_table

Word = tuple[str, int, object]
PLANTED = {"NaN": np.nan, "infinity": np.inf}


def scene(build: str) -> Model:
    """One of each kind of body, after 20 cycles."""
    m = Model(build, out="/tmp")
    m.tell = m.inform = lambda _: None
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e9, g=6e8)
    m.round(0.05)
    m.gravity(0, -10)
    m.damping(0.2, 5)
    m.block(0, -1, 0, 1, 3, 1, 3, -1)
    m.split(-1, 0, 4, 0)
    for x in (1, 2):
        m.split(x, 0, x, 2)
    m.fix(0, 3, -1, 0)
    m.change(1, 2, 0, 1, type="sdef")
    m.change(2, 3, 0, 1, type="fdef")
    m.generate(2, 3, 0, 1, "automatic", edge=1.0)
    m.boundary(0, 1, 0, 1, xforce=10.0)
    m.cycle(20)
    return m


def words(m: Model) -> list[Word]:
    """Every real there is: its name, the address of a group or 0, its offset or index."""
    found: list[Word] = []
    for group in read_table().groups:
        rows = m.table(group.name)
        if not len(rows):
            continue
        address = int(rows["address"][-1])
        found += [
            (f"{group.name}.{field.name}", address, getattr(g, field.name))
            for field in group.fields
            if field.real
        ]
    names = {index: name for name, index in vars(g).items() if name.isupper() and isinstance(index, int)}
    found += [(f"common {names.get(k, k)}", 0, k) for k in range(len(m.h.cr))]
    return found


def reals(m: Model) -> np.ndarray:
    h = m.array.h
    return np.concatenate([h.ra[: int(h.ci[g.MFREE])], h.cr, h.cd])


def searching(m: Model) -> np.ndarray:
    """Where, among `reals`, the displacements stand that say when domains are looked at."""
    h = m.array.h
    ratio = h.ra.itemsize // h.ia.itemsize
    offset = g.KUMAX[ratio >> 1] - 1
    places = [(int(ad) - 1) // ratio + offset for ad in m.table("domain")["address"]]
    return np.array([*places, int(h.ci[g.MFREE]) + g.UPEND, int(h.ci[g.MFREE]) + g.ULOOK])


def place(m: Model, address: int, k: Any) -> int:
    """Where, among `reals`, a word stands."""
    h = m.array.h
    ratio = int(h.ra.itemsize // h.ia.itemsize)
    return (address - 1) // ratio + int(k[ratio >> 1]) - 1 if address else int(h.ci[g.MFREE]) + int(k)


def plant(file: Path, build: str, word: Word, value: float, right: np.ndarray) -> tuple[bool, str]:
    """Whether the checker names it, and what one cycle makes of it."""
    m = Model(build, out="/tmp")
    m.tell = m.inform = lambda _: None
    m.restart(str(file))
    _, address, k = word
    h = m.array.h
    if address:
        putr(h, address, k, value)  # by the accessor: not through m.h, which would have the heap proved
    else:
        h.cr[k] = value
    named = any(True for _ in check(m.array))
    try:
        with np.errstate(all="ignore"):
            m.cycle(1)
    except UdecError:
        return named, "noticed"
    now = reals(m)
    other = np.setdiff1d(np.flatnonzero(now != right), searching(m))
    if not len(other):
        return named, "healed"
    return named, "stays" if [*other] == [place(m, address, k)] else "spread"


def main() -> None:
    """Plant, and print the table and what has spread."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--build", default="i32r64")
    given = parser.parse_args()
    file = Path("/tmp/planting.h5")
    m = scene(given.build)
    m.save(str(file))
    todo = words(m)
    m.cycle(1)
    right = reals(m)
    print("| planted | words | named | noticed | healed | stays | spread |\n|---|---|---|---|---|---|---|")
    spread = []
    for name, value in PLANTED.items():
        found = {word[0]: plant(file, given.build, word, value, right) for word in todo}
        count = Counter(what for _, what in found.values())
        kinds = [str(count[kind]) for kind in ("noticed", "healed", "stays", "spread")]
        named = sum(named for named, _ in found.values())
        print(f"| {name} | {len(found)} | {named} | {' | '.join(kinds)} |", flush=True)
        left = {word: what for word, (_, what) in found.items() if what in ("stays", "spread")}
        spread += [f"{name} in {word}: {what}" for word, what in left.items()]
        spread += [f"not named: {name} in {word}" for word, (named, _) in found.items() if not named]
    for one in spread:
        print("-", one)


if __name__ == "__main__":
    main()
