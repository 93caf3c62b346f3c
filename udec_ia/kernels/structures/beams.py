"""Cables and beams: nodes with mass, elements between them, and an interface between each node and its block.

An element has the length L, the direction n, t to its left. With u the displacements of its nodes and w their
rotations in a step, it has

    elongation        dq = n (u2 - u1)             N := N + E A/L dq
    bending           dq = w2 - w1                 (M2 - M1)/2 := ... + E I/L dq        of beams alone
    bending by shear  dq = w1 + w2 - 2 t (u2 - u1)/L      (M1 + M2)/2 := ... + 3 E I/L dq

which is the beam of Euler and Bernoulli, in the axes of the middle of the step: a motion as a rigid body
strains nothing. N yields at YIELD, M1 and M2 at MOMENT, and it breaks as a bolt does (bolts.py).

The interface of a node has the length l, half of the elements beside it, and the springs KN l and KS l
between the node and the point of its block where it is. Shear slips at COHESION l + FRICTION times the normal
force. A node on a wall parts from it where the tension is TENSION l, and touches it again when the gap has
closed; one inside a block, of a cable or a pile, is held on both sides. The forces on node and block act in
one point, so that momentum and angular momentum stay.
"""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.heap.accessors import Memory, getr, iget, int64, puti, putr, real
from udec_ia.kernels.structures.attached_points import block_at, moved_by, push, zone_at
from udec_ia.kernels.structures.bolts import limited
from udec_ia.layout import offsets as g

# ---- elements


@kernel
def element_axis(h: Memory, im: int) -> tuple[float, float, float]:
    """Length of element `im`, and the unit vector from its first to its second node."""
    n1, n2 = iget(h, im, g.KMN1), iget(h, im, g.KMN2)
    dx = np.float64(getr(h, n2, g.KNX)) - np.float64(getr(h, n1, g.KNX))
    dy = np.float64(getr(h, n2, g.KNY)) - np.float64(getr(h, n1, g.KNY))
    length = np.sqrt(dx * dx + dy * dy)
    return length, dx / length, dy / length


@kernel
def element_stiffness(h: Memory, im: int) -> tuple[float, float]:
    """E A/L and E I/L of element `im`; 0 if it is broken."""
    if iget(h, im, g.KMSTAT) & g.BROKEN:
        return 0.0, 0.0
    i, length = iget(h, im, g.KMMAT) - 1, np.float64(getr(h, im, g.KMLEN))
    young = np.float64(h.cr[g.STYM + i])
    bending = young * h.cr[g.STI + i] / length if iget(h, im, g.KMKIND) == g.OF_BEAM else 0.0
    return young * h.cr[g.STAREA + i] / length, bending


@kernel
def element_energy(h: Memory, im: int) -> float:
    """Energy stored in element `im`, in J/m."""
    axial, bending = element_stiffness(h, im)
    fn, m1, m2 = np.float64(getr(h, im, g.KMFN)), np.float64(getr(h, im, g.KMM1)), getr(h, im, g.KMM2)
    even, odd = (m1 + m2) * 0.5, (m2 - m1) * 0.5
    energy = fn * fn / (axial + axial) if axial > 0 else 0.0
    return (
        float(energy + (odd * odd + even * even / 3.0) / (bending + bending))
        if bending > 0
        else float(energy)
    )


@kernel
def strain_element(h: Memory, im: int, stretch: float, odd: float, even: float) -> None:
    """New forces of element `im`. What it does not store of the work on it is lost to yielding."""
    axial, bending = element_stiffness(h, im)
    if axial == 0:
        return
    i, stored, state = iget(h, im, g.KMMAT) - 1, element_energy(h, im), iget(h, im, g.KMSTAT)
    fn, m1, m2 = (
        np.float64(getr(h, im, g.KMFN)),
        np.float64(getr(h, im, g.KMM1)),
        np.float64(getr(h, im, g.KMM2)),
    )
    trial = fn + axial * stretch
    trial1, trial2 = m1 + bending * (3.0 * even - odd), m2 + bending * (3.0 * even + odd)
    new, limit = limited(trial, h.cr[g.STYF + i]), h.cr[g.STMY + i]
    new1, new2 = limited(trial1, limit), limited(trial2, limit)
    if new != trial:
        state |= g.YIELDED
        plastic = getr(h, im, g.KMPL) + (trial - new) / axial
        putr(h, im, g.KMPL, plastic)
        if h.cr[g.STBRK + i] > 0 and plastic > h.cr[g.STBRK + i] * getr(h, im, g.KMLEN):
            state |= g.BROKEN
    if new1 != trial1 or new2 != trial2:
        state |= g.HINGED
    if state & g.BROKEN:
        new, new1, new2 = 0.0, 0.0, 0.0
    puti(h, im, g.KMSTAT, state)
    putr(h, im, g.KMFN, new)
    putr(h, im, g.KMM1, new1)
    putr(h, im, g.KMM2, new2)
    if h.ci[g.LENER] != 0:
        work = (fn + new) * stretch * 0.5
        work += ((m1 + new1) * (even - odd) + (m2 + new2) * (even + odd)) * 0.25
        h.cd[g.WYIELD] += work + stored - element_energy(h, im)


@kernel
def move_element(h: Memory, im: int) -> None:
    """New forces of element `im` after its nodes have moved."""
    dt = np.float64(h.cr[g.TDEL])
    n1, n2 = iget(h, im, g.KMN1), iget(h, im, g.KMN2)
    du = (np.float64(getr(h, n2, g.KNXD)) - np.float64(getr(h, n1, g.KNXD))) * dt
    dv = (np.float64(getr(h, n2, g.KNYD)) - np.float64(getr(h, n1, g.KNYD))) * dt
    w1, w2 = np.float64(getr(h, n1, g.KNTD)) * dt, np.float64(getr(h, n2, g.KNTD)) * dt
    length, ex, ey = element_axis(h, im)
    nx, ny = ex * length, ey * length
    ox, oy, mx, my = nx - du, ny - dv, nx - du * 0.5, ny - dv * 0.5
    stretch = 2.0 * (du * mx + dv * my) / (np.sqrt(ox * ox + oy * oy) + length)
    turn = (dv * mx - du * my) / (mx * mx + my * my)
    strain_element(h, im, stretch, w2 - w1, w1 + w2 - turn - turn)


@kernel
def forces_on_node(h: Memory, node: int) -> tuple[float, float, float]:
    """Unbalanced forces and moment on a node, weight included."""
    m = getr(h, node, g.KNM)
    fx, fy = getr(h, node, g.KNFX) + m * h.cr[g.GRAVX], getr(h, node, g.KNFY) + m * h.cr[g.GRAVY]
    return fx, fy, getr(h, node, g.KNFT)


@kernel
def push_node(h: Memory, node: int, fx: float, fy: float, moment: float) -> None:
    """Add a force and a moment to the force sums of a node."""
    putr(h, node, g.KNFX, getr(h, node, g.KNFX) + fx)
    putr(h, node, g.KNFY, getr(h, node, g.KNFY) + fy)
    putr(h, node, g.KNFT, getr(h, node, g.KNFT) + moment)


@kernel
def push_by_element(h: Memory, im: int) -> None:
    """Add the forces of element `im` to the force sums of its nodes, and its direction to theirs."""
    n1, n2 = iget(h, im, g.KMN1), iget(h, im, g.KMN2)
    length, nx, ny = element_axis(h, im)
    for node in (n1, n2):
        putr(h, node, g.KNTX, getr(h, node, g.KNTX) + length * nx)
        putr(h, node, g.KNTY, getr(h, node, g.KNTY) + length * ny)
    fn, m1, m2 = (
        np.float64(getr(h, im, g.KMFN)),
        np.float64(getr(h, im, g.KMM1)),
        np.float64(getr(h, im, g.KMM2)),
    )
    across = (m1 + m2) / length
    fx, fy = fn * nx + across * ny, fn * ny - across * nx
    push_node(h, n1, fx, fy, -m1)
    push_node(h, n2, -fx, -fy, -m2)


# ---- interfaces of nodes


@kernel
def interface_axes(h: Memory, node: int) -> tuple[float, float, float, float]:
    """Unit vectors of the interface of a node: from the rock to it, and along it."""
    tx, ty = np.float64(getr(h, node, g.KNTX)), np.float64(getr(h, node, g.KNTY))
    size = np.sqrt(tx * tx + ty * ty)
    if size > 0:
        tx, ty = tx / size, ty / size
    side = -1.0 if iget(h, node, g.KNSIDE) == g.ROCK_ON_LEFT else 1.0
    return -side * ty, side * tx, tx, ty


@kernel
def interface_stiffness(h: Memory, node: int) -> tuple[float, float]:
    """Normal and shear stiffness of the interface of a node; a cable without KN has KS for both."""
    if iget(h, node, g.KNBL) == 0:
        return 0.0, 0.0
    i, length = iget(h, node, g.KNMAT) - 1, np.float64(getr(h, node, g.KNLEN))
    kn, ks = np.float64(h.cr[g.STKN + i]), np.float64(h.cr[g.STKS + i])
    return (kn if kn > 0 else ks) * length, ks * length


@kernel
def interface_energy(h: Memory, node: int) -> float:
    """Energy stored in the interface of a node, in J/m."""
    kn, ks = interface_stiffness(h, node)
    fn, fs = np.float64(getr(h, node, g.KNFN)), np.float64(getr(h, node, g.KNFS))
    energy = fn * fn / (kn + kn) if kn > 0 else 0.0
    return float(energy + fs * fs / (ks + ks)) if ks > 0 else float(energy)


@kernel
def normal_force(h: Memory, node: int, kn: float, parted: float) -> float:
    """New normal force of the interface of a node that has moved off the rock by `parted` in the step."""
    fn, gap = np.float64(getr(h, node, g.KNFN)), np.float64(getr(h, node, g.KNGAP))
    trial = fn - kn * (gap + parted) if gap > 0 else fn - kn * parted
    if iget(h, node, g.KNSIDE) == g.EMBEDDED:
        return float(trial)
    i, state = iget(h, node, g.KNMAT) - 1, iget(h, node, g.KNSTAT)
    strength = 0.0 if state & g.NODE_PARTED else np.float64(h.cr[g.STTEN + i]) * getr(h, node, g.KNLEN)
    if trial < -strength:
        puti(h, node, g.KNSTAT, state | g.NODE_PARTED)
        putr(h, node, g.KNGAP, -trial / kn)
        return 0.0
    putr(h, node, g.KNGAP, 0.0)
    return float(trial)


@kernel
def shear_force(h: Memory, node: int, trial: float, fn: float) -> float:
    """Shear force of the interface of a node: `trial` if it does not slip. fn: normal force."""
    i, state = iget(h, node, g.KNMAT) - 1, iget(h, node, g.KNSTAT)
    pressed = abs(fn) if iget(h, node, g.KNSIDE) == g.EMBEDDED else max(fn, 0.0)
    strength = pressed * h.cr[g.STMU + i]
    if not state & g.NODE_PARTED:
        strength += np.float64(h.cr[g.STCOH + i]) * getr(h, node, g.KNLEN)
    if abs(trial) <= strength:
        return trial
    puti(h, node, g.KNSTAT, state | g.NODE_SLIPPED)
    return float(strength if trial > 0 else -strength)


@kernel
def move_interface(h: Memory, node: int) -> None:
    """New forces of the interface of a node after node and block have moved. Lost work is friction."""
    ib = iget(h, node, g.KNBL)
    kn, ks = interface_stiffness(h, node)
    if ib == 0:
        return
    dt = np.float64(h.cr[g.TDEL])
    ax, ay = np.float64(getr(h, node, g.KNAX)), np.float64(getr(h, node, g.KNAY))
    u, v, w = moved_by(h, ib, iget(h, node, g.KNZN), ax, ay)
    putr(h, node, g.KNAX, ax + u)
    putr(h, node, g.KNAY, ay + v)
    du, dv = np.float64(getr(h, node, g.KNXD)) * dt, np.float64(getr(h, node, g.KNYD)) * dt
    rx = getr(h, node, g.KNX) - du * 0.5 - (ax + u * 0.5)
    ry = getr(h, node, g.KNY) - dv * 0.5 - (ay + v * 0.5)
    du, dv = du - (u - w * ry), dv - (v + w * rx)
    nx, ny, tx, ty = interface_axes(h, node)
    parted, along = du * nx + dv * ny, du * tx + dv * ty
    fn, fs, stored = (
        np.float64(getr(h, node, g.KNFN)),
        np.float64(getr(h, node, g.KNFS)),
        interface_energy(h, node),
    )
    new_n = normal_force(h, node, kn, parted) if kn > 0 else 0.0
    new_s = shear_force(h, node, fs + ks * along, new_n)
    putr(h, node, g.KNFN, new_n)
    putr(h, node, g.KNFS, new_s)
    work = ((fs + new_s) * along - (fn + new_n) * parted) * 0.5
    h.cd[g.WFRIC] += work + stored - interface_energy(h, node)


@kernel
def push_by_interface(h: Memory, node: int) -> None:
    """Add the forces of the interface of a node to its force sums and to those of its block."""
    ib = iget(h, node, g.KNBL)
    if ib == 0:
        return
    nx, ny, tx, ty = interface_axes(h, node)
    fn, fs = np.float64(getr(h, node, g.KNFN)), np.float64(getr(h, node, g.KNFS))
    fx, fy = fn * nx - fs * tx, fn * ny - fs * ty
    push_node(h, node, fx, fy, 0.0)
    ax, ay = np.float64(getr(h, node, g.KNAX)), np.float64(getr(h, node, g.KNAY))
    rx, ry = getr(h, node, g.KNX) - ax, getr(h, node, g.KNY) - ay
    push(h, ib, iget(h, node, g.KNZN), ax, ay, -fx, -fy, rx * -fy - ry * -fx)


# ---- all of them


@kernel
def begin_sums(h: Memory, node: int) -> None:
    """Force sums and direction of a node := 0."""
    zero = real(h, 0.0)
    for k in (g.KNFX, g.KNFY, g.KNFT, g.KNTX, g.KNTY):
        putr(h, node, k, zero)


@kernel
def sum_beams(h: Memory, moved: bool) -> None:
    """Force sums of nodes from elements and interfaces, and those of these on blocks, added to theirs.

    moved: True after blocks and nodes have moved, for new forces of elements and interfaces first.
    """
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        begin_sums(h, node)
        node = iget(h, node, g.KN)
    im = int64(h.ci[g.IELPNT])
    while im != 0:
        if moved:
            move_element(h, im)
        push_by_element(h, im)
        im = iget(h, im, g.KM)
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        if moved:
            move_interface(h, node)
        push_by_interface(h, node)
        node = iget(h, node, g.KN)


@kernel
def attach_nodes(h: Memory) -> bool:
    """Find the blocks and zones of nodes again, 0 where none is left; True if one has changed."""
    changed = False
    node = int64(h.ci[g.INDPNT])
    while node != 0:
        former = iget(h, node, g.KNBL)
        if former != 0:
            x, y = np.float64(getr(h, node, g.KNAX)), np.float64(getr(h, node, g.KNAY))
            ib = block_at(h, x, y, former)
            iz = zone_at(h, ib, x, y) if ib != 0 else int64(0)
            changed = changed or ib != former or iz != iget(h, node, g.KNZN)
            puti(h, node, g.KNBL, ib)
            puti(h, node, g.KNZN, iz)
        node = iget(h, node, g.KN)
    return changed
