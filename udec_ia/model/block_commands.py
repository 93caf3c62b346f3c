"""Methods of Model that make, change and remove blocks, and why a range has none."""

from __future__ import annotations

from typing import Any

from udec_ia.advice.input_warnings import (
    angular_momentum,
    check_new_material,
    check_spins,
    describe_inertia,
)
from udec_ia.advice.water_report import check_held, held_pressures
from udec_ia.errors import UdecError
from udec_ia.layout.offsets import DTOL, ICKPNT, NBLK
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import free_blocks
from udec_ia.ops.commands.boundary_command import number_of_conditions
from udec_ia.ops.commands.change_or_delete_blocks import change as change_blocks
from udec_ia.ops.commands.change_or_delete_blocks import delete as delete_blocks
from udec_ia.ops.commands.corner_rounding import round_corners
from udec_ia.ops.commands.create_block import create
from udec_ia.ops.commands.fill_space import fill as fill_space
from udec_ia.ops.commands.generate_zones import (
    NEAR,
    blocks_to_zone,
    generate_automatically,
    record_inertia,
)
from udec_ia.ops.commands.generate_zones import generate as generate_manually
from udec_ia.ops.commands.group_command import set_group
from udec_ia.ops.commands.joint_property_command import change_joints
from udec_ia.ops.commands.split_blocks import why_uncut
from udec_ia.ops.common.block_ranges import NO_BLOCK_YET, blocks_in, limits_turned, why_no_block
from udec_ia.ops.common.number_limits import real, reals, rows, whole
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import limits_of_scene, range_of, read_range
from udec_ia.remark import Remark

CUTS = ("arc", "bricks", "fractures", "jset", "polyline", "tunnel", "voronoi", "voussoirs")


def block(session: Session, *xy: float, material: int = 1, constitutive: int = 1) -> int:
    """BLOCK: create a block.

    Parameters
    ----------
    xy
        Its corners x1, y1, x2, y2, ... in m, clockwise.
    material, constitutive
        Its numbers.

    Returns
    -------
    int
        Its address.

    Raises
    ------
    UdecError
        4, 5, 6, 8, 9, 14, 18 or 28. Nothing is changed then.

    Examples
    --------
    >>> address = m.block(3, 0, 3, 1, 4, 1, 4, 0, material=2)
    >>> address in m.table("block")["address"]
    True
    """
    if len(xy) % 2:
        raise UdecError(8, f"{counted(len(xy), 'coordinate')} given", "give x1, y1, x2, y2, ...")
    numbers = reals(len(xy), xy=xy)
    session.ensure_ready()
    return create(session.array, list(zip(numbers[::2], numbers[1::2], strict=True)), material, constitutive)


def round(session: Session, d: float) -> None:
    """ROUND: round every corner with a circle.

    Parameters
    ----------
    d
        Distance in m from the corner at which the circle touches both edges.

    Raises
    ------
    UdecError
        14 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.round(0.1)
    """
    session.ensure_ready()
    round_corners(session.array, d)


def change(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    type: str | None = None,
    material: int | None = None,
    constitutive: int | None = None,
    jmaterial: int | None = None,
) -> int:
    """CHANGE: attributes of the blocks in the range.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    type
        "rigid", "sdef" or "fdef".
    material, constitutive
        Their numbers.
    jmaterial
        Instead: joint material of the contacts in the range.

    Returns
    -------
    int
        The number of blocks, or of contacts.

    Raises
    ------
    UdecError
        4, 9, 10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.change(0, 2, 1, 2, type="sdef", material=2)
    1
    """
    session.ensure_ready()
    if jmaterial is not None:
        if (type, material, constitutive) != (None, None, None):
            raise UdecError(10, "JMATERIAL is for contacts", "give it alone", parameter="jmaterial")
        return change_joints(session.array, range_of(x1, x2, y1, y2), jmaterial)
    conditions = number_of_conditions(session.array.h)
    kind = None if type is None else str(type).lower()
    changed = change_blocks(session.array, range_of(x1, x2, y1, y2), kind, material, constitutive)
    if changed and material is not None:
        session.report_remarks(check_new_material(session.array, changed, material))
    warn_of_lost_conditions(session, conditions)
    return changed


def group(session: Session, name: str, *where: float | str) -> int:
    """GROUP: the blocks that are in the range now are a group from now on.

    Parameters
    ----------
    name
        The name of the group.
    where
        Four limits or words; without it these follow the name, as in "crown CIRCLE 0 5 2".

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        10 for an impossible name, or for the range. Nothing is changed then.

    Examples
    --------
    >>> m.group("top", 0, 2, 1, 2)
    1
    >>> m.change("GROUP top", material=2)
    1
    """
    session.ensure_ready()
    first, *words = name.split(maxsplit=1) or [""]
    text = " ".join([*words, *map(str, where)])
    return set_group(session.array, first, read_range(text))


def generate(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    mode: str = "automatic",
    gridpoints: list[tuple[float, float]] | None = None,
    zones: list[tuple[int, int, int]] | None = None,
    edge: float | None = None,
    graded: tuple[float, float, float] | None = None,
    mixed: bool = False,
) -> int:
    """GENERATE: divide blocks in the range into zones.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    mode
        "automatic", with `edge`, divides all blocks that have no zones; "manual", with `gridpoints` and
        `zones`, the first of them.
    gridpoints, zones
        Points (x, y) in m, and triples of their numbers; the last grid-point given is number 1.
    edge
        Length of edges in m, about.
    graded
        Growth, x and y: the edge of a block is then `edge` plus growth times its distance (m) from (x, y).
    mixed
        Zones 1 and 2, 3 and 4 ... are pairs for mixed discretisation.

    Returns
    -------
    int
        The address of the first of the blocks, or 0.

    Raises
    ------
    UdecError
        7, 10, 14, 22, 24, 25, 26, 28 or 33. Nothing is changed then.

    Examples
    --------
    >>> m.generate(0, 2, 1, 2, edge=1.0) in m.table("block")["address"]
    True
    """
    session.ensure_ready(shapes=True)
    session.forget_boxes()
    array = session.array
    points = [(x, y) for x, y in rows(2, gridpoints=gridpoints)]
    triples = [(whole(zones=i), whole(zones=j), whole(zones=k)) for i, j, k in rows(3, zones=zones)]
    conditions = number_of_conditions(array.h)
    where = range_of(x1, x2, y1, y2)
    blocks = blocks_to_zone(array, where)
    if not blocks and mode.lower() == "automatic":
        session.inform("all blocks in the range have zones already")
        return 0
    if not blocks:
        ib = blocks_in(array, where)[0]
        advice = "give a range with another block, or CHANGE it to RIGID first"
        raise UdecError(28, f"block@{ib} is already divided into zones", advice, group=ib)
    ib = blocks[0]
    spins = {one: angular_momentum(array, one) for one in blocks}
    if mode.lower() == "manual":
        if not points or not triples:
            raise UdecError(26, "GRIDPOINTS and ZONES are both needed", "GRIDPOINTS x y ... ZONES l m n ...")
        if edge is not None or graded is not None:
            raise UdecError(10, "EDGE is for AUTOMATIC zones", parameter="graded" if edge is None else "edge")
        for remark in generate_manually(array, ib, points, triples, NEAR * float(array.h.cr[DTOL]), mixed):
            session.tell(Remark("gridpoints-moved", remark))
    elif mode.lower() == "automatic":
        if points or triples:
            blamed = "gridpoints" if points else "zones"
            raise UdecError(10, f"{blamed.upper()} are for MANUAL zones", parameter=blamed)
        if edge is None:
            advice = "AUTOMATIC EDGE d makes zones with sides of about d"
            raise UdecError(7, "EDGE d", advice, parameter="mode")
        ((growth, x, y),) = rows(3, graded=[graded or (0.0, 0.0, 0.0)])
        session.inform(generate_automatically(array, blocks, real(edge=edge), growth, (x, y), mixed))
    else:
        raise UdecError(22, mode, "take manual or automatic", parameter="mode")
    warn_of_lost_conditions(session, conditions)
    divided = blocks if mode.lower() == "automatic" else [ib]
    session.report_remarks(describe_inertia(record_inertia(array, divided)), session.inform)
    session.report_remarks(check_spins(array, {one: spins[one] for one in divided}))
    return ib


def delete(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    *,
    function: int | None = None,
) -> int:
    """DELETE: remove the blocks in the range.

    With "OUTSIDE x1 x2 y1 y2" those are removed that are not between these limits, and while cycling all
    that leave them; fixed blocks stay.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of centroids, or words.
    function
        Number of a FUNCTION. The forces of the deleted blocks on others stay as loads that it multiplies.

    Returns
    -------
    int
        The number of blocks.

    Raises
    ------
    UdecError
        10, 19, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.split(1, 0.5, 1, 3)
    1
    >>> m.delete(1, 2, 1, 2)
    1
    """
    session.ensure_ready()
    session.forget_boxes()
    held = held_pressures(session.array)
    limits = limits_of_scene(x1) if function is None else None
    if limits is not None:
        deleted = free_blocks.delete_outside(session.array, *limits)
    else:
        deleted = delete_blocks(session.array, range_of(x1, x2, y1, y2), function)
    session.report_remarks(check_held(session.array, held))
    return deleted


def fill(session: Session, x: float, y: float, material: int = 1, constitutive: int = 1) -> int:
    """FILL: make a block without stress in a space between blocks.

    Parameters
    ----------
    x, y
        A point in the space, m.
    material, constitutive
        Numbers of the new block.

    Returns
    -------
    int
        Its address.

    Raises
    ------
    UdecError
        4, 9, 18, 24 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.bricks(0, 2, 1, 2, length=0.5, height=0.25)  # m; then one of them is taken away
    17
    >>> m.delete(0.9, 1.1, 1.3, 1.5)
    1
    >>> m.fill(1.0, 1.4) in m.table("block")["address"]
    True
    """
    session.ensure_ready(shapes=True)
    session.forget_boxes()
    return fill_space(session.array, x, y, material, constitutive)


def warn_of_lost_conditions(session: Session, before: int) -> None:
    """Warn if there are fewer than `before` boundary conditions now."""
    lost = before - number_of_conditions(session.array.h)
    if lost > 0:
        what = counted(lost, "boundary condition")
        verb, it = ("were", "them") if lost > 1 else ("was", "it")
        text = f"{what} {verb} removed together with the block or grid-point: give {it} again with BOUNDARY"
        session.tell(Remark("conditions-removed", text))


def why_none(session: Session, command: str, *numbers: Any) -> str:
    """Why a command has found nothing.

    Parameters
    ----------
    command
        Name of a method that has returned 0.
    numbers
        What it was given.

    Returns
    -------
    str
        The reason.

    Examples
    --------
    >>> m.split(5, 5, 6, 6)
    0
    >>> len(m.why_none("split", 5, 5, 6, 6)) > 0
    True
    """
    session.ensure_ready(shapes=command == "split")
    if command in CUTS:
        no_block = session.array.h.ci[NBLK] == 0
        return NO_BLOCK_YET if no_block else "no line runs from one edge of a block to another edge of it"
    if command == "group":
        return "no centroid lies in the range"
    if command == "remove":
        return "PRINT BOLTS ELEMENTS shows where they are"
    if command == "delete" and limits_of_scene(numbers[0]):
        return "all blocks are between the limits; those that leave them will be deleted"
    if numbers and isinstance(numbers[0], str):
        return f"nothing in the range {numbers[0]}"
    a, b, c, d = numbers[:4]
    if command == "split":
        kept = "; it is kept for later cuts" if session.array.h.ci[ICKPNT] else ""
        return why_uncut(session.array, session.split_boxes, a, b, c, d) + kept
    if command != "boundary":
        return why_no_block(session.array, (a, b, c, d))
    some = number_of_conditions(session.array.h)
    there = "PRINT BOUNDARIES shows where they are" if some else "there are none"
    return limits_turned((a, b, c, d)) or there
