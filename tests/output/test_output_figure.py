"""Model.figure, and what it has in common with PLOT: numbers, units, arrows and scales."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import colormaps, pyplot
from matplotlib.collections import LineCollection, PathCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.patches import FancyArrow
from matplotlib.quiver import Quiver, QuiverKey
from test_output_field import stressed
from test_output_joints import stack

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.layout import offsets as g
from udec_ia.output.block_drawing import MANY, write
from udec_ia.output.drawn_outlines import joint_results
from udec_ia.output.plot_frames import Frame
from udec_ia.output.readable_units import in_readable_units, readable, round_number
from udec_ia.reader.drawable_quantities import IN_BLOCKS, OF_JOINTS


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (3.2e6, "Pa", "3.2 MPa"),
        (2e5, "Pa", "200 kPa"),
        (900, "Pa", "900 Pa"),
        (0.0, "Pa", "0 Pa"),
        (-0.0123456, "m", "-12.35 mm"),
        (0.3, "m", "0.3 m"),
        (5000.0, "m", "5000 m"),
        (1e-9, "m", "0.001 µm"),
        (25.8e6, "N/m", "25.8 MN/m"),
        (0.5, "", "0.5"),
        (3e-7, "m2/s", "3e-07 m2/s"),
    ],
)
def test_units_fit_the_numbers(value: float, unit: str, text: str) -> None:
    assert in_readable_units(value, unit) == text


def test_round_numbers() -> None:
    """The greatest of 1, 2 and 5 times a power of ten below each number, found by trial."""
    choice = np.outer([1.0, 2.0, 5.0], 10.0 ** np.arange(-9, 9)).ravel()
    for number in [*(10.0 ** np.linspace(-8, 7.9, 101)), 1.0, 2.0, 5.0, 1e-3]:
        assert round_number(number) == pytest.approx(choice[choice <= number * (1 + 1e-9)].max())


def moving() -> tuple[Model, Any]:
    """A block with zones, a simply-deformable and a rigid one, and what pictures show of their motion.

    That is: displacements and velocities of the zones, each the mean of its three points, and of the others.
    """
    m = stressed()
    m.gravity(3, -10)
    m.reset("displacements")
    before = rows_of_points(m)
    m.cycle(8)
    now = rows_of_points(m)
    motion = {address: (*(now[address][:2] - before[address][:2]), *now[address][2:]) for address in now}
    zones = [np.mean([motion[int(one)] for one in row], axis=0) for row in m.table("zone")["KZG"]]
    blocks = m.table("block")
    others = blocks["address"][blocks["KX"] > 1].tolist()  # in list order
    return m, np.array([*zones, *(motion[one] for one in others)])


def rows_of_points(m: Model) -> dict[int, Any]:
    """Place and velocity of grid-points and blocks, by address."""
    return {
        int(row["address"]): np.array([row[name] for name in names], np.float64)
        for kind, names in (
            ("gridpoint", ("KXG", "KYG", "KXDG", "KYDG")),
            ("block", ("KX", "KY", "KXD", "KYD")),
        )
        for row in m.table(kind)
    }


def shades(axes: Any) -> Any:
    """Colours of zones, and of the other blocks, of a picture of `stressed`."""
    (zones,) = (
        one for one in axes.collections if isinstance(one, PolyCollection) and one.get_zorder() == 2.4
    )
    (others,) = (
        one for one in axes.collections if isinstance(one, PathCollection) and one.get_zorder() == 2.4
    )
    return np.concatenate([zones.get_facecolor(), others.get_facecolor()])


@pytest.mark.parametrize(
    ("name", "label", "of"),
    [
        ("movement", "displacement", lambda row: np.hypot(row[:, 0], row[:, 1])),
        ("xdisplacement", "x displacement", lambda row: row[:, 0]),
        ("ydisplacement", "y displacement", lambda row: row[:, 1]),
        ("speed", "velocity", lambda row: np.hypot(row[:, 2], row[:, 3])),
        ("xvelocity", "x velocity", lambda row: row[:, 2]),
        ("yvelocity", "y velocity", lambda row: row[:, 3]),
    ],
)
def test_every_zone_and_block_has_the_colour_of_its_own_motion(name: str, label: str, of: Any) -> None:
    m, motion = moving()
    axes = m.figure(color=name)
    (strip,) = axes.child_axes
    wanted = of(motion)
    low, high, palette = wanted.min(), wanted.max(), "viridis"
    if name in ("movement", "speed"):
        low = 0.0
    elif low < 0 < high:
        low, high, palette = -abs(wanted).max(), abs(wanted).max(), "RdBu_r"
    unit = readable(IN_BLOCKS[name].unit, abs(wanted).max())
    assert strip.get_ylabel() == f"{label} ({unit.name})"
    assert strip.get_ylim() == pytest.approx((low / unit.size, high / unit.size), rel=1e-6)
    np.testing.assert_allclose(shades(axes), colormaps[palette]((wanted - low) / (high - low)), atol=0.03)


def test_arrows_have_a_scale_with_a_round_number() -> None:
    """The key of a round number is as much shorter than the longest arrow as the number is smaller."""
    m, _ = moving()
    axes = m.figure(arrows="velocity displacement", window=(-1.0, 4.0, -1.0, 2.0))
    keys = [one for one in axes.artists if isinstance(one, QuiverKey)]
    texts = [text.get_text() for text in axes.texts if "largest" in text.get_text()]  # not the g of gravity
    points = np.array([row[2:] for row in rows_of_points(m).values()])
    blocks_with_zones = 1  # the first row of the table: its centroid has no arrow
    assert len(keys) == 2
    for key, text in zip(keys, texts, strict=True):
        assert isinstance(key.Q, Quiver)
        assert np.size(key.Q.U) == len(points) - blocks_with_zones
        longest = np.hypot(key.Q.U, key.Q.V).max()
        assert longest == pytest.approx(0.08 * 5.0)
        number, unit, *_, largest, largest_unit = text.replace(";", "").split()
        assert number.strip("0.") in ("1", "2", "5")
        assert unit == largest_unit
        assert key.U / longest == pytest.approx(float(number) / float(largest), rel=1e-3)
    largest = np.hypot(*points.T).max()
    assert in_readable_units(float(largest), "m/s") in texts[0]


def test_stresses_and_safety_of_contacts_of_1980() -> None:
    """Force over length; cohesion and friction over the shear force, NaN where nothing is carried."""
    m = stack()
    m.property(1, cohesion=2e4)
    contacts = m.table("contact")["address"].tolist()
    for ic, (fn, fs) in zip(contacts, [(1e5, -4e4), (0.0, 0.0)], strict=True):
        putr(m.h, ic, g.KCFN, fn)
        putr(m.h, ic, g.KCFS, fs)
    joints = joint_results(m.h)  # each contact has half of the joint of 2 m
    assert OF_JOINTS["normalstress"].values(joints) == pytest.approx([1e5, 0.0])
    assert OF_JOINTS["shearstress"].values(joints) == pytest.approx([4e4, 0.0])
    safety = OF_JOINTS["safety"].values(joints)
    assert safety[0] == pytest.approx((2e4 + 0.5 * 1e5) / 4e4)
    assert np.isnan(safety[1])
    axes = m.figure(contacts="safety")
    assert [strip.get_ylim() for strip in axes.child_axes] == [(1.0, 3.0)]


@pytest.mark.parametrize(
    ("flags", "stress", "strength"),
    [
        (0, 2e4, 3e4 + 0.6 * 2e4),
        (g.JOINT_SLIPPED, 2e4, 1e3 + 0.4 * 2e4),
        (g.JOINT_BROKEN, 2e4, 1e3 + 0.4 * 2e4),
        (g.JOINT_SLIPPED, -1e4, min(1e3 - 0.4e4, 3e4 - 0.6e4)),
        (g.JOINT_BROKEN, 0.0, np.nan),
    ],
)
def test_stresses_and_safety_of_joint_materials(flags: int, stress: float, strength: float) -> None:
    """Peak strength until the first slip or opening, then the residual one, and never below 0."""
    m = stack(friction=0.6, cohesion=3e4, tension=2e4, residual_friction=0.4, residual_cohesion=1e3)
    for ix in m.table("joint")["address"].tolist():
        puti(m.h, ix, g.KCJFLAG, flags)
        putr(m.h, ix, g.KCJSN, stress)
        putr(m.h, ix, g.KCJTS, -8e3)
    rows = joint_results(m.h).stress
    assert rows["normal"] == pytest.approx(stress)
    assert rows["shear"] == pytest.approx(8e3)
    assert rows["safety"] == pytest.approx(
        max(strength, 0.0) / 8e3 if strength == strength else np.nan, nan_ok=True
    )


def test_axes_of_the_user_and_new_ones(tmp_path: Path) -> None:
    """The axes that are drawn on come back; pyplot does not hear of new ones, and no file is written."""
    m = stressed()
    m.session.out = tmp_path
    mine = Figure((9, 4)).add_subplot()
    assert m.figure(mine, contacts="state", arrows="force") is mine
    assert (*mine.get_xlim(), *mine.get_ylim()) == pytest.approx((-0.12, 3.12, -0.12, 1.12))
    assert mine.get_aspect() == 1.0
    assert m.figure() is not mine
    assert (pyplot.get_fignums(), list(tmp_path.iterdir())) == ([], [])


@pytest.mark.parametrize("gravity", [(0.0, -10.0), (0.0, 0.0), (3.0, -10.0), (0.0, 10.0), (-5.0, 0.0)])
def test_a_gravity_that_does_not_point_down_is_shown(gravity: tuple[float, float]) -> None:
    m = stressed()
    m.gravity(*gravity)
    arrows = [one for one in m.figure().patches if isinstance(one, FancyArrow)]
    assert len(arrows) == (gravity[0] != 0 or gravity[1] > 0)
    for arrow in arrows:
        way = np.array([arrow._dx, arrow._dy])  # type: ignore[attr-defined]
        np.testing.assert_allclose(way / np.hypot(*way), np.array(gravity) / np.hypot(*gravity), atol=1e-6)


def test_displacements_and_slip_since_a_stage(tmp_path: Path) -> None:
    m = stack()
    m.session.out = tmp_path
    m.gravity(20, -10)
    m.cycle(30)
    m.stage("before")
    slip, before = m.table("contact")["KCS"], m.table("block")
    m.cycle(200)
    axes = m.figure(color="movement", contacts="slip", since="before")
    now = m.table("block")
    moved = np.hypot(now["KX"] - before["KX"], now["KY"] - before["KY"]).max()
    limits = {strip.get_ylabel(): strip.get_ylim() for strip in axes.child_axes}
    for label, largest in (
        ("displacement", moved),
        ("slip since before", np.abs(m.table("contact")["KCS"] - slip).max()),
    ):
        unit = readable("m", largest)
        assert limits[f"{label} ({unit.name})"] == pytest.approx((0.0, largest / unit.size), rel=1e-6)


def test_since_takes_the_path_of_a_restart_file(tmp_path: Path) -> None:
    """One picture is written, or none; a deck looks for the file in the folder for files, as SAVE does."""
    m = stack()
    m.session.out = tmp_path
    m.save(tmp_path / "before.h5")
    m.cycle(5)
    assert [path.name for path in m.plot(since=str(tmp_path / "before.h5"))] == [
        "udec-plot-1.png",
        "udec-plot-1.svg",
    ]
    m.run("PLOT 0 SINCE ./before.h5")
    written = sorted(tmp_path.iterdir())
    with pytest.raises(UdecError, match="window is empty"):
        m.plot(since=str(tmp_path / "before.h5"), window=(1, 1, 0, 1))
    assert sorted(tmp_path.iterdir()) == written
    assert (tmp_path / "udec-plot-2.png").exists()


def test_what_the_state_has_counts_unless_a_stage_is_named(tmp_path: Path) -> None:
    """Also while a frame of PLOT that began with SINCE is open."""
    m = stack()
    m.session.out = tmp_path
    m.gravity(20, -10)
    m.displacements()
    m.cycle(50)
    m.stage("later")
    m.cycle(50)
    m.plot(since="later")
    rows = m.table("displacement")
    largest = np.hypot(rows["KBDX"], rows["KBDY"]).max()
    (scale,) = m.figure(color="movement").child_axes
    assert scale.get_ylim()[1] == pytest.approx(largest / readable("m", largest).size, rel=1e-6)


def test_one_value_everywhere_has_the_colour_that_its_scale_shows() -> None:
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=1e8)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.change("ALL", type="sdef")
    m.insitu("ALL", s22=-2e6)
    axes = m.figure(color="s22")
    (scale,) = axes.child_axes
    low, high = scale.get_ylim()
    shown = colormaps["viridis"]((-2.0 - low) / (high - low))
    drawn = [colour for one in axes.collections for colour in one.get_facecolor()]
    assert any(np.allclose(colour, shown) for colour in drawn)


@pytest.mark.parametrize(
    ("words", "number", "parameter", "known"),
    [
        ({"color": "slip"}, 10, "color", IN_BLOCKS),
        ({"contacts": "s11"}, 10, "contacts", OF_JOINTS),
        ({"arrows": "force speed"}, 10, "arrows", ("displacement", "velocity", "force")),
        ({"contacts": "flow"}, 26, "contacts", ()),
        ({"color": "movement"}, 26, "since", ()),
        ({"window": (1.0, 0.0, 0.0, 1.0)}, 28, "window", ()),
        ({"window": np.array([1.0, 0.0, 0.0, 1.0])}, 28, "window", ()),
        ({"window": (1.0, 0.0, 0.0)}, 26, "window", ()),
        ({"arrows": ["force", "speed"]}, 10, "arrows", ()),
    ],
)
def test_errors_name_the_words(words: dict[str, Any], number: int, parameter: str, known: Any) -> None:
    with pytest.raises(UdecError) as caught:
        stressed().figure(**words)
    assert (caught.value.number, caught.value.parameter) == (number, parameter)
    assert all(word in str(caught.value) for word in known)


@pytest.mark.parametrize("many", [False, True])
def test_what_has_many_parts_is_an_image_in_the_svg(many: bool, tmp_path: Path) -> None:
    figure = Figure((3, 3))
    axes = figure.add_subplot()
    lines = np.zeros((MANY + many, 2, 2))
    lines[:, 1] = 1.0
    axes.add_collection(LineCollection(list(lines)))
    png, svg = write(figure, tmp_path / "lines")
    assert png.stat().st_size > 0
    assert ("<image" in svg.read_text()) == many


def test_a_deck_writes_a_picture_when_it_begins_and_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not with each PLOT 1 that follows soon; from Python each call writes it."""
    written: list[int] = []
    save = Frame.save

    def saved(frame: Frame, base: Path) -> list[Path]:
        written.append(len(frame.states))
        return save(frame, base)

    monkeypatch.setattr(Frame, "save", saved)
    m = Model(out=tmp_path)
    printed = m.run("START\nBLOCK 0,0 0,1 1,1 1,0\nPLOT 0\nPLOT 1\nPLOT 1\nPLOT 0\nPLOT 1\n")
    assert written == [1, 3, 1, 2]
    assert printed is not None
    assert printed.count("written: ") == 6
    m.plot(1)
    assert written[4:] == [3]
    monkeypatch.setattr("udec_ia.output.plot_frames.PAUSE", 0.0)
    m.run("PLOT 1\nPLOT 1\n")
    assert written[5:] == [4, 5]


def test_the_scale_is_that_of_what_the_window_shows() -> None:
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8, bulk=1e8, g=1e8)
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.split(1, -1, 1, 2)
    m.change("ALL", type="sdef")
    m.insitu(0, 1, 0, 1, s22=-1e6)
    m.insitu(1, 2, 0, 1, s22=-9e6)
    for window, low, high in (((-0.5, 1.0, -0.2, 1.2), -1.1, -0.9), (None, -9.0, -1.0)):
        (scale,) = m.figure(color="s22", window=window).child_axes
        assert scale.get_ylim() == pytest.approx((low, high), rel=1e-6)


def test_arrows_of_blocks_that_hardly_move_are_left_out() -> None:
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 1, 2, 1, 2, 0)
    m.split(1, -1, 1, 2)
    m.velocity(0, 1, 0, 1, 1.0, 0.0, 0.0)
    (arrows,) = (one for one in m.figure(arrows="velocity").collections if isinstance(one, Quiver))
    assert arrows.N == 1


def test_keys_have_room_in_a_figure_with_several_axes() -> None:
    m = stack()
    m.cycle(1)
    figure = Figure((12, 5), layout="constrained")
    left, right = figure.subplots(1, 2)
    m.figure(left, color="speed", contacts="state")
    m.figure(right, contacts="slip")
    figure.savefig(io.BytesIO())
    (key,) = (one for one in left.get_children() if isinstance(one, Legend))
    assert left.bbox.x1 < key.get_window_extent().x0
    assert key.get_window_extent().x1 < right.bbox.x0
