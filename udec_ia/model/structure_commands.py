"""Methods of Model for structures: SPROPERTY, BOLT, CABLE, BEAM, REMOVE."""

from __future__ import annotations

from typing import Unpack

from udec_ia.errors import UdecError
from udec_ia.layout.material import StructuralProperties
from udec_ia.layout.offsets import OF_BEAM, OF_CABLE
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import structure_command
from udec_ia.ops.common.number_limits import reals
from udec_ia.reader.group_ranges import range_of

SEGMENTS = 10  # elements of a line
KINDS = ("bolts", "cables", "beams")


@takes_keywords(StructuralProperties)
def sproperty(session: Session, smaterial: int, **values: Unpack[StructuralProperties]) -> None:
    """SPROPERTY: properties of a structural material; those not given stay as they are.

    Forces and stiffnesses are for 1 m of thickness: those of one bolt over the distance between bolts.

    Parameters
    ----------
    smaterial
        Its number, 1 to 50.
    values
        Properties by name, as `young` (Pa), `area` (m2), `density` (kg/m3) ... (docs/structures.md).

    Raises
    ------
    UdecError
        4, 10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.sproperty(1, young=2e11, area=5e-4)
    """
    session.ensure_ready()
    structure_command.set_structural_property(session.array, smaterial, **values)


def bolt(
    session: Session,
    x1: float,
    y1: float,
    x2: float,
    y2: float,
    *,
    smaterial: int = 1,
    pretension: float = 0.0,
) -> int:
    """BOLT: a bolt between two points in blocks.

    Parameters
    ----------
    x1, y1, x2, y2
        Its ends in m. Each belongs to the block in which it is.
    smaterial
        Number of its structural material.
    pretension
        Axial force in N/m that it begins with.

    Returns
    -------
    int
        Its address.

    Raises
    ------
    UdecError
        4, 26 outside all blocks or for a material without stiffness, or 28. Nothing is changed then.

    Examples
    --------
    >>> m.sproperty(1, young=2e11, area=5e-4)
    >>> m.bolt(1, 0.5, 1, 1.5) in m.table("bolt")["address"]
    True
    """
    session.ensure_ready(shapes=True)
    return structure_command.make_bolt(session.array, x1, y1, x2, y2, smaterial, pretension)


def cable(
    session: Session,
    x1: float,
    y1: float,
    x2: float,
    y2: float,
    *,
    segments: int = SEGMENTS,
    smaterial: int = 1,
    pretension: float = 0.0,
) -> int:
    """CABLE: a grouted cable between two points.

    Parameters
    ----------
    x1, y1, x2, y2
        Its ends in m. Its nodes in blocks are joined to them by grout.
    segments
        Number of elements.
    smaterial
        Number of its structural material.
    pretension
        Axial force in N/m that its elements begin with.

    Returns
    -------
    int
        The number of its elements.

    Raises
    ------
    UdecError
        4, 26 outside all blocks or for a material without stiffness or density, or 28. Nothing is changed.

    Examples
    --------
    >>> m.sproperty(1, young=2e11, area=5e-4, density=7850, kn=1e9, ks=1e9, cohesion=1e5)
    >>> m.cable(1, 0.2, 1, 1.8, segments=4)
    4
    """
    session.ensure_ready(shapes=True)
    line = structure_command.straight_line(session.array, (x1, y1, x2, y2), segments, OF_CABLE)
    return structure_command.make_line(session.array, line, smaterial, pretension)


def beam(
    session: Session,
    x1: float | None = None,
    y1: float | None = None,
    x2: float | None = None,
    y2: float | None = None,
    *,
    around: tuple[float, float] | None = None,
    within: tuple[float, float, float, float] | str | None = None,
    segments: int | None = None,
    smaterial: int = 1,
) -> int:
    """BEAM: a beam between two points, or a lining of a space.

    Parameters
    ----------
    x1, y1, x2, y2
        Ends in m of a pile or strut. Its nodes in blocks are joined to them.
    around
        Instead: a point in a space between blocks, whose walls are lined.
    within
        Of a lining: range x1, x2, y1, y2 (m) or words; the longest part of the walls in it is lined.
    segments
        Number of elements (10), of a lining on each edge of the walls (1).
    smaterial
        Number of its structural material.

    Returns
    -------
    int
        The number of its elements.

    Raises
    ------
    UdecError
        4, 7, 10, 18, 24, 26 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.sproperty(1, young=2e11, area=5e-3, inertia=2e-6, density=7850, kn=1e9, ks=1e9)
    >>> m.beam(1, 0.2, 1, 1.8, segments=4)
    4
    """
    session.ensure_ready(shapes=True)
    array, ends = session.array, (x1, y1, x2, y2)
    if around is None:
        if within is not None:
            raise UdecError(10, "a range without AROUND", "BEAM AROUND x y RANGE ...", parameter="within")
        if None in ends:
            raise UdecError(7, "the ends of the beam", "give x1 y1 x2 y2, or AROUND x y", parameter="x1")
        line = structure_command.straight_line(
            array, ends, SEGMENTS if segments is None else segments, OF_BEAM
        )
    else:
        if ends != (None,) * 4:
            raise UdecError(10, "AROUND and a line", "give one of them", parameter="around")
        limits = (within, None, None, None) if isinstance(within, str) else within
        where = None if limits is None else range_of(*limits)
        line = structure_command.lining(
            array, reals(2, around=around), where, 1 if segments is None else segments
        )
    return structure_command.make_line(array, line, smaterial, 0.0)


def remove(
    session: Session,
    x1: float | str,
    x2: float | None = None,
    y1: float | None = None,
    y2: float | None = None,
    *,
    bolts: bool = False,
    cables: bool = False,
    beams: bool = False,
) -> int:
    """REMOVE: take away structures.

    Parameters
    ----------
    x1, x2, y1, y2
        Range in m of the middles of bolts and elements, or words.
    bolts, cables, beams
        Which of them; without any of these words all.

    Returns
    -------
    int
        The number of bolts and elements.

    Raises
    ------
    UdecError
        10 or 28. Nothing is changed then.

    Examples
    --------
    >>> m.sproperty(1, young=2e11, area=5e-4)
    >>> m.bolt(1, 0.5, 1, 1.5) > 0
    True
    >>> m.remove("ALL")
    1
    """
    session.ensure_ready()
    chosen = [name for name, given in (("bolts", bolts), ("cables", cables), ("beams", beams)) if given]
    where = range_of(x1, x2, y1, y2)
    return structure_command.remove_structures(session.array, where, chosen or KINDS)
