"""Why a SPLIT has cut no block: the line passes none, touches one at most, or ends inside."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from udec_ia.heap.main_array import MainArray
from udec_ia.ops.commands.generate import Outline
from udec_ia.ops.commands.split import ROUNDINGS, Boxes
from udec_ia.ops.common.limits import last_digit
from udec_ia.ops.common.ranges import NO_BLOCK_YET

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
        inside, touches = _along(Outline(array.h, ib), line, slack)
        for k in range(2):
            if inside[k]:
                ends[k] = f"{('begins', 'ends')[k]} inside block@{ib} at ({line[k, 0]:g}, {line[k, 1]:g})"
        touched = touched or (ib if touches else 0)
    if any(ends):
        return f"the line {' and '.join(filter(None, ends))}; {LONGER}"
    if touched:
        return f"the line only touches block@{touched}, along an edge or at a corner; {LONGER}"
    (ax, ay), (bx, by) = low.min(axis=0), high.max(axis=0)
    return f"the line meets no block; all blocks lie in x {ax:g} to {bx:g}, y {ay:g} to {by:g}"


def _along(block: Outline, line: Any, slack: float) -> tuple[Any, bool]:
    """Whether the start and the end of the line lie inside the block, and whether the line touches it at all.

    The line is divided where it meets the outline, and the middle of each part is looked at. What is nearer
    than `slack` to the line is on it.
    """
    length = math.dist(*line)
    c, s = unit = (line[1] - line[0]) / length
    x, y = (block.end - line[0]).T
    along, off = x * c + y * s, y * c - x * s
    off[np.abs(off) <= slack] = 0.0
    next_along, next_off = np.roll(along, -1), np.roll(off, -1)
    crosses = off * next_off < 0
    share = off[crosses] / (off[crosses] - next_off[crosses])
    meets = np.sort([*(along[crosses] + share * (next_along - along)[crosses]), *along[off == 0.0]])
    flat = (off == 0) & (next_off == 0)  # edges along the line
    inside = np.zeros(2, bool)
    for a, b in pairwise(meets.tolist()):
        middle = (a + b) / 2
        on_edge = (((along - middle) * (next_along - middle) < 0) & flat).any()
        if not on_edge and block.holds(*(line[0] + middle * unit)):
            inside |= a < -slack < slack < b, a < length - slack < length + slack < b
    beside = flat & (np.minimum(along, next_along) < length) & (np.maximum(along, next_along) > 0)
    return inside, bool(beside.any() or ((meets >= -slack) & (meets <= length + slack)).any())
