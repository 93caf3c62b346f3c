"""ROUND between cycles: a rounding length that the overlaps or the memory cannot bear changes nothing."""

from __future__ import annotations

from math import sqrt
from pathlib import Path

import pytest
from support.mechanics_scenes import on_base, sound

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import putr
from udec_ia.layout.offsets import KXD, KYD, MFREE, TDEL

LONG = 0.1  # rounding length; the blocks are 1 by 1


def pressed() -> tuple[Model, float]:
    """A block that has settled on its base by its weight, and its greatest overlap, W/(2 KN)."""
    m = on_base(1.0, 1.0, LONG, 4.0, stiffness=(1e6, 1e6))
    m.damping(1.0, 20.0, "mass")
    m.cycle(2000)
    return m, float(m.table("contact")["KCN"].max())


def words(m: Model) -> tuple[bytes, bytes, bytes]:
    """All words in use and the common block."""
    h = m.h
    return h.ia[: int(h.ci[MFREE]) - 1].tobytes(), h.ci.tobytes(), h.cr.tobytes(), h.cd.tobytes()


def test_a_rounding_length_of_less_than_twice_an_overlap_is_refused() -> None:
    m, overlap = pressed()
    assert overlap == pytest.approx(1000 * 10 / 2 / 1e6, rel=1e-3)
    before = words(m)
    with pytest.raises(UdecError) as caught:
        m.round(1.9 * overlap)
    error = caught.value
    assert error.number == 14
    deepest = m.table("contact")[0]
    assert f"block@{deepest['KB1']} and block@{deepest['KB2']} overlap by {overlap:g} at (" in error.message
    assert error.advice
    assert words(m) == before
    sound(m)
    m.round(2.1 * overlap)
    sound(m)


def tip_in_the_void(depth: float) -> Model:
    """Two blocks, corner to corner; one has moved by `depth` in x and y into the void at the other's."""
    m = Model()
    m.round(2 * LONG)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.property(1, density=1000, kn=1e6, ks=1e6)
    m.split(1, -1, 1, 3)
    m.split(-1, 1, 3, 1)
    m.delete(0, 1, 0, 1)
    m.delete(1, 2, 1, 2)
    m.fix(1, 2, 0, 1)
    m.cycle(0)
    upper = next(row for row in m.table("block") if row["KY"] > 1)
    speed = depth / 50 / float(m.h.cr[TDEL])
    putr(m.h, int(upper["address"]), KXD, speed)
    putr(m.h, int(upper["address"]), KYD, -speed)
    m.cycle(50)
    return m


def test_a_corner_that_comes_out_deep_in_another_block_is_refused() -> None:
    """The circles about points D inwards of both corners, in x and y, are sqrt(2) (2 D - depth) apart.

    With a great D there is no contact; with a small one the blocks lie deep in each other.
    """
    depth = 0.03
    m = tip_in_the_void(depth)
    assert m.table("contact")["KCFN"].tolist() == [0.0]
    before = words(m)
    one, two = m.table("block")["address"]
    for d in (0.02, 0.01, 0.005):
        with pytest.raises(
            UdecError, match=f"block@({one}|{two}) and block@({one}|{two}) overlap by "
        ) as caught:
            m.round(d)
        assert caught.value.number == 14
        assert words(m) == before
    sound(m)
    m.round(LONG)
    gap = sqrt(2) * (2 * LONG - depth) - 2 * LONG
    assert m.table("contact")["KCN"].tolist() == pytest.approx([-gap], rel=1e-9)
    sound(m)


def test_a_lone_block_is_rounded_anew_after_it_has_moved() -> None:
    m = Model()
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.property(1, density=1000, kn=1e6, ks=1e6)
    m.gravity(0, -10)
    for d in (0.2, 0.05):
        m.cycle(10)
        m.round(d)
        sound(m)


def test_the_caret_is_at_the_rounding_length(tmp_path: Path) -> None:
    m, overlap = pressed()
    m.out = tmp_path
    with pytest.raises(UdecError) as caught:
        m.run(f"ROUND {overlap:.9f}")
    assert (caught.value.number, caught.value.column) == (14, 7)


CUTS = "".join(f"SPLIT {x},1.2 {x},4\n" for x in range(2, 20, 2))
GAP = "SPLIT -1,1 21,1\nSPLIT -1,1.3 21,1.3\nDELETE 0 20 1 1.3\n"
COLUMNS = f"START\nBLOCK 0,-2 0,3 20,3 20,-2\nROUND 0.1\n{GAP}{CUTS}"


def fault(m: Model, deck: str) -> UdecError | None:
    """The error in which `deck` ends on `m`, or None."""
    try:
        m.run(deck)
    except UdecError as error:
        return error
    return None


def least_that_fits(deck: str, out: Path) -> Model:
    """The model after `deck` with the size of IA() found as a user would: by what each error 1 says."""
    m, reached = Model(mtop=100, out=out), 0
    while (error := fault(m, deck)) is not None:
        assert error.number == 1
        assert error.line is not None
        assert error.line > reached, "the size that the error named did not do for its line"
        reached = error.line
        m = Model(mtop=int(error.advice.partition("--mtop ")[2].split()[0].rstrip(":")), out=out)
    return m


def test_a_rounding_that_finds_no_memory_changes_nothing(tmp_path: Path) -> None:
    """A greater rounding length makes contacts across the gap; where IA() is full, the smaller one stays."""
    m = least_that_fits(COLUMNS, tmp_path)
    before = words(m)
    with pytest.raises(UdecError) as caught:
        m.round(0.7)
    assert caught.value.number == 1
    assert words(m) == before
    sound(m)
    grown = Model()
    grown.run(COLUMNS)
    grown.round(0.7)
    assert len(grown.table("contact")) > len(m.table("contact"))
