"""Commands that cut blocks along curves and patterns (POLYLINE, ARC, TUNNEL, JSET, ...), merge and fill."""

from __future__ import annotations

from udec_ia.deck.command_forms import CHANGES, Command, Counts, Word

RANGE = "x1 x2 y1 y2"
JOINT, JMATERIAL, GLUED, KEEP = Word("JOINT", "n"), Word("JMATERIAL", "n"), Word("GLUED"), Word("KEEP")
OF_CUT = (JOINT, JMATERIAL, GLUED, KEEP)
WITHIN = Word("RANGE", RANGE, sets="within")
CUT_OFF = Counts("block", "cut off", none="no block was cut", of_all=True)
HOW = (
    "JOINT, JMATERIAL as of SPLIT; JMATERIAL alone takes a free number of a joint. GLUED: the cut does not "
    "weaken the rock. KEEP: ends inside blocks are kept for later cuts, and not dropped."
)

POLYLINE = Command(
    "POLYLINE",
    CHANGES,
    "Cut the blocks along the line from point to point. Its parts between two edges of a block cut it; a "
    "line that closes inside a block gets two glued slits to the next edges, left and right. " + HOW,
    "POLYLINE 10,-1 12,10 10,21",
    words=OF_CUT,
    list="x y",
    ours="the command",
    counts=CUT_OFF,
)
ARC = Command(
    "ARC",
    CHANGES,
    "Cut the blocks along an arc of n chords about (xc,yc), from (x1,y1) on by an angle in degrees, "
    "anticlockwise if it is positive. " + HOW,
    "ARC 10,10 8,10 180 12",
    numbers="xc yc x1 y1 angle n",
    words=OF_CUT,
    ours="the command",
    counts=CUT_OFF,
)
TUNNEL = Command(
    "TUNNEL",
    CHANGES,
    "Cut a circle of the radius r about (x,y), of n chords (24), as the outline of a tunnel; DELETE ... "
    "excavates it. " + HOW,
    "TUNNEL 10,10 3 32",
    numbers="x y r",
    optional="n",
    words=OF_CUT,
    ours="the command",
    counts=CUT_OFF,
)
JSET = Command(
    "JSET",
    CHANGES,
    "Cut a set of parallel joints: ANGLE from the x-axis in degrees, SPACING of the joints, TRACE, the "
    "length of a joint (endless without it), GAP from one to the next on a line; each with a deviation, "
    "within which numbers are drawn evenly by a generator with that SEED (1). A joint begins at ORIGIN. "
    "RANGE: joints end at the limits x1<x<x2, y1<y<y2. Joints that would leave too short an edge or too "
    "sharp an angle are left out and reported. " + HOW,
    "JSET ANGLE 30 2 SPACING 2 0.5 SEED=7",
    words=(
        Word("ANGLE", "a [da]"),
        Word("SPACING", "s [ds]"),
        Word("TRACE", "t [dt]"),
        Word("GAP", "g [dg]"),
        Word("ORIGIN", "x y"),
        Word("SEED", "n"),
        WITHIN,
        *OF_CUT,
    ),
    first="angle",
    ours="the command",
    counts=CUT_OFF,
)
VORONOI = Command(
    "VORONOI",
    CHANGES,
    "Cut the blocks into Voronoi cells with edges of about e, from points that a generator with that SEED "
    "(1) draws; RANGE: those in x1<x<x2, y1<y<y2, whose limits are cut too. " + HOW,
    "VORONOI EDGE=0.5 SEED=3",
    words=(Word("EDGE", "e"), Word("SEED", "n"), WITHIN, *OF_CUT),
    first="edge",
    ours="the command",
    counts=CUT_OFF,
)
BRICKS = Command(
    "BRICKS",
    CHANGES,
    "Cut bricks of the LENGTH b and HEIGHT h in running bond in x1<x<x2, y1<y<y2, from (x1,y1) on. OFFSET: "
    "part of a brick by which every second course is moved (0.5). BED, HEAD: joint materials of bed and "
    "head joints. The limits of the range are cut too.",
    "BRICKS 0 4 0 3 LENGTH=0.25 HEIGHT=0.125 BED=1 HEAD=2",
    numbers=RANGE,
    words=(
        Word("LENGTH", "b"),
        Word("HEIGHT", "h"),
        Word("OFFSET", "f"),
        Word("BED", "n"),
        Word("HEAD", "n"),
    ),
    ours="the command",
    counts=CUT_OFF,
)
VOUSSOIRS = Command(
    "VOUSSOIRS",
    CHANGES,
    "Cut an arch of n stones out of a block: the inner line is an arc from (x1,y) to (x2,y) of that RISE, "
    "or of that RADIUS, the outer one is THICKNESS away, and the joints are radial.",
    "VOUSSOIRS 2 8 3 15 RISE=2 THICKNESS=0.6",
    numbers="x1 x2 y n",
    words=(Word("RISE", "h"), Word("RADIUS", "r"), Word("THICKNESS", "t"), *OF_CUT),
    ours="the command",
    counts=CUT_OFF,
)
FRACTURES = Command(
    "FRACTURES",
    CHANGES,
    "Cut along the lines in a file: CSV with the columns x1, y1, x2, y2 and perhaps joint, or GeoJSON with "
    "LineStrings or Polygons, and perhaps a property joint. Lines that would leave too short an edge or too "
    "sharp an angle are left out and reported. Relative names start in the folder of the deck. GLUED is "
    "for lines without a joint. KEEP: ends inside blocks are kept for later cuts.",
    "FRACTURES mapped.csv",
    words=(GLUED, KEEP),
    text="path",
    needs_text=True,
    ours="the command",
    counts=CUT_OFF,
)
CUTS = (ARC, BRICKS, FRACTURES, JSET, POLYLINE, TUNNEL, VORONOI, VOUSSOIRS)
TIDY = Command(
    "TIDY",
    CHANGES,
    "Merge blocks smaller than the area a (m2) into the neighbour with which they have the longest joint. "
    "Before zones and cycles.",
    "TIDY 0.05",
    numbers="a",
    ours="the command",
)
FILL = Command(
    "FILL",
    CHANGES,
    "Put a block into the space between blocks around the point (x,y), such as an excavation. It has no "
    "stress, the outline of the space as it is now, and a material.",
    "FILL 10,10 MATERIAL=2",
    numbers="x y",
    words=(Word("Material", "n"), Word("Constitutive", "m")),
    ours="the command",
)
BREAKAGE = Command(
    "BREAKAGE",
    CHANGES,
    "Blocks with centroids in x1<x<x2, y1<y<y2 may crack from now on. TENSION, COHESION (Pa) and FRICTION (a "
    "tangent) are their strength; what is not given does not break them. Rigid blocks crack by tension "
    "between two opposed contact forces, deformable ones also by their stress (docs/cracking.md). SMALLEST: "
    "no part gets a smaller area (m2). JMATERIAL: joint material of the cracks. Parts may crack again. OFF: "
    "they do not crack any more. PRINT CRACKS lists the cracks of a run, PLOT CRACKS draws them.",
    "BREAKAGE 0 10 0 10 TENSION=5.E6 SMALLEST=0.1",
    numbers="x1 x2 y1 y2",
    words=(
        Word("ON", sets="state"),
        Word("OFF", sets="state"),
        Word("Tension", "t"),
        Word("Cohesion", "c"),
        Word("Friction", "f"),
        Word("SMALLEST", "a"),
        Word("JMATERIAL", "n"),
    ),
    ours="the command",
    counts=Counts("block", "in the range"),
)
