"""Reactions against statics: weights and loads, moments, and the force on a lid that slides."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.mechanics_scenes import block, box, model, on_base, sound

from udec_ia import Model, UdecError
from udec_ia.layout import offsets as g

RATIO = 1e-8


def column(kind: str, out: Path) -> Model:
    """Two blocks of 2 m by 1 m and 20 kN on a floor of the same size, off centre by a load."""
    m = model(*box(0, 2, 0, 3), d=0.05, stiffness=(1e8, 1e8), friction=0.5)
    m.out = out
    m.property(1, bulk=1e9, g=6e8)
    m.split(-1, 1, 3, 1)
    m.split(-1, 2, 3, 2)
    if kind == "fdef":
        m.generate(0, 2, 0, 1, "automatic", edge=0.8)
    elif kind == "sdef":
        m.change(0, 2, 0, 1, kind)
    m.damping(local=0.8)
    return m


def sums(rows: Any) -> Any:
    """Force in x and y, and moment about the origin."""
    moment = rows["moment"] + rows["x"] * rows["fy"] - rows["y"] * rows["fx"]
    return np.array([rows["fx"].sum(), rows["fy"].sum(), moment.sum()])


@pytest.mark.parametrize("held", ["fixed", "velocity", "body", "base"])
@pytest.mark.parametrize("kind", ["rigid", "sdef", "fdef"])
def test_reactions_balance_weights_and_loads(kind: str, held: str, tmp_path: Path) -> None:
    """Force and moment, however the floor is held: 3 x 20 kN at x = 1, and a force on the highest block."""
    m = column(kind, tmp_path)
    if held == "fixed":
        m.fix(0, 2, 0, 1)
    elif held == "velocity":
        m.boundary(-0.1, 2.1, -0.1, 1.1, xvel=0.0, yvel=0.0)
    elif held == "body":
        m.boundary(-0.1, 2.1, -0.1, 1.1, xvel=0.0, yvel=0.0, rotation=0.0)
    elif kind == "fdef":
        m.boundary(-0.1, 2.1, -0.1, 0.1, xvel=0.0, yvel=0.0)
    else:
        pytest.skip("only grid-points can be held one by one")
    m.history(10, "xreaction")
    m.history(10, "yreaction", within=(-0.1, 2.1, -0.1, 1.1))
    m.history(10, "mreaction", within=(-0.1, 2.1, -0.1, 1.1))
    m.solve(RATIO)
    m.boundary(0, 2, 2, 3, xforce=3e3, yforce=-1e3)
    assert m.solve(RATIO)
    x, y = (float(block(m, 1, 2.5)[name]) for name in ("KX", "KY"))
    weights = sum(float(b["KBM"]) * 10 * float(b["KX"]) for b in m.table("block"))
    expected = np.array([-3e3, 61e3, weights + 1e3 * x + 3e3 * y])
    rows = m.reactions()
    tolerance = np.full(3, 61e3 * RATIO * 100)
    if len(rows) > 1:  # forces at rounded corners act on their grid-points, less than D away
        tolerance[2] += 61e3 * 0.05
    assert (np.abs(sums(rows) - expected) < tolerance).all()
    m.cycle(10 - int(m.h.ci[g.MCTOT]) % 10)
    np.testing.assert_allclose([one.numbers[-1, 2] for one in m.histories()], sums(m.reactions()), atol=1e-6)
    assert len(m.reactions(5, 6, 5, 6)) == 0
    assert f"Reactions: {len(rows)}," in m.print("reactions")
    sound(m)


def test_a_lid_that_slides_is_held_by_friction(tmp_path: Path) -> None:
    """A shear box: the lid moves in x under a normal load, cannot tilt, and slides on a fixed base."""
    m = on_base(2.0, 0.5, 0.05, 6.0, friction=0.6, fraction=0.2)
    m.out = tmp_path
    weight = 1000 * 2.0 * 0.5 * 10.0
    m.damping(local=0.8)
    m.boundary(-1, 1, 0, 0.5, yforce=-4e4)
    m.solve(1e-6)
    m.boundary(-1, 1, 0, 0.5, xvel=1e-3, rotation=0.0)
    (force,) = m.history(1, "xreaction", within=(-1, 1, 0, 0.5))
    m.cycle(time=2.0)
    lid = m.reactions(-1, 1.5, 0, 1)
    limit = 0.6 * (weight + 4e4)
    assert float(lid["fx"][0]) == pytest.approx(limit, rel=1e-3)
    assert float(lid["fy"][0]) == 0.0
    base = m.reactions(-6, 6, -1, 0)
    assert float(base["fx"][0]) == pytest.approx(-float(lid["fx"][0]), rel=1e-9)
    assert np.abs(force.numbers[:, 2]).max() < limit * 1.001
    contacts = m.table("contact")
    assert float(np.abs(contacts["KCFS"]).sum()) == pytest.approx(float(lid["fx"][0]), rel=1e-12)


def test_a_sum_follows_what_was_held_when_it_began(tmp_path: Path) -> None:
    """Beyond its range, through SAVE and RESTART; nothing of it is left after DELETE."""
    m = column("rigid", tmp_path)
    m.fix(0, 2, 0, 1)
    (force,) = m.history(1, "yreaction", within=(0, 2, 0.4, 0.6))
    m.solve(1e-6)
    m.boundary(0, 2, 0, 1, yvel=1.0)
    m.cycle(time=0.15)
    assert float(m.table("block")["KY"].min()) > 0.6
    assert force.numbers[-1, 2] == pytest.approx(float(m.reactions()["fy"].sum()), rel=1e-12)
    other = Model.restore(m.save(tmp_path / "one.h5"), out=tmp_path / "other")
    other.cycle(5)
    m.cycle(5)
    assert other.histories()[0].numbers.tobytes() == force.numbers.tobytes()
    assert other.histories()[0].place == force.place == "x 0 to 2, y 0.4 to 0.6"
    m.delete(0, 2, 0, 1.2)
    assert len(m.table("summand")) == 0
    m.cycle(2)
    assert np.isnan(force.numbers[-1, 2])
    sound(m)


@pytest.mark.parametrize(
    ("field", "given", "number"),
    [
        ("kx", {"within": (0, 2, 0, 1)}, 10),
        ("yreaction", {"within": (0, 2, 1, 2)}, 24),
        ("yreaction", {"within": (0, 2, 0, 1), "at": (1, 1)}, 10),
        ("yreaction", {"at": (1, 1)}, 10),
        ("yreaction", {"within": (0, 2, 0)}, 26),
    ],
)
def test_sums_of_nothing_are_refused(field: str, given: dict[str, Any], number: int, tmp_path: Path) -> None:
    m = column("rigid", tmp_path)
    m.fix(0, 2, 0, 1)
    before = m.h.ia.tobytes()
    with pytest.raises(UdecError) as caught:
        m.history(1, field, **given)
    assert caught.value.number == number
    assert m.h.ia.tobytes() == before
    assert m.histories() == []
