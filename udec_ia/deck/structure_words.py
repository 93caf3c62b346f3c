"""Commands and words for structures: SPROPERTY, BOLT, and words of PRINT and PLOT."""

from __future__ import annotations

from udec_ia.deck.command_forms import CHANGES, Command, Word
from udec_ia.layout.field_table import read_table

SMATERIAL = Word("SMATERIAL", "n")
PRINTED_STRUCTURES = ("BOLTS",)  # words of PRINT
SPROPERTIES = [Word(one.keyword, one.value, sets=one.argument) for one in read_table().structural_properties]

SPROPERTY = Command(
    "SPROPERTY",
    CHANGES,
    "Define structural material n, for 1 m of thickness: Young's modulus (Pa), area of the cross-section "
    "(m2/m); of a bolt axial stiffness, if it is not YOUNG AREA/length, and shear stiffness (N/m2); the axial "
    "force at which it yields, the shear strength (N/m), and the plastic strain at which it breaks. A "
    "strength that is not given has no limit. docs/structures.md has the formulas.",
    "SPROPERTY SMATERIAL=1 YOUNG=2.E11 AREA=5.E-4 YIELD=2.E5 KS=1.E7",
    words=(SMATERIAL, *SPROPERTIES),
    first="smaterial",
    ours="the command",
)
BOLT = Command(
    "BOLT",
    CHANGES,
    "Put a bolt between the points (x1,y1) and (x2,y2), which belong to the blocks there from now on: an "
    "axial spring, and a shear spring at its middle. SMATERIAL: its structural material (1). PRETENSION: "
    "axial force (N/m) that it begins with.",
    "BOLT 4,2 4,6 SMATERIAL=1 PRETENSION=5.E4",
    numbers="x1 y1 x2 y2",
    words=(SMATERIAL, Word("PRETENSION", "f")),
    ours="the command",
)
