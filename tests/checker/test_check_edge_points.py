"""The checker knows the points that GENERATE puts on edges: circles of radius zero that touch and are met.

Two squares side by side. The right one is fully deformable with a grid-point in the middle of the edge at the
joint; bent outwards there, it touches the left square with that point alone.
"""

from __future__ import annotations

import pytest

from udec_ia import Model
from udec_ia.heap.accessors import getr, iget, puti, putr
from udec_ia.layout import offsets as g

D = 0.1
POINTS = [(2.0, 0.0), (2.0, 1.0), (2.0, 2.0), (4.0, 2.0), (4.0, 0.0)]  # numbered from the last one
ZONES = [(5, 4, 1), (4, 3, 2), (4, 2, 1)]


@pytest.fixture(name="model", params=["i32r64", "i16r32"])
def two_squares(request: pytest.FixtureRequest) -> Model:
    """The two squares, the middle of the joint pressed in by 0.2 D."""
    model = Model(build=request.param)
    model.round(D)
    model.block(0, 0, 0, 2, 4, 2, 4, 0)
    model.property(1, density=2000, kn=1e8, ks=1e8, bulk=2e8, g=1e8)
    model.split(2, -1, 2, 3)
    model.fix(0, 2, 0, 2)
    model.generate(2, 4, 0, 2, "manual", POINTS, ZONES)
    model.fraction(0.1)
    model.cycle(0)
    (point,) = (int(row["address"]) for row in model.table("gridpoint") if row["KGEDGE"] == 1)
    puti(model.array.h, point, g.KGFIX, 3)  # it keeps its velocity, which no condition gives
    putr(model.array.h, point, g.KXDG, -1.0)
    model.cycle(round(0.2 * D / float(model.h.cr[g.TDEL])))
    puti(model.array.h, point, g.KGFIX, 0)
    return model


def point_of_edge(model: Model) -> int:
    """The corner that GENERATE has put on the edge."""
    marked = {int(point["address"]) for point in model.table("gridpoint") if point["KGEDGE"] == 1}
    (corner,) = (int(row["address"]) for row in model.table("corner") if row["KGP"] in marked)
    return corner


def contact_of(model: Model, corner: int) -> int:
    """The contact of the corner with an edge."""
    (contact,) = (
        int(row["address"])
        for row in model.table("contact")
        if corner == row["KCP1" if row["KCCOD"] == g.CORNER_EDGE else "KCP2"]
    )
    return contact


def names(model: Model, invariant: int, text: str) -> bool:
    return any(text in found.message for found in model.check() if found.invariant == invariant)


def test_a_point_of_an_edge_has_an_arc(model: Model) -> None:
    corner = point_of_edge(model)
    assert getr(model.h, contact_of(model, corner), g.KCN) > 0.1 * D
    assert model.check() == []


def test_a_point_of_an_edge_has_no_radius(model: Model) -> None:
    corner = point_of_edge(model)
    putr(model.h, corner, g.KRAD, 0.01 * D)
    assert names(model, 7, f"corner@{corner}")


def test_a_flat_corner_of_the_block_has_no_arc(model: Model) -> None:
    """The same corner without the mark at its grid-point: a contact that it has lasts until it opens."""
    corner = point_of_edge(model)
    contact = contact_of(model, corner)
    what = f"contact@{contact} stands on the arc of corner@{corner}"
    puti(model.h, iget(model.h, corner, g.KGP), g.KGEDGE, 0)
    assert not names(model, 7, what)
    putr(model.h, contact, g.KCFN, 0.0)
    for offset in (g.KXP, g.KXCP):
        putr(model.h, corner, offset, getr(model.h, corner, offset) + D)
    assert names(model, 7, what)


def test_a_point_of_an_edge_that_overlaps_needs_its_contact(model: Model) -> None:
    corner = point_of_edge(model)
    puti(model.h, contact_of(model, corner), g.KCCOD, 4)
    assert names(model, 8, f"corner@{corner}")
