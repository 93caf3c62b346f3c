"""Methods of Model for structures: SPROPERTY, BOLT."""

from __future__ import annotations

from typing import Unpack

from udec_ia.layout.material import StructuralProperties
from udec_ia.model.method_wrappers import takes_keywords
from udec_ia.model.model_session import Session
from udec_ia.ops.commands import structure_command


@takes_keywords(StructuralProperties)
def sproperty(session: Session, smaterial: int, **values: Unpack[StructuralProperties]) -> None:
    """SPROPERTY: properties of a structural material (docs/structures.md); those not given stay as they are.

    Forces and stiffnesses are for 1 m of thickness: those of one bolt over the distance between bolts.
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
    """BOLT: a bolt between two points in blocks. Returns its address.

    Parameters
    ----------
    x1, y1, x2, y2
        Its ends in m. Each belongs to the block in which it is.
    smaterial
        Number of its structural material.
    pretension
        Axial force in N/m that it begins with.

    Raises
    ------
    UdecError
        4, 26 outside all blocks or for a material without stiffness, or 28. Nothing is changed then.
    """
    session.ensure_ready(shapes=True)
    return structure_command.make_bolt(session.array, x1, y1, x2, y2, smaterial, pretension)
