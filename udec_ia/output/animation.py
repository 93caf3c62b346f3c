"""An animated GIF of a run: one picture for each state that was collected, all in the same frame.

With more than MAX_STATES states every second one is dropped, and from then on only every second one is taken,
so the pictures are evenly spaced in cycles.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from udec_ia.file_replacement import put_in_place
from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.output.block_drawing import HATCH_WIDTH, INK, draw_blocks, limits, paper, scale_for, title
from udec_ia.output.drawn_outlines import State, snapshot

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

MAX_STATES = 150
SHRINK = 0.8  # size against that of a plot
DPI = 100
TICK = 60  # milliseconds for each picture
PAUSE = 1500  # milliseconds for the last one
COLOURS = 64


class Animation:
    """The states of a run, `name` being the title of the pictures."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.states: list[State] = []
        self.stride = 1
        self.offered = 0

    def add(self, h: Memory) -> None:
        """Take the present state, if it is its turn."""
        if self.offered % self.stride == 0:
            self.states.append(snapshot(h))
        self.offered += 1
        if len(self.states) > MAX_STATES:
            self.states = self.states[::2]
            self.stride *= 2

    def save(self, path: Path, h: Memory) -> Path:
        """Write the GIF, the present state as its last picture; returns `path`. Error 31 if that fails."""
        from matplotlib import rc_context
        from PIL import Image

        if not self.states or self.states[-1].cycle != h.ci[g.MCTOT]:
            self.states.append(snapshot(h))
        box = limits(self.states)
        inches = SHRINK * scale_for(box, 0.0)
        with rc_context({"hatch.linewidth": HATCH_WIDTH}):
            pictures = [self._picture(state, box, inches) for state in self.states]
        palette = pictures[-1].quantize(COLOURS, Image.Quantize.FASTOCTREE)
        frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
        times = [TICK] * (len(frames) - 1) + [PAUSE]
        image = io.BytesIO()
        frames[0].save(image, "GIF", save_all=True, append_images=frames[1:], duration=times, loop=0)
        put_in_place(path, image.getvalue(), force=False)
        return path

    def _picture(self, state: State, box: tuple[float, float, float, float], inches: float) -> Picture:
        from PIL import Image

        figure, axes = paper(box, inches)
        title(axes, self.name)
        axes.set_title(f"cycle {state.cycle}, t = {state.time:.3f} s", loc="right", fontsize=9, color=INK)
        draw_blocks(axes, [state], inches)
        figure.dpi = DPI
        canvas: Any = figure.canvas
        canvas.draw()
        return Image.fromarray(np.array(canvas.buffer_rgba())[:, :, :3].copy())
