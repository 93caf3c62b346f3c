"""BOUNDARY: boundary conditions (kernels.body.boundary_conditions, kernels.body.turned_blocks).

Velocities and forces act on the grid-points in the range, and on blocks without grid-points whose centroids
lie in it. With a rotation, velocities act on whole blocks with centroids in the range. That is also so for
blocks that FIX holds: velocities that are not given are 0 there, and the condition holds the block from then
on. A block that moves as a whole has two conditions, one for the rotation.

Stresses and viscous resistance act on edges with both ends in the range. Tension is positive. A stress
S(x, y) = S0 + x SX + y SY on an edge from a to b with the outward normal n and the length L has the tractions
t = S n at the ends. The corners or their grid-points get the forces L (2 ta + tb)/6 and L (ta + 2 tb)/6,
which have the resultant and the moment of t.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Unpack

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers, puti, putr, size_of
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.body.motion import set_corner_velocities
from udec_ia.kernels.body.sdef import put_strain_rate
from udec_ia.kernels.body.turned_blocks import AS_WHOLE, turn_points
from udec_ia.kernels.links.linked_lists import is_corner
from udec_ia.layout import offsets as g
from udec_ia.ops.commands.function_command import existing_function, make_sine
from udec_ia.ops.commands.outside_conditions import OutsideWater, free_outside, set_outside
from udec_ia.ops.common.array_growth import require
from udec_ia.ops.common.block_ranges import (
    Point,
    blocks_in,
    check_range,
    edges_in,
    items,
    points_in,
    why_no_block,
    why_nothing,
)
from udec_ia.ops.common.kernel_arguments import renew_forces
from udec_ia.ops.common.listed_groups import drop, list_of
from udec_ia.ops.common.number_limits import check_real_range, finite, not_negative, positive, reals
from udec_ia.reader.group_ranges import EVERYWHERE, Range, holds, range_of
from udec_ia.reader.list_walks import chain

Triple = tuple[float, float, float]  # components 11, 12, 22
Target = tuple[int, int, int, int]  # KUB, KUG, KUP and KUQ of a condition
TARGET = (g.KUB, g.KUG, g.KUP, g.KUQ)
Load = tuple[float, ...]  # force x, y and viscous resistance xx, xy, yy
Loads = dict[Target, Load]
Motion = dict[str, float | None]  # xvel, yvel and rotation; None where it is not given
LOAD = (g.KUFX, g.KUFY, g.KUCXX, g.KUCXY, g.KUCYY)
ZERO: Triple = (0.0, 0.0, 0.0)


def boundary(
    array: MainArray,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    *,
    xvel: float | None = None,
    yvel: float | None = None,
    rotation: float | None = None,
    xforce: float = 0.0,
    yforce: float = 0.0,
    stress: Triple = ZERO,
    xgrad: Triple = ZERO,
    ygrad: Triple = ZERO,
    viscous: bool = False,
    sine: tuple[float, float] | None = None,
    function: int | None = None,
    free: bool = False,
    **water: Unpack[OutsideWater],
) -> int:
    """BOUNDARY: set conditions in the range, or with `free` remove them all.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m, or words.
    xvel, yvel, rotation
        Velocities in m/s of the grid-points in the range and of blocks without grid-points; with a rotation
        (rad/s, anticlockwise) those of whole blocks with centroids in the range, of every type.
    xforce, yforce
        Force in N/m on each grid-point or block.
    stress, xgrad, ygrad, viscous
        Stress in Pa on edges, components 11, 12, 22, and its increase per metre; or non-reflecting edges.
    sine, function
        Frequency (Hz) and duration (s) of a sine from now on, or number of a FUNCTION, which multiplies all.
    free
        Remove all conditions in the range.
    water
        On exposed edges, instead (OutsideWater).

    Returns
    -------
    int
        The number of places with a condition, or of the conditions that were removed.

    Raises
    ------
    UdecError
        10, 24, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.boundary(0, 2, 1, 2, xforce=1e4)  # N/m on the upper block
    1
    """
    where, motion = range_of(x1, x2, y1, y2), {"xvel": xvel, "yvel": yvel, "rotation": rotation}
    field, sine = _stress_field(array, stress=stress, xgrad=xgrad, ygrad=ygrad), _sine(array, sine)
    check_range(array, where)
    finite(array, xforce=xforce, yforce=yforce, **{name: v or 0.0 for name, v in motion.items()})
    drives, pushes = any(v is not None for v in motion.values()), bool(xforce or yforce)
    presses = viscous or any(map(any, field))
    if any(value is not None for value in water.values()):
        return set_outside(array, where, water, function, any((drives, pushes, presses, sine, free)))
    _check_conditions(drives or pushes or presses, sine is not None, function is not None, free)
    if free:
        return _set_free(array, where) + free_outside(array, where)
    loads = _loads(array, where, motion, (xforce, yforce), field if presses else None, viscous)
    return _set_conditions(array, where, motion, loads, pushes, sine, function)


def _set_conditions(
    array: MainArray,
    where: Range,
    motion: Motion,
    loads: Loads,
    pushes: bool,
    sine: tuple[float, float] | None,
    function: int | None,
) -> int:
    """Set conditions with a motion and loads. pushes: forces are among the loads. Returns as `boundary`."""
    h = array.h
    bodies = _bodies(array, where, motion)
    fix = 0 if motion["rotation"] is not None else _fix(motion)
    if not pushes:
        loads = {target: load for target, load in loads.items() if target[2] or target[0] not in bodies}
    if not (loads or bodies):
        raise _nothing_in(array, where, motion, pushes or bool(fix))
    if fix:
        _check_points(h, [target for target in loads if target[2] == 0 and target[0] not in bodies], motion)
    check_real_range(array, "a force or an impedance", (value for load in loads.values() for value in load))
    signal = existing_function(h, function) if function is not None else 0
    require(array, (len(loads) + 2 * len(bodies)) * size_of(h, g.NVBN) + size_of(h, g.NVSG))
    h = array.h
    if sine is not None:
        signal = make_sine(h, *sine)
    if fix:
        _release(h, {target[:2] for target in loads if target[2] == 0}, fix)
    velocity = motion["xvel"] or 0.0, motion["yvel"] or 0.0
    for target, load in loads.items():
        held = fix if target[2] == 0 and target[0] not in bodies else 0
        if held or any(load):
            _make(h, target, load, held, velocity, signal)
    for ib in bodies:
        _move_as_body(array, ib, motion, signal)
    return len(loads.keys() | {(ib, 0, 0, 0) for ib in bodies})


def _stress_field(array: MainArray, **triples: Triple) -> list[Triple]:
    """The stress and its gradients. Error 10 or 26 unless each has 3 components, 28 for an infinite one."""
    field = [reals(3, **{name: triple}) for name, triple in triples.items()]
    for name, triple in zip(triples, field, strict=True):
        for component in triple:
            finite(array, **{name: component})
    return field


def _sine(array: MainArray, sine: tuple[float, float] | None) -> tuple[float, float] | None:
    """Frequency and duration. Error 28 for a frequency of 0 or less, or a negative duration."""
    if sine is None:
        return None
    frequency, duration = reals(2, sine=sine)
    positive(array, sine=frequency)
    not_negative(array, sine=duration)
    return frequency, duration


def _fix(motion: Motion) -> int:
    """The codes of KUFIX for the velocities in x and y that are given."""
    return g.ALONG_X * (motion["xvel"] is not None) + g.ALONG_Y * (motion["yvel"] is not None)


def _bodies(array: MainArray, where: Range, motion: Motion) -> list[int]:
    """The blocks with centroids in the range that are to move as whole blocks.

    With a rotation these are all of them, else those that FIX holds and that get a velocity other than 0.
    Error 26 for a fully-deformable block with an incomplete motion.
    """
    h = array.h
    if motion["rotation"] is None and not any(motion.values()):
        return []
    blocks = blocks_in(array, where)
    if motion["rotation"] is None:
        blocks = [ib for ib in blocks if iget(h, ib, g.KBFIX) == g.FIXED]
    lacking = " and ".join(name.upper() for name, v in motion.items() if v is None)
    for ib in blocks:
        zoned = iget(h, ib, HEAD) == g.MFDEF
        if zoned and iget(h, iget(h, ib, g.KBEX), g.KFG) == 0:
            raise UdecError(26, f"block@{ib} has no zones", "GENERATE divides it", parameter="x1")
        if zoned and lacking and iget(h, ib, g.KBFIX) != g.FIXED:
            advice = "a fully-deformable block moves as a whole with XVEL, YVEL and ROTATION"
            raise UdecError(26, f"{lacking} of block@{ib}", advice, parameter="rotation")
    return blocks


def _move_as_body(array: MainArray, ib: int, motion: Motion, signal: int) -> None:
    """Make the conditions that move block `ib` as a whole. One that was fixed is held by them instead."""
    h = array.h
    fix, soft = _fix(motion), iget(h, ib, HEAD) == g.MFDEF
    moves = any(motion.values())
    if iget(h, ib, g.KBFIX) == g.FIXED:
        fix = g.ALONG_X | g.ALONG_Y
        if moves:
            puti(h, ib, g.KBFIX, 0)
            if soft and h.ci[g.MCTOT] > 0:
                renew_forces(array)  # a fixed block has none at its grid-points
    points = [*chain(h, iget(h, iget(h, ib, g.KBEX), g.KFG), g.KG)] if soft else []
    _release(h, {(ib, ig) for ig in (0, *points)}, fix | g.TURNS)
    body, no_load = (ib, 0, 0, 0), (0.0,) * len(LOAD)
    vx, vy, turn = (motion[name] or 0.0 for name in ("xvel", "yvel", "rotation"))
    if fix:
        _make(h, body, no_load, fix, (vx, vy), signal)
    _make(h, body, no_load, g.TURNS, (turn, 0.0), signal)
    for ig in points:
        puti(h, ig, g.KGFIX, g.ALONG_X | g.ALONG_Y)
    if iget(h, ib, g.KBFIX) == AS_WHOLE:
        _stop_straining(h, ib)


def _stop_straining(h: Memory, ib: int) -> None:
    """Leave deformable block `ib` only its motion as a rigid body."""
    if iget(h, ib, HEAD) == g.MSDEF:
        put_strain_rate(h, iget(h, ib, g.KBEX), *[h.cr.dtype.type(0)] * 3)
        set_corner_velocities(h, ib)
    elif iget(h, ib, HEAD) == g.MFDEF:
        turn_points(h, ib)
        for item in items(h, ib):
            if is_corner(h, item):
                ig = iget(h, item, g.KGP)
                putr(h, item, g.KXDP, getr(h, ig, g.KXDG))
                putr(h, item, g.KYDP, getr(h, ig, g.KYDG))


def _loads(
    array: MainArray,
    where: Range,
    motion: Motion,
    force: tuple[float, float],
    stress: Sequence[Triple] | None,
    viscous: bool,
) -> Loads:
    """The loads in the range: on points with a force or a velocity of their own, on edges with a stress."""
    h, loads = array.h, dict[Target, Load]()
    moved = any(v is not None for v in motion.values()) and motion["rotation"] is None
    if any(force) or moved:
        for ib, ig in points_in(array, where).tolist():
            add_to_load(loads, (ib, ig, 0, 0), (*force, *ZERO))
    if stress is not None:
        for ib, ip in edges_in(array, where).tolist():
            _load_edge(h, ib, ip, stress, viscous, loads)
    return loads


def add_to_load(loads: Loads, target: Target, load: Load) -> None:
    """Add `load` to what acts on `target` already."""
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


def _check_points(h: Memory, targets: Iterable[Target], motion: Motion) -> None:
    """Error 28 if a grid-point is to get a velocity of its own, but its block is held as a whole."""
    name = next((name for name, v in motion.items() if v), None)
    bodies = _zoned_bodies(h)
    for ib, ig, _, _ in targets:
        fixed = name is not None and iget(h, ib, g.KBFIX) == g.FIXED
        if fixed or (ig and ib in bodies):
            x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
            how = "fixed" if fixed else "moved as a whole by BOUNDARY ... ROTATION"
            undo = "FREE" if fixed else "BOUNDARY ... FREE"
            advice = f"a range with its centroid ({x:g}, {y:g}) moves the whole block; {undo} releases it"
            raise UdecError(28, f"block@{ib} is {how}", advice, parameter=name or "")


def _zoned_bodies(h: Memory) -> set[int]:
    """Blocks with zones that conditions move as a whole."""
    bounds = list_of(h, "bound")
    blocks = integers(h, bounds[integers(h, bounds, g.KUFIX) == g.TURNS], g.KUB)
    return set(blocks[integers(h, blocks, HEAD) == g.MFDEF].tolist())


def _nothing_in(array: MainArray, where: Range, motion: Motion, at_points: bool) -> UdecError:
    """Error 24: there is nothing in the range that the condition could act on."""
    h = array.h
    advice = "what lies on the limits of a range is outside it"
    edges = edges_in(array, where)
    if len(edges) and any(v is not None for v in motion.values()):
        ib = int(edges[0, 0])
        x, y = float(getr(h, ib, g.KX)), float(getr(h, ib, g.KY))
        advice = (
            f"block@{ib}, an edge of which is in the range, has velocities as a whole: take a range with its "
            f"centroid ({x:g}, {y:g}), or GENERATE zones in it, whose grid-points can move one by one"
        )
    turns = motion["rotation"] is not None
    detail = why_no_block(array, where) if turns else _why_nothing(array, where, at_points)
    return UdecError(24, detail, advice, parameter="x1")


def _why_nothing(array: MainArray, where: Range, moves: bool) -> str:
    """Why there is no point in the range (if `moves`), or no edge."""
    h = array.h
    if not moves:
        edges = (
            (f"block@{ib}'s", (_corner(h, iget(h, ip, g.KR)), _corner(h, ip)))
            for ib, ip in edges_in(array, EVERYWHERE).tolist()
        )
        return why_nothing(where, "edge with both ends", edges)
    points = []
    for ib, ig in points_in(array, EVERYWHERE).tolist():
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
        add_to_load(loads, (ib, ig, 0, 0) if ig else (ib, 0, i, j), (*force, *half))


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
    pairs = (g.ALONG_X, g.GIVEN_X), (g.ALONG_Y, g.GIVEN_Y), (g.TURNS, g.GIVEN_TURN)
    return sum(given for code, given in pairs if fix & code)


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


def set_loads(array: MainArray, loads: Loads, signal: int) -> None:
    """Make conditions with `loads` only, times that signal; there must be room for them. Error 28."""
    check_real_range(array, "a force", (value for load in loads.values() for value in load))
    for target, load in loads.items():
        if any(load):
            _make(array.h, target, load, 0, (0.0, 0.0), signal)


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
    """Remove all conditions on `blocks`, which are going to be deleted or changed.

    Sums of reactions lose the grid-points of these blocks.
    """
    changed, bounds, summands = list(blocks), list_of(h, "bound"), list_of(h, "summand")
    _free(h, bounds[np.isin(integers(h, bounds, g.KUB), changed)].tolist())
    points = np.isin(integers(h, summands, g.KQB), changed) & (integers(h, summands, g.KQG) != 0)
    drop(h, "summand", summands[points].tolist())


def _free(h: Memory, gone: list[int]) -> None:
    """Remove the conditions `gone`, and free the blocks and grid-points that they held."""
    for iu in gone:
        ib, ig = iget(h, iu, g.KUB), iget(h, iu, g.KUG)
        fix, points = iget(h, iu, g.KUFIX), [ig] if ig else []
        if not ig and iget(h, ib, HEAD) == g.MFDEF:
            points = [*chain(h, iget(h, iget(h, ib, g.KBEX), g.KFG), g.KG)]
        for one in points:
            puti(h, one, g.KGFIX, iget(h, one, g.KGFIX) & ~fix)
        if not ig and iget(h, ib, g.KBFIX) != g.FIXED:
            puti(h, ib, g.KBFIX, iget(h, ib, g.KBFIX) & ~_of_block(fix))
    _drop(h, gone)


def _set_free(array: MainArray, where: Range) -> int:
    """Remove the conditions in the range; returns their number."""
    h = array.h
    points = set(map(tuple, points_in(array, where).tolist()))
    points |= {(ib, 0) for ib in blocks_in(array, where)}

    def is_inside(iu: int) -> bool:
        ib, ig, ip = (iget(h, iu, k) for k in (g.KUB, g.KUG, g.KUP))
        if ip == 0:
            return (ib, ig) in points
        x, y = _corner(h, ip)
        return bool(holds(array, where, np.array([x]), np.array([y]), np.array([ib]))[0])

    gone = [iu for iu in list_of(h, "bound").tolist() if is_inside(iu)]
    _free(h, gone)
    return len(gone)
