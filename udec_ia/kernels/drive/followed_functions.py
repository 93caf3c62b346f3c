"""Numbers of the common block that follow a FUNCTION: gravity and properties of materials.

Before each step a follower sets its number to the value of the command times the factor of its FUNCTION,
halfway through the step as for boundary conditions.

A change of gravity is one between two steps, as that by a command: the potential is counted from a new
reference (EREF), so that it does not jump. In an account of the energy the kinetic energy at a full step
contains the weight (kernels.energy.stored_energy), and what the change adds to it is input.
"""

from __future__ import annotations

from udec_ia.compiling.kernel_decorators import kernel, outlined
from udec_ia.heap.accessors import Memory, getr, iget, int64
from udec_ia.kernels.body.boundary_conditions import set_signals
from udec_ia.kernels.energy.stored_energy import kinetic_energy, potential_energy, potential_in
from udec_ia.layout import offsets as g


@kernel
def set_followers(h: Memory) -> None:
    """Set every number that follows a FUNCTION to its value in the step that begins."""
    set_signals(h)
    iw = int64(h.ci[g.IFWPNT])
    while iw != 0:
        h.cr[iget(h, iw, g.KWN)] = getr(h, iw, g.KWB) * getr(h, iget(h, iw, g.KWS), g.KTNOW)
        iw = iget(h, iw, g.KW)


@outlined
def follow_functions(h: Memory) -> bool:
    """The same before a step, with its entries in the account of the energy."""
    gx, gy = h.cr[g.GRAVX], h.cr[g.GRAVY]
    if h.ci[g.LENER] == 0:
        set_followers(h)
    else:
        energy = kinetic_energy(h, True)
        set_followers(h)
        h.cd[g.EPUT] += kinetic_energy(h, True) - energy
    if h.cr[g.GRAVX] != gx or h.cr[g.GRAVY] != gy:
        h.cd[g.EREF] += potential_energy(h) - potential_in(h, gx, gy)
    return True
