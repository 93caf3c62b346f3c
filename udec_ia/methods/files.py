"""SAVE and RESTART: a state goes into a restart file, and comes out of one."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Self

from udec_ia.checker import check
from udec_ia.counting import counted
from udec_ia.deck.command_monitor import RESTART_FILE
from udec_ia.errors import MESSAGES, spoilt
from udec_ia.heap.main_array import MainArray
from udec_ia.layout.offsets import MCSPOI, MCTOT, NBLK, NCON, NSPOIL, TIME
from udec_ia.methods.state import State
from udec_ia.ops.commands.history_definitions import definitions
from udec_ia.ops.common.array_growth import refit
from udec_ia.ops.laws.law_file import Given
from udec_ia.ops.run.guard import Guard
from udec_ia.printable import printable
from udec_ia.session import NAME
from udec_ia.transaction import beside


class Files(State):
    """Each method does what the command of its name does."""

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
            self._prove()
        broken = [str(one) for one in check(self.array)] if force else []
        if broken:
            self.tell(f"the state is unsound, and the file is marked so: {broken[0]}")
        target = self.out / RESTART_FILE if path is None else Path(path)
        folder, makes = target.parent, path is not None and not os.path.isdir(target.parent)
        written = save(self.array, target, self.deck_log, self.laws.record(), self._recorder.series, broken)
        self.note([written])
        if makes:
            self.inform(f"the folder {printable(str(folder))} did not exist and was created")
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
            self.tell(
                f"taken by force: CYCLE and other commands that follow links are refused while {unsound[0]}"
            )
        for warning in self.laws.note(laws):
            self.tell(warning)
        self._boxes.forget()
        self._touched, self._unproved = force, True
        self._guard = Guard(self.warn)
        self.started = True
        ci, name = array.h.ci, array.scheme.name
        self.inform(
            f"{printable(str(source))}: {counted(ci[NBLK], 'block')}, {counted(ci[NCON], 'contact')}, "
            f"{counted(ci[MCTOT], 'cycle')}, "
            f"t = {array.h.cd[TIME]:.4g} s, words of {name}"
        )
        if ci[NSPOIL] in MESSAGES:
            told = spoilt(int(ci[NSPOIL]), int(ci[MCSPOI]))
            self.tell(f"{told}: inspect it, and continue from a state before that")
        if array.scheme != self.scheme:
            self.inform(
                f"continues with the word scheme {array.scheme.name}, as saved; --build applies to START only"
            )

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
        self._guard = Guard(self.warn)

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
