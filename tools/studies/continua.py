"""Verification problems of deformable blocks: waves, stresses, limit load, and a bar with joints."""

from __future__ import annotations

from math import pi, sqrt
from typing import Any

import numpy as np
from figure import RHO, Figure, cycle_for, deform
from udec_ia.verify.grids import generate, outline, quarter_ring, rectangle

from udec_ia import Model
from udec_ia.heap.accessors import putr
from udec_ia.layout import offsets as g

GRAVITY = 10.0
BULK, SHEAR = 2e8, 1e8
CP = sqrt((BULK + 4 * SHEAR / 3) / RHO)


def crossings(t: Any, v: Any) -> Any:
    """Times at which a vibration passes zero."""
    i = np.flatnonzero(np.sign(v[1:]) != np.sign(v[:-1]))
    return t[i] - v[i] * (t[i + 1] - t[i]) / (v[i + 1] - v[i])


def mode() -> list[Figure]:
    """Free uniaxial mode of a simply-deformable block: w = sqrt(12) Cp/L, alone if K = 2G/3."""
    length, shear = 2.0, 1e9
    m = Model()
    m.round(0.02)
    m.block(0, 0, 0, 1, length, 1, length, 0)
    m.property(1, density=RHO, kn=1e9, ks=1e9, bulk=2 * shear / 3, g=shear)
    m.change(-1, 3, -1, 2, type="sdef")
    m.fraction(0.05)
    m.cycle(0)
    putr(m.h, int(m.table("sdef")["address"][0]), g.KED11, 1e-3)
    t, s = [], []
    for _ in range(500):
        m.cycle(1)
        t.append(float(m.h.cd[g.TIME]))
        s.append(float(m.table("sdef")["KS111"][0]))
    got = pi / float(np.diff(crossings(np.array(t), np.array(s))).mean())
    exact = sqrt(12) * sqrt(2 * shear / RHO) / length
    return [Figure("mode of a simply-deformable block (rad/s)", got, exact, 0.005)]


def slab(nodes: Any, mixed: bool = False, law: Any = None, **strength: float) -> Model:
    """A fully-deformable block under the nodes of a rectangle."""
    m = Model(constitutive=law)
    m.round(0.02)
    (x0, y0), (x1, y1) = nodes[0, 0], nodes[-1, -1]
    m.block(x0, y0, x0, y1, x1, y1, x1, y0, constitutive=1 if law is None else 2)
    m.property(1, density=RHO, kn=1e9, ks=1e9, bulk=BULK, g=SHEAR, **strength)
    generate(m, nodes, mixed)
    return m


def period() -> list[Figure]:
    """Confined column fixed below, free above, its weight put on at once: 4 H/Cp; 20 zones over H."""
    height = 10.0
    m = slab(rectangle(0, 1, 0, height, 1, 20))
    m.boundary(-0.1, 1.1, -1, height + 1, xvel=0)
    m.boundary(-0.1, 1.1, -0.1, 0.1, xvel=0, yvel=0)
    m.gravity(0, -GRAVITY)
    m.fraction(0.5)
    m.cycle(0)
    t, v = [], []
    while m.h.cd[g.TIME] < 2.2 * 4 * height / CP:
        m.cycle(2)
        points = m.table("gridpoint")
        v.append(float(points["KYDG"][points["KYG"].argmax()]))
        t.append(float(m.h.cd[g.TIME]))
    got = 2 * float(np.diff(crossings(np.array(t), np.array(v))).mean())
    return [Figure("period of a confined column (s)", got, 4 * height / CP, 0.02)]


def energies(m: Model) -> tuple[float, float]:
    """Kinetic energy of the slab above, and its strain energy, J/m."""
    points, zones = m.table("gridpoint"), m.table("zone")
    kinetic = 0.5 * (points["KGPM"] * (points["KXDG"] ** 2 + points["KYDG"] ** 2)).sum()
    one, two = BULK + 4 * SHEAR / 3, BULK - 2 * SHEAR / 3
    s11, s12, s22 = zones["KZS11"], zones["KZS12"], zones["KZS22"]
    density = (one * (s11**2 + s22**2) - 2 * two * s11 * s22) / (one**2 - two**2) + s12**2 / SHEAR
    return float(kinetic), float((zones["KZM"] / RHO * density).sum() / 2)


def pulsed(length: float, lasts: float, stress: float) -> Model:
    """A bar on rollers with viscous ends, into which a smooth pulse of the given stress will run."""
    m = slab(rectangle(0, length, 0, 1, 60, 2))
    for y in (0.0, 1.0):
        m.boundary(-1, length + 1, y - 0.01, y + 0.01, yvel=0)
    for x in (0.0, length):
        m.boundary(x - 0.01, x + 0.01, -1, 2, viscous=True)
    times = np.linspace(0, lasts, 60)
    factors = 0.5 * (1 - np.cos(2 * np.pi * times / lasts))
    m.function(1, *np.stack([times, factors], axis=-1).ravel().tolist(), 1.001 * lasts, 0.0)
    m.boundary(-0.01, 0.01, -1, 2, stress=(2 * stress, 0, 0), function=1)  # half of it stays in the dashpots
    m.fraction(0.5)
    m.cycle(0)
    return m


def pulse() -> list[Figure]:
    """A stress pulse runs along a bar with Cp and leaves through a viscous edge, with its energy."""
    length = 10.0
    m = pulsed(length, 0.4 * length / CP, -1e4)
    centre, t, s, largest = [], [], [], 0.0
    while m.h.cd[g.TIME] < 2 * length / CP:
        m.cycle(5)
        zones, points = m.table("zone"), m.table("gridpoint")
        if not centre:
            x = dict(zip(points["address"].tolist(), points["KXG"].tolist(), strict=True))
            place = np.array([np.mean([x[i] for i in row]) for row in zones["KZG"].tolist()])
            centre = [abs(place - at).argmin() for at in (2.5, 7.5)]
        t.append(float(m.h.cd[g.TIME]))
        s.append(-zones["KZS11"][centre])
        largest = max(largest, sum(energies(m)))
    arrival = []
    for history in np.array(s).T:  # of the peak, by the parabola through the three highest samples
        k = int(history.argmax())
        a, b, c = history[k - 1 : k + 2]
        arrival.append(t[k] + (t[1] - t[0]) * (a - c) / (2 * (a - 2 * b + c)))
    speed = float(place[centre[1]] - place[centre[0]]) / (arrival[1] - arrival[0])
    return [
        Figure("speed of a plane wave (m/s)", speed, CP, 0.01),
        Figure("share of a pulse's energy that a viscous edge leaves", sum(energies(m)) / largest, 0.0, 0.01),
    ]


def hole() -> list[Figure]:
    """A round hole under hydrostatic pressure, quarter model with rollers, 24 zones around: p a/(2G), 2p."""
    inner, outer, p, shear = 1.0, 12.0, 1e6, 6e8
    nodes = quarter_ring(inner, outer, 12, 24)
    m = Model()
    m.round(0.02)
    m.block(*outline(nodes))
    m.property(1, density=RHO, kn=1e9, ks=1e9, bulk=1e9, g=shear)
    generate(m, nodes)
    everywhere = (-0.001, outer + 0.001, -0.001, outer + 0.001)
    m.insitu(*everywhere, -p, 0, -p)
    m.boundary(-0.001, 0.001, -1, outer + 1, xvel=0)
    m.boundary(-1, outer + 1, -0.001, 0.001, yvel=0)
    m.boundary(*everywhere, stress=(-p, 0, -p))
    m.boundary(-0.001, inner + 0.001, -0.001, inner + 0.001, stress=(p, 0, p))  # the wall is free
    m.fraction(0.6)
    m.damping(0.6, sqrt(1.8e9 / RHO) / outer / 4, "mass")
    m.cycle(3000)
    points, zones = m.table("gridpoint"), m.table("zone")
    moved = inner - float(np.sort(np.hypot(points["KXG"], points["KYG"]))[:13].mean())
    at = {int(row["address"]): (row["KXG"], row["KYG"]) for row in points}
    middle = np.array([np.mean([at[i] for i in row], axis=0) for row in zones["KZG"].tolist()])
    r2 = (middle**2).sum(axis=1)
    x, y = middle.T
    hoop = (zones["KZS11"] * y * y + zones["KZS22"] * x * x - 2 * zones["KZS12"] * x * y) / r2
    near = np.argsort(r2)[:24]  # the ring of zones at the wall
    exact = -p * (1 + inner**2 / r2[near])
    return [
        Figure("wall of a hole moves by (m)", moved, p * inner / (2 * shear), 0.03),
        Figure("hoop stress beside it, over p (1 + a^2/r^2)", float((hoop[near] / exact).mean()), 1.0, 0.03),
    ]


def footing() -> list[Figure]:
    """A rigid strip pressed into cohesive ground: q = (2 + pi) c, with and without pairs of zones."""
    width, height, half, n, c, v = 10.0, 5.0, 2.0, 20, 1e5, 2e-3
    figures = []
    for mixed in (True, False):
        nodes = rectangle(0, width, 0, height, n, n // 2)
        m = slab(nodes, mixed, "mohr-coulomb", block_cohesion=c, block_tension=1e9)
        for x in (0.0, width):
            m.boundary(x - 0.001, x + 0.001, -1, height + 1, xvel=0)
        m.boundary(-1, width + 1, -0.001, 0.001, xvel=0, yvel=0)
        m.boundary(-1, half + 0.001, height - 0.001, height + 0.001, xvel=0, yvel=-v)
        m.fraction(0.5)
        m.damping(0.5, CP / 4 / height, "mass")
        m.cycle(0)
        cycle_for(m, 0.02 * half / v)  # settlement 2 % of the half width
        points = m.table("gridpoint")
        under = (points["KGFIX"] >= 2) & (points["KYG"] > height / 2)
        carried = float(points["KGFY"][under].sum())
        got = carried / (half + width / n / 2) / c  # the load reaches half a zone beyond the last point
        name = f"strip footing, q/c, {'mixed discretisation' if mixed else 'without it'}"
        figures.append(Figure(name, got, 2 + pi, 0.05 if mixed else 0.25))
    return figures


def bar() -> list[Figure]:
    """Modulus of a bar in one piece and cut by joints with the spacing S: 1/E_m = 1/E + 1/(kn S).

    Without a Poisson effect, K = 2G/3, E is 2G. A joint has two contacts on its width of 1, so kn = 2 KN.
    """
    shear, kn, n, spacing, s = 1e9, 1e9, 5, 1.5, 1e4
    length, figures = n * spacing, []
    for kind in ("sdef", "fdef"):
        for joints in (False, True):
            m = Model()
            m.fraction(0.3)
            m.round(0.02)
            m.block(0, 0, 0, 1, length, 1, length, 0)
            m.property(1, density=RHO, kn=kn, ks=kn, bulk=2 * shear / 3, g=shear, friction=1.0)
            cells = [(k * spacing, (k + 1) * spacing) for k in range(n)] if joints else [(0.0, length)]
            for x, _ in cells[1:]:
                m.split(x, -1, x, 2)
            for x1, x2 in cells:
                deform(m, kind, x1, x2, 0, 1)
            for x in (0.0, length):
                m.boundary(x - 0.001, x + 0.001, -1, 2, stress=(-s, 0, 0))
            m.damping(0.8, sqrt(2 * shear / RHO) / (4 * length), "mass")
            m.damping(0.8, sqrt(2 * shear / RHO) / (4 * length), "internal")
            before = ends(m, joints)
            m.cycle(6000)
            strain = 1 - ends(m, joints) / before
            exact = 1 / (1 / (2 * shear) + (1 / (2 * kn * spacing) if joints else 0.0))
            name = f"modulus of a bar, {kind}, {'cut into blocks' if joints else 'one block'} (Pa)"
            figures.append(Figure(name, s / strain, exact, 0.01))
    return figures


def ends(m: Model, joints: bool) -> float:
    """Distance of the first and last centroid of a cut bar - whole spacings - or of the ends of one block."""
    x = m.table("block")["KX"] if joints else m.table("corner")["KXP"]
    return float(np.ptp(x))
