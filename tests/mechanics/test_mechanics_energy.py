"""Energy: what goes into motion, springs, height and friction adds up on runs without damping.

The springs hold Fn^2/2KN + Fs^2/2KS, friction has taken WFRIC. A leapfrog knows velocities at half steps:
the product of the two around a full step stands for the square of the velocity there, which keeps the
energy of a linear spring exactly.
"""

from __future__ import annotations

from math import radians, tan

import numpy as np
import pytest
from support.mechanics_scenes import G, at, block, box, model, no_damping, on_base, push, sound, step

from udec_ia import Model
from udec_ia.layout.offsets import AKN, AKS, GRAVX, GRAVY, WFRIC


def cycle_and_energy(m: Model) -> float:
    """One cycle, and the energy (J/m) at the full step before it."""
    cr = m.h.cr
    before, contacts, friction = m.table("block"), m.table("contact"), float(m.h.cd[WFRIC])
    m.cycle(1)
    after = m.table("block")
    free = before["KBFIX"] == 0
    linear = before["KXD"] * after["KXD"] + before["KYD"] * after["KYD"]
    motion = (before["KBM"] * linear + before["KBI"] * before["KTD"] * after["KTD"]) / 2
    height = -before["KBM"] * (cr[GRAVX] * before["KX"] + cr[GRAVY] * before["KY"])
    material = contacts["KCM"] - 1
    springs = contacts["KCFN"] ** 2 / cr[AKN + material] + contacts["KCFS"] ** 2 / cr[AKS + material]
    return float(motion[free].sum() + height[free].sum() + springs.sum() / 2 + friction)


def test_a_bouncing_block_keeps_its_energy() -> None:
    """A block dropped flat on its two contacts rises again to where it was, bounce after bounce."""
    m = model(*box(0, 1, -1, 3), d=0.1, fraction=0.02)
    m.split(-1, 0, 2, 0)
    m.split(-1, 1.5, 2, 1.5)
    m.delete(0, 1, 0, 1.5)
    m.fix(0, 1, -1, 0)
    address, top = block(m, 0.5, 2.25)["address"], 2.25
    start = cycle_and_energy(m)
    drop = 1000 * 1.5 * G * 1.5
    flight = 2 * (2 * 1.5 / G) ** 0.5
    heights, energies = [], []
    for _ in range(int(2.2 * flight / step(m) / 100)):
        m.cycle(99)
        energies.append(cycle_and_energy(m))
        heights.append(float(at(m, "block", address)["KY"]))
    assert np.ptp([start, *energies]) < 0.01 * drop
    low = heights.index(min(heights[: len(heights) // 2]))
    assert max(heights[low:]) == pytest.approx(top, abs=0.01 * 1.5)
    sound(m)


def test_a_sliding_block_pays_its_energy_to_friction() -> None:
    """Thrown along the base, it stops after v^2/(2 mu g): all its motion is in WFRIC."""
    mu, v = tan(radians(20)), 2.0
    m = on_base(2.0, 1.0, 0.1, 12.0, friction=mu)
    m.damping(1.0, 30.0, "mass")
    m.cycle(800)
    no_damping(m)
    row = block(m, 0, 0.5)
    push(m, row["address"], xd=v)
    m.cycle(1)
    energies = []
    for _ in range(130):
        energies.append(cycle_and_energy(m))
        m.cycle(9)
    kinetic = 2000 * v**2 / 2
    assert np.ptp(energies) < 0.01 * kinetic
    after = at(m, "block", row["address"])
    assert after["KX"] - row["KX"] == pytest.approx(v**2 / (2 * mu * G), rel=0.01)
    assert m.h.cd[WFRIC] == pytest.approx(kinetic, rel=0.01)
    sound(m)


def wall() -> Model:
    """Three courses of three blocks on a base, the middle joints of the second course shifted by half."""
    m = model(*box(0, 6, -1, 6), d=0.2, friction=0.3, fraction=0.02, density=2000.0, stiffness=(5e8, 5e8))
    for y in (0, 2, 4):
        m.split(-1, y, 7, y)
    for y in (0, 2, 4):
        for x in (1.0, 3.0, 5.0) if y == 2 else (2.0, 4.0):
            m.split(x, y - 0.5, x, y + 2.5)
    m.fix(0, 6, -1, 0)
    return m


def test_an_undamped_collapse_keeps_the_energy() -> None:
    """A wall that loses a block of its lowest course: height turns into motion, springs and friction."""
    m = wall()
    assert m.delete(4, 6, 0, 2) == 1
    start = cycle_and_energy(m)
    blocks = m.table("block")
    height0 = float((blocks["KBM"] * blocks["KY"]).sum() * G)
    energies = []
    for _ in range(300):
        m.cycle(39)
        energies.append(cycle_and_energy(m))
    sound(m)
    blocks = m.table("block")
    fallen = height0 - float((blocks["KBM"] * blocks["KY"]).sum() * G)
    assert fallen > 2000 * 4 * G * 2
    assert max(abs(energy - start) for energy in energies) < 0.01 * fallen
