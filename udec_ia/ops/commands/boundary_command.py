"""BOUNDARY: boundary conditions (kernels.body.boundary_conditions).

Velocities and forces act on the grid-points of fully-deformable blocks that lie in the range, and on rigid
and simply-deformable blocks whose centroids do. Stresses and viscous resistance act on edges that have both
ends in the range. Tension is positive. A stress S(x, y) = S0 + x SX + y SY on an edge from a to b with the
outward normal n and the length L gives the tractions t = S n at its ends, and there, on the corners or their
grid-points, the forces L (2 ta + tb)/6 and L (ta + 2 tb)/6: their resultant and their moment are those of t.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.geometry.range_selection import edges_between, points_between
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.block_ranges import Range, check_range, why_nothing
from udec_ia.ops.common.groups_of_blocks import HOSTED, drop
from udec_ia.ops.common.number_limits import finite, held, not_negative, positive, reals, whole
from udec_ia.reader.list_walks import chain

Triple = tuple[float, float, float]  # components 11, 12, 22
Target = tuple[int, int, int, int]  # as KUB, KUG, KUP and KUQ of a condition
ZERO: Triple = (0.0, 0.0, 0.0)
ALL: Range = (-math.inf, math.inf, -math.inf, math.inf)


@dataclass
class Load:
    """What one target gets: a force, and viscous resistance xx, xy, yy."""

    fx: float = 0.0
    fy: float = 0.0
    cxx: float = 0.0
    cxy: float = 0.0
    cyy: float = 0.0

    def add(self, fx: float, fy: float, c: Triple = ZERO) -> None:
        self.fx += fx
        self.fy += fy
        self.cxx += c[0]
        self.cxy += c[1]
        self.cyy += c[2]


def boundary(
    array: MainArray,
    x1: float,
    x2: float,
    y1: float,
    y2: float,
    *,
    xvel: float | None = None,
    yvel: float | None = None,
    xforce: float = 0.0,
    yforce: float = 0.0,
    stress: Triple = ZERO,
    xgrad: Triple = ZERO,
    ygrad: Triple = ZERO,
    viscous: bool = False,
    sine: tuple[float, float] | None = None,
    function: int | None = None,
    free: bool = False,
) -> int:
    """BOUNDARY: set conditions in the range, or with `free` take all away. Returns their number.

    xvel, yvel: given velocities, m/s. xforce, yforce: N/m on each grid-point or block. stress, with xgrad and
    ygrad its growth per metre: 11, 12, 22. viscous: non-reflecting edges. sine: frequency (Hz) and how long
    it lasts (s), from now on, or function: number of a FUNCTION; loads and velocities are multiplied by it.
    Errors 24, 26, 28.
    """
    where = x1, x2, y1, y2
    stress, xgrad, ygrad = reals(3, stress=stress), reals(3, xgrad=xgrad), reals(3, ygrad=ygrad)
    sine = None if sine is None else reals(2, sine=sine)
    check_range(array, where)
    finite(array, xvel=xvel or 0.0, yvel=yvel or 0.0, xforce=xforce, yforce=yforce)
    for name, triple in (("stress", stress), ("xgrad", xgrad), ("ygrad", ygrad)):
        for component in triple:
            finite(array, **{name: component})
    if sine is not None:
        positive(array, sine=sine[0])
        not_negative(array, sine=sine[1])
    moves = xvel is not None or yvel is not None or bool(xforce or yforce)
    presses = viscous or any((*stress, *xgrad, *ygrad))
    _check_asked(moves or presses, sine is not None, function is not None, free)
    if free:
        return _set_free(array.h, where)
    fix = g.ALONG_X * (xvel is not None) + g.ALONG_Y * (yvel is not None)
    pressure = (stress, xgrad, ygrad) if presses else None
    loads = _loads(array.h, where, (xforce, yforce) if moves else None, pressure, viscous)
    _check_free(array.h, [target[0] for target in loads if target[2] == 0], xvel=xvel, yvel=yvel)
    held(array, "a force or an impedance", (value for load in loads.values() for value in astuple(load)))
    signal = find_function(array.h, function) if function is not None else 0
    if function is not None and not signal:
        advice = f"define it first: FUNCTION {function} t1 f1 t2 f2 ..."
        raise UdecError(26, f"FUNCTION {function}", advice)
    h = array.h
    require(array, len(loads) * size_of(h, g.NVBN) + size_of(h, g.NVSG))
    if sine is not None:
        signal = make_sine(h, *sine)
    if fix:
        _release(h, {target[:2] for target in loads if target[2] == 0}, fix)
    for target, load in loads.items():
        _make(h, target, load, fix if target[2] == 0 else 0, (xvel or 0.0, yvel or 0.0), signal)
    return len(loads)


def _loads(
    h: Memory, where: Range, force: tuple[float, float] | None, stress: Sequence[Triple] | None, viscous: bool
) -> dict[Target, Load]:
    """What targets in the range get: points if `force` is given, edges if `stress` is. Error 24 if none."""
    loads: dict[Target, Load] = {}
    if force is not None:
        for ib, ig in points_between(h, *map(float, where)).tolist():
            loads.setdefault((ib, ig, 0, 0), Load()).add(*force)
    if stress is not None:
        for ib, ip in edges_between(h, *map(float, where)).tolist():
            _load_edge(h, ib, ip, stress, viscous, loads)
    if not loads:
        advice = "what lies on the limits of a range is outside it"
        raise UdecError(24, _why_nothing(h, where, force is not None), advice, parameter="x1")
    return loads


def _check_asked(condition: bool, sine: bool, function: bool, free: bool) -> None:
    """Error 26 if no condition is given, 10 if those that are given cannot stand together."""
    if free and (condition or sine or function):
        raise UdecError(
            10, "FREE stands alone", "give other conditions on a line of their own", parameter="free"
        )
    if sine and function:
        advice = "a condition follows a sine or a function, not both"
        raise UdecError(10, "FUNCTION beside SINE", advice, parameter="function")
    if not (condition or free):
        raise UdecError(26, "no velocity, and no force or stress other than 0", "BOUNDARY 0 9 0 1 YVEL=0")


def _check_free(h: Memory, blocks: Iterable[int], **velocity: float | None) -> None:
    """Error 28 if a fixed block or its grid-points are to move."""
    moving = next((name for name, v in velocity.items() if v), None)
    fixed = next((ib for ib in blocks if moving and iget(h, ib, g.KBFIX) == g.FIXED), None)
    if fixed is not None:
        x, y = float(getr(h, fixed, g.KX)), float(getr(h, fixed, g.KY))
        advice = f"FREE a range with its centroid ({x:g}, {y:g}) first; the velocity then holds the block"
        raise UdecError(28, f"block@{fixed} is fixed and would not move", advice, parameter=moving or "")


def _inside(where: Range, x: float, y: float) -> bool:
    return where[0] < x < where[1] and where[2] < y < where[3]


def _why_nothing(h: Memory, where: Range, moves: bool) -> str:
    """Why there is nothing in the range that `moves`, or else no edge."""
    if moves:
        points = (_named(h, ib, ig) for ib, ig in points_between(h, *ALL).tolist())
        return why_nothing(where, "grid-point and no centroid", points)
    edges = (
        (f"block@{ib}'s", (_corner(h, iget(h, ip, g.KR)), _corner(h, ip)))
        for ib, ip in edges_between(h, *ALL).tolist()
    )
    return why_nothing(where, "edge with both ends", edges)


def _named(h: Memory, ib: int, ig: int) -> tuple[str, tuple[tuple[float, float], ...]]:
    """Name and place of grid-point `ig` of block `ib`, or of the block if it is 0."""
    if ig:
        return f"gridpoint@{ig} of block@{ib}", ((float(getr(h, ig, g.KXG)), float(getr(h, ig, g.KYG))),)
    return f"block@{ib}", ((float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))),)


def _corner(h: Memory, ip: int) -> tuple[float, float]:
    return float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP))


def _load_edge(
    h: Memory, ib: int, ip: int, stress: Sequence[Triple], viscous: bool, loads: dict[Target, Load]
) -> None:
    """Add what stress and viscous resistance on one edge give to the targets of the edge."""
    ia = iget(h, ip, g.KR)
    (ax, ay), (bx, by) = _corner(h, ia), _corner(h, ip)
    length = math.hypot(bx - ax, by - ay)
    nx, ny = -(by - ay) / length, (bx - ax) / length  # outwards: to the left of a clockwise edge

    def traction(x: float, y: float) -> tuple[float, float]:
        s11, s12, s22 = (s + x * sx + y * sy for s, sx, sy in zip(*stress, strict=True))
        return s11 * nx + s12 * ny, s12 * nx + s22 * ny

    (tax, tay), (tbx, tby) = traction(ax, ay), traction(bx, by)
    cn, cs = _impedances(h, ib) if viscous else (0.0, 0.0)
    c = (cn * nx * nx + cs * ny * ny, (cn - cs) * nx * ny, cn * ny * ny + cs * nx * nx)
    half = (c[0] * length / 2, c[1] * length / 2, c[2] * length / 2)
    start, end = (loads.setdefault(_corner_target(h, ib, i, j), Load()) for i, j in ((ia, ip), (ip, ia)))
    start.add(length * (2 * tax + tbx) / 6, length * (2 * tay + tby) / 6, half)
    end.add(length * (tax + 2 * tbx) / 6, length * (tay + 2 * tby) / 6, half)


def _corner_target(h: Memory, ib: int, ip: int, iq: int) -> Target:
    """Where a load on the edge from corner `ip` to `iq` acts at `ip`: at its grid-point, if there is one."""
    ig = iget(h, ip, g.KGP)
    return (ib, ig, 0, 0) if ig else (ib, 0, ip, iq)


def _impedances(h: Memory, ib: int) -> tuple[float, float]:
    """rho Cp and rho Cs of the material of block `ib`. Error 26 without density and moduli."""
    m = iget(h, ib, g.KMAT)
    rho, one, two = (float(h.cr[k + m - 1]) for k in (g.DENS, g.ALAM1, g.ALAM2))
    if not (rho > 0 and one > 0 and one > two):
        detail = f"density, BULK and G of material {m} for a viscous edge"
        raise UdecError(26, detail, f"PROPERTY MATERIAL={m} DENSITY=... BULK=... G=...")
    return math.sqrt(rho * one), math.sqrt(rho * (one - two) / 2)


def _make(
    h: Memory, target: Target, load: Load, fix: int, velocity: tuple[float, float], signal: int
) -> None:
    """A condition at the head of the list."""
    ib, ig, ip, iq = target
    iu = int(find(h, g.NVBN))
    puti(h, iu, HEAD, g.MBND)
    where = ((g.KUB, ib), (g.KUG, ig), (g.KUP, ip), (g.KUQ, iq))
    for k, n in ((g.KU, int(h.ci[g.IBNPNT])), *where, (g.KUS, signal), (g.KUFIX, fix)):
        puti(h, iu, k, n)
    reals = (
        (g.KUFX, load.fx),
        (g.KUFY, load.fy),
        (g.KUCXX, load.cxx),
        (g.KUCXY, load.cxy),
        (g.KUCYY, load.cyy),
    )
    for kr, value in (*reals, (g.KUVX, velocity[0]), (g.KUVY, velocity[1])):
        putr(h, iu, kr, value)
    h.ci[g.IBNPNT] = iu
    if fix and ig:
        puti(h, ig, g.KGFIX, iget(h, ig, g.KGFIX) | fix)
    elif fix and iget(h, ib, g.KBFIX) != g.FIXED:
        puti(h, ib, g.KBFIX, iget(h, ib, g.KBFIX) | _of_block(fix))


def _of_block(fix: int) -> int:
    """The codes of KBFIX for the velocities `fix` that a condition on a block gives (KUFIX)."""
    return (g.GIVEN_X if fix & g.ALONG_X else 0) | (g.GIVEN_Y if fix & g.ALONG_Y else 0)


def _release(h: Memory, points: set[tuple[int, int]], fix: int) -> None:
    """Earlier conditions no longer give the velocities `fix` of the points; those left with nothing go.

    points: blocks and grid-points, as KUB and KUG.
    """
    bounds = _all(h)
    gives = bounds[integers(h, bounds, g.KUFIX) & fix != 0]
    left = [iu for iu in gives.tolist() if (iget(h, iu, g.KUB), iget(h, iu, g.KUG)) in points]
    for iu in left:
        puti(h, iu, g.KUFIX, iget(h, iu, g.KUFIX) & ~fix)
    loads = (g.KUFX, g.KUFY, g.KUCXX, g.KUCXY, g.KUCYY)
    _drop(h, [iu for iu in left if iget(h, iu, g.KUFIX) == 0 and not any(getr(h, iu, k) for k in loads)])


def _all(h: Memory) -> Any:
    """Addresses of all conditions, in the order of their list."""
    return addresses(h, int(h.ci[g.IBNPNT]), g.KU)


def number_of_conditions(h: Memory) -> int:
    """How many boundary conditions there are."""
    return len(_all(h))


def _drop(h: Memory, gone: list[int]) -> None:
    """Give the conditions `gone` back, and the sines that no other needs."""
    signals = {iget(h, iu, g.KUS) for iu in gone} - {0}
    drop(h, HOSTED["bound"], gone)
    if signals:
        lose_sines(h, signals.difference(integers(h, _all(h), g.KUS).tolist()))


def given_velocities(h: Memory) -> dict[int, int]:
    """KBFIX of the blocks, if they are not fixed, whose velocities conditions give: which of them."""
    bounds = _all(h)
    fix: dict[int, int] = {}
    for iu in bounds[(integers(h, bounds, g.KUFIX) != 0) & (integers(h, bounds, g.KUG) == 0)].tolist():
        ib = iget(h, iu, g.KUB)
        fix[ib] = fix.get(ib, 0) | _of_block(iget(h, iu, g.KUFIX))
    return fix


def forget_blocks(h: Memory, blocks: Iterable[int]) -> None:
    """Take away all conditions on `blocks`, which are about to go or to change."""
    bounds = _all(h)
    _free(h, bounds[np.isin(integers(h, bounds, g.KUB), list(blocks))].tolist())


def _free(h: Memory, gone: list[int]) -> None:
    """Take the conditions `gone` away and set free what they held."""
    for iu in gone:
        ib, ig = iget(h, iu, g.KUB), iget(h, iu, g.KUG)
        if ig:
            puti(h, ig, g.KGFIX, iget(h, ig, g.KGFIX) & ~iget(h, iu, g.KUFIX))
        elif iget(h, ib, g.KBFIX) != g.FIXED:
            puti(h, ib, g.KBFIX, iget(h, ib, g.KBFIX) & ~_of_block(iget(h, iu, g.KUFIX)))
    _drop(h, gone)


def _set_free(h: Memory, where: Range) -> int:
    """Take away the conditions in the range; returns their number."""
    points = set(map(tuple, points_between(h, *map(float, where)).tolist()))
    gone = [
        iu
        for iu in _all(h).tolist()
        if (iget(h, iu, g.KUP) == 0 and (iget(h, iu, g.KUB), iget(h, iu, g.KUG)) in points)
        or (iget(h, iu, g.KUP) and _inside(where, *_corner(h, iget(h, iu, g.KUP))))
    ]
    _free(h, gone)
    return len(gone)


# ---- FUNCTION, and the sines of BOUNDARY: the signals that boundary conditions follow in time


def make_sine(h: Memory, frequency: float, lasts: float) -> int:
    """A signal that is a sine of the given frequency for a time."""
    isg = _make_signal(h)
    putr(h, isg, g.KTFREQ, frequency)
    begins = float(h.cd[g.TIME])
    putr(h, isg, g.KTBEG, begins)
    putr(h, isg, g.KTREST, begins - float(getr(h, isg, g.KTBEG)))
    putr(h, isg, g.KTLAST, lasts)
    return isg


def _make_signal(h: Memory) -> int:
    isg = int(find(h, g.NVSG))
    puti(h, isg, HEAD, g.MSIG)
    puti(h, isg, g.KT, int(h.ci[g.ISGPNT]))
    h.ci[g.ISGPNT] = isg
    return isg


def find_function(h: Memory, number: int) -> int:
    """The signal that is FUNCTION `number`, 0 if there is none."""
    signals = chain(h, int(h.ci[g.ISGPNT]), g.KT)
    return next((s for s in signals if iget(h, s, g.KTP) and iget(h, s, g.KTNUM) == number), 0)


def set_function(array: MainArray, number: int, points: Sequence[tuple[float, float]]) -> None:
    """FUNCTION: factors over time, for boundary conditions; a function of the same number is replaced.

    points: (time, factor), the times in ascending order. Errors 26 and 28.
    """
    if not points:
        raise UdecError(26, "a function needs at least one point", "FUNCTION n t1 f1 t2 f2 ...")
    if not 1 <= whole(n=number) <= array.scheme.top_address:
        advice = f"a function has a number from 1 to {array.scheme.top_address}"
        raise UdecError(28, f"n is {number}", advice, parameter="n")
    for k, (t, f) in enumerate(points, 1):
        finite(array, **{f"t{k}": t, f"f{k}": f})
    for k, ((t1, f1), (t2, f2)) in enumerate(pairwise(points), 2):
        if t2 <= t1:
            raise UdecError(28, f"{t2:g} follows {t1:g}", "times must increase", parameter=f"t{k}")
        finite(array, **{f"t{k} - t{k - 1}": t2 - t1, f"f{k} - f{k - 1}": f2 - f1})
    require(array, size_of(array.h, g.NVSG) + len(points) * size_of(array.h, g.NVTP))
    h = array.h
    isg = find_function(h, number)
    for it in chain(h, iget(h, isg, g.KTP), g.KTPN) if isg else ():
        lose(h, it, g.NVTP)
    isg = isg or _make_signal(h)
    puti(h, isg, g.KTNUM, number)
    first = 0
    for t, f in reversed(points):
        it = int(find(h, g.NVTP))
        puti(h, it, g.KTPN, first)
        putr(h, it, g.KTPT, t)
        putr(h, it, g.KTPF, f)
        first = it
    puti(h, isg, g.KTP, first)


def lose_sines(h: Memory, unused: set[int]) -> None:
    """Give back those of the signals `unused` that are sines: no command can name them."""
    before = 0
    for isg in chain(h, int(h.ci[g.ISGPNT]), g.KT):
        if isg not in unused or iget(h, isg, g.KTP):
            before = isg
            continue
        if before:
            puti(h, before, g.KT, iget(h, isg, g.KT))
        else:
            h.ci[g.ISGPNT] = iget(h, isg, g.KT)
        puti(h, isg, HEAD, 0)
        lose(h, isg, g.NVSG)
