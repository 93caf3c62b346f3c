"""Methods of Model that cut blocks along lines: SPLIT, POLYLINE, FRACTURES; TIDY, which merges slivers."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TypedDict, Unpack

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.model.block_commands import warn_of_lost_conditions
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands.boundary_command import number_of_conditions
from udec_ia.ops.common.number_limits import real, rows
from udec_ia.ops.cuts.block_division import Reals
from udec_ia.ops.cuts.cut_blocks import Cuts
from udec_ia.ops.cuts.cut_command import (
    CutWords,
    cut,
    cut_lines_of_joints,
    split_or_keep,
)
from udec_ia.ops.cuts.fracture_file import read_fractures
from udec_ia.ops.cuts.merge_slivers import Tidied, merge_slivers
from udec_ia.printable_text import counted
from udec_ia.remark import Remark

SHOWN = 3  # places that a remark names


class OfCut(TypedDict, total=False):
    """What the cuts belong to: a joint, by number, with a joint material; or glue, which leaves the rock as
    strong as it was. keep: ends inside blocks are kept for later cuts.
    """

    joint: int | None
    jmaterial: int | None
    glued: bool | None
    keep: bool | None


def words_of(values: OfCut) -> CutWords:
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
    """SPLIT: cut all blocks in the path of a line.

    A line that cuts no block, but has ends inside blocks, is kept for later cuts.

    Parameters
    ----------
    x1, y1, x2, y2
        Ends of the line in m.
    joint, jmaterial
        Number of the joint that the cuts belong to, and its joint material.

    Returns
    -------
    int
        The number of new blocks; if it is 0, `why_none` gives the reason.

    Raises
    ------
    UdecError
        4, 10, 14, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.split(1, 0.5, 1, 3)  # the upper block; the lower one is not crossed from side to side
    1
    """
    session.ensure_ready(shapes=True)
    ends = x1, y1, x2, y2
    done = split_or_keep(session.array, session.split_boxes, ends, joint, jmaterial)
    report_cuts(session, done, True)
    return done.blocks


@takes_keywords(OfCut)
def polyline(session: Session, *xy: float, **words: Unpack[OfCut]) -> int:
    """POLYLINE: cut all blocks along a line of several parts.

    Parameters
    ----------
    xy
        Its points x1, y1, x2, y2, ... in m.
    words
        joint, jmaterial, glued, keep (OfCut).

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 7, 8, 10, 27 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.polyline(0.5, 3, 0.8, 1.5, 0.5, 0.5)
    1
    """
    if len(xy) < 4 or len(xy) % 2:
        raise UdecError(8, f"{counted(len(xy), 'coordinate')} given", "give x1, y1, x2, y2, ...")
    points = np.array(rows(2, xy=np.reshape(xy, (-1, 2)).tolist()), np.float64)
    kept = np.append(True, np.diff(points, axis=0).any(axis=1))
    if kept.sum() < 2:
        raise UdecError(28, "all points are the same", "give two different points", parameter="x1")
    return cut_along(session, [points[kept]], words)


def fractures(session: Session, path: str | Path, *, glued: bool = False, keep: bool = False) -> int:
    """FRACTURES: cut along the lines in a file.

    Parameters
    ----------
    path
        CSV or GeoJSON (docs/cuts.md).
    glued
        Lines for which the file gives no joint are glued.
    keep
        Ends inside blocks are kept for later cuts.

    Returns
    -------
    int
        The number of new blocks.

    Raises
    ------
    UdecError
        4, 10, 27 or 28. Nothing is changed then. FileNotFoundError if there is no such file.

    Examples
    --------
    >>> m.fractures("fractures.csv")  # doctest: +SKIP
    12
    """
    session.ensure_ready(shapes=True)
    found = read_fractures(Path(path))
    ignored = f", {counted(found.ignored, 'feature')} without lines ignored" if found.ignored else ""
    session.inform(f"{counted(len(found.lines), 'line')} in {path}{ignored}")
    words = CutWords(glued=glued, keep=keep)
    done = cut_lines_of_joints(session.array, session.split_boxes, found.lines, found.joints, words)
    report_cuts(session, done, keep)
    return done.blocks


def tidy(session: Session, a: float) -> Tidied:
    """TIDY: merge small blocks into neighbours, before zones and cycles.

    Parameters
    ----------
    a
        Area in m2. Smaller blocks are merged.

    Returns
    -------
    Tidied
        `merged` and `left`: slivers with `area` (m2), `x`, `y`.

    Raises
    ------
    UdecError
        26 after the first cycle, 28. Nothing is changed then.

    Examples
    --------
    >>> m.split(0.1, 0.5, 0.1, 3)
    1
    >>> len(m.tidy(0.15).merged)
    1
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


def cut_along(session: Session, lines: Sequence[Reals], words: OfCut, leave_out: bool = False) -> int:
    """Cut along the lines, and report. Returns the number of new blocks."""
    session.ensure_ready(shapes=True)
    given = words_of(words)
    done = cut(session.array, session.split_boxes, lines, given, leave_out)
    report_cuts(session, done, given.keep)
    return done.blocks


def report_cuts(session: Session, done: Cuts, keep: bool) -> None:
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
