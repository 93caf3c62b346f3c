"""Corners from very acute to nearly straight: is the state sound, the energy kept, and the force the weight?

    python docs/studies/corner_angles.py [--angles 5 9 ...]

For each angle, in 64- and in 32-bit reals, three scenes of one block above a fixed one:

- rest: it stands on an edge of 1 m between two corners of that angle. By statics the vertical forces of its
  contacts sum up to its weight, density times area times g.
- slide: then it slides down 30 degrees at a friction of 0.3, without damping, from 0.2 s to 1 s: its mean
  acceleration against g (sin 30 - 0.3 cos 30).
- fall: it falls by 5 cm on a corner of that angle, a little off the vertical, without damping, and bounces
  and tumbles for 2 s: the share of all energy that is not accounted for, with FRACTION 0.1 and 0.01.

Forces and accelerations are errors over the exact number. KN goes with the weight, so that all blocks sink
in by the same length: 1 mm at rest, 10 um under the weight of one that falls. The checker looks at the state
100 times in each run: `unsound` if it finds anything. What the program refuses has its error number. Messages
and warnings go to standard error.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT)]

from corner_angle_scenes import (
    BUILDS,
    DENSITY,
    FRICTION,
    Tell,
    area,
    falling,
    scene,
    standing,
)
from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

ANGLES = (1, 2, 5, 9, 15, 30, 60, 90, 120, 150, 170, 175, 179, 179.9)
G, LOOKS = 10.0, 100


def run(m: Model, seconds: float) -> None:
    """So much time, under the eyes of the checker; AssertionError if it finds anything."""
    m.cycle(0)
    cycles = math.ceil(seconds / float(m.h.cr[g.TDEL]))
    for k in range(LOOKS):
        m.cycle(cycles * (k + 1) // LOOKS - cycles * k // LOOKS)
        faults = m.check()
        assert not faults, str(faults[0])


def stood(build: str, angle: float, gravity: float, tell: Tell) -> Model:
    """The block that stands, at rest."""
    m = scene(build, standing(angle), 500 * G, tell)
    m.gravity(0, -gravity)
    m.damping(local=0.8)
    run(m, 8)
    return m


def rest(build: str, angle: float, tell: Tell) -> float:
    """Error of the force at rest."""
    force = float(stood(build, angle, G, tell).table("contact")["KCFN"].astype(float).sum())
    return force / (DENSITY * area(standing(angle)) * G) - 1


def slide(build: str, angle: float, tell: Tell) -> float:
    """Error of the acceleration."""
    along, across = G * math.sin(math.radians(30)), G * math.cos(math.radians(30))
    m = stood(build, angle, across, tell)
    m.damping(0, 1)
    m.gravity(along, -across)
    run(m, 0.2)
    begun, before = float(m.h.cd[g.TIME]), float(m.table("block")["KXD"].max())
    run(m, 0.8)
    gained = float(m.table("block")["KXD"].max()) - before
    return gained / (float(m.h.cd[g.TIME]) - begun) / (along - FRICTION * across) - 1


def fall(build: str, angle: float, tell: Tell, fraction: float) -> float:
    """Share of the energy that is not accounted for."""
    m = scene(build, falling(angle), 1e5 * G, tell)
    m.gravity(0.3, -G)
    m.fraction(fraction)
    m.energy()
    run(m, 2)
    found = m.balance()
    return found.residual / found.throughput


STUDIES: dict[str, Callable[[str, float, Tell], float]] = {
    "rest": rest,
    "slide": slide,
    "fall 0.1": partial(fall, fraction=0.1),
    "fall 0.01": partial(fall, fraction=0.01),
}


def cell(name: str, build: str, angle: float) -> str:
    """A number of the table, or why there is none."""

    def tell(text: object) -> None:
        print(f"{name}, {angle:g} degrees, {build} bits: {text}", file=sys.stderr)

    try:
        return f"{STUDIES[name](build, angle, tell):.1e}"
    except (UdecError, AssertionError) as error:
        tell(error)
        return f"error {error.number}" if isinstance(error, UdecError) else "unsound"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--angles", type=float, nargs="+", default=ANGLES)
    given = parser.parse_args()
    columns = [(name, build) for name in STUDIES for build in BUILDS]
    heads = [f"{name}, {build}" for name, build in columns]
    print(f"| corner | {' | '.join(heads)} |\n|---|{'---|' * len(heads)}")
    for angle in given.angles:
        cells = [cell(name, build, angle) for name, build in columns]
        print(f"| {angle:g} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
