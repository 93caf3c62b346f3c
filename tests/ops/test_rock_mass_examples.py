"""Example decks of rock masses, at a smaller size."""

from __future__ import annotations

import io
import re
from pathlib import Path

import numpy as np
import pytest

from udec_ia import Model

EXAMPLES = Path(__file__).parents[2] / "examples"
DECKS = [
    f"{name}.dat"
    for name in re.findall(
        r"\| ([a-z-]+)\.dat \|", (EXAMPLES.parent / "docs" / "rock-mass-examples.md").read_text()
    )
]


def run(name: str, tmp_path: Path, **values: float) -> tuple[Model, str]:
    m, out = Model(out=tmp_path), io.StringIO()
    m.run(EXAMPLES / name, out, values)
    return m, out.getvalue()


@pytest.mark.parametrize("name", DECKS)
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
    m, _ = run("voronoi-pillar.dat", tmp_path, V=0.05, T=0.14)
    force, _ = m.histories()
    stress = -force.numbers[:, 2] / 2
    quarter = len(stress) // 4
    assert 5e6 < stress[-1] < 50e6
    assert stress[-1] < 0.8 * 4 * stress[quarter]
    assert np.count_nonzero(m.table("joint")["KCJFLAG"] & 6) > 50


def test_a_tunnel_is_excavated_in_two_stages(tmp_path: Path) -> None:
    m, _ = run("two-stage-tunnel.dat", tmp_path, EDGE=8, RATIO=1e-3)
    stages = [Model.restore(tmp_path / "udec-stages.zip" / name) for name in ("rock", "heading")]
    blocks = [len(one.table("block")) for one in (*stages, m)]
    assert blocks == sorted(blocks, reverse=True)
    assert len({*blocks}) == 3
    factors = m.table("bound")
    assert len(factors) > 20
    assert len([*tmp_path.glob("udec-plot-*.svg")]) == 2


def test_columns_topple(tmp_path: Path) -> None:
    m, _ = run("toppling-slope.dat", tmp_path, D=4, T=0.5)
    before = Model.restore(tmp_path / "udec-stages.zip" / "stable").table("block")
    after = m.table("block")
    assert len(before) == len(after) > 8
    assert (after["KX"] - before["KX"]).min() < -5e-4


def test_a_wall_with_openings_cracks(tmp_path: Path) -> None:
    m, _ = run("wall-with-openings.dat", tmp_path, T=0.06)
    blocks = m.table("block")
    assert not ((blocks["KX"] > 1.1) & (blocks["KX"] < 1.9) & (blocks["KY"] > 0) & (blocks["KY"] < 2)).any()
    assert np.abs(m.histories()[0].numbers[:, 2]).max() > 2e5
    assert np.isin(m.table("joint")["KCJFLAG"] & 4, 4).sum() > 10


def test_a_load_moves_over_an_arch(tmp_path: Path) -> None:
    m, _ = run("arch-bridge.dat", tmp_path, V=8, T=0.5)
    blocks = m.table("block")
    (load,) = blocks[blocks["KMAT"] == 2]
    assert load["KX"] == pytest.approx(1.7 + 8 * 0.5, abs=0.02)
    assert load["KY"] == pytest.approx(3.9, abs=0.02)
    assert m.check() == []


def test_a_dry_stone_wall_leans_over(tmp_path: Path) -> None:
    m, _ = run("dry-stone-wall.dat", tmp_path, H=1.6, B=0.5, S=0.25, T=2.0)
    x = m.histories()[0].numbers[:, 2]
    assert x[-1] - x[0] > 0.05
