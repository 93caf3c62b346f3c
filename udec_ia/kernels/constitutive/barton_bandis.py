"""The joint model BARTON: closure that remembers the largest stress, and the strength of a rough joint.

    first loading            s = kni u/(1 - u/um1)
    unloading and reloading  s = kni (u - ur)/(1 - (u - ur)/um3)
    strength                 s tan(phi_r + JRC log10(JCS/s))

The closure ur remains without stress: both curves meet at the largest stress so far. um3 <= um1, so unloading
is the steeper one. The logarithm counts as at least 0, the whole angle as at most 70 degrees. Where its slope
reaches KNMAX a hyperbola goes on straight; without KNMAX where that is a million times kni. The joint has no
tensile strength. Shear stress grows by KS times the slip, up to the strength.

KCJV1 is the largest normal stress, Pa.

Sources: Bandis, Lumsden and Barton, Int. J. Rock Mech. Min. Sci. 20 (1983) 249-268 (closure); Barton and
Choubey, Rock Mechanics 10 (1977) 1-54 (strength); Brady and Brown, Rock mechanics for underground mining,
section 4.8.2 (unloading is a hyperbola too). All is calculated in 64 bits: differences of closures are small.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, putr, real
from udec_ia.kernels.constitutive.joint_materials import rounding_noise, set_flag
from udec_ia.layout import offsets as g

LARGEST_ANGLE = 70  # degrees
STEEPEST = 1000  # its square is the greatest slope of a hyperbola without KNMAX over its initial one


class Hyperbola(NamedTuple):
    """s = k u/(1 - u/greatest), up to `end` of the greatest closure; straight beyond that."""

    k: Any
    greatest: Any
    end: Any


@inlined
def _hyperbola(h: Memory, m: int, of_first_loading: bool) -> Hyperbola:
    """The curve of joint material m + 1 in its first loading, or in later ones, from closure 0."""
    k, steepest = np.float64(h.cr[g.JMKNI + m]), np.float64(h.cr[g.JMKN2 + m])
    greatest = np.float64(h.cr[g.JMUM1 + m] if of_first_loading else h.cr[g.JMUM3 + m])
    return Hyperbola(k, greatest, 1 - (np.sqrt(k / steepest) if steepest > 0 else np.float64(1) / STEEPEST))


@inlined
def _stress_at_end(curve: Hyperbola) -> Any:
    return curve.k * curve.greatest * curve.end / (1 - curve.end)


@inlined
def _steepness(curve: Hyperbola) -> Any:
    """Slope of the straight part, Pa/m."""
    return curve.k / ((1 - curve.end) * (1 - curve.end))


@kernel
def stress_of_hyperbola(curve: Hyperbola, u: float) -> float:
    """Normal stress at the closure `u`, not below 0."""
    part = max(u, np.float64(0)) / curve.greatest
    if part <= curve.end:
        return curve.k * curve.greatest * part / (1 - part)
    return _stress_at_end(curve) + _steepness(curve) * (u - curve.end * curve.greatest)


@kernel
def closure_of_hyperbola(curve: Hyperbola, sn: float) -> float:
    """Closure under the normal stress `sn`; tension: along the initial slope."""
    more = sn - _stress_at_end(curve)
    if more <= 0:
        return sn / (curve.k + max(sn, np.float64(0)) / curve.greatest)
    return curve.end * curve.greatest + more / _steepness(curve)


@inlined
def _permanent_closure(h: Memory, m: int, largest: float) -> Any:
    """The closure ur that remains without stress after the stress `largest`."""
    first = closure_of_hyperbola(_hyperbola(h, m, True), largest)
    return first - closure_of_hyperbola(_hyperbola(h, m, False), largest)


@kernel
def remember_stress(h: Memory, ix: int, sn: float) -> None:
    """Joint `ix` has reached the normal stress `sn`."""
    putr(h, ix, g.KCJV1, max(getr(h, ix, g.KCJV1), sn))


@kernel
def barton_closure(h: Memory, ix: int, m: int, sn: float) -> float:
    """Closure of joint `ix` of joint material m + 1 under the normal stress `sn`."""
    stress = np.float64(sn)
    closure = closure_of_hyperbola(_hyperbola(h, m, False), stress)
    return real(h, _permanent_closure(h, m, max(np.float64(getr(h, ix, g.KCJV1)), stress)) + closure)


@kernel
def barton_stiffness(h: Memory, m: int, sn: float) -> float:
    """Normal stiffness under the normal stress `sn`: the slope of unloading, which is the steeper one."""
    curve, stress = _hyperbola(h, m, False), max(np.float64(sn), np.float64(0))
    factor = 1 + stress / (curve.k * curve.greatest)
    return real(h, min(curve.k * factor * factor, _steepness(curve)))


@kernel
def barton_energy(h: Memory, m: int, sn: float) -> float:
    """Energy (J/m2) that unloading from the normal stress `sn` gives back."""
    curve, stress = _hyperbola(h, m, False), np.float64(sn)
    end = _stress_at_end(curve)
    part = min(closure_of_hyperbola(curve, stress) / curve.greatest, curve.end)
    energy = curve.k * curve.greatest * curve.greatest * (-math.log1p(-part) - part)
    if stress > end:
        energy += (stress * stress - end * end) / (2 * _steepness(curve))
    return real(h, energy)


@kernel
def barton_friction(h: Memory, m: int, sn: float) -> float:
    """Shear strength over the normal stress `sn`."""
    angle, largest = math.atan(np.float64(h.cr[g.JMMU + m])), math.radians(LARGEST_ANGLE)
    if sn > 0:
        ratio = max(np.float64(h.cr[g.JMJCS + m]) / np.float64(sn), np.float64(1))
        angle += np.float64(h.cr[g.JMJRC + m]) * math.radians(math.log10(ratio))
        largest = min(angle, largest)
    return real(h, math.tan(largest))


@kernel
def barton_joint(h: Memory, ix: int, m: int, closure: float, sliding: float) -> tuple[float, float]:
    """Stresses of joint `ix` of joint material m + 1 after a step, as of joint_stresses."""
    zero, u, largest = real(h, 0.0), np.float64(closure), np.float64(getr(h, ix, g.KCJV1))
    first = _hyperbola(h, m, True)
    if u > closure_of_hyperbola(first, largest):
        sn = real(h, stress_of_hyperbola(first, u))
        putr(h, ix, g.KCJV1, sn)
    else:
        later = _hyperbola(h, m, False)
        sn = real(h, stress_of_hyperbola(later, u - _permanent_closure(h, m, largest)))
    slip, held, ks = getr(h, ix, g.KCJSLIP), getr(h, ix, g.KCJTS), h.cr[g.JMKS + m]
    if sn <= zero:
        if closure < -rounding_noise(h):
            set_flag(h, ix, g.JOINT_BROKEN)
        putr(h, ix, g.KCJSLIP, slip + held / ks)
        return zero, zero
    trial, limit = held + ks * sliding, sn * barton_friction(h, m, sn)
    if abs(trial) <= limit:
        return sn, trial
    set_flag(h, ix, g.JOINT_SLIPPED | g.JOINT_SLIPS)
    ts = limit if trial > zero else -limit
    putr(h, ix, g.KCJSLIP, slip + (trial - ts) / ks)
    return sn, ts
