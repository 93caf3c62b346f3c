"""SPLIT and DELETE between two CYCLEs: what moves goes on moving, what is pressed stays pressed."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from support.mechanics_scenes import G, at, block, box, model, on_base, push, sound

KN = 1e9
EPS = np.finfo(float).eps


def _momentum(blocks: np.ndarray) -> list[float]:
    px, py = blocks["KBM"] * blocks["KXD"], blocks["KBM"] * blocks["KYD"]
    spin = blocks["KX"] * py - blocks["KY"] * px + blocks["KBI"] * blocks["KTD"]
    return [float(px.sum()), float(py.sum()), float(spin.sum())]


@pytest.mark.parametrize("cut", [(0.3, 0.5, 0.7, 9.0), (-5.0, 4.0, 5.0, 6.5), (-5.0, 3.0, 5.0, 7.0)])
def test_halves_carry_on_the_motion(cut: tuple[float, float, float, float]) -> None:
    """Mass, centre of mass, momentum and moment of momentum of the halves add up to those of the whole; they
    turn with its angular velocity.

    100 cycles round the coordinates, which are up to 10 from the origin, before the halves are measured.
    """
    lost = 100 * 10 * EPS
    m = model(*box(-1, 2, 0, 7), d=0.1, gravity=(0.0, 0.0))
    m.split(-9, 1, 9, 1)
    m.split(-9, 3, 9, 3)
    m.delete(-9, 9, 1, 3)
    m.fix(-9, 9, 0, 1)
    push(m, block(m, 0.5, 5)["address"], 1.0, 2.0, 0.7)
    m.cycle(100)
    before = m.table("block")
    (whole,) = before[before["KBFIX"] == 0]
    assert m.split(*cut) == 1
    after = m.table("block")
    halves = after[after["KBFIX"] == 0]
    assert len(halves) == 2
    assert list(halves["KTD"]) == [whole["KTD"]] * 2
    scale = float(whole["KBM"]) * 10
    assert _momentum(halves) == pytest.approx(_momentum(whole.reshape(1)), abs=lost * scale)
    assert halves["KBM"].sum() == pytest.approx(whole["KBM"], rel=lost)
    for k in ("KX", "KY"):
        assert (halves["KBM"] * halves[k]).sum() == pytest.approx(whole["KBM"] * whole[k], rel=lost)
    sound(m)


def test_a_cut_under_load_keeps_the_forces() -> None:
    """A resting block is cut from top to bottom: old contacts keep their forces, the crack's are new and
    empty. Without friction no half can lean on the other for long: each comes to stand on its own two."""
    m = on_base(4.0, 2.0, 0.1, 8.0, stiffness=(KN, KN))
    m.damping(1.0, (2 * KN / 8e3) ** 0.5 / (2 * pi), "mass")
    m.cycle(400)
    before = m.table("contact")
    assert m.split(0, -0.2, 0, 3) == 1
    after = m.table("contact")
    for row in before:
        kept = at(m, "contact", row["address"])
        assert (kept["KCFN"], kept["KCFS"]) == (row["KCFN"], row["KCFS"])
        assert kept["KCN"] == pytest.approx(row["KCN"], abs=16 * EPS)
    new = after[~np.isin(after["address"], before["address"])]
    assert len(new) >= 2
    assert not new["KCFN"].any()
    assert not new["KCFS"].any()
    for row in m.table("block"):
        if row["KBFIX"] == 0:
            assert row["KBFY"] == pytest.approx(8e3 * G / 2, rel=1e-6)
    sound(m)
    m.cycle(4000)
    sound(m)
    contacts, weight = m.table("contact"), 8e3 * G
    base = block(m, 0, -0.5)["address"]
    on_the_base = (contacts["KB1"] == base) | (contacts["KB2"] == base)
    assert contacts["KCFN"][on_the_base] == pytest.approx([weight / 4] * 4, rel=1e-4)  # they lean by 4e-5
    assert abs(block(m, 1, 1)["KYD"]) < 1e-9


def test_deleting_a_loaded_block_releases_its_neighbours() -> None:
    """Three blocks in a pile: the middle one goes; the upper one begins to fall with g, freely, and the
    lower one is pushed up by springs that hold three weights and have one to carry."""
    m = on_base(2.0, 6.0, 0.1, 6.0, stiffness=(KN, KN), friction=0.5)
    m.split(-3, 2, 3, 2)
    m.split(-3, 4, 3, 4)
    m.damping(0.6, (2 * KN / 4e3) ** 0.5 / (2 * pi), "mass")
    m.cycle(3000)
    m.damping(0.0, 1.0)
    assert m.delete(-1, 1, 2, 4) == 1
    sound(m)
    upper, lower = (block(m, 0, y)["address"] for y in (5, 1))
    assert at(m, "block", upper)["KBFY"] == 0
    assert at(m, "block", lower)["KBFY"] == pytest.approx(3 * 4e3 * G, rel=1e-6)
    start = at(m, "block", upper), at(m, "block", lower)
    m.cycle(1)
    end = at(m, "block", upper), at(m, "block", lower)
    dt = float(end[0]["KY"] - start[0]["KY"]) / float(end[0]["KYD"])
    gain = [(b["KYD"] - a["KYD"]) / dt for a, b in zip(start, end, strict=True)]
    assert gain == pytest.approx([-G, 2 * G], rel=1e-6)
    assert end[0]["KTD"] == 0
    sound(m)
    m.damping(1.0, (2 * KN / 4e3) ** 0.5 / (2 * pi), "stiffness")
    m.cycle(int(2 * (4 / G) ** 0.5 / dt))
    sound(m)
    contacts = np.sort(m.table("contact"), order="KYC")
    assert contacts["KCFN"] == pytest.approx([4e3 * G] * 2 + [4e3 * G / 2] * 2, rel=1e-6)
