"""States of the block system as arrays for drawing: outlines, contacts, domains, stresses and velocities."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from udec_ia.heap.accessors import HEAD, Memory, Offset, getr, iget, integers, size_of
from udec_ia.kernels.links.longer_groups import displacements_at, point_displacements_at
from udec_ia.layout import offsets as g
from udec_ia.reader.fracture_rows import cracks_made
from udec_ia.reader.joint_rows import joint_lines, joint_rows, normals_of_joints, stress_rows
from udec_ia.reader.list_walks import groups, kind_of, loop, members, point, reverse
from udec_ia.reader.structure_rows import structure_rows
from udec_ia.reader.water_rows import contact_flows, water_on_sides


@dataclass(frozen=True)
class Field:
    """Moving points (n), zones (k) and blocks without zones (l), which are the first l of the points.

    address, area (n,): of the point, and of its block in m2. place (m) and velocity (m/s): (n, 2). corners
    (k, 3): the points of each zone. stress (k + l, 3): s11, s12 and s22 in Pa of all zones, and then of the
    blocks without zones; NaN in rigid ones. moved (n, 2): displacements in m that the state has
    (DISPLACEMENTS), or None.
    """

    address: Any
    area: Any
    place: Any
    velocity: Any
    corners: Any
    stress: Any
    moved: Any = None

    @property
    def zone(self) -> Any:
        """Places of the corners of each zone, (k, 3, 2) in m."""
        return self.place[self.corners]

    @property
    def middle(self) -> Any:
        """Places to which the stresses belong, (k + l, 2) in m."""
        return self.in_blocks(self.place)

    def in_blocks(self, values: Any) -> Any:
        """Values of the points, (n, ...), as those of all zones and then of the blocks without zones."""
        without_zones = len(self.stress) - len(self.corners)
        return np.concatenate([values[self.corners].mean(axis=1), values[:without_zones]])


def field(h: Memory, shapes: Outlines) -> Field:
    """A copy of points and stresses of the present state, whose blocks have these outlines."""
    zoned = shapes.kind == g.MFDEF
    owners = np.flatnonzero(zoned)
    points = [[*members(h, ib, "gridpoint")] for ib in shapes.address[zoned].tolist()]
    zones = np.array([iz for ib in shapes.address[zoned].tolist() for iz in members(h, ib, "zone")], np.int64)
    block_of_point = np.repeat(owners, [*map(len, points)]).astype(np.int64)
    points_at = np.array([ig for one in points for ig in one], np.int64)
    hard = shapes.address[~zoned]
    address = np.concatenate([hard, points_at])
    order = np.argsort(address)
    zone_points = np.stack([integers(h, zones, g.KZG, i) for i in range(3)], axis=-1)
    stress = np.full((len(hard), 3), np.nan)
    simple = shapes.kind[~zoned] == g.MSDEF
    stress[simple] = reals(h, integers(h, hard[simple], g.KBEX), g.KS111, g.KS112, g.KS122)
    moved = None
    if h.ci[g.LDISP]:
        of_points = reals(h, point_displacements_at(h, points_at), g.KGDX, g.KGDY)
        moved = np.concatenate([reals(h, displacements_at(h, hard), g.KBDX, g.KBDY), of_points])
    return Field(
        address,
        np.concatenate([shapes.areas[~zoned], shapes.areas[block_of_point]]),
        np.concatenate([reals(h, hard, g.KX, g.KY), reals(h, points_at, g.KXG, g.KYG)]),
        np.concatenate([reals(h, hard, g.KXD, g.KYD), reals(h, points_at, g.KXDG, g.KYDG)]),
        order[np.searchsorted(address, zone_points, sorter=order)],
        np.concatenate([reals(h, zones, g.KZS11, g.KZS12, g.KZS22), stress]),
        moved,
    )


def reals(h: Memory, addresses: Any, *names: Offset) -> Any:
    """Fields of the groups at some addresses, as reals of 64 bits; names: along the last axis."""
    at = np.array(addresses, np.int64)
    return np.stack([_real(h, at, k) for k in names], axis=-1)


MOVE, LINE, CURVE, CLOSE = 1, 2, 4, 79  # path codes as in PostScript and matplotlib; CURVE is cubic
ARC_POINTS = 6  # points on an arc where a domain's polygon follows it


@dataclass(frozen=True)
class Outlines:
    """All blocks: n corners clockwise, block after block; the corners of block i are first[i]:first[i + 1].

    corner, centre: (n, 2) in m; radius: (n,) in m, not positive where a corner is sharp; rounding: DTOL in m;
    corner_address: (n,). centroid: (m, 2) in m; fixed, material, address and kind (head code): (m,).
    """

    corner: Any
    centre: Any
    radius: Any
    rounding: float
    corner_address: Any
    first: Any
    centroid: Any
    fixed: Any
    material: Any
    address: Any
    kind: Any

    @property
    def areas(self) -> Any:
        """Area of each block, (m,) in m2."""
        after = np.arange(1, len(self.corner) + 1)
        after[self.first[1:] - 1] = self.first[:-1]
        (x, y), (u, v) = self.corner.T, self.corner[after].T
        return np.add.reduceat(u * y - x * v, self.first[:-1]) / 2 if len(after) else np.zeros(0)


@dataclass(frozen=True)
class Contacts:
    """All contacts: place (n, 2) in m, force on block KB2 (n, 2) in N/m, virtual (n,), address (n,).

    link (n, 2, 2): the two corners that the contact belongs to, in m; of a virtual one all that is known.
    """

    place: Any
    force: Any
    virtual: Any
    link: Any
    address: Any


@dataclass(frozen=True)
class Joints:
    """The joints of all contacts but virtual ones: line (n, 3, 2) in m, rows (n,) of reader.joint_rows.

    blocks: addresses of KB1 and KB2, (n, 2). stress: rows (n,) of reader.joint_rows.stress_rows. water:
    pressure, saturation, flow and aperture on both sides of each, (n, 2), by these names; {} without water.
    """

    line: Any
    rows: Any
    blocks: Any
    stress: Any
    water: dict[str, Any]


@dataclass(frozen=True)
class Domain:
    """One domain: its polygon (k, 2) in m, anticlockwise around it, and whether it is the outer one."""

    address: int
    polygon: Any
    outer: bool


@dataclass(frozen=True)
class State:
    """The block system at one moment; contacts, domains, field, joints and structures where asked for.

    gravity: its acceleration along x and y, m/s2. structures: rows of reader.structure_rows. stage: its name
    if it is a stage, or "". cracks: rows of reader.fracture_rows, of those that runs have made.
    """

    cycle: int
    time: float
    outlines: Outlines
    contacts: Contacts | None = None
    domains: tuple[Domain, ...] = ()
    field: Field | None = None
    joints: Joints | None = None
    structures: Any = None
    stage: str = ""
    cracks: Any = None
    gravity: tuple[float, float] = (0.0, 0.0)

    def renumbered(self, moved: Any) -> State:
        """The same with new addresses: moved[old]. Groups that have gone have the address 0."""

        def new(one: Any) -> Any:
            return replace(one, address=moved[one.address].astype(np.int64))

        def new_rows(joints: Joints) -> Joints:
            rows = joints.rows.copy()
            rows["contact"] = moved[rows["contact"]]
            return replace(joints, rows=rows, blocks=moved[joints.blocks])

        return replace(
            self,
            outlines=replace(new(self.outlines), corner_address=moved[self.outlines.corner_address]),
            contacts=self.contacts and new(self.contacts),
            domains=tuple(new(domain) for domain in self.domains),
            field=self.field and new(self.field),
            joints=self.joints and new_rows(self.joints),
        )


def snapshot(
    h: Memory,
    contacts: bool = False,
    domains: bool = False,
    inside: bool = False,
    joints: bool = False,
    structures: bool = False,
    cracks: bool = False,
) -> State:
    """A copy of what can be drawn of the present state; inside: also points and stresses."""
    shapes = outlines(h)
    return State(
        int(h.ci[g.MCTOT]),
        float(h.cd[g.TIME]),
        shapes,
        contact_forces(h) if contacts else None,
        tuple(domain_polygons(h)) if domains else (),
        field(h, shapes) if inside else None,
        joint_results(h) if joints else None,
        structure_rows(h) if structures else None,
        cracks=cracks_made(h) if cracks else None,
        gravity=(float(h.cr[g.GRAVX]), float(h.cr[g.GRAVY])),
    )


def outlines(h: Memory, chosen: Sequence[int] | None = None) -> Outlines:
    """The outlines of all blocks, or of those chosen by address. Unsound if the heap cannot be walked."""
    blocks = np.array([*groups(h, "block")] if chosen is None else [*chosen], np.int64)
    corners, first = _clockwise(h, blocks)
    return Outlines(
        corner=reals(h, corners, g.KXP, g.KYP),
        centre=reals(h, corners, g.KXCP, g.KYCP),
        radius=_real(h, corners, g.KRAD),
        rounding=float(h.cr[g.DTOL]),
        corner_address=corners,
        first=first,
        centroid=reals(h, blocks, g.KX, g.KY),
        fixed=integers(h, blocks, g.KBFIX) != 0,
        material=integers(h, blocks, g.KMAT),
        address=blocks,
        kind=integers(h, blocks, HEAD),
    )


def _clockwise(h: Memory, blocks: Any) -> tuple[Any, Any]:
    """Corners of all blocks, clockwise, block after block, and where those of each block begin and end.

    All blocks are walked at once, a corner of each in a step; if that meets a broken list, one by one.
    """
    last = min(int(h.ci[g.MFREE]), len(h.ia) + 1) - size_of(h, g.NVCR)
    first = integers(h, blocks, g.KP)
    at, row = first, np.arange(len(blocks))
    rows, corners = [row[:0]], [at[:0]]
    while len(at):
        sound = len(corners) <= last and bool(((at >= 1) & (at <= last)).all())
        if not (sound and (integers(h, at, HEAD) == g.MCOR).all()):
            lists = [list(reverse(h, block))[::-1] for block in blocks.tolist()]  # Unsound, with the place
            return np.array([one for ring in lists for one in ring]), np.cumsum([0, *map(len, lists)])
        rows.append(row)
        corners.append(at)
        at = integers(h, at, g.KR)
        goes_on = at != first[row]
        at, row = at[goes_on], row[goes_on]
    every, turned = np.concatenate(rows[::-1]), np.concatenate(corners[::-1])
    order = np.argsort(every, kind="stable")
    return turned[order], np.searchsorted(every[order], np.arange(len(blocks) + 1))


def _real(h: Memory, addresses: Any, k: Offset) -> Any:
    return np.array(getr(h, addresses, k), np.float64)


def curves(o: Outlines) -> tuple[Any, Any, Any]:
    """Vertices (k, 2), path codes (k,) and block index (k,) of all outlines, with their corners rounded.

    An arc touches both edges at the distance DTOL from the corner (report 2.3). It is drawn as two cubic
    curves, which stay within 3e-4 of its radius. Concave corners, flat ones, and all corners when DTOL is 0
    are drawn as they are.
    """
    n = len(o.corner)
    index = np.arange(n)
    block = np.repeat(np.arange(len(o.first) - 1), np.diff(o.first))
    starts = index == o.first[block]
    ends = index == o.first[block + 1] - 1
    back = _unit(o.corner[np.where(starts, o.first[block + 1] - 1, index - 1)] - o.corner)
    ahead = _unit(o.corner[np.where(ends, o.first[block], index + 1)] - o.corner)
    d, r = o.rounding, o.radius[:, None]
    is_round = (o.radius > 0.0) & (d > 0.0)
    tangent_in, tangent_out = o.corner + d * back, o.corner + d * ahead
    middle = apex(o.corner, o.centre, o.radius)
    along = _unit(tangent_out - tangent_in)
    turn = 2.0 * np.arctan2(d, r)
    handle = r * (4.0 / 3.0) * np.tan(turn / 8.0)
    vertices = np.stack(
        [
            np.where(is_round[:, None], tangent_in, o.corner),
            tangent_in - handle * back,
            middle - handle * along,
            middle,
            middle + handle * along,
            tangent_out - handle * ahead,
            tangent_out,
            o.corner,
        ],
        axis=1,
    )
    codes = np.full((n, 8), CURVE)
    codes[:, 0] = np.where(starts, MOVE, LINE)
    codes[:, 7] = CLOSE
    keep = np.repeat(is_round[:, None], 8, axis=1)
    keep[:, 0] = True
    keep[:, 7] = ends
    return vertices[keep], codes[keep], np.repeat(block[:, None], 8, axis=1)[keep]


def apex(corner: Any, centre: Any, radius: Any) -> Any:
    """The middle of the arc of each corner, or the corner itself where it is sharp.

    Arrays: corner and centre (..., 2), radius (...).
    """
    r = radius[..., None]
    return np.where(r > 0.0, centre + r * _unit(corner - centre), corner)


def beside_corners(o: Outlines, i: int) -> Any:
    """Places inside block i beside its corners, each on the bisector of the corner's angle: (n, 2) in m.

    Their distance is a tenth of that to the centroid, and at most a third of that to the next corner.
    """
    part = slice(o.first[i], o.first[i + 1])
    corner = o.corner[part]
    ahead, behind = np.roll(corner, -1, axis=0) - corner, corner - np.roll(corner, 1, axis=0)
    along = _unit(ahead) + _unit(behind)
    inwards = _unit(np.stack([along[:, 1], -along[:, 0]], axis=-1))  # clockwise: the inside is on the right
    start = apex(corner, o.centre[part], o.radius[part])
    room = np.minimum(np.hypot(*ahead.T), np.hypot(*behind.T))
    step = np.minimum(0.1 * np.hypot(*(o.centroid[i] - start).T), room / 3.0)
    return start + step[:, None] * inwards


def _apex(h: Memory, corners: Any) -> Any:
    points = reals(h, corners, g.KXP, g.KYP), reals(h, corners, g.KXCP, g.KYCP)
    return apex(*points, _real(h, corners, g.KRAD))


def _unit(v: Any) -> Any:
    length = np.hypot(v[..., 0], v[..., 1])[..., None]
    return v / np.where(length > 0.0, length, 1.0)


def contact_forces(h: Memory) -> Contacts:
    """Places and forces of all contacts; a virtual contact has no force."""
    iads = np.array([*groups(h, "contact")], np.int64)
    virtual = integers(h, iads, g.KCCOD) == g.VIRTUAL
    normal = np.zeros((len(iads), 2))
    normal[~virtual] = normals_of_joints(h, iads[~virtual])
    tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=-1)
    fn, fs = _real(h, iads, g.KCFN)[:, None], _real(h, iads, g.KCFS)[:, None]
    return Contacts(
        place=reals(h, iads, g.KXC, g.KYC),
        force=fn * normal - fs * tangent,
        virtual=virtual,
        link=_apex(h, np.stack([integers(h, iads, g.KCP1), integers(h, iads, g.KCP2)], axis=1)),
        address=iads,
    )


def joint_results(h: Memory) -> Joints:
    """Lines, slip, opening, state and stresses of all joints, and their water."""
    rows = joint_rows(h)
    water: dict[str, Any] = {}
    if h.ci[g.LWATER]:
        water = {name: water_on_sides(h, rows["contact"], name) for name in ("pressure", "saturation")}
        pipes = contact_flows(h)
        for name in ("flow", "aperture"):
            water[name] = np.abs(pipes[name])[:, None].repeat(2, axis=1)
    blocks = np.stack([integers(h, rows["contact"], k) for k in (g.KB1, g.KB2)], axis=1)
    line = joint_lines(h, rows["contact"])
    lengths = np.hypot(*np.diff(line, axis=1).T).sum(axis=0)
    return Joints(line, rows, blocks, stress_rows(h, rows["contact"], lengths), water)


def domain_polygons(h: Memory) -> Iterator[Domain]:
    """All domains, as polygons along the rounded outlines of the blocks around them."""
    for domain in groups(h, "domain"):
        yield Domain(domain, np.array(list(_loop_points(h, domain))), domain == h.ci[g.IODPNT])


def _loop_points(h: Memory, domain: int) -> Iterator[tuple[float, float]]:
    """Points along the loop of a domain. A corner is the end of its arc (Fig. 7).

    Each step begins where the last one ended, but for a virtual contact: there the loop crosses to the other
    block, and back by the same way.
    """
    steps = list(loop(h, domain))
    for (before, block), (item, _) in zip([steps[-1], *steps[:-1]], steps, strict=True):
        previous, start = _place_on_block(h, before, block)
        corner, place = _place_on_block(h, item, block)
        yield start
        if corner:
            yield from _arc(
                h, corner, start if previous == corner else _tangent(h, corner, arriving=True), place
            )
        else:
            yield place


def _place_on_block(h: Memory, item: int, block: int) -> tuple[int, tuple[float, float]]:
    """The corner on whose arc the item is on its `block` (0 if on none), and the place of the item.

    The position of a virtual contact means nothing: the middle of its corner's arc is returned.
    """
    if kind_of(h, item) == "corner":
        rounded = getr(h, item, g.KRAD) > 0.0
        place = _tangent(h, item, arriving=False) if rounded else point(h, item, g.KXP, g.KYP)
        return item if rounded else 0, place
    first = iget(h, item, g.KB1) == block
    corner = iget(h, item, g.KCP1 if first else g.KCP2)
    code = iget(h, item, g.KCCOD)
    on_arc = getr(h, corner, g.KRAD) > 0.0 and code != (g.EDGE_CORNER if first else g.CORNER_EDGE)
    place = tuple(_apex(h, np.int64(corner))) if code == g.VIRTUAL else point(h, item, g.KXC, g.KYC)
    return corner if on_arc else 0, place


def _tangent(h: Memory, corner: int, arriving: bool) -> tuple[float, float]:
    """Where the arc of a corner begins (arriving along the block, clockwise) or ends.

    With the centre c, the corner p and m = c - p, they are p + (D^2 m -/+ D R Jm)/m.m, J a quarter turn.
    """
    x, y = point(h, corner, g.KXP, g.KYP)
    cx, cy = point(h, corner, g.KXCP, g.KYCP)
    d, r = float(h.cr[g.DTOL]), float(getr(h, corner, g.KRAD))
    mx, my = cx - x, cy - y
    mm = mx * mx + my * my
    along, across = d * d / mm, (-d if arriving else d) * r / mm
    return x + along * mx - across * my, y + along * my + across * mx


def _arc(
    h: Memory, corner: int, start: tuple[float, float], stop: tuple[float, float]
) -> Iterator[tuple[float, float]]:
    """Points on the arc of a corner, from `start` to `stop`."""
    cx, cy = point(h, corner, g.KXCP, g.KYCP)
    r = float(getr(h, corner, g.KRAD))
    first = np.arctan2(start[1] - cy, start[0] - cx)
    turn = (np.arctan2(stop[1] - cy, stop[0] - cx) - first + np.pi) % (2.0 * np.pi) - np.pi
    for angle in first + np.linspace(0.0, turn, ARC_POINTS):
        yield cx + r * float(np.cos(angle)), cy + r * float(np.sin(angle))
