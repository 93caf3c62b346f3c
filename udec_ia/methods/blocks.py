"""Commands that make blocks, cut them, load them, and change their words."""

from __future__ import annotations

from collections.abc import Callable
from functools import update_wrapper
from typing import Concatenate, ParamSpec, TypeVar

from udec_ia.counting import counted
from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.heap_tools.patch_words import patch
from udec_ia.layout.offsets import DTOL
from udec_ia.methods.state import State
from udec_ia.ops.commands import boundary_conditions as bounds
from udec_ia.ops.commands import model_settings
from udec_ia.ops.commands.boundary_conditions import ZERO, Triple, number_of_conditions, set_function
from udec_ia.ops.commands.change_or_delete_blocks import change, delete
from udec_ia.ops.commands.corner_rounding import round_corners
from udec_ia.ops.commands.create_block import create
from udec_ia.ops.commands.generate_zones import NEAR, block_to_zone, generate, generate_automatically
from udec_ia.ops.commands.initial_stress import insitu
from udec_ia.ops.commands.split_blocks import split, why_uncut
from udec_ia.ops.common.block_ranges import limits_turned, why_no_block
from udec_ia.ops.common.number_limits import real, reals, rows, whole
from udec_ia.ops.run.remarks import on_tension
from udec_ia.transaction import command

P = ParamSpec("P")
R = TypeVar("R")


def on_shapes(op: Callable[Concatenate[MainArray, P], R]) -> Callable[Concatenate[State, P], R]:
    """`op` as a method that takes what it takes: what looks at outlines, after these have been proved."""

    def method(model: State, /, *args: P.args, **named: P.kwargs) -> R:
        model._ready(shapes=True)
        return op(model.array, *args, **named)

    update_wrapper(method, op)
    return method


class Blocks(State):
    """Each method does what the command of its name does."""

    @command
    def block(self, *xy: float, material: int = 1, constitutive: int = 1) -> int:
        """BLOCK: create the block with the corners x1, y1, x2, y2, ..., clockwise. Returns its address."""
        if len(xy) % 2:
            raise UdecError(8, f"{counted(len(xy), 'coordinate')} given", "give x1, y1, x2, y2, ...")
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
        return model_settings.set_fixity(self.array, (x1, x2, y1, y2), True)

    @command
    def free(self, x1: float, x2: float, y1: float, y2: float) -> int:
        """FREE: let the blocks in the range move. Returns their number."""
        self._ready()
        return model_settings.set_fixity(self.array, (x1, x2, y1, y2), False)

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
                f"{counted(lost, 'boundary condition')} went with what "
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

    boundary = command(on_shapes(bounds.boundary))

    @command
    def function(self, n: int, *tf: float) -> None:
        """FUNCTION: the factors of function number n at times t: t1, f1, t2, f2, ..., for BOUNDARY."""
        if len(tf) % 2:
            raise UdecError(8, f"{counted(len(tf), 'number')} given", "give t1, f1, t2, f2, ...")
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
        many = insitu(self.array, (x1, x2, y1, y2), (s11, s12, s22), xgrad, ygrad)
        self.remark(on_tension((s11, s12, s22), (*xgrad, *ygrad)))
        return many

    @command
    def round(self, d: float) -> None:
        """ROUND: round every corner with the circle tangent at the distance d from it."""
        self._ready()
        round_corners(self.array, d)

    @command
    def rset(self, v: float, ia: int, ioff: int) -> None:
        """RSET: put the real value v at offset ioff of the group at address ia."""
        self._ready(sound=False)
        model_settings.rset(self.array, v, ia, ioff)
        self._boxes.forget()
        self._touched = True

    @command
    def patch(self, assignments: str) -> None:
        """PATCH: give words of the array other values by name, as in "block@88.KXD = 0.5, FRAC = 0.1".

        All of them, and only if the state is sound with them (patch_words.py): else error 10, 28 or 30.
        """
        self._ready(sound=False)
        patch(self.array, assignments)
        self._boxes.forget()
        self._touched = self._unproved = False
