"""BLOCK beside other blocks, FILL and TIDY: blocks that are put into a space, by shapely."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.random_cuts import cut_somehow, model_of, polygons, random_block

from udec_ia import Model, UdecError
from udec_ia.checker import check
from udec_ia.reader.group_tables import table

JOINTED = """START
PROPERTY MAT=1 DENSITY=2500 BULK=5E9 G=3E9 KN=1E10 KS=1E10 F=0.7
PROPERTY MAT=2 DENSITY=2200 BULK=1E9 G=6E8 KN=1E10 KS=1E10 F=0.7
BLOCK 0 0 0 40 60 40 60 0
"""


def contact_rows(m: Model, ib: int):  # type: ignore[no-untyped-def]
    """The contacts of a block."""
    rows = table(m.array, "contact")
    return rows[(rows["KB1"] == ib) | (rows["KB2"] == ib)]


@pytest.mark.parametrize("seed", range(4))
def test_random_blocks_fall_into_a_box_without_a_missed_contact(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m = Model()
    m.property(material=1, density=2000, kn=2e10, ks=2e10, friction=0.4)
    m.gravity(0, -10)
    m.block(0, 0, 0, 1, 8, 1, 8, 0)
    m.fix(0, 8, 0, 1)
    m.block(-1, 0, -1, 12, 0, 12, 0, 0)
    m.block(8, 0, 8, 12, 9, 12, 9, 0)
    m.fix(-1, 0, 0, 12)
    m.fix(8, 9, 0, 12)
    made = 3
    for row in range(4):
        for column in range(3):
            angles = np.sort(rng.uniform(0, 2 * np.pi, 5))[::-1]
            if np.diff(angles).max() > -0.6 or angles[-1] - angles[0] + 2 * np.pi < 0.6:
                continue
            x, y = 1.4 + 2.6 * column, 2.3 + 2.5 * row
            m.block(*np.c_[x + np.cos(angles), y + np.sin(angles)].ravel().tolist())
            made += 1
    m.round(0.02)
    m.damping(local=0.3)
    assert len(polygons(m)) == made
    for _ in range(8):
        m.cycle(1500)
        assert list(check(m.array)) == []
    assert max(one.bounds[3] for one in polygons(m)[: made - 3]) < 9


def test_blocks_that_touch_get_contacts_and_those_that_overlap_are_refused() -> None:
    m = Model()
    m.property(material=1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 1, 4, 1, 4, 0)
    upper = m.block(1, 1, 1, 2, 3, 2, 3, 1)
    rows = contact_rows(m, upper)
    assert sorted(rows["KXC"].round(1)) == [1.1, 2.9] or len(rows) == 2
    assert set(rows["KYC"].round(6)) == {1.0}
    for corners in ((2, 1.5, 2, 3, 5, 3, 5, 1.5), (0.2, 0.2, 0.2, 0.4, 0.4, 0.4, 0.4, 0.2)):
        with pytest.raises(UdecError) as error:
            m.block(*corners)
        assert error.value.number == 18
    around = m.block(-1, -1, -1, -0.5, 5, -0.5, 5, -1)
    assert [int(code) for code in contact_rows(m, around)["KCCOD"]] == [4]
    assert list(check(m.array)) == []


def test_a_block_fits_into_a_notch_and_into_a_hole() -> None:
    m = Model()
    m.property(material=1, density=2000, bulk=1e9, g=6e8, kn=1e9, ks=1e9)
    m.run(JOINTED)
    m.tunnel(30, 18, 5, 12)
    m.split(-1, 35, 61, 35)
    m.delete("CIRCLE 30 18 5")
    m.block(28, 16, 28, 20, 32, 20, 32, 16)
    inside = contact_rows(m, int(m.array.h.ci[6]))
    assert len(inside) == 1
    assert list(check(m.array)) == []


@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_fill_is_free_of_stress_and_bears_what_comes_later(kind: str) -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(JOINTED)
    m.tunnel(30, 18, 5, 12)
    m.round(0.05)
    if kind != "rigid":
        m.change("ALL", type=kind)
    if kind == "fdef":
        m.generate("ALL", edge=5.0)
    m.boundary("OUTSIDE", stress=(-1e6, 0, -1e6)) if kind == "fdef" else m.fix("NOT CIRCLE 30 18 5.5")
    m.insitu("ALL", s11=-1e6, s22=-1e6)
    m.damping(local=0.8)
    m.cycle(200)
    m.delete("CIRCLE 30 18 5")
    m.cycle(200)
    rock = shapely.union_all(polygons(m))
    space = shapely.box(*rock.bounds).difference(rock)
    ib = m.fill(30, 18, material=2)
    assert list(check(m.array)) == []
    new = next(
        one for one, at in zip(polygons(m), table(m.array, "block")["address"], strict=True) if at == ib
    )
    assert new.area == pytest.approx(space.area, rel=1e-3)
    assert new.symmetric_difference(max(shapely.get_parts(space), key=shapely.area)).area < 1e-3 * space.area
    assert len(contact_rows(m, ib)) >= 24
    assert not contact_rows(m, ib)["KCFN"].any()
    m.gravity(0, -10)
    m.cycle(400)
    assert contact_rows(m, ib)["KCFN"].max() > 1e4
    assert list(check(m.array)) == []


def test_fill_refuses_what_is_no_space() -> None:
    m = Model()
    with pytest.raises(UdecError) as error:
        m.fill(1, 1)
    assert error.value.number == 24
    m.run(JOINTED)
    m.tunnel(30, 18, 5, 12)
    m.delete("CIRCLE 30 18 5")
    for place, number in (((70, 1), 24), ((1, 1), 18)):
        before = m.array.h.ia.copy()
        with pytest.raises(UdecError) as error:
            m.fill(*place)
        assert error.value.number == number
        assert (m.array.h.ia == before).all()
    m.block(29, 17, 29, 18, 30, 18, 30, 17)
    with pytest.raises(UdecError) as error:
        m.fill(31, 20)
    assert error.value.number == 28


@pytest.mark.parametrize("seed", range(8))
def test_tidy_merges_all_slivers_and_keeps_the_rock(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rock = random_block(rng)
    m = model_of(rock)
    m.tell = m.inform = lambda _: None
    m.jproperty(1, kn=1e9, ks=1e9)
    for _ in range(5):
        try:
            cut_somehow(m, rng, rock)
        except UdecError:
            continue
    before = polygons(m)
    limit = float(np.quantile([one.area for one in before], 0.4)) + 1e-9
    done = m.tidy(limit)
    after = polygons(m)
    assert len(after) == len(before) - len(done.merged)
    assert shapely.area(after).sum() == pytest.approx(rock.area, rel=1e-9)
    assert shapely.union_all(after).symmetric_difference(rock).area < 1e-6 * rock.area
    assert sum(one.area < limit for one in after) <= len(done.left)
    assert list(check(m.array)) == []
    edges = shapely.union_all([one.exterior.buffer(1e-6) for one in before])
    assert all(one.exterior.within(edges) for one in after)
    m.cycle(20)
    assert list(check(m.array)) == []


def test_tidy_keeps_joints_materials_and_types() -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(material=1, density=2000, kn=1e8, ks=1e8)
    m.property(material=3, density=2000, bulk=1e9, g=6e8, kn=1e8, ks=1e8)
    m.jproperty(2, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 4, 10, 4, 10, 0)
    m.split(-1, 2, 11, 2, joint=7, jmaterial=2)
    m.split(9.9, -1, 9.9, 5, joint=8)
    m.change(0, 9.9, 0, 2, material=3)
    m.fix(0, 9.9, 0, 2)
    m.change(0, 9.9, 0, 2, type="sdef")
    m.group("base", 0, 9.9, 0, 2)
    done = m.tidy(0.3)
    assert m.group("again", "GROUP base") == 1
    assert [round(one.area, 3) for one in done.merged] == [0.2, 0.2]
    rows = table(m.array, "block")
    assert sorted(rows["KMAT"]) == [1, 3]
    lower = rows[rows["KMAT"] == 3][0]
    assert (lower["HEAD"], lower["KBFIX"]) == (2, 1)
    assert set(table(m.array, "joint")["KCJMAT"]) == {2}
    assert sorted({*table(m.array, "edge")["KEJ"]}) == [0, 7]
    m.cycle(1)
    with pytest.raises(UdecError) as error:
        m.tidy(1.0)
    assert error.value.number == 26


def test_tidy_keeps_contacts_of_neighbours_that_touch_along_a_bent_line() -> None:
    """The host of a sliver is the only neighbour of another block, and surrounds it on two sides."""
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(
        "START\nPROPERTY MAT=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0.5\nBLOCK 0,0 0,10 10,10 10,0\n"
        "POLYLINE 0,2 1,2 2,0\nTUNNEL 6 6 1 8\nTIDY 3\n"
    )
    assert [*check(m.array)] == []
    m.run("ROUND 0.02\nFIX NOT AREA < 10\nGRAVITY 0 10\nDAMPING 0.5 5 MASS\nCYCLE 3000\n")
    assert table(m.array, "contact")["KCFN"].max() > 1e3
    assert [*check(m.array)] == []


def test_tidy_leaves_no_edge_that_is_a_rounding_error() -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.run(
        "START\nPROPERTY MAT=1 DENSITY=2000 KN=1E8 KS=1E8 FRICTION=0.5\nBLOCK 0,0 0,10 10,10 10,0\n"
        "SPLIT -1,3 3,-1\nPOLYLINE 0,-1 0,1\nSPLIT 1,-1 -2,11\nPOLYLINE 0,8 0,0 1,11\n"
    )
    before = m.geometry().edges[0].value
    m.tidy(3)
    assert m.geometry().edges[0].value > min(before, 0.05)
    assert sum(one.area for one in polygons(m)) == pytest.approx(100)
    m.round(0.01)
    m.cycle(2)
    assert [*check(m.array)] == []


def test_small_blocks_are_not_merged_across_a_glued_outline() -> None:
    m = Model()
    m.tell = m.inform = lambda _: None
    m.property(1, density=2600, kn=1e9, ks=1e9)
    m.block(0, 0, 0, 20, 20, 20, 20, 0)
    m.polyline(8, 8, 8, 12, 12, 12, 12, 8, 8, 8, glued=True)
    m.split(0, 9.8, 20, 5.8)
    m.split(0, 5.8, 20, 9.8)
    m.tidy(0.3)
    m.delete(8, 12, 8, 12)
    hole = shapely.box(0, 0, 20, 20).difference(shapely.union_all(polygons(m)))
    assert hole.area == pytest.approx(16.0)
