"""Undo: a command is executed as a whole or not at all, whatever ends it.

An interrupt, lack of memory, an exception in a user's function or a bug may end a command at any step. Its
changes are then undone: the common block and what the session holds in Python are restored from copies, which
cost nothing, and the words of IA() from a copy that costs as much as the whole model. So this copy serves
many commands: it comes with a list of the commands executed since. To undo one, the copy is restored and they
are repeated, which gives the same words bit for bit. A new copy is made when they have taken as long as a
hundred copies. So copying adds one or two per cent to the time of many commands, and undoing one takes little
more than a hundred copies do.

A command that raises a numbered error has changed no word: ops check before their first change, or go back
themselves. If groups were made or given back all the same, their words are restored too, and so are those of
the commands before it where several are executed as one.

CYCLE and SOLVE may end between two cycles, and what they have done until then is final (`confirm_piece`).
What follows them is undone as far as to their end (`confirm_run`). Compiled passes end only for lack of
memory, at a place from which the next CYCLE goes on (JPHASE). Interpreted and checked ones end at any place:
there the words are copied between the pieces of a run, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from time import perf_counter
from typing import Any, Concatenate, ParamSpec, TypeVar

import numpy as np

from udec_ia.compiling.build_choice import CHECKED, forget_kinds
from udec_ia.compiling.interpreted_kernels import mode
from udec_ia.errors import UdecError, WrongAddress
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import allow_signals, defer_signals
from udec_ia.kernels.links.relaxation_groups import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.model.command_log import Step
from udec_ia.ops.commands.joint_property_command import update_all_joints
from udec_ia.ops.commands.joint_stress_at_cuts import stressed_parts
from udec_ia.ops.commands.structure_command import update_structures
from udec_ia.ops.commands.water_command import update_water
from udec_ia.ops.common.attached_structures import has_structures, number_of_structures
from udec_ia.ops.common.number_limits import AfterChangesError
from udec_ia.printable_text import counted
from udec_ia.remark import Remark

P = ParamSpec("P")
R = TypeVar("R")
Method = Callable[Concatenate[Any, P], R]
Session = Any  # model_session.Session, which imports this module

REPEATED = 100.0  # a new copy is made when the steps since the last one have taken as long as so many copies
LISTS = [g.IRXPNT, g.IBNPNT, g.ISGPNT, g.IHPNT, g.IFWPNT, g.ISMPNT, g.IOUPNT, g.ICKPNT, g.IMBPNT]
LISTS += [g.IBRPNT, g.IFRPNT, g.IBTPNT, g.INDPNT, g.IELPNT]
# One of these changes when a group is made or given back.
COUNTS = [g.MFREE, g.JUNK, g.NBLK, g.NCON, g.NDOM, *LISTS]


@dataclass(frozen=True)
class Undoable:
    """Decorator of a method of Model, which is then executed as a whole or not at all, and logged.

    words: it may change words of IA(). new_step: the next CYCLE calculates masses and time-step again; with
    `words`, blocks may change, too, and what was made of them for the last CYCLE is given back. recorded:
    undoing a later command has to repeat it; repeatable: that gives the same state.
    """

    words: bool = False
    new_step: bool = False
    recorded: bool = True
    repeatable: bool = True
    reports_lost_structures: bool = True

    def __call__(self, method: Method[P, R]) -> Method[P, R]:
        """The method that is executed as a whole."""

        @wraps(method)
        def step(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
            if self.new_step:
                self._reset_step(model.session)
            model.array.moved = None
            changes_joints = self.words and self.new_step and model.array.h.ci[g.LJOINT]
            parts = stressed_parts(model.array) if changes_joints and model.session.is_sound() else None
            has_points = self.words and self.new_step and has_structures(model.array.h)
            structures = number_of_structures(model.array.h) if has_points and model.session.is_sound() else 0
            result = method(model, *args, **named)
            if self.words and self.new_step and model.array.h.ci[g.LJOINT] and model.session.is_sound():
                update_all_joints(model.array, parts)
                update_water(model.array)
            if structures and model.session.is_sound():
                lost = update_structures(model.array, structures)
                if self.reports_lost_structures:
                    model.session.report_lost_structures(lost)
            if model.array.moved is not None:
                model.session.renumber(model.array.moved)
            return result

        @wraps(method)
        def command(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
            """The method, executed as a whole."""
            session = model.session

            def action() -> R:
                if self.recorded:
                    session.undo.add_step(Step(step, args, named) if self.repeatable else None)
                if self.words:
                    session.undo.save_words(session.array)
                result = step(model, *args, **named)
                session.log_call(step, args, named)
                return result

            done: R = session.undo.run_whole(model, action)
            return done

        return command

    def _reset_step(self, session: Session) -> None:
        """Let the next CYCLE calculate masses and time-step again.

        In an unsound heap the list of relaxations may lead anywhere: it stays, and the method refuses to
        follow lists, or repairs some word.
        """
        h = session.array.h
        h.ci[g.LREADY] = 0
        if self.words and h.ci[g.IRXPNT] and session.is_sound():
            lose_relaxations(session.array.h)


changes_array = Undoable(words=True, new_step=True)  # any word may change
removes_structures = Undoable(words=True, new_step=True, reports_lost_structures=False)
not_repeatable = Undoable(words=True, repeatable=False)  # depends on objects in Python
changes_words = Undoable(words=True)  # from which neither masses nor the time-step follow
reads_file = Undoable(words=True, new_step=True, repeatable=False)  # which may be another one later
changes_common = Undoable(new_step=True)  # numbers of the common block only
keeps_step = Undoable()  # the same, of numbers that do not affect the time-step
outside_array = Undoable(recorded=False)  # objects in Python only, or the whole array is replaced


def shows(method: Method[P, R]) -> Method[P, R]:
    """A method of Model that shows or draws: it may take long, and interrupts do not wait for its end."""

    @wraps(method)
    def shown(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
        with allow_signals():
            return method(model, *args, **named)

    return outside_array(shown)


class FormerState:
    """A former state but for the words of IA(): what a session holds in Python, and the common block.

    A list of the session is replaced by another, or grows at its end: its length restores it.
    """

    def __init__(self, session: Session) -> None:
        self.array: MainArray = session.array
        self.h: Memory = session.array.h
        self.common = [part.copy() for part in common_block(self.h)]
        self.parts = [(part, vars(part).copy()) for part in session.parts()]
        self.lengths = [
            (value, len(value)) for _, own in self.parts for value in own.values() if type(value) is list
        ]

    def restore(self, session: Session) -> None:
        """Make the session as it was."""
        for part, own in self.parts:
            vars(part).clear()
            vars(part).update(own)
        for value, length in self.lengths:
            del value[length:]
        set_common_block(self.h, self.common)
        session.array.h = self.h
        session.forget_boxes()

    def same_groups(self, h: Memory) -> bool:
        """True if `h` has as many groups of every kind as there were."""
        return bool((h.ci[COUNTS] == self.common[0][COUNTS]).all())

    def same_common(self, h: Memory) -> bool:
        """True if `h` is the memory that was there, and its common block as it was, bit for bit."""
        return h is self.h and common_bits(h) == b"".join(part.tobytes() for part in self.common)


def common_block(h: Memory) -> tuple[Any, ...]:
    """The common block: its integers, reals and doubles."""
    return h.ci, h.cr, h.cd


def set_common_block(h: Memory, numbers: list[Any]) -> None:
    """Give the common block other numbers, in the order of `common_block`."""
    for part, former in zip(common_block(h), numbers, strict=True):
        part[:] = former


def common_bits(h: Memory) -> bytes:
    """The bits of the common block."""
    return b"".join(part.tobytes() for part in common_block(h))


class Undo:
    """Undoes an action on a model that raises; an action is one command or several.

    It keeps a copy of the words of IA(), and the commands since. Both give the words before an action.
    """

    def __init__(self) -> None:
        self.array: MainArray | None = None  # whose words were copied; None if there is no copy
        self.words: Any = np.zeros(0, np.int64)  # the copy
        self.common: list[Any] = []  # the common block that belongs to the copy
        self.copy_seconds = 0.0  # time that the copy took
        self.steps: list[Step] = []  # commands since the copy
        self.step_seconds = 0.0  # time that they took
        self.common_after = b""  # bits of the common block after them
        self.active = False  # an action goes on
        self.former: FormerState | None = None  # before the action; None if nothing of it is undone
        self.current: list[Step | None] = []  # commands of the action; None for one that cannot be repeated
        self.words_saved = False  # copy and steps give the words before the action
        self.partly_final = False  # pieces of a run were copied, as its passes may end at any place
        self._start = 0.0  # when the action began

    def run_whole(self, model: Any, action: Callable[[], R]) -> R:
        """Call `action`, and undo all that it did with `model` if it raises."""
        if self.active:
            return action()
        with defer_signals():
            try:
                self._begin(model.session)
                result = action()
                self._end(model.session)
            except BaseException as error:
                with defer_signals(also_second=True):
                    self._undo(model, error)
                raise
            finally:
                self.active, self.former = False, None
        return result

    def add_step(self, step: Step | None) -> None:
        """A command begins, `step` if it can be repeated. One that is executed within another cannot."""
        repeatable = step is not None and step.has_constants_only and not self.current
        self.current.append(step if repeatable else None)

    def save_words(self, array: MainArray) -> None:
        """Ensure that the words of `array` before the present action can be restored.

        Those of an array that the action has made, by START or RESTART, are not needed again.
        """
        if not self.words_saved and (self.former is None or self.former.array is array):
            follows = self.array is array and common_bits(array.h) == self.common_after
            if not follows or self.step_seconds > REPEATED * self.copy_seconds:
                self._copy(array)
            self.words_saved = True

    def confirm_piece(self, session: Session) -> None:
        """What was done until now is final: between two cycles."""
        self.former = None
        if mode.python or CHECKED:
            self._copy(session.array)
            self.words_saved, self.partly_final, self.former = True, True, FormerState(session)
        else:
            self.release()

    def confirm_run(self, session: Session) -> None:
        """What was done until now is final, and what follows is undone to here: a run has ended."""
        self.release()
        self.words_saved, self.partly_final, self.current = False, False, []
        self.former = FormerState(session)

    def release(self) -> None:
        """Discard the copy."""
        self.array, self.steps, self.words = None, [], np.zeros(0, np.int64)

    def _begin(self, session: Session) -> None:
        if session.writes.pending:
            session.note_writes()
            session.writes.pending = False
        self.current, self.words_saved, self.partly_final, self._start = [], False, False, perf_counter()
        self.former = FormerState(session)
        self.active = True

    def _end(self, session: Session) -> None:
        """Add what was done to the steps, or discard the copy if it is of no use any more.

        It is final before it is added: an exception in between costs the copy and no more.
        """
        array, self.array = self.array, None
        self.former = None
        if array is not None and array is session.array and None not in self.current:
            self.step_seconds += perf_counter() - self._start if self.current else 0.0
            self.common_after = common_bits(array.h)
            self.steps += [step for step in self.current if step is not None]
            if self.step_seconds > REPEATED * self.copy_seconds:
                self.steps = []
            else:
                self.array = array

    def _copy(self, array: MainArray) -> None:
        self.array, self.steps = None, []
        start, used = perf_counter(), int(array.h.ci[g.MFREE]) - 1
        if len(self.words) < used or self.words.dtype != array.h.ia.dtype:
            self.words = np.empty(2 * used, array.h.ia.dtype)
        self.words[:used] = array.h.ia[:used]
        # the action may have changed numbers before its first change of words
        self.common = [part.copy() for part in (self.former.common if self.former else common_block(array.h))]
        self.common_after = common_bits(array.h)
        self.step_seconds, self.copy_seconds = 0.0, perf_counter() - start
        self.array = array

    def _undo(self, model: Any, error: BaseException) -> None:
        """Restore everything as it was before the action."""
        former, session = self.former, model.session
        if former is None:
            return
        refused = isinstance(error, UdecError) and not isinstance(error, WrongAddress | AfterChangesError)
        if refused and self.partly_final and not mode.python:  # compiled passes have ended where they may
            return
        changed = self.words_saved and not (
            len(self.current) == 1 and refused and former.same_groups(session.array.h)
        )
        former.restore(session)
        if changed and not self._repeat(model, former):
            self._restore_words(former.h)
            text = f"lost: the last {counted(len(self.steps), 'command')}, which could not be repeated"
            self.array = None
            session.tell(Remark("commands-lost", text))

    def _repeat(self, model: Any, former: FormerState) -> bool:
        """Restore the copy and repeat the steps since then; False if that does not give the former state."""
        session = model.session
        self._restore_words(former.h)
        session.tell = session.inform = lambda _: None
        try:
            for step in self.steps:
                step.method(model, *step.args, **step.named)
            return former.same_common(session.array.h)
        except Exception:
            return False
        finally:
            former.restore(session)

    def _restore_words(self, h: Memory) -> None:
        """Restore the copy, into an array that may have grown since."""
        size, used = int(h.ci[g.MTOP]), int(self.common[0][g.MFREE]) - 1
        h.ia[:used] = self.words[:used]
        forget_kinds(h.ia)
        set_common_block(h, self.common)
        h.ci[g.MTOP] = size
