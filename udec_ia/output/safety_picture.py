"""The picture of FOS: the last stable and the first failing state, with displacements."""

from __future__ import annotations

from pathlib import Path

from udec_ia.heap.main_array import MainArray
from udec_ia.output.block_drawing import FIT, draw_blocks, limits, paper, style_frame, title, write
from udec_ia.output.colour_scales import LONGEST, NOTE_HEIGHT, draw_notes
from udec_ia.output.drawn_outlines import snapshot
from udec_ia.output.field_drawing import displacements, draw_arrows, draw_gravity
from udec_ia.running.factor_of_safety import FactorOfSafety

GAP = 0.75  # inches between the two states


def draw_safety(array: MainArray, found: FactorOfSafety, base: Path) -> list[Path]:
    """Write base.png and base.svg, with the state in `array` as the first; returns their paths. Error 31."""
    trials = [one for one in (found.stable, found.failing) if one is not None and one.array is not None]
    if not trials:
        return []
    first = snapshot(array.h, inside=True)
    states = [snapshot(one.array.h, inside=True) for one in trials if one.array is not None]
    box = limits([first, *states], LONGEST)
    width, height = box[1] - box[0], box[3] - box[2]
    inches = min(FIT[0] / (1.5 * width), FIT[1] / height)
    beside = (len(trials) - 1) * (width * inches + GAP)
    figure, axes = paper(box, inches, beside, NOTE_HEIGHT)
    left, bottom, wide, high = axes.get_position().bounds
    for k, (trial, state) in enumerate(zip(trials, states, strict=True)):
        if k:
            axes = figure.add_axes((left + beside / figure.get_figwidth(), bottom, wide, high))
            axes.set(xlim=box[:2], ylim=box[2:], xlabel="x (m)")
            style_frame(axes)
        title(axes, f"{trial.verdict} at {trial.factor:.5g}")
        draw_blocks(axes, [state], inches)
        if first.field is not None and state.field is not None:
            moved = displacements(first.field, state.field)
            size = max(width, height)
            draw_notes(axes, [draw_arrows(axes, "displacement", state.field.place, moved, size)])
        draw_gravity(axes, state.gravity)
    return write(figure, base)
