"""Methods of Model for supports and loads: FIX, VELOCITY, GRAVITY, INSITU, FUNCTION, and displacements."""

from __future__ import annotations

from functools import partial
from math import inf
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from udec_ia.advice.input_warnings import check_initial_joints
from udec_ia.errors import UdecError
from udec_ia.layout.offsets import IFWPNT
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import free_blocks, initial_stress, model_settings
from udec_ia.ops.commands.boundary_command import ZERO, Triple
from udec_ia.ops.commands.function_command import read_function, set_function
from udec_ia.ops.commands.model_settings import set_fixity
from udec_ia.ops.commands.reset_command import reset_displacements, reset_slip, reset_time
from udec_ia.ops.common.array_growth import lengthen_groups
from udec_ia.ops.common.number_limits import reals
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import range_of, read_range
from udec_ia.reader.reaction_rows import reactions_in

RESETS = "displacements", "slip", "time"
ONE_OR_MORE = f"give one or more of {', '.join(RESETS).upper()}"


def fix(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
) -> int:
    """FIX: hold the blocks in the range.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.fix(0, 2, 1, 2)
    1
    """
    session.ensure_ready()
    return set_fixity(session.array, range_of(x1, x2, y1, y2), True)


def free(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
) -> int:
    """FREE: let the blocks in the range move.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.free("ALL")
    2
    """
    session.ensure_ready()
    return set_fixity(session.array, range_of(x1, x2, y1, y2), False)


def velocity(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    vx: float = 0.0,
    vy: float = 0.0,
    w: float = 0.0,
) -> int:
    """VELOCITY: throw the blocks in the range; fixed ones are left out.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    vx, vy
        Velocity of the centroid, m/s.
    w
        Angular velocity, rad/s, anticlockwise.

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.velocity(0, 2, 1, 2, vx=1.0, w=0.5)
    1
    """
    session.ensure_ready()
    return free_blocks.set_velocities(session.array, range_of(x1, x2, y1, y2), vx, vy, w)


def gravity(session: Session, gx: float, gy: float, *, function: int | None = None) -> None:
    """GRAVITY: accelerations of all blocks.

    Parameters
    ----------
    gx, gy
        In the x and y directions, m/s2.
    function
        Number of a FUNCTION that multiplies both from now on.

    Raises
    ------
    UdecError
        10, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.gravity(0, -9.81)
    """
    session.ensure_ready(sound=function is not None or bool(session.array.h.ci[IFWPNT]))
    model_settings.set_gravity(
        session.array, gx, gy, function, partial(session.undo.save_words, session.array)
    )


def insitu(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    s11: float = 0.0,
    s12: float = 0.0,
    s22: float = 0.0,
    xgrad: Triple = ZERO,
    ygrad: Triple = ZERO,
) -> int:
    """INSITU: initial stresses of the blocks in the range and of their joints.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    s11, s12, s22
        Components of the stress in Pa at the origin, tension positive.
    xgrad, ygrad
        Their increases per metre in x and y.

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        10, 24, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.insitu("ALL", s11=-1e6, s22=-2e6)
    2
    """
    session.ensure_ready()
    xgrad, ygrad = reals(3, xgrad=xgrad), reals(3, ygrad=ygrad)
    where = range_of(x1, x2, y1, y2)
    done = initial_stress.insitu(session.array, where, (s11, s12, s22), xgrad, ygrad)
    session.report_remarks(check_initial_joints(done.exceeded))
    return done.blocks


def function(session: Session, n: int, *tf: float, path: str | Path | None = None) -> None:
    """FUNCTION: factors at times of the model; linear between these points and constant outside.

    Parameters
    ----------
    n
        Number of the function.
    tf
        t1, f1, t2, f2, ...: times in s and factors.
    path
        Of a text file with these numbers in two columns, in place of them.

    Raises
    ------
    UdecError
        8, 10, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.function(1, 0.0, 0.0, 0.5, 1.0)
    >>> m.gravity(0, -10, function=1)  # grows for half a second
    """
    if len(tf) % 2:
        raise UdecError(8, f"{counted(len(tf), 'number')} given", "give t1, f1, t2, f2, ...")
    if tf and path is not None:
        raise UdecError(10, "numbers and a file", "give one of them", parameter="path")
    session.ensure_ready()
    if path is not None:
        read_function(session.array, n, Path(path))
    else:
        set_function(session.array, n, list(zip(tf[::2], tf[1::2], strict=True)))


def displacements(session: Session) -> None:
    """DISPLACEMENTS: the state has the displacements of all blocks and grid-points from now on.

    The tables "displacement" and "pointdisplacement" have them, and HISTORY can record them (m, rad).
    RESET DISPLACEMENTS sets them to 0. Blocks and grid-points get new addresses.

    Raises
    ------
    UdecError
        1 if there is no memory. Nothing is changed then.

    Examples
    --------
    >>> m.displacements()
    >>> m.cycle(10)
    10
    >>> m.table("displacement").dtype.names
    ('address', 'KBDX', 'KBDY', 'KBDT')
    """
    session.ensure_ready()
    lengthen_groups(session.array, "LDISP")


def reset(session: Session, *what: str) -> None:
    """RESET: begin anew what a run adds up.

    Parameters
    ----------
    what
        One or more of "displacements" (those of plots are measured from the present state, and those that the
        state has after `displacements` become 0), "slip" (the shear displacements of all contacts become 0)
        and "time" (the model's time becomes 0). A FUNCTION of the time then begins again, and a sine, which
        began at its command, goes on.

    Raises
    ------
    UdecError
        7 without any, 10 for anything else. Nothing is changed then.

    Examples
    --------
    >>> m.reset("displacements", "time")
    """
    words = [word.lower() for word in what]
    if not words:
        raise UdecError(7, "RESET of what?", ONE_OR_MORE)
    for word in words:
        if word not in RESETS:
            raise UdecError(10, f"RESET {word}", ONE_OR_MORE)
    session.ensure_ready()
    if "displacements" in words:
        session.reset_displacements()
        reset_displacements(session.array)
    if "slip" in words:
        reset_slip(session.array.h)
    if "time" in words:
        reset_time(session.array.h)


def reactions(
    session: Session, x1: float | str = -inf, x2: float = inf, y1: float = -inf, y2: float = inf
) -> NDArray[np.void]:
    """The forces that hold fixed blocks, and blocks and grid-points with prescribed velocities.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of the centroids and grid-points, or words; without it all.

    Returns
    -------
    numpy.ndarray
        Structured array with a row for each: `block`, `gridpoint` (0 for a block), `x`, `y` (m), `fx`, `fy`
        (N/m) and `moment` (N, about the centroid). The force is that by which it is held, its own weight
        included, without what accelerates it.

    Raises
    ------
    UdecError
        10 or 28 for the range.

    Examples
    --------
    >>> m.reactions()["fy"].tolist()  # N/m: the weight of the lower block, which is fixed
    [40000.0]
    """
    session.ensure_ready()
    where = read_range(x1) if isinstance(x1, str) else (x1, x2, y1, y2)
    return reactions_in(session.array, where)
