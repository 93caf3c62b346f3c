"""Model: one class with a method for every command of the deck language.

Every method does what the command of the same name does, takes the numbers that the command takes, and
raises UdecError with the number that the command would print. Warnings are Python warnings, UdecWarning.

Every command is executed as a whole or not at all, whatever ends it (undo.py).
"""

from __future__ import annotations

import copy
import io
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, ParamSpec, Self, TextIO, TypeVar

from udec_ia.deck.command_help import explain, summary
from udec_ia.deck.command_monitor import run_deck
from udec_ia.deck.deck_variables import Values
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import DEFAULT_SCHEME
from udec_ia.model import (
    block_commands,
    cut_commands,
    model_runs,
    pattern_commands,
    plot_command,
    saved_states,
    state_reports,
    water_commands,
)
from udec_ia.model import loading_commands as loading
from udec_ia.model import setting_commands as settings
from udec_ia.model import structure_commands as structures
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
from udec_ia.ops.commands.outside_conditions import OutsideWater
from udec_ia.ops.laws.law_file import Given

P = ParamSpec("P")
R = TypeVar("R")


class Model:
    """A block system, and the commands that act on it.

    Parameters
    ----------
    build
        Word scheme, "i16r32", "i32r32", "i16r64", "i32r64" or "i64r64".
    mtop
        Size of IA() in words, fixed as in 1980; None lets the array grow as needed.
    out
        Folder for plots and histories, and for restart files whose names are given in a deck or not at all;
        made when the first file is written.
    constitutive
        Laws of constitutive numbers 2 to 5 (udec_ia.laws): a file, the name of a law that comes with the
        program, a mapping from names to functions, or several of these.
    name
        Names of pictures and histories begin with it.

    Attributes
    ----------
    tell, inform
        Take warnings and information, by default as Python warnings and for the log.
    explain_step
        CYCLE and SOLVE report before they run what sets the time-step, as in a deck.
    progress
        Stream for the progress of CYCLE, or None; in a notebook its output, at first.
    animate
        CYCLE takes pictures for an animation.
    session
        Everything that belongs to the model, for programs that run it.

    Raises
    ------
    ValueError
        For a word scheme that does not exist, or an impossible size.
    UdecError
        34 if a law cannot be used.

    Notes
    -----
    In a `with` statement the files are closed at its end, as by STOP. Models can be copied and pickled. A
    copy continues bit for bit, and is independent.

    Examples
    --------
    >>> with Model(out=folder) as m:
    ...     m.block(0, 0, 0, 1, 1, 1, 1, 0)
    1
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

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        """STOP, also after an error."""
        self.stop()

    def __repr__(self) -> str:
        from udec_ia.model.notebook_display import one_line

        return one_line(self.session)

    def _repr_html_(self) -> str:
        """What a notebook shows. It changes nothing and raises nothing, whatever the state is."""
        from udec_ia.model.notebook_display import page

        return page(self.session)

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
        """Execute several commands, or none of them.

        Parameters
        ----------
        action
            A function that gives the commands to this model. If it raises, all of them are undone.

        Returns
        -------
        object
            What `action` returns.

        Examples
        --------
        >>> m.whole(lambda: m.split(1, 0.5, 1, 3) + m.fix("ALL"))
        4
        """
        return self.session.undo.run_whole(self, action)

    deck = of_session(saved_states.deck)

    # ---- start and end, saved states

    @outside_array
    def start(self) -> None:
        """START: a cold start; everything before it is discarded.

        Examples
        --------
        >>> m.start()
        >>> len(m.table("block"))
        0
        """
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
        """A new model from a restart file, in the word scheme of the file.

        Parameters
        ----------
        path
            The restart file.
        constitutive, mtop, out, name
            As for a new model. Runs side by side in one folder need different names.
        force, unchecked
            As for `restart`.

        Returns
        -------
        Model
            It continues bit for bit.

        Raises
        ------
        UdecError
            1, 10, 29 or 34.

        Examples
        --------
        >>> Model.restore(m.save()).check()
        []
        """
        model = cls(mtop=mtop, out=out, constitutive=constitutive, name=name)
        model.restart(path, force=force, unchecked=unchecked)
        model.session.scheme = model.array.scheme
        return model

    stop = shows(of_session(saved_states.stop))
    summary = of_session(saved_states.summary)

    def end(self) -> str:
        """END: the same as STOP, for a run that has not been stopped.

        Returns
        -------
        str
            The line that sums up the run.
        """
        return self.stop()

    @staticmethod
    def help(command: str | None = None) -> str:
        """HELP: the forms of all commands, or what one of them does.

        Parameters
        ----------
        command
            Its name, or None for all.

        Returns
        -------
        str
            Lines of text.

        Raises
        ------
        UdecError
            2 if there is no such command.

        Examples
        --------
        >>> Model.help("round").splitlines()[0]
        'Round d'
        """
        return summary() if command is None else explain(command)

    # ---- blocks, loads and words

    block = changes_array(of_session(block_commands.block))
    split = changes_array(of_session(cut_commands.split))
    polyline = changes_array(of_session(cut_commands.polyline))
    arc = changes_array(of_session(pattern_commands.arc))
    tunnel = changes_array(of_session(pattern_commands.tunnel))
    jset = changes_array(of_session(pattern_commands.jset))
    voronoi = changes_array(of_session(pattern_commands.voronoi))
    bricks = changes_array(of_session(pattern_commands.bricks))
    voussoirs = changes_array(of_session(pattern_commands.voussoirs))
    fractures = reads_file(of_session(cut_commands.fractures))

    delete = changes_array(of_session(block_commands.delete))
    velocity = changes_words(of_session(loading.velocity))
    fill = changes_array(of_session(block_commands.fill))
    tidy = changes_array(of_session(cut_commands.tidy))
    breakage = changes_array(of_session(settings.breakage))
    cracks = shows(of_session(state_reports.cracks))
    why_none = of_session(block_commands.why_none)

    fix = changes_array(of_session(loading.fix))
    free = changes_array(of_session(loading.free))
    group = changes_array(of_session(block_commands.group))
    change = changes_array(of_session(block_commands.change))
    generate = changes_array(of_session(block_commands.generate))
    boundary = changes_array(takes_keywords(OutsideWater)(on_sound_outlines(bounds.boundary)))

    function = reads_file(of_session(loading.function))

    insitu = changes_array(of_session(loading.insitu))
    round = changes_array(of_session(block_commands.round))
    rset = changes_array(of_session(settings.rset))
    patch = changes_array(of_session(settings.patch))

    # ---- materials, gravity, damping, time-step, energy

    property = changes_common(of_session(settings.property))
    gravity = changes_common(of_session(loading.gravity))

    jproperty = changes_array(of_session(settings.jproperty))
    damping = changes_common(of_session(settings.damping))
    fraction = changes_common(of_session(settings.fraction))
    scale = keeps_step(of_session(settings.scale))
    energy = keeps_step(of_session(settings.energy))
    balance = shows(of_session(state_reports.balance))

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

    # ---- running

    reset = changes_words(of_session(loading.reset))
    displacements = changes_array(of_session(loading.displacements))
    cycle = outside_array(of_session(model_runs.cycle))
    solve = outside_array(of_session(model_runs.solve))
    fos = shows(of_session(state_reports.fos))
    geometry = shows(of_session(state_reports.geometry))

    step_limits = shows(of_session(state_reports.step_limits))
    history = not_repeatable(of_session(model_runs.history))
    histories = of_session(model_runs.histories)
    solutions = of_session(model_runs.solutions)

    # ---- tables, pictures, checks

    table = of_session(state_reports.table)
    frame = of_session(state_reports.frame)
    reactions = shows(of_session(loading.reactions))

    info = of_session(state_reports.info)
    check = of_session(state_reports.check)
    check_file = staticmethod(state_reports.check_file)
    print = shows(of_session(state_reports.print))
    dump = shows(of_session(state_reports.dump))
    plot = shows(of_session(plot_command.plot))
    figure = shows(of_session(plot_command.figure))

    view = shows(of_session(state_reports.view))
    export = shows(of_session(state_reports.export))

    # ---- decks

    def run(
        self, text_or_path: str | Path, stream: TextIO | None = None, values: Values | None = None
    ) -> str | None:
        """Run a deck.

        Parameters
        ----------
        text_or_path
            Its text, or the path of a file.
        stream
            Takes the output; without it the output is returned.
        values
            Of the variables of the deck, by name, numbers or words; they go before those of DEFAULT.

        Returns
        -------
        str or None
            The output, in which warnings are lines.

        Raises
        ------
        UdecError
            As its commands do, with the place in the deck.
        FileNotFoundError
            If there is no file of that name, and it is no command either.

        Examples
        --------
        >>> print(m.run("FIX 0 2 1 2\\n"))
        > FIX 0 2 1 2
         FIX: 1 block fixed
        <BLANKLINE>
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
        """Run a deck under the debugger.

        Parameters
        ----------
        deck
            Its text.
        script
            Commands for the debugger; without it they come from the terminal.
        stream
            Takes what is printed; with a script and no stream it is returned.
        values
            As for `run`.

        Returns
        -------
        str or None
            What was printed.

        Examples
        --------
        >>> "reverse_step" in m.debug("FIX 0 2 1 2\\n", ["help"])
        True
        """
        from udec_ia.debug import debug

        out = stream or (sys.stdout if script is None else io.StringIO())
        debug(self, deck, out, script, values=values)
        return out.getvalue() if isinstance(out, io.StringIO) else None
