"""Invariant 7: the outlines of the blocks, taken apart once, and what holds for each alone.

Of all blocks whose lists are sound: clockwise corners p, the edge that ends at p with its length z, its
unit vector t (clockwise) and outward normal e = (-ty, tx), and the arc of p with centre c and radius r. All
is computed in 64 bits; what the heap says may differ by as much as its own reals can.

A point that GENERATE has put on an edge has an arc too: a circle of radius zero, however the edge is bent.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from udec_ia.inspect.check.groups import State
from udec_ia.inspect.reading import INDEX, Numbers
from udec_ia.kernels.geometry.contact_geometry import BLUNT
from udec_ia.kernels.geometry.shape import BULGE, FLAT, KEPT

ROUNDINGS = 8.0  # of the order of the roundings that one coordinate takes part in each time it is computed


@dataclass(frozen=True)
class Outlines:
    """The corners of all sound blocks, block by block, clockwise; arrays with one element for each corner.

    block: addresses of the blocks; first, count: where their corners stand; owner: index into `block`.
    corner: address; before, after: index of the neighbours. p, c: corner and circle centre (n x 2);
    r: radius; pointed: True for a point of an edge, by its grid-point. d: the rounding length; g: the slack
    between two contact codes; digit: relative rounding error of one real of the heap; cycles: in each the
    coordinates were rounded anew.
    """

    block: Numbers
    first: Numbers
    count: Numbers
    owner: Numbers
    corner: Numbers
    before: Numbers
    after: Numbers
    p: Numbers
    c: Numbers
    r: Numbers
    pointed: Numbers
    d: float
    g: float
    digit: float
    cycles: float

    @cached_property
    def low(self) -> Numbers:
        """Lower left of the box around the corners, for each block."""
        return np.asarray(np.minimum.reduceat(self.p, self.first))

    @cached_property
    def high(self) -> Numbers:
        """Upper right of it."""
        return np.asarray(np.maximum.reduceat(self.p, self.first))

    @cached_property
    def z(self) -> Numbers:
        """Length of the edge that ends at the corner."""
        return length(self.p - self.p.take(self.before, 0))

    @cached_property
    def t(self) -> Numbers:
        """Unit vector along the edge that ends at the corner."""
        return np.asarray((self.p - self.p.take(self.before, 0)) / self.z[:, None])

    def normal(self, j: Numbers) -> Numbers:
        """Outward normals of the edges that end at corners j."""
        return turned(self.t.take(j, 0))

    def outward(self, i: Numbers) -> Numbers:
        """A vector along the bisector of the two edges of each of corners i, outwards."""
        return np.asarray(self.normal(i) + self.normal(self.after[i]))

    @cached_property
    def arc(self) -> Numbers:
        """True for a corner that may touch edges and arcs of others."""
        return np.asarray((self.r > 0) | self.pointed)

    def rounded(self, k: Numbers) -> Numbers:
        """The rounded outline at corners k: start, middle and end of each arc (n x 3 x 2).

        A corner that touches nothing, a concave one above all, is sharp: others meet its two edges.
        """
        p, c, r = self.p.take(k, 0), self.c.take(k, 0), self.r[k]
        round_it = (r > 0)[:, None]
        outwards = p - c
        far = np.maximum(length(outwards), self.fine[k])
        top = np.where(round_it, c + (r / far)[:, None] * outwards, p)
        start = p - np.where(round_it, self.d * self.t.take(k, 0), 0.0)
        end = p + np.where(round_it, self.d * self.t.take(self.after[k], 0), 0.0)
        return np.stack((start, top, end), axis=1)

    def deepest(self, i: Numbers, inward: Numbers, on_edge: Numbers) -> Numbers:
        """The places of arcs i that are deepest along `inward`; on an edge a blunt one has an end."""
        blunt = on_edge & (self.r[i] > BLUNT * self.d)
        early, late = dot(inward, self.t.take(i, 0)) < 0, dot(inward, self.t.take(self.after[i], 0)) > 0
        found = np.asarray(self.c.take(i, 0) + self.r[i][:, None] * inward)
        for ends, along, reach in (
            (blunt & late, self.after, self.d),
            (blunt & early & ~late, np.arange(len(self.p)), -self.d),
        ):
            k = i[ends]
            found[ends] = self.p.take(k, 0) + reach * self.t.take(along[k], 0)
        return found

    @cached_property
    def turn(self) -> Numbers:
        """Angle by which the outline turns clockwise at the corner; negative at a concave corner."""
        t, after = self.t, self.t.take(self.after, 0)
        return np.asarray(np.arctan2(-cross(t, after), dot(t, after)))

    @property
    def flat(self) -> Numbers:
        """Sine of the turn below which the corner is a point of a straight edge."""
        bulge = BULGE * self.d * (1 / self.z + 1 / self.z[self.after])
        return np.minimum(bulge, FLAT) * np.where(self.r != 0, KEPT, 1.0)

    @cached_property
    def fine(self) -> Numbers:
        """What the heap's reals may be off in a length that follows from the coordinates as they are."""
        size = np.maximum(np.abs(self.p).max(axis=1), np.maximum(np.abs(self.c).max(axis=1), np.abs(self.r)))
        return np.asarray(np.maximum.reduceat(size, self.first)[self.owner] * self.digit * ROUNDINGS)

    @cached_property
    def slack(self) -> Numbers:
        """What a coordinate of the corner, or of its circle, may have gone off against the others.

        It grows with the square root of the number of cycles, for each rounds anew, and with their number,
        for a block that spins steadily rounds the same way in each.
        """
        return np.asarray(self.fine * (np.sqrt(self.cycles) + self.cycles / ROUNDINGS))

    def rounding(self, i: Numbers, j: Numbers) -> Numbers:
        """What the heap's reals may be off in a length between corners i and j."""
        return np.asarray(2 * np.maximum(self.fine[i], self.fine[j]))

    def apart(self, i: Numbers, j: Numbers) -> Numbers:
        """The least gap between corners i and j that counts: their rounding, but never more than GTOL."""
        return np.minimum(self.rounding(i, j), self.g)

    @cached_property
    def start(self) -> Numbers:
        """How far from its start the edge that ends at the corner is free of the rounding before it."""
        return np.where(self.r[self.before] > 0, self.d, 0.0)

    @cached_property
    def end(self) -> Numbers:
        """Where along the edge that ends at the corner its rounding begins."""
        return self.z - np.where(self.r > 0, self.d, 0.0)

    def straight(self, j: Numbers) -> tuple[Numbers, Numbers]:
        """Start and end of the straight parts of the edges that end at corners j."""
        start, t = self.p.take(self.before[j], 0), self.t.take(j, 0)
        return start + self.start[j][:, None] * t, start + self.end[j][:, None] * t

    @cached_property
    def boxes(self) -> list[tuple[Numbers, Numbers]]:
        """Least and greatest x, and y, of the straight parts of all edges."""
        ends = [end.T for end in self.straight(np.arange(len(self.p)))]
        return [(np.minimum(one, two), np.maximum(one, two)) for one, two in zip(*ends, strict=True)]


def dot(a: Numbers, b: Numbers) -> Numbers:
    """Scalar products of two arrays of plane vectors."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1])


def length(a: Numbers) -> Numbers:
    """Lengths of plane vectors. Their squares are numbers: `outlines` sees to that."""
    return np.asarray(np.sqrt(dot(a, a)))


def cross(a: Numbers, b: Numbers) -> Numbers:
    """Vector products of two arrays of plane vectors."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def turned(a: Numbers) -> Numbers:
    """Plane vectors turned by 90 degrees anticlockwise."""
    return np.stack((-a[:, 1], a[:, 0]), axis=1)


def outlines(state: State) -> Outlines | None:
    """The outlines of the blocks with closed lists and finite coordinates; None if there are none."""
    rings = state.rings
    corners = rings.item[~rings.contact]
    if not len(corners):
        return None
    rows = rings.row[~rings.contact]

    def column(*fields: str) -> Numbers:
        return np.stack([state.column("corner", name)[rows] for name in fields], axis=1)

    p, c, r = column("KXP", "KYP"), column("KXCP", "KYCP"), column("KRAD")[:, 0]
    usable = (np.abs(np.column_stack((p, c, r))) < np.sqrt(np.finfo(state.h.cr.dtype).max)).all(axis=1)
    count = np.add.reduceat(~rings.contact, rings.first, dtype=INDEX)
    sound = np.logical_and.reduceat(usable, np.cumsum(count) - count) & (count > 2)
    if not sound.any():
        return None
    kept = np.repeat(sound, count)
    on_edge = np.append(state.column("gridpoint", "KGEDGE"), 0) == 1  # one more, for row -1
    grid_point = state.rows("gridpoint", state.column("corner", "KGP")[rows])
    block, count = rings.block[sound], count[sound]
    first = np.cumsum(count, dtype=INDEX) - count
    owner = np.repeat(np.arange(len(block), dtype=INDEX), count)
    here = np.arange(len(owner), dtype=INDEX)
    last = first + count - 1
    return Outlines(
        block=block,
        first=first,
        count=count,
        owner=owner,
        corner=corners[kept],
        before=np.where(here == first[owner], last[owner], here - 1),
        after=np.where(here == last[owner], first[owner], here + 1),
        p=p[kept],
        c=c[kept],
        r=r[kept],
        pointed=on_edge[grid_point[kept]],
        d=state.tolerance("DTOL"),
        g=state.tolerance("GTOL"),
        digit=float(np.finfo(state.h.cr.dtype).eps),
        cycles=1.0 + max(state.common("MCTOT"), 0),
    )


def check_outlines(state: State, o: Outlines) -> None:
    """Invariant 7: areas are positive, corners are rounded as DTOL says, edges hold their roundings.

    Blocks that deform may shorten their edges until the roundings overlap by FTOL: a flat part shorter than
    that is none to the program. Beyond it error 14 ends the run.
    """
    if not o.d > 0:
        state.report(7, f"DTOL is {o.d}, but there are blocks")
        return
    from_first = o.p - o.p.take(o.first[o.owner], 0)
    area = np.add.reduceat(cross(from_first, from_first[o.before]), o.first) / 2
    for i in np.flatnonzero(~(area > 0)):
        state.report(
            7, f"the area inside the corners of block@{o.block[i]}, clockwise, is {area[i]}: not positive"
        )
    rows = state.rows("block", o.block)
    roundings = 2.0 - o.pointed - o.pointed[o.before]
    room, shortest = roundings * o.d, roundings * (o.d - state.tolerance("FTOL") / 2)
    for i in np.flatnonzero(~(o.z >= shortest - 2 * o.slack)):
        state.report(
            7,
            f"the edge from corner@{o.corner[o.before[i]]} to corner@{o.corner[i]} "
            f"of block@{o.block[o.owner[i]]} is {o.z[i]} long, "
            f"too short for its roundings, which take {room[i]}",
        )
    _check_circles(state, o)
    centroid = np.stack((state.column("block", "KX")[rows], state.column("block", "KY")[rows]), axis=1)
    far = reaches(o, centroid)
    noted = state.column("block", "KBRO")[rows]
    for i in np.flatnonzero(np.abs(far - noted) > 2 * o.slack[o.first]):
        state.report(
            7, f"KBRO of block@{o.block[i]} is {noted[i]}, but a corner is {far[i]} from the centroid"
        )


def circles(o: Outlines) -> tuple[Numbers, Numbers]:
    """Centre and radius of the circle that each corner's edges ask for: D tan(theta/2).

    A flat corner and a point of an edge have none: radius 0, and the corner itself.
    """
    bent = (np.abs(np.sin(o.turn)) >= o.flat) & ~o.pointed
    radius = np.where(bent, o.d / np.tan(o.turn / 2), 0.0)
    reach = np.where(radius == 0, 0.0, o.d)
    return o.p - reach[:, None] * o.t - radius[:, None] * turned(o.t), radius


def reaches(o: Outlines, centroid: Numbers) -> Numbers:
    """Distance of the farthest corner of each block from its centroid."""
    return np.asarray(np.maximum.reduceat(length(o.p - centroid.take(o.owner, 0)), o.first))


def _check_circles(state: State, o: Outlines) -> None:
    """Centre and radius against those that the edges ask for.

    An edge is at least 2 D long, so an error s in its ends turns it by s/D and changes the radius by
    (1 + (R/D)^2)/2 times as much.
    """
    centre, radius = circles(o)
    slack = o.slack * (1 + (radius / o.d) ** 2)
    wrong = (np.abs(o.r - radius) > slack) | (np.abs(o.c - centre).max(axis=1) > slack)
    border = (np.abs(np.abs(np.sin(o.turn)) - o.flat) < o.slack / o.d) & ~o.pointed
    for i in np.flatnonzero(wrong & ~border):
        state.report(
            7,
            f"corner@{o.corner[i]} of block@{o.block[o.owner[i]]} has KXCP {o.c[i, 0]}, KYCP {o.c[i, 1]}, "
            f"KRAD {o.r[i]}, but its edges ask for {centre[i, 0]}, {centre[i, 1]}, {radius[i]}",
        )
