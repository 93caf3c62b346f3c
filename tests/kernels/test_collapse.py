"""The rigid part of Appendix II-2: 25 blocks settle, lose those of one gap and collapse into it."""

from __future__ import annotations

from math import exp
from pathlib import Path

import pytest
from naive.relocate import differences, essence
from support.mechanics_scenes import G, sound

from udec_ia import Model
from udec_ia.kernels.drive.unbalanced_force import unbalanced_force
from udec_ia.layout.offsets import ALPHA, MCTOT, TIME
from udec_ia.reader.group_lists import Lists

DECK = Path(__file__).parents[2] / "examples" / "collapse-rigid.dat"
GAP = (20.0, 40.0, 10.0, 20.0)
SETTLED, CYCLES, SLICE = 1500, 21_500, 4300
LINKS = ("KCCOD", "KCP1", "KCP2", "KD1", "KD2", "KL1", "KL2")


def commands(deck: Path) -> list[str]:
    return [line for line in deck.read_text().splitlines() if not line.startswith("*")]


def test_the_deck_is_the_rigid_part_of_the_reports() -> None:
    """Line for line that of Appendix II-2 up to its damping, without the commands for soft blocks."""
    report = commands(DECK.with_name("collapse-small.dat"))
    soft = ("GENERATE", "+", "DUMP", "DAMP", "CYCLE", "PLOT", "P ", "STOP", "END")
    rigid = [line for line in report if not line.startswith(soft) and "DEF" not in line]
    assert commands(DECK)[: len(rigid)] == rigid


def links(m: Model) -> bytes:
    """The contacts with what they stand on and between: while these stay, no group changes its neighbours."""
    lists = Lists(m.array)
    contacts = lists.addresses("contact")
    return b"".join(
        column.tobytes() for column in (contacts, *(lists.read(contacts, name) for name in LINKS))
    )


def played(last: int, watched: int = CYCLES) -> Model:
    """The deck up to cycle `last`; proved sound from cycle `watched` on.

    After every command, every cycle that changes the map, and every two hundredth of the others.
    """
    m = Model()
    now = 0
    before = b""
    for line in commands(DECK):
        word, *numbers = line.split()
        if word == "CYCLE":
            end = min(now + int(numbers[0]), last)
            m.cycle(max(min(watched, end) - now, 0))
            while (now := int(m.h.ci[MCTOT])) < end:
                m.cycle(1)
                after = links(m)
                if after != before or int(m.h.ci[MCTOT]) % 200 == 0:
                    sound(m)
                before = after
        elif word not in ("PLOT", "STOP", "END"):
            m.run(line)
            if now >= watched:
                sound(m)
        if now == last:
            break
    return m


@pytest.mark.parametrize("first", range(0, CYCLES, SLICE))
def test_every_change_of_the_map_is_sound(first: int) -> None:
    """All invariants after every command and every cycle with a change; the slices together see all 21,500.

    Each plays the deck up to its first cycle, which takes no time, and goes on cycle by cycle. No bit of what
    it comes to differs from an uninterrupted run, so the slices are slices of one run.
    """
    m = played(first + SLICE, watched=first)
    assert int(m.h.ci[MCTOT]) == first + SLICE
    assert differences(essence(m.array), essence(played(first + SLICE).array)) == []


def test_the_slices_are_the_whole_deck() -> None:
    assert CYCLES % SLICE == 0
    assert sum(int(line.split()[1]) for line in commands(DECK) if line.startswith("CYCLE")) == CYCLES


def test_the_wall_settles_and_collapses() -> None:
    """Settling: mass damping takes exp(-ALPHA t/2) of every mode, whatever its frequency. At first every
    block feels its weight, which in the norm sum F^2/m is g^2 times the total mass; a single block then feels
    at most the square root of its own mass times that.
    """
    m = played(SETTLED)
    blocks = m.table("block")
    assert len(blocks) == 25
    free = blocks["KBM"][blocks["KBFIX"] == 0]
    first = G * float(free.max() * free.sum()) ** 0.5
    assert unbalanced_force(m.h, None)[0] <= first * exp(-float(m.h.cr[ALPHA] * m.h.cd[TIME]) / 2)

    height = float((blocks["KBM"] * blocks["KY"]).sum())
    inside = [
        GAP[0] < x < GAP[1] and GAP[2] < y < GAP[3] for x, y in zip(blocks["KX"], blocks["KY"], strict=True)
    ]
    assert m.delete(*GAP) == sum(inside) == 4
    lost = float((blocks["KBM"] * blocks["KY"])[inside].sum())
    assert m.cycle(CYCLES - SETTLED) == CYCLES - SETTLED
    sound(m)
    blocks = m.table("block")
    above = height - lost - float((blocks["KBM"] * blocks["KY"]).sum())
    two_heavy_blocks = 2 * 8000 * 100.0
    assert above > two_heavy_blocks * 8  # they have come down by most of a course
    assert unbalanced_force(m.h, None)[0] < 1e-3 * first  # and come to rest


def test_the_deck_runs(tmp_path: Path) -> None:
    """As a user runs it: one command, a sequence of pictures."""
    m = Model(out=tmp_path)
    printed = m.run(DECK)
    assert printed is not None
    assert printed.splitlines()[-1].startswith("21500 cycles")
    assert len(list(tmp_path.glob("*.png"))) >= 6
    sound(m)
