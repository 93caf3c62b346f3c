"""A block rocks on a joint that opens

A block is pushed and rocks to and fro on its joint, which has no tensile strength. The joint is a bed of
springs kn (Pa/m) that carry where they are closed:

      .----.
      |    |         N = kn int u+ ds          m y'' = N - W
      |    |         M = kn int u+ s ds        (I + m h^2) th'' = M + N h th ...
    --+----+--
       <-L->         u+(s): closure of the place s, at least 0; h: height of the centroid

These equations of motion are integrated in small steps (Runge-Kutta), with all terms of a rigid block whose
base stays where it is sideways. The joint opens over more than half of its length.

Contacts come and go as the joint opens, and lengths with them, but a force never steps by more than that of
the length 4 D at the closure u: 4 D kn u.

Tolerance. Contacts stand D inside the edge; on the D beyond them stress is that at the contact and not more:
(D/a)^2 of the force, a the length that is closed at the greatest angle. The base moves sideways by T/(KS a),
T the friction, where h th is what the centroid moves. One step of the motion.

Source: G. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seism. Soc.
Am. 53 (1963) 403-417, for a rigid base; the joint as a bed of springs: E. Winkler (1867).
"""

from math import sqrt

import numpy as np

from udec_ia.heap.accessors import getr
from udec_ia.layout import offsets as g
from udec_ia.studies.verification import Answer
from udec_ia.studies.verification_tools import now, on_base, push, step

BLOCKS = ("rigid",)
GRAVITY, DENSITY, B, H, D = 10.0, 2000.0, 1.0, 2.0, 0.02
KN, KS = 1e8, 2e9
MASS, INERTIA = DENSITY * B * H, DENSITY * B * H * (B**2 + H**2) / 12
PUSH, TIME = 0.2, 0.4  # rad/s, s
PLACES = (np.arange(400) + 0.5) * B / 400 - B / 2


def rates(state):
    """Rates of the height of the centroid, the angle, and their rates."""
    y, th, yd, thd = state
    c, s, h = np.cos(th), np.sin(th), H / 2
    force = KN * B / len(PLACES) * np.maximum(h * c - y - PLACES * s, 0.0)
    moment = (force * (PLACES * c + h * s)).sum() + MASS * h * h * s * c * thd**2
    return np.array([yd, thd, force.sum() / MASS - GRAVITY, moment / (INERTIA + MASS * (h * c) ** 2)])


def rock(dt=5e-5):
    """Times and angles of the block on its bed of springs."""
    state, found = np.array([H / 2 - MASS * GRAVITY / (KN * B), 0.0, 0.0, PUSH]), []
    for _ in range(round(TIME / dt)):
        found.append(state[1])
        a = rates(state)
        b = rates(state + dt / 2 * a)
        c = rates(state + dt / 2 * b)
        state = state + dt / 6 * (a + 2 * b + 2 * c + rates(state + dt * c))
    return np.arange(len(found)) * dt, np.array(found)


def crossings(t, th):
    """Times at which the angle is 0 again."""
    i = np.flatnonzero(th[1:-1] * th[2:] < 0) + 1
    return t[i] - th[i] * (t[i + 1] - t[i]) / (th[i + 1] - th[i])


def solve(case):
    m = case.model()
    m.property(1, density=DENSITY)
    m.jproperty(1, kn=KN, ks=KS, friction=5.0, between=(1, 1))
    m.gravity(0, -GRAVITY)
    on_base(case, m, B, H, width=3)
    m.round(D)
    m.damping(local=0.8)
    m.fraction(0.05)
    m.solve(1e-10, 50_000)
    m.damping(0, 1)
    blocks = m.table("block")
    address = int(blocks["address"][blocks["KBFIX"] == 0][0])
    push(m, address, KXD=-PUSH * H / 2, KTD=PUSH)
    contacts, joints = m.table("contact")["address"], m.table("joint")["address"]
    forces, closures, rate = [], [], []
    begin = now(m)
    while now(m) - begin < TIME:
        m.cycle(1)
        forces.append(getr(m.h, contacts, g.KCFN))
        closures.append(getr(m.h, contacts, g.KCN) + getr(m.h, joints, g.KCJOFF))
        rate.append(float(getr(m.h, address, g.KTD)))
    th = np.cumsum(rate) * step(m)
    t = np.arange(1, len(th) + 1) * step(m)
    exact_t, exact = rock()
    top = float(np.abs(exact).max())
    closed = sqrt(2 * MASS * GRAVITY / (KN * top))
    friction = MASS * H / 2 * MASS * GRAVITY * B / 2 / (INERTIA + MASS * H**2 / 4)
    shares = {
        "stress beyond the contacts, (D/a)^2": (D / closed) ** 2,
        "base, sideways": friction / (KS * closed) / (top * H / 2),
    }
    within = {why: share * top for why, share in shares.items()}
    yield Answer("greatest angle", "rad", float(np.abs(th).max()), top, within | {"a step": PUSH * step(m)})
    for k, (computed, back) in enumerate(zip(crossings(t, th), crossings(exact_t, exact), strict=True), 1):
        within = {why: share * back for why, share in shares.items()}
        yield Answer(f"upright again, {k}", "s", float(computed), float(back), within | {"a step": step(m)})
    steps = np.abs(np.diff(forces, axis=0)).max(axis=1)
    u = np.max(closures, axis=1)[:-1]
    largest = float((steps / (4 * D * KN * u)).max())
    yield Answer("greatest step of a force over 4 D kn u", "", largest, 0.0, {"length 4 D": 1.0})
    case.graph(
        "time (s)",
        "angle (degrees)",
        {"bed of springs": (exact_t, np.degrees(exact))},
        [(t[::40], np.degrees(th[::40]))],
    )
