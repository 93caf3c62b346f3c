"""Codes in range that contradict the rest, and masses that do not agree: check and PATCH refuse them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from udec_ia import Model
from udec_ia.checker import check
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.patch_words import patch
from udec_ia.layout import offsets as g

BUILDS = ("i32r64", "i16r32")


def scene(build: str = "i32r64") -> Model:
    """Rigid, simply-deformable and zoned blocks; some fixed, some driven."""
    m = Model(build=build)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 3, 4, 3, 4, 0)
    m.split(-1, 1, 5, 1)
    m.split(2, 0.9, 2, 4)
    m.split(-1, 2, 2.0, 2)
    m.fix(0, 4, 0, 1)
    m.round(0.05)
    m.generate(2, 4, 1, 3, "automatic", edge=0.7)
    m.change(0, 2, 2, 3, "sdef")
    m.boundary(2, 4.1, 2.9, 3.1, xvel=0.01)
    m.boundary(0, 2, 1, 2, yvel=-0.01)
    m.gravity(3, -10)
    m.cycle(20)
    return m


@pytest.fixture(scope="module", params=BUILDS)
def array(request: pytest.FixtureRequest) -> MainArray:
    made: MainArray = scene(request.param).array
    return made


def test_the_scene_is_sound(array: MainArray) -> None:
    assert check(array) == []


def refused(array: MainArray, kind: str, field: str, value: float, rows: Any = None) -> None:
    """PATCH of the field to `value` is refused in every group where it is another, and FORCE keeps it."""
    m = array.copy()
    table_rows = _table(m, kind)
    chosen = table_rows[table_rows[field] != value] if rows is None else table_rows[rows]
    assert len(chosen)
    for address in chosen["address"][:6].tolist():
        with pytest.raises(UdecError) as error:
            patch(m, f"{kind}@{address}.{field} = {value}")
        assert error.value.number == 28
        assert f"{kind}@{address}" in str(error.value)
    forced = array.copy()
    done = patch(forced, f"{kind}@{int(chosen['address'][0])}.{field} = {value}", force=True)
    assert done.broken


def _table(array: MainArray, kind: str) -> Any:
    from udec_ia.reader.group_tables import table

    found: Any = table(array, kind)
    return found


@pytest.mark.parametrize("value", [2, 4, 6])
def test_a_block_that_no_condition_moves(array: MainArray, value: int) -> None:
    rows = _table(array, "block")
    refused(array, "block", "KBFIX", value, np.flatnonzero(rows["KBFIX"] == 0))


def test_a_block_that_a_condition_moves(array: MainArray) -> None:
    rows = _table(array, "block")
    driven = np.flatnonzero(rows["KBFIX"] == g.GIVEN_Y)
    assert len(driven)
    for value in (0, g.GIVEN_X, g.GIVEN_X + g.GIVEN_Y):
        refused(array, "block", "KBFIX", value, driven)


@pytest.mark.parametrize("value", [0, 1, 2, 3])
def test_grid_points(array: MainArray, value: int) -> None:
    refused(array, "gridpoint", "KGFIX", value)


def test_points_of_edges(array: MainArray) -> None:
    """A corner that has become flat has no rounding either, so the code may be 0 on a straight edge."""
    rows = _table(array, "gridpoint")
    assert {0, 1} == set(rows["KGEDGE"].tolist())
    refused(array, "gridpoint", "KGEDGE", 1, np.flatnonzero(rows["KGEDGE"] == 0))


@pytest.mark.parametrize("field", ["KBM", "KBI"])
def test_masses_of_blocks(array: MainArray, field: str) -> None:
    rows = _table(array, "block")
    zoned = rows["HEAD"] == g.MFDEF
    refused(array, "block", field, 1, np.flatnonzero(~zoned))
    if field == "KBM":
        refused(array, "block", field, 1, np.flatnonzero(zoned))


@pytest.mark.parametrize(("kind", "field"), [("gridpoint", "KGPM"), ("zone", "KZM")])
def test_masses_of_zones(array: MainArray, kind: str, field: str) -> None:
    m = array.copy()
    rows = _table(m, kind)
    with pytest.raises(UdecError, match="mass"):
        patch(m, f"{kind}@{int(rows['address'][0])}.{field} = {float(rows[field][0]) * 1.5!r}")


@pytest.mark.parametrize("field", ["KXD", "KYD", "KTD"])
def test_a_fixed_block_stands_still(array: MainArray, field: str) -> None:
    rows = _table(array, "block")
    refused(array, "block", field, 1, np.flatnonzero(rows["KBFIX"] == g.FIXED))


def test_densities_may_change_after_the_masses_are_known() -> None:
    m = scene()
    m.property(1, density=3000)
    assert m.check() == []
    m.cycle(5)
    m.split(-1, 2.5, 2.0, 2.5)
    assert m.check() == []
    fresh = Model()
    fresh.block(0, 0, 0, 1, 1, 1, 1, 0)
    assert fresh.check() == []
    fresh.property(1, density=1000, kn=1e8, ks=1e8)
    assert fresh.check() == []


def test_a_cut_hands_velocities_on() -> None:
    m = scene()
    m.split(1.0, 1, 1.0, 2)
    assert m.check() == []
    m.free(0, 4, 0, 1)
    m.fix(0, 4, 1, 3)
    m.boundary(0, 4.1, 0, 3.1, free=True)
    m.free(0, 4, 1, 3)
    assert m.check() == []
