"""ROUND between cycles: a rounding length that the overlaps or the memory cannot bear changes nothing."""

from __future__ import annotations

from pathlib import Path

import pytest
from mechanics import on_base, sound

from offsets.generated import MFREE
from udec_ia import Model, UdecError

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
    return h.ia[: int(h.ci[MFREE]) - 1].tobytes(), h.ci.tobytes(), h.cr.tobytes()


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
        m = Model(mtop=int(error.advice.partition("--mtop ")[2].split()[0]), out=out)
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
