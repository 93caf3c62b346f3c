"""What the widths of integers and reals cost, bear and lose.

    python docs/studies/word_scheme_costs.py

prints the tables of docs/words.md. First those that are alike wherever they are made: the deck
examples/ball-rolling.dat is run in all five word schemes, without its plots, and held against the formulas
for a disc that rolls. Then what 32-bit reals lose in the scenes of word_scheme_scenes.py, and what each takes.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from math import hypot
from pathlib import Path
from typing import NamedTuple

from word_scheme_scenes import SCENES, Run, losses, rest, run, times, way

from udec_ia import Model
from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME
from udec_ia.layout.offsets import MFREE, NBLK

DECK = Path(__file__).parents[2] / "examples" / "ball-rolling.dat"
SIDE, RADIUS, DENSITY, KN, STEP = 5**0.5, 1.115, 2000.0, 1e8, 0.002  # of the deck; s, m, kg/m3, N/m
NARROW = "i32r32"
PRICED = "ball", "wall of squares", "slab, 1,000 blocks"
LEFT_OUT = ("PLOT", "P B", "SAVE", "STOP", "END")


class Ball(NamedTuple):
    """overlap (m) and force (N/m) of the settled ball; travelled: m, after 200, 400, ... 1000 cycles."""

    overlap: float
    force: float
    travelled: list[float]


def expected() -> Ball:
    """By formula: the ball settles under gravity (4, -8) on a slope of 1 in 2, and rolls under (0, -10)."""
    mass = DENSITY * SIDE**2
    force = mass * (4 * 1 + 8 * 2) / 5**0.5
    acceleration = 10 / 5**0.5 / (1 + SIDE**2 / 6 / RADIUS**2)
    return Ball(force / KN, force, [acceleration * (200 * k * STEP) ** 2 / 2 for k in range(1, 6)])


def roll(build: str) -> Ball:
    """The ball as the deck has it."""
    m = Model(build)
    settled, places = None, []
    for line in DECK.read_text().splitlines():
        if line.startswith(LEFT_OUT):
            continue
        m.run(line)
        if line.startswith("CYCLE"):
            (ball,) = (row for row in m.table("block") if row["KBFIX"] == 0)
            places.append((float(ball["KX"]), float(ball["KY"])))
            settled = settled or tuple(float(m.table("contact")[name][0]) for name in ("KCN", "KCFN"))
    (x0, y0), *rest = places
    return Ball(*settled, [hypot(x - x0, y - y0) for x, y in rest])


def wall(build: str) -> tuple[int, int]:
    """Blocks and words in use of a wall of 6 by 6 square blocks."""
    m = Model(build)
    m.block(0, 0, 0, 6, 6, 6, 6, 0)
    for k in range(1, 6):
        m.split(-1, k, 7, k)
        m.split(k, -1, k, 7)
    return int(m.h.ci[NBLK]), int(m.h.ci[MFREE]) - 1


def row(*cells: str) -> str:
    return f"| {' | '.join(cells)} |"


def head(*cells: str) -> str:
    return f"{row(*cells)}\n|{'---|' * len(cells)}"


def sizes() -> list[str]:
    """What each scheme can hold."""
    lines = [head("scheme", "words of IA(), at most", "bytes for a block of a wall", "blocks, about")]
    for name, scheme in ALL_SCHEMES.items():
        blocks, words = wall(name)
        each, largest = (
            words * scheme.int_bits / 8 / blocks,
            float(f"{scheme.top_address * blocks / words:.2g}"),
        )
        lines.append(row(name, f"{scheme.top_address:,}", f"{each:.0f}", f"{largest:,.0f}"))
    return lines


def errors(balls: dict[str, Ball]) -> list[str]:
    """The errors of each scheme against the formulas."""
    right = expected()
    cells = [f"travelled, {200 * k} cycles" for k in range(1, 6)]
    lines = [head("scheme", "overlap", "Fn", *cells)]
    for name, ball in balls.items():
        pairs = [(ball.overlap, right.overlap), (ball.force, right.force)]
        pairs += zip(ball.travelled, right.travelled, strict=True)
        lines.append(row(name, *(f"{100 * (ours / formula - 1):+.3f} %" for ours, formula in pairs)))
    return lines


def cost(balls: dict[str, Ball]) -> list[str]:
    """What 32-bit reals differ from 64-bit ones."""
    lines = [head("32-bit against 64-bit reals", "overlap", "Fn", "travelled, at most")]
    for narrow, wide in (("i16r32", "i16r64"), ("i32r32", "i32r64")):
        one, two = balls[narrow], balls[wide]
        travelled = max(abs(a / b - 1) for a, b in zip(one.travelled, two.travelled, strict=True))
        settled = (abs(one.overlap / two.overlap - 1), abs(one.force / two.force - 1))
        lines.append(row(f"{narrow} against {wide}", *(f"{part:.1e}" for part in (*settled, travelled))))
    return lines


def report() -> str:
    """The tables, as they stand in docs/words.md."""
    balls = {name: roll(name) for name in ALL_SCHEMES}
    return "\n\n".join("\n".join(table) for table in (sizes(), errors(balls), cost(balls))) + "\n"


def loss(name: str, text: str, wide: Run, narrow: Run) -> str:
    """A row: what 32-bit reals lose in a scene."""
    places, most, every, parted = losses(wide, narrow)
    ends = [rest(text, one) for one in (wide, narrow)]
    cells = [f"{way(wide):.2g} m", *(f"{part:.0e}" for part in (places, most, every))]
    parts = f"cycle {parted:,}" if parted else "-"
    return row(name, *cells, parts, ", ".join(dict.fromkeys(ends)), narrow.warned)


def price(name: str, runs: dict[str, Run]) -> str:
    """A row: kB of IA() in use, and time of a cycle: in us for the default scheme, of others a part of it."""
    models = {build: one.model for build, one in runs.items() if one.model is not None}
    took = times(models)
    cells = []
    for build in ALL_SCHEMES:
        if build not in models:
            cells.append("no room")
            continue
        held = (int(models[build].h.ci[MFREE]) - 1) * ALL_SCHEMES[build].int_bits / 8000
        share = f"{took[build] / took[DEFAULT_SCHEME]:.2f}"
        cells.append(
            f"{held:,.0f} kB, {share if build != DEFAULT_SCHEME else f'{1e6 * took[build]:,.1f} us'}"
        )
    return row(name, *cells)


def prices() -> Iterator[str]:
    """What 32-bit reals lose in each scene; then memory and time, which differ from run to run."""
    names = "places", "greatest force", "all forces", "part", "force ratio at the end, 64 and 32 bits"
    yield head("32-bit reals lose", "way", *names, "warned")
    taken = []
    for name, made in SCENES.items():
        text = made()
        builds = ALL_SCHEMES if name in PRICED else (NARROW, DEFAULT_SCHEME)
        runs = {build: run(text, build) for build in builds}
        yield loss(name, text, runs[DEFAULT_SCHEME], runs[NARROW])
        if name in PRICED:
            taken.append(price(name, runs))
    yield "\n" + head("IA() in use and time of a cycle", *ALL_SCHEMES)
    yield from taken


def main() -> None:
    """Print the tables."""
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter).parse_args()
    print(report())
    for line in prices():
        print(line, flush=True)


if __name__ == "__main__":
    main()
