"""The order of cuts by which a polygon falls into its faces: each cuts one face off what is left.

A face can be cut off if it shares one connected part of its outline with the rest, and meets it nowhere else.
There is always one. The cut is that part, from outline to outline.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from udec_ia.ops.cuts.block_division import Division, Reals


class Cut(NamedTuple):
    """A cut: its points (n, 2) and the joints (n - 1) of its parts. The face is to the right of it."""

    points: Reals
    joints: list[int]


def cuts_of(division: Division, joints: Sequence[int], slack: float) -> Iterator[Cut]:
    """The cuts that make all faces of the division but the last.

    joints: number of the joint of each curve, and last that of slits. Points on the straight line between
    those before and behind, to within `slack`, are left out.
    """
    rest = _Rest(division)
    while rest.count > 1:
        path = rest.cut_off()
        numbers = [joints[division.curve[min(i, j), max(i, j)]] for i, j in pairwise(path)]
        yield _straighten(division.points[path], numbers, slack)


class _Rest:
    """The faces that are not cut off yet."""

    def __init__(self, division: Division) -> None:
        self.rings = division.faces
        self.count = len(self.rings)
        self.gone = [False] * self.count
        self.face_of = {
            edge: k
            for k, ring in enumerate(self.rings)
            for edge in zip(ring, ring[1:] + ring[:1], strict=True)
        }
        self.at_outline: set[int] = set()
        self.faces_at: dict[int, list[int]] = {}
        for k, ring in enumerate(self.rings):
            for i in ring:
                self.faces_at.setdefault(i, []).append(k)
        for i, j in self.face_of:
            if (j, i) not in self.face_of:
                self.at_outline |= {i, j}
        self.next = deque(range(self.count))

    def cut_off(self) -> list[int]:
        """Remove a face; returns the points of the cut, with the face to the right."""
        for _ in range(2 * len(self.next) + len(self.rings)):
            k = self.next.popleft()
            path = None if self.gone[k] else self._path(k)
            if path is not None:
                self._remove(k, path)
                return path
            if not self.gone[k]:
                self.next.append(k)
        raise AssertionError("no face of the division can be cut off")

    def _path(self, k: int) -> list[int] | None:
        """The points at which face `k` meets the rest, if it can be cut off."""
        ring = self.rings[k]
        n = len(ring)
        inner = [(ring[(i + 1) % n], ring[i]) in self.face_of for i in range(n)]
        starts = [i for i in range(n) if inner[i] and not inner[i - 1]]
        if len(starts) != 1:
            return None
        first = starts[0]
        path = [ring[first]]
        for i in range(first, first + n):
            if not inner[i % n]:
                break
            path.append(ring[(i + 1) % n])
        inside = self.at_outline.isdisjoint(path[1:-1])
        outside = {*ring} - {*path}
        whole = all(self._is_alone(i, k) for i in outside)
        return path if inside and whole else None

    def _is_alone(self, i: int, k: int) -> bool:
        """True if no other face of the rest has point `i`."""
        return all(other == k or self.gone[other] for other in self.faces_at[i])

    def _remove(self, k: int, path: list[int]) -> None:
        ring = self.rings[k]
        for edge in zip(ring, ring[1:] + ring[:1], strict=True):
            del self.face_of[edge]
        self.gone[k] = True
        self.count -= 1
        self.at_outline.update(path)
        neighbours = {other for i in path for other in self.faces_at[i] if not self.gone[other]}
        self.next.extendleft(sorted(neighbours))


def _straighten(points: Reals, joints: list[int], slack: float) -> Cut:
    """Leave out points at which the cut does not turn, and the joint does not change."""
    kept = [0]
    for i in range(1, len(points) - 1):
        (ax, ay), (bx, by), (x, y) = points[kept[-1]], points[i + 1], points[i]
        off = abs((x - ax) * (by - ay) - (y - ay) * (bx - ax))
        goes_on = (bx - x) * (x - ax) + (by - y) * (y - ay) > 0
        straight = off <= slack * np.hypot(bx - ax, by - ay) and goes_on
        if not straight or joints[i - 1] != joints[i]:
            kept.append(i)
    kept.append(len(points) - 1)
    return Cut(points[kept], [joints[i] for i in kept[:-1]])
