"""Methods of Model that study its state: FOS, the factor of safety, and GEOMETRY, shapes of blocks."""

from __future__ import annotations

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.model.model_session import Session
from udec_ia.ops.commands.strength_reduction import strengths
from udec_ia.ops.common.number_limits import positive, whole
from udec_ia.output.safety_picture import draw_safety
from udec_ia.reader.block_shapes import Shapes, block_shapes
from udec_ia.reader.group_ranges import range_of
from udec_ia.running.factor_of_safety import FactorOfSafety, factor_of_safety


def geometry(session: Session) -> Shapes:
    """GEOMETRY: the shortest edges, smallest blocks and sharpest angles, and what they cost.

    Returns
    -------
    Shapes
        `edges` (m), `areas` (m2), `angles` (degrees): five of each, with `value`, `x`, `y` and `block`; its
        text is the table. Error 26 without blocks.
    """
    session.ensure_ready()
    found = block_shapes(session.array)
    if found is None:
        raise UdecError(26, "there is no block", "create one with BLOCK")
    return found


def _check_numbers(array: MainArray, tolerance: float, jobs: int | None) -> None:
    """Error 28 for a tolerance that is not between 0 and 1, or less than one process."""
    positive(array, tolerance=tolerance)
    if tolerance >= 1:
        detail = f"the tolerance is {tolerance:g}"
        raise UdecError(28, detail, "give a part of the factor, as 0.01", parameter="tolerance")
    if jobs is not None and whole(jobs=jobs) < 1:
        raise UdecError(28, f"{jobs} jobs", "give 1 or more", parameter="jobs")


def fos(
    session: Session,
    x1: float | str | None = None,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    *,
    blocks: bool = False,
    joints: bool = False,
    tolerance: float = 0.01,
    jobs: int | None = None,
    picture: bool = True,
) -> FactorOfSafety:
    """FOS: the factor by which strength can be divided before blocks fail. The model stays as it is.

    Parameters
    ----------
    x1, x2, y1, y2
        Range, four limits in m or words, of blocks and contacts whose strength is divided; without it all.
    blocks, joints
        Divide the strength inside blocks, or that of joints; without both words that of both.
    tolerance
        Width of the bracket of the factor over its middle, at the end.
    jobs
        Processes, which do not change the result; by default as many as save time, at most three.
    picture
        Draw the last stable and the first failing state, into NAME-fos-1.png and .svg.

    Returns
    -------
    FactorOfSafety
        `factor`, `bracket`, `trials`, `n` (cycles of N), and the `stable` and the `failing` trial; its text
        is the table.

    Raises
    ------
    UdecError
        10 for a material that is inside and outside the range, 26 without strength, without load, or without
        rest at unlimited strength, and what may stop a run.

    Examples
    --------
    >>> m.fos(joints=True, tolerance=0.002).factor  # doctest: +SKIP
    1.332
    """
    session.ensure_ready()
    array = session.array
    _check_numbers(array, tolerance, jobs)
    where = None if x1 is None else range_of(x1, x2, y1, y2)
    both = blocks == joints
    places = strengths(array, where, blocks or both, joints or both)
    found = factor_of_safety(array, session.laws, places, tolerance, jobs, session.inform)
    if picture:
        session.safety_pictures += 1
        base = session.out / f"{session.name}-fos-{session.safety_pictures}"
        found.files = draw_safety(array, found, base)
        session.add_files(found.files)
    return found
