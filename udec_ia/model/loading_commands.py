"""Methods of Model for loading in time: PROPERTY, GRAVITY, FUNCTION, RESET, and the reactions."""

from __future__ import annotations

from functools import partial
from math import inf
from pathlib import Path
from typing import Any, Unpack

from udec_ia.advice.input_warnings import check_properties
from udec_ia.errors import UdecError
from udec_ia.layout.material import Properties
from udec_ia.layout.offsets import IFWPNT
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.function_command import read_function, set_function
from udec_ia.ops.commands.reset_command import keep_displacements, reset_displacements, reset_slip, reset_time
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import read_range
from udec_ia.reader.reaction_rows import reactions_in


@takes_keywords(Properties)
def property(
    session: Session, material: int, *, function: int | None = None, **values: Unpack[Properties]
) -> None:
    """PROPERTY: set properties of a material; those not given stay as they are.

    From dilation on they are for the laws of constitutive numbers 2 to 5 (udec_ia.laws). function: number of
    a FUNCTION that multiplies the given values from now on, of any property but density and stiffness.
    """
    session.ensure_ready()
    model_settings.set_property(
        session.array, material, function, partial(session.undo.save_words, session.array), **values
    )
    session.report_remarks(check_properties(session.array, material, dict[str, float | None](**values)))


def gravity(session: Session, gx: float, gy: float, *, function: int | None = None) -> None:
    """GRAVITY: accelerations in the x and y directions, m/s2.

    function: number of a FUNCTION that multiplies both from now on.
    """
    session.ensure_ready(sound=function is not None or bool(session.array.h.ci[IFWPNT]))
    model_settings.set_gravity(
        session.array, gx, gy, function, partial(session.undo.save_words, session.array)
    )


def function(session: Session, n: int, *tf: float, path: str | Path | None = None) -> None:
    """FUNCTION: the factors of function number n at times of the model: t1, f1, t2, f2, ... (s, -).

    path: of a text file with these numbers in two columns, in place of them. The function is linear between
    its points and constant outside. Errors 8, 10, 26 and 28.
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


RESETS = "displacements", "slip", "time"


def displacements(session: Session) -> None:
    """DISPLACEMENTS: the state has the displacements of all blocks and grid-points from now on.

    The tables "displacement" and "pointdisplacement" have them, and HISTORY can record them (m, rad).
    RESET DISPLACEMENTS sets them to 0. Blocks and grid-points get new addresses.

    Raises
    ------
    UdecError
        1 if there is no memory. Nothing is changed then.
    """
    session.ensure_ready()
    keep_displacements(session.array)


def reset(session: Session, *what: str) -> None:
    """RESET: begin anew what a run adds up.

    Parameters
    ----------
    what
        One or more of "displacements" (those of plots are measured from the present state, and those that the
        state has after `displacements` become 0), "slip" (the shear
        displacements of all contacts become 0) and "time" (the model's time becomes 0). A FUNCTION of the
        time then begins again, and a sine, which began at its command, goes on.

    Raises
    ------
    UdecError
        7 without any, 10 for anything else. Nothing is changed then.
    """
    words = [word.lower() for word in what]
    if not words:
        raise UdecError(7, "RESET of what?", "give one or more of DISPLACEMENTS, SLIP, TIME")
    for word in words:
        if word not in RESETS:
            raise UdecError(10, f"RESET {word}", "give one or more of DISPLACEMENTS, SLIP, TIME")
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
) -> Any:
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
    """
    session.ensure_ready()
    where = read_range(x1) if isinstance(x1, str) else (x1, x2, y1, y2)
    return reactions_in(session.array, where)
