"""The example of an opening: what it draws and records, and that the rock around it carries the load."""

from __future__ import annotations

from pathlib import Path

import pytest
from support.mechanics_scenes import sound

from udec_ia import Model

DECK = Path(__file__).parents[2] / "examples" / "opening.dat"


def test_the_opening(tmp_path: Path) -> None:
    """20 m of 10 MPa go through the joint above the opening on both sides of it, to the ratio of SOLVE."""
    m = Model(out=tmp_path)
    m.run(str(DECK))
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
    roof = [
        float(line.split(",")[2]) for line in next(tmp_path.glob("*.csv")).read_text().splitlines()[-300:]
    ]
    assert roof[-1] == pytest.approx(roof[-20], abs=1e-5)  # it has come to rest ...
    assert 2e-3 < roof[0] - roof[-1] < 2e-2  # ... a few millimetres lower
