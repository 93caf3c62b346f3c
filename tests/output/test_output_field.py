"""Pictures of what goes on inside blocks: colours, crosses and arrows against the numbers they stand for."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import colormaps

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import field, outlines, snapshot
from udec_ia.output.plot_frames import Frame, What
from udec_ia.reader.drawable_quantities import IN_BLOCKS
from udec_ia.studies.verification_tools import generate, rectangle

STRESSES = [(-3e5, 1e5, -1e5), (2e5, -5e4, -4e5), (-1e5, 0.0, -1e5), (0.0, 3e5, 0.0)]


def stressed() -> Model:
    """A fully-deformable block of four zones with different stresses, a simply-deformable and a rigid one."""
    m = Model()
    m.round(0.05)
    m.block(0, 0, 0, 1, 3, 1, 3, 0)
    m.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e9, g=5e8)
    m.split(1, -1, 1, 2)
    m.split(2, -1, 2, 2)
    points = [(0.5, 0.5), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]
    m.generate(0, 1, 0, 1, "manual", points, [(1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)])
    m.change(1, 2, 0, 1, type="sdef")
    for address, stress in zip(m.table("zone")["address"], STRESSES, strict=True):
        for k, value in zip((g.KZS11, g.KZS12, g.KZS22), stress, strict=True):
            putr(m.h, int(address), k, value)
    (simple,) = m.table("sdef")["address"]
    putr(m.h, int(simple), g.KS111, -2e5)
    putr(m.h, int(simple), g.KS122, 1e5)
    return m


def colour_at(figure: Any, places: Any) -> Any:
    """Colours of a picture (0 to 255) at places of its axes."""
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())
    x, y = figure.axes[0].transData.transform(places).T.astype(int)
    return pixels[len(pixels) - 1 - y, x, :3].astype(int)


@pytest.mark.parametrize("name", ["s11", "s12", "s22", "pressure", "shear", "major", "minor"])
def test_colours_are_those_of_the_stresses(name: str) -> None:
    m = stressed()
    frame = Frame("colours")
    frame.add(snapshot(m.h, inside=True), What(contour=name))
    s11, s12, s22 = np.array([*STRESSES, (-2e5, 0.0, 1e5)]).T
    mohr = np.array([np.linalg.eigvalsh([[a, b], [b, c]]) for a, b, c in zip(s11, s12, s22, strict=True)])
    values = {
        "s11": s11,
        "s12": s12,
        "s22": s22,
        "pressure": -mohr.mean(axis=1),
        "shear": np.ptp(mohr, axis=1) / 2,
        "major": -mohr[:, 0],
        "minor": -mohr[:, 1],
    }
    wanted = values[name]
    least, most, palette = wanted.min(), wanted.max(), "viridis"
    if least < 0 < most:
        most = abs(wanted).max()
        least, palette = -most, "RdBu_r" if name[0] == "s" else "RdBu"  # tension is red
    shades = colormaps[palette]((wanted - least) / (most - least))[:, :3] * 255
    points = m.table("gridpoint")
    zones = [points[np.isin(points["address"], row)] for row in m.table("zone")["KZG"]]
    places = [*((zone["KXG"].mean(), zone["KYG"].mean()) for zone in zones), (1.4, 0.6)]
    np.testing.assert_allclose(colour_at(frame.figure(), places), shades, atol=3.0)  # a palette has 256 steps


def test_a_zone_is_cut_off_where_its_block_is_rounded() -> None:
    m = stressed()
    frame = Frame("rounded")
    frame.add(snapshot(m.h, inside=True), What(contour="s22"))
    inside, outside = colour_at(frame.figure(), [(0.03, 0.5), (0.004, 0.004)])
    assert (outside == 255).all()
    assert (inside != 255).any()


def test_crosses_lie_along_principal_stresses() -> None:
    m = stressed()
    frame = Frame("crosses")
    frame.add(snapshot(m.h, inside=True), What(stresses=True))
    collections = [c for c in frame.figure().axes[0].collections if c.get_zorder() == 4]
    lines = np.concatenate(
        [np.reshape(c.get_segments(), (-1, 2, 2)) for c in collections if c.get_segments()]
    )
    now = field(m.h, outlines(m.h))
    known = np.isfinite(now.stress).all(axis=1)  # rigid blocks have no stresses
    largest = max(abs(np.linalg.eigvalsh([[a, b], [b, c]])).max() for a, b, c in now.stress[known])
    longest = max(np.hypot(*(line[1] - line[0])) for line in lines)
    for middle, (s11, s12, s22) in zip(now.middle[known], now.stress[known], strict=True):
        values, vectors = np.linalg.eigh([[s11, s12], [s12, s22]])
        for value, vector in zip(values, vectors.T, strict=True):
            if value == 0:
                continue
            half = vector * abs(value) / largest * longest / 2
            ends = np.array([middle - half, middle + half])
            gap = np.minimum(abs(lines - ends).max(axis=(1, 2)), abs(lines - ends[::-1]).max(axis=(1, 2)))
            gap = np.where(np.isclose(*values), abs(lines.mean(axis=1) - middle).max(axis=1), gap)
            assert gap.min() < 1e-9


def test_arrows_are_displacements_since_the_frame_began() -> None:
    m = stressed()
    frame = Frame("moved")
    frame.add(snapshot(m.h, inside=True), What())
    point = int(m.table("gridpoint")["address"][0])
    putr(m.h, point, g.KXG, float(m.table("gridpoint")["KXG"][0]) + 0.03)
    putr(m.h, point, g.KYG, float(m.table("gridpoint")["KYG"][0]) + 0.04)
    frame.add(snapshot(m.h, inside=True), What(displacements=True))
    texts = [text.get_text() for text in frame.figure().axes[0].texts]
    assert "50 mm; largest displacement: 50 mm" in texts


def test_a_window_is_what_is_shown(tmp_path: Path) -> None:
    m = stressed()
    frame = Frame("window")
    frame.add(snapshot(m.h), What(window=(0.5, 1.5, -1.0, 2.0)))
    axes = frame.figure().axes[0]
    assert (*axes.get_xlim(), *axes.get_ylim()) == (0.5, 1.5, -1.0, 2.0)
    for wrong in ((1, 1, 0, 1), (0, 1, 1, 0), (0, 1, 0, np.inf), (np.nan, 1, 0, 1)):
        with pytest.raises(UdecError, match=r"error 28: .* window") as caught:
            m.plot(0, window=wrong)
        assert caught.value.parameter == "window"


def test_measures_of_a_mesh_are_those_of_its_zones() -> None:
    m = Model()
    m.round(0.05)
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e9, g=5e8)
    generate(m, rectangle(0, 2, 0, 1, 4, 2))
    m.insitu(-1, 3, -1, 2, -1e5, 2e4, -3e5)
    now = field(m.h, outlines(m.h))
    assert len(now.zone) == len(now.stress) == len(m.table("zone"))
    for name, value in (("pressure", 2e5), ("shear", np.hypot(1e5, 2e4))):
        np.testing.assert_allclose(IN_BLOCKS[name].values(now, None), value)
