"""SPLIT: blocks are cut by a line (report 2.7)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.split.line_crossing import SHORTEST, X, Y, rounding_is_open
from udec_ia.kernels.split.split import (
    DONE,
    NO_MEMORY,
    NO_ROWS,
    REFUSED_SHORT,
    cut_path,
    cutting,
    enter_boxes,
    path,
)
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.corner_rounding import update_flagged
from udec_ia.ops.commands.generate_zones import Outline
from udec_ia.ops.commands.joint_property_command import add_joints, jmaterial_number, joint_number
from udec_ia.ops.common.array_growth import find_room, keep_spare
from udec_ia.ops.common.block_ranges import NO_BLOCK_YET
from udec_ia.ops.common.kernel_arguments import renew_forces, soft_or_loaded_in
from udec_ia.ops.common.number_limits import EDGE_DIGITS, finite, last_digit
from udec_ia.reader.zone_rows import has_zones

CROSSINGS = 64  # room for the crossings of one block at first
ROUNDINGS = 32  # last digits by which the distance of a corner from a line may be wrong


class Boxes:
    """The bounding boxes of all blocks, reused by the next SPLIT unless blocks have moved in between.

    without_zones: of those without zones.
    """

    def __init__(self, without_zones: bool = False) -> None:
        self.without_zones, self.left_out = without_zones, 0
        self.boxes = np.zeros((0, 4))
        self.blocks = np.zeros(0, np.int64)
        self.n = 0
        self.size = 0.0  # greatest |x| + |y| that a corner can have

    def forget(self) -> None:
        """Read the block list again next time, as blocks have moved or gone."""
        self.n = 0

    def enter(self, array: MainArray) -> None:
        """Enter all blocks of the list."""
        count = int(array.h.ci[g.NBLK])
        self.make_room(array, count)
        if self.n + self.left_out != count:
            self.n, self.left_out = enter_boxes(array.h, self.boxes, self.blocks), 0
            if self.without_zones:
                kept = np.array([not has_zones(array.h, ib) for ib in self.blocks[: self.n].tolist()], bool)
                self.left_out, self.n = int((~kept).sum()), int(kept.sum())
                self.boxes[: self.n] = self.boxes[: len(kept)][kept]
                self.blocks[: self.n] = self.blocks[: len(kept)][kept]
                if self.n == 0:
                    return
            far = np.abs(self.boxes[: self.n]).max(axis=0)
            self.size = float(max(far[0], far[2]) + max(far[1], far[3]))

    def make_room(self, array: MainArray, count: int) -> None:
        """Make sure that there are `count` rows."""
        if len(self.blocks) >= count:
            return
        boxes, blocks = np.zeros((2 * count, 4), array.h.cr.dtype), np.zeros(2 * count, np.int64)
        boxes[: self.n], blocks[: self.n] = self.boxes[: self.n], self.blocks[: self.n]
        self.boxes, self.blocks = boxes, blocks


def split(
    array: MainArray,
    boxes: Boxes,
    x1: float,
    y1: float,
    x2: float,
    y2: float,
    joint: int | None = None,
    jmaterial: int | None = None,
) -> int:
    """Split all blocks in the path of the line from (x1, y1) to (x2, y2). Returns the number of new blocks.

    A line that ends inside a block leaves it whole. joint: number of the joint that the cracks belong to.
    jmaterial: joint material of that joint. Error 27 or 14, and nothing is changed, if the line runs too
    close to a corner or an edge; error 4 or 7 for a wrong joint. Blocks with zones must not be in `boxes`.
    """
    finite(array, x1=x1, y1=y1, x2=x2, y2=y2)
    z = math.hypot(x2 - x1, y2 - y1)
    finite(array, length=z)
    number = joint_number(joint)
    if jmaterial is not None:
        jmaterial_number(array, jmaterial)
    if z == 0:
        raise UdecError(28, "the two ends of the line are the same point", "give two points", parameter="x2")
    before = int(array.h.ci[g.NBLK])
    if before == 0:
        return 0
    if number:
        add_joints(array)
    boxes.enter(array)
    digit = last_digit(array, boxes.size)
    shortest = EDGE_DIGITS * digit if rounding_is_open(array.h) else 2 * (array.h.cr[g.DTOL] - digit)
    slack = ROUNDINGS * (digit + last_digit(array, abs(x1) + abs(y1)))
    line = np.array([x1, y1, (x2 - x1) / z, (y2 - y1) / z, z, shortest, slack], array.h.cr.dtype)
    while not _cut(array, boxes, line, number):
        boxes.forget()
    if jmaterial is not None:
        array.h.ci[g.JLINE + number - 1] = jmaterial
    if array.h.ci[g.MCTOT] > 0:
        renew_forces(array)
    return int(array.h.ci[g.NBLK]) - before


def _cut(array: MainArray, boxes: Boxes, line: np.ndarray, joint: int) -> bool:
    """Cut along the line; False if it has to be begun again with more memory."""
    keep_spare(array)
    boxes.enter(array)
    h = array.h
    rows = np.empty(boxes.n, np.int64)
    status, room = NO_ROWS, CROSSINGS
    while status == NO_ROWS:
        where, which = np.empty((room, 3), h.cr.dtype), np.empty((room, 2), np.int64)
        status, found, cuts = path(h, boxes.boxes, boxes.blocks, boxes.n, line, rows, where, which)
        room *= 2
    if status != DONE:
        refuse(array, status, found, float(where[0, X]), float(where[0, Y]), float(line[SHORTEST]))
    boxes.make_room(array, boxes.n + cuts)
    status, boxes.n = cut_path(
        *(h, boxes.boxes, boxes.blocks, boxes.n, line, rows, found, cuts, where, which),
        np.empty((0, 2), h.cr.dtype),
        np.array([joint], np.int64),
        cutting(h, soft_or_loaded_in(h)),
    )
    if status == NO_MEMORY:
        try:
            find_room(array)
        finally:
            boxes.forget()
        update_flagged(array)
    return bool(status == DONE)


def refuse(array: MainArray, status: int, ib: int, x: float, y: float, shortest: float) -> None:
    """Error 14 or 27 for a cut of block `ib` at (x, y). shortest: the shortest edge that it may leave."""
    place = f"at ({x:.10g}, {y:.10g}) on block@{ib}"
    if status == REFUSED_SHORT and rounding_is_open(array.h):
        bits = array.scheme.real_bits
        detail = f"{place} it leaves an edge shorter than {shortest:g}, the finest for {bits}-bit reals here"
        advice = "move the line, put the origin nearer to the blocks, or use a --build with 64-bit reals"
        raise UdecError(27, detail, advice, group=ib)
    if status == REFUSED_SHORT:
        detail = f"the cut {place} leaves an edge shorter than {shortest:g}"
        raise UdecError(14, detail, "move the line, or first use a smaller rounding length", group=ib)
    advice = "move the line: it may pass through a corner, but not graze one or touch a notch from inside"
    raise UdecError(27, place, advice, group=ib)


# ---- Why a SPLIT has cut no block: the line meets none, only touches one, or ends inside

LONGER = "a block is cut where the line crosses it from side to side"


def why_uncut(array: MainArray, boxes: Boxes, x1: float, y1: float, x2: float, y2: float) -> str:
    """Why the line from (x1, y1) to (x2, y2) cuts no block."""
    boxes.enter(array)
    if boxes.n == 0:
        return NO_BLOCK_YET
    line = np.array([[x1, y1], [x2, y2]])
    low, high = boxes.boxes[: boxes.n, :2], boxes.boxes[: boxes.n, 2:]
    met = np.flatnonzero(((line.min(axis=0) <= high) & (line.max(axis=0) >= low)).all(axis=1))
    slack = ROUNDINGS * (last_digit(array, boxes.size) + last_digit(array, abs(x1) + abs(y1)))  # as SPLIT's
    ends, touched = ["", ""], 0
    for ib in boxes.blocks[met].tolist():
        block, on_outline = Outline(array.h, ib), False
        for k, (x, y) in enumerate(line.tolist()):
            if block.place(x, y, slack).corner:
                on_outline = True
            elif block.holds(x, y):
                ends[k] = f"{('begins', 'ends')[k]} inside block@{ib} at ({x:g}, {y:g})"
        if not touched and (on_outline or _passes_corner(block, line, slack)):
            touched = ib
    if any(ends):
        return f"the line {' and '.join(filter(None, ends))}; {LONGER}"
    if touched:
        return f"the line only touches block@{touched}, along an edge or at a corner; {LONGER}"
    (ax, ay), (bx, by) = low.min(axis=0), high.max(axis=0)
    return f"the line meets no block; all blocks lie in x {ax:g} to {bx:g}, y {ay:g} to {by:g}"


def _passes_corner(block: Outline, line: Any, slack: float) -> bool:
    """True if the line passes a corner of the block within the distance `slack`."""
    length = math.dist(*line)
    c, s = (line[1] - line[0]) / length
    x, y = (block.end - line[0]).T
    along, off = x * c + y * s, y * c - x * s
    return bool(((np.abs(off) <= slack) & (along >= -slack) & (along <= length + slack)).any())
