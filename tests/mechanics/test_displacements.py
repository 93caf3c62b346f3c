"""Displacements that the state has are differences of places, whatever has been cut, zoned or restored."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.text import Text
from support.random_cuts import polygons

from udec_ia import Model
from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import snapshot


def scene(build: str = "i32r64", out: Path = Path()) -> Model:
    """A rigid, a simply-deformable and a zoned block that slide, turn and press on one another."""
    m = Model(build, out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.2, bulk=1e8, g=6e7)
    m.block(0, -1, 0, 0, 10, 0, 10, -1)
    for x in (1, 3.5, 6):
        m.block(x, 0, x, 2, x + 2, 2, x + 2, 0)
    m.round(0.05)
    m.fix(0, 10, -1, 0)
    m.change(3.5, 5.5, 0, 2, type="sdef")
    m.generate(6, 8, 0, 2, edge=0.7)
    m.gravity(3, -10)
    m.damping(1.0, 5.0, "mass")
    m.velocity(0, 10, 0, 2, 3.0, 2.0, 2.0)
    return m


def places(m: Model) -> dict[int, Any]:
    """Centroid of each block, and place of each grid-point, by address."""
    found = {row["address"]: (row["KX"], row["KY"]) for row in m.table("block")}
    return found | {row["address"]: (row["KXG"], row["KYG"]) for row in m.table("gridpoint")}


def displacements(m: Model) -> dict[int, Any]:
    """The displacements of the state, by address of block and grid-point."""
    found = {}
    for kind, behind, names in (
        ("block", "displacement", ("KBDX", "KBDY")),
        ("gridpoint", "pointdisplacement", ("KGDX", "KGDY")),
    ):
        for row, moved in zip(m.table(kind), m.table(behind), strict=True):
            found[row["address"]] = tuple(moved[name] for name in names)
    return found


@pytest.mark.parametrize("build", ["i32r64", "i16r32"])
def test_displacements_are_differences_of_places(build: str) -> None:
    m = scene(build)
    m.cycle(1)
    m.displacements()
    first = places(m)
    m.cycle(400)
    assert m.check() == []
    last, moved = places(m), displacements(m)
    digits = 400 * float(np.finfo(m.h.cr.dtype).eps) * 10  # of places, summed up over all cycles
    for address, place in last.items():
        assert np.subtract(place, first[address]) == pytest.approx(moved[address], abs=digits)
    assert max(np.hypot(*u) for u in moved.values()) > 0.05
    m.reset("displacements")
    assert not any(np.any(u) for u in displacements(m).values())


def test_blocks_are_cut_before_and_after() -> None:
    """SPLIT reads where blocks are once for several commands; DISPLACEMENTS gives them new addresses."""
    m = Model()
    m.block(0, 0, 0, 3, 4, 3, 4, 0)
    m.split(-1, 1, 5, 1)
    m.displacements()
    assert m.split(2, 0.5, 2, 4) == 1
    assert m.check() == []
    assert sorted(round(one.area, 9) for one in polygons(m)) == [4.0, 4.0, 4.0]


def test_rotation_is_that_of_the_outline() -> None:
    m = scene()
    m.cycle(1)
    m.displacements()

    def angles() -> Any:
        rows = m.table("corner")
        at = {row["address"]: row for row in rows}
        edges = [(at[row["KR"]], row) for row in rows]
        return np.array([np.arctan2(b["KYP"] - a["KYP"], b["KXP"] - a["KXP"]) for a, b in edges])

    first = angles()
    m.cycle(300)
    turned = np.angle(np.exp(1j * (angles() - first)))
    hosts = m.table("corner")["KNB"]
    for block, kind, moved in zip(
        m.table("block")["address"], m.table("block")["HEAD"], m.table("displacement"), strict=True
    ):
        if kind == 1:
            assert turned[hosts == block] == pytest.approx(moved["KBDT"], abs=1e-9)


def test_parts_of_a_cut_block_were_where_the_block_was() -> None:
    m = scene()
    m.cycle(1)
    m.displacements()
    start = {row["address"]: (row["KX"], row["KY"]) for row in m.table("block")}
    m.cycle(300)
    heap = m.table("block")
    turned = {row["address"]: moved["KBDT"] for row, moved in zip(heap, m.table("displacement"), strict=True)}
    whole = {row["address"]: (row["KX"], row["KY"]) for row in heap}
    m.split(0, 1.0, 10, 1.2)
    m.generate(1, 3, 0, 2, edge=0.7)
    assert m.check() == []
    rows, moved = m.table("block"), displacements(m)
    for row in rows:
        ib = min(whole, key=lambda one: np.hypot(row["KX"] - whole[one][0], row["KY"] - whole[one][1]))
        c, s = np.cos(turned[ib]), np.sin(turned[ib])
        arm = np.array([row["KX"], row["KY"]]) - whole[ib]
        before = np.array(start[ib]) + np.array([c * arm[0] + s * arm[1], c * arm[1] - s * arm[0]])
        expected = np.array([row["KX"], row["KY"]]) - before
        assert moved[row["address"]] == pytest.approx(expected, abs=2e-3)
    points = np.array([moved[row["address"]] for row in m.table("gridpoint")])
    assert np.hypot(*points.T).min() > 1e-3


def mean_of_points(m: Model, ib: int) -> Any:
    """Mean displacement of the grid-points of zoned block `ib`, by mass."""
    fdef = {row["address"]: row["KFG"] for row in m.table("fdef")}
    points = {row["address"]: row for row in m.table("gridpoint")}
    moved = displacements(m)
    ig = fdef[m.table("block")["KBEX"][m.table("block")["address"] == ib][0]]
    total, mass = np.zeros(2), 0.0
    while ig:
        total += points[ig]["KGPM"] * np.array(moved[ig])
        mass += points[ig]["KGPM"]
        ig = points[ig]["KG"]
    return total / mass


def test_a_zoned_block_has_the_mean_of_its_points_also_after_cuts() -> None:
    """SPLIT divides the parts anew; a crack follows zone sides."""
    m = scene()
    m.cycle(1)
    m.displacements()
    m.cycle(300)
    m.split(5, 1.0, 10, 1.2)
    zoned = 2
    for k in range(2):
        rows = m.table("block")
        found = rows["address"][rows["HEAD"] == g.MFDEF].tolist()
        assert len(found) == zoned if k == 0 else len(found) > zoned
        for ib in found:
            assert displacements(m)[ib] == pytest.approx(mean_of_points(m, ib), rel=1e-9)
        m.breakage("ALL", tension=1.0, cohesion=1.0, smallest=0.05)
        m.cycle(20)
    assert m.check() == []


def test_they_are_saved_recorded_and_cost_nothing_without(tmp_path: Path) -> None:
    one, two = scene(out=tmp_path), scene(out=tmp_path)
    two.displacements()
    for m in (one, two):
        m.cycle(100)
    assert np.array_equal(one.table("block")["KX"], two.table("block")["KX"])
    assert len(one.table("displacement")) == 0
    (series,) = two.history(10, "KBDX", at=(7, 1))
    two.cycle(100)
    assert series.numbers[-1, 2] == displacements(two)[place_of(two, 7, 1)][0]
    file = two.save(tmp_path / "a.h5")
    again = Model.restore(file, out=tmp_path)
    for m in (two, again):
        m.cycle(50)
    assert np.array_equal(two.table("pointdisplacement"), again.table("pointdisplacement"))


def place_of(m: Model, x: float, y: float) -> int:
    """Address of the block with the centroid nearest to a point."""
    rows = m.table("block")
    return int(rows["address"][np.hypot(rows["KX"] - x, rows["KY"] - y).argmin()])


def test_pictures_show_what_the_state_has(tmp_path: Path) -> None:
    m = scene(out=tmp_path)
    m.cycle(1)
    m.displacements()
    m.cycle(100)
    m.split(0, 1.0, 10, 1.2)
    again = Model.restore(m.save(tmp_path / "a.h5"), out=tmp_path)
    moved = displacements(again)
    state = snapshot(again.h, inside=True).field
    assert state is not None
    assert [tuple(u) for u in state.moved] == [moved[address] for address in state.address.tolist()]
    axes = again.figure(color="movement", arrows="displacement")
    largest = max(np.hypot(*u) for u in moved.values())
    assert any(f"{1e3 * largest:.4g}" in text.get_text() for text in axes.figure.findobj(Text))
