"""Undo: a command is obeyed as a whole or not at all, whatever ends it.

An interrupt, lack of memory, an exception in a user's function or a bug may end a command at any step. What
it has done until then is taken back: the common block and what the session holds in Python from copies that
cost nothing, the words of IA() from a copy that costs as much as the whole model. For a short command not to
pay for that, the copy is kept from one command to the next, with a list of the commands obeyed since. To
take one back the copy is put back and they are obeyed again, which gives the same words bit for bit. The copy
is made anew when they have taken as long as a hundred copies. So copying adds one or two per cent to the time
of many commands, and to take one back takes little more than a hundred copies do.

A command that raises a numbered error has changed no word: ops check before their first change, or go back
themselves. If groups were made or given back all the same, their words are taken back, too, and so are those
of the commands before it where several are obeyed as one.

CYCLE and SOLVE may end between two cycles, and what they have done until then stays (`confirm_piece`). What
follows them is taken back as far as to their end (`confirm_run`). Compiled passes stop by themselves for lack
of memory only, at a place from which the next CYCLE goes on (JPHASE). Interpreted and checked ones stop at
any place: there the words are copied between the pieces of a run, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import wraps
from time import perf_counter
from typing import Any, Concatenate, ParamSpec, Protocol, TypeVar

import numpy as np

from udec_ia.compiling.build_choice import CHECKED, forget_kinds
from udec_ia.compiling.interpreted_kernels import mode
from udec_ia.errors import UdecError, WrongAddress
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.write_tracking import Writes
from udec_ia.interrupt_signals import hold, passing
from udec_ia.kernels.links.relaxation_groups import lose_relaxations
from udec_ia.layout import offsets as g
from udec_ia.model.command_log import Step
from udec_ia.printable_text import counted

P = ParamSpec("P")
R = TypeVar("R")
Method = Callable[Concatenate[Any, P], R]

REPEATED = 100.0  # a copy is made anew when the commands since then have taken as long as so many copies
COUNTS = [g.MFREE, g.JUNK, g.NBLK, g.NCON, g.NDOM]  # one of them changes when a group is made or given back


@dataclass(frozen=True)
class Undoable:
    """Decorator of a method of Model, which is then obeyed as a whole or not at all, and logged.

    words: it may change words of IA(). new_step: the next CYCLE finds masses and time-step anew; with
    `words`, blocks may change, too, and what was made of them for the last CYCLE is given back. recorded:
    undoing a later command has to repeat it; repeatable: that gives the same state.
    """

    words: bool = False
    new_step: bool = False
    recorded: bool = True
    repeatable: bool = True

    def __call__(self, method: Method[P, R]) -> Method[P, R]:
        """The method that is obeyed as a whole."""

        @wraps(method)
        def work(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
            if self.new_step:
                self._forget_step(model.session)
            return method(model, *args, **named)

        @wraps(method)
        def obeyed(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
            session = model.session

            def obey() -> R:
                if self.recorded:
                    session.undo.add_step(Step(work, args, named) if self.repeatable else None)
                if self.words:
                    session.undo.save_words(session.array)
                result = work(model, *args, **named)
                session.log_call(work, args, named)
                return result

            done: R = session.undo.run_whole(model, obey)
            return done

        return obeyed

    def _forget_step(self, session: Any) -> None:
        """Let the next CYCLE find masses and time-step anew.

        In a heap that is unsound the list of relaxations may lead anywhere: it stays, and the method refuses
        to follow lists, or mends some word.
        """
        h = session.array.h
        h.ci[g.LREADY] = 0
        if self.words and h.ci[g.IRXPNT] and session.is_sound():
            lose_relaxations(session.array.h)


changes_array = Undoable(words=True, new_step=True)  # any word may change
not_repeatable = Undoable(words=True, repeatable=False)  # depends on objects in Python
changes_common = Undoable(new_step=True)  # numbers of the common block only
keeps_step = Undoable()  # the same, of numbers that do not affect the time-step
outside_array = Undoable(recorded=False)  # objects in Python only, or the whole array is replaced


def shows(method: Method[P, R]) -> Method[P, R]:
    """A method of Model that shows or draws: it may take long, and interrupts do not wait for its end."""

    @wraps(method)
    def shown(model: Any, /, *args: P.args, **named: P.kwargs) -> R:
        with passing():
            return method(model, *args, **named)

    return outside_array(shown)


class UndoSession(Protocol):
    """What undo needs of a session."""

    array: MainArray
    writes: Writes
    tell: Callable[[str], None]
    inform: Callable[[str], None]

    def parts(self) -> Iterator[object]:
        """The objects that hold what is not in the main array."""

    def note_writes(self) -> None:
        """Words were written through tracked arrays."""

    def forget_boxes(self) -> None:
        """Blocks are not where they were."""


class FormerState:
    """Everything but the words of IA(): what a session holds in Python, and the common block.

    A list of the session is put in place of another, or grows at its end: its length says how it was.
    """

    def __init__(self, session: UndoSession) -> None:
        self.array: MainArray = session.array
        self.h: Memory = session.array.h
        self.numbers = [part.copy() for part in common(self.h)]
        self.parts = [(one, vars(one).copy()) for one in session.parts()]
        self.lengths = [
            (value, len(value)) for _, held in self.parts for value in held.values() if type(value) is list
        ]

    def put_back(self, session: UndoSession) -> None:
        """Make the session as it was."""
        for one, held in self.parts:
            vars(one).clear()
            vars(one).update(held)
        for value, length in self.lengths:
            del value[length:]
        put_common(self.h, self.numbers)
        session.array.h = self.h
        session.forget_boxes()

    def same_groups(self, h: Memory) -> bool:
        """True if `h` has as many groups of every kind as there were."""
        return bool((h.ci[COUNTS] == self.numbers[0][COUNTS]).all())

    def same_common(self, h: Memory) -> bool:
        """True if `h` is the memory that was there, and its common block as it was, bit for bit."""
        return h is self.h and image(h) == b"".join(part.tobytes() for part in self.numbers)


def common(h: Memory) -> tuple[Any, ...]:
    """The common block: its integers, reals and doubles."""
    return h.ci, h.cr, h.cd


def put_common(h: Memory, numbers: Sequence[Any]) -> None:
    """Give the common block other numbers, in the order of `common`."""
    for part, kept in zip(common(h), numbers, strict=True):
        part[:] = kept


def image(h: Memory) -> bytes:
    """The bits of the common block."""
    return b"".join(part.tobytes() for part in common(h))


class Undo:
    """What it takes to take back the command that is being obeyed.

    words, ci, cr: those of `array` at some time. since: the commands obeyed since then, which took `seconds`;
    `cost` is how long the copy took. left: the common block at the end of the last of them.
    before: all but the words at the beginning of what is being done; None if that is to stay.
    settled: a part of it is to stay, of a run that passes may end at any place.
    doing: the commands of which that consists, None for one that cannot be repeated. covered: the words can
    be had again as they were then.
    """

    def __init__(self) -> None:
        self.array: MainArray | None = None
        self.words: Any = np.zeros(0, np.int64)
        self.since: list[Step] = []
        self.seconds = self.cost = 0.0
        self.busy = self.covered = self.settled = False
        self.before: FormerState | None = None
        self.doing: list[Step | None] = []

    def run_whole(self, model: Any, action: Callable[[], R]) -> R:
        """Call `action`, and undo all that it did with `model` if it raises."""
        if self.busy:
            return action()
        with hold():
            try:
                self._begin(model.session)
                result = action()
                self._end(model.session)
            except BaseException as error:
                with hold(firm=True):
                    self._take_back(model, error)
                raise
            finally:
                self.busy, self.before = False, None
        return result

    def add_step(self, step: Step | None) -> None:
        """A command begins, `step` if it can be repeated. One that is obeyed within another cannot."""
        self.doing.append(step if step is not None and step.lasts and not self.doing else None)

    def save_words(self, array: MainArray) -> None:
        """See to it that the words of `array` can be had again as they were before what is being done.

        Those of an array that has come in its course, by START or RESTART, are not needed again.
        """
        if not self.covered and (self.before is None or self.before.array is array):
            follows = self.array is array and image(array.h) == self.left
            if not follows or self.seconds > REPEATED * self.cost:
                self._copy(array)
            self.covered = True

    def confirm_piece(self, session: UndoSession) -> None:
        """What was done until now stays: between two cycles."""
        self.before = None
        if mode.python or CHECKED:
            self._copy(session.array)
            self.covered, self.settled, self.before = True, True, FormerState(session)
        else:
            self.release()

    def confirm_run(self, session: UndoSession) -> None:
        """What was done until now stays, and what follows is taken back to here: a run has ended."""
        self.release()
        self.covered, self.settled, self.doing, self.before = False, False, [], FormerState(session)

    def release(self) -> None:
        """Let go of the copy, and of its memory."""
        self.array, self.since, self.words = None, [], np.zeros(0, np.int64)

    def _begin(self, session: UndoSession) -> None:
        if session.writes.pending:
            session.note_writes()
            session.writes.pending = False
        self.doing, self.covered, self.settled, self._start = [], False, False, perf_counter()
        self.before = FormerState(session)
        self.busy = True

    def _end(self, session: UndoSession) -> None:
        """Record what was done, or that the copy is of no use any more.

        It is confirmed before it is recorded: an end in between costs the copy and no more.
        """
        array, self.array = self.array, None
        self.before = None
        if array is session.array and None not in self.doing:
            self.seconds += perf_counter() - self._start if self.doing else 0.0
            self.left = image(session.array.h)
            self.since += [step for step in self.doing if step is not None]
            if self.seconds > REPEATED * self.cost:
                self.since = []
            else:
                self.array = array

    def _copy(self, array: MainArray) -> None:
        self.array, self.since = None, []
        start, used = perf_counter(), int(array.h.ci[g.MFREE]) - 1
        if len(self.words) < used or self.words.dtype != array.h.ia.dtype:
            self.words = np.empty(2 * used, array.h.ia.dtype)
        self.words[:used] = array.h.ia[:used]
        # what is being done may have changed numbers before it came to words
        self.numbers = [part.copy() for part in (self.before.numbers if self.before else common(array.h))]
        self.left = image(array.h)
        self.seconds, self.cost = 0.0, perf_counter() - start
        self.array = array

    def _take_back(self, model: Any, error: BaseException) -> None:
        """Make everything as it was before what is being done."""
        before, session = self.before, model.session
        if before is None:
            return
        refused = isinstance(error, UdecError) and not isinstance(error, WrongAddress)
        if refused and self.settled and not mode.python:  # compiled passes have stopped where they may
            return
        changed = self.covered and not (
            len(self.doing) == 1 and refused and before.same_groups(session.array.h)
        )
        before.put_back(session)
        if changed and not self._repeat(model, before):
            self._put_words(before.h)
            session.tell(
                f"lost: the last {counted(len(self.since), 'command')}, which could not be obeyed once more"
            )
            self.array = None

    def _repeat(self, model: Any, before: FormerState) -> bool:
        """Put the copy back and obey the commands since then once more; False if that gives another state."""
        session = model.session
        self._put_words(before.h)
        session.tell = session.inform = lambda _: None
        try:
            for step in self.since:
                step.method(model, *step.args, **step.named)
            return before.same_common(session.array.h)
        except Exception:
            return False
        finally:
            before.put_back(session)

    def _put_words(self, h: Memory) -> None:
        """Put the copy back, into an array that may have grown since."""
        size, used = int(h.ci[g.MTOP]), int(self.numbers[0][g.MFREE]) - 1
        h.ia[:used] = self.words[:used]
        forget_kinds(h.ia)
        put_common(h, self.numbers)
        h.ci[g.MTOP] = size
