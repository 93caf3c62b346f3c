"""The rigid part of Appendix II-2: 25 blocks settle, lose those of one gap and collapse into it."""

from __future__ import annotations

from math import exp
from pathlib import Path

from mechanics import G, sound

from offsets.generated import ALPHA, TIME
from udec_ia import Model
from udec_ia.kernels.balance import unbalanced

DECK = Path(__file__).parent.parent / "examples" / "collapse-rigid.dat"
GAP = (20.0, 40.0, 10.0, 20.0)


def commands(deck: Path) -> list[str]:
    return [line for line in deck.read_text().splitlines() if not line.startswith("*")]


def test_the_deck_is_the_rigid_part_of_the_reports() -> None:
    """Line for line that of Appendix II-2 up to its damping, without the commands for soft blocks."""
    report = commands(DECK.with_name("collapse-small.dat"))
    soft = ("GENERATE", "+", "DUMP", "DAMP", "CYCLE", "PLOT", "P ", "STOP", "END")
    rigid = [line for line in report if not line.startswith(soft) and "DEF" not in line]
    assert commands(DECK)[: len(rigid)] == rigid


def test_the_wall_settles_and_collapses(tmp_path: Path) -> None:
    """No error and no broken invariant in 21,500 cycles.

    Settling: mass damping takes exp(-ALPHA t/2) of every mode, whatever its frequency. At first every block
    feels its weight, which in the norm sum F^2/m is g^2 times the total mass; a single block then feels at
    most the square root of its own mass times that.
    """
    m = Model(out=tmp_path)
    for line in commands(DECK):
        if line.startswith("CYCLE"):
            break
        m.run(line)
        sound(m)
    assert len(m.table("block")) == 25
    for _ in range(1500):
        m.cycle(1)
        sound(m)
    blocks = m.table("block")
    free = blocks["KBM"][blocks["KBFIX"] == 0]
    first = G * float(free.max() * free.sum()) ** 0.5
    assert unbalanced(m.h) <= first * exp(-float(m.h.cr[ALPHA] * m.h.cr[TIME]) / 2)

    height = float((blocks["KBM"] * blocks["KY"]).sum())
    inside = [
        GAP[0] < x < GAP[1] and GAP[2] < y < GAP[3] for x, y in zip(blocks["KX"], blocks["KY"], strict=True)
    ]
    assert m.delete(*GAP) == sum(inside) == 4
    lost = float((blocks["KBM"] * blocks["KY"])[inside].sum())
    sound(m)
    for _ in range(1000):
        assert m.cycle(20) == 20
        sound(m)
    blocks = m.table("block")
    above = height - lost - float((blocks["KBM"] * blocks["KY"]).sum())
    two_heavy_blocks = 2 * 8000 * 100.0
    assert above > two_heavy_blocks * 8  # they have come down by most of a course
    assert unbalanced(m.h) < 1e-3 * first  # and come to rest


def test_the_deck_runs(tmp_path: Path) -> None:
    """As a user runs it: one command, a sequence of pictures."""
    m = Model(out=tmp_path)
    printed = m.run(DECK)
    assert printed is not None
    assert printed.splitlines()[-1].startswith("21500 cycles")
    assert len(list(tmp_path.glob("*.png"))) >= 6
    sound(m)
