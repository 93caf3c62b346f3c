"""What goes on inside and around blocks: zones, stresses, velocities and displacements, and how it is drawn.

A Field is a copy of the moving points of one moment - grid-points of fully-deformable blocks, centroids of
all others - and of the stress in every zone and in every simply-deformable block. Displacements are those of
a point between two moments of one frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

import offsets.generated as g
from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget
from udec_ia.inspect.walk import groups, members

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LONGEST = 0.08  # of the picture: the longest arrow or cross
ARROW = "#1f4e79"
TENSION, COMPRESSION = "#b3261e", "#1f4e79"
MESH = "#6d675d"
CONTOURS = {  # keyword of PLOT: what it means, from the stresses 11, 12, 22 (tension positive)
    "s11": "stress 11 (Pa)",
    "s12": "stress 12 (Pa)",
    "s22": "stress 22 (Pa)",
    "pressure": "pressure (Pa)",
    "shear": "greatest shear stress (Pa)",
}


@dataclass(frozen=True)
class Field:
    """Moving points (n): address, place (m) and velocity (m/s). Zones (k): corners (k, 3, 2), stress (k, 3).

    Stresses also of simply-deformable blocks: middle (m, 2) and stress (m, 3) of zones and such blocks.
    """

    address: Any
    place: Any
    velocity: Any
    zone: Any
    zone_stress: Any
    middle: Any
    stress: Any


def field(h: Memory) -> Field:
    """A copy of points and stresses of the present state. Unsound if the heap cannot be walked."""
    blocks = list(groups(h, "block"))
    hard = [ib for ib in blocks if iget(h, ib, HEAD) != g.MFDEF]
    points = [ig for ib in blocks for ig in members(h, ib, "gridpoint")]
    zones = [iz for ib in blocks for iz in members(h, ib, "zone")]
    simple = [iget(h, ib, g.KBEX) for ib in hard if iget(h, ib, HEAD) == g.MSDEF]
    place = np.concatenate([_reals(h, hard, g.KX, g.KY), _reals(h, points, g.KXG, g.KYG)])
    velocity = np.concatenate([_reals(h, hard, g.KXD, g.KYD), _reals(h, points, g.KXDG, g.KYDG)])
    at = {address: i for i, address in enumerate(hard + points)}
    rows = np.array([[at[iget(h, iz, g.KZG, i)] for i in range(3)] for iz in zones], int).reshape(-1, 3)
    zone_stress = _reals(h, zones, g.KZS11, g.KZS12, g.KZS22)
    centres = [place[at[ib]] for ib in hard if iget(h, ib, HEAD) == g.MSDEF]
    return Field(
        np.array(hard + points, np.int64),
        place,
        velocity,
        place[rows],
        zone_stress,
        np.concatenate([place[rows].mean(axis=1), np.array(centres).reshape(-1, 2)]),
        np.concatenate([zone_stress, _reals(h, simple, g.KS111, g.KS112, g.KS122)]),
    )


def _reals(h: Memory, addresses: list[int], *names: Offset) -> Any:
    at: Any = np.array(addresses, np.int64)
    return np.stack([np.array(getr(h, at, k), np.float64) for k in names], axis=-1)


def measure(stress: Any, name: str) -> Any:
    """One number for each stress (k, 3): see CONTOURS."""
    s11, s12, s22 = stress.T
    if name == "pressure":
        return -(s11 + s22) / 2
    if name == "shear":
        return np.hypot((s11 - s22) / 2, s12)
    return {"s11": s11, "s12": s12, "s22": s22}[name]


def draw_zones(axes: Axes, now: Field) -> None:
    """The sides of all zones."""
    from matplotlib.collections import PolyCollection

    axes.add_collection(
        PolyCollection(list(now.zone), facecolors="none", edgecolors=MESH, linewidths=0.4, zorder=2.6)
    )


def draw_contours(axes: Axes, now: Field, name: str) -> None:
    """Zones in the colour of one of their stresses, with a key on the right."""
    from matplotlib.collections import PolyCollection

    values = measure(now.zone_stress, name)
    signed = name != "shear"
    most = float(np.abs(values).max(initial=0.0)) or 1.0
    patches = PolyCollection(list(now.zone), cmap="RdBu_r" if signed else "viridis", zorder=2.4)
    patches.set_array(values)
    patches.set_clim(-most if signed else 0.0, most)
    axes.add_collection(patches)
    strip = axes.inset_axes((1.02, 0.0, 0.02, 1.0))
    bar = axes.figure.colorbar(patches, cax=strip)
    bar.set_label(CONTOURS[name], fontsize=8)
    strip.tick_params(labelsize=7)


def draw_principal(axes: Axes, now: Field, size: float) -> str:
    """Crosses along the principal stresses; returns a note on their scale."""
    from matplotlib.collections import LineCollection

    s11, s12, s22 = now.stress.T
    angle = np.arctan2(2 * s12, s11 - s22) / 2
    mean, radius = (s11 + s22) / 2, np.hypot((s11 - s22) / 2, s12)
    most = float((np.abs(mean) + radius).max(initial=0.0)) or 1.0
    for value, turn in ((mean + radius, 0.0), (mean - radius, np.pi / 2)):
        along = np.stack([np.cos(angle + turn), np.sin(angle + turn)], axis=-1)
        half = along * (np.abs(value) / most * size * LONGEST / 2)[:, None]
        for chosen, colour in ((value > 0, TENSION), (value < 0, COMPRESSION)):
            lines = np.stack([now.middle - half, now.middle + half], axis=1)[chosen]
            axes.add_collection(LineCollection(list(lines), colors=colour, linewidths=0.9, zorder=4))
    return f"largest principal stress: {most:.4g} Pa (red: tension)"


def draw_velocities(axes: Axes, now: Field, size: float) -> str:
    """Arrows along the velocities of all moving points; returns a note on their scale."""
    return f"largest velocity: {_arrows(axes, now.place, now.velocity, size):.4g} m/s"


def draw_displacements(axes: Axes, first: Field, now: Field, size: float) -> str:
    """Arrows along the displacements since the first state of the frame; returns a note on their scale."""
    at = {address: i for i, address in enumerate(first.address.tolist())}
    both = [(at[address], i) for i, address in enumerate(now.address.tolist()) if address in at]
    before, after = np.array(both, int).reshape(-1, 2).T
    moved = now.place[after] - first.place[before]
    return f"largest displacement: {_arrows(axes, now.place[after], moved, size):.4g} m"


def _arrows(axes: Axes, place: Any, vector: Any, size: float) -> float:
    """Arrows with their tails at `place`, the longest LONGEST of the picture; returns the greatest length."""
    most = float(np.hypot(*vector.T).max(initial=0.0))
    if most > 0:
        reach = vector * (size * LONGEST / most)
        style: dict[str, Any] = {"angles": "xy", "scale_units": "xy", "scale": 1.0, "width": 0.0025}
        axes.quiver(*place.T, *reach.T, color=ARROW, zorder=5, **style)
    return most
