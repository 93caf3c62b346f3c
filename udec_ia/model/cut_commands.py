"""Methods of Model that cut blocks: lines, curves and patterns, BREAKAGE; and TIDY, which merges slivers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypedDict, Unpack

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.layout import offsets as g
from udec_ia.model.block_commands import warn_of_lost_conditions
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands.boundary_command import number_of_conditions
from udec_ia.ops.commands.breakage_command import break_blocks, joint_of_cracks, keep_whole
from udec_ia.ops.commands.joint_property_command import add_joints, jmaterial_number
from udec_ia.ops.common.number_limits import real, rows, whole
from udec_ia.ops.cuts import patterns
from udec_ia.ops.cuts.block_division import Reals
from udec_ia.ops.cuts.cut_blocks import Cuts
from udec_ia.ops.cuts.cut_command import (
    CutWords,
    cut,
    cut_joints,
    cut_lines,
    cut_lines_of_joints,
    split_or_keep,
)
from udec_ia.ops.cuts.fracture_file import read_fractures
from udec_ia.ops.cuts.joint_of_cut import free_joint
from udec_ia.ops.cuts.merge_slivers import Tidied, merge_slivers
from udec_ia.printable_text import counted
from udec_ia.reader.fracture_rows import cracks_made
from udec_ia.reader.group_ranges import range_of, read_range
from udec_ia.reader.range_region import region_of
from udec_ia.remark import Remark

SHOWN = 3  # places that a remark names
Limits = tuple[float, float, float, float]
Value = float | tuple[float, float]
Within = Limits | str  # a range


class OfCut(TypedDict, total=False):
    """What the cuts belong to: a joint, by number, with a joint material; or glue, which leaves the rock as
    strong as it was. keep: ends inside blocks are kept for later cuts.
    """

    joint: int | None
    jmaterial: int | None
    glued: bool | None
    keep: bool | None


def _words(values: OfCut) -> CutWords:
    given = CutWords(values.get("joint"), values.get("jmaterial"))
    return given._replace(glued=bool(values.get("glued")), keep=bool(values.get("keep")))


def split(
    session: Session,
    x1: float,
    y1: float,
    x2: float,
    y2: float,
    joint: int | None = None,
    jmaterial: int | None = None,
) -> int:
    """SPLIT: cut all blocks in the path of the line. Returns the number of new blocks (0: `why_none`).

    A line that cuts no block, but has ends inside blocks, is kept for later cuts.
    """
    session.ensure_ready(shapes=True)
    ends = x1, y1, x2, y2
    done = split_or_keep(session.array, session.split_boxes, ends, joint, jmaterial)
    _report(session, done, True)
    return done.blocks


@takes_keywords(OfCut)
def polyline(session: Session, *xy: float, **words: Unpack[OfCut]) -> int:
    """POLYLINE: cut all blocks along the line x1, y1, x2, y2, ... Returns the number of new blocks."""
    if len(xy) < 4 or len(xy) % 2:
        raise UdecError(8, f"{counted(len(xy), 'coordinate')} given", "give x1, y1, x2, y2, ...")
    points = np.array(rows(2, xy=np.reshape(xy, (-1, 2)).tolist()), np.float64)
    kept = np.append(True, np.diff(points, axis=0).any(axis=1))
    if kept.sum() < 2:
        raise UdecError(28, "all points are the same", "give two different points", parameter="x1")
    return _cut(session, [points[kept]], words)


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
    """ARC: cut all blocks along an arc of `n` chords about (xc, yc). Returns the number of new blocks.

    It begins at (x1, y1) and turns by `angle` degrees, anticlockwise if that is positive.
    """
    return _cut(session, [patterns.arc(xc, yc, x1, y1, angle, whole(n=n))], words)


@takes_keywords(OfCut)
def tunnel(
    session: Session, x: float, y: float, r: float, n: int | None = None, **words: Unpack[OfCut]
) -> int:
    """TUNNEL: cut a circle of radius `r` about (x, y), of `n` chords (24). Returns as `polyline`."""
    return _cut(session, [patterns.circle(x, y, r, 24 if n is None else whole(n=n))], words)


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
    """JSET: cut a set of parallel joints. Returns the number of new blocks.

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
        done = cut_lines(session.array, session.split_boxes, lines, _words(words))
        _report(session, done, False)
        return done.blocks
    if within is not None:
        pieces = shapely.get_parts(shapely.intersection(shapely.linestrings(lines), region))
        lines = [shapely.get_coordinates(one) for one in pieces if one.length]
    return _cut(session, lines, words, True)


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
    """VORONOI: cut blocks into Voronoi cells with edges of about `edge`. Returns the number of new blocks.

    seed: of the generator of the points. within: limits x1, x2, y1, y2 or a range in words, whose limits are
    cut too.
    """
    region = _region(session, within)
    if region is None:
        return 0
    lines = patterns.voronoi_edges(region, edge, _seed(seed))
    if within is not None:
        inside = shapely.get_parts(shapely.intersection(shapely.linestrings(lines), region))
        limits = [shapely.get_coordinates(ring) for ring in shapely.get_parts(region.boundary)]
        lines = limits + [shapely.get_coordinates(one) for one in inside if one.length]  # limits come first
    return _cut(session, lines, words, True)


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
    """BRICKS: cut bricks in running bond in a range. Returns the number of new blocks.

    length, height: of a brick in m. offset: part of a brick by which every second course is moved. bed, head:
    joint materials of bed and head joints.
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
    _report(session, done, False)
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
    """VOUSSOIRS: cut an arch of `n` stones out of blocks. Returns the number of new blocks.

    The inner line is an arc from (x1, y) to (x2, y), of that rise or of that radius; the outer line is
    `thickness` away from it.
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
    return _cut(session, [inner, outer, *joints], words)


def fractures(session: Session, path: str | Path, *, glued: bool = False, keep: bool = False) -> int:
    """FRACTURES: cut along the lines in a file, CSV or GeoJSON. Returns the number of new blocks.

    glued: lines for which the file gives no joint. keep: ends inside blocks are kept for later cuts.
    """
    session.ensure_ready(shapes=True)
    found = read_fractures(Path(path))
    ignored = f", {counted(found.ignored, 'feature')} without lines ignored" if found.ignored else ""
    session.inform(f"{counted(len(found.lines), 'line')} in {path}{ignored}")
    words = CutWords(glued=glued, keep=keep)
    done = cut_lines_of_joints(session.array, session.split_boxes, found.lines, found.joints, words)
    _report(session, done, keep)
    return done.blocks


def tidy(session: Session, a: float) -> Tidied:
    """TIDY: merge blocks smaller than the area `a` (m2) into neighbours, before zones and cycles.

    Returns
    -------
    Tidied
        `merged` and `left`: slivers with `area` (m2), `x`, `y`. Error 26 after the first cycle.
    """
    session.ensure_ready(shapes=True)
    session.forget_boxes()
    conditions = number_of_conditions(session.array.h)
    done = merge_slivers(session.array, real(a=a))
    warn_of_lost_conditions(session, conditions)
    if done.left:
        one = done.left[0]
        what = counted(len(done.left), "small block")
        text = f"{what} left, with zones or without a neighbour that fits: at ({one.x:.6g}, {one.y:.6g})"
        session.tell(Remark("slivers-left", text + (", ..." if len(done.left) > 1 else "")))
    return done


def breakage(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    state: str = "on",
    *,
    tension: float | None = None,
    cohesion: float | None = None,
    friction: float | None = None,
    smallest: float | None = None,
    jmaterial: int | None = None,
) -> int:
    """BREAKAGE: the blocks in the range may crack from now on, or not any more. Returns their number.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    state
        "on" or "off".
    tension, cohesion, friction
        Strength in Pa, and a tangent. What is not given does not break a block. Rigid blocks break by tension
        between two contact forces, deformable ones also by their stress.
    smallest
        Area in m2 of the smallest part that a crack may leave.
    jmaterial
        Joint material of cracks; without it they have that of the contacts between two such blocks.

    Raises
    ------
    UdecError
        1, 4, 7, 10 or 28. Nothing is changed then.
    """
    session.ensure_ready(shapes=True)
    array, where = session.array, range_of(x1, x2, y1, y2)
    strength = {"tension": tension, "cohesion": cohesion, "friction": friction}
    if state.lower() not in ("on", "off"):
        raise UdecError(10, f"BREAKAGE {state}", "ON or OFF", parameter="state")
    if state.lower() == "off":
        if {*strength.values(), smallest, jmaterial} != {None}:
            raise UdecError(10, "a strength with OFF", "give OFF alone", parameter="state")
        return keep_whole(array, where)
    joint = 0
    if jmaterial is not None:
        joint = joint_of_cracks(array, jmaterial_number(array, jmaterial)) or free_joint(array)
        add_joints(array)
    done = break_blocks(array, where, joint, smallest, **strength)
    if done and jmaterial is not None:
        array.h.ci[g.JLINE + joint - 1] = jmaterial
    return done


def cracks(session: Session) -> Any:
    """The cracks that runs have made, the earliest first.

    Returns
    -------
    numpy.ndarray
        Structured array with `crack` (address), `cycle`, `time` (s), `x1`, `y1`, `x2`, `y2` (m, both ends
        where they were then), `cause` ("forces", "tension", "shear") and `energy` (J/m), which it took.
    """
    session.ensure_ready()
    return cracks_made(session.array.h)


def _cut(session: Session, lines: Sequence[Reals], words: OfCut, leave_out: bool = False) -> int:
    """Cut along the lines, and report. Returns the number of new blocks."""
    session.ensure_ready(shapes=True)
    given = _words(words)
    done = cut(session.array, session.split_boxes, lines, given, leave_out)
    _report(session, done, given.keep)
    return done.blocks


def _report(session: Session, done: Cuts, keep: bool) -> None:
    """Report ends inside blocks, slits, what was left out, and new zones."""
    if done.dead_ends:
        many = len(done.dead_ends)
        lengths = [float(np.hypot(*np.diff(end, axis=0).T).sum()) for end, _ in done.dead_ends]
        longest = done.dead_ends[int(np.argmax(lengths))][0][-1]
        verb = "is" if many == 1 else "are"
        what = f"{verb} kept for later cuts" if keep else f"{verb} dropped; KEEP keeps them"
        place = "{:.3g} m, ends at ({:g}, {:g})".format(max(lengths), *longest)
        session.inform(f"{counted(many, 'dead end')} inside blocks {what}; the longest, {place}")
    if done.slits:
        session.inform(f"{counted(done.slits, 'glued slit')} from outlines that close inside blocks")
    if done.left_out:
        places = ", ".join(f"({one.x:.6g}, {one.y:.6g})" for one in done.left_out[:SHOWN])
        more = ", ..." if len(done.left_out) > SHOWN else ""
        text = (
            f"left out where they leave too short an edge or too sharp an angle, {len(done.left_out)} times: "
        )
        session.tell(Remark("cuts-left-out", text + places + more))
    if done.zoned:
        what = counted(len(done.zoned), "block") + " with zones"
        before, after = sum(one.before for one in done.zoned), sum(one.after for one in done.zoned)
        angle, x, y = min(one.sharpest for one in done.zoned)
        energy = sum(one.energy for one in done.zoned)
        session.inform(
            f"{what} cut: {before} zones became {after}, the least angle is {angle:.1f} degrees, at "
            f"({x:.4g}, {y:.4g}); the stored energy changed by {energy:.3g} J/m"
        )
