"""Pictures: the curves are the rounded outlines, frames collect states, files are numbered."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.path import Path as Curve
from matplotlib.quiver import Quiver
from PIL import Image
from support.handmade_map import ROUNDING, two_blocks

from udec_ia import Model
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, getr, iget, puti, putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.output.animation import MAX_STATES, Animation
from udec_ia.output.block_drawing import LARGEST, limits, moved_blocks, scale_for, to_draw
from udec_ia.output.drawn_outlines import (
    ARC_POINTS,
    CLOSE,
    CURVE,
    LINE,
    MOVE,
    beside_corners,
    contact_forces,
    curves,
    domain_polygons,
    outlines,
    snapshot,
)
from udec_ia.output.plot_frames import Frame, Plots, What
from udec_ia.reader.list_walks import corners, groups

ROUNDED_AREA = 1.0 - (4.0 - np.pi) * ROUNDING**2
# a quarter circle drawn as n chords loses R^2 (pi/4 - (n/2) sin(pi/2n)) of its area
CHORDS = ROUNDING**2 * (np.pi / 4.0 - 0.5 * (ARC_POINTS - 1) * np.sin(np.pi / 2.0 / (ARC_POINTS - 1)))


def shift(h: Memory, block: int, dx: float, dy: float) -> None:
    """Move a block without turning it."""
    putr(h, block, g.KX, getr(h, block, g.KX) + dx)
    putr(h, block, g.KY, getr(h, block, g.KY) + dy)
    for corner in corners(h, block):
        for kx, ky in ((g.KXP, g.KYP), (g.KXCP, g.KYCP)):
            putr(h, corner, kx, getr(h, corner, kx) + dx)
            putr(h, corner, ky, getr(h, corner, ky) + dy)


def area(polygon: np.ndarray) -> float:
    """Area of a polygon, positive when it runs anticlockwise."""
    x, y = polygon.T
    return float(0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def flattened(vertices: np.ndarray, codes: np.ndarray) -> np.ndarray:
    """A path as a fine polygon: every cubic curve becomes 50 points."""
    points = [vertices[0]]
    t = np.linspace(0.0, 1.0, 50)[:, None]
    i = 1
    while i < len(codes):
        if codes[i] == CURVE:
            a, (b, c, d) = points[-1], vertices[i : i + 3]
            points += list((1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d)
            i += 3
        else:
            points += [vertices[i]] if codes[i] != CLOSE else []
            i += 1
    return np.array(points)


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_outlines_are_rounded_squares(scheme: str) -> None:
    """Each outline is a closed clockwise path; its area is that of a square with four rounded corners."""
    o = outlines(two_blocks(scheme).h)
    vertices, codes, block = curves(o)
    assert o.fixed.tolist() == [True, False]
    assert o.centroid.round(6).tolist() == [[0.5, 0.5], [0.5, 1.5]]
    for i in range(2):
        path, kinds = vertices[block == i], codes[block == i]
        assert (kinds[0], kinds[-1]) == (MOVE, CLOSE)
        assert list(kinds).count(CURVE) == 4 * 2 * 3
        # two cubic curves for a quarter circle are within 4e-6 of the radius: area within 3e-6 R^2
        assert area(flattened(path, kinds)) == pytest.approx(-ROUNDED_AREA, abs=1e-5)


def test_sharp_corners_stay_sharp() -> None:
    """A corner with a radius that is not positive is drawn as it is; without rounding all are."""
    h = two_blocks().h
    first = corners(h, next(groups(h, "block")))[0]
    putr(h, first, g.KRAD, -ROUNDING)
    vertices, codes, block = curves(outlines(h))
    assert area(flattened(vertices[block == 0], codes[block == 0])) == pytest.approx(
        -ROUNDED_AREA - (1.0 - np.pi / 4.0) * ROUNDING**2, abs=1e-5
    )
    h.cr[g.DTOL] = 0.0
    vertices, codes, block = curves(outlines(h))
    assert codes[block == 1].tolist() == [MOVE, LINE, LINE, LINE, CLOSE]
    assert area(vertices[block == 1][:-1]) == pytest.approx(-1.0)


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_forces_act_on_the_second_block(scheme: str) -> None:
    """Normal force up from the lower block, shear force against the tangent (normal turned anticlockwise)."""
    h = two_blocks(scheme).h
    left, right = groups(h, "contact")
    putr(h, left, g.KCFN, 300.0)
    putr(h, left, g.KCFS, 40.0)
    puti(h, right, g.KCCOD, 4)
    found = contact_forces(h)
    assert found.force == pytest.approx(np.array([[40.0, 300.0], [0.0, 0.0]]), abs=1e-3)
    assert found.virtual.tolist() == [False, True]
    apex = 1.0 - ROUNDING * (1.0 - 0.5**0.5)
    assert found.link[1] == pytest.approx(np.array([[apex, apex], [apex, 2.0 - apex]]))


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_domain_polygons(scheme: str) -> None:
    """The joint is closed and has no area; the outer loop goes around two rounded squares."""
    inner, outer = domain_polygons(two_blocks(scheme).h)
    assert (inner.outer, outer.outer) == (False, True)
    assert abs(area(inner.polygon)) < 1e-6
    assert area(outer.polygon) == pytest.approx(-2.0 * ROUNDED_AREA, abs=8 * CHORDS + 1e-6)


def test_domain_around_sharp_corners() -> None:
    """Without rounding the contacts stand at the corners themselves, and the outer loop is a rectangle."""
    h = two_blocks().h
    h.cr[g.DTOL] = 0.0
    for x, contact in enumerate(groups(h, "contact")):
        putr(h, contact, g.KXC, float(x))
    for block in groups(h, "block"):
        for corner in corners(h, block):
            putr(h, corner, g.KRAD, 0.0)
    _, outer = domain_polygons(h)
    assert area(outer.polygon) == pytest.approx(-2.0)


def test_virtual_contacts_add_no_area_to_a_domain() -> None:
    """Wherever a virtual contact happens to stand, the loop crosses there and back by the same way.

    With the right contact virtual the two loops together still cover what they covered before, but for two
    arcs that are drawn with other chords.
    """
    h = two_blocks().h
    before = sum(area(domain.polygon) for domain in domain_polygons(h))
    right = list(groups(h, "contact"))[1]
    puti(h, right, g.KCCOD, 4)
    putr(h, right, g.KXC, 17.0)
    after = sum(area(domain.polygon) for domain in domain_polygons(h))
    assert after == pytest.approx(before, abs=2 * CHORDS)


def texts_of(picture: Figure) -> list[str]:
    """All texts on the axes of a picture: notes, and addresses."""
    return [text.get_text() for text in picture.axes[0].texts]


def test_what_stands_still_is_drawn_once() -> None:
    h = two_blocks().h
    lower, upper = groups(h, "block")
    states = [snapshot(h)]
    shift(h, upper, 0.3, 0.0)
    states.append(snapshot(h))
    states.append(snapshot(h))
    drawn = to_draw(states, 1e-3)
    assert [mask.tolist() for mask in drawn] == [[True, True], [False, True], [False, False]]
    assert moved_blocks(states, drawn) == {upper}
    assert lower not in moved_blocks(states, drawn)


def test_limits_and_scale() -> None:
    """The range holds the blocks; what flies off further than the first state is wide is cut."""
    h = two_blocks().h
    states = [snapshot(h)]
    assert limits(states) == pytest.approx((-0.08, 1.08, -0.08, 2.08))
    shift(h, list(groups(h, "block"))[1], 1000.0, 0.0)
    states.append(snapshot(h))
    assert limits(states)[1] == pytest.approx(1.0 + 2.0 + 0.08)
    box = limits(states[:1])
    assert scale_for(box, 0.2) == 0.2
    assert scale_for(box, 1e6) * (box[3] - box[2]) == pytest.approx(LARGEST)
    assert scale_for(box, 0.0) * (box[3] - box[2]) == pytest.approx(5.5)


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_frames_and_their_files(scheme: str, tmp_path: Path) -> None:
    """PLOT 1 adds to the frame, PLOT 0 starts the next one; each frame gives a PNG and an SVG that open."""
    h = two_blocks(scheme).h
    plots = Plots(tmp_path / "new" / "folder", "deck")
    written = plots.draw(h, 1)
    assert [path.name for path in written] == ["deck-plot-1.png", "deck-plot-1.svg"]
    one_state = [path.read_bytes() for path in written]
    shift(h, list(groups(h, "block"))[1], 0.2, 0.1)
    assert plots.draw(h, 1) == plots.files == written
    assert all(path.read_bytes() != before for path, before in zip(written, one_state, strict=True))
    plots.draw(h, 0, What(contacts=True, domains=True, addresses=True))
    files = plots.close()
    assert [path.name for path in files[2:]] == ["deck-plot-2.png", "deck-plot-2.svg"]
    assert plots.close() == files
    for path in files[::2]:
        with Image.open(path) as picture:
            assert min(picture.size) > 300
    assert all("</svg>" in path.read_text() for path in files[1::2])


def test_a_frame_of_many_states_is_not_drawn_for_each(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All that is drawn until the frame ends is a small multiple of its states, and no state is left out."""
    drawn: list[int] = []

    def figure(frame: Frame) -> Figure:
        drawn.append(len(frame.states))
        return Figure((1, 1))

    monkeypatch.setattr(Frame, "figure", figure)
    h, plots = two_blocks().h, Plots(tmp_path, "deck")
    for n in (20, 80):
        drawn.clear()
        for k in range(n):
            message = plots.draw(h, int(k > 0))
            assert (message == []) == (drawn[-1] < k + 1)
            assert (message == []) == any(
                "drawn with later ones" in text for text in plots.remarks(h, What())
            )
        plots.close()
        assert drawn[:10] == list(range(1, 11))
        assert drawn[-1] == n
        assert sum(drawn) <= 6 * n + 55


def test_a_picture_is_there_as_soon_as_it_was_asked_for(tmp_path: Path) -> None:
    """In Python and in a deck, without the end of the run; STOP names each file once."""
    m = Model(out=tmp_path)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    files = [tmp_path / f"udec-plot-1.{kind}" for kind in ("png", "svg")]
    assert m.plot() == m.plot(1) == files
    assert all(path.stat().st_size > 1000 for path in files)
    printed = m.run("PLOT 1\nPLOT 0 S11 DISP\n")
    assert printed is not None
    assert printed.count("written: ") == 2  # the first picture was ended, and its files were named before
    assert "rigid blocks have no stresses" in printed
    assert "PLOT 1 DISPLACEMENTS draws them" in printed
    assert m.stop().count("udec-plot-1.png, udec-plot-1.svg, udec-plot-2.png, udec-plot-2.svg; ") == 1


def test_displacements_are_those_since_a_bare_start(tmp_path: Path) -> None:
    """PLOT 0 does not know yet what PLOT 1 will ask for."""
    h, plots = two_blocks().h, Plots(tmp_path, "deck")
    plots.draw(h, 0)
    shift(h, list(groups(h, "block"))[1], 0.3, 0.4)
    plots.draw(h, 1, What(displacements=True))
    assert plots.frame is not None
    picture = plots.frame.figure()
    assert "0.5 m; largest displacement: 0.5 m" in texts_of(picture)
    (arrows,) = (one for one in picture.axes[0].collections if isinstance(one, Quiver))
    at = arrows.XY[:, 1].argmax()
    assert arrows.XY[at] == pytest.approx([0.8, 1.9])
    assert arrows.U[at] / arrows.V[at] == pytest.approx(0.75)


def test_displacements_begin_anew_in_an_open_frame(tmp_path: Path) -> None:
    h, plots = two_blocks().h, Plots(tmp_path, "deck")
    plots.reset_displacements(h)
    plots.draw(h, 0)
    shift(h, list(groups(h, "block"))[1], 0.3, 0.4)
    plots.reset_displacements(h)
    shift(h, list(groups(h, "block"))[1], 0.0, 0.25)
    plots.draw(h, 1, What(displacements=True))
    assert plots.frame is not None
    assert "0.2 m; largest displacement: 0.25 m" in texts_of(plots.frame.figure())


@pytest.mark.parametrize("name", ["caf\udce9", r"$\frac$", "a\x1b[31m\nb", "日本"])
def test_any_name_of_a_run_can_be_drawn(name: str, tmp_path: Path) -> None:
    """Bytes that are no UTF-8, a formula, control characters, what the font does not have."""
    m = Model(out=tmp_path)
    m.name = name
    m.animate = True
    m.property(1, density=1, kn=1, ks=1)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.split(-1, 0.5, 2, 0.5)
    m.fix(0, 1, 0, 0.5)
    m.history(1, "TIME")
    m.cycle(1)
    files = [*m.plot(), *m.plot(history=True)]
    line = m.stop()
    assert line.isprintable()
    assert all(path.is_file() and path.name.startswith(name) for path in files)
    assert sorted(path.suffix for path in tmp_path.iterdir()) == [
        ".csv",
        ".gif",
        ".h5",
        ".png",
        ".png",
        ".svg",
        ".svg",
    ]
    for path in files[1::2]:
        ElementTree.parse(path)


def test_words_add_up_over_a_frame(tmp_path: Path) -> None:
    """A new contour or window replaces the one before; a new frame begins with nothing."""
    h = two_blocks().h
    plots = Plots(tmp_path, "deck")
    plots.draw(h, 0, What(contacts=True, stresses=True, contour="s22", window=(0.0, 1.0, 0.0, 1.0)))
    plots.draw(h, 1, What(velocities=True))
    assert plots.frame is not None
    was = What(contacts=True, stresses=True, velocities=True, contour="s22", window=(0.0, 1.0, 0.0, 1.0))
    assert plots.frame.what == was
    plots.draw(h, 1, What(contour="s11", window=(0.0, 1.0, 0.0, 2.0)))
    assert plots.frame.what == replace(was, contour="s11", window=(0.0, 1.0, 0.0, 2.0))
    assert plots.frame.states[-1].field is not None  # for the velocities that were asked for before
    notes = "".join(texts_of(plots.frame.figure()))
    assert "largest contact force" in notes
    assert "velocity" in notes
    plots.draw(h, 0)
    assert plots.frame.what == What()


def test_addresses_are_written_in_the_picture(tmp_path: Path) -> None:
    h = two_blocks().h
    frame = Frame("deck")
    frame.add(snapshot(h, contacts=True, domains=True), What(addresses=True))
    texts = [text.get_text() for text in frame.figure().axes[0].texts]
    wanted = [*groups(h, "block"), *groups(h, "contact"), iget(h, next(groups(h, "block")), g.KP)]
    assert {str(iad) for iad in wanted} <= set(texts)
    assert str(next(groups(h, "domain"))) in texts


@pytest.mark.parametrize(
    ("corners", "cut"),
    [
        ((0, 0, 0, 10, 3, 10, 3, 5, 7, 5, 7, 10, 10, 12, 14, 10, 20, 1, 20, 0), (-1, 7.5, 21, 7.5)),
        ((0, 0, 0, 1, 100, 1, 100, 0), (50, -1, 50, 2)),
        ((0, 0, 0, 9, 1, 9, 1, 1, 20, 1, 20, 0), (10, -1, 10, 2)),
    ],
    ids=["notched", "slabs", "angle"],
)
def test_addresses_of_corners_stand_inside_their_blocks(corners: tuple[int, ...], cut: Any) -> None:
    m = Model()
    m.block(*corners)
    m.split(*cut)
    o = outlines(m.h)
    for i in range(len(o.address)):
        polygon = o.corner[o.first[i] : o.first[i + 1]]
        places = beside_corners(o, i)
        assert Curve(polygon).contains_points(places).all()
        nearest = np.hypot(*(places[:, None] - polygon[None]).transpose(2, 0, 1)).argmin(axis=1)
        assert nearest.tolist() == list(range(len(polygon)))


def test_the_note_gives_the_resultant_force() -> None:
    """The summary of a run gives normal forces: here 3, where the arrows are 5 long."""
    h = two_blocks().h
    for contact in groups(h, "contact"):
        putr(h, contact, g.KCFN, 3.0)
        putr(h, contact, g.KCFS, 4.0)
    frame = Frame("deck")
    frame.add(snapshot(h, contacts=True))
    notes = "".join(texts_of(frame.figure()))
    assert "largest contact force (resultant): 5 N/m" in notes
    assert "in cycle" not in notes
    h.ci[g.MCTOT] = 7
    frame.add(snapshot(h))
    notes = "".join(texts_of(frame.figure()))
    assert "largest contact force (resultant): 5 N/m, in cycle 0" in notes  # whose forces the arrows are


def test_name_and_cycle_stand_above_each_other_where_the_picture_is_narrow() -> None:
    frame = Frame("a name that is longer than the picture is wide")
    frame.add(snapshot(two_blocks().h))
    narrow = frame.figure().axes[0]
    frame.name = "deck"
    wide = frame.figure().axes[0]
    assert narrow.get_title(loc="left").endswith("\n")
    assert wide.get_title(loc="left") == "deck"
    assert wide.get_title(loc="right") == narrow.get_title(loc="right") == "cycle 0, t = 0 s"


def test_only_two_kinds_of_plot(tmp_path: Path) -> None:
    with pytest.raises(UdecError) as error:
        Plots(tmp_path, "deck").draw(two_blocks().h, 2)
    assert error.value.number == 28


def test_matplotlib_is_loaded_only_to_draw() -> None:
    """Starting the program must not pay for matplotlib."""
    code = "import sys, json\nimport udec_ia.output.plot_frames, udec_ia.output.animation\n"
    code += "print(json.dumps(list(sys.modules)))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert not {"matplotlib", "PIL"} & set(json.loads(out.stdout))


def test_animation_keeps_evenly_spaced_states() -> None:
    h = two_blocks().h
    animation = Animation("deck")
    offered = 2 * MAX_STATES + 10
    for cycle in range(offered):
        h.ci[g.MCTOT] = cycle
        animation.add(h)
    cycles = [state.cycle for state in animation.states]
    assert cycles == list(range(0, offered, animation.stride))
    assert MAX_STATES / 2 <= len(cycles) <= MAX_STATES


def test_animation_is_written_with_its_last_state(tmp_path: Path) -> None:
    h = two_blocks().h
    upper = list(groups(h, "block"))[1]
    animation = Animation("deck")
    for cycle in range(3):
        h.ci[g.MCTOT] = cycle
        animation.add(h)
        shift(h, upper, 0.1, 0.0)
    h.ci[g.MCTOT] = 3
    path = animation.save(tmp_path / "run" / "deck.gif", h)
    with Image.open(path) as picture:
        assert picture.format == "GIF"
        assert getattr(picture, "n_frames", 1) == 4


@pytest.mark.parametrize(
    "window",
    [
        (4.953, 5.739, -1e308, -1.0),
        (-1e308, 1e308, 0.0, 1.0),
        (0.0, 1e5, 0.0, 1.0),
        (1e12, 1e12 + 1, 0.0, 1.0),
        (1e200, 2e200, 1e200, 2e200),
        (0.0, 1e-320, 0.0, 1e-320),
        (-1e-30, 1e-30, 0.0, 1e-30),
        (1.0, 0.0, 0.0, 1.0),
        (np.nan, 1.0, 0.0, 1.0),
    ],
)
def test_windows_that_cannot_be_drawn(window: tuple[float, float, float, float], tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    with pytest.raises(UdecError, match=r"window|WINDOW") as caught:
        m.plot(0, window=window)
    assert caught.value.number == 28
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "window",
    [(0.0, 90.0, 0.0, 1.0), (0.0, 1.0, -90.0, 0.0), (-1e-6, 1e-6, 0.0, 1e-6), (9e29, 1e30, 0.0, 1e29)],
)
def test_windows_at_the_limits_are_drawn(window: tuple[float, float, float, float], tmp_path: Path) -> None:
    m = Model(out=tmp_path)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    assert {path.suffix for path in m.plot(0, window=window)} == {".png", ".svg"}
