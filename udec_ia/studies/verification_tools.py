"""Functions that verification problems share: scenes, meshes of structured zones, and measurements."""

from __future__ import annotations

from math import cos, pi, sin, sqrt
from typing import Any

import numpy as np

from udec_ia.layout import offsets as g
from udec_ia.model import Model
from udec_ia.studies.verification import Case

REST = 1e-10  # force ratio of a state of rest, as far as the reals can hold one


def on_base(case: Case, m: Model, b: float, h: float, n: int = 1, width: float = 12.0) -> None:
    """Build a column of `n` blocks, `b` broad and `h` high, of the type of the case, centred at x = 0.

    It stands on a fixed rigid base, `width` wide and 1 m high, with its top at y = 0.
    """
    m.block(-width / 2, -1, -width / 2, n * h, width / 2, n * h, width / 2, -1)
    m.split(-width, 0, width, 0)
    for x in (-b / 2, b / 2):
        m.split(x, -0.5, x, n * h + 1)
    m.delete(-width, -b / 2, 0, n * h)
    m.delete(b / 2, width, 0, n * h)
    for k in range(1, n):
        m.split(-width, k * h, width, k * h)
    m.fix(-width, width, -1, 0)
    for k in range(n):
        case.deform(m, -b / 2, b / 2, k * h, (k + 1) * h)


def settle(case: Case, m: Model, stiffness: float, mass: float) -> None:
    """Let the blocks come to rest under critical damping of a mass on a spring; then take it away."""
    frequency = sqrt(stiffness / mass) / (2 * pi)
    m.damping(2.0, frequency, "mass")
    m.damping(1.0, frequency, "internal")
    m.solve(max(REST, 1e4 * case.last_digit), 20_000)  # as far as the last digits let it rest
    m.damping(0, 1)
    m.damping(0, 1, "internal")


def tilt(m: Model, g: float, angle: float, steps: int = 10) -> None:
    """Turn gravity g from downwards towards x, by `angle` (rad) in `steps`, with rest between them."""
    for k in range(1, steps + 1):
        m.gravity(g * sin(angle * k / steps), -g * cos(angle * k / steps))
        m.solve(1e-4, 5000)


def loose_polygons(
    m: Model, columns: int, rows: int, pitch: float, corners: tuple[int, int], smallest: float
) -> None:
    """Put polygons above y = 0, right of x = 0, at random angles, one to a square of the side `pitch` (m).

    corners: fewest, and one more than the most. smallest: of the radii, as a part of the greatest, 0.5 m.
    """
    rng = np.random.default_rng(5)
    for j in range(rows):
        for i in range(columns):
            n, turn, r = int(rng.integers(*corners)), rng.uniform(0, 2 * pi), 0.5 * rng.uniform(smallest, 1.0)
            x, y = (i + 0.5) * pitch, (j + 0.5) * pitch
            angles = turn - 2 * pi * np.arange(n) / n
            m.block(*(float(c) for t in angles for c in (x + r * cos(t), y + r * sin(t))))


def rectangle(x0: float, x1: float, y0: float, y1: float, nx: int, ny: int) -> Any:
    """Nodes of a rectangle, shape (ny + 1, nx + 1, 2)."""
    return np.stack(np.meshgrid(np.linspace(x0, x1, nx + 1), np.linspace(y0, y1, ny + 1)), axis=-1)


def quarter_ring(inner: float, outer: float, around: int, across: int) -> Any:
    """Nodes of a quarter of a ring about the origin, x and y positive; rings grow geometrically."""
    angle = np.linspace(np.pi / 2, 0.0, around + 1)
    radius = np.geomspace(inner, outer, across + 1)
    nodes = radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)[None]
    nodes[np.abs(nodes) < 1e-12 * outer] = 0.0
    return nodes


def outline(nodes: Any) -> list[float]:
    """Corners of a block around the nodes: the four sides with all their nodes, clockwise: x, y, x, y ..."""
    sides = [nodes[-1, :-1], nodes[::-1, -1][:-1], nodes[0, ::-1][:-1], nodes[:-1, 0]]
    loop = np.concatenate(sides)
    return [float(v) for v in loop.ravel()]


def generate(model: Model, nodes: Any, mixed: bool = False) -> int:
    """GENERATE for the block under the nodes; the diagonals of neighbouring quadrilaterals alternate."""
    nx, ny = int(nodes.shape[1]) - 1, int(nodes.shape[0]) - 1
    points = [(float(x), float(y)) for x, y in nodes.reshape(-1, 2)]

    def number(i: int, j: int) -> int:  # grid-points are numbered from the last one
        return len(points) - (j * (nx + 1) + i)

    zones = []
    for j in range(ny):
        for i in range(nx):
            a, b, c, d = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
            zones += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
    low, high = nodes.reshape(-1, 2).min(axis=0), nodes.reshape(-1, 2).max(axis=0)
    return model.generate(low[0], high[0], low[1], high[1], "manual", points, zones, mixed=mixed)


def fan(model: Model, x: float, y: float, edge_points: int = 0) -> int:
    """GENERATE for the convex block whose centroid is nearest to (x, y): all zones meet in its centroid.

    edge_points: grid-points on each edge besides those at its ends.
    """
    row, corners = block(model, x, y), model.table("corner")
    ring = corners[corners["KNB"] == row["address"]]
    outer: list[tuple[float, float]] = []
    for start, end in zip(ring, np.roll(ring, -1), strict=True):
        for k in range(edge_points + 1):
            s = k / (edge_points + 1)
            px, py = ((1 - s) * start[name] + s * end[name] for name in ("KXP", "KYP"))
            outer.append((float(px), float(py)))
    n, cx, cy = len(outer), float(row["KX"]), float(row["KY"])
    zones = [(1, k + 2, (k + 1) % n + 2) for k in range(n)]  # the centroid, given last, is number 1
    at = cx - 1e-6, cx + 1e-6, cy - 1e-6, cy + 1e-6
    return model.generate(*at, "manual", [*reversed(outer), (cx, cy)], zones)


def polar(model: Model) -> tuple[Any, Any, Any, Any]:
    """Of quadrilaterals: distance of the middle from the origin, mean radial and hoop stress, angle (rad)."""
    points, zones = model.table("gridpoint"), model.table("zone")
    at = {int(row["address"]): (row["KXG"], row["KYG"]) for row in points}
    middle = np.array([np.mean([at[i] for i in row], axis=0) for row in zones["KZG"].tolist()])
    x, y, s11, s12, s22 = (
        (one[0::2] + one[1::2]) / 2 for one in (*middle.T, zones["KZS11"], zones["KZS12"], zones["KZS22"])
    )
    r2 = x * x + y * y
    radial = (s11 * x * x + s22 * y * y + 2 * s12 * x * y) / r2
    hoop = (s11 * y * y + s22 * x * x - 2 * s12 * x * y) / r2
    return np.sqrt(r2), radial, hoop, np.arctan2(y, x)


def block(m: Model, x: float, y: float) -> Any:
    """The row of the block whose centroid is nearest to (x, y)."""
    blocks = m.table("block")
    return blocks[((blocks["KX"] - x) ** 2 + (blocks["KY"] - y) ** 2).argmin()]


def row(m: Model, kind: str, address: int) -> Any:
    """The row of the group of `kind` at `address`."""
    rows = m.table(kind)
    return rows[(rows["address"] == address).argmax()]


def push(m: Model, address: int, **velocity: float) -> None:
    """Give a block velocities: KXD, KYD (m/s), KTD (rad/s)."""
    m.patch(", ".join(f"block@{address}.{name} = {float(value)!r}" for name, value in velocity.items()))


def step(m: Model) -> float:
    """The time-step of the last CYCLE, s."""
    return float(m.h.cr[g.TDEL])


def now(m: Model) -> float:
    """Time since the first cycle, s."""
    return float(m.h.cd[g.TIME])


def cycle_for(m: Model, seconds: float) -> None:
    """Cycle for a time, with the time-step of the last CYCLE."""
    m.cycle(max(1, round(seconds / step(m))))


def period(t: Any, v: Any) -> float:
    """Of a vibration about zero, from all its crossings."""
    t, v = np.asarray(t), np.asarray(v)
    i = np.flatnonzero(np.sign(v[1:]) != np.sign(v[:-1]))
    times = t[i] - v[i] * (t[i + 1] - t[i]) / (v[i + 1] - v[i])
    return 2 * float(times[-1] - times[0]) / (len(times) - 1)


def straight_line(t: Any, v: Any) -> tuple[float, float]:
    """Slope of the straight line through velocities, and the error that the deviations from it can cause.

    Deviations of at most A, whatever their order, tilt the best line over a time T by 3 A/T.
    """
    t, v = np.asarray(t), np.asarray(v)
    line = np.polyfit(t, v, 1)
    return float(line[0]), 3 * float(np.abs(v - np.polyval(line, t)).max() / (t[-1] - t[0]))


def domain(m: Model, x: float, y: float) -> Any:
    """The rows in "domain" and "water" of the inner domain whose middle is nearest to (x, y)."""
    domains, water = m.table("domain"), m.table("water")
    far = (water["KVX"] - x) ** 2 + (water["KVY"] - y) ** 2
    k = (far + 1e30 * (domains["address"] == m.h.ci[g.IODPNT])).argmin()
    return domains[k], water[k]


def flow_through(m: Model, x1: float, x2: float, y1: float, y2: float) -> float:
    """Flow from the outer domain into the joints whose last contacts are in x1 x2 y1 y2, m2/s."""
    rows, pipes = m.table("contact"), m.table("pipe")
    outer = int(m.h.ci[g.IODPNT])
    inside = (rows["KXC"] > x1) & (rows["KXC"] < x2) & (rows["KYC"] > y1) & (rows["KYC"] < y2)
    q = pipes["KPQ"]
    return float(q[inside & (rows["KD1"] == outer)].sum() - q[inside & (rows["KD2"] == outer)].sum())
