"""Stresses and loads that the reals cannot hold are error 28 and change nothing; what they hold is taken."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.layout.offsets import NSPARE, TDEL, WFRIC

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
    return [part.tobytes() for part in (model.h.ia, np.delete(model.h.ci, NSPARE), model.h.cr, model.h.cd)]


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
    model.array.h.cd[WFRIC] = np.inf
    with pytest.raises(UdecError, match="of the whole run") as caught:
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


@pytest.mark.parametrize("build", ["i32r32", "i32r64"])
def test_a_density_whose_masses_the_reals_cannot_hold_is_refused(build: str) -> None:
    """Before BLOCK and after it; the heaviest that is taken makes masses that are finite."""
    largest = float(np.finfo(Model(build).h.cr.dtype).max)
    corners = (0, 0, 0, 20, 40, 20, 40, 0)
    model = Model(build)
    model.block(*corners)
    with pytest.raises(UdecError, match="moment of inertia at a density") as caught:
        model.property(1, density=largest / 1e3)
    assert caught.value.number == 28
    model.property(1, density=largest / 1e8)
    model.split(-1, 3, 41, 4)
    model.change(*EVERYWHERE, material=2)
    assert model.check() == []
    model = Model(build)
    model.property(2, density=largest / 1e3)
    with pytest.raises(UdecError, match="moment of inertia at a density"):
        model.block(*corners)
    assert len(model.table("block")) == 0


def test_factors_that_the_reals_cannot_interpolate_are_refused() -> None:
    """Halfway from the greatest real to the least their difference would be infinite."""
    model = Model("i32r32")
    with pytest.raises(UdecError, match="f2 - f1") as caught:
        model.function(1, 0.0, 3e38, 1.0, -3e38)
    assert caught.value.number == 28
    with pytest.raises(UdecError, match="t3 - t2"):
        model.function(1, -3.2e38, 1.0, -3.1e38, 0.0, 3e38, 1.0)
    assert model.check() == []


def test_an_edge_of_zones_that_is_next_to_nothing_is_refused() -> None:
    """The number of zones would be beyond 64 bits."""
    model = blocks("i32r64", "sdef")
    for edge in (1e-320, 1e-200, 1e-100):
        with pytest.raises(UdecError, match="in number") as caught:
            model.generate(*EVERYWHERE, "automatic", edge=edge)
        assert caught.value.number == 28


def test_a_potential_that_the_reals_cannot_hold_is_refused() -> None:
    """1.6e6 kg at a height of 10 m under a gravity of 2e301 m/s2. The account has 64 bits in every scheme."""
    small = Model("i32r32")
    small.block(0, 0, 0, 20, 40, 20, 40, 0)
    small.property(1, density=2000, kn=1e8, ks=1e8)
    small.gravity(0, -1e35)
    small.energy("on")
    assert small.balance().commands == 0
    model = Model()
    model.block(0, 0, 0, 20, 40, 20, 40, 0)
    model.property(1, density=2000, kn=1e8, ks=1e8)
    model.cycle(1)
    model.gravity(0, -2e301)
    before = memory(model)
    with pytest.raises(UdecError, match="potential of gravity") as caught:
        model.energy("on")
    assert caught.value.number == 28
    assert memory(model) == before


def test_an_energy_beyond_the_reals_at_the_end_of_a_cycle_is_an_error() -> None:
    """A velocity of 1e160 is a real, and its square times a mass is not."""
    model = Model()
    model.block(0, 0, 0, 20, 40, 20, 40, 0)
    model.property(1, density=2000, kn=1e305, ks=1e305)
    model.energy("on")
    model.boundary(*EVERYWHERE, xvel=1e160)
    with pytest.raises(UdecError, match="energy") as caught:
        model.cycle(1)
    assert caught.value.number == 36


def test_the_moment_of_inertia_of_a_block_that_leaps_is_that_of_its_shape() -> None:
    """In one step a block in two zones goes a thousand times farther than it is long, in 32 bits."""
    model = blocks("i32r32", "fdef")
    model.boundary(*EVERYWHERE, xvel=0.0)
    model.cycle(1)
    before = model.table("block")["KBI"][0]
    model.boundary(*EVERYWHERE, xvel=4e5 / float(model.h.cr[TDEL]))
    model.cycle(1)
    block = model.table("block")[0]
    assert block["KX"] > 3e5
    assert block["KBI"] == pytest.approx(before, rel=1e-4)
