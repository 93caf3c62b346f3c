"""PLOT: pictures of the blocks, of their change since a STAGE, or of the histories."""

from __future__ import annotations

from pathlib import Path

from udec_ia.errors import UdecError
from udec_ia.model.model_session import Session
from udec_ia.model.saved_states import stages


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
    contour: str = "",
    joints: str = "",
    structures: bool = False,
    history: bool = False,
    window: tuple[float, float, float, float] | None = None,
    cracks: bool = False,
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
        What is drawn beside the blocks; arrows and crosses are scaled, and a note has the scale.
    contour
        "s11", "s12", "s22", "pressure" or "shear".
    joints
        "slip", "opening", "state", "ppressure", "saturation", "flow" or "aperture".
    structures
        Bolts, cables and beams, with their axial forces and moments.
    cracks
        Those that runs have made are drawn, where they were then.
    window
        Range x1, x2, y1, y2 (m) that is shown.
    since
        Name of a stage of this run, or of a restart file with a folder: the present state is drawn over that,
        with the displacements, and the slip, since then.
    history
        Without the others: histories are drawn instead.

    Returns
    -------
    list of Path
        The files written, PNG and SVG.

    Raises
    ------
    UdecError
        10 for an unknown word, 26, 28, 29 if there is no such stage, 31 if a file cannot be written.

    Examples
    --------
    >>> [file.name for file in m.plot(contacts=True)]
    ['udec-plot-1.png', 'udec-plot-1.svg']
    """
    from udec_ia.output.plot_frames import What, check_words

    what = What(
        *(contacts, domains, addresses, stresses, velocities, displacements or bool(since)),
        *(contour.lower(), joints.lower(), window, structures, cracks),
    )
    if history:
        if n is not None or what != What():
            advice = "use PLOT HISTORY for histories, PLOT 0 for blocks"
            raise UdecError(10, "histories and blocks are not plotted together", advice, parameter="history")
        return session.draw_histories()
    session.ensure_ready()
    if since:
        if n == 1:
            raise UdecError(10, "SINCE starts a frame", "PLOT 0 SINCE name", parameter="since")
        check_words(session.array.h, what)
        _draw_stage(session, since, what.joints)
        n = 1
    return session.draw(n or 0, what)


def _draw_stage(session: Session, name: str, joints: str) -> None:
    """Start a frame with the state of a stage. joints: what is drawn of the joints."""
    from udec_ia.output.plot_frames import What
    from udec_ia.restart import look_into

    path = Path(session.out) / name if "/" in name else stages(session) / name
    moved = session.moved_since.get(path.name) if path.parent.resolve() == stages(session).resolve() else None
    session.draw(0, What(joints=joints), look_into(path).h, path.name, moved)
