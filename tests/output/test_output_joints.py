"""Pictures of joints: lines, slip, opening and state against the numbers of contacts and joints."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.legend import Legend

from udec_ia import Model, UdecError
from udec_ia.heap.accessors import puti, putr
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets as g
from udec_ia.output.drawn_outlines import joint_results, snapshot
from udec_ia.output.joint_drawing import COLOURS, THICK, THIN
from udec_ia.output.plot_frames import Frame, What
from udec_ia.reader.drawable_quantities import OF_JOINTS
from udec_ia.reader.joint_rows import STATES, joint_rows

WIDE, D = 4.0, 0.1
STATES_BY_NUMBER = [*STATES]


def stack(scheme: str = "i32r64", **joint: float) -> Model:
    """A block of 2 m on one of 4 m, in the middle; with a joint material if it is given."""
    m = Model(build=scheme)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    if joint:
        m.jproperty(1, **{"kn": 1e8, "ks": 1e8, **joint})
    m.block(0, 0, 0, 2, WIDE, 2, WIDE, 0)
    m.split(-1, 1, WIDE + 1, 1, **({"joint": 1, "jmaterial": 1} if joint else {}))
    m.split(1, 1, 1, 3)
    m.split(3, 1, 3, 3)
    m.delete(0, 1, 1, 2)
    m.delete(3, 4, 1, 2)
    m.fix(0, WIDE, 0, 1)
    m.round(D)
    return m


def by_place(m: Model) -> Any:
    """Lines and rows of the picture in the order of the contacts along x."""
    found = joint_results(m.h)
    order = np.argsort(found.line[:, 1, 0])
    return found.line[order], found.rows[order]


@pytest.mark.parametrize("scheme", ALL_SCHEMES)
def test_lines_meet_half_way_and_end_at_the_corners(scheme: str) -> None:
    """The joint of 2 m: contacts D inside its ends share it."""
    line, rows = by_place(stack(scheme))
    left, right = (one[np.argsort(one[:, 0])] for one in line)
    assert left == pytest.approx(np.array([[1, 1], [1 + D, 1], [2, 1]]), abs=1e-5)
    assert right == pytest.approx(np.array([[2, 1], [3 - D, 1], [3, 1]]), abs=1e-5)
    assert len(rows) == 2


def test_a_contact_alone_is_twice_the_rounding_long() -> None:
    """A triangle that stands on its corner."""
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.block(0, 0, 0, 2, 4, 2, 4, 0)
    m.split(-1, 1, 5, 1)
    m.split(2, 1, 0.8, 2.2)
    m.split(2, 1, 3.2, 2.2)
    blocks = m.table("block")
    for x in blocks["KX"][(blocks["KY"] > 1) & (np.abs(blocks["KX"] - 2) > 0.1)]:
        m.delete(float(x) - 0.01, float(x) + 0.01, 1, 2)
    m.round(D)
    line, rows = by_place(m)
    assert len(rows) == 1
    assert np.hypot(*(line[0, 0] - line[0, 2])) == pytest.approx(2 * D)


def test_contacts_of_1980_show_their_own_numbers() -> None:
    m = stack()
    rows = m.table("contact")
    for row, (n, s, fn, fs) in zip(
        rows["address"].tolist(), [(2e-3, -3e-3, 1e5, -5e4), (-4e-3, 1e-3, 0, 0)], strict=True
    ):
        for field, value in ((g.KCN, n), (g.KCS, s), (g.KCFN, fn), (g.KCFS, fs)):
            putr(m.h, row, field, value)
    found = joint_results(m.h)
    assert found.rows["contact"].tolist() == rows["address"].tolist()
    assert OF_JOINTS["slip"].values(found) == pytest.approx([3e-3, 1e-3])
    assert OF_JOINTS["opening"].values(found) == pytest.approx([0, 4e-3])
    assert [STATES_BY_NUMBER[k] for k in OF_JOINTS["state"].values(found)] == ["slips", "open"]
    putr(m.h, int(rows["address"][0]), g.KCFS, -4.99e4)
    assert [STATES_BY_NUMBER[k] for k in joint_rows(m.h)["state"]] == ["closed", "open"]


@pytest.mark.parametrize(
    ("flags", "stress", "state", "broken"),
    [
        (0, -1.0, "closed", False),  # it holds a tension
        (g.JOINT_SLIPPED, 1.0, "slipped", False),
        (g.JOINT_SLIPPED | g.JOINT_SLIPS, 1.0, "slips", False),
        (g.JOINT_BROKEN, 1.0, "broken", True),
        (g.JOINT_BROKEN | g.JOINT_SLIPPED, 1.0, "broken", True),
        (g.JOINT_BROKEN | g.JOINT_SLIPPED | g.JOINT_SLIPS, 1.0, "slips", True),
        (g.JOINT_BROKEN | g.JOINT_GIVEN, 0.0, "open", True),
    ],
)
def test_joints_with_a_material_show_theirs(flags: int, stress: float, state: str, broken: bool) -> None:
    m = stack(tension=1e4, cohesion=1e4)
    contacts, joints = m.table("contact")["address"], m.table("joint")["address"]
    for ic, ix in zip(contacts.tolist(), joints.tolist(), strict=True):
        puti(m.h, ix, g.KCJFLAG, flags)
        putr(m.h, ix, g.KCJSN, stress)
        putr(m.h, ix, g.KCJOFF, -4e-3)
        putr(m.h, ic, g.KCN, -1e-3)
        putr(m.h, ic, g.KCS, -7e-3)
    rows = joint_rows(m.h)
    assert rows["slip"] == pytest.approx(-7e-3)
    assert rows["opening"] == pytest.approx(5e-3)
    assert {STATES_BY_NUMBER[k] for k in rows["state"]} == {state}
    assert (rows["broken"] == broken).all()


@pytest.mark.parametrize("name", ["slip", "opening", "state"])
@pytest.mark.parametrize("joint", [{}, {"tension": 1e4}])
def test_the_picture_has_a_line_for_each_contact_and_a_key(name: str, joint: dict[str, float]) -> None:
    m = stack(**joint)
    for k, row in enumerate(m.table("contact")["address"].tolist()):
        putr(m.h, row, g.KCS, 1e-3 * k)
        putr(m.h, row, g.KCN, -2e-3 * k)
    frame = Frame("joints")
    frame.add(snapshot(m.h, inside=True, joints=True), What(joints=name, contour="s11"))
    figure = frame.figure()
    (drawn,) = (c for c in figure.axes[0].collections if isinstance(c, LineCollection))
    lines = joint_results(m.h).line
    assert len(drawn.get_segments()) == len(lines) == 2
    widths = [float(width) for width in drawn.get_linewidths()]
    if name != "state":
        assert sorted(widths) == pytest.approx([THIN, THICK])
        (strip,) = (axes for axes in figure.axes[0].child_axes if axes.get_ylabel() == f"{name} (mm)")
        assert strip.get_ylim() == pytest.approx((0, 1 if name == "slip" else 2))
    else:
        (legend,) = (one for one in figure.axes[0].artists if isinstance(one, Legend))
        texts = [text.get_text() for text in legend.get_texts()]
        assert [text.partition(":")[0] for text in texts] == [*STATES]
        assert len(texts) == len(COLOURS)


def test_words_of_a_deck(tmp_path: Path) -> None:
    """SLIP, OPENING and STATE; S and ST are still stresses; unknown words in Python are error 10."""
    m = Model(out=tmp_path)
    m.run("START\nBLOCK 0,0 0,2 2,2 2,0\nSPLIT -1,1 3,1\n")
    for words, what in (
        ("SL", What(joints="slip")),
        ("OPENING", What(joints="opening")),
        ("STATE", What(joints="state")),
        ("ST", What(stresses=True)),
        ("S", What(stresses=True)),
        ("SH", What(contour="shear")),
    ):
        m.run(f"PLOT 0 {words}\n")
        assert m.session.plots is not None
        assert m.session.plots.frame is not None
        assert m.session.plots.frame.what == what
    for wrong in ({"joints": "stress"}, {"contour": "slip"}):
        with pytest.raises(UdecError) as raised:
            m.plot(**wrong)
        assert raised.value.number == 10
