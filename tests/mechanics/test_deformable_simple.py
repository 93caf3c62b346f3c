"""Simply-deformable blocks: modes, stresses at rest, stresses that turn with the block (report 2.6)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import getr, putr
from udec_ia.kernels.body.sdef import put_strain_rate, put_stress, stress
from udec_ia.kernels.geometry.plane_tensors import cayley
from udec_ia.layout import offsets as g

RHO = 2000.0


def free_block(length: float, height: float, bulk: float, shear: float) -> tuple[Model, int, int]:
    """A free block `length` by `height`; model, addresses of block and extension."""
    model = Model()
    model.round(0.02 * min(length, height))
    model.block(0, 0, 0, height, length, height, length, 0)
    model.property(1, density=RHO, kn=1e9, ks=1e9, bulk=bulk, g=shear)
    model.change(-1, length + 1, -1, height + 1, "sdef")
    row = model.table("block")[0]
    return model, int(row["address"]), int(row["KBEX"])


def frequency(times: list[float], values: list[float]) -> float:
    """Circular frequency from the zero crossings of a vibration about zero."""
    t, v = np.array(times), np.array(values)
    i = np.flatnonzero(np.sign(v[1:]) != np.sign(v[:-1]))
    zero = t[i] - v[i] * (t[i + 1] - t[i]) / (v[i + 1] - v[i])
    return float(math.pi / np.diff(zero).mean())


@pytest.mark.parametrize(("length", "height"), [(2.0, 1.0), (1.0, 1.0), (1.0, 3.0)])
def test_uniaxial_mode(length: float, height: float) -> None:
    """w = sqrt(12) Cp/L; with no Poisson effect (K = 2G/3) the mode stands alone.

    Central differences shorten the period by (w dt)^2/24, at most 0.04 % here.
    """
    shear = 1e9
    model, _, ie = free_block(length, height, 2 * shear / 3, shear)
    model.fraction(0.05)
    model.cycle(0)
    putr(model.h, ie, g.KED11, 1e-3)
    times, values = [], []
    for _ in range(500):
        model.cycle(1)
        times.append(float(model.h.cd[g.TIME]))
        values.append(float(getr(model.h, ie, g.KS111)))
    speed = math.sqrt((2 * shear / 3 + 4 * shear / 3) / RHO)
    assert frequency(times, values) == pytest.approx(math.sqrt(12) * speed / length, rel=5e-3)


def test_mean_stress_at_rest_is_the_applied_stress() -> None:
    model = Model()
    model.round(0.2)
    model.block(0, -4, 0, 4, 10, 4, 10, -4)
    model.property(1, density=RHO, kn=1e8, ks=1e8, bulk=1e7, g=0.5e7, friction=0.5)
    model.split(-1, 0, 11, 0)
    model.fix(0, 10, -4, 0)
    model.change(0, 10, 0, 4, "sdef")
    model.gravity(0, -10)
    model.fraction(0.2)
    model.damping(0.5, 3.0, "mass")
    model.damping(0.8, 3.0, "internal")
    model.cycle(3000)
    row = model.table("sdef")[0]
    assert abs(row["KED11"]) + abs(row["KED22"]) < 1e-12
    applied = np.array([row["KSA11"], (row["KSA12"] + row["KSA21"]) / 2, row["KSA22"]]) / row["KSAREA"]
    inside = np.array([row["KS111"], row["KS112"], row["KS122"]])
    np.testing.assert_allclose(inside, applied, atol=1e-9 * abs(inside).max())
    assert inside[2] < 0  # pressed between its weight and the floor
    assert model.check() == []


def test_stress_turns_with_the_block() -> None:
    """A turn by 360 degrees in 1000 steps leaves the stress where it was, and its invariants on the way."""
    model, ib, ie = free_block(1.0, 1.0, 1e9, 1e9)
    model.fraction(0.02)
    model.cycle(0)
    h = model.h
    put_stress(h, ie, 3e5, -1e5, 1e5)
    put_strain_rate(h, ie, 0.0, 0.0, 0.0)
    tangent = 2 * math.tan(math.pi / 1000)  # the step's angle as the motion takes it
    c, s = cayley(h, tangent)
    for _ in range(1000):
        stress(h, ib, ie, c, s, None)
        s11, s12, s22 = (float(getr(h, ie, k)) for k in (g.KS111, g.KS112, g.KS122))
        assert s11 + s22 == pytest.approx(4e5, rel=1e-10)
        assert s11 * s22 - s12 * s12 == pytest.approx(2e10, rel=1e-9)
    assert (s11, s12, s22) == pytest.approx((3e5, -1e5, 1e5), rel=1e-9)


def test_a_spinning_block_keeps_its_shape() -> None:
    model, ib, _ = free_block(2.0, 1.0, 1e9, 1e9)
    model.fraction(0.1)
    model.cycle(0)
    putr(model.h, ib, g.KTD, 20.0)
    model.cycle(int(2 * math.pi / 20.0 / float(model.h.cr[g.TDEL])))
    row = model.table("sdef")[0]
    assert row["KSAREA"] == pytest.approx(2.0, rel=1e-12)
    assert abs(row["KS111"]) + abs(row["KS122"]) + abs(row["KS112"]) < 1e-6
    corners = model.table("corner")
    lengths = np.hypot(np.diff(corners["KXP"]), np.diff(corners["KYP"]))
    np.testing.assert_allclose(sorted(lengths)[0], 1.0, rtol=1e-12)


def test_a_block_cut_in_two_keeps_type_and_stress() -> None:
    model, _, ie = free_block(2.0, 1.0, 1e9, 1e9)
    put_stress(model.h, ie, -1e5, 0.0, -2e5)
    assert model.split(1, -1, 1, 2) == 1
    rows = model.table("sdef")
    assert rows["KS111"].tolist() == [-1e5, -1e5]
    assert rows["KS122"].tolist() == [-2e5, -2e5]
    assert rows["KSAREA"] == pytest.approx([1.0, 1.0])
    assert model.check() == []


def test_momentum_of_two_blocks_that_collide() -> None:
    """Contacts act equal and opposite: linear momentum stays to rounding."""
    model = Model()
    model.round(0.1)
    model.block(0, 0, 0, 1, 2, 1, 2, 0)
    model.property(1, density=RHO, kn=1e7, ks=1e7, bulk=1e7, g=0.5e7, friction=0.3)
    model.split(1, -1, 1, 2)
    model.change(0, 2, 0, 1, "sdef")
    model.fraction(0.05)
    model.cycle(0)
    first, second = model.table("block")["address"]
    for ib in (int(first), int(second)):
        towards = 1.0 if float(getr(model.h, ib, g.KX)) < 1 else -1.0
        putr(model.h, ib, g.KXD, towards * 0.5)
        putr(model.h, ib, g.KYD, 0.1 * towards)
    blocks = model.table("block")
    before = (blocks["KBM"] * blocks["KXD"]).sum(), (blocks["KBM"] * blocks["KYD"]).sum()
    model.cycle(500)
    blocks = model.table("block")
    scale = (blocks["KBM"] * 0.5).sum()
    after = (blocks["KBM"] * blocks["KXD"]).sum(), (blocks["KBM"] * blocks["KYD"]).sum()
    np.testing.assert_allclose(after, before, atol=1e-11 * scale)
    assert abs(model.table("sdef")["KS111"]).max() > 1.0
    assert model.check() == []


def test_a_block_that_is_turned_inside_out_ends_the_run() -> None:
    """A stress of 100 times the stiffness pulls a free block apart in a step or two: error 32 names it."""
    model, ib, ie = free_block(2.0, 1.0, 1e6, 1e6)
    model.cycle(0)
    put_stress(model.h, ie, 2e8, 0.0, 2e8)
    with pytest.raises(UdecError) as caught:
        model.cycle(50)
    assert caught.value.number == 32
    assert caught.value.group == ib
    assert f"block@{ib} at (" in caught.value.detail
