"""FIX and given velocities hold blocks of every type, in whole or at a grid-point."""

from __future__ import annotations

import numpy as np
import pytest
from naive.bodies import points_of
from support.lone_block_loads import EVERYWHERE, TYPES, G, K, lone
from support.mechanics_scenes import at, block, box, model, push, sound

from udec_ia import Model
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g
from udec_ia.studies.verification_tools import fan


def on_floor(kind: str) -> tuple[Model, int, int]:
    """A block of `kind` on a floor of the same kind, pressed by gravity: model, floor and block."""
    m = model(*box(0, 2, -1, 1), d=0.1, friction=0.5)
    m.property(1, bulk=K, g=G)
    m.split(-1, 0, 3, 0)
    if kind == "sdef":
        m.change(*EVERYWHERE, type="sdef")
    elif kind == "zoned":
        fan(m, 1, 0.5)
        fan(m, 1, -0.5)
    return m, int(block(m, 1, -0.5)["address"]), int(block(m, 1, 0.5)["address"])


@pytest.mark.parametrize("kind", TYPES)
def test_a_fixed_block_has_no_velocity_whatever_is_given(kind: str) -> None:
    """What stands on it does not feel the velocity. Set free, the block has it."""
    m, floor, _ = on_floor(kind)
    plain, _, _ = on_floor(kind)
    m.boundary(-0.1, 2.1, -1.1, 0.05 if kind != "zoned" else -0.5, xvel=0.5)
    for one in (m, plain):
        one.fix(0, 2, -1, 0)
        one.cycle(50)
    for row, name in (("block", "KX"), ("block", "KXD"), ("contact", "KCFS"), ("contact", "KCFN")):
        np.testing.assert_array_equal(m.table(row)[name], plain.table(row)[name])
    assert m.table("contact")["KCFN"].max() > 0
    m.free(0, 2, -1, 0)
    before = float(at(m, "block", floor)["KX"])
    m.cycle(10)
    dt = float(m.h.cr[g.TDEL])
    if kind != "zoned":
        assert at(m, "block", floor)["KX"] - before == pytest.approx(5 * dt, rel=1e-9)
    else:
        corner = m.table("gridpoint")["KYG"].argmin()
        assert m.table("gridpoint")["KXDG"][corner] == 0.5
    sound(m)


@pytest.mark.parametrize("kind", TYPES)
def test_fix_stops_all_of_a_block(kind: str) -> None:
    """A block that is fixed while it flies and deforms stands still at once; set free it starts from rest."""
    m, _, top = on_floor(kind)
    m.fix(0, 2, -1, 0)
    m.gravity(0, 0)
    m.cycle(1)
    for p in points_of(m).get(top, []):
        putr(m.h, int(p["address"]), g.KYDG, 0.1)
        putr(m.h, int(p["address"]), g.KXDG, 0.05 * float(p["KYG"]))
    if kind != "zoned":
        push(m, top, xd=0.1, yd=0.1, td=0.1)
    if kind == "sdef":
        putr(m.h, int(at(m, "block", top)["KBEX"]), g.KED11, 0.1)
    m.cycle(2)
    m.fix(0, 2, 0, 1)
    where = m.table("corner")
    m.cycle(5)
    for name in ("KXP", "KYP"):
        np.testing.assert_array_equal(m.table("corner")[name], where[name])
    contacts = m.table("contact")
    assert not contacts["KXDC"][contacts["KCFN"] > 0].any()
    m.free(0, 2, 0, 1)
    assert not any(at(m, "block", top)[k] for k in ("KXD", "KYD", "KTD"))
    assert not any(p[k] for p in points_of(m).get(top, []) for k in ("KXDG", "KYDG"))
    sound(m)


def test_both_velocities_given_stop_the_turning() -> None:
    m = lone("rigid", box(0, 2, 0, 1))
    m.cycle(0)
    push(m, int(m.table("block")["address"][0]), td=2.0)
    m.boundary(*EVERYWHERE, xvel=1.0, yvel=0.0)
    m.cycle(10)
    ring = m.table("corner")
    assert m.table("block")["KTD"][0] == 0
    assert np.hypot(ring["KXDP"] - 1, ring["KYDP"]).max() == 0


def test_a_grid_point_inside_takes_velocities_and_forces() -> None:
    m = lone("zoned", box(0, 2, 0, 1))
    (inner,) = (row for row in m.table("gridpoint") if not row["KCOR"])
    x, y = float(inner["KXG"]), float(inner["KYG"])
    assert m.boundary(x - 0.01, x + 0.01, y - 0.01, y + 0.01, xvel=0.5, yvel=0.0) == 1
    m.cycle(10)
    held = at(m, "gridpoint", int(inner["address"]))
    assert (held["KGFIX"], held["KXDG"], held["KYDG"]) == (3, 0.5, 0)
