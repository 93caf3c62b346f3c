"""Energy from nowhere: a step above the safe bound is warned of, and what it throws apart is stopped.

Against false alarms: with every run suspected, whatever its step, none that is sound is blamed.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import pytest
from support.brick_slope import slope
from support.every_group_kind import every_kind
from support.mechanics_scenes import block, on_base, push

from udec_ia import Model, UdecError
from udec_ia.advice import energy_monitor
from udec_ia.advice.contact_chatter_monitor import JUDGE
from udec_ia.cli import main
from udec_ia.layout import offsets as g
from udec_ia.remark import Remark

WARNING = re.compile(
    r"time-step of \S+ s is (\S+) of the safe bound, which (\S+) at \(\S+ \S+\) sets.* FRACTION (\S+) is safe"
)


def deck_of_stack(fraction: float, y: float = 0.0) -> str:
    """Three blocks on each other without damping, from the height `y` on."""
    return f"""START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5
BLOCK 0,{y} 0,{y + 3} 1,{y + 3} 1,{y}
SPLIT -1,{y + 1} 2,{y + 1}
SPLIT -1,{y + 2} 2,{y + 2}
FIX 0 1 {y} {y + 1}
GRAVITY 0 -10
FRAC {fraction}
"""


def stack(fraction: float, out: Path, y: float = 0.0) -> Model:
    m = Model(out=out)
    m.run(deck_of_stack(fraction, y))
    return m


@pytest.mark.parametrize("fraction", [0.45, 0.5])
def test_a_deck_that_runs_away_is_warned_of_and_stopped(
    fraction: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    deck = tmp_path / "stack.dat"
    deck.write_text(deck_of_stack(fraction) + "CYCLE 20000\nSTOP\n")
    assert main(["run", str(deck), "--out", str(tmp_path)]) == 1
    printed = capsys.readouterr()
    warning = WARNING.search(printed.out)
    assert warning is not None
    assert printed.out.index(warning.group()) < printed.out.index("cycle 100 of 20000")
    assert "error 37: more energy than was put in" in printed.err
    assert re.search(r"block@\d+ leads with", printed.err)
    assert (tmp_path / "rescue.h5").exists()


def test_the_cycles_that_stay_of_a_run_of_a_deck_are_in_the_deck_of_the_model(tmp_path: Path) -> None:
    m = stack(0.5, tmp_path)
    with pytest.raises(UdecError, match="more energy than was put in"):
        m.run("CYCLE 20000\n")
    assert m.deck().splitlines()[-1] == f"CYCLE {int(m.h.ci[g.MCTOT])}"
    again = Model(out=tmp_path)
    with suppress(UdecError):  # the same, after its last cycle
        again.run(m.deck())
    assert again.array.h.ia.tobytes() == m.array.h.ia.tobytes()


def test_python_is_warned_once_and_hears_of_the_group(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    m = stack(0.5, tmp_path)
    with caplog.at_level(logging.WARNING, "udec_ia"), pytest.raises(UdecError) as caught:
        cycle_by_tens(m)
    assert caught.value.number == 37
    assert caught.value.group in m.table("block")["address"]
    assert len([one for one in caplog.messages if WARNING.search(one)]) == 1


def test_the_fraction_that_the_warning_names_is_silent_and_sound(tmp_path: Path) -> None:
    m = stack(0.5, tmp_path)
    told: list[str] = []
    m.tell = told.append
    m.cycle(0)
    found = WARNING.search(told[0])
    assert found is not None
    m.fraction(float(found[3]))
    m.cycle(2000)
    assert len(told) == 1
    assert float(m.table("block")["KY"].max()) == pytest.approx(2.5, abs=0.01)


def test_a_step_that_contacts_yet_to_come_make_unsafe_is_found_on_the_way(tmp_path: Path) -> None:
    """In the air nothing bounds it; after the fall it is warned of, in the midst of the CYCLE."""
    m = Model(out=tmp_path)
    told: list[str] = []
    m.tell = told.append
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.block(0, 0, 0, 3.4, 1, 3.4, 1, 0)
    for y in (1, 1.2, 2.2, 2.4):
        m.split(-1, y, 2, y)
    m.delete(0, 1, 1, 1.2)
    m.delete(0, 1, 2.2, 2.4)
    m.fix(0, 1, 0, 1)
    m.fraction(0.3)
    m.damping(0.5, 20, "mass")
    m.gravity(0, -10)
    m.cycle(1)
    assert told == []
    m.cycle(2000)
    (warning,) = told
    assert WARNING.search(warning)


def cycle_by_tens(m: Model) -> None:
    for _ in range(100):
        m.cycle(10)


# ---- no false alarms


def impact(m: Model) -> None:
    """A block is thrown onto its base, again and again, without damping."""
    push(m, int(block(m, 0, 0.5)["address"]), xd=0.5, yd=2.0)
    m.cycle(6000)


def fall(m: Model) -> None:
    """The base goes, and the block falls for ever."""
    m.cycle(500)
    m.free(-9, 9, -9, 0)
    m.cycle(3000)


def drive(m: Model) -> None:
    """A base that shakes, and then one that pushes at constant speed."""
    m.free(-9, 9, -9, 0)
    m.boundary(-9, 9, -9, 0, xvel=0.3, yvel=0.0, sine=(2.0, 2.0))
    m.cycle(3000)
    m.boundary(-9, 9, -9, 0, xvel=0.5, yvel=0.1)
    m.cycle(2000)


def load(m: Model) -> None:
    """A force that pulls the block away over the base, from one CYCLE to the next."""
    m.boundary(-1, 1, 0, 1, xforce=4e4)
    for _ in range(300):
        m.cycle(7)


def grow(m: Model) -> None:
    """Gravity that grows, and swings, far above the origin and far below it."""
    m.function(1, 0.0, 0.0, 0.05, 1.0, 0.1, 0.2, 0.15, 2.0)
    m.gravity(0, -10, function=1)
    for _ in range(20):
        m.cycle(100)


@pytest.mark.parametrize("height", [1e4, -1e4])
@pytest.mark.parametrize("fraction", [0.1, 0.5])
def test_gravity_that_grows_is_no_energy(
    height: float, fraction: float, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor does it hide energy from nowhere."""
    monkeypatch.setattr(energy_monitor, "SUSPECT", 0.0)
    m = stack(fraction, tmp_path, height)
    m.function(1, 0.0, 0.0, 0.05, 1.0)
    m.gravity(0, -10, function=1)
    if fraction == 0.1:
        m.cycle(2000)
    else:
        with pytest.raises(UdecError, match="more energy than was put in"):
            m.cycle(20000)


def strengthen(m: Model) -> None:
    """What commands put in: a stiffness, a velocity, a block that goes; over a restart."""
    m.cycle(950)
    m.property(1, kn=4e8, ks=4e8)
    m.restart(m.save((m.out / "half.h5").absolute()))
    m.cycle(950)
    push(m, int(block(m, 0, 0.5)["address"]), xd=5.0)
    m.cycle(950)


@pytest.mark.parametrize("play", [impact, fall, drive, load, grow, strengthen])
def test_no_run_at_a_sound_step_is_blamed(
    play: Callable[[Model], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(energy_monitor, "SUSPECT", 0.0)
    looks = watched(monkeypatch)
    m = on_base(1.0, 1.0, 0.1, 4.0, friction=0.5, density=2000)
    m.out = tmp_path
    play(m)
    assert len(looks) >= 10


def test_blocks_of_all_kinds_under_all_conditions_are_not_blamed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(energy_monitor, "SUSPECT", 0.0)
    looks = watched(monkeypatch)
    m = every_kind()
    m.out = tmp_path
    m.damping(0.1, 30.0, "stiffness")
    for _ in range(3):
        m.cycle(400)
    assert len(looks) >= 10


def watched(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The cycles at which the energy of a suspected run is looked at."""
    looks: list[int] = []
    look = energy_monitor.EnergyMonitor.look

    def counted(self: energy_monitor.EnergyMonitor, array: energy_monitor.MainArray) -> None:
        if self._account is not None and array.h.ci[g.MCTOT] % energy_monitor.LOOK == 0:
            looks.append(int(array.h.ci[g.MCTOT]))
        look(self, array)

    monkeypatch.setattr(energy_monitor.EnergyMonitor, "look", counted)
    return looks


def test_what_boundary_conditions_put_in_is_summed(tmp_path: Path) -> None:
    """A force of 100 N/m on 1000 kg/m over its way, and a velocity that is given at once."""
    m = Model(out=tmp_path)
    m.property(1, density=1000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.boundary(-1, 2, -1, 2, xforce=100.0)
    m.cycle(1000)
    moved = 1000 * float(m.table("block")["KXD"][0]) ** 2 / 2
    assert float(m.h.cd[g.WDRIVE]) == pytest.approx(moved, rel=0.01)
    m.boundary(-1, 2, -1, 2, free=True)
    m.boundary(-1, 2, -1, 2, xvel=3.0, yvel=4.0)
    before = float(m.h.cd[g.WDRIVE])
    m.cycle(10)
    assert float(m.h.cd[g.WDRIVE]) - before == pytest.approx(1000 * 25 / 2 - moved, rel=1e-6)
    assert not math.isnan(float(m.h.cd[g.WDRIVE]))


def test_a_command_puts_no_work_in() -> None:
    """CHANGE makes the force sums anew, and no step goes by."""
    m = Model()
    m.property(1, density=1000, kn=1e8, ks=1e8, bulk=1e8, g=1e8)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.boundary(-1, 2, -1, 2, yforce=-100.0)
    m.cycle(10)
    before = float(m.h.cd[g.WDRIVE])
    assert before > 0
    m.change(-1, 2, -1, 2, type="sdef")
    assert float(m.h.cd[g.WDRIVE]) == before


def bricks(out: Path, **damping: float) -> Model:
    """Courses of bricks on a slope, with mass damping of 1 Hz or another `damping`."""
    m = slope(out)
    if damping:
        m.damping(**damping)
    else:
        m.damping(0.5, 1, "mass")
    return m


def test_marks_are_forgotten_when_contacts_get_new_addresses() -> None:
    """JPROPERTY moves all contacts of a model without joints."""
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.block(0, 1, 0, 2, 1, 2, 1, 1)
    m.gravity(0, -10)
    m.fix(0, 1, 0, 1)
    m.cycle(JUDGE + 100)
    monitor = m.session.monitors.chatter
    assert monitor.marks(m.h, 1).any()
    m.jproperty(1, kn=1e8, ks=1e8, friction=0.5, between=(1, 1))
    assert not monitor.marks(m.h, 1).any()


def test_contacts_that_chatter_are_told(tmp_path: Path) -> None:
    """They slide on contacts that open and close all the time. With LOCAL damping they hold, unremarked."""
    m = bricks(tmp_path)
    printed: list[str] = []
    m.tell = printed.append
    m.cycle(2500)
    (text,) = printed
    assert isinstance(text, Remark)
    assert text.key == "contacts-chatter"
    where = int(text.partition("contact@")[2].split()[0])
    assert where in m.table("contact")["address"]
    assert (bool(m.solve(1e-4, 1500)), len(printed)) == (False, 1)
    held = bricks(tmp_path, local=0.8)
    held.tell = printed.append
    held.cycle(3000)
    assert held.solve(1e-4)
    assert len(printed) == 1
