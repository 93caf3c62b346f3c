"""GROUP: blocks that keep the name of a range in which they were."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model, UdecError
from udec_ia.checker import check
from udec_ia.heap.word_scheme import ALL_SCHEMES


def quarters(build: str = "i32r64") -> Model:
    """Four square blocks of 1 m."""
    m = Model(build)
    m.tell = m.inform = lambda _: None
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.split(-1, 1, 3, 1)
    m.split(1, -1, 1, 3)
    return m


def middles(m: Model, where: str) -> list[tuple[float, float]]:
    """Centroids of the blocks in a range."""
    before = m.table("block")["KMAT"].copy()
    m.change(where, material=9)
    rows = m.table("block")
    found = [(round(float(r["KX"]), 3), round(float(r["KY"]), 3)) for r in rows[rows["KMAT"] == 9]]
    for row, mat in zip(rows, before, strict=True):
        m.change(row["KX"] - 1e-6, row["KX"] + 1e-6, row["KY"] - 1e-6, row["KY"] + 1e-6, material=int(mat))
    return sorted(found)


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_a_group_is_what_was_in_the_range(build: str) -> None:
    m = quarters(build)
    assert m.group("Upper", "ABOVE 0 1 2 1") == 2
    assert m.group("left 0 1 0 2") == 2
    assert m.group("abcdefghijkl", "ALL") == 4
    assert middles(m, "GROUP upper") == [(0.5, 1.5), (1.5, 1.5)]
    assert middles(m, "GROUP LEFT NOT GROUP UPPER") == [(0.5, 0.5)]
    assert m.group("upper", "GROUP left") == 2
    assert middles(m, "GROUP UPPER") == [(0.5, 0.5), (0.5, 1.5)]
    assert m.group("upper", "CIRCLE 9 9 1") == 0
    assert middles(m, "GROUP UPPER") == [(0.5, 0.5), (0.5, 1.5)]
    assert [*check(m.array)] == []


def test_a_group_moves_and_is_cut_and_deleted_with_its_blocks(tmp_path: Path) -> None:
    m = quarters()
    m.group("a", 1, 2, 1, 2)
    m.group("b", "ALL")
    m.split(-1, 1.5, 3, 1.5)
    assert middles(m, "GROUP A") == [(1.5, 1.25), (1.5, 1.75)]
    m.polyline(1.5, 0.9, 1.5, 1.6)
    assert len(middles(m, "GROUP A")) == 3
    m.voronoi(0.5, within=(1.1, 1.9, 0.2, 0.8))
    assert len(middles(m, "GROUP B")) == len(m.table("block"))
    assert [*check(m.array)] == []
    m.fix(0, 1, 0, 2)
    m.gravity(3, 0)
    m.cycle(200)
    many = len(middles(m, "GROUP B"))
    m.save(tmp_path / "x.h5")
    again = Model.restore(tmp_path / "x.h5")
    assert middles(again, "GROUP A") == middles(m, "GROUP A")
    assert m.delete("GROUP A") == 3
    assert len(middles(m, "GROUP B")) == many - 3
    with pytest.raises(UdecError) as error:
        m.delete("GROUP A")
    assert error.value.number == 10
    assert [*check(m.array)] == []


def test_a_deck_with_groups(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.run(
        "START\nPROP MAT=1 DENS=2000 KN=1E8 KS=1E8\nBLOCK 0,0 0,2 2,2 2,0\nSPLIT -1 1 3 1\n"
        "GROUP lower BELOW 0 1 2 1\nFIX RANGE GROUP lower\nFUNCTION 1 0 1\nSPLIT 1 -1 1 3\n"
        "CHANGE MATERIAL=2 RANGE GROUP lower NOT 0 1 0 1\n"
    )
    rows = m.table("block")
    assert rows[rows["KMAT"] == 2]["KX"].tolist() == [1.5]
    assert np.count_nonzero(rows["KBFIX"]) == 2
    assert "GROUP lower BELOW 0 1 2 1" in m.deck()


def test_names_of_groups() -> None:
    m = quarters()
    for name in ("1a", "a/b", "", "abcdefghijklm", "all", "Circle", "ä"):
        with pytest.raises((UdecError, ValueError)):
            m.group(name or " ", "ALL")
    with pytest.raises(UdecError) as error:
        m.change("GROUP", material=2)
    assert error.value.number == 10
    with pytest.raises(UdecError) as error:
        m.group("a")
    assert error.value.number == 10
    assert len(m.table("member")) == 0


def test_joint_sets_cells_and_reactions_in_ranges(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.tell = m.inform = lambda _: None
    m.run(
        "START\nPROP MAT=1 DENS=2500 KN=1E9 KS=1E9\nBLOCK 0 0 0 20 30 20 30 0\nSPLIT -1 10 31 10\n"
        "GROUP lower BELOW 0 10 30 10\nJSET ANGLE 60 SPACING 3 RANGE GROUP lower\n"
    )
    rows = m.table("block")
    assert np.count_nonzero(rows["KY"] > 10) == 1
    assert np.count_nonzero(rows["KY"] < 10) > 8
    m.run("VORONOI EDGE=1.5 SEED=2 RANGE CIRCLE 15 15 3\nJSET ANGLE 20 SPACING 2 RANGE ABOVE 0 18 30 18\n")
    far = np.hypot(m.table("block")["KX"] - 15, m.table("block")["KY"] - 15)
    assert np.count_nonzero(far < 3) > 5
    assert len(m.table("block")[(m.table("block")["KY"] > 10) & (far > 3.1)]) < 14
    m.run(
        "FIX RANGE GROUP lower\nHISTORY 5 YREACTION RANGE GROUP lower\nHISTORY 5 YREACTION RANGE 0 30 0 10\n"
    )
    m.run("GRAVITY 0 -10\nCYCLE 20\n")
    one, two = m.histories()
    assert (one.numbers == two.numbers).all()
    assert (one.place, two.place) == ("GROUP lower", "x 0 to 30, y 0 to 10")
    assert m.reactions("GROUP lower")["fy"].sum() == pytest.approx(m.reactions()["fy"].sum())
    for words, number in (("OUTSIDE", 10), ("CIRCLE 90 90 1", 28), ("RANGE 1 0 0 1", 28), ("GROUP no", 10)):
        with pytest.raises(UdecError) as error:
            m.jset(30.0, spacing=1.0, within=words)
        assert error.value.number == number
    assert [*check(m.array)] == []


def test_a_group_of_nothing_says_so(tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.tell = m.inform = lambda _: None
    m.run("START\nBLOCK 0 0 0 1 1 1 1 0\nGROUP stone MATERIAL 9\n")
    assert len(m.table("member")) == 0
    assert m.why_none("group")


def test_a_name_may_have_the_letters_of_where() -> None:
    m = Model()
    m.inform = lambda _: None
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.split(1, -1, 1, 2)
    m.group("nowhere", "CIRCLE 0.5 0.5 0.1")
    m.group("left", "GROUP nowhere NOT WHERE KX > 1")
    assert m.fix("GROUP left") == 1
