"""What pictures can show in colours and by arrows: a line for each quantity, for PLOT and Model.figure alike.

The key of a line is the keyword of PLOT and the word of Model.figure. In blocks every zone, and every block
without zones, has its own colour; a joint has one for the part of each contact, or for each side of it. The
numbers come from what a picture knows of a state (output/drawn_outlines.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

InBlock = Callable[[Any, Any], Any]
# Which numbers a scale of colours shows; COMPRESSION: all, positive in compression
RANGE, FROM_ZERO, SAFETY, COMPRESSION = "range", "from zero", "safety", "compression"
HIGHEST_SAFETY = 3.0  # above it all are shown alike


@dataclass(frozen=True)
class InBlocks:
    """label: of the scale. unit: of the field table.

    values: of a Field and displacements of its points, one for each zone and block without zones.
    moves: it is about displacements. scale: RANGE, COMPRESSION, or FROM_ZERO if no number is negative.
    """

    label: str
    unit: str
    values: InBlock
    moves: bool = False
    scale: str = RANGE


@dataclass(frozen=True)
class OfJoints:
    """label and unit as above. values: of Joints, (n,), or (n, 2) for the two sides.

    water: it needs FLUID. scale: FROM_ZERO, COMPRESSION or SAFETY; "" for states, which are named.
    """

    label: str
    unit: str
    values: Callable[[Any], Any]
    water: bool = False
    scale: str = FROM_ZERO


class Arrows(NamedTuple):
    """label and unit as above."""

    label: str
    unit: str


def _stress(row: Callable[[Any, Any, Any], Any]) -> InBlock:
    return lambda now, moved: row(*now.stress.T)


def _principal(sign: float) -> InBlock:
    """Mean pressure plus or minus the greatest shear stress."""
    return _stress(lambda s11, s12, s22: -(s11 + s22) / 2 + sign * np.hypot((s11 - s22) / 2, s12))


def _velocity(part: Callable[[Any, Any], Any]) -> InBlock:
    return lambda now, moved: part(*now.in_blocks(now.velocity).T)


def _displacement(part: Callable[[Any, Any], Any]) -> InBlock:
    return lambda now, moved: part(*now.in_blocks(moved).T)


def _stress_of_joints(name: str) -> Callable[[Any], Any]:
    return lambda joints: joints.stress[name]


def _water(name: str) -> Callable[[Any], Any]:
    return lambda joints: joints.water[name]


IN_BLOCKS = {
    "s11": InBlocks("stress 11", "Pa", _stress(lambda s11, s12, s22: s11)),
    "s12": InBlocks("stress 12", "Pa", _stress(lambda s11, s12, s22: s12)),
    "s22": InBlocks("stress 22", "Pa", _stress(lambda s11, s12, s22: s22)),
    "pressure": InBlocks("pressure", "Pa", _principal(0.0), scale=COMPRESSION),
    "shear": InBlocks(
        "greatest shear stress", "Pa", _stress(lambda s11, s12, s22: np.hypot((s11 - s22) / 2, s12))
    ),
    "major": InBlocks(
        "major principal stress, compression positive", "Pa", _principal(1.0), scale=COMPRESSION
    ),
    "minor": InBlocks(
        "minor principal stress, compression positive", "Pa", _principal(-1.0), scale=COMPRESSION
    ),
    "movement": InBlocks("displacement", "m", _displacement(np.hypot), True, FROM_ZERO),
    "xdisplacement": InBlocks("x displacement", "m", _displacement(lambda x, y: x), True),
    "ydisplacement": InBlocks("y displacement", "m", _displacement(lambda x, y: y), True),
    "speed": InBlocks("velocity", "m/s", _velocity(np.hypot), scale=FROM_ZERO),
    "xvelocity": InBlocks("x velocity", "m/s", _velocity(lambda x, y: x)),
    "yvelocity": InBlocks("y velocity", "m/s", _velocity(lambda x, y: y)),
}
SLIP, STATE = "slip", "state"
OF_JOINTS = {
    SLIP: OfJoints("slip", "m", lambda joints: np.abs(joints.rows["slip"])),
    "opening": OfJoints("opening", "m", lambda joints: np.maximum(joints.rows["opening"], 0.0)),
    STATE: OfJoints("joints (contacts)", "", lambda joints: joints.rows["state"], scale=""),
    "normalstress": OfJoints("normal stress of joints", "Pa", _stress_of_joints("normal"), scale=COMPRESSION),
    "shearstress": OfJoints("shear stress of joints", "Pa", _stress_of_joints("shear")),
    "safety": OfJoints("strength over shear stress", "", _stress_of_joints("safety"), scale=SAFETY),
    "ppressure": OfJoints("pore pressure", "Pa", _water("pressure"), True),
    "saturation": OfJoints("saturation", "", _water("saturation"), True),
    "flow": OfJoints("flow", "m2/s", _water("flow"), True),
    "aperture": OfJoints("aperture", "m", _water("aperture"), True),
}
SHORT = {"pressure": "Pressure", "shear": "SHear", SLIP: "SLip", "opening": "Opening", STATE: "STAte"}
KEYWORDS = {name: SHORT.get(name, name.upper()) for name in (*IN_BLOCKS, *OF_JOINTS)}  # of PLOT
ARROWS = {
    "displacement": Arrows("displacement", "m"),
    "velocity": Arrows("velocity", "m/s"),
    "force": Arrows("contact force (resultant)", "N/m"),
}
