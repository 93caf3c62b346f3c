"""The account of the energy: input, stored energy and losses (ENERGY, PRINT ENERGY).

It begins with ENERGY ON: the energy of the model is then the first input, and the potential of gravity is 0.
Between two CYCLEs commands delete moving blocks, set velocities and change stiffnesses. Their input is the
difference of stored energy, kinetic and strain, between the end of one CYCLE and the beginning of the next.
So the account of the cycles must balance. Its residual is the error of the time-step, of contacts that open
and close within a step, and of missing terms.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import Memory
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.energy.stored_energy import (
    contact_strain_energy,
    kinetic_energy,
    potential_energy,
    strain_energy_of_blocks,
    strain_energy_of_structures,
)
from udec_ia.layout import offsets as g
from udec_ia.ops.common.kernel_arguments import soft
from udec_ia.ops.common.number_limits import check_real_range

LOST = g.WFRIC, g.WMASS, g.WREST, g.WSTIF, g.WYIELD, g.WSHAPE, g.WCRACK  # as in Balance
OF_WATER = g.WATERW, g.WPUMPW, g.WHEADW, g.WVISCW
SUM_BITS = 64  # of the reals that hold the account, in every word scheme


class Balance(NamedTuple):
    """Energies in J per m of thickness. commands: initial energy and input by commands. water: its work."""

    commands: float
    boundary: float
    water: float
    kinetic: float
    contacts: float
    blocks: float
    structures: float
    potential: float
    friction: float
    mass_damping: float
    relaxation: float
    stiffness_damping: float
    yielding: float
    shape: float
    cracks: float

    @property
    def strain(self) -> float:
        """Strain energy of contacts, deformable blocks and structures."""
        return self.contacts + self.blocks + self.structures

    @property
    def residual(self) -> float:
        """Input that is neither stored nor lost."""
        return self.commands + self.boundary + self.water - sum(self[3:])

    @property
    def throughput(self) -> float:
        """The sum of all sources and the sum of all sinks: the mean of both."""
        return sum(map(abs, self)) / 2


def switch(array: MainArray, on: bool) -> None:
    """ENERGY ON: an account begins, with sums of 0. ENERGY OFF: it ends.

    Error 26 if masses are scaled, 28 as `begin`.
    """
    h = array.h
    if on and h.ci[g.LSCALE]:
        advice = "FRACTION without SCALED"
        raise UdecError(26, "no account of the energy can be kept with scaled masses", advice)
    energy, reference = (_energy(array), _height(array)) if on else (0.0, 0.0)
    h.ci[g.LENER] = int(on)
    for name in (g.WBOUND, *LOST, g.EPOT, *OF_WATER):
        h.cd[name] = 0
    h.cd[g.EPUT] = h.cd[g.ESTOR] = energy
    h.cd[g.EREF] = reference


def balance(h: Memory) -> Balance:
    """The present account. Error 26 without ENERGY ON."""
    if not h.ci[g.LENER]:
        raise UdecError(26, "no account of the energy is kept", "give ENERGY ON before CYCLE")
    stored = stored_energies(h)
    commands = _put_in(h, sum(stored))
    lost = (float(h.cd[name]) for name in LOST)
    given = float(h.cd[g.WBOUND]), float(h.cd[g.WATERW])
    return Balance(commands, *given, *stored, float(h.cd[g.EPOT]), *lost)


def begin(array: MainArray) -> None:
    """A CYCLE begins: add the input by commands since the last one.

    Error 28, and nothing is changed, if 64-bit reals cannot hold the energy or its change.
    """
    h = array.h
    if h.ci[g.LENER]:
        energy, reference = _energy(array), _height(array) - float(h.cd[g.EPOT])
        put = _put_in(h, energy)
        check_real_range(array, "the energy put in by commands", [put, reference], SUM_BITS)
        h.cd[g.EPUT], h.cd[g.ESTOR], h.cd[g.EREF] = put, energy, reference


def end(array: MainArray) -> None:
    """A CYCLE has ended. Energies beyond the reals become infinite."""
    h = array.h
    if h.ci[g.LENER]:
        with np.errstate(over="ignore"):
            h.cd[g.ESTOR] = sum(stored_energies(h))
            h.cd[g.EPOT] = float(potential_energy(h)) - float(h.cd[g.EREF])


def _height(array: MainArray) -> float:
    """Potential of gravity against the origin. Error 28 if 64-bit reals cannot hold it."""
    potential = float(potential_energy(array.h))
    check_real_range(array, "the potential of gravity", [potential], SUM_BITS)
    return potential


def _energy(array: MainArray) -> float:
    """Kinetic and strain energy. Error 28 if 64-bit reals cannot hold it."""
    energy = sum(stored_energies(array.h))
    check_real_range(array, "the kinetic and strain energy", [energy], SUM_BITS)
    return energy


def stored_energies(h: Memory) -> tuple[float, float, float, float]:
    """Kinetic energy, and strain energy of contacts, of blocks and of structures."""
    kinds = soft(h)
    return (
        float(kinetic_energy(h, kinds)),
        float(contact_strain_energy(h)),
        float(strain_energy_of_blocks(h, kinds)),
        float(strain_energy_of_structures(h)),
    )


def _put_in(h: Memory, energy: float) -> float:
    """Input by commands so far. energy: stored now; ESTOR: stored before the last commands."""
    return float(h.cd[g.EPUT]) + (energy - float(h.cd[g.ESTOR]))
