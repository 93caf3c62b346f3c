"""Cuts along curves as commands give them: their joints, and cracks that were kept or are to be kept."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, getr, iget, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.interrupt_signals import poll
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.joint_property_command import add_joints
from udec_ia.ops.commands.split_blocks import Boxes, split
from udec_ia.ops.common.array_growth import all_or_nothing, require
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.cuts.block_division import Reals, Refused
from udec_ia.ops.cuts.cut_blocks import Cuts, cut_curves
from udec_ia.ops.cuts.joint_of_cut import end_glue_along, glue, joint_of_cut
from udec_ia.reader.zone_rows import any_zones

Ends = tuple[float, float, float, float]  # x1, y1, x2, y2


class CutWords(NamedTuple):
    """Words of commands that cut.

    joint, jmaterial, glued: see joint_of_cut. keep: ends inside blocks are kept for later cuts.
    """

    joint: int | None = None
    jmaterial: int | None = None
    glued: bool = False
    keep: bool = False


def cut(
    array: MainArray, boxes: Boxes, curves: Sequence[Reals], words: CutWords, leave_out: bool = False
) -> Cuts:
    """Cut all blocks along `curves`, which belong to one joint, and along the cracks that are kept.

    leave_out: curves that cannot cut a block are left out there. Errors as of cut_curves and joint_of_cut.
    """
    number = _number(array, words, curves)
    joints = [(curve, number) for curve in curves]
    return cut_joints(array, boxes, joints, _materials(number, words), words.keep, leave_out)


def cut_joints(
    array: MainArray,
    boxes: Boxes,
    curves: Sequence[tuple[Reals, int]],
    materials: dict[int, int],
    keep: bool = False,
    leave_out: bool = False,
) -> Cuts:
    """The same for curves with the number of the joint of each. materials: joint materials of joints."""
    old, old_joints = kept_cracks(array)
    lines = [*old, *(curve for curve, _ in curves)]
    joints = [*old_joints, *(joint for _, joint in curves)]
    if any(joints):
        add_joints(array)

    def slit_joint() -> int:
        return glue(array, _mean_length(lines))

    done = cut_curves(array, boxes, lines, joints, slit_joint, leave_out)
    end_glue_along(array, lines, joints, boxes.size)
    kept = [(end, joints[k]) for end, k in done.dead_ends if k < len(old) or keep]
    if kept or old:
        keep_cracks(array, kept)
    done.dead_ends = [(end, k) for end, k in done.dead_ends if k >= len(old)]
    for joint, material in materials.items():
        array.h.ci[g.JLINE + joint - 1] = material
    return done


def cut_lines_of_joints(
    array: MainArray, boxes: Boxes, lines: Sequence[Reals], joints: Sequence[int], words: CutWords
) -> Cuts:
    """Cut along lines with the joint of each, 0 for that of the words; those that cannot cut are left out."""
    own = [line for line, joint in zip(lines, joints, strict=True) if not joint]
    number = _number(array, words, own) if own else 0
    curves = [(line, joint or number) for line, joint in zip(lines, joints, strict=True)]
    materials = _materials(number, words) if number else {}
    return cut_joints(array, boxes, curves, materials, words.keep, leave_out=True)


def cut_lines(array: MainArray, boxes: Boxes, lines: Sequence[Reals], words: CutWords) -> Cuts:
    """Cut all blocks along straight lines that leave them, one after the other as SPLIT does.

    Lines that one block refuses are left out, in all blocks.
    """
    number = _number(array, words, lines)
    done, cut = Cuts(), list[Reals]()
    for k, line in enumerate(lines):
        poll()
        try:
            _split(array, boxes, line, number or None, None, done)
            cut.append(line)
        except UdecError as error:
            if error.number not in (14, 27):
                raise
            x, y = line.mean(axis=0).tolist()
            done.left_out.append(Refused(x, y, (k,), 0.0))
    end_glue_along(array, cut, [number] * len(cut), boxes.size)
    done.add(cut_joints(array, boxes, [], _materials(number, words)))
    return done


def split_or_keep(
    array: MainArray, boxes: Boxes, ends: Ends, joint: int | None, jmaterial: int | None
) -> Cuts:
    """SPLIT along a line; if no block is cut, its parts inside blocks are kept for later cuts.

    Cracks that were kept cut what they can now.
    """
    joint = joint_of_cut(array, joint, jmaterial, False, 1.0) or None
    done, line = Cuts(), np.array(ends, np.float64).reshape(2, 2)
    _split(array, boxes, line, joint, jmaterial, done)
    end_glue_along(array, [line], [joint or 0], boxes.size)
    kept = [] if done.blocks else [(line, joint or 0)]
    if kept or array.h.ci[g.ICKPNT]:
        done.add(cut_joints(array, boxes, kept, {}, keep=True))
    done.dead_ends.clear()  # why_uncut explains them
    return done


def _split(
    array: MainArray, boxes: Boxes, line: Reals, joint: int | None, jmaterial: int | None, done: Cuts
) -> None:
    """Split all blocks in the path of a line (2, 2), first those with zones."""
    (x1, y1), (x2, y2) = line.tolist()
    if not any_zones(array.h):
        done.blocks += split(array, boxes, x1, y1, x2, y2, joint, jmaterial)
        return
    with all_or_nothing(array):
        if joint:
            add_joints(array)
        done.add(cut_curves(array, boxes, [line], [joint or 0], lambda: 0, only_zoned=True))
        done.blocks += split(array, Boxes(without_zones=True), x1, y1, x2, y2, joint, jmaterial)
        boxes.forget()


def _number(array: MainArray, words: CutWords, curves: Sequence[Reals]) -> int:
    return joint_of_cut(array, words.joint, words.jmaterial, words.glued, _mean_length(curves))


def _materials(number: int, words: CutWords) -> dict[int, int]:
    return {} if words.jmaterial is None else {number: words.jmaterial}


def _mean_length(curves: Sequence[Reals]) -> float:
    """Mean length of the straight pieces of curves; 1 for none."""
    lengths = [np.hypot(*np.diff(curve, axis=0).T) for curve in curves]
    return float(np.concatenate(lengths).mean()) if lengths else 1.0


# ---- Cracks that end inside a block, kept until a later cut meets them (list ICKPNT)

ENDS = (g.KKX1, g.KKY1, g.KKX2, g.KKY2)


def kept_cracks(array: MainArray) -> tuple[list[Reals], list[int]]:
    """Lines (2, 2) of the cracks that are kept, and the number of the joint of each, the oldest first."""
    h = array.h
    found = list_of(h, "crack").tolist()[::-1]
    lines = [np.array([float(getr(h, ik, end)) for end in ENDS]).reshape(2, 2) for ik in found]
    return lines, [int(iget(h, ik, g.KKJ)) for ik in found]


def keep_cracks(array: MainArray, cracks: Sequence[tuple[Reals, int]]) -> None:
    """Keep `cracks`, lines (k, 2) with joints, in place of those that are kept now. Error 1."""
    drop(array.h, "crack", list_of(array.h, "crack").tolist())
    pieces = [(line[k : k + 2], joint) for line, joint in cracks for k in range(len(line) - 1)]
    require(array, len(pieces) * size_of(array.h, g.NVCK))
    h = array.h
    for piece, joint in pieces:
        ik = int(find(h, g.NVCK))
        puti(h, ik, HEAD, g.MCRK)
        puti(h, ik, g.KK, int(h.ci[g.ICKPNT]))
        puti(h, ik, g.KKJ, joint)
        for end, value in zip(ENDS, piece.ravel().tolist(), strict=True):
            putr(h, ik, end, value)
        h.ci[g.ICKPNT] = ik
