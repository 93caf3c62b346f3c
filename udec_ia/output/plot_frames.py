"""PLOT: the block system as a picture, or several of its states superimposed (Fig. II-2), as PNG and SVG.

PLOT 0 starts a frame and PLOT 1 draws the present state over the last one, with all that either asks for.
The picture is written at once, PLOT 1 writes it anew; in a deck, which goes on, not within PAUSE seconds. A
frame of many states is written whenever it has grown by a quarter, and when it ends: so that a frame of n
states takes a time in proportion to n. A block is drawn again only when it has moved visibly
(block_drawing.py).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.layout import offsets as g
from udec_ia.output.block_drawing import (
    FORCE,
    FORCE_LENGTH,
    HATCH_WIDTH,
    draw_addresses,
    draw_blocks,
    draw_contacts,
    draw_domains,
    limits,
    paper,
    scale_for,
    title,
    write,
)
from udec_ia.output.colour_scales import LONGEST, NOTE_HEIGHT, Note, draw_notes, scale_note
from udec_ia.output.drawn_outlines import State, snapshot
from udec_ia.output.field_drawing import (
    displacements,
    draw_arrows,
    draw_colours,
    draw_gravity,
    draw_principal,
    draw_zones,
)
from udec_ia.output.joint_drawing import draw_cracks, draw_joints, slip_since
from udec_ia.output.structure_drawing import draw_structures
from udec_ia.printable_text import counted
from udec_ia.reader.drawable_quantities import ARROWS, IN_BLOCKS, OF_JOINTS, SLIP, STATE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KEY_WIDTH, SCALE_WIDTH = 1.55, 0.95  # inches for a key with words on the right, and for a scale of colours
SLENDER, REMOTE, FARTHEST = 100.0, 1e6, 1e30  # limits that the reals of a picture resolve
PAUSE = 5.0  # s from one writing of a frame to the next, in a deck
AT_ONCE = 10  # states up to which each one is drawn at once
RIGID = "rigid blocks have no stresses: CHANGE x1 x2 y1 y2 SDEF makes them deformable"
GROWTH = 1.25  # of a frame that has more


@dataclass(frozen=True)
class What:
    """What a picture shows beside blocks, centroids and zones.

    contour: a key of drawable_quantities.IN_BLOCKS, or "". joints: a key of OF_JOINTS there, or "".
    window: range x1, x2, y1, y2 in m, or what the blocks need.
    """

    contacts: bool = False
    domains: bool = False
    addresses: bool = False
    stresses: bool = False
    velocities: bool = False
    displacements: bool = False
    contour: str = ""
    joints: str = ""
    window: tuple[float, float, float, float] | None = None
    structures: bool = False
    cracks: bool = False

    @property
    def moves(self) -> bool:
        """True if it shows displacements."""
        return self.displacements or (bool(self.contour) and IN_BLOCKS[self.contour].moves)

    def with_more(self, more: What) -> What:
        """What is shown when `more` is asked for, too: words add up; a new contour or window replaces one."""
        return What(*(getattr(more, one.name) or getattr(self, one.name) for one in fields(self)))

    @property
    def margin(self) -> float:
        """Share of the picture that stays free around the blocks: room for arrows, if there are any."""
        return LONGEST + 0.02 if self.velocities or self.displacements else 0.04


BARE = What()
PARAMETERS = {"contour": "contour", "joints": "joints"}  # of Model.plot


def check_words(h: Memory, what: What, named: Mapping[str, str] = PARAMETERS) -> None:
    """Error 10 unless contour and joints are known, 26 for water where there is none.

    named: what the caller calls contour and joints.
    """
    known: dict[str, list[str]] = {"contour": [*IN_BLOCKS], "joints": [*OF_JOINTS]}
    for name, words in known.items():
        if (word := getattr(what, name)) and word not in words:
            parameter = named[name]
            detail, advice = f"{parameter} is {word}", f"there are {', '.join(words)}"
            raise UdecError(10, detail, advice, parameter=parameter)
    if what.joints and OF_JOINTS[what.joints].water and not h.ci[g.LWATER]:
        raise UdecError(26, "there is no fluid", "first give the command FLUID", parameter=named["joints"])


def _check_window(window: tuple[float, float, float, float] | None, reach: float) -> None:
    """Error 28 unless the window is not empty and can be drawn. reach: largest coordinate of a block, m."""
    if window is None:
        return
    x1, x2, y1, y2 = window
    wide, high, far = x2 - x1, y2 - y1, max(reach, *map(abs, window))
    if not (0 < wide < np.inf and 0 < high < np.inf):
        advice = "WINDOW takes x1 x2 y1 y2 with x1 below x2 and y1 below y2, in m"
        raise UdecError(28, "the window is empty", advice, parameter="window")
    if min(wide, high) < max(max(wide, high) / SLENDER, far / REMOTE, 1 / FARTHEST) or far > FARTHEST:
        detail = f"a window of {wide:g} m by {high:g} m, with blocks {far:g} m away from 0, cannot be drawn"
        advice = f"its sides may be as 1 to {SLENDER:g}, and {REMOTE:g} of them reach from 0 to all blocks"
        raise UdecError(28, detail, advice, parameter="window")


def state_of(h: Memory, what: What) -> State:
    """The state of `h` for a picture of `what`. Error 28 for a window that cannot be drawn."""
    state = snapshot(
        h,
        contacts=what.contacts,
        domains=what.domains,
        inside=True,  # PLOT 1 may ask for displacements
        joints=bool(what.joints),
        structures=what.structures,
        cracks=what.cracks,
    )
    _check_window(what.window, float(np.abs(state.outlines.corner).max(initial=0.0)))
    return state


class StoredStage(NamedTuple):
    """A state from which displacements and slip are counted, and its name.

    new_addresses: of its groups in the present state, by old ones; None if they have not moved.
    """

    h: Memory
    name: str
    new_addresses: Any


def state_of_stage(stage: StoredStage, what: What) -> State:
    """The blocks of a stage, and its joints if `what` shows them, with their present addresses."""
    state = state_of(stage.h, What(joints=what.joints))
    if stage.new_addresses is not None:
        state = state.renumbered(stage.new_addresses)
    return replace(state, stage=stage.name)


def draw_state(h: Memory, what: What, name: str, origin: State | None, axes: Axes | None) -> Axes:
    """Draw the state of `h` on `axes`, or on those of a new figure with the title `name`; returns the axes.

    origin: from which displacements and slip are counted.
    """
    from matplotlib import rc_context

    frame = Frame(name)
    frame.add(state_of(h, what), what, float(h.cr[g.PSCALE]))
    frame.origin = origin
    with rc_context({"hatch.linewidth": HATCH_WIDTH}):
        if axes is None:
            return frame.figure().axes[0]
        x1, x2, y1, y2 = frame.box
        axes.set(xlim=(x1, x2), ylim=(y1, y2), aspect="equal", xlabel="x (m)", ylabel="y (m)")
        axes.apply_aspect()
        frame.draw_on(axes)
    return axes


def largest_displacement(first: State, now: State) -> str:
    """One line on the largest displacement since a stage."""
    assert first.field is not None
    assert now.field is not None
    moved = displacements(first.field, now.field)
    lengths = np.hypot(*moved.T)
    if np.isnan(lengths).all():
        return f"no block of stage {first.stage} is left"
    k = int(np.nanargmax(lengths))
    (x, y), (dx, dy) = now.field.place[k], moved[k]
    return (
        f"largest displacement since {first.stage}: {lengths[k]:.4g} m ({dx:.4g}, {dy:.4g}) "
        f"at ({x:.4g}, {y:.4g}), of centroids and grid-points"
    )


class Plots:
    """The frames of a run: files NAME-plot-1.png, NAME-plot-1.svg, NAME-plot-2.png ... in `folder`.

    files: those that are written, each once. frame: the one that is open, number `count`. after: the last
    number that is taken. origin: from which displacements are measured; None for the first state of a frame.
    waits: a frame that was written less than PAUSE seconds ago is not written again by `draw`.
    """

    waits = False

    def __init__(self, folder: Path, name: str, after: int = 0) -> None:
        self.folder = folder
        self.name = name
        self.files: list[Path] = []
        self.count = after
        self.frame: Frame | None = None
        self.origin: State | None = None

    def first_state(self) -> State | None:
        """The state from which the displacements of a picture would be counted; None if there is none."""
        if self.frame is None:
            return self.origin
        return self.frame.origin or self.frame.states[0]

    def reset_displacements(self, h: Memory) -> None:
        """Measure displacements from the present state, in the open frame and in later ones."""
        self.origin = state_of(h, BARE)
        if self.frame is not None and not self.frame.states[0].stage:
            self.frame.origin = self.origin

    def draw(self, h: Memory, n: int = 0, what: What = BARE, stage: StoredStage | None = None) -> list[Path]:
        """PLOT n: start a frame with the state of `h` (0), or draw it over the last one (1).

        stage: is drawn below it. Displacements and slip of the frame are counted from there, whatever RESET
        DISPLACEMENTS was before. Returns the files that were written; none if the frame has many states and
        waits for more.
        """
        if n not in (0, 1):
            advice = "PLOT 0 starts a frame, PLOT 1 draws over the last one"
            raise UdecError(28, f"PLOT {n}", advice, parameter="n")
        check_words(h, what)
        state = state_of(h, what)
        below = None if stage is None else state_of_stage(stage, what)
        if n == 0 or self.frame is None:
            self.close()
            self.frame = Frame(self.name)
            self.count += 1
        if below is not None:
            self.frame.add(below)
            self.frame.origin = below
        self.frame.add(state, what, float(h.cr[g.PSCALE]))
        if self.frame.origin is None:
            self.frame.origin = self.origin
        wait = self.waits and perf_counter() < self.frame.written_at + PAUSE
        return self._write(self.frame) if self.frame.due and not wait else []

    def write_rest(self) -> list[Path]:
        """Write the open frame if it has states that its files do not show; the files written."""
        if self.frame is None or self.frame.written == len(self.frame.states):
            return []
        return self._write(self.frame)

    def remarks(self, h: Memory, what: What) -> list[str]:
        """Why something that the last PLOT asked for (`what`) cannot be seen."""
        remarks = []
        if self.frame is not None and self.frame.written < len(self.frame.states):
            many = counted(len(self.frame.states), "state")
            remarks.append(f"{many} to be drawn with later ones or when the frame ends")
        first = self.frame is not None and len(self.frame.states) == 1
        if what.moves and first and self.origin is None and not h.ci[g.LDISP]:
            remarks.append(
                "displacements are counted from this picture on: PLOT 1 DISPLACEMENTS draws them; "
                "for those of a run give RESET DISPLACEMENTS before it"
            )
        stresses = what.stresses or (what.contour and IN_BLOCKS[what.contour].unit == "Pa")
        if stresses and h.ci[g.NSOFT] == 0:
            remarks.append(RIGID)
        if self.frame is not None and not first and self.frame.states[0].stage:
            remarks.append(largest_displacement(self.frame.states[0], self.frame.states[-1]))
        return remarks

    def renumber(self, moved: Any) -> None:
        """Groups have moved (heap.main_array): the open frame goes on with their new addresses."""
        if self.frame is not None:
            self.frame.states = [state.renumbered(moved) for state in self.frame.states]
            self.frame.origin = self.frame.origin and self.frame.origin.renumbered(moved)
        self.origin = self.origin and self.origin.renumbered(moved)

    def close(self) -> list[Path]:
        """End the frame that is open, if any; returns all files written by now."""
        self.write_rest()
        self.frame = None
        return self.files

    def _write(self, frame: Frame) -> list[Path]:
        paths = frame.save(self.folder / f"{self.name}-plot-{self.count}")
        self.files += [path for path in paths if path not in self.files]
        return paths


class Frame:
    """States of the block system that are drawn over each other.

    what: all that was asked for by now. Contacts and domains are of the states for which they were asked for.
    scale: inches per metre (SCALE, PSCALE); 0 fits the blocks into the picture. written: states in its
    files, at written_at (s, of perf_counter). origin: from which displacements are measured; None for the
    first state.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.scale = 0.0
        self.what = BARE
        self.states: list[State] = []
        self.origin: State | None = None
        self.written, self.written_at = 0, -math.inf

    @property
    def due(self) -> bool:
        """True if the frame is to be written before there is more of it."""
        return len(self.states) <= AT_ONCE or len(self.states) >= GROWTH * self.written

    def add(self, state: State, what: What = BARE, scale: float = 0.0) -> None:
        """Draw one more state over those before it, at the plot scale now in force."""
        self.states.append(state)
        self.what = self.what.with_more(what)
        self.scale = scale

    def save(self, base: Path) -> list[Path]:
        """Write base.png and base.svg; returns both paths. Error 31 if that cannot be done."""
        from matplotlib import rc_context

        with rc_context({"hatch.linewidth": HATCH_WIDTH}):
            paths = write(self.figure(), base)
        self.written, self.written_at = len(self.states), perf_counter()
        return paths

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Range x1, x2, y1, y2 of the picture in m."""
        return self.what.window or limits(self.states, self.what.margin)

    def figure(self) -> Figure:
        """The picture of all states of the frame."""
        box = self.box
        inches = scale_for(box, self.scale)
        figure, axes = paper(box, inches, self._keys()["end"], NOTE_HEIGHT * self._note_count())
        last = self.states[-1]
        title(axes, self.name, f"cycle {last.cycle}, t = {last.time:.4g} s")
        self.draw_on(axes)
        return figure

    def draw_on(self, axes: Axes) -> None:
        """Draw all states on axes whose range is that of the picture, with keys and notes around them."""
        (x1, x2), (y1, y2) = axes.get_xlim(), axes.get_ylim()
        inches = axes.bbox.width / axes.figure.dpi / (x2 - x1)
        draw_blocks(axes, self.states, inches)
        for state in self.states:
            draw_domains(axes, state.domains, inches)
            if state.contacts is not None:
                draw_contacts(axes, state.contacts, self.what.addresses, (x1, x2, y1, y2))
        size, inch = max(x2 - x1, y2 - y1), float(axes.figure.dpi / axes.bbox.width)
        beyond = {name: inches * inch for name, inches in self._keys().items()}
        notes = [*self._notes(size), *self._draw_inside(axes, size, beyond)]
        self._draw_joints(axes, beyond)
        if self.what.addresses:
            draw_addresses(axes, self.states[-1].outlines, inches)
        draw_gravity(axes, self.states[-1].gravity)
        draw_notes(axes, notes)

    def _keys(self) -> dict[str, float]:
        """Inches from the picture to each of the keys on its right, and to the `end` of all of them.

        The key of cracks has room below that of the states of joints.
        """
        what, places, end = self.what, dict[str, float](), 0.0
        wanted = {"cycles": len(self.states) > 1, "contour": what.contour, "joints": what.joints}
        for name in (name for name, word in wanted.items() if word):
            places[name] = end
            end += KEY_WIDTH if name == "cycles" or wanted[name] == STATE else SCALE_WIDTH
        if what.cracks:
            places["cracks"] = places["joints"] if what.joints == STATE else end
            end += 0.0 if what.joints == STATE else KEY_WIDTH
        return places | {"end": end}

    def _draw_joints(self, axes: Axes, beyond: Mapping[str, float]) -> None:
        """The joints that were last asked for, and cracks. beyond: places of keys, in widths of it."""
        joints = next((state.joints for state in self.states[::-1] if state.joints is not None), None)
        first, last = self.origin or self.states[0], self.states[-1]
        if joints is not None:
            since = ""
            if self.what.joints == SLIP and first.stage and first.joints is not None:
                joints, since = slip_since(joints, first.joints), first.stage
            draw_joints(axes, joints, self.what.joints, beyond["joints"], since)
        if last.cracks is not None:
            draw_cracks(axes, last.cracks, beyond["cracks"])

    def _draw_inside(self, axes: Axes, size: float, beyond: Mapping[str, float]) -> list[Note]:
        """Colours, zones, stresses, arrows and structures of the last state; returns notes on scales."""
        what, now = self.what, self.states[-1].field
        begin = self.origin or self.states[0]
        first, shown = begin.field, self.states[-1].outlines
        if now is None:
            return []
        if now.moved is not None and not begin.stage:
            moved = now.moved
        else:
            moved = np.full(now.place.shape, np.nan) if first is None else displacements(first, now)
        if what.contour:
            draw_colours(axes, now, moved, shown, what.contour, beyond["contour"])
        draw_zones(axes, now, shown)
        notes = []
        if what.stresses:
            notes.append(draw_principal(axes, now, size))
        if what.velocities:
            notes.append(draw_arrows(axes, "velocity", now.place, now.velocity, size))
        if what.displacements:
            notes.append(draw_arrows(axes, "displacement", now.place, moved, size))
        if what.structures and self.states[-1].structures is not None:
            notes.append(draw_structures(axes, self.states[-1].structures, size))
        return notes

    def _notes(self, size: float) -> list[Note]:
        """Notes on the domain that cannot be tinted, and the scale of forces. size: of the picture, m."""
        outer = [Note(f"outer domain: {one.address}") for one in self.states[-1].domains if one.outer]
        shown = [(state.cycle, state.contacts) for state in self.states if state.contacts is not None]
        if not shown:
            return outer
        cycle, contacts = shown[-1]
        force = float(np.hypot(*contacts.force.T).max(initial=0.0))
        quantity = ARROWS["force"]
        note = scale_note(quantity.label, quantity.unit, force, FORCE_LENGTH * size, colour=FORCE)
        then = f", in cycle {cycle}" if cycle != self.states[-1].cycle else ""
        return [*outer, note._replace(text=note.text + then)]

    def _note_count(self) -> int:
        """Number of notes below the picture."""
        what = self.what
        return len(self._notes(1.0)) + what.stresses + what.velocities + what.displacements + what.structures
