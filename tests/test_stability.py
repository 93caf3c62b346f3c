"""The time-step against stiffness damping: when CYCLE warns, and that it is right to.

The oracle assembles the stiffness matrix of a grid of equal square blocks itself: two contacts a face, each
two springs of stiffness 1, between points of rigid unit squares of mass 1 and moment of inertia 1/6.
"""

from __future__ import annotations

from itertools import product
from math import sqrt
from pathlib import Path

import numpy as np
import pytest
from mechanics import G

from offsets.generated import TDEL
from udec_ia import Model
from udec_ia.kernels.balance import unbalanced
from udec_ia.ops.cycle import GRID

DECK = Path(__file__).parent.parent / "examples" / "collapse-rigid.dat"
RAYLEIGH = "DAMP 0.25 1.0"
D = 0.05  # rounding length: contacts stand at that distance from the corners


def highest_frequency(n: int) -> float:
    """Highest eigenfrequency of n by n blocks, in units of sqrt(k/m): the estimate's own."""
    stiffness = np.zeros((3 * n * n, 3 * n * n))
    for i, j, (right, up), end in product(range(n), range(n), ((1, 0), (0, 1)), (D - 0.5, 0.5 - D)):
        if i + right < n and j + up < n:
            x, y = right / 2 + up * end, up / 2 + right * end  # from the centre of block (i, j)
            for ex, ey in ((right, up), (-up, right)):
                row = np.zeros(3 * n * n)
                one, two = 3 * (i * n + j), 3 * ((i + right) * n + j + up)
                row[one : one + 3] = ex, ey, ey * x - ex * y
                row[two : two + 3] = -ex, -ey, -(ey * (x - right) - ex * (y - up))
                stiffness += np.outer(row, row)
    scale = np.sqrt(np.tile([1, 1, 1 / 6], n * n))
    return sqrt(np.linalg.eigvalsh(stiffness / np.outer(scale, scale))[-1])


def test_the_frequency_that_is_reckoned_with_is_that_of_a_grid() -> None:
    assert highest_frequency(2) < GRID
    assert highest_frequency(8) == pytest.approx(GRID, rel=0.02)
    assert highest_frequency(14) == pytest.approx(GRID, rel=0.02)


def wall(damping: str, fraction: float | None = None) -> tuple[Model, str]:
    """The wall of Appendix II-2 with `damping`, after 2 s of settling, and what the deck printed."""
    lines = DECK.read_text().partition("DAMP")[0]
    m = Model()
    printed = m.run(lines + (f"FRAC {fraction}\n" if fraction else "") + f"{damping}\nCYCLE 0\n")
    printed += m.run(f"CYCLE {int(2 / m.h.cr[TDEL])}")
    return m, printed


def weight(m: Model) -> float:
    """Weight of the heaviest block: the greatest force on a block before the first contact takes any."""
    return G * float(m.table("block")["KBM"].max())


def test_a_step_that_damping_makes_unstable_is_warned_of_once() -> None:
    """The blocks rattle instead of settling. The fraction that the warning names is stable, and silent."""
    m, printed = wall(RAYLEIGH)
    assert printed.count("\n CYCLE: stiffness damping BETA = 0.0398 s") == 1
    assert unbalanced(m.h) > weight(m)
    fraction = float(printed.partition("FRACTION ")[2].split()[0])
    m, printed = wall(RAYLEIGH, 0.95 * fraction)  # it is printed with two digits
    assert "\n CYCLE:" not in printed
    assert unbalanced(m.h) < 0.05 * weight(m)


def test_mass_damping_makes_no_step_unstable() -> None:
    m, printed = wall(f"{RAYLEIGH} MASS")
    assert "\n CYCLE:" not in printed
    assert unbalanced(m.h) < weight(m)


def test_python_hears_of_it_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    m = Model()
    m.run(DECK.read_text().partition("DAMP")[0])
    m.damping(0.25, 1.0)
    m.cycle(0)
    m.cycle(0)
    (record,) = caplog.records
    assert (record.name, record.levelname) == ("udec_ia", "WARNING")
    assert "BETA" in record.getMessage()
    heard: list[str] = []
    m.tell = heard.append
    m.damping(0.5, 1.0)
    m.cycle(0)
    assert len(heard) == 1
