"""PLOT and Model.figure: pictures of the blocks, of their change since a STAGE, or of the histories."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.errors import UdecError
from udec_ia.layout.offsets import LDISP
from udec_ia.model.model_session import Session
from udec_ia.model.saved_states import stages
from udec_ia.ops.common.number_limits import reals
from udec_ia.printable_text import is_of_notebook

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from udec_ia.output.plot_frames import StoredStage, What

Window = tuple[float, float, float, float]


def plot(
    session: Session,
    n: int | None = None,
    *,
    contacts: bool = False,
    domains: bool = False,
    addresses: bool = False,
    stresses: bool = False,
    velocities: bool = False,
    displacements: bool = False,
    contour: str | None = "",
    joints: str | None = "",
    structures: bool = False,
    window: Window | None = None,
    cracks: bool = False,
    history: bool | int = False,
    less: int = 0,
    against: int = 0,
    logx: bool = False,
    logy: bool = False,
    since: str = "",
) -> list[Path]:
    """PLOT: start a frame, or draw over the last one.

    A frame of more than ten states is written when it has grown by a quarter, and when it ends: at `plot(0)`
    or `stop()`.

    Parameters
    ----------
    n
        0, also if it is left off: start a frame; 1: draw over the last one.
    contacts, domains, addresses, stresses, velocities, displacements
        What is drawn beside the blocks; arrows and crosses have a scale.
    contour, joints
        Colours of zones and blocks, and of joints: "s22", "movement", "slip", ... (docs/pictures.md).
    structures, cracks, window
        Bolts, cables and beams, with their forces; the cracks that runs have made, where they were then; the
        range x1, x2, y1, y2 (m) that is shown.
    since
        Name of a stage of this run, or of a restart file with a folder: the present state is drawn over that,
        with the displacements, and the slip, since then.
    history, less, against, logx, logy
        Alone: all histories, or that one, less another one, against another one instead of time.

    Returns
    -------
    list of Path
        The files written, PNG and SVG.

    Raises
    ------
    UdecError
        10 for an unknown word or history, 26, 28, 29 if there is no such stage, 31 if no file can be written.

    Examples
    --------
    >>> [file.name for file in m.plot(contacts=True)]
    ['udec-plot-1.png', 'udec-plot-1.svg']
    """
    from udec_ia.output.block_drawing import load_matplotlib
    from udec_ia.output.plot_frames import What

    load_matplotlib()
    what = _what(
        contour,
        joints,
        window,
        contacts=contacts,
        domains=domains,
        addresses=addresses,
        stresses=stresses,
        velocities=velocities,
        displacements=displacements or bool(since),
        structures=structures,
        cracks=cracks,
    )
    if history is not False or less or against or logx or logy:
        if n is not None or what != What():
            advice = "use PLOT HISTORY for histories, PLOT 0 for blocks"
            raise UdecError(10, "histories and blocks are not plotted together", advice, parameter="history")
        return _plot_histories(session, history, less, against, logx, logy)
    session.ensure_ready()
    if since and n == 1:
        raise UdecError(10, "SINCE starts a frame", "PLOT 0 SINCE name", parameter="since")
    return session.draw(n or 0, what, _stage(session, since) if since else None)


def _what(contour: str | None, joints: str | None, window: Window | None, **shown: bool) -> What:
    """What a picture shows. Error 10 or 26 for a window that is no row of four numbers."""
    from udec_ia.output.plot_frames import What

    limits = None if window is None else reals(4, window=window)
    return What(contour=(contour or "").lower(), joints=(joints or "").lower(), window=limits, **shown)


def _plot_histories(
    session: Session, history: bool | int, less: int, against: int, logx: bool, logy: bool
) -> list[Path]:
    """Draw histories; history: True for all of them."""
    from udec_ia.output.history_graph import Wanted

    if history is False:
        advice = "PLOT HISTORY n LESS m AGAINST k LOGX LOGY"
        raise UdecError(10, "LESS, AGAINST, LOGX and LOGY belong to HISTORY", advice, parameter="history")
    if history == 0:
        raise UdecError(10, "there is no history 0", "PRINT HISTORIES lists them", parameter="history")
    number = 0 if history is True else history
    return session.draw_histories(Wanted(number, less, against, logx, logy))


def _stage(session: Session, name: str) -> StoredStage:
    """A stage of this run, or the state of a restart file."""
    from udec_ia.output.plot_frames import StoredStage
    from udec_ia.restart import look_into

    path = Path(name) if "/" in name else stages(session) / name
    moved = (
        session.addresses_since.get(path.name) if path.parent.resolve() == stages(session).resolve() else None
    )
    return StoredStage(look_into(path).h, path.name, moved)


def figure(
    session: Session,
    ax: Axes | None = None,
    color: str | None = "",
    contacts: str | None = "",
    arrows: str | Sequence[str] | None = "",
    *,
    stresses: bool = False,
    structures: bool = False,
    cracks: bool = False,
    domains: bool = False,
    addresses: bool = False,
    window: Window | None = None,
    since: str = "",
) -> Axes:
    """Draw the present state with matplotlib, as PLOT does, and return the axes; no file is written.

    Parameters
    ----------
    ax
        Axes of matplotlib to draw on; their range becomes that of the picture, with equal scales. By default
        a new figure is made around the picture: `ax.figure` of what is returned.
    color, contacts
        What colours zones and blocks, and joints contact by contact: a word of `contour`, and of `joints`, of
        `plot` (docs/pictures.md).
    arrows
        "displacement", "velocity", "force" (of contacts, as lines), or several: a list, or with blanks
        between them.
    stresses, structures, cracks, domains, addresses, window
        As of `plot`. stresses: crosses along the principal stresses.
    since
        Stage of this run, or restart file with a folder, from which displacements and slip are counted. By
        default displacements are those that the state has (DISPLACEMENTS), or those since RESET
        DISPLACEMENTS, or since the open frame of PLOT began.

    Returns
    -------
    matplotlib.axes.Axes
        The axes with the blocks; keys are beside them, notes on arrows below.

    Raises
    ------
    UdecError
        10 for an unknown word, 26 for water without FLUID or displacements since no state, 28 for an empty
        window, 29 if there is no such stage.

    Examples
    --------
    >>> m.cycle(10)
    10
    >>> ax = m.figure(color="speed", contacts="slip", arrows="velocity")
    >>> ax.figure.savefig("blocks.png", dpi=200)
    """
    from udec_ia.output.block_drawing import load_matplotlib

    load_matplotlib()
    shown = _arrows(arrows)
    what = _what(
        color,
        contacts,
        window,
        contacts="force" in shown,
        domains=domains,
        addresses=addresses,
        stresses=stresses,
        velocities="velocity" in shown,
        displacements="displacement" in shown,
        structures=structures,
        cracks=cracks,
    )
    return _draw_state(session, what, since, ax)


def _arrows(words: str | Sequence[str] | None) -> list[str]:
    """The words for arrows. Error 10 for an unknown one."""
    from udec_ia.reader.drawable_quantities import ARROWS

    shown = [word.lower() for word in (words.split() if isinstance(words, str) else words or ())]
    for word in shown:
        if word not in ARROWS:
            raise UdecError(10, f"arrows is {word}", f"there are {', '.join(ARROWS)}", parameter="arrows")
    return shown


def _draw_state(session: Session, what: What, since: str, ax: Axes | None) -> Axes:
    """Draw the present state, with displacements and slip since a stage, if it is named."""
    from udec_ia.output.plot_frames import check_words, draw_state, state_of_stage

    session.ensure_ready()
    check_words(session.array.h, what, {"contour": "color", "joints": "contacts"})
    in_state = bool(session.array.h.ci[LDISP])
    origin = None if session.plots is None or in_state else session.plots.first_state()
    if since:
        origin = state_of_stage(_stage(session, since), what)
    if what.moves and origin is None and not in_state:
        advice = "give DISPLACEMENTS or RESET DISPLACEMENTS before the run, or since="
        raise UdecError(26, "displacements are not counted from any state", advice, parameter="since")
    axes = draw_state(session.array.h, what, session.name, origin, ax)
    if is_of_notebook(sys.stdout):
        _show_figures_in_cells()
    return axes


def _show_figures_in_cells() -> None:
    """Have the notebook show the figure that a cell returns, also if pyplot has not made any."""
    from IPython import get_ipython
    from IPython.core import pylabtools
    from matplotlib.figure import Figure

    shell = get_ipython()
    try:
        shell.display_formatter.formatters["image/png"].lookup_by_type(Figure)
    except KeyError:
        show: Any = pylabtools.select_figure_formats
        show(shell, {"png"})
