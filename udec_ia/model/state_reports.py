"""Methods of Model that read its state: tables, listings, files and checks; FOS and GEOMETRY."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from udec_ia.advice.time_step_warnings import describe_step
from udec_ia.checker import Violation, unchecked_parts
from udec_ia.checker import check as violations
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import MCTOT
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import energy_account
from udec_ia.ops.commands.energy_account import Balance
from udec_ia.ops.commands.strength_reduction import strengths
from udec_ia.ops.common.number_limits import positive, whole
from udec_ia.output import word_dump
from udec_ia.output.printed_tables import printout
from udec_ia.output.safety_picture import draw_safety
from udec_ia.reader import group_tables
from udec_ia.reader.block_shapes import Shapes, block_shapes
from udec_ia.reader.fracture_rows import cracks_made
from udec_ia.reader.group_ranges import range_of
from udec_ia.running.critical_step import bound
from udec_ia.running.factor_of_safety import FactorOfSafety, factor_of_safety
from udec_ia.running.history_series import frame_of

if TYPE_CHECKING:
    from pandas import DataFrame


def table(session: Session, kind: str) -> NDArray[np.void]:
    """All groups of a kind, one row each.

    Parameters
    ----------
    kind
        A kind of groups of the field table, as "block", "contact" or "zone".

    Returns
    -------
    numpy.ndarray
        Structured array (n,): `address`, then the fields by the names and in the units of the field table.
        Integers are int64, reals have the type of the word scheme. It is a copy.

    Raises
    ------
    ValueError
        For an unknown kind.
    UdecError
        20 if a list is damaged.

    Examples
    --------
    >>> blocks = m.table("block")
    >>> blocks["KX"].tolist(), blocks["KY"].tolist()  # centroids in m
    ([1.0, 1.0], [1.5, 0.5])
    """
    return group_tables.table(session.array, kind)


def frame(session: Session, kind: str) -> DataFrame:
    """All groups of a kind, or all histories, as a pandas DataFrame.

    Parameters
    ----------
    kind
        A kind of groups, as for `table`. "histories": what HISTORY has recorded; "history" are the groups of
        that kind.

    Returns
    -------
    pandas.DataFrame
        Of groups: index `address`, and a column for each field, with its name of the field table. Of
        histories: index `time` (s), and columns `cycle` and the title of each; NaN where one was not
        recorded.
        `attrs["units"]` has the unit of each column, `attrs["names"]` what it is in words.

    Raises
    ------
    ModuleNotFoundError
        Without pandas.
    ValueError
        For an unknown kind.
    UdecError
        20 if a list is damaged.

    Examples
    --------
    >>> blocks = m.frame("block")
    >>> blocks.attrs["units"]["KX"], blocks.attrs["names"]["KX"]
    ('m', 'x coordinate of centroid')
    >>> blocks.rename(columns=blocks.attrs["names"])["y coordinate of centroid"].tolist()
    [1.5, 0.5]
    """
    if kind.lower() == "histories":
        return frame_of(session.recorder.series)
    return group_tables.frame(session.array, kind)


def cracks(session: Session) -> NDArray[np.void]:
    """The cracks that runs have made, the earliest first.

    Returns
    -------
    numpy.ndarray
        Structured array (n,) with `crack` (address), `cycle`, `time` (s), `x1`, `y1`, `x2`, `y2` (m, both
        ends where they were then), `cause` ("forces", "tension", "shear") and `energy` (J/m), which it took.

    Examples
    --------
    >>> len(m.cracks())
    0
    """
    session.ensure_ready()
    return cracks_made(session.array.h)


def info(session: Session) -> str:
    """INFO: what is in the model, what is missing before it can run, and remarks.

    A notebook shows the same with a picture, and with the calls that give what is missing.

    Returns
    -------
    str
        The text, one fact a line. A part that cannot be made of a damaged array says why.

    Examples
    --------
    >>> print(m.info().splitlines()[1])
        blocks: 2: 2 rigid, 1 fixed
    """
    from udec_ia.model.notebook_display import facts

    return facts(session)


def check(session: Session) -> list[Violation]:
    """The proof that the array is a sound block system.

    Returns
    -------
    list of Violation
        All violations of the invariants of the map; empty if it is sound.

    Examples
    --------
    >>> m.check()
    []
    """
    for sentence in unchecked_parts(session.array):
        session.inform(sentence)
    return list(violations(session.array))


def check_file(path: str | Path) -> list[Violation]:
    """The same for a restart file, also if RESTART refuses it.

    Parameters
    ----------
    path
        The restart file.

    Returns
    -------
    list of Violation
        As of `check`.

    Raises
    ------
    UdecError
        29 if it is not what SAVE wrote.

    Examples
    --------
    >>> Model.check_file(m.save())
    []
    """
    from udec_ia.restart import look_into

    return list(violations(look_into(path)))


def print(session: Session, *what: str) -> str:
    """PRINT: listings, one after the other, as text.

    Parameters
    ----------
    what
        Groups, as "blocks" or "contacts", "list", "dlist", "reactions", "functions", "energy", "histories",
        "max", "cracks", "water" ...

    Returns
    -------
    str
        The lines of the listings.

    Raises
    ------
    UdecError
        7 without any, 10 for anything else, 26 for an account that was not begun.

    Examples
    --------
    >>> "cycle 0" in m.print("blocks")
    True
    """
    if any(word.lower() in ("energy", "reactions", "functions") for word in what):
        session.ensure_ready()
    return printout(session.array.h, *(word.lower() for word in what), series=session.recorder.series)


def dump(session: Session, n: int, m: int) -> str:
    """DUMP: words of the array.

    Parameters
    ----------
    n, m
        Addresses of the first and of the last word.

    Returns
    -------
    str
        Their numbers as integers and reals.

    Raises
    ------
    UdecError
        30 for addresses outside the array.

    Examples
    --------
    >>> "1" in m.dump(1, 4)
    True
    """
    return word_dump.dump(session.array.h, whole(n=n), whole(m=m))


def balance(session: Session) -> Balance:
    """The account of the energy that PRINT ENERGY shows.

    Returns
    -------
    Balance
        Input, stored energy and losses in J per m of thickness, by name; `residual` is what is left.

    Raises
    ------
    UdecError
        26 unless energy("on") began an account.

    Examples
    --------
    >>> m.energy("on")
    >>> m.balance().residual
    0.0
    """
    session.ensure_ready()
    return energy_account.balance(session.array.h)


def step_limits(session: Session) -> str:
    """The time-step of the last CYCLE, its shares of estimate and bound, and what sets these.

    Returns
    -------
    str
        One line. Estimate and bound are those of the present state, which the cycles since then have made.

    Raises
    ------
    UdecError
        11 or 12 for undefined properties.

    Examples
    --------
    >>> m.cycle(1)
    1
    >>> m.step_limits().startswith("time-step")
    True
    """
    session.ensure_ready()
    return describe_step(session.array, bound(session.array))


def geometry(session: Session) -> Shapes:
    """GEOMETRY: the shortest edges, smallest blocks and sharpest angles, and what they cost.

    Returns
    -------
    Shapes
        `edges` (m), `areas` (m2), `angles` (degrees): five of each, with `value`, `x`, `y` and `block`; its
        text is the table.

    Raises
    ------
    UdecError
        26 without blocks.

    Examples
    --------
    >>> m.geometry().areas[0].value
    2.0
    """
    session.ensure_ready()
    found = block_shapes(session.array)
    if found is None:
        raise UdecError(26, "there is no block", "create one with BLOCK")
    return found


def view(session: Session, path: str | Path) -> Path:
    """Write a page for a browser that shows the array beside the blocks.

    Parameters
    ----------
    path
        Its name. Of several states make a `udec_ia.view.Page`.

    Returns
    -------
    Path
        Its name.

    Raises
    ------
    UdecError
        31 if it cannot be written, or would replace another kind of file.

    Examples
    --------
    >>> m.view(folder / "state.html").name
    'state.html'
    """
    from udec_ia.view import Page

    page = Page()
    page.add(session.array, f"{session.name}, cycle {session.array.h.ci[MCTOT]}", session.log.lines)
    return page.write(path)


def export(session: Session, path: str | Path) -> list[Path]:
    """Write the state for another program.

    Parameters
    ----------
    path
        It ends with .vtkhdf, .csv, .geojson or .svg. Of several states make a series with
        `udec_ia.export.export`.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    UdecError
        10 for another ending, 31 if a file cannot be written, or would replace another kind of file.

    Examples
    --------
    >>> [file.name for file in m.export(folder / "state.csv")]
    ['state-blocks.csv', 'state-contacts.csv']
    """
    from udec_ia.export import export as write_states

    return write_states(path, [session.array])


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
    >>> m.fos(joints=True, tolerance=0.002).factor  # of a slope  # doctest: +SKIP
    1.332
    """
    session.ensure_ready()
    array = session.array
    _check_numbers(array, tolerance, jobs)
    where = None if x1 is None else range_of(x1, x2, y1, y2)
    both = blocks == joints
    places = strengths(array, where, blocks or both, joints or both)
    found = factor_of_safety(array, session.laws, places, tolerance, jobs, session.inform)
    session.recorder.safety = [*session.recorder.safety, (found.factor, *found.bracket)]
    if picture:
        session.safety_pictures += 1
        base = session.out / f"{session.name}-fos-{session.safety_pictures}"
        found.files = draw_safety(array, found, base)
        session.add_files(found.files)
    return found
