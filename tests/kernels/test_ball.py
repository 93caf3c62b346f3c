"""Appendix II-1: the report's ball settles on its slope and rolls down, on all five word schemes.

Targets by formula: a disc of radius R = D and the square's moment of inertia rolls with the acceleration
g sin(b)/(1 + I/(m R^2)); before, it rests on one contact with the normal force m g cos(b), g and b those of
the tilted gravity, and overlaps by that force over KN. The rounding length is half the edge but for a part in
400.
"""

from __future__ import annotations

from functools import cache
from math import hypot
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from support.mechanics_scenes import sound

from udec_ia import Model
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout.field_table import read_table

DECK = Path(__file__).parents[2] / "examples" / "ball-rolling.dat"
RADIUS, EDGE, DOWN = 1.115, 5**0.5, (-2 / 5**0.5, -1 / 5**0.5)
DENSITY, KN, TILTED, G, STEP = 2000.0, 1e8, (4.0, -8.0), 10.0, 0.002  # of the deck; its time-step
MASS, INERTIA = DENSITY * EDGE**2, DENSITY * EDGE**4 / 6
PROVED = ("i32r64",)  # word schemes in which every fourth cycle is
FORCE = MASS * abs(TILTED[0] * DOWN[1] - TILTED[1] * DOWN[0])
OVERLAP = FORCE / KN
ACCELERATION = G / 5**0.5 / (1 + INERTIA / (MASS * RADIUS**2))
TRAVELLED = [ACCELERATION * (200 * k * STEP) ** 2 / 2 for k in range(1, 6)]


class Roll(NamedTuple):
    """overlap, force: of the settled ball. travelled: after 200, 400, ... cycles. tables: reals at the end.

    In m, N/m, m and the units of the field table.
    """

    overlap: float
    force: float
    travelled: list[float]
    tables: dict[str, Any]


def tables(m: Model) -> dict[str, Any]:
    """All reals of all groups, in list order."""
    return {
        f"{group.name}.{field.name}": m.table(group.name)[field.name]
        for group in read_table().groups
        for field in group.fields
        if field.real
    }


@cache
def roll(build: str) -> Roll:
    """The deck, line by line and cycle by cycle; the heap is proved sound after every fourth or tenth."""
    m = Model(build=build)
    looked_at = 4 if build in PROVED else 10
    settled: Any = None
    places = []
    for line in DECK.read_text().splitlines():
        words = line.split()
        if words[0] == "STOP":
            break
        if words[0] in ("PLOT", "SAVE"):
            continue
        if words[0] == "CYCLE":
            for done in range(1, int(words[1]) + 1):
                assert m.cycle(1) == 1
                if done % looked_at == 0:
                    sound(m)
            (ball,) = (row for row in m.table("block") if row["KBFIX"] == 0)
            places.append((float(ball["KX"]), float(ball["KY"])))
            if settled is None:
                (settled,) = m.table("contact")
        else:
            m.run(line)
            sound(m)
    (x0, y0), *rest = places
    travelled = [hypot(x - x0, y - y0) for x, y in rest]
    return Roll(float(settled["KCN"]), float(settled["KCFN"]), travelled, tables(m))


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_the_ball_settles_and_rolls(build: str) -> None:
    seen = roll(build)
    assert seen.overlap == pytest.approx(OVERLAP, rel=0.01)
    assert seen.force == pytest.approx(FORCE, rel=0.01)
    assert seen.travelled == pytest.approx(TRAVELLED, rel=0.01)


@pytest.mark.parametrize(
    ("build", "other"), [("i16r32", "i32r32"), ("i16r64", "i32r64"), ("i32r64", "i64r64")]
)
def test_the_width_of_an_integer_changes_no_bit(build: str, other: str) -> None:
    one, two = roll(build).tables, roll(other).tables
    for name, values in one.items():
        assert values.tobytes() == two[name].tobytes(), name


def test_what_32_bit_reals_cost() -> None:
    """Coordinates of 10 m hold 1e-6 m: of an overlap of 0.9 mm, measured between two of them, 2e-3 may go.
    1000 cycles round a coordinate 1000 times by half of that: 5e-4 m in all if they never cancelled.

    What is really lost is in docs/words.md.
    """
    narrow, wide = roll("i32r32"), roll("i32r64")
    assert narrow.overlap == pytest.approx(wide.overlap, rel=2e-3)
    assert narrow.force == pytest.approx(wide.force, rel=2e-3)
    assert narrow.travelled == pytest.approx(wide.travelled, abs=5e-4)


def test_the_whole_deck_in_one_run(tmp_path: Path) -> None:
    """The same deck from its file, with plots and restart file: no bit differs from cycle by cycle."""
    m = Model(out=tmp_path)
    printed = m.run(DECK)
    sound(m)
    assert printed is not None
    assert "2 blocks" in printed.splitlines()[-1]
    for name, values in roll("i32r64").tables.items():
        assert values.tobytes() == tables(m)[name].tobytes(), name
    assert {path.suffix for path in tmp_path.iterdir()} >= {".png", ".svg", ".h5"}


def test_it_rolls_without_slipping_on_one_contact() -> None:
    """The ball turns by its path over its radius, all on a single contact; the four short flats between its
    arcs, over which it turns by nothing, are a small part of the way round."""
    reals = roll("i32r64").tables
    assert len(reals["contact.KCN"]) == 1
    flats = 4 * (EDGE - 2 * RADIUS) / (6.28 * RADIUS)
    free = np.flatnonzero(reals["block.KTD"])
    speed = np.hypot(reals["block.KXD"], reals["block.KYD"])[free]
    assert reals["block.KTD"][free] * RADIUS == pytest.approx(speed, rel=flats)
