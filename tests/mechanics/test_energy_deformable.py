"""PRINT ENERGY with deformable blocks, boundary conditions and laws of the user's: the account closes."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from naive.relocate import differences, essence
from support.every_group_kind import every_kind
from support.mechanics_scenes import box, model

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.energy_account import Balance
from udec_ia.studies.verification_tools import generate, rectangle

EXAMPLES = Path(__file__).parents[2] / "examples"
BULK, SHEAR = 1e7, 5e6
STIFF, SOFT = BULK + 4 * SHEAR / 3, BULK - 2 * SHEAR / 3
STRESS = 1e5  # a strain of half a per cent
DIGITS = 1e-10  # of the throughput: thousands of cycles with a last digit each, and some numbers in each


@pytest.fixture(autouse=True)
def folder_of_its_own(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)


def afloat(kind: str, stress: tuple[float, float, float] = (STRESS, 0.0, 0.0), **numbers: Any) -> Model:
    """A deformable block, 1 by 1, that floats above a fixed one, with stresses that nothing holds."""
    m = model(*box(0, 1, -1, 9), d=0.05, gravity=(0.0, 0.0), fraction=0.05, **numbers)
    m.property(1, bulk=BULK, g=SHEAR)
    m.split(-1, 0, 2, 0)
    m.split(-1, 8, 2, 8)
    m.delete(0, 1, 0, 8)
    m.fix(0, 1, -1, 0)
    m.change(0, 1, 8, 9, type=kind)
    if kind == "fdef":
        generate(m, rectangle(0, 1, 8, 9, 3, 3))
    m.damping(0.0, 1.0)
    m.energy("on")
    m.insitu(0, 1, 8, 9, *stress)
    return m


def strain(stress: tuple[float, float, float]) -> Any:
    """Strains 11, 12, 22 by the inverse of Hooke's law."""
    law = np.array([[STIFF, 0, SOFT], [0, 2 * SHEAR, 0], [SOFT, 0, STIFF]])
    return np.linalg.solve(law, stress)


def elastic(stress: tuple[float, float, float]) -> float:
    """Energy of a stress per m3."""
    return float(np.array(stress) @ np.diag([1, 2, 1]) @ strain(stress) / 2)


def within(balance: Balance, share: float) -> bool:
    return abs(balance.residual) <= share * balance.throughput


@pytest.mark.parametrize(
    "stress", [(STRESS, 0.0, 0.0), (0.0, STRESS, 0.0), (STRESS, STRESS / 3, -STRESS / 2)]
)
@pytest.mark.parametrize("kind", ["sdef", "fdef"])
def test_a_block_that_swings_keeps_its_energy(kind: str, stress: tuple[float, float, float]) -> None:
    """What the stress held goes into motion and back.

    What the formulation does not keep, yielding and change of shape, is as small as areas and inertia change:
    by up to twice a strain that goes from one side to the other. The time-step changes with the zones, and
    what moves is known at half steps: so each CYCLE finds a little more or less than the last one left.
    """
    m = afloat(kind, stress)
    given, change = elastic(stress), 4 * np.abs(strain(stress)).max()
    assert m.balance().blocks == m.balance().commands == pytest.approx(given, rel=1e-9)
    most = 0.0
    for _ in range(100):
        m.cycle(10)
        balance = m.balance()
        most = max(most, balance.kinetic)
        assert within(balance, DIGITS)
        assert balance.commands == pytest.approx(given, rel=change)
        assert abs(balance.yielding) + abs(balance.shape) < change * given
    assert most > 0.3 * given


@pytest.mark.parametrize(("kind", "only"), [("sdef", "internal"), ("fdef", None), ("fdef", "mass")])
def test_damping_takes_all(kind: str, only: str | None) -> None:
    """A block that swings comes to rest, but for a hundredth of its energy.

    The dashpots of zones are counted at the end of the step: off by (w dt)^2/4 of what they take, w being at
    most 2/FRACTION/dt of the whole step.
    """
    m = afloat(kind)
    m.damping(0.3, 20.0, only)
    m.cycle(4000)
    balance = m.balance()
    given = elastic((STRESS, 0.0, 0.0))
    lost = balance.mass_damping + balance.stiffness_damping
    assert (balance.stiffness_damping > 0) == (only is None)
    assert balance.kinetic + balance.blocks < 0.01 * given
    assert lost == pytest.approx(given, rel=0.01 + 4 * np.abs(strain((STRESS, 0.0, 0.0))).max())
    assert within(balance, DIGITS if only else (2 * 0.05) ** 2 / 4)


def test_a_pulse_brings_its_energy_and_takes_it_away_through_a_viscous_edge() -> None:
    """Half of a pulse of a load runs along the bar, which is on rollers, and leaves at the other end."""
    length, high = 10.0, 1.0
    m = Model()
    m.round(0.02)
    m.block(0, 0, 0, high, length, high, length, 0)
    m.property(1, density=2000, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR)
    generate(m, rectangle(0, length, 0, high, 60, 2))
    cp = math.sqrt(STIFF / 2000)
    for y in (0.0, high):
        m.boundary(-1, length + 1, y - 0.01, y + 0.01, yvel=0)
    for x in (0.0, length):
        m.boundary(x - 0.01, x + 0.01, -1, 2, viscous=True)
    lasts = length / 2 / cp
    m.function(1, 0, 0, lasts / 2, 1, lasts, 0)
    m.boundary(-0.01, 0.01, -1, 2, stress=(-1e3, 0, 0), function=1)
    m.fraction(0.3)
    m.energy("on")
    m.cycle(0)
    steps = int(length / cp / m.h.cr[g.TDEL])
    m.cycle(int(0.7 * steps))
    inside = m.balance()
    assert within(inside, DIGITS)
    assert inside.boundary == pytest.approx(inside.kinetic + inside.blocks, rel=1e-3)
    assert inside.kinetic == pytest.approx(inside.blocks, rel=2e-2)
    in_pulse = (
        (1e3 / 2) ** 2 / STIFF / 3 * length / 2 * high
    )  # the mean of the square of a triangle is a third
    assert inside.boundary == pytest.approx(in_pulse, rel=3e-2)
    m.cycle(int(1.3 * steps))
    left = m.balance()
    assert left.boundary < 0.01 * inside.boundary
    assert abs(left.residual) < DIGITS * inside.throughput


def test_velocities_loads_and_dashpots_of_all_kinds_of_blocks_balance(tmp_path: Path) -> None:
    """Sines, functions, viscous edges, on every kind of block, which slide and lift off."""
    m = every_kind()
    m.out = tmp_path
    m.damping(0.05, 20.0)
    m.energy("on")
    for _ in range(10):
        m.cycle(200)
        assert within(m.balance(), 1e-3)
    balance = m.balance()
    assert abs(balance.boundary) > 0.1 * balance.throughput
    assert min(balance.friction, balance.mass_damping, balance.stiffness_damping) > 0


def test_what_gives_a_velocity_does_the_work() -> None:
    """A block is carried along by a sine against nothing: its kinetic energy is all from the boundary."""
    m = model(*box(0, 1, -1, 9), d=0.05, gravity=(0.0, 0.0))
    m.split(-1, 0, 2, 0)
    m.split(-1, 8, 2, 8)
    m.delete(0, 1, 0, 8)
    m.fix(0, 1, -1, 0)
    m.energy("on")
    m.boundary(0, 1, 8, 9, xvel=0.3, sine=(3.0, 1.0))
    for _ in range(20):
        m.cycle(50)
        (upper,) = (row for row in m.table("block") if row["KBFIX"] != 1)
        balance = m.balance()
        assert balance.boundary == pytest.approx(1000 * upper["KXD"] ** 2 / 2, rel=1e-9)
        assert within(balance, DIGITS)


def test_a_law_of_the_users_closes_as_law_1_does() -> None:
    """The account does not know who has computed a force: the same law as a function, blocks that deform."""

    def clj2(fn: float, fs: float, dun: float, dus: float, un: float, us: float, m: Any) -> Any:
        force = fn + m.kn * dun
        if un + dun <= 0.0 or force <= 0.0:
            return -fn, -fs
        limit = m.cohesion + m.friction * force
        return force - fn, min(max(fs + m.ks * dus, -limit), limit) - fs

    found = []
    for number in (1, 2):
        m = Model(constitutive={"clj2": clj2} if number == 2 else None)
        m.property(1, density=2000, kn=1e8, ks=5e7, friction=0.4, bulk=2e7, g=1e7)
        m.block(0, 0, 0, 3, 4, 3, 4, 0, constitutive=number)
        m.split(-1, 1, 5, 1.3)
        m.split(2, 0.5, 2, 4)
        m.round(0.1)
        m.fix(0, 4, 0, 1)
        for x in (1, 3):
            m.generate(x - 0.5, x + 0.5, 1.2, 4, "automatic", edge=0.7)
        m.gravity(0, -10)
        m.energy("on")
        m.cycle(1000)
        found.append(m.balance())
    one, two = found
    assert abs(one.shape) > 1e-3 * one.throughput
    assert two.shape == pytest.approx(one.shape, rel=1e-3)
    assert abs(two.residual) < 1e-3 * two.throughput


def test_yielding_takes_what_plastic_shear_dissipates() -> None:
    """All grid-points driven in simple shear, beyond the strength of a material without friction.

    Its stress is its cohesion as soon as it yields; what turns with the shear is of the order of the strain.
    """
    cohesion = 1e4
    m = afloat("fdef", (0.0, 0.0, 0.0), law="mohr_coulomb")
    m.property(1, block_cohesion=cohesion, block_tension=10 * cohesion)
    m.cycle(0)
    rate, shear = 0.1, 0.02
    for row in m.table("gridpoint"):
        for k, v in ((g.KXDG, rate * (float(row["KYG"]) - 8)), (g.KYDG, 0.0)):
            putr(m.array.h, int(row["address"]), k, v)
        puti(m.array.h, int(row["address"]), g.KGFIX, 3)
    m.cycle(int(shear / rate / m.h.cr[g.TDEL]))
    balance = m.balance()
    before = cohesion / SHEAR  # the shear at which it yields
    assert balance.blocks == pytest.approx(cohesion**2 / SHEAR / 2, rel=2 * shear)
    assert balance.yielding == pytest.approx(cohesion * (shear - before), rel=2 * shear)
    assert within(balance, DIGITS)


@pytest.mark.parametrize("damping", ["DAMP 0.05 1.0 MASS", "DAMP 0.02 3"])
def test_the_deformable_collapse_closes(damping: str) -> None:
    """The deck of Appendix II-2: settled, blocks removed, and two more seconds, blocks of all types."""
    m = Model()
    settled = False
    for line in (EXAMPLES / "collapse.dat").read_text().replace("\n+", " ").splitlines():
        word = line.partition(" ")[0]
        if word in ("SAVE", "STOP") or m.h.cd[g.TIME] > 3.5:
            break
        if word in ("PLOT", "PRINT", "P", "*"):
            continue
        m.run(damping if settled and word == "DAMP" else line)
        settled = settled or word == "CYCLE"
        if word == "START":
            m.energy("on")
        if word == "CYCLE":
            assert within(m.balance(), 0.01)
            assert m.check() == []
    balance = m.balance()
    assert balance.friction > 0.1 * balance.throughput
    assert balance.blocks > 0.1 * balance.throughput
    assert abs(balance.yielding) + abs(balance.shape) < 0.05 * balance.throughput


def test_the_account_changes_no_bit_and_costs_nothing_when_it_is_off(tmp_path: Path) -> None:
    plain, counted = every_kind(), every_kind()
    plain.out = counted.out = tmp_path
    counted.energy("on")
    for m in (plain, counted):
        m.damping(0.05, 20.0)
        m.cycle(100)
    sums = ("WBOUND", "WMASS", "WSTIF", "WYIELD", "WSHAPE", "EPUT", "ESTOR", "EPOT", "EREF", "LENER", "WFRIC")
    sums += ("WATERW", "WPUMPW", "WHEADW", "WVISCW")
    apart = differences(essence(plain.array), essence(counted.array))
    assert set(apart) <= set(sums)
    assert [float(plain.h.cd[getattr(g, name)]) for name in sums[:9]] == [0.0] * 9
    counted.energy("off")
    before = counted.h.cd.tolist()
    counted.cycle(10)
    assert [counted.h.cd[getattr(g, name)] for name in sums[:5]] == [
        before[getattr(g, name)] for name in sums[:5]
    ]
    for m in (plain, counted):
        with pytest.raises(UdecError) as caught:
            m.print("energy")
        assert caught.value.number == 26
