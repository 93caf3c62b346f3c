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
from math import inf
from pathlib import Path
from typing import TextIO

from udec_ia.compiling.interpreting import mode
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.command_table import explain, summary
from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.heap_tools.memory_order import arrange
from udec_ia.kernels.drive.unbalanced import at_rest, at_rest_in_mean, force_ratios, motion_ratio, unbalanced
from udec_ia.kernels.energy.stored import liveliest
from udec_ia.layout.offsets import MCTOT, WFRIC
from udec_ia.methods.blocks import Blocks
from udec_ia.methods.files import Files
from udec_ia.methods.looks import Looks
from udec_ia.methods.numbers import Numbers
from udec_ia.ops.common.deformable_scene import soft_or_loaded_in
from udec_ia.ops.common.number_limits import not_negative, whole
from udec_ia.ops.run.aside import speed_after
from udec_ia.ops.run.cycle import cycle, finish
from udec_ia.ops.run.damped import UNDAMPED, damping
from udec_ia.ops.run.remarks import (
    on_joints,
    on_laws,
    on_loads,
    on_moduli,
    on_resolution,
    on_rest,
    on_rounding,
    on_slivers,
    on_softness,
)
from udec_ia.ops.run.scaling import relaxations_due
from udec_ia.ops.run.solution import MAX, MEAN, Solution, criterion_of
from udec_ia.ops.run.static import STATIC, statically
from udec_ia.ops.run.strides import given
from udec_ia.ops.run.timestep import bound, describe, kind_of
from udec_ia.ops.run.unrest import Unrest
from udec_ia.ops.run.watch import SOLVE_LIMIT, Series, Watch
from udec_ia.transaction import beside, looking, once

PICTURES = 40  # pictures that an animation takes during one CYCLE command
GIVEN = "given strides"  # of that which BOUNDARY moves, before the run
STRIDES = "strides"  # what they lose of a steady way is told once, after the run
RESOLUTION = "resolution"  # what reals of few bits lose is told once, before the run or after it

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
        return self._cycle(n, self._recorder.watch(self.array))

    @beside
    def solve(
        self, ratio: float, limit: int = SOLVE_LIMIT, *, static: bool = False, criterion: str = MAX
    ) -> Solution:
        """SOLVE: cycle until the unbalanced force ratio is `ratio` or less, at most `limit` cycles.

        static: with what leads to rest in few cycles, whatever DAMPING and FRACTION say (ops.run.static).
        criterion: "max" or "mean", the unbalanced force that counts: the greatest, or the mean of all.

        The ratio: that force over the mean of those that are carried (drive.unbalanced); it is looked at
        every 10 cycles, and after the last one. What moves must have come to rest as well: kinetic over
        strain energy is not greater than `ratio` either. What is returned is true if that was reached.
        """
        self._ready()
        not_negative(self.array, ratio=ratio, limit=whole(limit=limit))
        criterion = criterion_of(criterion)
        if not static:
            found = list(on_rest(self.array))
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
        unrest, mean = Unrest(self._guard.since_rest(self.array)), criterion == MEAN
        watch = Watch(self.array, self._recorder.series, ratio, mean, unrest)
        cycles = self._cycle(limit, watch, ended)
        h, kinds = self.array.h, soft_or_loaded_in(self.array.h)
        reached = cycles > 0 and bool((at_rest_in_mean if mean else at_rest)(h, float(ratio)))
        largest, average = map(float, force_ratios(h, kinds))
        worst, lively = (
            kind_of(h, int(at)) if at else "" for at in (unbalanced(h, kinds)[1], liveliest(h, kinds)[2])
        )
        state, why = unrest.explain(self.array, reached, ratio, self._guard, self._speed_after)
        solution = Solution(
            reached,
            ratio,
            largest,
            cycles,
            worst,
            float(motion_ratio(h, kinds)),
            lively,
            criterion,
            average,
            state,
            why,
        )
        self._recorder.solutions.append(solution)
        if reached:
            self._guard.rested = float(h.cd[WFRIC])
        return solution

    def _speed_after(self, ib: int, n: int) -> float:
        return inf if self.laws.given else speed_after(self.array, ib, n)  # a law may remember cycles

    def _cycle(self, n: int, watch: Watch | None, ended: Ended | None = None) -> int:
        """Up to `n` cycles under the eyes of `watch`, with progress and files; returns how many it were.

        ended: logs how many cycles are to stay when the run ends before its time; by default as a CYCLE.
        """
        self._boxes.forget()
        if self.array.h.ci[MCTOT] == 0 or relaxations_due(self.array):
            self.undo.keep(self.array)  # to be arranged, rounded, given masses and relaxations
        moved = arrange(self.array)
        if moved is not None:
            self.renumber(moved)
        self._guard.drift.begin(self.array)
        self._guard.since_rest(self.array)
        watch = self.around(watch)
        report = self.report(self.array, n)
        before = int(self.array.h.ci[MCTOT])
        try:
            every = max(1, n // PICTURES) if self.animate else None
            done = cycle(
                self.array,
                n,
                report,
                every,
                self._judge,
                self.laws,
                watch,
                lambda: self._settle(watch),
                self._guard,
            )
        except BaseException:
            ended = ended or (lambda n: self.log_part(Model.cycle, (n,), {}))
            ended(int(self.array.h.ci[MCTOT]) - before)  # they stay
            finish(self.array, watch)
            with suppress(UdecError):  # of two errors the first one counts
                self.keep(watch)
            raise
        finally:
            report.close()
        self.undo.afresh(self)
        self.keep(watch)
        lost = list(self._guard.strides.told(self.array))
        self.remark(lost, what=STRIDES)
        if not lost:
            self.remark(self._guard.drift.told(self.array), what=RESOLUTION)
        return done

    def _settle(self, watch: Watch | None) -> None:
        """The cycles of a run until now are to stay, whatever ends it."""
        if mode.python:
            finish(self.array, watch)
        self.undo.settle(self)

    @looking
    def step_limits(self) -> str:
        """One line: the time-step of the last CYCLE, its shares of estimate and bound, what sets these.

        Estimate and bound are those of the present state, which the cycles since then have made.
        """
        self._ready()
        return describe(self.array, bound(self.array))

    def _judge(self) -> None:
        """Judge the time-step and the materials of a CYCLE; explain the step if that is asked for."""
        self._guard.runaway.judge(self.array, self.explain_step)
        self._guard.strides.begin(self.array)
        if self.explain_step:
            self.inform(describe(self.array, self._guard.runaway.safe))
            self.remark([damping(self.array.h)], self.inform)
        self.remark(on_moduli(self.array, self.laws.block_laws))
        self.remark(on_laws(self.array))
        self.remark(on_joints(self.array))
        self.remark(on_loads(self.array))
        self.remark(list(on_rounding(self.array)) or on_slivers(self.array))
        self.remark(on_softness(self.array))
        self.remark(on_resolution(self.array), what=RESOLUTION)
        self.remark(given(self.array), what=GIVEN)

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
