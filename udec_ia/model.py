"""The Python face of the program: one Model, with a method for every command of the deck language.

A Model owns one main array. Every method below does what the command of the same name does, takes the
numbers that the command takes, and raises UdecError with the number that the command would print.

What a run has to say besides goes to the log "udec_ia", as warnings, which Python shows on standard error
unless it is told otherwise: that routines are being compiled, that a time-step may be unstable.

Every command is obeyed as a whole or not at all, whatever ends it (transaction.py).
"""

from __future__ import annotations

import io
import operator
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Self, SupportsIndex, TextIO, TypeVar, Unpack

from udec_ia.deck.monitor import RESTART_FILE, run_deck
from udec_ia.deck.reference import explain, summary
from udec_ia.deck.variables import Values
from udec_ia.errors import MESSAGES, UdecError, spoilt
from udec_ia.heap.accessors import Memory
from udec_ia.heap.array import MainArray
from udec_ia.heap.interpreting import mode
from udec_ia.heap.lent import Writes, lend
from udec_ia.heap.words import DEFAULT_SCHEME, scheme
from udec_ia.inspect.arrange import arrange
from udec_ia.inspect.change import patch
from udec_ia.inspect.check import check, check_shapes, unjudged
from udec_ia.inspect.check.common import check_common
from udec_ia.inspect.table import table
from udec_ia.kernels.drive.unbalanced import at_rest, force_ratio, motion_ratio, unbalanced
from udec_ia.kernels.energy.stored import liveliest
from udec_ia.keywords import takes
from udec_ia.layout.material import Properties
from udec_ia.layout.offsets import DTOL, LREADY, MCSPOI, MCTOT, NBLK, NCON, NSPOIL, TIME, WFRIC
from udec_ia.ops.commands import settings
from udec_ia.ops.commands.boundary import ZERO, Triple, boundary, number_of_conditions, set_function
from udec_ia.ops.commands.change import change
from udec_ia.ops.commands.create import create
from udec_ia.ops.commands.delete import delete
from udec_ia.ops.commands.energy import Balance, balance, switch
from udec_ia.ops.commands.generate import NEAR, block_to_zone, generate
from udec_ia.ops.commands.generate_automatic import generate_automatically
from udec_ia.ops.commands.history import definitions
from udec_ia.ops.commands.insitu import insitu
from udec_ia.ops.commands.rounding import round_corners
from udec_ia.ops.commands.split import Boxes, split
from udec_ia.ops.commands.uncut import why_uncut
from udec_ia.ops.common.limits import not_negative, real, reals, rows, whole
from udec_ia.ops.common.memory import refit
from udec_ia.ops.common.ranges import limits_turned, why_no_block
from udec_ia.ops.common.soft import soft
from udec_ia.ops.laws.law_file import Given
from udec_ia.ops.laws.laws import LawBook
from udec_ia.ops.run.cycle import cycle, finish
from udec_ia.ops.run.remarks import (
    on_laws,
    on_loads,
    on_moduli,
    on_properties,
    on_resolution,
    on_rest,
    on_rounding,
)
from udec_ia.ops.run.runaway import Runaway
from udec_ia.ops.run.scaling import relaxations_due
from udec_ia.ops.run.static import STATIC, statically, way_taken
from udec_ia.ops.run.timestep import bound, describe, kind_of
from udec_ia.ops.run.watch import SOLVE_LIMIT, Series, Solution, Watch
from udec_ia.output.dump import dump
from udec_ia.output.printout import printout
from udec_ia.printable import printable
from udec_ia.session import NAME, Session
from udec_ia.transaction import Undo, beside, command, looking, numbers, once, steady

R = TypeVar("R")
PICTURES = 40  # pictures that an animation takes during one CYCLE command

Ended = Callable[[int], None]


class Model(Session):
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

    def __init__(
        self,
        build: str = DEFAULT_SCHEME,
        mtop: int | None = None,
        out: str | Path = ".",
        constitutive: Given | Iterable[Given] | None = None,
        name: str = NAME,
    ) -> None:
        super().__init__(out, name)
        self.mtop = None if mtop is None else _words(mtop)
        self.scheme = scheme(build)
        self.array = MainArray(self.scheme, self.mtop)
        self.laws = LawBook(constitutive)
        self.started = False
        self.undo = Undo()
        self.writes = Writes()
        self._lent: tuple[Memory, Memory] | None = None  # memory of IA(), and that which was lent for it
        self._boxes = Boxes()
        self._touched = False  # by RSET or through `h`, since links and outlines were last proved sound
        self._unproved = False  # outlines are those of a restart file, of which the links alone are proved
        self._runaway = Runaway(self.warn)
        settings.set_fraction(self.array, settings.DEFAULT_FRACTION)

    @property
    def h(self) -> Memory:
        """The array itself: IA() as integers and reals, h.ia and h.ra, and the common block, h.ci and h.cr.

        To be read freely. What is assigned to its words, as in h.cr[3] = 1.0, is proved sound before the next
        command that follows addresses, as after RSET. It is another object after commands that let the
        array grow: take it anew.
        """
        if self._lent is None or self._lent[0] is not self.array.h:
            self._lent = self.array.h, lend(self.array.h, self.writes)
        return self._lent[1]

    def parts(self) -> Iterator[object]:
        """The objects that hold what is not in the main array."""
        yield from super().parts()
        yield self.laws
        yield self._runaway

    def whole(self, action: Callable[[], R]) -> R:
        """Have all that `action` does with this model done, or nothing of it if it raises."""
        return self.undo.whole(self, action)

    def note_writes(self) -> None:
        """Something was written to the words that `h` lends: what follows them proves them first."""
        self.array.h.ci[LREADY] = 0
        self.forget_boxes()
        self.undo.array = None  # commands obeyed once more would not give these words
        self._touched = True

    def forget_boxes(self) -> None:
        """Blocks are not where SPLIT has seen them last."""
        self._boxes.forget()

    # ---- starting, saving, ending

    @beside
    def start(self) -> None:
        """START: a cold start; whatever was there is gone."""
        self.array = MainArray(self.scheme, self.mtop)
        settings.set_fraction(self.array, settings.DEFAULT_FRACTION)
        self.laws.note({})
        self.begin()
        self._boxes.forget()
        self._touched = self._unproved = False
        self._runaway = Runaway(self.warn)
        self.started = True

    @beside
    def save(self, path: str | Path | None = None, *, force: bool = False) -> Path:
        """SAVE: write the restart file `path`, by default restart.h5 in the folder `out`. Returns its name.

        Here as everywhere in Python a relative path starts from the working directory; in a deck, from `out`.
        It may replace a restart file; error 31 if anything else stands there, or if it cannot be written.
        force: also a state that is unsound, whatever has made it so; the file is marked with what `check`
        says, and RESTART takes it only by force.
        """
        from udec_ia.restart import save

        if self._touched and not force:
            self._prove(whole=True)
        broken = [str(one) for one in check(self.array)] if force else []
        if broken:
            self.tell(f"the state is unsound, and the file is marked: {broken[0]}")
        target = self.out / RESTART_FILE if path is None else Path(path)
        folder, makes = target.parent, path is not None and not os.path.isdir(target.parent)
        written = save(self.array, target, self.deck_log, self.laws.record(), self._recorder.series, broken)
        self.note([written])
        if makes:
            self.inform(f"the folder {printable(str(folder))} was not there and has been made")
        return written

    @beside
    def restart(self, path: str | Path | None = None, *, force: bool = False) -> None:
        """RESTART: go on from the restart file `path`, by default restart.h5 in the folder `out`.

        The words are those of the file's scheme; how many there may be is for `mtop` to say, whatever it was
        when they were saved. Pictures that are there stay: those to come take the next numbers. Error 29 if
        the file cannot be used, 1 if it holds more; the model is then as it was.
        force: take an unsound state, too, to look at it and to mend it through `h`; what follows links proves
        them first, as after RSET.
        """
        from udec_ia.restart import load

        source = self.out / RESTART_FILE if path is None else path
        array, deck_log, laws, series, said, unsound = load(source, force)
        refit(array, self.mtop)
        self.array = array
        self.go_on(deck_log, series)
        for sentence in said:
            self.tell(sentence)
        if unsound:
            self.tell(f"taken by force: CYCLE and all that follows links is refused while {unsound[0]}")
        for warning in self.laws.note(laws):
            self.tell(warning)
        self._boxes.forget()
        self._touched, self._unproved = force, True
        self._runaway = Runaway(self.warn)
        self.started = True
        ci, name = array.h.ci, array.scheme.name
        self.inform(
            f"{printable(str(source))}: {ci[NBLK]} blocks, {ci[NCON]} contacts, {ci[MCTOT]} cycles, "
            f"t = {array.h.cd[TIME]:.4g} s, words of {name}"
        )
        if ci[NSPOIL] in MESSAGES:
            told = spoilt(int(ci[NSPOIL]), int(ci[MCSPOI]))
            self.tell(f"{told}: look at it, and go on from one before that")
        if array.scheme != self.scheme:
            self.inform(f"goes on with the words of {array.scheme.name}, as saved; --build is for START")

    @beside
    def take_up(self, array: MainArray, lines: Sequence[str]) -> None:
        """Go on from a former state of this run, to which `lines` have led: what came later is forgotten."""
        self.array = array
        series = self._recorder.series[: len(definitions(array))]
        for one in series:
            one.until(int(array.h.ci[MCTOT]))
        self.go_on(lines, series)
        self._boxes.forget()
        self._touched, self._unproved = False, True
        self._runaway = Runaway(self.warn)

    @classmethod
    def restore(
        cls,
        path: str | Path,
        constitutive: Given | Iterable[Given] | None = None,
        *,
        force: bool = False,
        mtop: int | None = None,
        out: str | Path = ".",
        name: str = NAME,
    ) -> Self:
        """A new model from a restart file, in the word scheme of the file, with laws of the user's.

        force: as for `restart`. mtop, out, name: as for a new model. Runs that go on side by side in one
        folder need different names.
        """
        model = cls(mtop=mtop, out=out, constitutive=constitutive, name=name)
        model.restart(path, force=force)
        model.scheme = model.array.scheme
        return model

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

    def _ready(self, sound: bool = True, shapes: bool = False) -> None:
        """Start a model that was not started; with `sound`, prove the heap first if it has been written to.

        A routine that follows pointers must never meet one that RSET or Python has damaged, nor one that cuts
        or loads outlines (`shapes`) one of a restart file that crosses itself: error 20.
        """
        if not self.started:
            self.start()
        if self.writes.made:  # by the function that is obeyed as a whole, and it stays if that is taken back
            self.note_writes()
        if (sound and self._touched) or (shapes and self._unproved):
            self._prove()

    def is_sound(self) -> bool:
        """True if routines may follow the lists of the heap; proved, if words have been written to."""
        try:
            self._ready()
        except UdecError:
            return False
        return True

    def _prove(self, whole: bool = False) -> None:
        """Error 20 with the first violation of links, numbers or outlines that could mislead a routine.

        whole: with the first of all; else words that are lost for good are left to SAVE.
        """
        broken = check_common(self.array) or check_shapes(self.array)
        for one in broken:
            if whole or one.misleads:
                advice = "put back what was changed, or RESTART from a sound file"
                raise UdecError(20, str(one), advice)
        self._touched, self._unproved = bool(broken), False

    # ---- the block system

    @command
    def block(self, *xy: float, material: int = 1, constitutive: int = 1) -> int:
        """BLOCK: create the block with the corners x1, y1, x2, y2, ..., clockwise. Returns its address."""
        if len(xy) % 2:
            raise UdecError(8, f"{len(xy)} coordinates given", "give x1, y1, x2, y2, ...")
        self._ready()
        return create(self.array, list(zip(xy[::2], xy[1::2], strict=True)), material, constitutive)

    @command
    def split(self, x1: float, y1: float, x2: float, y2: float) -> int:
        """SPLIT: cut all blocks in the path of the line. Returns the number of new blocks (0: `why_none`)."""
        self._ready(shapes=True)
        return split(self.array, self._boxes, x1, y1, x2, y2)

    @command
    def delete(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """DELETE: remove the blocks whose centroids lie in the range. Returns their number."""
        self._ready()
        self._boxes.forget()
        return delete(self.array, (x1, x2, y1, y2))

    def why_none(self, command: str, a: float, b: float, c: float, d: float) -> str:
        """Why `command`, a method that was given these numbers and has returned 0, found nothing."""
        self._ready(shapes=command == "split")
        if command == "split":
            return why_uncut(self.array, self._boxes, a, b, c, d)
        if command != "boundary":
            return why_no_block(self.array, (a, b, c, d))
        there = "PRINT BOUNDARIES shows where they are" if number_of_conditions(self.h) else "there are none"
        return limits_turned((a, b, c, d)) or there

    @command
    def fix(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """FIX: hold the blocks in the range. Returns their number."""
        self._ready()
        return settings.set_fixity(self.array, (x1, x2, y1, y2), True)

    @command
    def free(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """FREE: let the blocks in the range move. Returns their number."""
        self._ready()
        return settings.set_fixity(self.array, (x1, x2, y1, y2), False)

    @command
    def change(
        self,
        x1: float,
        x2: float,
        y1: float,
        y2: float,
        type: str | None = None,
        material: int | None = None,
        constitutive: int | None = None,
    ) -> int:
        """CHANGE: attributes of the blocks in the range. Returns their number."""
        self._ready()
        conditions = number_of_conditions(self.array.h)
        kind = None if type is None else str(type).lower()
        changed = change(self.array, (x1, x2, y1, y2), kind, material, constitutive)
        self._tell_lost(conditions)
        return changed

    def _tell_lost(self, conditions: int) -> None:
        """Tell if there are less than `conditions` boundary conditions now."""
        lost = conditions - number_of_conditions(self.array.h)
        if lost > 0:
            self.tell(
                f"{lost} boundary condition{'s' if lost > 1 else ''} went with what "
                f"{'they' if lost > 1 else 'it'} acted on: give them again with BOUNDARY"
            )

    @command
    def generate(
        self,
        x1: float,
        x2: float,
        y1: float,
        y2: float,
        mode: str,
        gridpoints: list[tuple[float, float]] | None = None,
        zones: list[tuple[int, int, int]] | None = None,
        edge: float | None = None,
        mixed: bool = False,
    ) -> int:
        """GENERATE: divide the first block in the range into zones. Returns its address.

        mode: "manual", with `gridpoints` and `zones`, or "automatic", with `edge` (m). mixed: zones 1 and 2,
        3 and 4 ... are pairs for mixed discretisation.
        """
        self._ready(shapes=True)
        self._boxes.forget()
        points = rows(2, gridpoints=gridpoints)
        triples = [(whole(zones=i), whole(zones=j), whole(zones=k)) for i, j, k in rows(3, zones=zones)]
        conditions = number_of_conditions(self.array.h)
        ib = block_to_zone(self.array, (x1, x2, y1, y2))
        if mode.lower() == "manual":
            if not points or not triples:
                raise UdecError(
                    26, "GRIDPOINTS and ZONES are both needed", "GRIDPOINTS x y ... ZONES l m n ..."
                )
            if edge is not None:
                raise UdecError(10, "EDGE is for AUTOMATIC zones", parameter="edge")
            near = NEAR * float(self.array.h.cr[DTOL])
            for remark in generate(self.array, ib, [(x, y) for x, y in points], triples, near, mixed):
                self.tell(remark)
        elif mode.lower() == "automatic":
            if points or triples:
                blamed = "gridpoints" if points else "zones"
                raise UdecError(10, f"{blamed.upper()} are for MANUAL zones", parameter=blamed)
            if edge is None:
                raise UdecError(
                    7, "EDGE d", "AUTOMATIC EDGE d makes zones with sides of about d", parameter="mode"
                )
            self.inform(generate_automatically(self.array, ib, real(edge=edge), mixed))
        else:
            raise UdecError(22, mode, "take manual or automatic", parameter="mode")
        self._tell_lost(conditions)
        return ib

    @command
    def boundary(
        self,
        x1: float,
        x2: float,
        y1: float,
        y2: float,
        *,
        xvel: float | None = None,
        yvel: float | None = None,
        xforce: float = 0.0,
        yforce: float = 0.0,
        stress: Triple = ZERO,
        xgrad: Triple = ZERO,
        ygrad: Triple = ZERO,
        viscous: bool = False,
        sine: tuple[float, float] | None = None,
        function: int | None = None,
        free: bool = False,
    ) -> int:
        """BOUNDARY: conditions on what lies in the range (ops.commands.boundary). Returns their number."""
        self._ready(shapes=True)
        return boundary(
            self.array,
            (x1, x2, y1, y2),
            xvel=xvel,
            yvel=yvel,
            xforce=xforce,
            yforce=yforce,
            stress=reals(3, stress=stress),
            xgrad=reals(3, xgrad=xgrad),
            ygrad=reals(3, ygrad=ygrad),
            viscous=viscous,
            sine=None if sine is None else reals(2, sine=sine),
            function=function,
            free=free,
        )

    @command
    def function(self, n: int, *tf: float) -> None:
        """FUNCTION: the factors of function number n at times t: t1, f1, t2, f2, ..., for BOUNDARY."""
        if len(tf) % 2:
            raise UdecError(8, f"{len(tf)} numbers given", "give t1, f1, t2, f2, ...")
        self._ready()
        set_function(self.array, n, list(zip(tf[::2], tf[1::2], strict=True)))

    @command
    def insitu(
        self,
        x1: float,
        x2: float,
        y1: float,
        y2: float,
        s11: float,
        s12: float,
        s22: float,
        xgrad: Triple = ZERO,
        ygrad: Triple = ZERO,
    ) -> int:
        """INSITU: initial stresses of the deformable blocks in the range. Returns their number."""
        self._ready()
        xgrad, ygrad = reals(3, xgrad=xgrad), reals(3, ygrad=ygrad)
        return insitu(self.array, (x1, x2, y1, y2), (s11, s12, s22), xgrad, ygrad)

    @command
    def round(self, d: float) -> None:
        """ROUND: round every corner with the circle tangent at the distance d from it."""
        self._ready()
        round_corners(self.array, d)

    @command
    def rset(self, v: float, ia: int, ioff: int) -> None:
        """RSET: put the real value v at offset ioff of the group at address ia."""
        self._ready(sound=False)
        settings.rset(self.array, v, ia, ioff)
        self._boxes.forget()
        self._touched = True

    @command
    def patch(self, assignments: str) -> None:
        """PATCH: give words of the array other values by name, as in "block@88.KXD = 0.5, FRAC = 0.1".

        All of them, and only if the state is sound with them (inspect.change.patch): else error 10, 28 or 30.
        """
        self._ready(sound=False)
        patch(self.array, assignments)
        self._boxes.forget()
        self._touched = self._unproved = False

    # ---- numbers

    @numbers
    @takes(Properties)
    def property(self, material: int, **values: Unpack[Properties]) -> None:
        """PROPERTY: set properties of a material; those not given stay as they are.

        From dilation on they are for the laws of constitutive numbers 2 to 5 (udec_ia.laws).
        """
        self._ready()
        settings.set_property(self.array, material, **values)
        self.remark(on_properties(self.array, material, dict[str, float | None](**values)))

    @numbers
    def gravity(self, gx: float, gy: float) -> None:
        """GRAVITY: accelerations in the x and y directions."""
        self._ready(sound=False)
        settings.set_gravity(self.array, gx, gy)

    @numbers
    def damping(
        self,
        fcrit: float | None = None,
        freq: float | None = None,
        only: str | None = None,
        *,
        local: float | None = None,
        combined: float | None = None,
        kinetic: bool = False,
        adaptive: float | None = None,
    ) -> None:
        """DAMPING: Rayleigh damping; only "mass", only "stiffness", or "internal" (see set_damping).

        Or one of what else leads to rest: local, combined, kinetic or adaptive (see set_relaxation).
        """
        self._ready(sound=False)
        others = {"local": local, "combined": combined, "kinetic": kinetic or None, "adaptive": adaptive}
        given = {how: f for how, f in others.items() if f is not None}
        if len(given) + (fcrit is not None or freq is not None or only is not None) != 1:
            advice = "fcrit and freq, or one of " + ", ".join(word.upper() for word in others)
            raise UdecError(7, "DAMPING takes one kind of damping", advice, parameter="fcrit")
        for how, f in given.items():
            settings.set_relaxation(self.array, how, float(f))
        if not given:
            if fcrit is None or freq is None:
                raise UdecError(7, "freq" if fcrit is not None else "fcrit", parameter="fcrit")
            settings.set_damping(self.array, fcrit, freq, only.lower() if only else None)

    @steady
    def energy(self, state: str = "on") -> None:
        """ENERGY: "on": an account of the energy begins (see `balance`); "off": it ends."""
        self._ready()
        if state.lower() not in ("on", "off"):
            raise UdecError(10, f"ENERGY {state}", "ON or OFF", parameter="state")
        switch(self.array, state.lower() == "on")

    @looking
    def balance(self) -> Balance:
        """The account of the energy that PRINT ENERGY shows, in J per m of thickness.

        Error 26 unless energy("on") began one.
        """
        self._ready()
        return balance(self.array.h)

    @numbers
    def fraction(self, f: float, *, safe: bool = False, scaled: bool = False) -> None:
        """FRACTION: fraction of the critical time-step to be used; safe: of a bound on all modes.

        scaled: the same with inertial masses that make all degrees of freedom as quick as the quickest one.
        """
        self._ready(sound=False)
        settings.set_fraction(self.array, f, safe, scaled)

    @steady
    def scale(self, s: float) -> None:
        """SCALE: plot scale."""
        self._ready(sound=False)
        settings.set_scale(self.array, s)

    # ---- running

    @beside
    def cycle(self, n: int) -> int:
        """CYCLE: n calculation cycles. Returns how many were completed."""
        self._ready()
        not_negative(self.array, n=whole(n=n))
        return self._cycle(n, self._recorder.watch(self.array))

    @beside
    def solve(self, ratio: float, limit: int = SOLVE_LIMIT, *, static: bool = False) -> Solution:
        """SOLVE: cycle until the unbalanced force ratio is `ratio` or less, at most `limit` cycles.

        static: with what leads to rest in few cycles, whatever DAMPING and FRACTION say (ops.run.static).

        The ratio: greatest unbalanced force over the mean of those that are carried (drive.unbalanced); it is
        looked at every 10 cycles, and after the last one. What moves must have come to rest as well: kinetic
        over strain energy is not greater than `ratio` either. What is returned is true if that was reached.
        """
        self._ready()
        not_negative(self.array, ratio=ratio, limit=whole(limit=limit))
        if not static:
            self.remark(on_rest(self.array))
            return self._to_rest(ratio, limit)
        self.inform(STATIC)
        begun = self.undo.before
        try:
            with statically(self.array):
                friction = float(self.array.h.cd[WFRIC])
                solution = self._to_rest(
                    ratio, limit, lambda n: self.log_call(Model.solve, (ratio, n), {"static": True})
                )
            if said := way_taken(self.array, friction):
                self.inform(said)
            return solution
        finally:
            if self.undo.before is not begun:  # cycles are to stay, and with them what stood before
                self.undo.afresh(self)

    def _to_rest(self, ratio: float, limit: int, ended: Ended | None = None) -> Solution:
        """Up to `limit` cycles to rest; ended: as of _cycle."""
        watch = Watch(self.array, self._recorder.series, ratio)
        cycles = self._cycle(limit, watch, ended)
        h, kinds = self.array.h, soft(self.array)
        reached = cycles > 0 and bool(at_rest(h, float(ratio)))
        ends, motion = float(force_ratio(h, kinds)), float(motion_ratio(h, kinds))
        worst, lively = (
            kind_of(h, int(at)) if at else "" for at in (unbalanced(h, kinds)[1], liveliest(h, kinds)[2])
        )
        solution = Solution(reached, ratio, ends, cycles, worst, motion, lively)
        self._recorder.solutions.append(solution)
        return solution

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
                self._runaway,
            )
        except BaseException:
            ended = ended or (lambda n: self.log_call(Model.cycle, (n,), {}))
            ended(int(self.array.h.ci[MCTOT]) - before)  # they stay
            finish(self.array, watch)
            with suppress(UdecError):  # of two errors the first one counts
                self.keep(watch)
            raise
        finally:
            report.close()
        self.undo.afresh(self)
        self.keep(watch)
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
        self._runaway.judge(self.array, self.explain_step)
        if self.explain_step:
            self.inform(describe(self.array, self._runaway.safe))
        self.remark(on_moduli(self.array, self.laws.block_laws))
        self.remark(on_laws(self.array))
        self.remark(on_loads(self.array))
        self.remark(on_rounding(self.array))
        self.remark(on_resolution(self.array))

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

    # ---- looking

    def table(self, kind: str) -> Any:
        """One row a group: `address`, then the fields by the names of the table (see inspect.table)."""
        return table(self.array, kind)

    def check(self) -> list[Any]:
        """All violations of the invariants of the map; empty when it is sound."""
        for sentence in unjudged(self.array):
            self.inform(sentence)
        return list(check(self.array))

    @staticmethod
    def check_file(path: str | Path) -> list[Any]:
        """All violations in the restart file `path`, also if RESTART refuses it for them.

        Error 29 if it is not what SAVE wrote.
        """
        from udec_ia.restart import look_into

        return list(check(look_into(path)))

    @looking
    def print(self, *what: str) -> str:
        """PRINT: "blocks", "contacts", "corners", "domains", "list", "dlist", "energy", "histories"."""
        if any(word.lower() == "energy" for word in what):
            self._ready()
        return printout(self.array.h, *(word.lower() for word in what), series=self._recorder.series)

    @looking
    def dump(self, n: int, m: int) -> str:
        """DUMP: the words from address n to address m."""
        return dump(self.array.h, whole(n=n), whole(m=m))

    @looking
    def plot(
        self,
        n: int | None = None,
        *,
        contacts: bool = False,
        domains: bool = False,
        addresses: bool = False,
        stresses: bool = False,
        velocities: bool = False,
        displacements: bool = False,
        contour: str = "",
        history: bool = False,
        window: tuple[float, float, float, float] | None = None,
    ) -> list[Path]:
        """PLOT: start a frame (0, also if n is left off) or draw over the last one (1); the files written.

        contour: a key of field.CONTOURS. window: range x1, x2, y1, y2 (m) that is shown, or all blocks. With
        `history`, which stands alone, what was recorded is drawn instead. A frame of more than ten states is
        written when it has grown by a quarter, and when it ends: at `plot(0)` or `stop()`.
        """
        from udec_ia.output.plot import What

        what = What(
            contacts, domains, addresses, stresses, velocities, displacements, contour.lower(), window
        )
        if history:
            if n is not None or what != What():
                advice = "give PLOT HISTORY for the one, PLOT 0 for the other"
                raise UdecError(10, "histories are not plotted with blocks", advice, parameter="history")
            return self.draw_histories()
        self._ready()
        return self.draw(self.array, n or 0, what)

    @looking
    def view(self, path: str | Path) -> Path:
        """Write the page `path` that shows the array beside the blocks, in a browser. Returns its name.

        Of several states make a `udec_ia.view.Page`. Error 31 if something else stands there, or it cannot be
        written.
        """
        from udec_ia.view import Page

        page = Page()
        page.add(self.array, f"{self.name}, cycle {self.array.h.ci[MCTOT]}", self.deck_log)
        return page.write(path)


def _words(mtop: SupportsIndex) -> int:
    """`mtop` as an integer; TypeError that says so if it is none."""
    try:
        return operator.index(mtop)
    except TypeError:
        raise TypeError(f"mtop is a number of words, an integer, not {mtop!r}") from None
