"""Colours for numbers, with the scale that explains them, and arrows and lines with a round length below."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from udec_ia.output.block_drawing import INK, MARGINS
from udec_ia.output.readable_units import Unit, in_readable_units, readable, round_number
from udec_ia.reader.drawable_quantities import COMPRESSION, FROM_ZERO, HIGHEST_SAFETY, SAFETY

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.quiver import Quiver

LONGEST = 0.08  # of the picture: the longest arrow or cross
STRIP = 0.12  # inches: width of a scale of colours, and of the space before it
NOTE_HEIGHT = 0.18  # inches for each line of notes below the picture
PALEST = 0.25  # what is below that part of the palette is hardly seen on white
UNKNOWN = "#8a857c"
SIGNED, COMPRESSED = "RdBu_r", "RdBu"  # tension is red, and what is positive, unless in compression
WHOLE, FROM_WHITE, WATER_BLUES, FROM_SLIP = "viridis", "YlOrRd", "YlGnBu", "RdYlBu"


class Colours(NamedTuple):
    """mappable: of values in `unit`."""

    mappable: ScalarMappable
    unit: Unit

    def of(self, values: Any) -> Any:
        """Colours of values in the unit of the field table, (n, 4)."""
        return self.mappable.to_rgba(np.asarray(values) / self.unit.size)


def colours_for(values: Any, unit: str, scale: str, palette: str = WHOLE) -> Colours:
    """A scale of colours for values (n,), some of which may be unknown (NaN) or infinite.

    scale: of drawable_quantities. A scale from zero or over a range has `palette`; values of both signs are
    red and blue about 0, compression blue.
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, Normalize

    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
    colours = colormaps[palette]
    if palette in (FROM_WHITE, WATER_BLUES):
        colours = ListedColormap(colours(np.linspace(PALEST, 1.0, 256)))
    if scale == SAFETY:
        low, high, colours = 1.0, HIGHEST_SAFETY, colormaps[FROM_SLIP]
    elif scale == FROM_ZERO:
        low, high = 0.0, high or 1.0
    elif low < 0 < high:
        high = max(high, -low)
        low, colours = -high, colormaps[COMPRESSED if scale == COMPRESSION else SIGNED]
    if low == high:  # the same value everywhere is in the middle of the scale
        margin = abs(low) / 10 or 1.0
        low, high = low - margin, high + margin
    shown = readable(unit, max(abs(low), abs(high)))
    colours = colours.with_extremes(bad=UNKNOWN)
    return Colours(ScalarMappable(Normalize(low / shown.size, high / shown.size), colours), shown)


def draw_scale(axes: Axes, colours: Colours, quantity: str, beyond: float, endless: bool = False) -> None:
    """The scale of colours on the right of the picture.

    beyond: width of other keys, between picture and this one, as a share of the picture. endless: larger
    values have the last colour.
    """
    figure: Any = axes.figure
    wide = STRIP * float(figure.dpi / axes.bbox.width)
    strip = axes.inset_axes((1.0 + wide + beyond, 0.0, wide, 1.0))
    bar = figure.colorbar(colours.mappable, cax=strip, extend="max" if endless else "neither")
    bar.set_label(colours.unit.label(quantity), fontsize=9, color=INK, parse_math=False)
    strip.tick_params(labelsize=8, colors=INK, width=0.6)
    strip.ticklabel_format(axis="y", scilimits=(-3, 4))
    strip.yaxis.get_offset_text().set_fontsize(8)


class Note(NamedTuple):
    """A line below the picture. length: round one of an arrow or line, in m of the picture; 0 for none.

    label: what the length stands for. arrows: whose key it is; None: a line of that colour.
    """

    text: str
    length: float = 0.0
    label: str = ""
    arrows: Quiver | None = None
    colour: str = INK


def scale_note(
    quantity: str, unit: str, largest: float, longest: float, arrows: Quiver | None = None, colour: str = INK
) -> Note:
    """What an arrow or line of a round length stands for. longest: in m of the picture, of the `largest`."""
    text = f"largest {quantity}: {in_readable_units(largest, unit)}"
    if not (largest > 0.0 and np.isfinite(largest)):
        return Note(text)
    size = readable(unit, largest).size
    number = round_number(largest / size) * size
    return Note(text, longest * number / largest, in_readable_units(number, unit), arrows, colour)


def draw_notes(axes: Axes, notes: list[Note]) -> None:
    """Write the notes below the picture, one below the other, each behind its arrow or line."""
    from matplotlib.lines import Line2D

    low, high = axes.get_xlim()
    dpi = axes.figure.dpi
    width, height = axes.bbox.width / dpi, axes.bbox.height / dpi
    left = -0.6 * MARGINS[0] / width
    for row, note in enumerate(notes):
        y = -(MARGINS[2] + NOTE_HEIGHT * (row + 0.3)) / height
        end = left + note.length / (high - low)
        if note.arrows is not None:
            axes.quiverkey(note.arrows, end, y, note.length, "", labelpos="E", coordinates="axes")
        elif note.length:
            line = Line2D([left, end], [y, y], color=note.colour, linewidth=1.4, transform=axes.transAxes)
            line.set_clip_on(False)
            axes.add_artist(line)
        text = f"{note.label}; {note.text}" if note.length else note.text
        start = end + (0.06 / width if note.length else 0.0)
        axes.text(
            start, y, text, transform=axes.transAxes, fontsize=9, color=INK, va="center", parse_math=False
        )
