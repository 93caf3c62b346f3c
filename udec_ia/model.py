"""The Python face of the program: one Model, with a method for every command of the deck language.

A Model owns one main array. Every method does what the command of the same name does, takes the numbers that
the command takes, and raises UdecError with the number that the command would print. Those that run stand
here, the others in methods/.

What a run has to say besides goes to the log "udec_ia", as warnings, which Python shows on standard error
unless it is told otherwise: that routines are being compiled, that a time-step may be unstable.

Every command is obeyed as a whole or not at all, whatever ends it (transaction.py).
"""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TextIO

from udec_ia.advice.damping_report import UNDAMPED, describe_damping
from udec_ia.advice.input_warnings import check_damping, check_input
from udec_ia.advice.rest_diagnosis import RestDiagnosis
from udec_ia.advice.step_warnings import describe_step
from udec_ia.compiling.interpreting import mode
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.command_table import explain, summary
from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.heap_tools.memory_order import arrange
from udec_ia.layout.offsets import MCTOT, WFRIC
from udec_ia.methods.blocks import Blocks
from udec_ia.methods.files import Files
from udec_ia.methods.looks import Looks
from udec_ia.methods.numbers import Numbers
from udec_ia.ops.common.number_limits import not_negative, whole
from udec_ia.running.critical_step import bound
from udec_ia.running.cycle import cycle, finish
from udec_ia.running.history_series import NEVER, SOLVE_LIMIT, Recording, Series
from udec_ia.running.mass_scaling import relaxations_due
from udec_ia.running.observer import Observer
from udec_ia.running.solve_result import MAX, MEAN, Solution, criterion_of, solution_of
from udec_ia.running.static_relaxation import STATIC, statically
from udec_ia.transaction import beside, looking, once

PICTURES = 40  # pictures that an animation takes during one CYCLE command

Ended = Callable[[int], None]


class Model(Files, Blocks, Numbers, Looks):
    """A block system and everything that was done to it.

    build: word scheme, "i16r32", "i32r32", "i16r64", "i32r64" or "i64r64".
    mtop: size of IA() in words, fixed as in 1980; None lets the array grow as needed.
    out: folder for plots and histories, and for restart files whose names are given in a deck or not at all;
    made when the first file is written.
    constitutive: laws of constitutive numbers 2 to 5 (udec_ia.laws): a file, the name of a law that comes
    with the program, a mapping from names to functions, or several of these; error 34 if one cannot be used.
    name: what the names of pictures and histories begin with.
    tell: takes what CYCLE has to warn of. explain_step: CYCLE and SOLVE say before they run what sets the
    time-step, as a deck has them do.
    """

    @looking
    def stop(self) -> str:
        """STOP: write what is still open and return the line that sums up the run."""
        self.close(self.array)
        return self.summary()

    def summary(self) -> str:
        """The line that sums up the run until now: what STOP returns, of files that are written by now."""
        return self.summary_of(self.array)

    def end(self) -> str:
        """END: the same as STOP, for a run that has not been stopped."""
        return self.stop()

    @staticmethod
    def help(command: str | None = None) -> str:
        """HELP: the forms of all commands, or what one of them does. Error 2 if there is no such command."""
        return summary() if command is None else explain(command)

    # ---- running

    @beside
    def cycle(self, n: int) -> int:
        """CYCLE: n calculation cycles. Returns how many were completed."""
        self._ready()
        not_negative(self.array, n=whole(n=n))
        return self._cycle(n, self._recording())

    @beside
    def solve(
        self, ratio: float, limit: int = SOLVE_LIMIT, *, static: bool = False, criterion: str = MAX
    ) -> Solution:
        """SOLVE: cycle until the unbalanced force ratio is `ratio` or less, at most `limit` cycles.

        static: with what leads to rest in few cycles, whatever DAMPING and FRACTION say
        (running.static_relaxation).
        criterion: "max" or "mean", the unbalanced force that counts: the greatest, or the mean of all.

        The ratio: that force over the mean of those that are carried (drive.unbalanced); it is looked at
        every 10 cycles, and after the last one. What moves must have come to rest as well: kinetic over
        strain energy is not greater than `ratio` either. What is returned is true if that was reached.
        """
        self._ready()
        not_negative(self.array, ratio=ratio, limit=whole(limit=limit))
        criterion = criterion_of(criterion)
        if not static:
            found = list(check_damping(self.array))
            self.remark(found)
            if found:  # CYCLE need not say it again
                self._said = self._said | {UNDAMPED}
            return self._to_rest(ratio, limit, criterion)
        self.inform(STATIC)
        begun = self.undo.before
        named = {"static": True} | ({"criterion": criterion} if criterion == MEAN else {})
        try:
            with statically(self.array):
                return self._to_rest(
                    ratio, limit, criterion, lambda n: self.log_part(Model.solve, (ratio, n), named)
                )
        finally:
            if self.undo.before is not begun:  # cycles are to stay, and with them what stood before
                self.undo.afresh(self)

    def _to_rest(self, ratio: float, limit: int, criterion: str, ended: Ended | None = None) -> Solution:
        """Up to `limit` cycles to rest; ended: as of _cycle."""
        diagnosis = RestDiagnosis(self._monitors.friction_until_rest(self.array))
        cycles = self._cycle(limit, self._recording(ratio, criterion == MEAN), ended, [diagnosis])
        solution = diagnosis.complete(self.array, solution_of(self.array, ratio, criterion, cycles))
        self._recorder.solutions.append(solution)
        if solution:
            self._monitors.rested = float(self.array.h.cd[WFRIC])
        return solution

    def _recording(self, ratio: float = NEVER, mean: bool = False) -> Recording:
        return Recording(self.array, self._recorder.series, ratio, mean, self._monitors.chatter.marks)

    def _cycle(
        self, n: int, recording: Recording, ended: Ended | None = None, observers: Sequence[Observer] = ()
    ) -> int:
        """Up to `n` cycles, with progress and files; returns how many it were.

        ended: logs how many cycles are to stay when the run ends before its time; by default as a CYCLE.
        observers: look on, besides those of the model.
        """
        self._boxes.forget()
        if self.array.h.ci[MCTOT] == 0 or relaxations_due(self.array):
            self.undo.keep(self.array)  # to be arranged, rounded, given masses and relaxations
        moved = arrange(self.array)
        if moved is not None:
            self.renumber(moved)
        self._monitors.friction_until_rest(self.array)
        report = self.report(self.array, n)
        before = int(self.array.h.ci[MCTOT])
        try:
            done = cycle(
                self.array,
                n,
                recording=recording,
                observers=(*observers, *self.observers, self._monitors),
                laws=self.laws,
                report=report,
                every=max(1, n // PICTURES) if self.animate else None,
                prepared=self._judge,
                settled=lambda: self._settle(recording),
            )
        except BaseException:
            ended = ended or (lambda n: self.log_part(Model.cycle, (n,), {}))
            ended(int(self.array.h.ci[MCTOT]) - before)  # they stay
            finish(self.array, recording)
            with suppress(UdecError):  # of two errors the first one counts
                self.keep(recording)
            raise
        finally:
            report.close()
        self.undo.afresh(self)
        self.keep(recording)
        return done

    def _settle(self, recording: Recording) -> None:
        """The cycles of a run until now are to stay, whatever ends it."""
        if mode.python:
            finish(self.array, recording)
        self.undo.settle(self)

    @looking
    def step_limits(self) -> str:
        """One line: the time-step of the last CYCLE, its shares of estimate and bound, what sets these.

        Estimate and bound are those of the present state, which the cycles since then have made.
        """
        self._ready()
        return describe_step(self.array, bound(self.array))

    def _judge(self) -> None:
        """Warn of the time-step and of suspicious input before a CYCLE; explain the step if asked to."""
        self._monitors.energy.judge(self.array, self.explain_step)
        if self.explain_step:
            self.inform(describe_step(self.array, self._monitors.energy.safe))
            self.remark([describe_damping(self.array.h)], self.inform)
        self.remark(check_input(self.array, self.laws.block_laws))

    @once
    def history(
        self,
        n: int,
        field: str,
        address: int | None = None,
        at: Sequence[tuple[float, float]] | Sequence[float] = (),
    ) -> list[Series]:
        """HISTORY: record the number called `field` every `n` cycles, at those that are multiples of `n`.

        field: a name of the field table, of a group or the common block, or a quantity of the whole model. A
        field of a group needs the address of a group of its kind, or at: a point (x, y) or several; the group
        nearest to each is taken. Returns the histories; `numbers` of one are what it has recorded.
        """
        self._ready()
        return self._recorder.add(self.array, n, field, address, at)

    def histories(self) -> list[Series]:
        """All histories, in the order of their numbers."""
        return list(self._recorder.series)

    def solutions(self) -> list[Solution]:
        """How the SOLVEs have ended until now, in order."""
        return list(self._recorder.solutions)

    def run(
        self, text_or_path: str | Path, stream: TextIO | None = None, values: Values | None = None
    ) -> str | None:
        """Run a deck, given as text or as the path of a file. Output goes to `stream` or is returned.

        values: of the variables of the deck, by name, numbers or words; they go before those of DEFAULT.
        FileNotFoundError if there is no file of that name, and it cannot be meant as a command either.
        """
        out = io.StringIO() if stream is None else stream
        run_deck(self, text_or_path, out, values)
        return out.getvalue() if isinstance(out, io.StringIO) else None

    def debug(
        self,
        deck: str,
        script: Sequence[str] | None = None,
        stream: TextIO | None = None,
        values: Values | None = None,
    ) -> str | None:
        """Run the text of a deck under the debugger, which is talked to at the terminal, or obeys `script`.

        What is printed goes to `stream`; with a script and no stream it is returned. values: as for `run`.
        """
        from udec_ia.debug import debug

        out = stream or (sys.stdout if script is None else io.StringIO())
        debug(self, deck, out, script, values=values)
        return out.getvalue() if isinstance(out, io.StringIO) else None
