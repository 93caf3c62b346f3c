"""BOUNDARY and FUNCTION: boundary conditions (kernels.body.boundary_conditions) and their signals in time.

Velocities and forces act on the grid-points in the range, and on blocks without grid-points whose centroids
lie in it. Stresses and viscous resistance act on edges with both ends in the range. Tension is positive. A
stress S(x, y) = S0 + x SX + y SY on an edge from a to b with the outward normal n and the length L has the
tractions t = S n at the ends. The corners or their grid-points get the forces L (2 ta + tb)/6 and
L (ta + 2 tb)/6, which have the resultant and the moment of t.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find, lose
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.geometry.range_selection import edges_between, points_between
from udec_ia.layout import offsets as g
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.block_ranges import Point, Range, check_range, why_nothing
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import check_real_range, finite, not_negative, positive, reals, whole
from udec_ia.reader.list_walks import chain

Triple = tuple[float, float, float]  # components 11, 12, 22
Target = tuple[int, int, int, int]  # KUB, KUG, KUP and KUQ of a condition
TARGET = (g.KUB, g.KUG, g.KUP, g.KUQ)
Load = tuple[float, ...]  # force x, y and viscous resistance xx, xy, yy
Loads = dict[Target, Load]
LOAD = (g.KUFX, g.KUFY, g.KUCXX, g.KUCXY, g.KUCYY)
ZERO: Triple = (0.0, 0.0, 0.0)
ALL: Range = (-math.inf, math.inf, -math.inf, math.inf)


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
    """BOUNDARY: set conditions in the range, or with `free` remove them all. Returns their number.

    xvel, yvel: velocities, m/s. xforce, yforce: N/m on each grid-point or block. stress: Pa; 11, 12, 22;
    xgrad, ygrad: its increase per metre. viscous: non-reflecting edges. sine: frequency (Hz) and duration (s)
    from now on, or function: number of a FUNCTION; it multiplies loads and velocities. Errors 24, 26, 28.
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
    _check_conditions(moves or presses, sine is not None, function is not None, free)
    if free:
        return _set_free(array.h, where)
    fix = g.ALONG_X * (xvel is not None) + g.ALONG_Y * (yvel is not None)
    pressure = (stress, xgrad, ygrad) if presses else None
    loads = _loads(array.h, where, (xforce, yforce) if moves else None, pressure, viscous)
    _check_free(array.h, [target[0] for target in loads if target[2] == 0], xvel=xvel, yvel=yvel)
    check_real_range(array, "a force or an impedance", (value for load in loads.values() for value in load))
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
) -> Loads:
    """The loads in the range: on points if `force` is given, on edges if `stress` is. Error 24 if none."""
    loads: Loads = {}
    if force is not None:
        for ib, ig in points_between(h, *map(float, where)).tolist():
            _add(loads, (ib, ig, 0, 0), (*force, *ZERO))
    if stress is not None:
        for ib, ip in edges_between(h, *map(float, where)).tolist():
            _load_edge(h, ib, ip, stress, viscous, loads)
    if not loads:
        advice = "what lies on the limits of a range is outside it"
        raise UdecError(24, _why_nothing(h, where, force is not None), advice, parameter="x1")
    return loads


def _add(loads: Loads, target: Target, load: Load) -> None:
    before = loads.get(target, (0.0,) * len(LOAD))
    loads[target] = tuple(a + b for a, b in zip(before, load, strict=True))


def _check_conditions(condition: bool, sine: bool, function: bool, free: bool) -> None:
    """Error 26 if no condition is given, 10 if the given conditions exclude each other."""
    if free and (condition or sine or function):
        advice = "give other conditions on another line"
        raise UdecError(10, "FREE takes no other conditions", advice, parameter="free")
    if sine and function:
        advice = "a condition follows a sine or a function, not both"
        raise UdecError(10, "FUNCTION beside SINE", advice, parameter="function")
    if not (condition or free):
        raise UdecError(26, "no velocity, and no force or stress other than 0", "BOUNDARY 0 9 0 1 YVEL=0")


def _check_free(h: Memory, blocks: Iterable[int], **velocity: float | None) -> None:
    """Error 28 if a velocity other than 0 is given to a fixed block or to its grid-points."""
    moving = next((name for name, v in velocity.items() if v), None)
    fixed = next((ib for ib in blocks if moving and iget(h, ib, g.KBFIX) == g.FIXED), None)
    if fixed is not None:
        x, y = float(getr(h, fixed, g.KX)), float(getr(h, fixed, g.KY))
        advice = f"FREE a range with its centroid ({x:g}, {y:g}) first; the velocity then holds the block"
        raise UdecError(28, f"block@{fixed} is fixed and would not move", advice, parameter=moving or "")


def _why_nothing(h: Memory, where: Range, moves: bool) -> str:
    """Why there is no point in the range (if `moves`), or no edge."""
    if not moves:
        edges = (
            (f"block@{ib}'s", (_corner(h, iget(h, ip, g.KR)), _corner(h, ip)))
            for ib, ip in edges_between(h, *ALL).tolist()
        )
        return why_nothing(where, "edge with both ends", edges)
    points = []
    for ib, ig in points_between(h, *ALL).tolist():
        x, y = (getr(h, ig, k) for k in (g.KXG, g.KYG)) if ig else (getr(h, ib, k) for k in (g.KX, g.KY))
        name = f"gridpoint@{ig} of block@{ib}" if ig else f"block@{ib}"
        points.append((name, ((float(x), float(y)),)))
    return why_nothing(where, "grid-point and no centroid", points)


def _corner(h: Memory, ip: int) -> Point:
    return float(getr(h, ip, g.KXP)), float(getr(h, ip, g.KYP))


def _load_edge(h: Memory, ib: int, ip: int, stress: Sequence[Triple], viscous: bool, loads: Loads) -> None:
    """Add stress and viscous resistance on one edge to the loads of its two ends."""
    ia = iget(h, ip, g.KR)
    (ax, ay), (bx, by) = _corner(h, ia), _corner(h, ip)
    length = math.hypot(bx - ax, by - ay)
    nx, ny = -(by - ay) / length, (bx - ax) / length  # outwards: to the left of a clockwise edge

    def traction(x: float, y: float) -> Point:
        s11, s12, s22 = (s + x * sx + y * sy for s, sx, sy in zip(*stress, strict=True))
        return s11 * nx + s12 * ny, s12 * nx + s22 * ny

    (tax, tay), (tbx, tby) = traction(ax, ay), traction(bx, by)
    cn, cs = _impedances(h, ib) if viscous else (0.0, 0.0)
    c = (cn * nx * nx + cs * ny * ny, (cn - cs) * nx * ny, cn * ny * ny + cs * nx * nx)
    half = [one * length / 2 for one in c]
    start = length * (2 * tax + tbx) / 6, length * (2 * tay + tby) / 6
    end = length * (tax + 2 * tbx) / 6, length * (tay + 2 * tby) / 6
    for i, j, force in ((ia, ip, start), (ip, ia, end)):
        ig = iget(h, i, g.KGP)
        _add(loads, (ib, ig, 0, 0) if ig else (ib, 0, i, j), (*force, *half))


def _impedances(h: Memory, ib: int) -> tuple[float, float]:
    """rho Cp and rho Cs of the material of block `ib`. Error 26 without density and moduli."""
    m = iget(h, ib, g.KMAT)
    rho, one, two = (float(h.cr[k + m - 1]) for k in (g.DENS, g.ALAM1, g.ALAM2))
    if not (rho > 0 and one > 0 and one > two):
        detail = f"density, BULK and G of material {m} for a viscous edge"
        raise UdecError(26, detail, f"PROPERTY MATERIAL={m} DENSITY=... BULK=... G=...")
    return math.sqrt(rho * one), math.sqrt(rho * (one - two) / 2)


def _make(h: Memory, target: Target, load: Load, fix: int, velocity: Point, signal: int) -> None:
    """Put a condition at the head of the list."""
    ib, ig, _, _ = target
    iu = int(find(h, g.NVBN))
    puti(h, iu, HEAD, g.MBND)
    whole_numbers = int(h.ci[g.IBNPNT]), *target, signal, fix
    for k, n in zip((g.KU, *TARGET, g.KUS, g.KUFIX), whole_numbers, strict=True):
        puti(h, iu, k, n)
    for k, value in zip((*LOAD, g.KUVX, g.KUVY), (*load, *velocity), strict=True):
        putr(h, iu, k, value)
    h.ci[g.IBNPNT] = iu
    if fix and ig:
        puti(h, ig, g.KGFIX, iget(h, ig, g.KGFIX) | fix)
    elif fix and iget(h, ib, g.KBFIX) != g.FIXED:
        puti(h, ib, g.KBFIX, iget(h, ib, g.KBFIX) | _of_block(fix))


def _of_block(fix: int) -> int:
    """The codes of KBFIX for the codes `fix` of KUFIX of a condition on a block."""
    return (g.GIVEN_X if fix & g.ALONG_X else 0) | (g.GIVEN_Y if fix & g.ALONG_Y else 0)


def _release(h: Memory, points: set[tuple[int, int]], fix: int) -> None:
    """End the velocities `fix` of earlier conditions on points; remove conditions that are then empty.

    points: blocks and grid-points, as KUB and KUG.
    """
    bounds = list_of(h, "bound")
    gives = bounds[integers(h, bounds, g.KUFIX) & fix != 0]
    left = [iu for iu in gives.tolist() if (iget(h, iu, g.KUB), iget(h, iu, g.KUG)) in points]
    for iu in left:
        puti(h, iu, g.KUFIX, iget(h, iu, g.KUFIX) & ~fix)
    _drop(h, [iu for iu in left if iget(h, iu, g.KUFIX) == 0 and not any(getr(h, iu, k) for k in LOAD)])


def number_of_conditions(h: Memory) -> int:
    """The number of boundary conditions."""
    return len(list_of(h, "bound"))


def _drop(h: Memory, gone: list[int]) -> None:
    """Give the conditions `gone` back, and sines without another condition, as no command can name them."""
    signals = {iget(h, iu, g.KUS) for iu in gone} - {0}
    drop(h, "bound", gone)
    if signals:
        signals.difference_update(integers(h, list_of(h, "bound"), g.KUS).tolist())
        sines = [isg for isg in list_of(h, "signal").tolist() if isg in signals and not iget(h, isg, g.KTP)]
        drop(h, "signal", sines)


def given_velocities(h: Memory) -> dict[int, int]:
    """KBFIX, without FIXED, of all blocks with velocities by conditions."""
    bounds = list_of(h, "bound")
    fix: dict[int, int] = {}
    for iu in bounds[(integers(h, bounds, g.KUFIX) != 0) & (integers(h, bounds, g.KUG) == 0)].tolist():
        ib = iget(h, iu, g.KUB)
        fix[ib] = fix.get(ib, 0) | _of_block(iget(h, iu, g.KUFIX))
    return fix


def forget_blocks(h: Memory, blocks: Iterable[int]) -> None:
    """Remove all conditions on `blocks`, which are going to be deleted or changed."""
    bounds = list_of(h, "bound")
    _free(h, bounds[np.isin(integers(h, bounds, g.KUB), list(blocks))].tolist())


def _free(h: Memory, gone: list[int]) -> None:
    """Remove the conditions `gone`, and free the blocks and grid-points that they held."""
    for iu in gone:
        ib, ig = iget(h, iu, g.KUB), iget(h, iu, g.KUG)
        if ig:
            puti(h, ig, g.KGFIX, iget(h, ig, g.KGFIX) & ~iget(h, iu, g.KUFIX))
        elif iget(h, ib, g.KBFIX) != g.FIXED:
            puti(h, ib, g.KBFIX, iget(h, ib, g.KBFIX) & ~_of_block(iget(h, iu, g.KUFIX)))
    _drop(h, gone)


def _set_free(h: Memory, where: Range) -> int:
    """Remove the conditions in the range; returns their number."""
    x1, x2, y1, y2 = map(float, where)
    points = set(map(tuple, points_between(h, x1, x2, y1, y2).tolist()))

    def is_inside(iu: int) -> bool:
        ib, ig, ip = (iget(h, iu, k) for k in (g.KUB, g.KUG, g.KUP))
        if ip == 0:
            return (ib, ig) in points
        x, y = _corner(h, ip)
        return x1 < x < x2 and y1 < y < y2

    gone = [iu for iu in list_of(h, "bound").tolist() if is_inside(iu)]
    _free(h, gone)
    return len(gone)


# ---- FUNCTION, and the sines of BOUNDARY: signals in time


def make_sine(h: Memory, frequency: float, lasts: float) -> int:
    """A signal that is a sine of the given frequency (Hz) from now on, for a time (s)."""
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
    signals = list_of(h, "signal").tolist()
    return next((s for s in signals if iget(h, s, g.KTP) and iget(h, s, g.KTNUM) == number), 0)


def set_function(array: MainArray, number: int, points: Sequence[tuple[float, float]]) -> None:
    """FUNCTION: factors over time for boundary conditions; replaces a function of the same number.

    points: (time, factor), by ascending time. Errors 26 and 28.
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
