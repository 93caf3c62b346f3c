"""Figures of docs/theory and docs/units.md: drawings, and runs of the program beside their formulas.

    python docs/studies/theory_figures.py [NAME ...] [--out docs/images]

Without a name all are drawn: theory-rounding, theory-contacts, theory-step, theory-damping, theory-joints,
theory-zones, units-signs. Each takes some seconds at most.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from udec_ia import Model
from udec_ia.layout.offsets import TDEL

ROCK, EDGE, FORCE, HELP = "#eddfc3", "#333333", "#b22222", "#1f77b4"


def arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], colour: str = FORCE) -> None:
    """An arrow from a point to another one."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.8})


def measure(axes: Axes, start: tuple[float, float], end: tuple[float, float], text: str, side: float) -> None:
    """A dimension line between two points, with its name beside the middle."""
    axes.annotate("", end, start, arrowprops={"arrowstyle": "<->", "color": HELP, "lw": 1.2, "shrinkA": 0, "shrinkB": 0})
    along = np.subtract(end, start) / np.hypot(*np.subtract(end, start))
    x, y = np.add(start, end) / 2 + side * np.array([-along[1], along[0]])
    axes.text(x, y, text, color=HELP, ha="center", va="center")


def drawing(columns: int, width: float, height: float) -> tuple[Figure, list[Axes]]:
    """A figure of drawings side by side, without axes and with equal scales."""
    figure = Figure(figsize=(width, height), layout="constrained")
    found = np.atleast_1d(figure.subplots(1, columns))
    for axes in found:
        axes.set_aspect("equal")
        axes.axis("off")
    return figure, list(found)


def rounding() -> Figure:
    """A corner and its circle: D along both edges, and the radius R."""
    figure, (axes,) = drawing(1, 6, 4)
    tip, angle, d = np.array([0.0, 0.0]), np.radians(70), 1.6
    first, second = np.array([1.0, 0.0]), np.array([np.cos(angle), np.sin(angle)])
    centre = d / np.cos(angle / 2) * (first + second) / np.hypot(*(first + second))
    radius = d * np.tan(angle / 2)
    axes.add_patch(Polygon([tip, 4 * first, 4 * first + 1.9 * second, 2.7 * second], fc=ROCK, ec="none"))
    axes.plot([0, 4], [0, 0], color=EDGE, lw=1, ls=":")
    axes.plot(*np.transpose([tip, 2.7 * second]), color=EDGE, lw=1, ls=":")
    axes.plot(*np.transpose([d * first, 4 * first]), color=EDGE, lw=2)
    axes.plot(*np.transpose([d * second, 2.7 * second]), color=EDGE, lw=2)
    axes.add_patch(Circle(tuple(centre), radius, fill=False, ec=HELP, lw=1, ls="--"))
    axes.add_patch(Arc(tuple(centre), 2 * radius, 2 * radius, theta1=160, theta2=270, color=EDGE, lw=2))
    measure(axes, (0, -0.25), (d, -0.25), "D", -0.22)
    measure(axes, tuple(-0.3 * first + 0.1 * second), tuple(-0.3 * first + 0.1 * second + d * second), "D", 0.22)
    arrow(axes, tuple(centre), tuple(centre + radius * np.array([0, -1])), HELP)
    axes.text(centre[0] + 0.12, centre[1] / 2, "R", color=HELP)
    axes.plot(*centre, "+", color=HELP)
    axes.add_patch(Arc((0, 0), 1.1, 1.1, theta1=0, theta2=70, color=EDGE))
    axes.text(0.28, 0.16, r"$\theta$")
    axes.text(3.1, 1.1, "block")
    axes.set(xlim=(-1, 4.1), ylim=(-0.8, 2.8))
    return figure


def contacts() -> Figure:
    """Corner on edge, and corner on corner: normal and overlap."""
    figure, (left, right) = drawing(2, 9, 4)
    for axes in (left, right):
        axes.set(xlim=(-2.6, 2.6), ylim=(-1.9, 2.6))
    left.add_patch(Polygon([(-2.5, 0), (2.5, 0), (2.5, -1.8), (-2.5, -1.8)], fc=ROCK, ec=EDGE, lw=1.5))
    left.add_patch(Circle((0, 0.8), 1, fc=ROCK, ec=EDGE, lw=1.5, alpha=0.9))
    left.plot([-2.5, 2.5], [0, 0], color=EDGE, lw=1.5)
    left.plot(0, 0.8, "+", color=HELP)
    left.text(-0.25, 0.85, "c", color=HELP)
    measure(left, (0, 0.8), (np.cos(0.6), 0.8 + np.sin(0.6)), "r", 0.2)
    measure(left, (1.5, -0.2), (1.5, 0), "", 0)
    left.text(1.6, -0.17, "overlap", color=HELP)
    arrow(left, (0, -0.1), (0, -1.1))
    left.text(0.12, -0.9, "normal n", color=FORCE)
    arrow(left, (0, -0.1), (1.0, -0.1), "#2e7d32")
    left.text(0.3, -0.42, "tangent t", color="#2e7d32")
    left.text(-1.6, 2.1, "corner on edge", fontsize=12)
    left.text(-2.2, 1.3, "block KB1")
    left.text(-2.3, -1.5, "block KB2")
    one, two = np.array([-0.85, -0.5]), np.array([0.75, 0.65])
    for centre, radius in ((one, 1.1), (two, 1.05)):
        right.add_patch(Circle(tuple(centre), radius, fc=ROCK, ec=EDGE, lw=1.5, alpha=0.8))
        right.plot(*centre, "+", color=HELP)
    right.text(one[0] - 0.2, one[1] - 0.35, "$c_1$", color=HELP)
    right.text(two[0] + 0.1, two[1] + 0.1, "$c_2$", color=HELP)
    right.plot(*np.transpose([one, two]), ls=":", color=EDGE)
    along = (two - one) / np.hypot(*(two - one))
    middle = one + along * (1.1 + np.hypot(*(two - one)) - 1.05) / 2
    arrow(right, tuple(middle), tuple(middle + 1.1 * along))
    right.text(*(middle + 0.9 * along + [0.12, -0.25]), "n", color=FORCE)
    arrow(right, tuple(middle), tuple(middle + np.array([-along[1], along[0]])), "#2e7d32")
    right.text(*(middle + 0.9 * np.array([-along[1], along[0]]) + [-0.25, 0.05]), "t", color="#2e7d32")
    right.text(-1.6, 2.1, "corner on corner", fontsize=12)
    right.text(-2.3, -1.75, "block KB1")
    right.text(1.3, 1.9, "block KB2")
    return figure


def column(**damping: object) -> Model:
    """A square block of 1 m on a fixed one, two contacts of 1E8 N/m2; the weight is applied at once."""
    m = Model()
    m.tell = m.inform = lambda text: None
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5)
    m.gravity(0, -10)
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.block(0, 1, 0, 2, 1, 2, 1, 1)
    m.round(0.05)
    m.fix(0, 1, 0, 1)
    if damping:
        m.damping(**damping)
    return m


def step() -> Figure:
    """The period of a block that bounces, against the time-step; and the growth beyond the limit."""
    frequency = np.sqrt(2 * 1e8 / 2000)
    critical = 2 / frequency
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    shares, periods = np.array([0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.97]), []
    for share in shares:
        m = column(local=0.8)
        m.boundary(0, 1, 1, 2, xvel=0, rotation=0)
        m.solve(1e-6)
        m.damping(0, 1)
        m.fraction(0.1 * share * critical / m.h.cr[TDEL])
        m.gravity(0, -13)
        (height,) = m.history(1, "KY", at=(0.5, 1.5))
        m.cycle(time=60 * 2 * np.pi / frequency)
        cycle, time, y = height.numbers[1:].T
        wave = y - y.mean()
        crossings = np.nonzero((wave[:-1] < 0) & (wave[1:] >= 0))[0]
        at = time[crossings] - wave[crossings] / (wave[crossings + 1] - wave[crossings]) * np.diff(time)[crossings]
        periods.append((at[-1] - at[0]) / (len(at) - 1) * frequency / (2 * np.pi))
    curve = np.linspace(0.01, 0.999, 200)
    left.plot(curve, curve / np.arcsin(curve), label="theory")
    left.plot(shares, periods, "o", label="udec_ia")
    left.set(xlabel="time-step / critical time-step", ylabel="period / exact period", ylim=(0.6, 1.02))
    left.legend()
    left.grid(alpha=0.3)
    for share, colour in ((0.95, "tab:green"), (1.0005, "tab:red")):
        growth = np.empty(60)
        x, v = 1.0, 0.0
        for i in range(60):
            v -= x * frequency**2 * share * critical * (0.5 if i == 0 else 1)
            x += v * share * critical
            growth[i] = x
        right.plot(growth, "o-", ms=3, lw=1, color=colour, label=f"{share:g} of the critical step")
    right.set(xlabel="cycle", ylabel="displacement / first one")
    right.legend(fontsize="small")
    right.grid(alpha=0.3)
    return figure


def damping() -> Figure:
    """A block on two contacts, whose weight is applied at once, under each kind of damping."""
    kinds = {
        "none": {},
        "MASS, 0.2 at 50 Hz": {"fcrit": 0.2, "freq": 50, "only": "mass"},
        "STIFFNESS, 0.2 at 50 Hz": {"fcrit": 0.2, "freq": 50, "only": "stiffness"},
        "LOCAL 0.3": {"local": 0.3},
        "COMBINED 0.3": {"combined": 0.3},
        "KINETIC": {"kinetic": True},
        "ADAPTIVE 0.7": {"adaptive": 0.7},
    }
    figure = Figure(figsize=(8, 6.5), layout="constrained")
    panels = figure.subplots(len(kinds), 1, sharex=True, sharey=True)
    static = 2000 * 10 / 2e8
    for axes, (name, given) in zip(panels, kinds.items(), strict=True):
        m = column(**given)
        m.fraction(0.1, safe=True)
        (height,) = m.history(1, "KY", at=(0.5, 1.5))
        m.cycle(time=0.1)
        _, time, y = height.numbers.T
        axes.plot(1000 * time, (1.5 - y) / static, lw=1.2)
        axes.axhline(1, color=EDGE, lw=0.6, ls=":")
        axes.set_title(name, fontsize=9, loc="left", pad=2)
        axes.set(yticks=[0, 1, 2], ylim=(-0.2, 2.2))
    panels[-1].set_xlabel("time (ms)")
    figure.supylabel("settlement / static settlement")
    return figure


def shear_curves() -> dict[str, np.ndarray]:
    """Shear displacement and stress of a joint of 1 m under 1 MPa, for three joint materials."""
    given = {
        "COULOMB, c 0.2 MPa, residual 0": {"kn": 1e10, "ks": 2e9, "friction": 0.6, "cohesion": 2e5, "residual_cohesion": 0.0},
        "YIELDING, friction 1 to 0.58": {"model": "yielding", "kn": 1e10, "ks": 2e9, "friction": 0.58, "initial_friction": 1.0, "roughness": 4e-4},
        "BARTON, JRC 8, JCS 100 MPa": {"model": "barton", "jrc": 8, "jcs": 1e8, "sigmac": 1e8, "friction": 0.53, "ks": 2e9, "kn_max": 1e12},
    }
    found = {}
    for name, properties in given.items():
        m = Model()
        m.tell = m.inform = lambda text: None
        m.property(1, density=2500)
        m.jproperty(1, between=(1, 1), **properties)
        m.block(0, 0, 0, 0.5, 1, 0.5, 1, 0)
        m.block(0, 0.5, 0, 1, 1, 1, 1, 0.5)
        m.round(0.01)
        m.fix(0, 1, 0, 0.5)
        m.damping(local=0.8)
        m.function(1, 0, 0, 0.1, 1)
        m.boundary(-0.1, 1.1, 0.99, 1.01, stress=(0, 0, -1e6), function=1)
        m.boundary(0, 1, 0.5, 1, rotation=0)
        m.cycle(time=0.1)
        m.solve(1e-5)
        m.boundary(0, 1, 0.5, 1, xvel=2e-3, rotation=0)
        histories = m.history(20, "KCS", at=(0.05, 0.5)) + m.history(20, "KCJTS", at=(0.05, 0.5))
        m.cycle(time=0.5)
        found[name] = np.column_stack([one.numbers[1:, 2] for one in histories])
    return found


def joints() -> Figure:
    """Shear stress of three joint models, calculated by the program, and closure of two by their formulas."""
    figure = Figure(figsize=(8, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, curve in shear_curves().items():
        left.plot(1e3 * np.abs(curve[:, 0]), np.abs(curve[:, 1]) / 1e6, label=name)
    left.set(xlabel="shear displacement (mm)", ylabel="shear stress (MPa)", ylim=(0, None), xlim=(0, 1))
    left.legend(fontsize="x-small", loc="lower right")
    left.grid(alpha=0.3)
    u = np.linspace(0, 0.2, 300)
    jrc, jcs = 8, 100.0
    aperture = jrc / 5 * (0.2 - 0.1)
    stiffness = -7.15 + 1.75 * jrc + 0.02 * jcs / aperture
    largest = min(-0.2960 - 0.0056 * jrc + 2.2410 * (jcs / aperture) ** -0.2450, aperture)
    inside = u[u < 0.97 * largest]
    right.plot(inside, stiffness * inside / (1 - inside / largest), label="BARTON, JRC 8, JCS 100 MPa")
    right.plot(u, 50 * u, label="COULOMB, KN 50 GPa/m")
    right.set(xlabel="closure (mm)", ylabel="normal stress (MPa)", ylim=(0, 15), xlim=(0, 0.2))
    right.legend(fontsize="x-small")
    right.grid(alpha=0.3)
    return figure


def zones() -> Figure:
    """The three types of blocks under the same load, with their degrees of freedom."""
    figure, panels = drawing(3, 9, 3.4)
    for axes, title in zip(panels, ("rigid", "simply-deformable", "zones"), strict=True):
        axes.set(xlim=(-0.5, 3.2), ylim=(-0.7, 3))
        axes.set_title(title)
        for x in (0.4, 1.2, 2.0):
            arrow(axes, (x + 0.1, 2.95), (x + 0.1, 2.35))
    panels[0].add_patch(Polygon([(0, 0), (0, 2.2), (2.6, 2.2), (2.6, 0)], fc=ROCK, ec=EDGE, lw=1.5))
    panels[0].plot(1.3, 1.1, "o", color=HELP)
    panels[0].text(0.1, -0.5, "x, y, rotation: 3 degrees of freedom", fontsize=8)
    panels[1].add_patch(Polygon([(0, 0), (0, 2.2), (2.6, 2.2), (2.6, 0)], fill=False, ec=EDGE, lw=0.8, ls=":"))
    panels[1].add_patch(Polygon([(-0.1, 0), (0.1, 2.0), (2.85, 2.0), (2.65, 0)], fc=ROCK, ec=EDGE, lw=1.5))
    panels[1].plot(1.35, 1.0, "o", color=HELP)
    panels[1].text(0.0, -0.5, "and three strain rates: 6, one stress", fontsize=8)
    points = np.array([(0, 0), (-0.15, 1.0), (0, 2.2), (1.3, 1.9), (2.6, 2.2), (2.75, 1.0), (2.6, 0), (1.3, 0), (1.3, 1.0)])
    panels[2].add_patch(Polygon(points[:8], fc=ROCK, ec=EDGE, lw=1.5))
    for point in points[:8]:
        panels[2].plot(*np.transpose([points[8], point]), color=EDGE, lw=0.7)
    panels[2].plot(*points.T, "o", ms=4, color=HELP)
    panels[2].text(-0.1, -0.5, "x, y of each grid-point, one stress a zone", fontsize=8)
    return figure


def signs() -> Figure:
    """Signs of stresses, forces, displacements and rotations."""
    figure, panels = drawing(3, 9, 3.8)
    for axes in panels:
        axes.set(xlim=(-1.9, 1.9), ylim=(-2.2, 2.0))
    stress, contact, motion = panels
    stress.add_patch(Polygon([(-0.7, -0.7), (-0.7, 0.7), (0.7, 0.7), (0.7, -0.7)], fc=ROCK, ec=EDGE, lw=1.5))
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        arrow(stress, (0.75 * x, 0.75 * y), (1.5 * x, 1.5 * y))
    for x, y, dx, dy in ((0.85, -0.5, 0, 1), (-0.85, 0.5, 0, -1), (-0.5, 0.85, 1, 0), (0.5, -0.85, -1, 0)):
        arrow(stress, (x, y), (x + dx, y + dy), "#2e7d32")
    stress.text(1.25, 0.15, "s11", color=FORCE)
    stress.text(0.12, 1.4, "s22", color=FORCE)
    stress.text(0.93, 0.55, "s12", color="#2e7d32")
    stress.set_title("stress in blocks: tension +", fontsize=10)
    stress.text(-1.8, -2.1, "compression is negative", fontsize=9)
    contact.add_patch(Polygon([(-1.7, -1.7), (-1.7, -0.1), (1.7, -0.1), (1.7, -1.7)], fc=ROCK, ec=EDGE, lw=1.5))
    contact.add_patch(Polygon([(-1.1, 0.1), (-1.1, 1.6), (1.1, 1.6), (1.1, 0.1)], fc=ROCK, ec=EDGE, lw=1.5))
    contact.text(-1.0, 1.25, "KB2")
    contact.text(-1.6, -1.55, "KB1")
    arrow(contact, (0.3, 0), (0.3, 0.9))
    contact.text(0.4, 0.6, "n, Fn on KB2", color=FORCE, fontsize=9)
    arrow(contact, (0.3, 0), (-0.6, 0), "#2e7d32")
    contact.text(-0.75, 0.2, "t", color="#2e7d32")
    contact.set_title("contacts and joints: compression +", fontsize=10)
    contact.text(-1.8, -2.1, "overlap +, gap -; slip of KB2 along t +", fontsize=9)
    motion.annotate("", (1.6, -1.4), (-1.4, -1.4), arrowprops={"arrowstyle": "->"})
    motion.annotate("", (-1.4, 1.7), (-1.4, -1.4), arrowprops={"arrowstyle": "->"})
    motion.text(1.45, -1.25, "x")
    motion.text(-1.3, 1.6, "y")
    motion.add_patch(Polygon([(-0.5, -0.7), (-0.7, 0.4), (0.4, 0.6), (0.6, -0.5)], fc=ROCK, ec=EDGE, lw=1.5))
    motion.add_patch(Arc((0, 0), 2.4, 2.4, theta1=-20, theta2=70, color=FORCE, lw=1.8))
    motion.annotate("", (0.35, 1.15), (0.47, 1.1), arrowprops={"arrowstyle": "-|>", "color": FORCE})
    motion.text(0.75, 1.05, "rotation +", color=FORCE, fontsize=9)
    for number, (x, y, dx, dy) in enumerate(((-0.5, -0.7, -0.2, -0.3), (-0.7, 0.4, -0.3, 0.1), (0.4, 0.6, 0.1, 0.15), (0.6, -0.5, 0.15, -0.2))):
        motion.text(x + dx, y + dy, str(number + 1), color=HELP, ha="center", va="center")
    motion.set_title("axes, rotation, order of corners", fontsize=10)
    motion.text(-1.8, -2.1, "corners clockwise; angles anticlockwise", fontsize=9)
    return figure


FIGURES = {
    "theory-rounding": rounding,
    "theory-contacts": contacts,
    "theory-step": step,
    "theory-damping": damping,
    "theory-joints": joints,
    "theory-zones": zones,
    "units-signs": signs,
}


def main() -> None:
    """Write the figures that are named, or all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--out", type=Path, default=ROOT / "docs" / "images")
    given = parser.parse_args()
    for name in given.names or FIGURES:
        FIGURES[name]().savefig(given.out / f"{name}.png", dpi=100)
        print(given.out / f"{name}.png")


if __name__ == "__main__":
    main()
