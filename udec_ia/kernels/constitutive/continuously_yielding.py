"""The joint model YIELDING, continuously yielding: friction that decreases with plastic displacement.

    dsn = kn dun         kn = KN sn^NEXPONENT, between KNMIN and KNMAX
    dts = F ks dus       ks = KS sn^SEXPONENT, between KSMIN and KSMAX
    F = (1 - ts/tm)/(1 - r), from 0 to 1        tm = sn tan(phi_m) sign(dus)
    dphi_m = -(phi_m - phi)(1 - F)|dus|/R

r is ts/tm at the last reversal of slip, at most 0.75. Slip the other way is a reversal when it is longer
than 1e-6 R. phi_m begins with IFRICTION and tends to phi of FRICTION; R is ROUGHNESS. Shear stress is at most
|tm|. The joint has no tensile strength.

The normal stress is the exact integral of kn over the closure. (1 - F)|dus| is plastic; with its sum p,
phi_m = phi + (phi_i - phi) exp(-p/R). A step is one of the midpoint rule.

KCJV1   p, m
KCJV2   (1 - r) times the sign of the slip since the last reversal; 0 before the first slip
KCJV3   slip against that, m

Sources: Cundall and Hart, Analysis of block test no. 1, RHO report 1984; Brady and Brown, Rock mechanics for
underground mining, section 4.8.3. All is calculated in 64 bits.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, putr, real
from udec_ia.kernels.constitutive.joint_materials import rounding_noise, set_flag
from udec_ia.layout import offsets as g

LARGEST_RATIO = 0.75  # of r
REVERSAL = 1e-6  # slip that is a reversal over R
LARGEST = 150  # natural logarithm of a stress


class Stiffness(NamedTuple):
    """k = factor s^exponent from the stress `low` to the stress `high`; `lowest` below, `highest` above."""

    factor: Any
    exponent: Any
    lowest: Any
    highest: Any
    low: Any
    high: Any


@inlined
def _stress_of(ratio: float, exponent: float) -> float:
    """The stress s with s^exponent = ratio, within what a real can hold."""
    return math.exp(min(max(math.log(ratio) / exponent, -np.float64(LARGEST)), np.float64(LARGEST)))


@kernel
def _stiffness(factor: float, exponent: float, lowest: float, highest: float) -> Stiffness:
    """highest: 0 for no limit."""
    endless = np.float64(np.inf)
    limit = highest if highest > 0 else endless
    if exponent == 0:
        return Stiffness(factor, exponent, min(max(factor, lowest), limit), limit, endless, endless)
    low, high = _stress_of(lowest / factor, exponent), _stress_of(limit / factor, exponent)
    return Stiffness(factor, exponent, lowest, limit, low, high)


@inlined
def _normal_stiffness(h: Memory, m: int) -> Stiffness:
    """kn of joint material m + 1."""
    lowest, highest = np.float64(h.cr[g.JMKN1 + m]), np.float64(h.cr[g.JMKN2 + m])
    return _stiffness(np.float64(h.cr[g.JMKN + m]), np.float64(h.cr[g.JMEN + m]), lowest, highest)


@inlined
def _shear_stiffness(h: Memory, m: int) -> Stiffness:
    """ks of joint material m + 1."""
    lowest, highest = np.float64(h.cr[g.JMKS1 + m]), np.float64(h.cr[g.JMKS2 + m])
    return _stiffness(np.float64(h.cr[g.JMKS + m]), np.float64(h.cr[g.JMES + m]), lowest, highest)


@kernel
def _at_stress(k: Stiffness, sn: float) -> float:
    """Stiffness (Pa/m) under the normal stress `sn`."""
    if sn <= k.low:
        return k.lowest
    if sn >= k.high:
        return k.highest
    return k.factor * math.exp(k.exponent * math.log(sn))


@kernel
def _integral(k: Stiffness, power: int, sn: float) -> float:
    """Integral of s^power ds/k from 0 to `sn`. power: 0, the closure, or 1, the energy."""
    low = min(sn, k.low)
    total = (low if power == 0 else low * low / 2) / k.lowest
    if sn > k.low:
        q, ratio = power + 1 - k.exponent, math.log(min(sn, k.high) / k.low)
        grown = math.exp(q * math.log(k.low)) * math.expm1(q * ratio) / q if q != 0 else ratio
        total += grown / k.factor
    if sn > k.high:
        total += ((sn - k.high) if power == 0 else (sn * sn - k.high * k.high) / 2) / k.highest
    return total


@kernel
def _stress_at(k: Stiffness, u: float) -> float:
    """Normal stress at the closure `u`, not below 0."""
    more = u - k.low / k.lowest
    if more <= 0:
        return max(u, np.float64(0)) * k.lowest
    if k.high < np.inf:
        above = u - _integral(k, 0, k.high)
        if above > 0:
            return k.high + above * k.highest
    q = 1 - k.exponent
    if q == 0:
        return k.low * math.exp(k.factor * more)
    return k.low * math.exp(math.log1p(q * k.factor * more / math.exp(q * math.log(k.low))) / q)


@kernel
def yielding_closure(h: Memory, m: int, sn: float) -> float:
    """Closure of a joint of joint material m + 1 under the normal stress `sn`; tension: as at 0."""
    return real(h, _integral(_normal_stiffness(h, m), 0, np.float64(sn)))


@kernel
def yielding_stiffness(h: Memory, m: int, sn: float) -> tuple[float, float]:
    """Normal and shear stiffness under the normal stress `sn`, Pa/m."""
    stress = np.float64(sn)
    kn, ks = _at_stress(_normal_stiffness(h, m), stress), _at_stress(_shear_stiffness(h, m), stress)
    return real(h, kn), real(h, ks)


@kernel
def yielding_energy(h: Memory, m: int, sn: float, ts: float) -> tuple[float, float]:
    """Energy (J/m2) by closure and by shear: F is 1 behind a reversal."""
    stress, shear = np.float64(sn), np.float64(ts)
    of_shear = shear * shear / (2 * _at_stress(_shear_stiffness(h, m), stress))
    return real(h, _integral(_normal_stiffness(h, m), 1, stress)), real(h, of_shear)


@inlined
def _friction_after(h: Memory, m: int, plastic: float) -> float:
    """tan(phi_m) after the plastic displacement `plastic`, in 64 bits."""
    final, first = math.atan(np.float64(h.cr[g.JMMU + m])), math.atan(np.float64(h.cr[g.JMIMU + m]))
    return math.tan(final + (first - final) * math.exp(-plastic / np.float64(h.cr[g.JMR + m])))


@kernel
def yielding_friction(h: Memory, ix: int, m: int) -> float:
    """Shear strength over normal stress of joint `ix`: tan(phi_m)."""
    return real(h, _friction_after(h, m, np.float64(getr(h, ix, g.KCJV1))))


@inlined
def _elastic_part(way: float, ts: float, bound: float, rest: float) -> float:
    """F of a slip to the side `way`. rest: 1 - r. bound: |tm|."""
    zero, one = np.float64(0), np.float64(1)
    return min(max((1 - way * ts / bound) / rest, zero), one) if bound > 0 else zero


@kernel
def _rest_of_ratio(h: Memory, ix: int, m: int, sliding: float, ts: float, bound: float) -> float:
    """1 - r for the slip `sliding` of joint `ix`, after a reversal if that is one."""
    way, now = np.float64(1 if sliding > 0 else -1), np.float64(getr(h, ix, g.KCJV2))
    if now == 0:
        now = way
    if now * way > 0:
        putr(h, ix, g.KCJV3, real(h, 0.0))
    else:
        back = np.float64(getr(h, ix, g.KCJV3)) + abs(sliding)
        if back > np.float64(real(h, REVERSAL)) * np.float64(h.cr[g.JMR + m]):
            ratio = min(way * ts / bound, np.float64(real(h, LARGEST_RATIO))) if bound > 0 else np.float64(0)
            now, back = way * (1 - ratio), np.float64(0)
        putr(h, ix, g.KCJV3, back)
    putr(h, ix, g.KCJV2, now)
    return abs(now)


@kernel
def _slide(h: Memory, ix: int, m: int, normal: float, sliding: float, ks: float) -> float:
    """Shear stress of joint `ix` after the slip `sliding` under the mean normal stress `normal`."""
    ts, plastic = np.float64(getr(h, ix, g.KCJTS)), np.float64(getr(h, ix, g.KCJV1))
    bound = normal * _friction_after(h, m, plastic)
    rest = _rest_of_ratio(h, ix, m, sliding, ts, bound)
    way, length = np.float64(1 if sliding > 0 else -1), abs(sliding)
    part = _elastic_part(way, ts, bound, rest)
    bound = normal * _friction_after(h, m, plastic + (1 - part) * length / 2)
    part = _elastic_part(way, ts + part * ks * sliding / 2, bound, rest)
    putr(h, ix, g.KCJV1, plastic + (1 - part) * length)
    return ts + part * ks * sliding


@kernel
def yielding_joint(h: Memory, ix: int, m: int, closure: float, sliding: float) -> tuple[float, float]:
    """Stresses of joint `ix` of joint material m + 1 after a step, as of joint_stresses."""
    zero, slip, held = real(h, 0.0), getr(h, ix, g.KCJSLIP), getr(h, ix, g.KCJTS)
    sn = real(h, _stress_at(_normal_stiffness(h, m), np.float64(closure)))
    normal = (np.float64(getr(h, ix, g.KCJSN)) + np.float64(sn)) / 2
    ks = _at_stress(_shear_stiffness(h, m), normal)
    if sn <= zero:
        if closure < -rounding_noise(h):
            set_flag(h, ix, g.JOINT_BROKEN)
        putr(h, ix, g.KCJSLIP, slip + held / real(h, ks))
        putr(h, ix, g.KCJV2, zero)
        putr(h, ix, g.KCJV3, zero)
        return zero, zero
    ts = held
    if sliding != 0:
        ts = real(h, _slide(h, ix, m, normal, np.float64(sliding), ks))
    limit = sn * yielding_friction(h, ix, m)
    if abs(ts) > limit:
        set_flag(h, ix, g.JOINT_SLIPPED | g.JOINT_SLIPS)
        ts = limit if ts > 0 else -limit
    putr(h, ix, g.KCJSLIP, slip + sliding - (ts - held) / real(h, ks))
    return sn, ts
