"""Cuts of all blocks along curves: division of each block (block_division.py), and its cuts one by one.

Everything is found before the first block is cut. Where a division would leave an edge or an angle that SPLIT
refuses, the cut is refused with its place, or the curve is left out of that block.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.kernels.split.line_crossing import rounding_is_open
from udec_ia.kernels.split.polyline_cut import NOT_ON_OUTLINE, cut_along
from udec_ia.kernels.split.split import DONE, NO_MEMORY, REFUSED_CLOSE, REFUSED_SHORT, cutting
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.corner_rounding import update_flagged
from udec_ia.ops.commands.generate_zones import Outline
from udec_ia.ops.commands.split_blocks import ROUNDINGS, Boxes, refuse
from udec_ia.ops.common.array_growth import all_or_nothing, find_room, keep_spare
from udec_ia.ops.common.kernel_arguments import renew_forces, soft_or_loaded_in
from udec_ia.ops.common.number_limits import EDGE_DIGITS, finite, last_digit
from udec_ia.ops.cuts.block_division import Division, Reals, Refused, divide, refusals
from udec_ia.ops.cuts.cut_order import cuts_of
from udec_ia.ops.cuts.cut_zoned_blocks import Rezoned, ZonedCut, near_points
from udec_ia.reader.zone_rows import has_zones


@dataclass
class Cuts:
    """What curves have cut: new blocks, slits to holes, ends of curves inside blocks, and parts left out.

    dead_ends: with the number of the curve of each. left_out: places where a curve would have left too short
    an edge or too sharp an angle. zoned: blocks with zones that were cut.
    """

    blocks: int = 0
    slits: int = 0
    dead_ends: list[tuple[Reals, int]] = field(default_factory=list)
    left_out: list[Refused] = field(default_factory=list)
    zoned: list[Rezoned] = field(default_factory=list)

    def add(self, more: Cuts) -> None:
        """Add what other curves have cut."""
        self.blocks += more.blocks
        self.slits += more.slits
        self.dead_ends += more.dead_ends
        self.left_out += more.left_out
        self.zoned += more.zoned


def cut_curves(
    array: MainArray,
    boxes: Boxes,
    curves: Sequence[Any],
    joints: Sequence[int],
    slit_joint: Callable[[], int],
    leave_out: bool = False,
    only_zoned: bool = False,
) -> Cuts:
    """Cut all blocks along `curves`, each (k, 2) points.

    joints: the number of the joint of each, 0 for none. slit_joint: finds that of slits to holes, if there
    are any. leave_out: a curve that cannot cut a block is left out there. only_zoned: only blocks with zones
    are cut. Error 14 or 27 with the place if it cannot; nothing is changed then.
    """
    lines = [np.asarray(curve, np.float64) for curve in curves]
    for line in lines:
        finite(array, x=float(np.abs(line[:, 0]).max()), y=float(np.abs(line[:, 1]).max()))
    done = Cuts()
    before = int(array.h.ci[g.NBLK])
    if before == 0 or not lines:
        return done
    cutter = _Cutter(array, boxes, lines, leave_out)
    crossed = [one for one in cutter.crossed() if not only_zoned or has_zones(array.h, one[0])]
    found = [(ib, cutter.division(ib, which, done)) for ib, which in crossed]
    done.slits = sum(division.slits for _, division in found)
    numbers = [*joints, slit_joint() if done.slits else 0]
    any_zoned = any(len(division.faces) > 1 and has_zones(array.h, ib) for ib, division in found)
    with all_or_nothing(array) if any_zoned else nullcontext():
        for ib, division in found:
            cutter.cut(ib, division, numbers, done)
        boxes.forget()
        if array.h.ci[g.MCTOT] > 0:
            renew_forces(array)
    done.blocks = int(array.h.ci[g.NBLK]) - before
    return done


def cut_block_along(
    array: MainArray, ib: int, path: Reals, joints: Sequence[int], slack: float, shortest: float, zoned: bool
) -> tuple[int, int]:
    """Cut block `ib` along a polyline (n, 2) from outline to outline: DONE and the part to the left of it.

    joints, slack, shortest: as of polyline_cut.cut_along. zoned: along sides of its zones. If the cut is
    refused nothing is changed; returns why, and the row of the point. Error 1.
    """
    status, found = NO_MEMORY, 0
    while status == NO_MEMORY and not found:
        keep_spare(array)
        passes = cutting(array.h, soft_or_loaded_in(array.h), zoned)
        status, found = cut_along(array.h, ib, path, np.array(joints, np.int64), slack, shortest, passes)
        if status == NO_MEMORY:
            find_room(array)
    if status not in (DONE, NO_MEMORY):
        return int(status), int(found)
    if status == NO_MEMORY or array.h.ci[g.NDUE]:  # the block is cut, and updates are left
        update_flagged(array)
    return DONE, int(found)


def _curves_to_leave_out(refused: list[Refused]) -> list[int]:
    """Curves to leave out so that no refused place remains: those with most first, the last of equals."""
    places = Counter(k for one in refused for k in one.curves if k >= 0)
    found: list[int] = []
    for k, _ in sorted(places.items(), key=lambda item: (-item[1], -item[0])):
        if any(k in one.curves and set(found).isdisjoint(one.curves) for one in refused):
            found.append(k)
    return found


class _Cutter:
    """Divisions and cuts of blocks by lines, with the tolerances of this model."""

    def __init__(self, array: MainArray, boxes: Boxes, lines: list[Reals], leave_out: bool) -> None:
        self.array, self.lines, self.leave_out = array, lines, leave_out
        self.near: dict[int, list[int]] = {}  # corners to remove from blocks with zones
        boxes.enter(array)
        self.boxes = boxes.boxes[: boxes.n].copy()
        self.blocks = boxes.blocks[: boxes.n].copy()
        digit = last_digit(array, boxes.size)
        is_open = rounding_is_open(array.h)
        self.shortest = EDGE_DIGITS * digit if is_open else 2 * (float(array.h.cr[g.DTOL]) - digit)
        self.grid = 2.0 ** np.ceil(np.log2(ROUNDINGS * digit))

    def crossed(self) -> Iterator[tuple[int, list[int]]]:
        """Blocks whose boxes lines meet, in the order of their making, and the numbers of the lines."""
        tree = shapely.STRtree([shapely.LineString(line) for line in self.lines])
        row, line = tree.query(shapely.box(*self.boxes.T.astype(np.float64)), predicate="intersects")
        order = np.lexsort((line, row))
        row, line = row[order], line[order]
        starts = np.flatnonzero(np.diff(row, prepend=-1))
        for first, end in zip(starts, [*starts[1:], len(row)], strict=False):  # of none, no end
            yield int(self.blocks[row[first]]), line[first:end].tolist()

    def division(self, ib: int, which: list[int], done: Cuts) -> Division:
        """The faces of block `ib` that the lines in `which` make, by the numbers of all lines."""
        whole = Outline(self.array.h, ib)
        outline = whole.end
        while True:
            found = divide(outline, [self.lines[k] for k in which], self.grid)
            if len(found.faces) > 1 and has_zones(self.array.h, ib):
                self.near[ib] = near_points(self.array, ib, found, self.shortest)
                outline = whole.end[~np.isin(whole.corners, self.near[ib])]
                found = divide(outline, [self.lines[k] for k in which], self.grid)
            refused = refusals(found, self.shortest) if len(found.faces) > 1 else []
            if not refused:
                break
            spoilers = _curves_to_leave_out(refused) if self.leave_out else []
            if not spoilers:
                x, y, _, length = refused[0]
                refuse(self.array, REFUSED_SHORT if length else REFUSED_CLOSE, ib, x, y, self.shortest)
            gone = [one for one in refused if not set(spoilers).isdisjoint(one.curves)]
            done.left_out += [
                one._replace(curves=tuple(which[k] for k in one.curves if k >= 0)) for one in gone
            ]
            which = [line for k, line in enumerate(which) if k not in spoilers]
        done.dead_ends += [(end, which[k]) for end, k in zip(found.dead_ends, found.dead_curves, strict=True)]
        return found._replace(curve={edge: which[k] if k >= 0 else k for edge, k in found.curve.items()})

    def cut(self, ib: int, division: Division, joints: list[int], done: Cuts) -> None:
        """Cut block `ib` into its faces; joints: by the number of the line, that of slits last."""
        if len(division.faces) < 2:
            return
        array, slack, parts = self.array, self.grid, [ib]
        zoned = ZonedCut(array, ib) if has_zones(array.h, ib) else None
        if zoned:
            division = zoned.divide_coarsely(ib, division, self.near[ib], 4 * self.grid)
            slack = -1.0  # each point of the faces is a grid-point
        for points, numbers in cuts_of(division, joints, slack):
            poll()
            ib = self._cut_once(ib, points, numbers, zoned is not None)
            parts.append(int(array.h.ci[g.IBPNT]))
        if zoned:
            done.zoned.append(zoned.divide_parts(parts))

    def _cut_once(self, ib: int, points: Reals, numbers: list[int], zoned: bool) -> int:
        """Cut block `ib` along a polyline; returns the part to the left of it."""
        path = points.astype(self.array.h.cr.dtype)
        status, found = cut_block_along(self.array, ib, path, numbers, 2 * self.grid, self.shortest, zoned)
        if status != DONE:
            x, y = points[found].tolist()
            self._stop(status, ib, x, y)
        return found

    def _stop(self, status: int, ib: int, x: float, y: float) -> None:
        if status == NOT_ON_OUTLINE:
            raise UdecError(27, f"({x:.10g}, {y:.10g}) is not on the outline of block@{ib}", group=ib)
        refuse(self.array, status, ib, x, y, self.shortest)
