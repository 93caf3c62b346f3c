"""Methods of Model that take several operations: CHANGE, GENERATE, DAMPING, and why a range has no block."""

from __future__ import annotations

from typing import Any, Unpack

from udec_ia.advice.input_warnings import (
    angular_momentum,
    check_joint_properties,
    check_new_material,
    check_spin,
    describe_inertia,
)
from udec_ia.advice.water_report import check_held, held_pressures
from udec_ia.errors import UdecError
from udec_ia.kernels.drive.damping_modes import MODES
from udec_ia.layout.material import JointProperties
from udec_ia.layout.offsets import DTOL, ICKPNT, NBLK
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import free_blocks
from udec_ia.ops.commands.boundary_command import number_of_conditions
from udec_ia.ops.commands.change_or_delete_blocks import change as change_blocks
from udec_ia.ops.commands.change_or_delete_blocks import delete as delete_blocks
from udec_ia.ops.commands.fill_space import fill as fill_space
from udec_ia.ops.commands.generate_zones import (
    NEAR,
    blocks_to_zone,
    generate_automatically,
    record_inertia,
)
from udec_ia.ops.commands.generate_zones import generate as generate_manually
from udec_ia.ops.commands.group_command import set_group
from udec_ia.ops.commands.joint_property_command import Between, change_joints, set_joint_property
from udec_ia.ops.commands.model_settings import set_damping, set_damping_mode
from udec_ia.ops.commands.split_blocks import why_uncut
from udec_ia.ops.common.block_ranges import NO_BLOCK_YET, blocks_in, limits_turned, why_no_block
from udec_ia.ops.common.number_limits import real, rows, whole
from udec_ia.printable_text import counted
from udec_ia.reader.group_ranges import limits_of_scene, range_of, read_range
from udec_ia.remark import Remark

CUTS = ("arc", "bricks", "fractures", "jset", "polyline", "tunnel", "voronoi", "voussoirs")


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
    """CHANGE: attributes of the blocks in the range. Returns their number.

    jmaterial: joint material of the contacts in the range instead, whose number is returned.
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
    """GROUP: the blocks that are in the range now are the group `name` from now on. Returns their number.

    where: four limits or words; without it these follow the name, as in "crown CIRCLE 0 5 2". Error 10 for an
    impossible name.
    """
    session.ensure_ready()
    first, *words = name.split(maxsplit=1)
    text = " ".join([*words, *map(str, where)])
    return set_group(session.array, first, read_range(text))


@takes_keywords(JointProperties)
def jproperty(
    session: Session,
    jmaterial: int,
    model: str | None = None,
    unit: str | None = None,
    between: Between | None = None,
    *,
    function: int | None = None,
    **values: Unpack[JointProperties],
) -> None:
    """JPROPERTY: define a joint material; what is not given stays as it is.

    model: "coulomb", "yielding", "barton", or "jl2" to "jl5" for your own law. unit: "length" (Pa/m, Pa),
    "ends" (the same, in the form of the report) or "contact" (N/m2, N/m) as in 1980. between: numbers of two
    block materials; joints between them have it. function: number of a FUNCTION that multiplies the given
    values from now on, of strengths only.
    """
    session.ensure_ready()
    set_joint_property(session.array, jmaterial, model, unit, between, function, **values)
    session.report_remarks(check_joint_properties(session.array, jmaterial, values))


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
    """GENERATE: divide blocks in the range into zones. Returns the address of the first of them, or 0.

    mode: "manual", with `gridpoints` and `zones`, divides the first block that has no zones; "automatic",
    with `edge` (m), all of them. graded: growth, x and y; the edge of a block is then `edge` plus growth
    times its distance (m) from (x, y). mixed: zones 1 and 2, 3 and 4 ... are pairs for mixed discretisation.
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
    spins = [angular_momentum(array, one) for one in blocks]
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
    for one, spin in zip(divided, spins, strict=False):
        session.report_remarks(check_spin(array, one, spin))
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
    """DELETE: remove the blocks whose centroids lie in the range. Returns their number.

    With "OUTSIDE x1 x2 y1 y2" those are removed that are not between these limits, and while cycling all
    that leave them; fixed blocks stay. function: number of a FUNCTION. The forces of the deleted blocks on
    others stay as loads that it multiplies.
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


def velocity(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    vx: float = 0.0,
    vy: float = 0.0,
    w: float = 0.0,
) -> int:
    """VELOCITY: throw the blocks in the range. Returns their number; fixed ones are left out.

    vx, vy: velocity of the centroid, m/s. w: angular velocity, rad/s, anticlockwise.
    """
    session.ensure_ready()
    return free_blocks.set_velocities(session.array, range_of(x1, x2, y1, y2), vx, vy, w)


def fill(session: Session, x: float, y: float, material: int = 1, constitutive: int = 1) -> int:
    """FILL: make a block without stress in the space around the point (x, y). Returns its address."""
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
    """Why `command`, a method that was given these numbers and has returned 0, found nothing."""
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


@takes_keywords(type("Modes", (), {"__annotations__": {one.argument: float | None for one in MODES}}))
def damping(
    session: Session,
    /,
    fcrit: float | None = None,
    freq: float | None = None,
    only: str | None = None,
    **modes: float | None,
) -> None:
    """DAMPING: Rayleigh damping of the fraction `fcrit` of critical at the frequency `freq` (Hz).

    only: "mass", "stiffness", or "internal" for the strain rates of simply-deformable blocks. Instead of
    these, one of the modes that lead to rest: local=f, combined=f, kinetic=True, adaptive=f.
    """
    session.ensure_ready(sound=False)
    asked = {one: modes.get(one.argument) for one in MODES}
    given = {one: f for one, f in asked.items() if f is not None and f is not False}
    if len(given) + (fcrit is not None or freq is not None or only is not None) != 1:
        advice = "fcrit and freq, or one of " + ", ".join(one.name for one in MODES)
        raise UdecError(7, "DAMPING takes one kind of damping", advice, parameter="fcrit")
    for mode, f in given.items():
        set_damping_mode(session.array, mode, float(f))
    if not given:
        if fcrit is None or freq is None:
            raise UdecError(7, "freq" if fcrit is not None else "fcrit", parameter="fcrit")
        set_damping(session.array, fcrit, freq, only.lower() if only else None)
