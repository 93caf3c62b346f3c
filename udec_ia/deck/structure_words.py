"""Commands and words for structures: SPROPERTY, BOLT, CABLE, BEAM, REMOVE, and words of PRINT."""

from __future__ import annotations

from udec_ia.deck.command_forms import CHANGES, LIMITS, Command, Counts, Word
from udec_ia.layout.field_table import read_table

SMATERIAL, SEGMENTS = Word("SMATERIAL", "n"), Word("SEGMENTS", "n")
PRETENSION = Word("PRETENSION", "f")
PRINTED_STRUCTURES = ("BOLTS", "ELEMENTS", "NODES")  # words of PRINT
SPROPERTIES = [Word(one.keyword, one.value, sets=one.argument) for one in read_table().structural_properties]
MADE = Counts("element", "made")

SPROPERTY = Command(
    "SPROPERTY",
    CHANGES,
    "Define structural material n, for 1 m of thickness: Young's modulus (Pa), area (m2/m) and second moment "
    "(m4/m) of the cross-section, density; the axial force (N/m) and the moment (N) at which it yields, and "
    "the plastic strain at which it breaks. Of a bolt: axial stiffness, if it is not YOUNG AREA/length, "
    "shear stiffness (N/m2) and strength (N/m). Of cables and beams: normal and shear stiffness (Pa/m), "
    "friction, cohesion and tensile strength (Pa) of grout or interface. What is not given is 0; YIELD, "
    "MOMENT, SHEAR and BREAK have no limit then. docs/structures.md has the formulas.",
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
    words=(SMATERIAL, PRETENSION),
    ours="the command",
)
CABLE = Command(
    "CABLE",
    CHANGES,
    "Put a grouted cable along the line from (x1,y1) to (x2,y2): SEGMENTS elements (10), whose nodes are "
    "joined to the blocks in which they are. SMATERIAL: its structural material (1). PRETENSION: axial "
    "force (N/m) that its elements begin with.",
    "CABLE 4,2 4,12 SMATERIAL=2 SEGMENTS=20",
    numbers="x1 y1 x2 y2",
    words=(SMATERIAL, SEGMENTS, PRETENSION),
    ours="the command",
    counts=MADE,
)
BEAM = Command(
    "BEAM",
    CHANGES,
    "Put a beam along the line from (x1,y1) to (x2,y2), a pile or a strut: SEGMENTS elements (10), whose "
    "nodes are joined to the blocks in which they are. AROUND: a lining instead, along the walls of the "
    "space between blocks around (x,y), with SEGMENTS elements on each edge (1); RANGE: along the longest "
    "part of them in the range. SMATERIAL: its structural material (1).",
    "BEAM AROUND 10,10 SMATERIAL=3 SEGMENTS=4",
    numbers="x1 y1 x2 y2",
    words=(
        Word("AROUND", "x y", replaces=True),
        SMATERIAL,
        SEGMENTS,
        Word("RANGE", LIMITS, sets="within"),
    ),
    ours="the command",
    counts=MADE,
)
REMOVE = Command(
    "REMOVE",
    CHANGES,
    "Take away the bolts and the elements of cables and beams whose middles are in x1<x<x2, y1<y<y2. BOLTS, "
    "CABLES, BEAMS: only these.",
    "REMOVE 0 10 4 6 BEAMS",
    numbers="x1 x2 y1 y2",
    words=(Word("BOLTS"), Word("CABLES"), Word("BEAMS")),
    ours="the command",
    counts=Counts("structure", "removed", none="no structure in range"),
)
