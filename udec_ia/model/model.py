"""Model: one class with a method for every command of the deck language.

Every method does what the command of the same name does, takes the numbers that the command takes, and
raises UdecError with the number that the command would print. Warnings go to the log "udec_ia", which Python
shows on standard error by default.

Every command is executed as a whole or not at all, whatever ends it (undo.py).
"""

from __future__ import annotations

import copy
import io
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any, ParamSpec, Self, TextIO, TypeVar

from udec_ia.advice.input_warnings import check_initial_joints
from udec_ia.advice.time_step_warnings import describe_step
from udec_ia.checker import check, unchecked_parts
from udec_ia.deck.command_help import explain, summary
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.deck_variables import Values
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.heap_tools.patch_words import patch
from udec_ia.layout.offsets import MCTOT
from udec_ia.model import block_commands, cut_commands, model_runs, plot_command, saved_states, state_studies
from udec_ia.model import loading_commands as loading
from udec_ia.model import structure_commands as structures
from udec_ia.model import water_commands as water_commands
from udec_ia.model.method_wrappers import InSession, of_session, on_sound_outlines, takes_keywords
from udec_ia.model.model_session import NAME, Session
from udec_ia.model.undo import (
    changes_array,
    changes_common,
    changes_words,
    keeps_step,
    not_repeatable,
    outside_array,
    reads_file,
    removes_structures,
    shows,
)
from udec_ia.ops.commands import boundary_command as bounds
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.boundary_command import ZERO, Triple
from udec_ia.ops.commands.corner_rounding import round_corners
from udec_ia.ops.commands.create_block import create
from udec_ia.ops.commands.energy_account import Balance, balance, switch
from udec_ia.ops.commands.initial_stress import insitu
from udec_ia.ops.commands.outside_conditions import OutsideWater
from udec_ia.ops.common.number_limits import reals, whole
from udec_ia.ops.laws.law_file import Given
from udec_ia.output.printed_tables import printout
from udec_ia.output.word_dump import dump
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import range_of
from udec_ia.reader.group_tables import table
from udec_ia.running.critical_step import bound
from udec_ia.running.history_series import Series
from udec_ia.running.solve_result import Solution

P = ParamSpec("P")
R = TypeVar("R")


class Model:
    """A block system, and the commands that act on it.

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

        After assignments to its words, as in h.cr[3] = 1.0, the state is proved sound before the next command
        that follows addresses, as after RSET. Commands that let the array grow replace it: get it again after
        them.
        """
        return self.session.h

    def whole(self, action: Callable[[], R]) -> R:
        """Execute all commands that `action` gives to this model, or none of them if it raises."""
        return self.session.undo.run_whole(self, action)

    def deck(self) -> str:
        """The deck of all commands until now, from decks and Python, without SAVE and RESTART.

        What was given as `constitutive` is given with it again; words that were written through `h` cannot be
        expressed in it. The deck of a model from a restart file begins as that of the model that was saved.
        """
        return "".join(line + "\n" for line in self.session.log.lines)

    # ---- start and end, saved states

    @outside_array
    def start(self) -> None:
        """START: a cold start; everything before it is discarded."""
        self.session.start()

    save = outside_array(of_session(saved_states.save))
    stage = outside_array(of_session(saved_states.keep_stage))
    restart = outside_array(of_session(saved_states.restart))

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
        """STOP: write the open files and return the line that sums up the run."""
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
        numbers = reals(len(xy), xy=xy)
        self.session.ensure_ready()
        return create(self.array, list(zip(numbers[::2], numbers[1::2], strict=True)), material, constitutive)

    split = changes_array(of_session(cut_commands.split))
    polyline = changes_array(of_session(cut_commands.polyline))
    arc = changes_array(of_session(cut_commands.arc))
    tunnel = changes_array(of_session(cut_commands.tunnel))
    jset = changes_array(of_session(cut_commands.jset))
    voronoi = changes_array(of_session(cut_commands.voronoi))
    bricks = changes_array(of_session(cut_commands.bricks))
    voussoirs = changes_array(of_session(cut_commands.voussoirs))
    fractures = reads_file(of_session(cut_commands.fractures))

    delete = changes_array(of_session(block_commands.delete))
    velocity = changes_words(of_session(block_commands.velocity))
    fill = changes_array(of_session(block_commands.fill))
    tidy = changes_array(of_session(cut_commands.tidy))
    breakage = changes_array(of_session(cut_commands.breakage))
    cracks = shows(of_session(cut_commands.cracks))
    why_none = of_session(block_commands.why_none)

    @changes_array
    def fix(
        self, x1: float | str, x2: float | None = None, y1: float | None = None, y2: float | None = None
    ) -> int:
        """FIX: hold the blocks in the range. Returns their number."""
        self.session.ensure_ready()
        return model_settings.set_fixity(self.array, range_of(x1, x2, y1, y2), True)

    @changes_array
    def free(
        self, x1: float | str, x2: float | None = None, y1: float | None = None, y2: float | None = None
    ) -> int:
        """FREE: let the blocks in the range move. Returns their number."""
        self.session.ensure_ready()
        return model_settings.set_fixity(self.array, range_of(x1, x2, y1, y2), False)

    group = changes_array(of_session(block_commands.group))
    change = changes_array(of_session(block_commands.change))
    generate = changes_array(of_session(block_commands.generate))
    boundary = changes_array(takes_keywords(OutsideWater)(on_sound_outlines(bounds.boundary)))

    function = reads_file(of_session(loading.function))

    @changes_array
    def insitu(
        self,
        x1: float | str,
        x2: float | None = None,
        y1: float | None = None,
        y2: float | None = None,
        s11: float = 0.0,
        s12: float = 0.0,
        s22: float = 0.0,
        xgrad: Triple = ZERO,
        ygrad: Triple = ZERO,
    ) -> int:
        """INSITU: initial stresses of blocks in the range and of their joints. Returns how many blocks."""
        self.session.ensure_ready()
        xgrad, ygrad = reals(3, xgrad=xgrad), reals(3, ygrad=ygrad)
        where = range_of(x1, x2, y1, y2)
        done = insitu(self.array, where, (s11, s12, s22), xgrad, ygrad)
        self.session.report_remarks(check_initial_joints(done.exceeded))
        return done.blocks

    @changes_array
    def round(self, d: float) -> None:
        """ROUND: round every corner with the circle tangent at the distance d from it."""
        self.session.ensure_ready()
        round_corners(self.array, d)

    @changes_array
    def rset(self, v: float, ia: int, ioff: int) -> None:
        """RSET: write the real value v at offset ioff of the group at address ia."""
        self.session.ensure_ready(sound=False)
        model_settings.rset(self.array, v, ia, ioff)
        self.session.forget_boxes()
        self.session.written = True

    @changes_array
    def patch(self, assignments: str) -> None:
        """PATCH: change words of the array by name, as in "block@88.KXD = 0.5, FRAC = 0.1".

        All of them, and only if the state is sound with them (patch_words.py): else error 10, 28 or 30.
        """
        self.session.ensure_ready(sound=False)
        patch(self.array, assignments)
        self.session.forget_boxes()
        self.session.written = self.session.unproved = False

    # ---- materials, gravity, damping, time-step, energy

    property = changes_common(of_session(loading.property))
    gravity = changes_common(of_session(loading.gravity))

    jproperty = changes_array(of_session(block_commands.jproperty))
    damping = changes_common(of_session(block_commands.damping))

    # ---- structures

    sproperty = changes_array(of_session(structures.sproperty))
    bolt = changes_array(of_session(structures.bolt))
    cable = changes_array(of_session(structures.cable))
    beam = changes_array(of_session(structures.beam))
    remove = removes_structures(of_session(structures.remove))

    # ---- water

    fluid = changes_array(of_session(water_commands.fluid))
    ppressure = changes_array(of_session(water_commands.ppressure))
    flow = changes_array(of_session(water_commands.flow))
    water = shows(of_session(water_commands.water))
    pipes = shows(of_session(water_commands.pipes))

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

    @keeps_step
    def scale(self, s: float) -> None:
        """SCALE: plot scale."""
        self.session.ensure_ready(sound=False)
        model_settings.set_scale(self.array, s)

    # ---- running

    reset = changes_words(of_session(loading.reset))
    cycle = outside_array(of_session(model_runs.cycle))
    solve = outside_array(of_session(model_runs.solve))
    fos = shows(of_session(state_studies.fos))
    geometry = shows(of_session(state_studies.geometry))

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
        within: Sequence[float] | str = (),
    ) -> list[Series]:
        """HISTORY: record the number called `field` every `n` cycles, at those that are multiples of `n`.

        field: a name of the field table, of a group or the common block, or a quantity of the whole model. A
        field of a group needs the address of a group of its kind, or at: a point (x, y) or several; the group
        nearest to each is taken. within: a range, x1, x2, y1, y2 (m) or words, for "xreaction", "yreaction"
        and "mreaction": the sum is that of all that is held in it now. Returns the histories; `numbers` of
        one are what it has recorded.
        """
        self.session.ensure_ready()
        return self.session.recorder.add(self.array, n, field, address, at, within)

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

    reactions = shows(of_session(loading.reactions))

    def check(self) -> list[Any]:
        """All violations of the invariants of the map; empty when it is sound."""
        for sentence in unchecked_parts(self.array):
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
        """PRINT: the listings of `what`, one after the other, as text.

        what: groups, "list", "dlist", "reactions", "functions", "energy", "histories", "max", "cracks" or
        "water"
        """
        if any(word.lower() in ("energy", "reactions", "functions") for word in what):
            self.session.ensure_ready()
        return printout(self.array.h, *(word.lower() for word in what), series=self.session.recorder.series)

    @shows
    def dump(self, n: int, m: int) -> str:
        """DUMP: the words from address n to address m."""
        return dump(self.array.h, whole(n=n), whole(m=m))

    plot = shows(of_session(plot_command.plot))
    figure = shows(of_session(plot_command.figure))

    @shows
    def view(self, path: str | Path) -> Path:
        """Write the page `path` that shows the array beside the blocks, in a browser. Returns its name.

        Of several states make a `udec_ia.view.Page`. Error 31 if it cannot be written, or would replace
        another kind of file.
        """
        from udec_ia.view import Page

        page = Page()
        page.add(self.array, f"{self.name}, cycle {self.array.h.ci[MCTOT]}", self.session.log.lines)
        return page.write(path)

    @shows
    def export(self, path: str | Path) -> list[Path]:
        """Write the state for another program: `path` ends with .vtkhdf, .csv or .geojson. Returns the files.

        Of several states make a series with `udec_ia.export.export`. Error 10 for another ending, 31 if a
        file cannot be written, or would replace another kind of file.
        """
        from udec_ia.export import export

        return export(path, [self.array])

    # ---- decks

    def run(
        self, text_or_path: str | Path, stream: TextIO | None = None, values: Values | None = None
    ) -> str | None:
        """Run a deck, given as text or as the path of a file. Output goes to `stream` or is returned.

        values: of the variables of the deck, by name, numbers or words; they go before those of DEFAULT.
        FileNotFoundError if there is no file of that name, and it is no command either.
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
        """Run the text of a deck under the debugger, with commands from the terminal or from `script`.

        What is printed goes to `stream`; with a script and no stream it is returned. values: as for `run`.
        """
        from udec_ia.debug import debug

        out = stream or (sys.stdout if script is None else io.StringIO())
        debug(self, deck, out, script, values=values)
        return out.getvalue() if isinstance(out, io.StringIO) else None
