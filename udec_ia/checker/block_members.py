"""Invariant 6: what belongs together names each other, and belongs to the same block.

Links between corners and grid-points are mutual, and a group names corners and grid-points of its own block.
Every corner of a block with zones has a grid-point, and no other has; a point of an edge is not rounded. The
zones fill their block: every side of a zone is that of one other zone, the other way round, or an edge of the
outline; every edge is such a side; every grid-point belongs to a zone. So the areas of the zones add up to
that of the outline, and if none is turned over (invariant 7) there is neither gap nor overlap.
"""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State, corner_before
from udec_ia.reader.field_reading import TABLE, Numbers, names

OF_BLOCK = ("corner", "gridpoint", "zone")  # kinds of groups that belong to a block
COUNTS = {"KFNG": "gridpoint", "KFNZ": "zone"}  # of an fdef group
KGP, *_ = names("corner", "backlink")
KCOR, *_ = names("gridpoint", "backlink")
KZG, *_ = names("zone", "triple")
KFMIX = "KFMIX"
MUTUAL = [  # kind and field, the kind that it leads to, and the field that leads back
    (group.name, field.name, str(field.target), back.name)
    for group in TABLE.groups
    for field in group.fields
    for back in (TABLE.group(str(field.target)).fields if field.role == "backlink" else ())
    if back.role == "backlink" and back.target == group.name
]

MASS_SHARE = 1e-3  # by which sums of masses may differ, for rounding in 32 bits


def check_members(state: State) -> None:
    """Invariant 6, and the counts of each block with zones (invariant 5)."""
    _check_mutual(state)
    _check_same_block(state)
    _check_counts(state)
    _check_zoned(state)
    _check_cover(state)


def _check_mutual(state: State) -> None:
    """Links back and forth between groups of two kinds."""
    for kind, name, target, back in MUTUAL:
        addresses, values = state.address[kind], state.column(kind, name)
        row = state.rows(target, values)
        answer = np.append(state.column(target, back), 0)[row]
        for k in np.flatnonzero((row >= 0) & (answer != addresses)):
            text = f"{name} of {kind}@{addresses[k]} is {values[k]}"
            state.report(6, f"{text}, but {back} of {target}@{values[k]} is {answer[k]}")


def block_of(state: State, kind: str) -> Numbers | None:
    """The block that each group of `kind` belongs to, or acts on; None if it has none, or two."""
    hosts = names(kind, "host")
    if kind in OF_BLOCK:
        return state.owner[kind]
    if kind == "block":
        return state.address[kind]
    return state.column(kind, hosts[0]) if len(hosts) == 1 else None


def _check_same_block(state: State) -> None:
    """Corners, grid-points and zones that a group names are those of its own block."""
    for kind, addresses in state.address.items():
        mine = block_of(state, kind)
        if mine is None or not len(addresses):
            continue
        for field in TABLE.group(kind).fields:
            if field.target not in OF_BLOCK or field.role not in ("member", "backlink", "triple"):
                continue
            for i in range(field.count):
                values = state.column(kind, field.name, i)
                row = state.rows(field.target, values)
                theirs = np.append(state.owner[field.target], 0)[row]
                for k in np.flatnonzero((row >= 0) & (theirs != mine)):
                    text = f"{field.name} of {kind}@{addresses[k]} is {values[k]}, a {field.target} of"
                    state.report(6, f"{text} block@{theirs[k]} and not of block@{mine[k]}")


def _check_counts(state: State) -> None:
    """The numbers of grid-points and zones that each block with zones says it has."""
    rows = state.rows("block", state.owner["fdef"])
    for name, kind in COUNTS.items():
        counts = state.column("fdef", name)
        owners = state.rows("block", state.owner[kind])
        of_blocks = np.bincount(owners[owners >= 0], minlength=len(state.address["block"]))
        there = of_blocks[rows]
        for k in np.flatnonzero(counts != there):
            text = f"{name} of fdef@{state.address['fdef'][k]} is {counts[k]}"
            state.report(5, f"{text}, but counting gives {there[k]}")


def zoned(state: State) -> Numbers:
    """Addresses of the blocks that have grid-points."""
    return np.unique(state.owner["gridpoint"])


def _check_zoned(state: State) -> None:
    owner = state.owner["corner"]
    with_zones = np.isin(owner, zoned(state))

    def has(k: int) -> str:
        return f"but block@{owner[k]} has {'' if with_zones[k] else 'no '}zones"

    state.report_rows(6, "corner", KGP, (state.column("corner", KGP) != 0) != with_zones, has)
    marked, at = state.column("gridpoint", "KGEDGE") == 1, state.column("gridpoint", KCOR)
    radius = np.append(state.column("corner", "KRAD"), 0)[state.rows("corner", at)]

    def stands(k: int) -> str:
        return f"but it stands at corner@{at[k]}, which is rounded" if at[k] else "but it is inside its block"

    state.report_rows(6, "gridpoint", "KGEDGE", marked & ((at == 0) | (radius != 0)), stands)


def _check_cover(state: State) -> None:
    zones, points = state.address["zone"], state.address["gridpoint"]
    if not len(zones) and not len(points):
        return
    triples = np.stack([state.column("zone", KZG, i) for i in range(3)], axis=1)
    rows = state.rows("gridpoint", triples)
    known = np.isin(state.owner["zone"], state.rings.block) & (rows >= 0).all(axis=1)
    zones, rows = zones[known], rows[known]
    n = len(points)
    start, end = rows.ravel(), np.roll(rows, -1, axis=1).ravel()
    side = start * n + end
    zone = np.repeat(np.arange(len(zones)), 3)
    order = np.argsort(side, kind="stable")
    for k in np.flatnonzero(side[order[1:]] == side[order[:-1]]):
        one, two = order[k], order[k + 1]
        line = f"the line from gridpoint@{points[start[one]]} to gridpoint@{points[end[one]]}"
        state.report(6, f"zone@{zones[zone[one]]} and zone@{zones[zone[two]]} lie on the same side of {line}")
    outline, corner = _outline(state)
    for k in np.flatnonzero(~np.isin(outline, side)):
        state.report(6, f"no zone stands on the edge that ends at corner@{corner[k]}")
    for k in np.flatnonzero(~np.isin(end * n + start, side) & ~np.isin(side, outline)):
        line = f"from gridpoint@{points[start[k]]} to gridpoint@{points[end[k]]}, which is no edge"
        state.report(6, f"zone@{zones[zone[k]]} has no neighbour beyond its side {line} of the block")
    alone = np.isin(state.owner["gridpoint"], state.rings.block)
    alone[start] = False
    for point in points[alone]:
        state.report(6, f"gridpoint@{point} belongs to no zone")
    _check_pairs(state)


def _outline(state: State) -> tuple[Numbers, Numbers]:
    """The edges of blocks with zones, as sides between grid-points, and the corner at the end of each."""
    rings = state.rings
    end = np.flatnonzero(~rings.contact)
    ends = [
        state.rows("gridpoint", state.read(rings.item[index], KGP)) for index in (corner_before(rings), end)
    ]
    known = (ends[0] >= 0) & (ends[1] >= 0)
    return (ends[0] * len(state.address["gridpoint"]) + ends[1])[known], rings.item[end][known]


def _check_pairs(state: State) -> None:
    """Zones that are pairs for mixed discretisation have a common side: four grid-points in all."""
    paired = state.owner["fdef"][state.column("fdef", KFMIX) == 1]
    rows = np.flatnonzero(np.isin(state.owner["zone"], paired))
    owner = state.owner["zone"][rows]
    new = np.flatnonzero(np.concatenate(([True], owner[1:] != owner[:-1]))) if len(rows) else rows
    place = np.arange(len(rows)) - np.repeat(new, np.diff(np.append(new, len(rows))))
    first = np.flatnonzero(place % 2 == 0)
    second = np.minimum(first + 1, len(rows) - 1)
    triples = np.stack([state.column("zone", KZG, i)[rows] for i in range(3)], axis=1)
    four = np.sort(np.hstack((triples[first], triples[second])), axis=1)
    distinct = 1 + np.count_nonzero(np.diff(four, axis=1), axis=1)
    for k in np.flatnonzero((distinct != 4) | (owner[first] != owner[second]) | (first == second)):
        zone = state.address["zone"][rows[first[k]]]
        state.report(6, f"{KFMIX} of block@{owner[first[k]]} is 1, but zone@{zone} is no pair with the next")


def check_point_masses(state: State) -> None:
    """Invariant 7: a grid-point has a third of the mass of each of its zones, a block that of its zones."""
    rows = np.stack([state.rows("gridpoint", state.column("zone", KZG, i)) for i in range(3)], axis=1)
    known = (rows >= 0).all(axis=1)
    mass, points = state.column("zone", "KZM")[known], len(state.address["gridpoint"])
    due = np.bincount(rows[known].ravel(), np.repeat(mass / 3, 3), points)
    _check_masses(state, "gridpoint", "KGPM", due, np.ones(points, bool))
    block = state.rows("block", state.owner["zone"][known])
    due = np.bincount(block[block >= 0], mass[block >= 0], len(state.address["block"]))
    _check_masses(state, "block", "KBM", due, np.isin(state.address["block"], zoned(state)))


def _check_masses(state: State, kind: str, field: str, due: Numbers, here: Numbers) -> None:
    """The masses of the groups `here` are those that their zones give them."""
    mass = state.column(kind, field)
    wrong = here & (np.abs(mass - due) > MASS_SHARE * np.maximum(np.abs(due), np.abs(mass)))
    state.report_rows(7, kind, field, wrong, lambda k: f"but its zones have the mass {due[k]}")


def check_zone_areas(state: State) -> None:
    """Invariant 7: no zone is flat or turned over, and grid-points are where their corners are."""
    x, y = (np.append(state.column("gridpoint", name), np.nan) for name in ("KXG", "KYG"))
    rows = [state.rows("gridpoint", state.column("zone", KZG, i)) for i in range(3)]
    (x1, x2, x3), (y1, y2, y3) = ([values[row] for row in rows] for values in (x, y))
    area = ((x3 - x1) * (y2 - y1) - (x2 - x1) * (y3 - y1)) / 2
    for k in np.flatnonzero(area <= 0):
        state.report(7, f"the area of zone@{state.address['zone'][k]}, clockwise, is {area[k]}: not positive")
    row = state.rows("gridpoint", state.column("corner", KGP))
    for corner, point, values in (("KXP", "KXG", x), ("KYP", "KYG", y)):
        here, there = state.column("corner", corner), values[row]
        for k in np.flatnonzero((row >= 0) & (here != there)):
            text = f"{corner} of corner@{state.address['corner'][k]} is {here[k]}"
            state.report(7, f"{text}, but {point} of its grid-point is {there[k]}")
