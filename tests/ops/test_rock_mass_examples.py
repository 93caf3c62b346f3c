"""Example decks of rock masses, at a smaller size."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(name: str, tmp_path: Path, **values: float) -> tuple[Model, str]:
    m, out = Model(out=tmp_path), io.StringIO()
    m.run(EXAMPLES / name, out, values)
    return m, out.getvalue()


@pytest.mark.parametrize("name", ["slope-safety.dat", "two-stage-tunnel.dat", "voronoi-pillar.dat"])
def test_a_deck_is_short(name: str) -> None:
    lines = (EXAMPLES / name).read_text().splitlines()
    assert sum(not line.startswith("*") for line in lines) <= 25


def test_a_slope_fails_along_its_joints(tmp_path: Path) -> None:
    m, text = run("slope-safety.dat", tmp_path, D=6)
    factor = re.search(r"factor of safety ([\d.]+): stable", text)
    assert factor is not None
    assert 1 < float(factor[1]) < 2
    assert len(m.table("block")) > 40
    assert (tmp_path / "udec-fos-1.png").exists()


def test_a_pillar_of_grains_breaks(tmp_path: Path) -> None:
    m, _ = run("voronoi-pillar.dat", tmp_path, E=0.35, T=0.25)
    force, _ = m.histories()
    stress = -force.numbers[:, 2] / 2
    peak = int(np.argmax(stress))
    assert 5e6 < stress[peak] < 50e6
    assert stress[peak:].min() < 0.95 * stress[peak]


def test_a_tunnel_is_excavated_in_two_stages(tmp_path: Path) -> None:
    m, _ = run("two-stage-tunnel.dat", tmp_path, EDGE=8, RATIO=1e-3)
    stages = [Model.restore(tmp_path / "udec-stages.zip" / name) for name in ("rock", "heading")]
    blocks = [len(one.table("block")) for one in (*stages, m)]
    assert blocks == sorted(blocks, reverse=True)
    assert len({*blocks}) == 3
    factors = m.table("bound")
    assert len(factors) > 20
    assert len([*tmp_path.glob("udec-plot-*.svg")]) == 2
