"""Unbalanced force of a model, greatest or mean, and its ratio to the forces that are carried.

An unbalanced force accelerates a rigid block, a grid-point of a fully-deformable block, or the strains of a
simply-deformable one. Moments and strains count as a force at the distance of the farthest corner. Weight and
the loads of boundary conditions are included. The loads are added to the force sums, whose old words are then
restored, so the calculation changes no bit.

Balance is not rest: a block that slides or flies at a constant speed is in balance, as is one that swings
through its equilibrium position. A stiffness K stops a mass m with the velocity v with the force v sqrt(K m).
The ratio of this force to the carried force F is the root of kinetic over strain energy. So a model is at
rest to within a ratio if neither its force ratio nor its kinetic over its strain energy is greater.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, int64, putr, real
from udec_ia.kernels.body.boundary_conditions import add_load, load
from udec_ia.kernels.body.fdef import zone_area
from udec_ia.kernels.body.motion import turns_freely
from udec_ia.kernels.body.sdef import straining_force
from udec_ia.kernels.body.turned_blocks import AS_WHOLE
from udec_ia.kernels.energy.stored_energy import (
    energy_of_motion,
    greatest_motion,
    strain_energy,
)
from udec_ia.kernels.structures.beams import forces_on_node
from udec_ia.layout import offsets as g

BLOCK_SUMS = (g.KBFX, g.KBFY, g.KBFT)
POINT_SUMS = (g.KGFX, g.KGFY)
APPLIED = (g.KSA11, g.KSA12, g.KSA21, g.KSA22)
HELD = g.GIVEN_X + g.GIVEN_Y  # of KBFIX: nothing is free, as the block does not turn freely then
SUMS = len(BLOCK_SUMS) + len(APPLIED)  # words that a load can change; a grid-point has fewer


@kernel
def block_force(h: Memory, ib: int) -> float:
    """Unbalanced force on block `ib` as a whole; its moment counts as a force on the farthest corner."""
    fix, bm, zero = iget(h, ib, g.KBFIX), getr(h, ib, g.KBM), real(h, 0.0)
    if fix == g.FIXED:
        return zero
    fx = zero if fix & g.GIVEN_X else getr(h, ib, g.KBFX) + bm * h.cr[g.GRAVX]
    fy = zero if fix & g.GIVEN_Y else getr(h, ib, g.KBFY) + bm * h.cr[g.GRAVY]
    ft = getr(h, ib, g.KBFT) / getr(h, ib, g.KBRO) if turns_freely(fix) else zero
    return max(np.sqrt(fx * fx + fy * fy), abs(ft))


@kernel
def strain_force(h: Memory, ib: int) -> float:
    """Straining force of simply-deformable block `ib`, as a force on its farthest corner."""
    if iget(h, ib, g.KBFIX) == g.FIXED or iget(h, ib, g.KBFIX) == AS_WHOLE:
        return real(h, 0.0)
    f11, f12, f22 = straining_force(h, iget(h, ib, g.KBEX))
    return max(abs(f11), max(abs(f12), abs(f22))) / getr(h, ib, g.KBRO)


@kernel
def point_force(h: Memory, ib: int) -> tuple[float, int, float, int]:
    """Greatest unbalanced force on a grid-point of block `ib`, and the grid-point; 0 if there is none.

    Then the sum of these forces, and the number of grid-points that are free to follow one.
    """
    largest, at, total, count = real(h, 0.0), int64(0), 0.0, int64(0)
    ig = int64(0) if iget(h, ib, g.KBFIX) == g.FIXED else iget(h, iget(h, ib, g.KBEX), g.KFG)
    while ig != 0:
        fix, m = iget(h, ig, g.KGFIX), getr(h, ig, g.KGPM)
        fx = real(h, 0.0) if fix & g.ALONG_X else getr(h, ig, g.KGFX) + m * h.cr[g.GRAVX]
        fy = real(h, 0.0) if fix & g.ALONG_Y else getr(h, ig, g.KGFY) + m * h.cr[g.GRAVY]
        force = np.sqrt(fx * fx + fy * fy)
        total += force
        if fix & g.ALONG_X == 0 or fix & g.ALONG_Y == 0:
            count += 1
        if force > largest:
            largest, at = force, ig
        ig = iget(h, ig, g.KG)
    return largest, at, total, count


@kernel
def node_force(h: Memory, node: int) -> float:
    """Unbalanced force on a node of a structure; a moment counts as a force at its length of interface."""
    fx, fy, moment = forces_on_node(h, node)
    return max(np.sqrt(fx * fx + fy * fy), abs(moment / getr(h, node, g.KNLEN)))


@kernel
def greatest_unbalanced(h: Memory, soft: Any) -> tuple[float, int, float]:
    """Greatest unbalanced force in the model, from the present force sums, and the group on which it acts.

    That is a grid-point, a block, the extension of a block that is strained, or a node of a structure; 0 if
    nothing is unbalanced.
    Then the mean over all of these that are free to follow a force.
    """
    largest, at, total, count = real(h, 0.0), int64(0), 0.0, int64(0)
    ib = int64(h.ci[g.IBPNT])
    while ib != 0:
        fix = iget(h, ib, g.KBFIX)
        if soft is not None and iget(h, ib, HEAD) == g.MFDEF:
            force, on, sum_of_points, points = point_force(h, ib)
            total += sum_of_points
            count += points
        else:
            force, on = block_force(h, ib), ib
            total += force
            count += 0 if fix == g.FIXED or fix & HELD == HELD else 1
        if soft is not None and iget(h, ib, HEAD) == g.MSDEF:
            straining = strain_force(h, ib)
            total += straining
            count += 0 if fix == g.FIXED or fix == AS_WHOLE else 1
            if straining > force:
                force, on = straining, iget(h, ib, g.KBEX)
        if force > largest:
            largest, at = force, on
        ib = iget(h, ib, g.KB)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        force = node_force(h, node)
        total += force
        count += 1
        if force > largest:
            largest, at = force, node
        node = iget(h, node, g.KN)
    return largest, at, total / count if count > 0 else 0.0


@kernel
def save_force_sums(h: Memory, iu: int, words: Any) -> None:
    """Copy to `words` the force sums that the load of condition `iu` changes."""
    ib, ig = iget(h, iu, g.KUB), iget(h, iu, g.KUG)
    for i in range(len(BLOCK_SUMS)):
        words[i] = getr(h, ib, BLOCK_SUMS[i])
    if ig != 0:
        for i in range(len(POINT_SUMS)):
            words[len(BLOCK_SUMS) + i] = getr(h, ig, POINT_SUMS[i])
    elif iget(h, ib, HEAD) == g.MSDEF:
        for i in range(len(APPLIED)):
            words[len(BLOCK_SUMS) + i] = getr(h, iget(h, ib, g.KBEX), APPLIED[i])


@kernel
def restore_force_sums(h: Memory, iu: int, words: Any) -> None:
    """Restore the words that keep_sums has copied to `words`."""
    ib, ig = iget(h, iu, g.KUB), iget(h, iu, g.KUG)
    for i in range(len(BLOCK_SUMS)):
        putr(h, ib, BLOCK_SUMS[i], real(h, words[i]))
    if ig != 0:
        for i in range(len(POINT_SUMS)):
            putr(h, ig, POINT_SUMS[i], real(h, words[len(BLOCK_SUMS) + i]))
    elif iget(h, ib, HEAD) == g.MSDEF:
        for i in range(len(APPLIED)):
            putr(h, iget(h, ib, g.KBEX), APPLIED[i], real(h, words[len(BLOCK_SUMS) + i]))


@kernel
def put_loads(h: Memory) -> tuple[Any, Any]:
    """Add the loads of all conditions to the force sums; returns the conditions and the old words."""
    n = 0
    iu = int64(h.ci[g.IBNPNT])
    while iu != 0:
        n += 1
        iu = iget(h, iu, g.KU)
    conditions, words = np.empty(n, np.int64), np.empty((n, SUMS), np.float64)
    iu = int64(h.ci[g.IBNPNT])
    for i in range(n):
        conditions[i] = iu
        save_force_sums(h, iu, words[i])
        fx, fy, x, y = load(h, iu)
        add_load(h, iu, fx, fy, x, y)
        iu = iget(h, iu, g.KU)
    return conditions, words


@kernel
def take_loads_back(h: Memory, conditions: Any, words: Any) -> None:
    """Restore the force sums to what they were before `put_loads`, which has returned the arguments."""
    for i in range(len(conditions) - 1, -1, -1):
        restore_force_sums(h, conditions[i], words[i])


@kernel
def greatest_under_loads(h: Memory) -> tuple[float, int, float]:
    """As `greatest_unbalanced`, with the loads of all boundary conditions."""
    conditions, words = put_loads(h)
    found = greatest_unbalanced(h, True)
    take_loads_back(h, conditions, words)
    return found


@kernel
def unbalanced_force(h: Memory, soft: Any) -> tuple[float, int, float]:
    """Greatest unbalanced force, the group on which it acts, and the mean as in `greatest_unbalanced`.

    soft: None if all blocks are rigid and free of boundary conditions.
    """
    if soft is not None:
        return greatest_under_loads(h)
    return greatest_unbalanced(h, soft)


@kernel
def inner_force(h: Memory, ib: int) -> tuple[float, float]:
    """Sum and number of the forces that stresses of block `ib` carry: magnitude of stress times length."""
    total, count = real(h, 0.0), real(h, 0.0)
    if iget(h, ib, HEAD) == g.MSDEF:
        ie = iget(h, ib, g.KBEX)
        s11, s12, s22 = getr(h, ie, g.KS111), getr(h, ie, g.KS112), getr(h, ie, g.KS122)
        size = np.sqrt((s11 * s11 + s12 * s12 * real(h, 2.0) + s22 * s22) * getr(h, ie, g.KSAREA))
        return size, real(h, 1.0) if size > 0 else real(h, 0.0)
    iz = iget(h, iget(h, ib, g.KBEX), g.KFZ) if iget(h, ib, HEAD) == g.MFDEF else int64(0)
    while iz != 0:
        s11, s12, s22 = getr(h, iz, g.KZS11), getr(h, iz, g.KZS12), getr(h, iz, g.KZS22)
        if s11 != 0 or s12 != 0 or s22 != 0:
            total += np.sqrt((s11 * s11 + s12 * s12 * real(h, 2.0) + s22 * s22) * abs(zone_area(h, iz)))
            count += real(h, 1.0)
        iz = iget(h, iz, g.KZ)
    return total, count


@kernel
def mean_carried_force(h: Memory, soft: Any) -> float:
    """Mean of the carried forces; 0 if there are none.

    Contacts with a normal force, zones and simply-deformable blocks with a stress, and structures carry a
    force.
    """
    total, count = real(h, 0.0), real(h, 0.0)
    ic = int64(h.ci[g.ICPNT])
    while ic != 0:
        fn, fs = getr(h, ic, g.KCFN), getr(h, ic, g.KCFS)
        if fn != 0:
            total += np.sqrt(fn * fn + fs * fs)
            count += real(h, 1.0)
        ic = iget(h, ic, g.KC)
    if soft is not None:
        ib = int64(h.ci[g.IBPNT])
        while ib != 0:
            inner, stressed = inner_force(h, ib)
            total += inner
            count += stressed
            ib = iget(h, ib, g.KB)
    ia = int64(h.ci[g.IBTPNT])
    while ia != 0:
        fn, fs = getr(h, ia, g.KAFN), getr(h, ia, g.KAFS)
        if fn != 0 or fs != 0:
            total += np.sqrt(fn * fn + fs * fs)
            count += real(h, 1.0)
        ia = iget(h, ia, g.KA)
    im = int64(h.ci[g.IELPNT])
    while im != 0:
        if getr(h, im, g.KMFN) != 0:
            total += abs(getr(h, im, g.KMFN))
            count += real(h, 1.0)
        im = iget(h, im, g.KM)
    return total / count if total > 0 else real(h, 0.0)


@kernel
def force_ratios(h: Memory, soft: Any) -> tuple[float, float]:
    """Greatest and mean unbalanced force over the mean of the forces that are carried.

    0 if there is no unbalanced force, infinite if there is one and no force is carried.
    """
    largest, _, mean = unbalanced_force(h, soft)
    if largest == 0:
        return 0.0, 0.0
    usual = mean_carried_force(h, soft)
    return (largest / usual, mean / usual) if usual > 0 else (np.inf, np.inf)


@kernel
def force_ratio(h: Memory, soft: Any) -> float:
    """The greater of the two."""
    return force_ratios(h, soft)[0]


@kernel
def motion_ratio(h: Memory, soft: Any) -> float:
    """Kinetic over strain energy; 0 without motion, infinite with motion and without strain energy.

    Scaled masses count as inertial masses, since these determine the force that stops them.
    """
    moving, _, _ = greatest_motion(h, soft)
    if moving == 0:
        return 0.0
    if h.ci[g.LSCALE] != 0:
        moving = energy_of_motion(h)
    strained = strain_energy(h, soft)
    return moving / strained if strained > 0 else np.inf


@outlined
def at_rest(h: Memory, ratio: float) -> bool:
    """True if the model is at rest to within `ratio`: forces are balanced, and the motion is small."""
    return bool(force_ratio(h, True) <= ratio and motion_ratio(h, True) <= ratio)


@outlined
def at_rest_in_mean(h: Memory, ratio: float) -> bool:
    """The same by the mean unbalanced force."""
    return bool(force_ratios(h, True)[1] <= ratio and motion_ratio(h, True) <= ratio)
