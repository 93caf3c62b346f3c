"""SAVE, STAGE, RESTART and STOP of a session: restart files, and what is left of a run at its end."""

from __future__ import annotations

import os
from pathlib import Path

from udec_ia.checker import check
from udec_ia.deck.command_monitor import RESTART_FILE
from udec_ia.errors import MESSAGES, UdecError, spoilt
from udec_ia.layout.offsets import MCSPOI, MCTOT, NBLK, NCON, NSPOIL, TIME
from udec_ia.model.model_session import Session
from udec_ia.ops.common.array_growth import refit
from udec_ia.printable_text import counted, printable
from udec_ia.remark import Remark


def save(session: Session, path: str | Path | None = None, *, force: bool = False) -> Path:
    """SAVE: write a restart file.

    Parameters
    ----------
    path
        Its name, by default restart.h5 in the folder `out`. Here as everywhere in Python a relative path
        starts from the working directory; in a deck, from `out`. It may replace a restart file only. Folders
        are created within `out` only.
    force
        Also a state that is unsound, whatever has made it so; the file is marked with the result of `check`,
        and RESTART takes it only by force.

    Returns
    -------
    Path
        Its name.

    Raises
    ------
    UdecError
        20 for an unsound state, 31 if it cannot be written.

    Examples
    --------
    >>> m.save().name
    'restart.h5'
    """
    from udec_ia.restart import save as write

    if not force:
        session.prove_before_save()
    broken = [str(one) for one in check(session.array)] if force else []
    if broken:
        text = f"the state is unsound, and the file is marked so: {broken[0]}"
        session.tell(Remark("unsound-state", text))
    target = session.out / RESTART_FILE if path is None else Path(path)
    folder, makes = target.parent, path is not None and not os.path.isdir(target.parent)
    if makes and not folder.resolve().is_relative_to(session.out.resolve()):
        advice = "create it first, or give a name within the folder for files (--out)"
        raise UdecError(31, f"{folder} does not exist, and is outside the folder for files", advice)
    recorded = session.recorder.series
    written = write(session.array, target, session.log.lines, session.laws.record(), recorded, broken)
    session.add_files([written])
    if makes:
        session.inform(f"the folder {printable(str(folder))} did not exist and was created")
    return written


def stages(session: Session) -> Path:
    """The file of the stages of the run."""
    return Path(session.out) / f"{session.name}-stages.zip"


def keep_stage(session: Session, name: str) -> Path:
    """STAGE: keep the present state under a name, in the file NAME-stages.zip of the run.

    The first stage of a run begins the file anew, unless the run continues another one.

    Parameters
    ----------
    name
        Of the stage.

    Returns
    -------
    Path
        NAME-stages.zip/name, which `restart` and all programs that read restart files take.

    Raises
    ------
    UdecError
        10 for an impossible name, 20 for an unsound state, 31 if the file cannot be written.

    Examples
    --------
    >>> m.stage("built").name
    'built'
    """
    from udec_ia.restart import add_stage, restart_image

    session.prove_before_save()
    path = stages(session)
    laws, recorded = session.laws.record(), session.recorder.series
    image = restart_image(session.array, session.log.lines, laws, recorded)
    add_stage(path, name, image, begins=not (session.continued or path in session.files))
    session.add_files([path])
    session.addresses_since = {**session.addresses_since, name: None}
    return path / name


keep_stage.__name__ = keep_stage.__qualname__ = "stage"  # as users call it


def restart(
    session: Session, path: str | Path | None = None, *, force: bool = False, unchecked: bool = False
) -> None:
    """RESTART: continue from a restart file.

    The words are those of the file's scheme; `mtop` limits them, whatever the limit was when they were
    saved. Existing pictures stay: new ones take the next numbers. A state of which an error has ended a run
    is proved in its links, codes and counts only.

    Parameters
    ----------
    path
        Its name, by default restart.h5 in the folder `out`.
    force
        Take an unsound state, too, to inspect and to mend it through `h`; commands that follow links prove
        the state first.
    unchecked
        Prove links, codes and counts only; commands that cut or load outlines, and SAVE, prove the rest.

    Raises
    ------
    UdecError
        29 if the file cannot be used or `check` finds its state unsound, 1 if it holds more than `mtop`, 10.
        The model is then as it was.

    Examples
    --------
    >>> m.restart(m.save())
    """
    from udec_ia.restart import load

    if force and unchecked:
        raise UdecError(10, "FORCE beside UNCHECKED", "give one of them", parameter="force")
    source = session.out / RESTART_FILE if path is None else path
    array, deck_log, laws, series, notes, unsound = load(source, force, unchecked)
    refit(array, session.mtop)
    session.array = array
    session.continue_from(deck_log, series)
    own = Path(source).parent.resolve() == stages(session).resolve()
    session.addresses_since = {Path(source).name: None} if own else {}
    for sentence in notes:
        session.tell(Remark("restart-file-note", sentence))
    if unsound:
        text = f"taken by force: CYCLE and other commands that follow links are refused while {unsound[0]}"
        session.tell(Remark("unsound-state", text))
    for warning in session.laws.note(laws):
        session.tell(Remark("law-changed", warning))
    ci, name = array.h.ci, array.scheme.name
    session.replace_state(written=force, unproved=force or unchecked or bool(ci[NSPOIL]))
    session.started = True
    session.inform(
        f"{printable(str(source))}: {counted(ci[NBLK], 'block')}, {counted(ci[NCON], 'contact')}, "
        f"{counted(ci[MCTOT], 'cycle')}, "
        f"t = {array.h.cd[TIME]:.4g} s, words of {name}"
    )
    if ci[NSPOIL] in MESSAGES:
        text = (
            f"{spoilt(int(ci[NSPOIL]), int(ci[MCSPOI]))}: inspect it, and continue from a state before that"
        )
        session.tell(Remark("state-of-an-error", text))
    if array.scheme != session.scheme:
        session.inform(
            f"continues with the word scheme {array.scheme.name}, as saved; --build applies to START only"
        )


def deck(session: Session) -> str:
    """The deck of all commands until now, from decks and Python, without SAVE, STAGE and RESTART.

    What was given as `constitutive` is given with it again; words that were written through `h` cannot be
    expressed in it. The deck of a model from a restart file begins as that of the model that was saved.

    Returns
    -------
    str
        Its lines.

    Examples
    --------
    >>> m.deck().splitlines()[0]
    'START'
    """
    return "".join(line + "\n" for line in session.log.lines)


def stop(session: Session) -> str:
    """STOP: write the open files.

    Returns
    -------
    str
        The line that sums up the run.

    Examples
    --------
    >>> m.stop()[:28]
    '0 cycles (t = 0 s), 2 blocks'
    """
    session.close_files()
    return session.summary()


def summary(session: Session) -> str:
    """The line that STOP returns.

    Returns
    -------
    str
        It is of the run until now and the files written by now.
    """
    return session.summary()
