"""A nearly straight corner on a tilted edge: what touches is the arc or its end, not the circle beyond it."""

from __future__ import annotations

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.heap.accessors import getr, putr
from udec_ia.kernels.geometry.block_shape import crad
from udec_ia.kernels.geometry.contact_geometry import BLUNT, meet
from udec_ia.layout import offsets as g

D = 0.05


def on_a_corner(slope: float) -> tuple[Model, int, int]:
    """A block that stands on the corner (0, 0), the edges beside it rising by `slope`, on a flat base.

    Returns the model, that corner, and the one at the end of the edge under it.
    """
    m = Model()
    m.block(-2, -1, -2, 1, 2, 1, 2, -1)
    m.split(-3, 0, 3, 0)
    for way in (-1, 1):
        m.split(-0.001 * way, -0.001 * slope, 2.1 * way, 2.1 * slope)
        m.delete(*sorted((1.2 * way, 1.5 * way)), 0.0, 0.7 * slope)
    m.round(D)
    corners = m.table("corner")
    upper = np.isin(corners["KNB"], corners["KNB"][corners["KYP"] > 0.9])
    apex = corners["address"][upper & (abs(corners["KXP"]) < 1e-9)]
    below = corners["address"][~upper & (corners["KXP"] > 1) & (abs(corners["KYP"]) < 1e-9)]
    return m, int(apex[0]), int(below[0])


def tilt(m: Model, apex: int, angle: float) -> None:
    """Turn the block of the corner about it, anticlockwise."""
    corners, c, s = m.table("corner"), np.cos(angle), np.sin(angle)
    block = corners["KNB"][corners["address"] == apex][0]
    for row in corners[corners["KNB"] == block]:
        for kx, ky, x, y in (
            (g.KXP, g.KYP, row["KXP"], row["KYP"]),
            (g.KXCP, g.KYCP, row["KXCP"], row["KYCP"]),
        ):
            putr(m.array.h, int(row["address"]), kx, c * x - s * y)
            putr(m.array.h, int(row["address"]), ky, s * x + c * y)


def arc(slope: float, angle: float) -> np.ndarray:
    """Many points of the arc at the corner (0, 0), from end to end."""
    half = np.arctan(slope)
    radius = D / np.tan(half)
    centre = np.array([0.0, radius / np.cos(half)])
    turn = np.linspace(-half, half, 20001) - np.pi / 2
    points = centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


@pytest.mark.parametrize("angle", [-0.2, -0.05, -0.031, -0.01, 0.0, 0.02, 0.029, 0.04, 0.2])
def test_a_blunt_corner_touches_by_a_place_of_its_arc(angle: float) -> None:
    slope = 0.03
    m, apex, below = on_a_corner(slope)
    assert m.table("corner")["KRAD"].max() > BLUNT * D
    tilt(m, apex, angle)
    h = m.array.h
    deepest = min(arc(slope, angle), key=lambda point: point[1])
    for code, pair in ((g.EDGE_CORNER, (below, apex)), (g.CORNER_EDGE, (apex, below))):
        nx, ny, overlap, x, y, _ = meet(h, code, *pair)
        up = 1 if code == g.EDGE_CORNER else -1
        assert (nx, ny) == pytest.approx((0.0, up), abs=1e-12)
        assert overlap == pytest.approx(-deepest[1], abs=1e-9)
        assert (x, y) == pytest.approx((deepest[0], deepest[1] + overlap / 2), abs=2e-4 * D)


@pytest.mark.parametrize("angle", [-0.2, -0.05, 0.0, 0.04, 0.2])
def test_a_sharp_corner_touches_by_its_circle(angle: float) -> None:
    slope = 0.5
    m, apex, below = on_a_corner(slope)
    tilt(m, apex, angle)
    _, _, overlap, x, y, _ = meet(m.array.h, g.EDGE_CORNER, below, apex)
    half = np.arctan(slope)
    radius, far = D / np.tan(half), D / np.sin(half)
    centre = far * np.array([-np.sin(angle), np.cos(angle)])
    assert overlap == pytest.approx(radius - centre[1], abs=1e-12)
    assert (x, y) == pytest.approx((centre[0], -overlap / 2), abs=1e-12)


def test_a_blunt_corner_finds_its_contact_beside_a_rounded_one() -> None:
    """Its circle's centre is 300 m away, and its end touches an edge between a notch and an arc."""
    m, d = Model(), 0.2
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0)
    upper = [(0, 2.01), (4, 2.01), (4, 1.01), (1.5, 1.03), (0, 1.01)]
    lower = [(0, 1), (1, 1.001), (4, 1), (4, 0), (0, 0)]
    m.block(*np.ravel([(-2, 0), (-2, 2.01), *upper, (-1, 1.01), (-1, 1), *lower]))
    m.split(0, -1, 0, 3)
    m.delete(-3, -0.1, -1, 9)
    m.round(d)
    m.cycle(0)
    blocks = m.table("block")
    above = int(blocks["address"][blocks["KY"] > 1][0])
    m.rset(-0.1 * d / float(m.h.cr[g.TDEL]), above, g.KYD[1])
    for _ in range(6):
        m.cycle(1)
        assert m.check() == []
    contacts = m.table("contact")
    assert (abs(contacts["KXC"] - 0.8) < 0.01).any()


def test_an_arc_passes_a_point_of_an_edge_without_a_jolt() -> None:
    """A corner slides below a mesh point that has a contact beyond its arc: nothing overlaps at any time."""
    m, d, gap = Model(), 0.2, 0.02
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0, bulk=1e8, g=6e7)
    y, px = 1 - 1.5 * np.tan(0.4), 1.5 + 1.1 * d
    left = [-1, y - 1, -1, 2 + gap, 0, 2 + gap, 3, 2 + gap, 3, 1 + gap, 0, 1 + gap, -0.5, 1 + gap, -0.5, y]
    m.block(*left, *(0, y, 1.5, 1, 3, 1.003, 3, y - 1, 0, y - 1))
    m.split(0, -9, 0, 3)
    m.delete(-2, -0.05, -9, 3)
    m.round(d)
    points = [(0, 1 + gap), (0, 2 + gap), (3, 2 + gap), (3, 1 + gap), (px, 1 + gap), (1.5, 1.5 + gap)]
    m.generate(
        1, 2, 1.1, 2, "manual", gridpoints=points, zones=[(1, 6 - j, 6 - (j + 1) % 5) for j in range(5)]
    )
    m.cycle(0)
    blocks = m.table("block")
    below = int(blocks["address"][blocks["HEAD"] == g.MRIG][0])
    m.rset(0.01 * d / float(m.h.cr[g.TDEL]), below, g.KXD[1])
    for _ in range(40):
        m.cycle(1)
        assert m.table("contact")["KCFN"].max() == 0
        assert m.check() == []
    assert (m.table("contact")["KXC"] > px + 0.05).any()


@pytest.mark.parametrize("turn", [8e-4, 2e-4])
def test_a_corner_that_hardly_turns_is_touched_if_it_stands_out(turn: float) -> None:
    """Over edges of 400 D it stands out by 80 or 20 hundredths of D: what comes from below finds it first."""
    d, slope = 0.005, turn / 2
    m, gap = Model(), 0.1 * d
    m.property(1, density=2000, kn=1e6, ks=1e6)
    upper = [(2, 3), (2, 2 * slope + gap), (0, gap), (-2, 2 * slope + gap), (-2, 1), (-3.25, 1)]
    m.block(*np.ravel([(-3.5, -1), (-3.5, 3), *upper, (-3.25, 0), (3, 0), (3, -1)]))
    m.split(-2, -2, -2, 4)
    m.delete(-4, -2.5, -2, 4)
    m.round(d)
    m.fix(-2, 3, -1, 0)
    m.cycle(0)
    speed = 0.02 * d / float(m.h.cr[g.TDEL])
    m.boundary(-1, 1, 1, 2, xvel=0.0, yvel=-speed)
    for _ in range(16):
        m.cycle(1)
        assert m.check() == []
        corners, contacts = m.table("corner"), m.table("contact")
        (apex,) = corners[(abs(corners["KXP"]) < 1e-9) & (abs(corners["KYP"]) < d)]
        assert apex["KRAD"] == pytest.approx(d / np.tan(slope), rel=1e-6)
        assert contacts["KCN"].max() == pytest.approx(-apex["KYP"], abs=1e-3 * d)
    assert apex["KYP"] < 0


def test_a_strained_corner_does_not_come_and_go() -> None:
    """It has an arc from a turn of 0.001 on, and keeps it until it turns by 0.0009."""
    m = Model()
    m.block(0, 0, 0, 1, 1, 1.1, 2, 1, 2, 0)
    m.round(D)
    corners = m.table("corner")
    (top,) = corners[corners["KYP"] > 1.05]
    h, block = m.array.h, int(top["KNB"])
    found = []
    for turn in (
        1.1e-3,
        1.01e-3,
        0.95e-3,
        0.91e-3,
        0.89e-3,
        0.95e-3,
        0.99e-3,
        1.01e-3,
        0.95e-3,
        -0.95e-3,
        -0.8e-3,
    ):
        putr(h, int(top["address"]), g.KYP, 1 + turn / 2)
        crad(h, block, True)
        found.append(float(np.sign(getr(h, int(top["address"]), g.KRAD))))
    assert found == [1, 1, 1, 1, 0, 0, 0, 1, 1, -1, 0]
