"""What a command does beside what was asked is reported, and what would do nothing is refused."""

from __future__ import annotations

import math
import re

import pytest

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g


def pile() -> tuple[Model, list[str], list[str]]:
    """Three blocks on one another, the lowest fixed, with its warnings and its information."""
    m = Model()
    told: list[str] = []
    informed: list[str] = []
    m.tell, m.inform = told.append, informed.append
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e9, g=6e8)
    m.property(2, density=4000, kn=1e8, ks=1e8, friction=0.5)
    m.block(0, 0, 0, 3, 6, 3, 6, 0)
    m.split(-1, 1, 7, 1)
    m.split(-1, 2, 7, 2)
    m.fix(0, 6, 0, 1)
    return m, told, informed


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
@pytest.mark.parametrize("velocity", [{"xvel": 0.01}, {"yvel": -0.01}, {"xvel": 0.0, "yvel": 1.0}])
def test_a_fixed_block_moves_as_a_whole(kind: str, velocity: dict[str, float]) -> None:
    """FIX stops it, and a velocity of 0 leaves it as it is. Its grid-points alone get no velocity."""
    m, _, _ = pile()
    if kind == "fdef":
        m.generate(0, 6, 0, 1, "automatic", edge=2)
        with pytest.raises(UdecError) as caught:
            m.boundary(-1, 7, 0.9, 1.1, **velocity)
        largest = max(velocity, key=lambda name: abs(velocity[name]))
        assert (caught.value.number, caught.value.parameter) == (28, largest)
    else:
        m.change(0, 6, 0, 1, kind)
    assert m.boundary(-1, 7, -1, 1.1, yvel=0.0) > 0
    assert m.table("block")["KBFIX"].tolist().count(g.FIXED) == 1
    assert m.boundary(-1, 7, -1, 1.1, **velocity) == 1
    assert m.table("block")["KBFIX"].tolist().count(14) == 1
    assert m.check() == []
    m.fix(0, 6, 0, 1)
    assert m.table("block")["KBFIX"].tolist().count(g.FIXED) == 1
    assert m.check() == []


def test_a_material_after_the_first_cycle_is_reported() -> None:
    m, told, _ = pile()
    m.change(0, 6, 2, 3, material=2)
    assert told == []
    m.cycle(1)
    before = [*told]
    m.change(0, 6, 1, 2, material=2)
    (printed,) = [one for one in told if one not in before]
    assert "1 block of material 2" in printed
    assert "mass" in printed
    m.change(0, 6, 9, 10, material=2)
    m.change(0, 6, 1, 2, constitutive=1)
    assert [one for one in told if one not in before] == [printed]


def test_zones_report_inertia_and_angular_momentum() -> None:
    """A block as high as half its width in four zones about its middle: 3/2 + 1/2 of the exact inertia."""
    corners = [(0.0, 1.0), (0.0, 2.0), (6.0, 2.0), (6.0, 1.0)]
    points = [(3.0, 1.5), *corners]
    zones = [(5, 4, 3), (5, 3, 2), (5, 2, 1), (5, 1, 4)]
    m, told, informed = pile()
    m.cycle(1)
    printed = [*told]
    m.change(0, 6, 1, 2, "rigid")
    upper = m.table("block")
    (ib,) = upper["address"][abs(upper["KY"] - 1.5) < 0.1].tolist()
    m.patch(f"block@{ib}.KTD = 0.5")
    m.generate(0, 6, 1, 2, "manual", gridpoints=points, zones=zones)
    now = m.table("block")
    (spin,) = now["KTD"][now["address"] == ib].tolist()
    assert spin == 0.5
    assert any(f"block@{ib} 2.00 times" in one for one in informed)
    (text,) = [one for one in told if one not in printed and f"block@{ib} has its velocities" in one]
    now, before = (float(found) for found in re.findall(r"([\d.e+]+)(?: N\.s|$)", text)[-2:])
    assert math.isclose(now, 2 * before, rel_tol=1e-3)
    assert float(m.h.cr[g.ZINER]) == pytest.approx(2.0)
