"""Symmetric tensors in the plane, as three numbers 11, 12, 22, and their rotation."""

from __future__ import annotations

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined
from udec_ia.heap.accessors import Memory, real

ROUND = 1e-6  # of a moment: if principal moments differ by less, last digits would determine the axes


@inlined
def cayley(h: Memory, angle: float) -> tuple[float, float]:
    """Cosine and sine of the rotation whose half angle has the tangent `angle`/2: orthogonal to rounding."""
    one, half = real(h, 1.0), angle * real(h, 0.5)
    below = one + half * half
    return (one - half * half) / below, (half + half) / below


@inlined
def rotated(s11: float, s12: float, s22: float, c: float, s: float) -> tuple[float, float, float]:
    """The tensor rotated anticlockwise by the angle with cosine `c` and sine `s`."""
    cc, cs, ss = c * c, c * s, s * s
    t = cs * (s12 + s12)
    return cc * s11 - t + ss * s22, cs * (s11 - s22) + (cc - ss) * s12, ss * s11 + t + cc * s22


@inlined
def first_axis(h: Memory, s11: float, s12: float, s22: float) -> tuple[float, float]:
    """Cosine and sine of the angle from x to the first principal axis; 1 and 0 if every axis is principal."""
    one, half = real(h, 1.0), real(h, 0.5)
    along, across = (s11 - s22) * half, s12
    size = np.sqrt(along * along + across * across)
    if size <= real(h, ROUND) * (s11 + s22):
        return one, real(h, 0.0)
    if along >= 0:
        c = np.sqrt((one + along / size) * half)
        return c, across / (size * (c + c))
    s = np.sqrt((one - along / size) * half)
    return across / (size * (s + s)), s
