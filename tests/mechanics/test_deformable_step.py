"""The time-step against dense matrices: the safe bound is one, and at 0.99 of it nothing grows."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from naive.bodies import points_of
from naive.stiffness import Scene
from support.mechanics_scenes import box, model, sound

from udec_ia import Model
from udec_ia.advice.time_step_warnings import step_warning
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g
from udec_ia.running.critical_step import bound, estimate
from udec_ia.running.stiffness_bound import StepLimit
from udec_ia.studies.verification_tools import fan

D = 0.05
JOINTS = (3e8, 1e8)


def random_scene(seed: int, *, viscous: bool = True) -> tuple[Model, tuple[float, float]]:
    """A block cut by random lines; parts of all types, some held, some with viscous edges; and its moduli."""
    rng = np.random.default_rng(seed)
    w, h = rng.uniform(1.5, 4, 2)
    m = model(*box(0, w, 0, h), d=D, stiffness=JOINTS, gravity=(0.0, 0.0), density=rng.uniform(500, 5000))
    bulk = float(rng.choice([1e7, 1e8, 1e9]))
    shear = float(bulk * rng.uniform(0.2, 1.4))
    m.property(1, bulk=bulk, g=shear, cohesion=1e12)
    for _ in range(int(rng.integers(2, 5))):
        (ax, ay), (bx, by) = rng.uniform(0, 1, (2, 2)) * (w, h)
        with suppress(UdecError):  # too close to a corner
            m.split(ax - 20 * (bx - ax), ay - 20 * (by - ay), bx + 20 * (bx - ax), by + 20 * (by - ay))
    for row in m.table("block"):
        x, y, kind = float(row["KX"]), float(row["KY"]), rng.integers(4)
        near = x - 1e-9, x + 1e-9, y - 1e-9, y + 1e-9
        if kind == 1:
            m.change(*near, type="sdef")
        elif kind > 1:
            with suppress(UdecError):  # a sliver has no zones, no room for points on its edges
                fan(m, x, y, edge_points=kind - 2)
        if rng.random() < 0.15:
            m.fix(*near)
    hold_some(m, rng, w, h)
    if viscous and rng.random() < 0.5:
        m.boundary(-0.1, 0.6 * w, -0.1, 1.1 * h, viscous=True)
    m.cycle(0)
    return m, (bulk, shear)


def hold_some(m: Model, rng: Any, w: float, h: float) -> None:
    """Velocities given in a corner of the scene, if anything is there."""
    given = {"xvel": 0.0} if rng.random() < 0.5 else {"yvel": 0.0}
    if rng.random() < 0.5:
        with suppress(UdecError):
            m.boundary(-0.1, rng.uniform(0, w), -0.1, rng.uniform(0, h), **given)


def test_the_bound_is_one() -> None:
    """It is at most the critical step of the assembled matrices, and mostly not much less."""
    shares = []
    for seed in range(40):
        m, moduli = random_scene(seed)
        found = bound(m.array)
        shares.append(found.step / Scene(m, moduli, JOINTS).critical())
        assert shares[-1] <= 1 + 1e-9, seed
        addresses = {int(row["address"]) for kind in ("block", "gridpoint") for row in m.table(kind)}
        assert found.address in addresses
        assert estimate(m.array).step > 0
    assert np.median(shares) > 0.5


def excited(m: Model, rng: Any) -> None:
    """Random velocities for all that is free, by which nothing overlaps by more than a thousandth of D."""
    speed = 1e-3 * D / float(m.h.cr[g.TDEL]) / 100
    for row in m.table("block"):
        points = points_of(m).get(int(row["address"]), [])
        for p in points if row["KBFIX"] != 1 else []:
            for bit, k in ((1, g.KXDG), (2, g.KYDG)):
                if not p["KGFIX"] & bit:
                    putr(m.h, int(p["address"]), k, speed * rng.normal())
        if row["KBFIX"] == 0 and not points:
            for k in (g.KXD, g.KYD, g.KTD):
                putr(m.h, int(row["address"]), k, speed * rng.normal())
            if row["HEAD"] == g.MSDEF:
                for k in (g.KED11, g.KED22):
                    putr(m.h, int(row["KBEX"]), k, speed * rng.normal())


def kinetic(m: Model) -> float:
    """Kinetic energy, without that of strains."""
    total = 0.0
    for row in m.table("block"):
        if row["HEAD"] != g.MFDEF:
            total += (
                float(row["KBM"] * (row["KXD"] ** 2 + row["KYD"] ** 2) + row["KBI"] * row["KTD"] ** 2) / 2
            )
    for p in m.table("gridpoint"):
        total += float(p["KGPM"] * (p["KXDG"] ** 2 + p["KYDG"] ** 2)) / 2
    return total


@pytest.mark.parametrize("seed", range(40, 48))
def test_at_the_bound_nothing_grows(seed: int) -> None:
    """An unstable mode grows exponentially; here no energy of thousands of cycles exceeds the first ones."""
    m, _ = random_scene(seed)
    m.fraction(0.99, safe=True)
    m.cycle(0)
    excited(m, np.random.default_rng(seed))
    energies = []
    for _ in range(60):
        m.cycle(50)
        energies.append(kinetic(m))
    assert energies[0] > 0
    assert max(energies[10:]) <= 4 * max(energies[:10])
    sound(m)


@pytest.mark.parametrize("kind", ["sdef", "zoned"])
@pytest.mark.parametrize("share", [0.99, 1.01])
def test_the_critical_step_is_the_border(kind: str, share: float) -> None:
    """A lone block vibrates for ever below the step that the matrices give, and blows up above it."""
    m = model(*box(0, 2, 0, 1), d=D, gravity=(0.0, 0.0), density=2000.0)
    m.property(1, bulk=1e8, g=5e7)
    if kind == "sdef":
        m.change(0, 2, 0, 1, type="sdef")
    else:
        fan(m, 1, 0.5, edge_points=3)
    m.cycle(0)
    m.fraction(share * Scene(m, (1e8, 5e7), JOINTS).critical() / estimate(m.array).step)
    m.cycle(0)
    excited(m, np.random.default_rng(3))
    m.cycle(1)
    start = moving(m)
    ended = 0
    try:
        m.cycle(200)
    except UdecError as error:
        ended = error.number
    assert ended in (
        (0,) if share < 1 else (0, 14, 32, 37)
    )  # it is strained until its edges or it have gone, if that is not seen before
    assert (not ended and moving(m) <= 1000 * start) == (share < 1)


def moving(m: Model) -> float:
    """The greatest speed of a corner."""
    ring = m.table("corner")
    return float(np.hypot(ring["KXDP"], ring["KYDP"]).max())


def test_after_a_zone_has_turned_inside_out_the_limits_are_numbers() -> None:
    """Grid-points thrown through their blocks: the error says where, and no warning of NumPy's follows."""
    m = model(*box(0, 2, -1, 1), d=D, stiffness=JOINTS)
    m.property(1, bulk=1e8, g=5e7)
    m.split(-1, 0, 3, 0)
    m.fix(0, 2, -1, 0)
    fan(m, 1, 0.5)
    m.boundary(-0.1, 2.1, 0.9, 1.1, viscous=True)
    m.cycle(1)
    row = m.table("gridpoint")[0]
    putr(m.h, int(row["address"]), g.KXDG, 1e6 if row["KXG"] < 1 else -1e6)
    with pytest.raises(UdecError) as caught:
        m.cycle(3)
    zones, points = m.table("zone"), m.table("gridpoint")
    (zone,) = zones[zones["address"] == caught.value.group]
    corners = points[np.isin(points["address"], zone["KZG"])]
    x, y = corners["KXG"].mean(), corners["KYG"].mean()
    (block,) = m.table("block")["address"][m.table("block")["KBEX"] > 0]
    assert f"zone@{caught.value.group} of block@{block} at ({x:g}, {y:g}) in cycle" in str(caught.value)
    assert "smaller loads" in str(caught.value)
    shares = re.findall(r"(\S+) of the (?:estimate|safe bound) (\S+) s ", m.step_limits())
    assert len(shares) == 2
    assert all(float(number) > 0 for share in shares for number in share)


def test_moments_of_inertia_that_are_no_numbers_set_a_step_of_nothing() -> None:
    m = model(*box(0, 2, -1, 1), d=D, stiffness=JOINTS)
    m.property(1, bulk=1e8, g=5e7)
    m.split(-1, 0, 3, 0)
    m.change(0, 2, -1, 1, "sdef")
    m.cycle(0)
    putr(m.array.h, int(m.table("sdef")["address"][1]), g.KSJ12, np.nan)
    limit = bound(m.array)
    assert limit == StepLimit(0.0, int(m.table("block")["address"][1]))
    warning = step_warning(m.array, limit)
    assert warning is not None
    assert warning.key == "no-safe-step"


def test_what_is_squashed_flat_sets_a_step_of_nothing() -> None:
    m = model(*box(0, 2, -1, 1), d=D, stiffness=JOINTS)
    m.property(1, bulk=1e8, g=5e7)
    m.split(-1, 0, 3, 0)
    m.fix(0, 2, -1, 0)
    fan(m, 1, 0.5)
    m.fraction(0.1, safe=True)
    m.cycle(1)
    point = int(m.table("gridpoint")["address"][0])
    putr(m.array.h, point, g.KGPM, 0.0)
    assert bound(m.array) == StepLimit(0.0, point)
    assert "inf of the safe bound 0 s" in m.step_limits()
    m.fraction(0.1, safe=True)  # the next step is found anew
    with pytest.raises(UdecError, match="error 28"):
        m.cycle(1)
