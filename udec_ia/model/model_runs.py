"""CYCLE, SOLVE and HISTORY of a session: cycles with progress, histories, warnings and undo around them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

from udec_ia.advice.damping_report import UNDAMPED, describe_damping
from udec_ia.advice.input_warnings import check_damping, check_input
from udec_ia.advice.rest_diagnosis import RestDiagnosis
from udec_ia.advice.time_step_warnings import describe_step
from udec_ia.advice.water_report import check_apertures, describe_flow
from udec_ia.compiling.interpreted_kernels import mode
from udec_ia.errors import UdecError
from udec_ia.heap_tools.renumber_groups import arrange
from udec_ia.layout.offsets import DTOL, IFRPNT, LROUND, LWATER, MCTOT, NLEFT, WFRIC
from udec_ia.model.model_session import Session
from udec_ia.ops.commands.default_stiffness import settle_stiffness
from udec_ia.ops.common.attached_structures import number_of_structures
from udec_ia.ops.common.number_limits import not_negative, whole
from udec_ia.printable_text import counted
from udec_ia.reader.block_shapes import block_shapes
from udec_ia.reader.fracture_rows import crack_text, cracks_made
from udec_ia.remark import UdecWarning
from udec_ia.running.cycle_observer import Observer
from udec_ia.running.history_series import NEVER, SOLVE_LIMIT, Recording, Series
from udec_ia.running.mass_scaling import relaxations_due
from udec_ia.running.run_cycles import cycle as run
from udec_ia.running.run_cycles import finish, prepare
from udec_ia.running.solve_result import MAX, MEAN, Solution, criterion_of, solution_of
from udec_ia.running.static_relaxation import STATIC, static_settings
from udec_ia.running.time_goal import TimeGoal

AT_REST = 1e-5  # force ratio of SOLVE
SHOWN = 100  # cracks that a run reports
PICTURES = 40  # pictures that an animation takes during one CYCLE command

LogPart = Callable[[int], None]  # logs so many cycles of a run that has ended early


def cycle(session: Session, n: int | None = None, *, time: float | None = None) -> int:
    """CYCLE: calculation cycles.

    Parameters
    ----------
    n
        Number of cycles.
    time
        Time in s by which the model's time grows, in place of n. The last cycle reaches it, or goes beyond it
        by less than a step. The step may change during the run (FRACTION f SAFE).

    Returns
    -------
    int
        How many cycles were completed.

    Raises
    ------
    UdecError
        7 or 10 unless one of the two is given, 28 for a negative one, and what may stop a run.

    Examples
    --------
    >>> m.cycle(10)
    10
    """
    session.ensure_ready()
    if n is not None and time is not None:
        raise UdecError(10, "a number of cycles and a time", "give one of them", parameter="time")
    if time is not None:
        not_negative(session.array, time=time)
        return _run_cycles(session, 0, _recording(session), partial(_log_cycles, session), time=time)
    if n is None:
        raise UdecError(7, "number of cycles", "CYCLE n, or CYCLE TIME t")
    not_negative(session.array, n=whole(n=n))
    return _run_cycles(session, n, _recording(session), partial(_log_cycles, session))


def solve(
    session: Session,
    ratio: float = AT_REST,
    limit: int = SOLVE_LIMIT,
    *,
    static: bool = False,
    criterion: str = MAX,
) -> Solution:
    """SOLVE: cycle until the model is at rest.

    Parameters
    ----------
    ratio
        Unbalanced force over the mean of the forces that are carried (drive.unbalanced_force), at which the
        run ends. It is looked at every 10 cycles, and after the last one. What moves must have come to rest
        as well: kinetic over strain energy is not greater than `ratio` either.
    limit
        Cycles after which it gives up.
    static
        With what leads to rest in few cycles, whatever DAMPING and FRACTION say
        (running/static_relaxation.py).
    criterion
        "max" or "mean", the unbalanced force that counts: the greatest, or the mean of all.

    Returns
    -------
    Solution
        True if rest was reached; with `cycles`, `ratio` and `remarks`.

    Raises
    ------
    UdecError
        10 or 28, and what may stop a run.

    Examples
    --------
    >>> bool(m.solve(1e-3, static=True))
    True
    >>> print(f"{m.table('contact')['KCFN'].sum():.4g}")  # N/m: the weight of the upper block
    4e+04
    """
    session.ensure_ready()
    not_negative(session.array, ratio=ratio, limit=whole(limit=limit))
    criterion = criterion_of(criterion)
    if static:
        return _solve_statically(session, ratio, limit, criterion)
    found = list(check_damping(session.array))
    session.report_remarks(found)
    if found:  # CYCLE need not say it again
        session.mark_as_reported(UNDAMPED)
    return _run_to_rest(session, ratio, limit, criterion, partial(_log_cycles, session))


def history(
    session: Session,
    n: int,
    field: str,
    address: int | None = None,
    at: Sequence[tuple[float, float]] | Sequence[float] = (),
    within: Sequence[float] | str = (),
) -> list[Series]:
    """HISTORY: record a number every few cycles.

    Parameters
    ----------
    n
        It is recorded in cycles that are multiples of this number.
    field
        A name of the field table, of a group or the common block, or a quantity of the whole model.
    address
        Of the group that has the field.
    at
        In place of it a point (x, y) in m, or several; the group nearest to each is taken.
    within
        A range, x1, x2, y1, y2 (m) or words, for "xreaction", "yreaction" and "mreaction": the sum is that of
        all that is held in it now.

    Returns
    -------
    list of Series
        The new histories. `numbers` of one, (k, 3), are cycle, time in s and value.

    Raises
    ------
    UdecError
        7, 8, 10, 24, 26, 28 or 30. Nothing is changed then.

    Examples
    --------
    >>> (series,) = m.history(10, "KY", at=(1, 1.5))
    >>> m.cycle(20)
    20
    >>> series.numbers[:, 0].tolist(), series.unit
    ([0.0, 10.0, 20.0], 'm')
    """
    session.ensure_ready()
    return session.recorder.add(session.array, n, field, address, at, within)


def histories(session: Session) -> list[Series]:
    """All histories.

    Returns
    -------
    list of Series
        In the order of their numbers.

    Examples
    --------
    >>> m.histories()
    []
    """
    return list(session.recorder.series)


def solutions(session: Session) -> list[Solution]:
    """How the SOLVEs have ended until now.

    Returns
    -------
    list of Solution
        In order.

    Examples
    --------
    >>> m.solutions()
    []
    """
    return list(session.recorder.solutions)


def _log_cycles(session: Session, n: int) -> None:
    """Log the `n` cycles of a run that ended early."""
    session.log.add(cycle, (n,), {})


def _solve_statically(session: Session, ratio: float, limit: int, criterion: str) -> Solution:
    session.inform(STATIC)
    named = {"static": True} | ({"criterion": criterion} if criterion == MEAN else {})
    undo = session.undo
    former = undo.former
    try:
        with static_settings(session.array):
            return _run_to_rest(
                session, ratio, limit, criterion, lambda done: session.log.add(solve, (ratio, done), named)
            )
    finally:
        if undo.former is not former:  # cycles are final, and the settings from before the command are back
            undo.confirm_run(session)


def _run_to_rest(session: Session, ratio: float, limit: int, criterion: str, log_part: LogPart) -> Solution:
    """Run up to `limit` cycles, to rest."""
    array, monitors = session.array, session.monitors
    diagnosis = RestDiagnosis(monitors.friction_until_rest(array))
    recording = _recording(session, ratio, criterion == MEAN)
    cycles = _run_cycles(session, limit, recording, log_part, [diagnosis])
    solution = diagnosis.complete(array, solution_of(array, ratio, criterion, cycles))
    session.recorder.solutions.append(solution)
    if solution:
        monitors.rested = float(array.h.cd[WFRIC])
    return solution


def _recording(session: Session, ratio: float = NEVER, mean: bool = False) -> Recording:
    """What a run records. ratio, mean: the force ratio at which it ends, as of SOLVE."""
    return Recording(session.array, session.recorder.series, ratio, mean, session.monitors.chatter.marks)


def _run_cycles(
    session: Session,
    n: int,
    recording: Recording,
    log_part: LogPart,
    observers: Sequence[Observer] = (),
    time: float | None = None,
) -> int:
    """Up to `n` cycles, with progress and files; returns how many were completed.

    log_part: logs the completed cycles when the run ends early. observers: besides those of the session.
    time: by which the model's time grows, in place of `n`.
    """
    array, undo, monitors = session.array, session.undo, session.monitors
    _arrange(session)
    goal = None
    if time is not None:
        prepare(array)
        goal = TimeGoal(array, time)
        n = goal.left
    _settle_defaults(session)
    progress = session.run_progress(n)
    before, left, cracks = int(array.h.ci[MCTOT]), int(array.h.ci[NLEFT]), len(cracks_made(array.h))
    structures = number_of_structures(array.h)

    def report(cycles: int) -> None:
        if goal is not None:  # a shorter step takes more of them
            progress.total = cycles + goal.left
        progress(cycles)

    def confirm_piece() -> None:
        """The cycles of a run until now are not undone, whatever ends it."""
        if mode.python:
            finish(array, recording)
        undo.confirm_piece(session)

    try:
        try:
            done = run(
                array,
                n,
                recording=recording,
                observers=(*observers, *session.observers, monitors),
                goal=goal,
                laws=session.laws,
                report=report,
                every=max(1, n // PICTURES) if session.animate else None,
                before_first_cycle=lambda: _warn(session),
                after_each_piece=confirm_piece,
            )
        finally:
            progress.close()
            _report_cracks(session, cracks)
            _report_deleted(session, left, structures)
        session.write_histories(recording)
    except BaseException:
        log_part(int(array.h.ci[MCTOT]) - before)  # they are not undone
        finish(array, recording)
        with suppress(UdecError, UdecWarning):  # of two errors the first one counts
            session.write_histories(recording)
        raise
    undo.confirm_run(session)
    return done


def _arrange(session: Session) -> None:
    """Put the groups in the order of their use, before a run."""
    array = session.array
    session.forget_boxes()
    if array.h.ci[MCTOT] == 0 or relaxations_due(array):
        session.undo.save_words(array)  # to be arranged, rounded, given masses and relaxations
    moved = arrange(array)
    if moved is not None:
        session.renumber(moved)


def _report_cracks(session: Session, before: int) -> None:
    """Report the cracks of a run, in which there were `before` of them at first."""
    rows = cracks_made(session.array.h)[before:] if session.array.h.ci[IFRPNT] else ()
    for row in rows[:SHOWN]:
        session.inform(crack_text(row))
    if len(rows) > SHOWN:
        session.inform(f"and {counted(len(rows) - SHOWN, 'crack')} more: PRINT CRACKS lists them")


def _report_deleted(session: Session, left: int, structures: int) -> None:
    """Report what a run deleted. left, structures: blocks that had left the scene, and structures, before."""
    h = session.array.h
    gone = int(h.ci[NLEFT]) - left
    if gone:
        verb = "was" if gone == 1 else "were"
        session.inform(f"{counted(gone, 'block')} left the limits of DELETE OUTSIDE and {verb} deleted")
        session.report_lost_structures(structures - number_of_structures(h))


def _settle_defaults(session: Session) -> None:
    """Give contacts the stiffness of their blocks, where it is missing; begin the account of friction."""
    for remark in settle_stiffness(session.array):
        session.inform(remark)
    session.monitors.friction_until_rest(session.array)


def _warn(session: Session) -> None:
    """Warn of the time-step and of suspicious input before a CYCLE; explain the step on request."""
    array, energy = session.array, session.monitors.energy
    shapes = block_shapes(array) if session.explain_step and array.h.ci[MCTOT] == 0 else None
    if shapes is not None:
        how = "" if array.h.ci[LROUND] else ", by default"
        session.inform(f"{shapes.short}; rounding length {array.h.cr[DTOL]:.4g} m{how}")
    energy.check_step(array, session.explain_step)
    if session.explain_step:
        session.inform(describe_step(array, energy.safe))
        session.report_remarks([describe_damping(array.h)], session.inform)
        if array.h.ci[LWATER]:
            session.inform(describe_flow(array))
    session.report_remarks([*check_input(array, session.laws.block_laws), *check_apertures(array)])
