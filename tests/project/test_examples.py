"""The examples of an opening, a masonry panel and a gravity dam: what they draw and record, and forces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from support.mechanics_scenes import sound

from udec_ia import Model
from udec_ia.layout.offsets import MCTOT
from udec_ia.output.drawn_outlines import joint_results

EXAMPLES = Path(__file__).parents[2] / "examples"


def test_the_opening(tmp_path: Path) -> None:
    """20 m of 10 MPa go through the joint above the opening on both sides of it, to the ratio of SOLVE."""
    m = Model(out=tmp_path)
    m.run(str(EXAMPLES / "opening.dat"))
    sound(m)
    assert {path.suffix for path in tmp_path.iterdir()} == {".png", ".svg", ".csv", ".h5"}
    blocks = {int(row["address"]): row for row in m.table("block")}
    assert len(blocks) == 8
    above = [
        float(row["KCFN"])
        for row in m.table("contact")
        if {blocks[int(row[k])]["KY"] > 12 for k in ("KB1", "KB2")} == {True, False}
    ]
    assert sum(above) == pytest.approx(20 * 10e6, rel=1e-2)
    roof = [float(line.split(",")[2]) for line in next(tmp_path.glob("*.csv")).read_text().splitlines()[1:]]
    assert roof[-1] == pytest.approx(roof[-20], abs=1e-5)  # it has come to rest ...
    assert 2e-3 < roof[0] - roof[-1] < 2e-2  # ... a few millimetres lower


def test_the_masonry_panel(tmp_path: Path) -> None:
    """Beds and heads have their materials; heads open along the cracks; at last the beam slides on its bed.

    Before that no bed carries more than L (c + s tan phi), and then L s tan phi, as its cohesion is lost.
    """
    m = Model(out=tmp_path)
    m.run(str(EXAMPLES / "masonry-panel.dat"))
    sound(m)
    assert len(m.table("block")) == 2 + 7 * 4 + 3
    found = joint_results(m.h)
    along = np.abs(found.line[:, 2] - found.line[:, 0])
    is_bed = along[:, 0] > along[:, 1]
    joints = {
        int(c): int(one)
        for c, one in zip(m.table("contact")["address"], m.table("joint")["KCJMAT"], strict=True)
    }
    materials = np.array([joints[c] for c in found.rows["contact"].tolist()])
    assert set(materials[is_bed]) == {1}
    assert set(materials[~is_bed]) == {2}
    beds, heads = found.rows["opening"][is_bed].max(), found.rows["opening"][~is_bed].max()
    assert heads > 5 * beds > 0
    force = np.abs(m.histories()[0].numbers[:, 2])
    assert force.max() < 1.6 * (2e5 + 4e5 * 0.75)
    assert force[-1] == pytest.approx(1.6 * 4e5 * 0.75, rel=1e-2)


def test_the_gravity_dam(tmp_path: Path) -> None:
    """It holds while the water is 11 m deep, and slides under 11.2 m; uplift falls from heel to toe."""
    m = Model(out=tmp_path)
    m.run(str(EXAMPLES / "gravity-dam.dat"))
    sound(m)
    place = m.histories()[1].numbers  # cycle, time, KX
    before_last = place[:, 0] <= m.h.ci[MCTOT] - 4000
    assert np.ptp(place[before_last, 2]) < 5e-4
    assert place[-1, 2] - place[before_last, 2][-1] > 1e-3
    assert m.histories()[0].numbers[-1, 2] > 2e-3  # and goes on
    rows = m.water()
    base = rows[(np.abs(rows["y"]) < 0.01) & (rows["x"] > 0) & (rows["x"] < 9)]
    falling = base["pressure"][np.argsort(base["x"])]
    assert (np.diff(falling) < 0).all()
    assert (rows["saturation"] < 1).any()
    assert len(list(tmp_path.glob("udec-plot-*.png"))) == 4
