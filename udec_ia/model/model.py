"""Model: one class with a method for every command of the deck language.

Every method does what the command of the same name does, takes the numbers that the command takes, and
raises UdecError with the number that the command would print. Warnings go to the log "udec_ia", which Python
shows on standard error by default.

Every command is obeyed as a whole or not at all, whatever ends it (undo.py).
"""

from __future__ import annotations

import copy
import inspect
import io
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import update_wrapper, wraps
from pathlib import Path
from typing import Any, Concatenate, Generic, ParamSpec, Self, TextIO, TypeVar, Unpack, get_type_hints

from udec_ia.advice.input_warnings import (
    check_fraction,
    check_new_material,
    check_properties,
    check_spin,
    check_tension,
    describe_inertia,
)
from udec_ia.advice.step_warnings import describe_step
from udec_ia.checker import check, unjudged
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.command_table import explain, summary
from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory, getr
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.heap_tools.patch_words import patch
from udec_ia.kernels.drive.damping_modes import MODES
from udec_ia.layout.material import Properties
from udec_ia.layout.offsets import DTOL, KTD, MCTOT
from udec_ia.model.model_runs import recording_of, run_cycles, solve_as_given, solve_statically
from udec_ia.model.model_session import NAME, Session
from udec_ia.model.saved_states import restart_from, save_state
from udec_ia.model.undo import changes_array, changes_common, keeps_step, not_repeatable, outside_array, shows
from udec_ia.ops.commands import boundary_conditions as bounds
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.boundary_conditions import ZERO, Triple, number_of_conditions, set_function
from udec_ia.ops.commands.change_or_delete_blocks import change, delete
from udec_ia.ops.commands.corner_rounding import round_corners
from udec_ia.ops.commands.create_block import create
from udec_ia.ops.commands.energy_account import Balance, balance, switch
from udec_ia.ops.commands.generate_zones import NEAR, block_to_zone, generate, generate_automatically
from udec_ia.ops.commands.initial_stress import insitu
from udec_ia.ops.commands.split_blocks import split, why_uncut
from udec_ia.ops.common.block_ranges import limits_turned, why_no_block
from udec_ia.ops.common.number_limits import not_negative, real, reals, rows, whole
from udec_ia.ops.laws.law_file import Given
from udec_ia.output.printed_tables import printout
from udec_ia.output.word_dump import dump
from udec_ia.printable import counted
from udec_ia.reader.group_tables import table
from udec_ia.running.critical_step import bound
from udec_ia.running.history_series import SOLVE_LIMIT, Series
from udec_ia.running.solve_result import MAX, MEAN, Solution, criterion_of

P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")


class InSession(Generic[T]):
    """An attribute of a Model that its session holds under the same name."""

    def __set_name__(self, _: type, name: str) -> None:
        self.name = name

    def __get__(self, model: Model | None, _: type | None = None) -> T:
        value: Any = self if model is None else getattr(model.session, self.name)
        return value  # type: ignore[no-any-return]

    def __set__(self, model: Model, value: T) -> None:
        setattr(model.session, self.name, value)


def on_shapes(op: Callable[Concatenate[MainArray, P], R]) -> Callable[Concatenate[Model, P], R]:
    """`op` as a method of the same arguments, for an operation that needs sound outlines."""

    def method(model: Model, /, *args: P.args, **named: P.kwargs) -> R:
        model.session.ensure_ready(shapes=True)
        return op(model.array, *args, **named)

    update_wrapper(method, op)
    return method


def takes_keywords(names: type) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """The method's **values are the keys of the TypedDict `names`, all optional. TypeError for any other."""

    def described(method: Callable[P, R]) -> Callable[P, R]:
        """`method` with the names in its signature, which are checked when it is called."""
        plain = inspect.signature(method)
        fixed = [one for one in plain.parameters.values() if one.kind is not one.VAR_KEYWORD]
        named = [
            inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None, annotation=kind)
            for name, kind in get_type_hints(names).items()
        ]
        signature = plain.replace(parameters=[*fixed, *named])

        @wraps(method)
        def checked(*args: P.args, **values: P.kwargs) -> R:
            try:
                signature.bind(*args, **values)
            except TypeError as error:
                raise TypeError(f"{method.__name__}() {error}") from None
            return method(*args, **values)

        checked.__signature__ = signature  # type: ignore[attr-defined]
        return checked

    return described


class Model:
    """A block system and everything that was done to it.

    build: word scheme, "i16r32", "i32r32", "i16r64", "i32r64" or "i64r64".
    mtop: size of IA() in words, fixed as in 1980; None lets the array grow as needed.
    out: folder for plots and histories, and for restart files whose names are given in a deck or not at all;
    made when the first file is written.
    constitutive: laws of constitutive numbers 2 to 5 (udec_ia.laws): a file, the name of a law that comes
    with the program, a mapping from names to functions, or several of these; error 34 if one cannot be used.
    name: names of pictures and histories begin with it.

    tell, inform: take warnings and information, by default for the log. explain_step: CYCLE and SOLVE report
    before they run what sets the time-step, as in a deck. progress: stream for the progress of CYCLE, or
    None. animate: CYCLE takes pictures for an animation. session: everything that belongs to the model, for
    programs that run it.

    Models can be copied and pickled. A copy continues bit for bit, and is independent.
    """

    out = InSession[Any]()
    name = InSession[str]()
    tell = InSession[Callable[[str], None]]()
    inform = InSession[Callable[[str], None]]()
    explain_step = InSession[bool]()
    progress = InSession[TextIO | None]()
    animate = InSession[bool]()

    def __init__(
        self,
        build: str = DEFAULT_SCHEME,
        mtop: int | None = None,
        out: str | Path = ".",
        constitutive: Given | Iterable[Given] | None = None,
        name: str = NAME,
    ) -> None:
        self.session = Session(build, mtop, out, constitutive, name)

    def __copy__(self) -> Model:
        return copy.deepcopy(self)

    @property
    def array(self) -> MainArray:
        """The main array, for the functions of this package that take one; it is to be read only."""
        return self.session.array

    @property
    def h(self) -> Memory:
        """The array itself: IA() as integers and reals, h.ia and h.ra, and the common block, h.ci and h.cr.

        To be read freely. What is assigned to its words, as in h.cr[3] = 1.0, is proved sound before the next
        command that follows addresses, as after RSET. It is another object after commands that let the
        array grow: take it anew.
        """
        return self.session.h

    def whole(self, action: Callable[[], R]) -> R:
        """Obey all commands that `action` gives to this model, or none of them if it raises."""
        return self.session.undo.run_whole(self, action)

    def deck(self) -> str:
        """The deck that does what was done until now, in decks and in Python: all but SAVE and RESTART.

        What was given as `constitutive` is given with it again; words that were written through `h` cannot be
        expressed in it. The deck of a model from a restart file begins as that of the model that was saved.
        """
        return "".join(line + "\n" for line in self.session.deck_log)

    # ---- start and end, saved states

    @outside_array
    def start(self) -> None:
        """START: a cold start; all that was there is gone."""
        self.session.start()

    @outside_array
    def save(self, path: str | Path | None = None, *, force: bool = False) -> Path:
        """SAVE: write the restart file `path`, by default restart.h5 in the folder `out`. Returns its name.

        Here as everywhere in Python a relative path starts from the working directory; in a deck, from `out`.
        It may replace a restart file; error 31 if anything else stands there, or if it cannot be written. A
        folder is created within `out` only.
        force: also a state that is unsound, whatever has made it so; the file is marked with the result of
        `check`, and RESTART takes it only by force.
        """
        return save_state(self.session, path, force)

    @outside_array
    def restart(
        self, path: str | Path | None = None, *, force: bool = False, unchecked: bool = False
    ) -> None:
        """RESTART: continue from the restart file `path`, by default restart.h5 in the folder `out`.

        The words are those of the file's scheme; `mtop` limits them, whatever the limit was when they were
        saved. Existing pictures are kept: new ones take the next numbers. Error 29 if the file cannot be used
        or `check` finds its state unsound, 1 if it holds more than `mtop`; the model is then as it was. A
        state of which an error has ended a run is proved in its links and codes only.
        force: take an unsound state, too, to look at it and to mend it through `h`; commands that follow
        links prove the state first. unchecked: prove links and codes only; commands that cut or load
        outlines, and SAVE, prove the rest.
        """
        restart_from(self.session, path, force, unchecked)

    @classmethod
    def restore(
        cls,
        path: str | Path,
        constitutive: Given | Iterable[Given] | None = None,
        *,
        force: bool = False,
        unchecked: bool = False,
        mtop: int | None = None,
        out: str | Path = ".",
        name: str = NAME,
    ) -> Self:
        """A new model from a restart file, in the word scheme of the file, with the user's laws.

        force, unchecked: as for `restart`. mtop, out, name: as for a new model. Runs side by side in one
        folder need different names.
        """
        model = cls(mtop=mtop, out=out, constitutive=constitutive, name=name)
        model.restart(path, force=force, unchecked=unchecked)
        model.session.scheme = model.array.scheme
        return model

    @shows
    def stop(self) -> str:
        """STOP: write what is still open and return the line that sums up the run."""
        self.session.close_files()
        return self.summary()

    def end(self) -> str:
        """END: the same as STOP, for a run that has not been stopped."""
        return self.stop()

    def summary(self) -> str:
        """The line that STOP returns, of the run until now and the files written by now."""
        return self.session.summary()

    @staticmethod
    def help(command: str | None = None) -> str:
        """HELP: the forms of all commands, or what one of them does. Error 2 if there is no such command."""
        return summary() if command is None else explain(command)

    # ---- blocks, loads and words

    @changes_array
    def block(self, *xy: float, material: int = 1, constitutive: int = 1) -> int:
        """BLOCK: create the block with the corners x1, y1, x2, y2, ..., clockwise. Returns its address."""
        if len(xy) % 2:
            raise UdecError(8, f"{counted(len(xy), 'coordinate')} given", "give x1, y1, x2, y2, ...")
        self.session.ensure_ready()
        return create(self.array, list(zip(xy[::2], xy[1::2], strict=True)), material, constitutive)

    @changes_array
    def split(self, x1: float, y1: float, x2: float, y2: float) -> int:
        """SPLIT: cut all blocks in the path of the line. Returns the number of new blocks (0: `why_none`)."""
        self.session.ensure_ready(shapes=True)
        return split(self.array, self.session.split_boxes, x1, y1, x2, y2)

    @changes_array
    def delete(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """DELETE: remove the blocks whose centroids lie in the range. Returns their number."""
        self.session.ensure_ready()
        self.session.forget_boxes()
        return delete(self.array, (x1, x2, y1, y2))

    def why_none(self, command: str, a: float, b: float, c: float, d: float) -> str:
        """Why `command`, a method that was given these numbers and has returned 0, found nothing."""
        self.session.ensure_ready(shapes=command == "split")
        if command == "split":
            return why_uncut(self.array, self.session.split_boxes, a, b, c, d)
        if command != "boundary":
            return why_no_block(self.array, (a, b, c, d))
        there = "PRINT BOUNDARIES shows where they are" if number_of_conditions(self.h) else "there are none"
        return limits_turned((a, b, c, d)) or there

    @changes_array
    def fix(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """FIX: hold the blocks in the range. Returns their number."""
        self.session.ensure_ready()
        return model_settings.set_fixity(self.array, (x1, x2, y1, y2), True)

    @changes_array
    def free(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """FREE: let the blocks in the range move. Returns their number."""
        self.session.ensure_ready()
        return model_settings.set_fixity(self.array, (x1, x2, y1, y2), False)

    @changes_array
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
        self.session.ensure_ready()
        conditions = number_of_conditions(self.array.h)
        kind = None if type is None else str(type).lower()
        changed = change(self.array, (x1, x2, y1, y2), kind, material, constitutive)
        if changed and material is not None:
            self.session.remark(check_new_material(self.array, changed, material))
        self._warn_of_lost(conditions)
        return changed

    @changes_array
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
        self.session.ensure_ready(shapes=True)
        self.session.forget_boxes()
        points = rows(2, gridpoints=gridpoints)
        triples = [(whole(zones=i), whole(zones=j), whole(zones=k)) for i, j, k in rows(3, zones=zones)]
        conditions = number_of_conditions(self.array.h)
        ib = block_to_zone(self.array, (x1, x2, y1, y2))
        spin = float(getr(self.array.h, ib, KTD))
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
        self._warn_of_lost(conditions)
        self.session.remark(describe_inertia(self.array, ib), self.session.inform)
        self.session.remark(check_spin(self.array, ib, spin))
        return ib

    boundary = changes_array(on_shapes(bounds.boundary))

    @changes_array
    def function(self, n: int, *tf: float) -> None:
        """FUNCTION: the factors of function number n at times t: t1, f1, t2, f2, ..., for BOUNDARY."""
        if len(tf) % 2:
            raise UdecError(8, f"{counted(len(tf), 'number')} given", "give t1, f1, t2, f2, ...")
        self.session.ensure_ready()
        set_function(self.array, n, list(zip(tf[::2], tf[1::2], strict=True)))

    @changes_array
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
        self.session.ensure_ready()
        xgrad, ygrad = reals(3, xgrad=xgrad), reals(3, ygrad=ygrad)
        many = insitu(self.array, (x1, x2, y1, y2), (s11, s12, s22), xgrad, ygrad)
        self.session.remark(check_tension((s11, s12, s22), (*xgrad, *ygrad)))
        return many

    @changes_array
    def round(self, d: float) -> None:
        """ROUND: round every corner with the circle tangent at the distance d from it."""
        self.session.ensure_ready()
        round_corners(self.array, d)

    @changes_array
    def rset(self, v: float, ia: int, ioff: int) -> None:
        """RSET: put the real value v at offset ioff of the group at address ia."""
        self.session.ensure_ready(sound=False)
        model_settings.rset(self.array, v, ia, ioff)
        self.session.forget_boxes()
        self.session.written = True

    @changes_array
    def patch(self, assignments: str) -> None:
        """PATCH: give words of the array other values by name, as in "block@88.KXD = 0.5, FRAC = 0.1".

        All of them, and only if the state is sound with them (patch_words.py): else error 10, 28 or 30.
        """
        self.session.ensure_ready(sound=False)
        patch(self.array, assignments)
        self.session.forget_boxes()
        self.session.written = self.session.unproved = False

    def _warn_of_lost(self, conditions: int) -> None:
        """Warn if there are less than `conditions` boundary conditions now."""
        lost = conditions - number_of_conditions(self.array.h)
        if lost > 0:
            self.session.tell(
                f"{counted(lost, 'boundary condition')} went with what "
                f"{'they' if lost > 1 else 'it'} acted on: give them again with BOUNDARY"
            )

    # ---- materials, gravity, damping, time-step, energy

    @changes_common
    @takes_keywords(Properties)
    def property(self, material: int, **values: Unpack[Properties]) -> None:
        """PROPERTY: set properties of a material; those not given stay as they are.

        From dilation on they are for the laws of constitutive numbers 2 to 5 (udec_ia.laws).
        """
        self.session.ensure_ready()
        model_settings.set_property(self.array, material, **values)
        self.session.remark(check_properties(self.array, material, dict[str, float | None](**values)))

    @changes_common
    def gravity(self, gx: float, gy: float) -> None:
        """GRAVITY: accelerations in the x and y directions."""
        self.session.ensure_ready(sound=False)
        model_settings.set_gravity(self.array, gx, gy)

    @changes_common
    @takes_keywords(type("Modes", (), {"__annotations__": {one.argument: float | None for one in MODES}}))
    def damping(
        self,
        /,
        fcrit: float | None = None,
        freq: float | None = None,
        only: str | None = None,
        **modes: float | None,
    ) -> None:
        """DAMPING: Rayleigh damping; only "mass", only "stiffness", or "internal" (see set_damping).

        Or one of the modes that lead to rest: local=f, combined=f, kinetic=True, adaptive=f
        (kernels.drive.damping_modes).
        """
        self.session.ensure_ready(sound=False)
        asked = {one: modes.get(one.argument) for one in MODES}
        given = {one: f for one, f in asked.items() if f is not None and f is not False}
        if len(given) + (fcrit is not None or freq is not None or only is not None) != 1:
            advice = "fcrit and freq, or one of " + ", ".join(one.name for one in MODES)
            raise UdecError(7, "DAMPING takes one kind of damping", advice, parameter="fcrit")
        for mode, f in given.items():
            model_settings.set_damping_mode(self.array, mode, float(f))
        if not given:
            if fcrit is None or freq is None:
                raise UdecError(7, "freq" if fcrit is not None else "fcrit", parameter="fcrit")
            model_settings.set_damping(self.array, fcrit, freq, only.lower() if only else None)

    @keeps_step
    def energy(self, state: str = "on") -> None:
        """ENERGY: "on": an account of the energy begins (see `balance`); "off": it ends."""
        self.session.ensure_ready()
        if state.lower() not in ("on", "off"):
            raise UdecError(10, f"ENERGY {state}", "ON or OFF", parameter="state")
        switch(self.array, state.lower() == "on")

    @shows
    def balance(self) -> Balance:
        """The account of the energy that PRINT ENERGY shows, in J per m of thickness.

        Error 26 unless energy("on") began one.
        """
        self.session.ensure_ready()
        return balance(self.array.h)

    @changes_common
    def fraction(self, f: float, *, safe: bool = False, scaled: bool = False) -> None:
        """FRACTION: fraction of the critical time-step to be used; safe: of a bound on all modes.

        scaled: the same with inertial masses that make all degrees of freedom as quick as the quickest one.
        """
        self.session.ensure_ready(sound=False)
        model_settings.set_fraction(self.array, f, safe, scaled)
        self.session.remark(check_fraction(f))

    @keeps_step
    def scale(self, s: float) -> None:
        """SCALE: plot scale."""
        self.session.ensure_ready(sound=False)
        model_settings.set_scale(self.array, s)

    # ---- running

    @outside_array
    def cycle(self, n: int) -> int:
        """CYCLE: n calculation cycles. Returns how many were completed."""
        self.session.ensure_ready()
        not_negative(self.array, n=whole(n=n))
        return run_cycles(self.session, n, recording_of(self.session), self._log_cycles)

    def _log_cycles(self, n: int) -> None:
        """Log the `n` cycles of a run that has ended early."""
        self.session.log_part(Model.cycle, (n,), {})

    @outside_array
    def solve(
        self, ratio: float, limit: int = SOLVE_LIMIT, *, static: bool = False, criterion: str = MAX
    ) -> Solution:
        """SOLVE: cycle until the unbalanced force ratio is `ratio` or less, at most `limit` cycles.

        static: with what leads to rest in few cycles, whatever DAMPING and FRACTION say
        (running/static_relaxation.py).
        criterion: "max" or "mean", the unbalanced force that counts: the greatest, or the mean of all.

        The ratio: that force over the mean of those that are carried (drive.unbalanced_force). It is looked
        at every 10 cycles, and after the last one. What moves must have come to rest as well: kinetic over
        strain energy is not greater than `ratio` either. What is returned is true if that was reached.
        """
        session = self.session
        session.ensure_ready()
        not_negative(self.array, ratio=ratio, limit=whole(limit=limit))
        criterion = criterion_of(criterion)
        if not static:
            return solve_as_given(session, ratio, limit, criterion, self._log_cycles)
        named = {"static": True} | ({"criterion": criterion} if criterion == MEAN else {})

        def log_part(done: int) -> None:
            session.log_part(Model.solve, (ratio, done), named)

        return solve_statically(session, ratio, limit, criterion, log_part)

    @shows
    def step_limits(self) -> str:
        """One line: the time-step of the last CYCLE, its shares of estimate and bound, what sets these.

        Estimate and bound are those of the present state, which the cycles since then have made.
        """
        self.session.ensure_ready()
        return describe_step(self.array, bound(self.array))

    @not_repeatable
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
        self.session.ensure_ready()
        return self.session.recorder.add(self.array, n, field, address, at)

    def histories(self) -> list[Series]:
        """All histories, in the order of their numbers."""
        return list(self.session.recorder.series)

    def solutions(self) -> list[Solution]:
        """How the SOLVEs have ended until now, in order."""
        return list(self.session.recorder.solutions)

    # ---- tables, pictures, checks

    def table(self, kind: str) -> Any:
        """One row a group: `address`, then the fields by the names of the table (reader/group_tables.py)."""
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

    @shows
    def print(self, *what: str) -> str:
        """PRINT: "blocks", "contacts", "corners", "domains", "list", "dlist", "energy", "histories"."""
        if any(word.lower() == "energy" for word in what):
            self.session.ensure_ready()
        return printout(self.array.h, *(word.lower() for word in what), series=self.session.recorder.series)

    @shows
    def dump(self, n: int, m: int) -> str:
        """DUMP: the words from address n to address m."""
        return dump(self.array.h, whole(n=n), whole(m=m))

    @shows
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
        from udec_ia.output.plot_frames import What

        what = What(
            contacts, domains, addresses, stresses, velocities, displacements, contour.lower(), window
        )
        if history:
            if n is not None or what != What():
                advice = "use PLOT HISTORY for histories, PLOT 0 for blocks"
                raise UdecError(
                    10, "histories and blocks are not plotted together", advice, parameter="history"
                )
            return self.session.draw_histories()
        self.session.ensure_ready()
        return self.session.draw(n or 0, what)

    @shows
    def view(self, path: str | Path) -> Path:
        """Write the page `path` that shows the array beside the blocks, in a browser. Returns its name.

        Of several states make a `udec_ia.view.Page`. Error 31 if something else stands there, or it cannot be
        written.
        """
        from udec_ia.view import Page

        page = Page()
        page.add(self.array, f"{self.name}, cycle {self.array.h.ci[MCTOT]}", self.session.deck_log)
        return page.write(path)

    # ---- decks

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
