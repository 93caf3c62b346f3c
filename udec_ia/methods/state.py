"""The state that all methods of a Model work on, and what is proved before they follow its addresses."""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import SupportsIndex, TypeVar

from udec_ia.checker import check_shapes
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.tracked_arrays import Writes, track
from udec_ia.heap.word_scheme import DEFAULT_SCHEME, scheme
from udec_ia.layout.offsets import LREADY
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.split_blocks import Boxes
from udec_ia.ops.laws.law_book import LawBook
from udec_ia.ops.laws.law_file import Given
from udec_ia.ops.run.guard import Guard
from udec_ia.session import NAME, Session
from udec_ia.transaction import Undo, beside

R = TypeVar("R")


class State(Session):
    """The base of Model, which explains the arguments."""

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
        self._guard = Guard(self.warn)
        model_settings.set_fraction(self.array, model_settings.DEFAULT_FRACTION)

    @property
    def h(self) -> Memory:
        """The array itself: IA() as integers and reals, h.ia and h.ra, and the common block, h.ci and h.cr.

        To be read freely. What is assigned to its words, as in h.cr[3] = 1.0, is proved sound before the next
        command that follows addresses, as after RSET. It is another object after commands that let the
        array grow: take it anew.
        """
        if self._lent is None or self._lent[0] is not self.array.h:
            self._lent = self.array.h, track(self.array.h, self.writes)
        return self._lent[1]

    def parts(self) -> Iterator[object]:
        """The objects that hold what is not in the main array."""
        yield from super().parts()
        yield self.laws
        yield self._guard
        yield self._guard.runaway

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

    @beside
    def start(self) -> None:
        """START: a cold start; whatever was there is gone."""
        self.array = MainArray(self.scheme, self.mtop)
        model_settings.set_fraction(self.array, model_settings.DEFAULT_FRACTION)
        self.laws.note({})
        self.begin()
        self._boxes.forget()
        self._touched = self._unproved = False
        self._guard = Guard(self.warn)
        self.started = True

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

    def _prove(self) -> None:
        """Error 20 with the first violation of links, numbers, outlines, or the use of memory."""
        for broken in check_shapes(self.array):
            raise UdecError(20, str(broken), "undo the change, or RESTART from a sound file")
        self._touched = self._unproved = False


def _words(mtop: SupportsIndex) -> int:
    """`mtop` as an integer; TypeError that says so if it is none."""
    try:
        return operator.index(mtop)
    except TypeError:
        raise TypeError(f"mtop is a number of words, an integer, not {mtop!r}") from None
