"""Methods of Model that cut blocks in patterns: ARC, TUNNEL, JSET, VORONOI, BRICKS, VOUSSOIRS."""

from __future__ import annotations

from typing import Any, Unpack

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.model.cut_commands import OfCut, cut_along, report_cuts, words_of
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands.joint_property_command import jmaterial_number
from udec_ia.ops.common.number_limits import whole
from udec_ia.ops.cuts import patterns
from udec_ia.ops.cuts.cut_command import cut_joints, cut_lines
from udec_ia.ops.cuts.joint_of_cut import free_joint
from udec_ia.reader.group_ranges import read_range
from udec_ia.reader.range_region import region_of

Limits = tuple[float, float, float, float]
Value = float | tuple[float, float]
Within = Limits | str  # a range


@takes_keywords(OfCut)
def arc(
    session: Session,
    xc: float,
    yc: float,
    x1: float,
    y1: float,
    angle: float,
    n: int,
    **words: Unpack[OfCut],
) -> int:
    """ARC: cut all blocks along an arc.

    Parameters
    ----------
    xc, yc, x1, y1
        Its centre and its first point, in m.
    angle
        By which it turns, in degrees, anticlockwise if that is positive.
    n
        Number of its chords.
    words
        joint, jmaterial, glued, keep (OfCut).

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.arc(0, 3, 0, 1.4, 90, 4)
    1
    """
    return cut_along(session, [patterns.arc(xc, yc, x1, y1, angle, whole(n=n))], words)


@takes_keywords(OfCut)
def tunnel(
    session: Session, x: float, y: float, r: float, n: int | None = None, **words: Unpack[OfCut]
) -> int:
    """TUNNEL: cut a circle.

    Parameters
    ----------
    x, y, r
        Its centre and radius in m.
    n
        Number of its chords (24).
    words
        joint, jmaterial, glued, keep (OfCut).

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.tunnel(1, 1, 0.4, 8)  # half of it in each block
    2
    """
    return cut_along(session, [patterns.circle(x, y, r, 24 if n is None else whole(n=n))], words)


@takes_keywords(OfCut)
def jset(
    session: Session,
    angle: Value,
    *,
    spacing: Value | None = None,
    trace: Value = 0.0,
    gap: Value = 0.0,
    origin: tuple[float, float] = (0.0, 0.0),
    seed: int = 1,
    within: Within | None = None,
    **words: Unpack[OfCut],
) -> int:
    """JSET: cut a set of parallel joints.

    Parameters
    ----------
    angle, spacing, trace, gap
        Angle from the x-axis in degrees; distances in m. Each a number, or a pair of it and a deviation,
        within which values are drawn evenly. Without a trace the joints are endless.
    origin
        A joint begins there.
    seed
        Of the generator of the deviations.
    within
        Limits x1, x2, y1, y2 or a range in words, at whose limits the joints end.
    words
        joint, jmaterial, glued, keep (OfCut).

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.jset(90, spacing=1, origin=(0.5, 0))
    4
    """
    if spacing is None:
        raise UdecError(7, "SPACING s", "JSET ANGLE a SPACING s", parameter="angle")
    for name, given in {"spacing": spacing, "trace": trace, "gap": gap}.items():
        value, deviation = _pair(given)
        if not 0 <= deviation <= value and (value or deviation):
            detail = f"{name} {value:g} with a deviation of {deviation:g}"
            raise UdecError(28, detail, "give a deviation from 0 to the value", parameter=name)
    angles, spacings, traces, gaps = (_pair(value) for value in (angle, spacing, trace, gap))
    joints = patterns.JointSet(angles, spacings, traces, gaps, _pair(origin))
    region = _region(session, within)
    if region is None:
        return 0
    low, high = np.array(region.bounds).reshape(2, 2)
    lines = patterns.joint_lines(joints, low, high, _seed(seed))
    if within is None and traces[0] == 0:
        done = cut_lines(session.array, session.split_boxes, lines, words_of(words))
        report_cuts(session, done, False)
        return done.blocks
    if within is not None:
        pieces = shapely.get_parts(shapely.intersection(shapely.linestrings(lines), region))
        lines = [shapely.get_coordinates(one) for one in pieces if one.length]
    return cut_along(session, lines, words, True)


def _seed(seed: int) -> int:
    """A seed; error 28 for a negative one."""
    if whole(seed=seed) < 0:
        raise UdecError(28, f"seed {seed}", "give 0 or more", parameter="seed")
    return seed


def _pair(value: Any) -> tuple[float, float]:
    """A value and its deviation, 0 if none is given."""
    row = np.atleast_1d(np.asarray(value, np.float64))
    if row.shape not in ((1,), (2,)) or not np.isfinite(row).all():
        raise UdecError(28, f"{value}", "give a number, or a number and its deviation")
    return float(row[0]), float(row[1]) if len(row) == 2 else 0.0


def _region(session: Session, within: Within | None) -> Any:
    """The region of the range, or a rectangle around all blocks; None if there are no blocks."""
    session.ensure_ready(shapes=True)
    boxes = session.split_boxes
    boxes.enter(session.array)
    if boxes.n == 0:
        return None
    if within is None or isinstance(within, str):
        low, high = boxes.boxes[: boxes.n, :2].min(axis=0), boxes.boxes[: boxes.n, 2:].max(axis=0)
        frame = shapely.box(*low.tolist(), *high.tolist())
        return frame if within is None else region_of(session.array, read_range(within), frame)
    x1, x2, y1, y2 = within
    if not (x1 < x2 and y1 < y2):
        raise UdecError(28, "the range is empty", "a range is x1 x2 y1 y2", parameter="within")
    return shapely.box(x1, y1, x2, y2)


@takes_keywords(OfCut)
def voronoi(
    session: Session,
    edge: float,
    *,
    seed: int = 1,
    within: Within | None = None,
    **words: Unpack[OfCut],
) -> int:
    """VORONOI: cut blocks into Voronoi cells.

    Parameters
    ----------
    edge
        Length of their edges in m, about.
    seed
        Of the generator of the points.
    within
        Limits x1, x2, y1, y2 or a range in words, whose limits are cut too.
    words
        joint, jmaterial, glued, keep (OfCut).

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.voronoi(0.5, seed=3) > 5
    True
    """
    region = _region(session, within)
    if region is None:
        return 0
    lines = patterns.voronoi_edges(region, edge, _seed(seed))
    if within is not None:
        inside = shapely.get_parts(shapely.intersection(shapely.linestrings(lines), region))
        limits = [shapely.get_coordinates(ring) for ring in shapely.get_parts(region.boundary)]
        lines = limits + [shapely.get_coordinates(one) for one in inside if one.length]  # limits come first
    return cut_along(session, lines, words, True)


def bricks(
    session: Session,
    x1: float,
    x2: float,
    y1: float,
    y2: float,
    *,
    length: float | None = None,
    height: float | None = None,
    offset: float = 0.5,
    bed: int | None = None,
    head: int | None = None,
) -> int:
    """BRICKS: cut bricks in running bond.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m.
    length, height
        Of a brick in m.
    offset
        Part of a brick by which every second course is moved.
    bed, head
        Joint materials of bed and head joints.

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.bricks(0, 2, 1, 2, length=1, height=0.5)
    4
    """
    session.ensure_ready(shapes=True)
    if length is None or height is None:
        missing = "LENGTH b" if length is None else "HEIGHT h"
        raise UdecError(7, missing, "BRICKS x1 x2 y1 y2 LENGTH=b HEIGHT=h", parameter="x1")
    array = session.array
    numbers: list[int] = []
    lines = patterns.running_bond((x1, x2, y1, y2), length, height, offset)
    for material in (bed, head):
        number = 0
        if material is not None:
            jmaterial_number(array, material)
            number = free_joint(array, besides=numbers)
        numbers.append(number)
    joints = [(line, number) for part, number in zip(lines, numbers, strict=True) for line in part]
    materials = {number: m for number, m in zip(numbers, (bed, head), strict=True) if m is not None}
    done = cut_joints(array, session.split_boxes, joints, materials)
    report_cuts(session, done, False)
    return done.blocks


@takes_keywords(OfCut)
def voussoirs(
    session: Session,
    x1: float,
    x2: float,
    y: float,
    n: int,
    *,
    rise: float | None = None,
    radius: float | None = None,
    thickness: float | None = None,
    **words: Unpack[OfCut],
) -> int:
    """VOUSSOIRS: cut an arch out of blocks.

    Parameters
    ----------
    x1, x2, y
        The inner line is an arc from (x1, y) to (x2, y), in m.
    n
        Number of stones.
    rise, radius
        One of these two of the inner line, in m.
    thickness
        Distance in m of the outer line from it.
    words
        joint, jmaterial, glued, keep (OfCut).

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.voussoirs(0.5, 1.5, 1, 3, rise=0.4, thickness=0.3)
    4
    """
    if thickness is None:
        raise UdecError(7, "THICKNESS t", "VOUSSOIRS x1 x2 y n RISE=h THICKNESS=t", parameter="x1")
    if (rise is None) == (radius is None):
        raise UdecError(7, "RISE h or RADIUS r", "give one of them", parameter="x1")
    if radius is not None:
        if not 2 * radius >= x2 - x1 > 0:
            detail = f"the radius is {radius:g}, the span {x2 - x1:g}"
            raise UdecError(28, detail, "give at least half the span", parameter="radius")
        rise = radius - float(np.sqrt(radius**2 - (x2 - x1) ** 2 / 4))
    assert rise is not None
    inner, outer, joints = patterns.voussoir_arch(x1, x2, y, rise, thickness, whole(n=n))
    return cut_along(session, [inner, outer, *joints], words)
