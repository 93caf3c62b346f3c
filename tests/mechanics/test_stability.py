"""The time-step against stiffness damping: when CYCLE warns, and that it is right to."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.mechanics_scenes import G

from udec_ia import Model
from udec_ia.kernels.drive.unbalanced_force import unbalanced_force
from udec_ia.layout.offsets import TDEL

DECK = Path(__file__).parents[2] / "examples" / "collapse-rigid.dat"
RAYLEIGH = "DAMP 0.25 1.0"


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
    rattling = 0.0
    for _ in range(10):
        m.cycle(20)
        rattling = max(rattling, float(unbalanced_force(m.h, None)[0]))
    assert rattling > weight(m)
    fraction = float(printed.partition("FRACTION ")[2].split()[0])
    m, printed = wall(RAYLEIGH, 0.95 * fraction)  # it is printed with two digits
    assert "stiffness damping BETA" not in printed
    assert unbalanced_force(m.h, None)[0] < 0.05 * weight(m)


def test_mass_damping_makes_no_step_unstable() -> None:
    m, printed = wall(f"{RAYLEIGH} MASS")
    assert "stiffness damping BETA" not in printed
    assert unbalanced_force(m.h, None)[0] < weight(m)


def test_python_hears_of_it_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    m = Model()
    m.run(DECK.read_text().partition("DAMP")[0])
    m.damping(0.25, 1.0)
    m.cycle(0)
    m.cycle(0)
    (record,) = (record for record in caplog.records if "BETA" in record.getMessage())
    assert (record.name, record.levelname) == ("udec_ia", "WARNING")
    heard: list[str] = []
    m.tell = heard.append
    m.damping(0.5, 1.0)
    m.cycle(0)
    assert len(heard) == 1


def test_a_deck_says_what_set_the_step_in_the_state_it_was_found_for() -> None:
    """Before the run, in Python only if it is asked for: at the end another group may be the one."""
    deck = (DECK.parent / "collapse.dat").read_text().partition("CYCLE")[0]
    m = Model()
    _, shapes, found, _ = (part.strip() for part in m.run(deck + "CYCLE 0").split("\n CYCLE: "))
    assert found == m.step_limits()
    assert shapes.startswith(m.geometry().short)
    printed = m.run("CYCLE 400")
    assert f"\n CYCLE: {found}\n" in printed
    assert found != m.step_limits()
    assert m.run("SOLVE 0 LIMIT=1").count("\n SOLVE: time-step") == 1
    told: list[str] = []
    m.inform = told.append
    m.cycle(1)
    assert told == []
