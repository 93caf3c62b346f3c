"""The yardstick of the speed measurements: the cycle of the program over a structure of arrays.

Blocks, corners, contacts and domain loops are taken out of the heap once, every field into an array of
its own, every address turned into a row number. The loops below then do the arithmetic of MOTION, PVEL,
ACCUM and FORD as one would write them for such arrays, compiled with the program's own flags. They know
nothing of lists and cannot change the map: where the program would re-classify, make or break a contact,
they count an event, and a comparison with events is void.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from numba import njit

from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.contact.map_changes import TURNED
from udec_ia.layout import offsets as g
from udec_ia.reader.group_tables import table
from udec_ia.reader.list_walks import loop

# Flags of the program's kernels; no counting of references to arrays, which its kernels do not have either.
F = TypeVar("F", bound=Callable[..., Any])
compiled = cast(Callable[[F], F], njit(error_model="numpy", _nrt=False, forceinline=True))

NONE = 0xFFFFFFFF  # row number that stands for nothing
UPEND, ULOOK, WORK, EVENTS = 0, 1, 2, 3  # numbers that outlive a cycle, in Slab.sums


class Constants(NamedTuple):
    """Scalars of the common block; `border` is DTOL - GTOL."""

    border: float
    dt: float
    con1: float
    con2: float
    gx: float
    gy: float
    beta: float
    dtol: float
    gtol: float
    btol: float
    ftol: float
    dtol2: float
    etol: float
    htol: float


class Blocks(NamedTuple):
    """One row a block; `first` has a row more: the block's corners are first[i] to first[i + 1]."""

    fixed: Any
    first: Any
    x: Any
    y: Any
    xd: Any
    yd: Any
    td: Any
    m: Any
    i: Any
    fx: Any
    fy: Any
    ft: Any
    reach: Any


class Corners(NamedTuple):
    """One row a corner; `before` is the row of the corner where its edge starts."""

    before: Any
    x: Any
    y: Any
    xc: Any
    yc: Any
    rad: Any
    xd: Any
    yd: Any


class Contacts(NamedTuple):
    """One row a contact. The six rows of `near`, where there are such contacts, NONE where not:

    the next and the previous contact on `b1` if they are with `b2` as well; the next and the previous
    contact on the same segment of `b1`; and of `b2`.
    """

    b1: Any
    b2: Any
    p1: Any
    p2: Any
    near: Any
    code: Any
    mat: Any
    x: Any
    y: Any
    xd: Any
    yd: Any
    us: Any
    un: Any
    fs: Any
    fn: Any
    waiting: Any  # room for the rows of those that get their forces after all others


class Domains(NamedTuple):
    """One row a domain: its corners are corner[c[i]] to corner[c[i + 1]], its contacts likewise."""

    umax: Any
    c: Any
    corner: Any
    k: Any
    contact: Any


class Slab(NamedTuple):
    """A whole model. kn, ks, mu, coh: one value a material. sums: see UPEND, ULOOK, WORK, EVENTS."""

    constants: Constants
    blocks: Blocks
    corners: Corners
    contacts: Contacts
    domains: Domains
    kn: Any
    ks: Any
    mu: Any
    coh: Any
    sums: Any


def _rows(addresses: Any, wanted: Any) -> Any:
    """Row numbers of the groups at the addresses `wanted`; NONE where there is no such group."""
    order = np.argsort(addresses)
    place = np.minimum(np.searchsorted(addresses, wanted, sorter=order), len(order) - 1)
    row = order[place]
    return np.where(addresses[row] == wanted, row, NONE).astype(np.uint32)


def _columns(rows: Any, names: str) -> list[Any]:
    return [np.ascontiguousarray(rows[name]) for name in names.split()]


def extract(array: MainArray) -> Slab:
    """The structure of arrays for the model in `array`, rows in the order of the program's lists."""
    cr = array.h.cr
    b, p, k, d = (table(array, kind) for kind in ("block", "corner", "contact", "domain"))
    first = np.searchsorted(_rows(b["address"], p["KNB"]), np.arange(len(b) + 1)).astype(np.uint32)
    blocks = Blocks(
        b["KBFIX"].astype(np.uint8),
        first,
        *_columns(b, "KX KY KXD KYD KTD KBM KBI KBFX KBFY KBFT KBRO"),
    )
    corners = Corners(_rows(p["address"], p["KR"]), *_columns(p, "KXP KYP KXCP KYCP KRAD KXDP KYDP"))
    contacts = Contacts(
        _rows(b["address"], k["KB1"]),
        _rows(b["address"], k["KB2"]),
        _rows(p["address"], k["KCP1"]),
        _rows(p["address"], k["KCP2"]),
        _near(k),
        k["KCCOD"].astype(np.uint8),
        (k["KCM"] - 1).astype(np.uint8),
        *_columns(k, "KXC KYC KXDC KYDC KCS KCN KCFS KCFN"),
        np.empty(len(k), np.int64),
    )
    names = (
        g.TDEL,
        g.CON1,
        g.CON2,
        g.GRAVX,
        g.GRAVY,
        g.BETA,
        g.DTOL,
        g.GTOL,
        g.BTOL,
        g.FTOL,
        g.DTOL2,
        g.ETOL,
        g.HTOL,
    )
    constants = Constants(float(cr[g.DTOL] - cr[g.GTOL]), *(float(cr[i]) for i in names))
    kn, ks, mu, coh = (cr[i : i + 50].copy() for i in (g.AKN, g.AKS, g.AMU, g.COH))
    domains = _domains(array, d, p["address"], k["address"])
    sums = np.array([cr[g.UPEND], cr[g.ULOOK], array.h.cd[g.WFRIC], 0.0])
    return Slab(constants, blocks, corners, contacts, domains, kn, ks, mu, coh, sums)


def _near(k: Any) -> Any:
    """The rows of `near` for all contacts, which must be real ones."""
    columns = []
    sides = [(1, "KL1"), (1, "KLB1"), (1, "KL1"), (1, "KLB1"), (2, "KL2"), (2, "KLB2")]
    for n, (side, link) in enumerate(sides):
        row = _rows(k["address"], k[link])
        one, two = (_side(k[np.where(row == NONE, 0, row)], k[f"KB{side}"]), _side(k, k[f"KB{side}"]))
        if n < 2:  # twins: the other block is the same, and the contact is no bridge of the map
            same = (one[0] == two[0]) & (k["KD1"] != k["KD2"])
        else:
            same = (one[1] == two[1]) & (one[2] == two[2])
        columns.append(np.where(same, row, NONE))
    return np.stack(columns, axis=1).astype(np.uint32)


def _side(k: Any, block: Any) -> tuple[Any, Any, Any]:
    """For contacts that stand on `block`: the other block, the corner on `block`, True for its arc."""
    first = k["KB1"] == block
    arc = (k["KCCOD"] == 1) | (k["KCCOD"] == np.where(first, 2, 3))
    return np.where(first, k["KB2"], k["KB1"]), np.where(first, k["KCP1"], k["KCP2"]), arc


def _domains(array: MainArray, rows: Any, corners: Any, contacts: Any) -> Domains:
    """The loops of all domains, corners and contacts apart."""
    lengths, items = [0], []
    for idm in rows["address"]:
        items += [item for item, _ in loop(array.h, int(idm))]
        lengths.append(len(items))
    found = np.array(items)
    owner = np.repeat(np.arange(len(rows)), np.diff(lengths))
    parts = []
    for addresses in (corners, contacts):
        row = _rows(addresses, found)
        mine = row != NONE
        parts += [np.searchsorted(owner[mine], np.arange(len(rows) + 1)).astype(np.uint32), row[mine]]
    return Domains(rows["KUMAX"].copy(), *parts)


@compiled
def move(b: Blocks, p: Corners, c: Constants) -> float:
    """Law of motion and new corners; returns the greatest velocity bound."""
    fastest = 0.0
    for i in range(len(b.x)):
        fx, fy, ft = b.fx[i], b.fy[i], b.ft[i]
        b.fx[i] = b.fy[i] = b.ft[i] = 0.0
        if b.fixed[i]:
            continue
        x, y = b.x[i], b.y[i]
        xd = (c.con1 * b.xd[i] + (fx / b.m[i] + c.gx) * c.dt) * c.con2
        yd = (c.con1 * b.yd[i] + (fy / b.m[i] + c.gy) * c.dt) * c.con2
        td = (c.con1 * b.td[i] + ft / b.i[i] * c.dt) * c.con2
        xn, yn = x + xd * c.dt, y + yd * c.dt
        b.xd[i], b.yd[i], b.td[i], b.x[i], b.y[i] = xd, yd, td, xn, yn
        half = td * c.dt * 0.5
        below = 1.0 + half * half
        co, si = (1.0 - half * half) / below, (half + half) / below
        for j in range(b.first[i], b.first[i + 1]):
            rx, ry = p.x[j] - x, p.y[j] - y
            nx, ny = co * rx - si * ry, si * rx + co * ry
            p.x[j], p.y[j] = xn + nx, yn + ny
            p.xd[j], p.yd[j] = xd - td * ny, yd + td * nx
            rx, ry = p.xc[j] - x, p.yc[j] - y
            p.xc[j], p.yc[j] = xn + (co * rx - si * ry), yn + (si * rx + co * ry)
        fastest = max(fastest, max(abs(xd), abs(yd)) + abs(td) * b.reach[i])
    return fastest


@compiled
def accumulate(s: Slab, fastest: float) -> None:
    """Fictitious displacements of the domains, when they cannot wait; an event if one needs an update."""
    b, p, k, d, c = s.blocks, s.corners, s.contacts, s.domains, s.constants
    bound = (fastest + fastest) * c.dt
    waiting, greatest = s.sums[UPEND], 0.0
    if s.sums[ULOOK] >= c.htol:
        s.sums[ULOOK] = 0.0
    if waiting + bound < c.htol:
        s.sums[UPEND] = waiting + bound
        return
    for i in range(len(d.umax)):
        lx, ly, hx, hy = np.inf, np.inf, -np.inf, -np.inf
        for n in range(d.c[i], d.c[i + 1]):
            j = d.corner[n]
            vx, vy = p.xd[j], p.yd[j]
            lx, ly, hx, hy = min(lx, vx), min(ly, vy), max(hx, vx), max(hy, vy)
        for n in range(d.k[i], d.k[i + 1]):
            j = d.contact[n]
            for ib in (k.b1[j], k.b2[j]):
                vx = b.xd[ib] - b.td[ib] * (k.y[j] - b.y[ib])
                vy = b.yd[ib] + b.td[ib] * (k.x[j] - b.x[ib])
                lx, ly, hx, hy = min(lx, vx), min(ly, vy), max(hx, vx), max(hy, vy)
        moved = max(hx - lx, hy - ly) * c.dt
        d.umax[i] += waiting + moved
        greatest = max(greatest, moved)
        if d.umax[i] + moved > c.etol or moved > c.etol + c.etol:
            s.sums[EVENTS] += 1
    s.sums[ULOOK] += waiting + greatest
    s.sums[UPEND] = 0.0


@compiled
def over_ends(mx: float, my: float, r: float, d: float, x: float, y: float) -> float:
    """How far (x, y) leans over either end of an arc whose centre lies at (mx, my) from its corner."""
    mm = mx * mx + my * my
    along, across = d * (x * mx + y * my), r * (x * my - y * mx)
    return max((along - across) / mm, (along + across) / mm)


@compiled
def corner_corner(p: Corners, i: int, j: int, c: Constants) -> tuple[float, float, float, float, bool]:
    """Normal, overlap, distance of the contact point from the centre of `i`; False if it must change."""
    dx, dy = p.xc[j] - p.xc[i], p.yc[j] - p.yc[i]
    one = over_ends(p.xc[i] - p.x[i], p.yc[i] - p.y[i], p.rad[i], c.dtol, dx, dy)
    two = over_ends(p.xc[j] - p.x[j], p.yc[j] - p.y[j], p.rad[j], c.dtol, -dx, -dy)
    z = np.sqrt(dx * dx + dy * dy)
    overlap = p.rad[i] + p.rad[j] - z
    return dx / z, dy / z, overlap, p.rad[i] - overlap * 0.5, max(one, two) <= c.gtol


@compiled
def corner_edge(p: Corners, i: int, j: int, c: Constants) -> tuple[float, float, float, float, bool]:
    """As corner_corner, for corner `i` on the edge that ends at `j`."""
    a = p.before[j]
    dx, dy = p.x[j] - p.x[a], p.y[j] - p.y[a]
    z = np.sqrt(dx * dx + dy * dy)
    ex, ey = dx / z, dy / z
    x, y = p.xc[i] - p.x[a], p.yc[i] - p.y[a]
    overlap = p.rad[i] - (y * ex - x * ey)
    along = x * ex + y * ey
    fits = along >= c.border and z - along >= c.border
    return ey, -ex, overlap, p.rad[i] - overlap * 0.5, fits


@compiled
def touch(p: Corners, k: Contacts, j: int, c: Constants) -> tuple[float, float, float, bool]:
    """New coordinates and overlap of contact `j`; its normal, the overlap before, False for an event."""
    before = k.un[j]
    ip, iq = k.p1[j], k.p2[j]
    if k.code[j] == 1:
        nx, ny, overlap, reach, fits = corner_corner(p, ip, iq, c)
        k.x[j], k.y[j] = p.xc[ip] + nx * reach, p.yc[ip] + ny * reach
    elif k.code[j] == 2:
        nx, ny, overlap, reach, fits = corner_edge(p, ip, iq, c)
        k.x[j], k.y[j] = p.xc[ip] + nx * reach, p.yc[ip] + ny * reach
    else:
        mx, my, overlap, reach, fits = corner_edge(p, iq, ip, c)
        nx, ny = -mx, -my
        k.x[j], k.y[j] = p.xc[iq] + mx * reach, p.yc[iq] + my * reach
    k.un[j] = overlap
    return nx, ny, before, fits and -c.btol <= overlap <= c.dtol2


@compiled
def faces(p: Corners, i: int, c: Constants, nx: float, ny: float) -> bool:
    """False if the arc of corner `i` has turned away from the edge that its normal (nx, ny) points to."""
    mx, my = p.xc[i] - p.x[i], p.yc[i] - p.y[i]
    mm = mx * mx + my * my
    along, across = c.dtol * (nx * mx + ny * my), p.rad[i] * (nx * my - ny * mx)
    ahead, behind = (along - across) / mm, (along + across) / mm
    return max(ahead, behind) <= TURNED and min(ahead, behind) <= 0.0


@compiled
def foot(p: Corners, ip: int, x: float, y: float) -> tuple[float, float]:
    """Where the arc of corner `ip` is nearest to the point (x, y) outside it; a point inside stays."""
    dx, dy = x - p.xc[ip], y - p.yc[ip]
    z = np.sqrt(dx * dx + dy * dy)
    if z <= p.rad[ip]:
        return x, y
    return p.xc[ip] + dx / z * p.rad[ip], p.yc[ip] + dy / z * p.rad[ip]


@compiled
def ahead_by(p: Corners, k: Contacts, j: int, ip: int, arc: bool, i: int) -> float:
    """How far contact `i` lies ahead of contact `j` on a segment of corner `ip`."""
    ax, ay, bx, by = k.x[j], k.y[j], k.x[i], k.y[i]
    if arc:
        ax, ay = foot(p, ip, ax, ay)
        bx, by = foot(p, ip, bx, by)
        tx, ty = p.y[ip] - p.yc[ip], p.xc[ip] - p.x[ip]
    else:
        a = p.before[ip]
        tx, ty = p.x[ip] - p.x[a], p.y[ip] - p.y[a]
    return ((bx - ax) * tx + (by - ay) * ty) / np.sqrt(tx * tx + ty * ty)


@compiled
def in_place(s: Slab, j: int, nx: float, ny: float) -> bool:
    """False if open contact `j` would be given up: turned away, or overtaken by a neighbour."""
    p, k, c = s.corners, s.contacts, s.constants
    code = k.code[j]
    if code == 2 and not faces(p, k.p1[j], c, nx, ny):
        return False
    if code == 3 and not faces(p, k.p2[j], c, -nx, -ny):
        return False
    most = c.ftol - k.un[j]
    for n in range(2, 6):
        i = k.near[j, n]
        if i != NONE:
            side = n // 4
            ip, arc = (k.p1[j], code != 3) if side == 0 else (k.p2[j], code != 2)
            ahead = ahead_by(p, k, j, ip, arc, i)
            if (ahead if n % 2 == 1 else -ahead) > most:
                return False
    return True


@compiled
def has_twin(k: Contacts, j: int, c: Constants) -> bool:
    """True if a neighbour between the same two blocks is nearer than FTOL."""
    for n in range(2):
        i = k.near[j, n]
        if i != NONE:
            dx, dy = k.x[i] - k.x[j], k.y[i] - k.y[j]
            if dx * dx + dy * dy < c.ftol * c.ftol:
                return True
    return False


@compiled
def stays(s: Slab, j: int, nx: float, ny: float) -> bool:
    """False if contact `j` carries no force and would be given up."""
    k, c = s.contacts, s.constants
    overlap = k.un[j]
    if overlap > 0.0 and k.fn[j] != 0.0:
        return True
    if overlap > 0.0 and s.sums[ULOOK] >= c.htol:
        return not has_twin(k, j, c)
    if s.sums[ULOOK] < c.htol:
        return True
    return in_place(s, j, nx, ny) and not has_twin(k, j, c)


@compiled
def waits(s: Slab, j: int) -> bool:
    """True if contact `j` gets its force after the others: it looks at its neighbours before."""
    k, c = s.contacts, s.constants
    idle = k.un[j] <= 0.0 or k.fn[j] == 0.0
    return k.un[j] > c.ftol or (idle and s.sums[ULOOK] >= c.htol)


@compiled
def force(s: Slab, j: int, nx: float, ny: float, before: float) -> None:
    """Relative velocity, spring forces and friction of contact `j`, and force sums of its blocks."""
    b, k, c = s.blocks, s.contacts, s.constants
    ib, jb, x, y, overlap = k.b1[j], k.b2[j], k.x[j], k.y[j], k.un[j]
    xi, yi, xj, yj = x - b.x[ib], y - b.y[ib], x - b.x[jb], y - b.y[jb]
    xd = (b.xd[jb] - b.td[jb] * yj) - (b.xd[ib] - b.td[ib] * yi)
    yd = (b.yd[jb] + b.td[jb] * xj) - (b.yd[ib] + b.td[ib] * xi)
    k.xd[j], k.yd[j] = xd, yd
    if overlap <= 0.0:
        k.fn[j] = k.fs[j] = k.us[j] = 0.0
        return
    m = k.mat[j]
    kn, ks = s.kn[m], s.ks[m]
    closing, sliding = -(xd * nx + yd * ny), yd * nx - xd * ny
    held, dus = k.fs[j], sliding * c.dt
    fn, fs = k.fn[j] + kn * (overlap - max(before, 0.0)), held + ks * dus
    k.us[j] += dus
    if fn <= 0.0:
        fn, fs = 0.0, 0.0
    most = s.coh[m] + s.mu[m] * fn
    dashpot = c.beta * ks * sliding
    if abs(fs) > most:
        s.sums[WORK] += (abs(fs) - most) / ks * (most + (held if fs > 0.0 else -held)) * 0.5
        fs = most if fs > 0.0 else -most
        dashpot = 0.0
    k.fn[j], k.fs[j] = fn, fs
    normal, shear = fn + c.beta * kn * closing, fs + dashpot
    fx, fy = nx * normal + ny * shear, ny * normal - nx * shear
    b.fx[ib] -= fx
    b.fy[ib] -= fy
    b.ft[ib] -= xi * fy - yi * fx
    b.fx[jb] += fx
    b.fy[jb] += fy
    b.ft[jb] += xj * fy - yj * fx


@compiled
def forces(s: Slab) -> None:
    """All contacts: geometry and force; those that wait, when all others have theirs."""
    p, k, c = s.corners, s.contacts, s.constants
    n = 0
    for j in range(len(k.x)):
        nx, ny, before, fits = touch(p, k, j, c)
        if not fits:
            s.sums[EVENTS] += 1
        if waits(s, j):
            k.un[j] = before
            k.waiting[n] = j
            n += 1
        else:
            force(s, j, nx, ny, before)
    for i in range(n):
        j = k.waiting[i]
        nx, ny, before, _ = touch(p, k, j, c)
        if not stays(s, j, nx, ny):
            s.sums[EVENTS] += 1
        force(s, j, nx, ny, before)


@compiled
def run_soa(s: Slab, n: int) -> None:
    """`n` cycles: motion, corners, domains, contacts."""
    for _ in range(n):
        accumulate(s, move(s.blocks, s.corners, s.constants))
        forces(s)
