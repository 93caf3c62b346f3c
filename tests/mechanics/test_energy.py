"""PRINT ENERGY: every term against the tables, and the balance closes, to rounding where it can."""

from __future__ import annotations

import re
from math import radians, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.mechanics_scenes import G, at, block, box, model, on_base, push, sound, step

from udec_ia import Model
from udec_ia.layout.offsets import ALPHA, EPOT, EPUT, EREF, ESTOR, WBOUND, WFRIC
from udec_ia.ops.commands.energy_account import Balance

EXAMPLES = Path(__file__).parents[2] / "examples"
CLOSED = 0.01  # residual against throughput that is asked for


def closes(balance: Balance) -> bool:
    return abs(balance.residual) < CLOSED * balance.throughput


def deck(name: str, damping: str | None = None, build: str = "i32r64", last: str = "STOP") -> Model:
    """An example up to the command `last`, without its pictures, with other damping if that is given."""
    m = Model(build=build)
    for line in (EXAMPLES / name).read_text().splitlines():
        if line.startswith(last):
            break
        if not line.startswith(("PLOT", "P ", "SAVE", "*")):
            m.run(damping if damping and line.startswith("DAMP") else line)
        if line == "START":
            m.energy("on")
    return m


def counted(m: Model) -> Model:
    """The model with an account of its energy."""
    m.energy("on")
    return m


def mass(m: Model) -> float:
    """Mass of the free blocks."""
    blocks = m.table("block")
    return float(blocks["KBM"][blocks["KBFIX"] == 0].sum())


def test_kinetic_energy_is_that_of_the_full_step() -> None:
    """Without damping: half of m times the product of the velocities around it. Spin, slip and flight."""
    m = counted(on_base(1.0, 2.0, 0.1, 8.0, friction=0.3))
    m.damping(0.0, 1.0)
    push(m, int(block(m, 0, 1.0)["address"]), xd=2.0, yd=0.5, td=1.0)
    m.cycle(1)
    for _ in range(200):
        before, balance = m.table("block"), m.balance()
        m.cycle(1)
        after = m.table("block")
        free = before["KBFIX"] == 0
        linear = before["KXD"] * after["KXD"] + before["KYD"] * after["KYD"]
        naive = (before["KBM"] * linear + before["KBI"] * before["KTD"] * after["KTD"])[free].sum() / 2
        assert balance.kinetic == pytest.approx(naive, rel=1e-9)


def test_free_fall_turns_potential_into_motion() -> None:
    """No contact carries anything: both are known from the height alone."""
    m = counted(model(*box(0, 1, -1, 9), d=0.1))
    m.split(-1, 0, 2, 0)
    m.split(-1, 8, 2, 8)
    m.delete(0, 1, 0, 8)
    m.fix(0, 1, -1, 0)
    m.cycle(300)
    (balance, fallen) = m.balance(), 8.5 - float(block(m, 0.5, 8.5)["KY"])
    assert fallen > 0.1
    assert balance.potential == pytest.approx(-1000 * G * fallen, rel=1e-9)
    assert balance.kinetic == pytest.approx(1000 * G * fallen, rel=1e-9)
    assert set(balance) - {balance.kinetic, balance.potential} == {0}


@pytest.mark.parametrize("damping", [(0.4, 30.0, "mass"), (0.4, 30.0, "stiffness"), (0.3, 30.0, None)])
@pytest.mark.parametrize("fraction", [0.05, 0.3])
def test_linear_springs_and_dashpots_balance_to_rounding(
    damping: tuple[float, float, str | None], fraction: float
) -> None:
    """A block presses on its base and settles, in contact all the time: every step is exact.

    Each of the terms is summed over the cycles, with an error of a last digit of it in each.
    """
    m = counted(on_base(1.0, 1.0, 0.1, 4.0, fraction=0.05))
    m.damping(4.0, 30.0, "mass")
    m.cycle(2000)
    m.damping(*damping)
    m.fraction(fraction)
    push(m, int(block(m, 0, 0.5)["address"]), yd=1e-3)
    cycles = 1000
    m.cycle(1)
    start = m.balance()
    m.cycle(cycles)
    end = m.balance()
    assert m.table("contact")["KCFN"].min() > 0
    assert (end.mass_damping > start.mass_damping) == (damping[2] != "stiffness")
    assert (end.stiffness_damping > 0) == (damping[2] != "mass")
    assert abs(end.kinetic) < 0.5 * abs(start.kinetic)
    digits = np.finfo(float).eps * cycles * max(map(abs, end))
    assert abs(end.residual - start.residual) < 10 * digits


def test_mass_damping_takes_what_the_exact_solution_loses() -> None:
    """A block that floats: v falls by exp(-ALPHA t), the energy by its square."""
    m = counted(model(*box(0, 1, -1, 9), d=0.1, gravity=(0.0, 0.0), fraction=0.02))
    m.split(-1, 0, 2, 0)
    m.split(-1, 8, 2, 8)
    m.delete(0, 1, 0, 8)
    m.fix(0, 1, -1, 0)
    m.damping(0.1, 5.0, "mass")
    push(m, int(block(m, 0.5, 8.5)["address"]), xd=3.0, td=0.5)
    m.cycle(0)
    given = m.balance().commands
    assert given == pytest.approx(1000 * 3.0**2 / 2 + 1000 / 6 * 0.5**2 / 2, rel=1e-6)
    m.cycle(2000)
    left = np.exp(-2 * float(m.h.cr[ALPHA]) * 2000 * step(m))
    balance = m.balance()
    assert 0.01 < left < 0.5
    assert balance.kinetic == pytest.approx(given * left, rel=1e-3)
    assert balance.mass_damping == pytest.approx(given * (1 - left), rel=1e-3)
    assert abs(balance.residual) < 1e-9 * given


def test_friction_takes_all_motion() -> None:
    """Thrown along the base it stops; what it had is in friction but for what the springs still hold."""
    m = counted(on_base(2.0, 1.0, 0.1, 12.0, friction=tan(radians(20))))
    m.damping(1.0, 30.0, "mass")
    m.cycle(800)
    m.damping(0.0, 1.0)
    before = m.balance()
    push(m, int(block(m, 0, 0.5)["address"]), xd=2.0)
    assert m.balance().commands - before.commands == pytest.approx(2000 * 2.0**2 / 2, rel=1e-3)
    m.cycle(1500)
    balance = m.balance()
    assert balance.friction == pytest.approx(2000 * 2.0**2 / 2, rel=0.01)
    assert abs(balance.residual) < 1e-3 * balance.throughput


@pytest.mark.parametrize("damping", ["DAMP 0.25 1 MASS", "DAMP 0.1 1", "DAMP 0.5 1 MASS", "DAMP 0.05 5"])
def test_the_collapse_closes(damping: str) -> None:
    """21 blocks fall by a course, slide, hit and come to rest."""
    m = deck("collapse-rigid.dat", damping, last="CYCLE 15000")
    balance = m.balance()
    assert balance.friction > 0.1 * balance.throughput
    assert balance.mass_damping > 0.1 * balance.throughput
    assert (balance.stiffness_damping > 0.01 * balance.throughput) == ("MASS" not in damping)
    assert closes(balance)
    sound(m)


@pytest.mark.parametrize("cohesion", ["5E5", "5E6"])
def test_broken_cohesion_is_accounted_for(cohesion: str) -> None:
    """Springs that hold more than friction lose it at once when their contact opens."""
    glue = "\n".join(f"PROP MAT={k} COH={cohesion}" for k in (1, 2))
    m = deck("collapse-rigid.dat", f"DAMP 0.1 1 MASS\n{glue}", last="CYCLE 15000")
    balance = m.balance()
    assert balance.friction > 0.1 * balance.throughput
    assert closes(balance)


def test_what_friction_takes_does_not_need_an_account(tmp_path: Path) -> None:
    """Shear that contacts lose as they open counts whether or not ENERGY is on: the same sum, bit for bit."""
    sums = []
    for on in (False, True):
        m = on_base(1.0, 3.0, 0.1, 12.0, friction=50.0)
        m.out = tmp_path
        if on:
            m.energy("on")
        push(m, int(block(m, 0, 1.5)["address"]), xd=0.5, td=2.0)
        m.cycle(3000)
        sums.append(float(m.h.cd[WFRIC]))
    assert sums[0] == sums[1] > 0


def test_the_ball_closes() -> None:
    m = deck("ball-rolling.dat")
    balance = m.balance()
    assert balance.mass_damping > 0
    assert balance.stiffness_damping > 0
    assert closes(balance)


def test_32_bit_reals_close_too() -> None:
    m = deck("collapse-rigid.dat", build="i32r32")
    assert m.h.cr.itemsize == 4
    assert closes(m.balance())


def stressed() -> Model:
    """Three blocks on each other, at rest."""
    m = counted(on_base(1.0, 3.0, 0.1, 4.0, friction=0.5))
    for y in (1, 2):
        m.split(-9, y, 9, y)
    m.damping(1.0, 30.0, "mass")
    assert m.solve(1e-9)
    return m


def springs(m: Model) -> float:
    contacts = m.table("contact")
    return float((contacts["KCFN"] ** 2 + contacts["KCFS"] ** 2).sum() / (2 * 1e8))


def test_what_a_law_still_holds_goes_with_its_contact() -> None:
    """A joint law that keeps its force as the joint opens, until the contact is given up."""

    def clj2(fn: float, fs: float, dun: float, dus: float, un: float, us: float, m: Any) -> Any:
        return (m.kn * dun, 0.0) if fn == 0.0 or dun > 0 else (0.0, 0.0)

    m = Model(constitutive={"clj2": clj2})
    m.property(1, density=2000, kn=1e7, ks=1e7)
    m.block(0, 0, 0, 3, 4, 3, 4, 0, constitutive=2)
    m.split(-1, 1, 5, 1)
    m.round(0.1)
    m.fix(0, 4, 0, 1)
    m.gravity(0, -10)
    m.fraction(0.02)
    m.energy("on")
    m.cycle(122)
    assert (m.table("contact")["KCFN"] > 0).all()
    m.cycle(15)
    assert (m.table("contact")["KCFN"] == 0).all()
    balance = m.balance()
    assert abs(balance.residual) < 1e-10 * balance.throughput


def test_what_commands_put_in_and_take_out() -> None:
    """DELETE, PROPERTY, RSET, FIX and GRAVITY change what is stored by what the tables say, and no more."""
    m = stressed()
    rest = m.balance()
    assert closes(rest)
    assert rest.commands == 0
    assert rest.strain == pytest.approx(springs(m))
    m.property(1, kn=2e8, ks=2e8)
    assert m.balance().commands == pytest.approx(-rest.strain / 2)
    m.property(1, kn=1e8, ks=1e8)
    assert m.balance() == rest
    m.delete(-1, 1, 2, 3)
    taken = springs(m) - rest.strain
    assert taken < -0.01 * rest.strain
    assert m.balance().commands == pytest.approx(taken, rel=1e-6)
    m.cycle(0)
    upper = int(block(m, 0, 1.5)["address"])
    push(m, upper, xd=0.5)
    thrown = m.balance().commands
    assert thrown - taken == pytest.approx(1000 * 0.5**2 / 2, rel=1e-3)
    m.cycle(5)
    before = m.balance()
    m.gravity(0, 0)
    m.cycle(0)
    assert m.balance().potential == before.potential
    m.fix(-1, 1, 1, 2)
    assert at(m, "block", upper)["KXD"] == 0
    fixed = m.balance()
    assert fixed.kinetic < 0.05 * before.kinetic
    assert fixed.commands - before.commands == pytest.approx(fixed.kinetic - before.kinetic)
    assert fixed.residual == pytest.approx(before.residual, abs=1e-9 * rest.throughput)
    m.fraction(0.02)
    m.cycle(300)
    assert closes(m.balance())


def test_looking_at_the_balance_changes_nothing() -> None:
    m = stressed()
    m.delete(-1, 1, 2, 3)
    before = m.h.ia.tobytes(), m.h.ci.tobytes(), m.h.cr.tobytes(), m.h.cd.tobytes()
    m.print("energy")
    assert (m.h.ia.tobytes(), m.h.ci.tobytes(), m.h.cr.tobytes(), m.h.cd.tobytes()) == before


def test_the_balance_goes_on_after_a_restart(tmp_path: Path) -> None:
    m = stressed()
    m.delete(-1, 1, 2, 3)
    other = Model.restore(m.save((tmp_path / "here.h5").absolute()))
    assert other.balance() == m.balance()
    for one in (m, other):
        one.cycle(50)
    assert other.balance() == m.balance()


def test_histories_of_energy(tmp_path: Path) -> None:
    """In the midst of a CYCLE they are what PRINT ENERGY would show there."""
    m, twin = counted(on_base(1.0, 1.0, 0.1, 4.0)), counted(on_base(1.0, 1.0, 0.1, 4.0))
    m.out = tmp_path
    for one in (m, twin):
        one.damping(0.2, 30)
        one.cycle(7)
        one.gravity(0, -5)
    for name in ("kinetic", "strain", "potential", "wmass", "wstif"):
        m.history(10, name)
    m.cycle(33)
    twin.cycle(3)
    for row in range(4):
        b = twin.balance()
        seen = [one.numbers[row, 2] for one in m.histories()]
        expected = [b.kinetic, b.strain, b.potential, b.mass_damping, b.stiffness_damping]
        assert seen == pytest.approx(expected, rel=1e-9, abs=1e-9 * b.throughput)
        twin.cycle(10)


def test_print_energy() -> None:
    m = stressed()
    text = m.run("P ENERGY")
    assert text is not None
    balance = m.balance()
    printed = [float(found) for found in re.findall(r"^[a-z ,]+?\s+(-?[\d.e+-]+)", text, re.MULTILINE)]
    assert balance.water == balance.structures == balance.cracks == 0  # and have no lines
    numbers = [*balance[:2], *balance[3:6], *balance[7:-1], balance.residual]
    assert printed[-13:] == pytest.approx(numbers, rel=1e-5)
    assert f"of {balance.throughput:.6g} that passed through" in text
    assert "= 0 % of 0 that passed" in counted(Model()).print("energy")


def test_off_leaves_no_numbers_behind() -> None:
    """Nor does it look at any: a weight beyond all reals is nothing to it."""
    m = on_base(1.0, 1.0, 0.1, 4.0)
    m.energy("on")
    m.cycle(3)
    m.gravity(0, -1e308)
    m.energy("off")
    assert not any(m.h.cd[name] for name in (EPUT, ESTOR, EREF, EPOT, WBOUND))
    assert m.check() == []
