"""Stresses and loads that the reals cannot hold are error 28 and change nothing; what they hold is taken."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from offsets.generated import NSPARE, WFRIC
from udec_ia import Model, UdecError

EVERYWHERE = (-1.0, 99.0, -1.0, 99.0)


def blocks(build: str, kind: str) -> Model:
    """A block 40 by 20, simply-deformable or in two zones."""
    model = Model(build)
    model.block(0, 0, 0, 20, 40, 20, 40, 0)
    model.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=1e8)
    model.change(*EVERYWHERE, "sdef")
    if kind == "fdef":
        corners = [(0.0, 0.0), (0.0, 20.0), (40.0, 20.0), (40.0, 0.0)]
        model.generate(*EVERYWHERE, "manual", gridpoints=corners, zones=[(1, 2, 3), (1, 3, 4)])
    return model


def memory(model: Model) -> list[bytes]:
    """All words of a model but NSPARE, by which the array is kept ready for the next command."""
    return [part.tobytes() for part in (model.h.ia, np.delete(model.h.ci, NSPARE), model.h.cr)]


COMMANDS: dict[str, Callable[[Model, float], object]] = {
    "a stress": lambda m, s: m.insitu(*EVERYWHERE, 0.0, s, 0.0),
    "a stress that grows": lambda m, s: m.insitu(*EVERYWHERE, 0.0, 0.0, 0.0, xgrad=(0.0, s, 0.0)),
    "a load": lambda m, s: m.boundary(*EVERYWHERE, stress=(s, 0.0, 0.0)),
    "a load that grows": lambda m, s: m.boundary(*EVERYWHERE, stress=(0.0, 0.0, 0.0), ygrad=(0.0, 0.0, s)),
}


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
@pytest.mark.parametrize("kind", ["sdef", "fdef"])
@pytest.mark.parametrize("command", COMMANDS)
def test_what_the_reals_cannot_hold_changes_nothing(command: str, kind: str, build: str) -> None:
    """The largest real times half a length of 20 or more is refused; a millionth of it is taken."""
    model = blocks(build, kind)
    largest = float(np.finfo(model.h.cr.dtype).max)
    before = memory(model)
    with pytest.raises(UdecError, match=r"than \d\d-bit reals can hold") as caught:
        COMMANDS[command](model, 0.9 * largest)
    assert caught.value.number == 28
    assert memory(model) == before
    COMMANDS[command](model, -1e-6 * largest)
    assert model.check() == []


def test_an_energy_that_the_reals_cannot_hold_is_refused() -> None:
    """The square of 1e200 is beyond 64 bits; 1e100 is not."""
    model = blocks("i32r64", "sdef")
    model.insitu(*EVERYWHERE, 1e200, 0.0, 0.0)
    before = memory(model)
    with pytest.raises(UdecError, match="energy would be greater than 64-bit reals can hold"):
        model.energy()
    assert memory(model) == before
    model.insitu(*EVERYWHERE, 1e100, 0.0, 0.0)
    model.energy()
    model.insitu(*EVERYWHERE, 1e200, 0.0, 0.0)
    with pytest.raises(UdecError, match="energy would be greater than 64-bit reals can hold"):
        model.cycle(1)
    assert model.check() == []


def test_contacts_of_a_material_without_stiffness_store_nothing() -> None:
    """CHANGE has given the contacts another material before PROPERTY gives it a stiffness."""
    model = Model()
    model.block(0, 0, 0, 2, 1, 2, 1, 0)
    model.property(1, density=2000, kn=1e8, ks=1e8)
    model.split(-1, 1, 2, 1)
    model.fix(0, 1, 0, 1)
    model.gravity(0, -10)
    model.cycle(50)
    assert model.table("contact")["KCFN"].min() > 0
    model.change(0, 1, 0, 2, material=2)
    model.energy()
    assert model.check() == []
    assert np.isfinite(list(model.balance())).all()


def loaded(kind: str, traction: float) -> Model:
    """The block, rigid or in two zones, with normal tractions on all its sides; 32-bit reals."""
    model = Model("i32r32")
    model.block(0, 0, 0, 20, 40, 20, 40, 0)
    model.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=1e8)
    if kind == "fdef":
        model.change(*EVERYWHERE, "sdef")
        corners = [(0.0, 0.0), (0.0, 20.0), (40.0, 20.0), (40.0, 0.0)]
        model.generate(*EVERYWHERE, "manual", gridpoints=corners, zones=[(1, 2, 3), (1, 3, 4)])
    model.boundary(*EVERYWHERE, stress=(traction, 0.0, traction))
    return model


@pytest.mark.parametrize("kind", ["rigid", "fdef"])
def test_a_cycle_that_ends_with_a_number_beyond_the_reals_is_an_error(kind: str) -> None:
    """Forces of 8e37 times arms of 20 are no 32-bit real; the next cycle would find the block nowhere."""
    model = loaded(kind, 2e36)
    with pytest.raises(UdecError, match="in cycle 1") as caught:
        model.cycle(1)
    assert caught.value.number == 36
    assert model.check() != []
    model = loaded(kind, 2e6)
    model.cycle(1)
    assert model.check() == []


def test_a_work_beyond_the_reals_is_an_error() -> None:
    """The work of friction only grows: at the end of the reals it takes one more slip."""
    model = loaded("rigid", 1e3)
    model.h.cr[WFRIC] = np.inf
    with pytest.raises(UdecError, match="summed up in the run") as caught:
        model.cycle(1)
    assert caught.value.number == 36


def test_a_mean_stress_that_the_reals_cannot_hold_changes_nothing() -> None:
    """A fixed block does not move by its loads; their sum of force times arm is what CHANGE would put in."""
    model = Model("i32r32")
    model.block(0, 0, 0, 2, 2, 2, 2, 0)
    model.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=1e8)
    model.fix(*EVERYWHERE)
    model.boundary(*EVERYWHERE, stress=(1e38, 0.0, 1e38))
    model.cycle(1)
    before = memory(model)
    with pytest.raises(UdecError, match="the stress in block@1") as caught:
        model.change(*EVERYWHERE, "sdef")
    assert caught.value.number == 28
    assert memory(model) == before
