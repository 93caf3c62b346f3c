"""The table of commands: every command of the deck language, its parameters and its help (Appendix I-1).

Parser, log, studies, HELP, suggestions and docs/commands.md follow from this table.
"""

from __future__ import annotations

from udec_ia.deck.command_forms import CHANGES, RUNS, SESSION, SEVERAL, SHOWS, Command, Counts, Word
from udec_ia.deck.cut_words import (
    ARC,
    BREAKAGE,
    BRICKS,
    FILL,
    FRACTURES,
    JSET,
    POLYLINE,
    TIDY,
    TUNNEL,
    VORONOI,
    VOUSSOIRS,
)
from udec_ia.deck.session_words import CALL, DEFAULT, PLOT, STAGE
from udec_ia.deck.structure_words import BEAM, BOLT, CABLE, PRINTED_STRUCTURES, REMOVE, SPROPERTY
from udec_ia.deck.study_words import (
    CHECK,
    DISPLACEMENTS,
    FOS,
    GEOMETRY,
    GROUP,
    INFO,
    RESET,
    SOLVE,
    VELOCITY,
)
from udec_ia.deck.water_words import FLOW, FLUID, OUTSIDE, PPRESSURE
from udec_ia.kernels.drive.damping_modes import MODES
from udec_ia.layout.field_table import read_table
from udec_ia.reader.recordable_numbers import QUANTITIES, recordable

MATERIAL = Word("Material", "n")
PROPERTIES = [
    Word(one.keyword, one.value, sets=one.argument if one.argument != one.keyword.lower() else "")
    for one in read_table().properties
    if one.keyword
]
CONSTITUTIVE = Word("Constitutive", "m")
JMATERIAL = Word("JMATERIAL", "n")
JPROPERTIES = [Word(one.keyword, one.value, sets=one.argument) for one in read_table().joint_properties]
FOLLOWS = Word("FUNCTION", "n")
BY_FORCE, UNCHECKED = Word("FORCE"), Word("UNCHECKED")
RANGE = "x1 x2 y1 y2"
PRINTED = (
    *("Blocks", "Contacts", "CORners", "Domains", "List", "DList", "Gridpoints", "Zones", "BOundaries"),
    *("ENErgy", "HIStories", "REActions", "FUnctions", "JOINTS", "WATER", "MAX", "CRACKS"),
    *PRINTED_STRUCTURES,
)
FIELDS = tuple(Word(name, sets="field") for name in recordable() if name not in map(str.upper, QUANTITIES))

COMMANDS = (
    ARC,
    BEAM,
    Command(
        "Block",
        CHANGES,
        "Create a rigid block with the corners (x,y), given clockwise. SPLIT cuts it. A further block may "
        "touch others; it must not overlap them.",
        "BLOCK MAT=2 0,0 0,40 60,40 60,0",
        words=(MATERIAL, CONSTITUTIVE),
        list="x y",
    ),
    Command(
        "BOundary",
        CHANGES,
        "Boundary conditions in x1<x<x2, y1<y<y2. Velocities and forces act on the grid-points and block "
        "centroids there. ROTATION (rad/s, anticlockwise) gives an angular velocity to the blocks with "
        "centroids there, and XVel and YVel are then those of the whole block, of every type: with all "
        "three it moves as a rigid body. Stresses act on the edges with both ends there, edges of joints "
        "included: tension is positive, stresses are those at x = 0 and y = 0, and XGrad and YGrad are "
        "their increases with x and y. Viscous makes those edges non-reflecting, with the present "
        "properties. A sine (frequency, duration) begins now; a FUNCTION depends on the time of the model. "
        "Either multiplies loads and velocities. Loads add to existing loads. A velocity replaces the "
        "previous one. A fixed block that gets a velocity moves with it as a whole, until FIX stops it. "
        "Water outside acts on exposed edges with both ends in the range: PPRESSURE with its gradients, or "
        "LEVEL, the height of its surface, loads them and is the pressure at their joints; FLOW is the flow "
        "(m2/s) into each joint there; IMPERMEABLE closes them. Elsewhere water only leaves, at the pressure "
        "0. FUNCTION multiplies pressure or flow. Free removes all conditions.",
        "BOUNDARY -1 61 39 41 STRESS 0 0 -1.E6",
        numbers=RANGE,
        words=(
            Word("XVel", "v"),
            Word("YVel", "v"),
            Word("ROTATION", "w"),
            Word("XForce", "f"),
            Word("YForce", "f"),
            Word("Stress", "s11 s12 s22"),
            Word("XGrad", "g11 g12 g22"),
            Word("YGrad", "g11 g12 g22"),
            Word("Viscous"),
            Word("SIne", "freq t"),
            Word("Function", "n"),
            *OUTSIDE,
            Word("FRee"),
        ),
        ours="the command, which the report lists under further developments",
        counts=Counts("condition", "in the range", none="no condition in range"),
    ),
    BOLT,
    BREAKAGE,
    BRICKS,
    Command(
        "Change",
        CHANGES,
        "Change type, material or constitutive number of the blocks with centroids in x1<x<x2, y1<y<y2. "
        "JMATERIAL: give the contacts in the range that joint material.",
        "CHANGE 0 60 30 40 MATERIAL=2",
        numbers=RANGE,
        words=(
            Word("Sdef", sets="type"),
            Word("Fdef", sets="type"),
            Word("Rigid", sets="type"),
            MATERIAL,
            CONSTITUTIVE,
            JMATERIAL,
        ),
        ours="Rigid; JMATERIAL",
        counts=Counts("block", "changed", with_word=("jmaterial", "contact")),
    ),
    CHECK,
    Command(
        "CYcle",
        RUNS,
        "Calculate n cycles, or cycles until the time of the model has grown by t: the last one reaches it, "
        "or goes beyond it by less than a step.",
        "CYCLE 300",
        numbers="n",
        words=(Word("TIME", "t", replaces=True),),
        ours="the command, which both example runs use; TIME",
    ),
    Command(
        "DAmping",
        CHANGES,
        "Rayleigh damping: the fraction of critical damping at the centre frequency, in cycles per unit "
        "time. Mass or Stiffness keeps only that half, which is fcrit/2 at that frequency. There is no "
        "damping by default, and DAMPING 0 1 switches it off again. The other kinds only lead to rest and "
        "are not physical. " + " ".join(f"{one.name} {one.help}." for one in MODES),
        "DAMP 0.1 30 STIFFNESS",
        optional="fcrit freq",
        words=(
            Word("Mass", sets="only"),
            Word("Stiffness", sets="only"),
            Word("Internal", sets="only"),
            *(Word(one.keyword, one.fraction) for one in MODES),
        ),
        ours=", ".join(one.name for one in MODES),
    ),
    CABLE,
    CALL,
    DEFAULT,
    Command(
        "DElete",
        CHANGES,
        "Delete the blocks with centroids in x1<x<x2, y1<y<y2. FUNCTION: their forces on other blocks stay "
        "as loads, times a FUNCTION of the time: so an excavated boundary is relaxed by a factor. OUTSIDE "
        "with limits deletes the blocks that are not between them, and while cycling all that leave them; "
        "fixed blocks stay.",
        "DELETE 20 40 10 20",
        numbers=RANGE,
        words=(FOLLOWS,),
        ours="FUNCTION",
        counts=Counts("block", "deleted", of_all=True),
    ),
    DISPLACEMENTS,
    Command(
        "Dump",
        SHOWS,
        "Dump the main array from address n to address m, and its five pointers.",
        "DUMP 1 100",
        numbers="n m",
    ),
    Command(
        "ENErgy",
        CHANGES,
        "ON starts an account of the energy, which PRINT ENERGY shows: motion, springs, weight, friction, "
        "damping, boundary conditions. Cycles take longer with it. OFF ends it.",
        "ENERGY ON",
        words=(Word("ON", sets="state"), Word("OFf", sets="state")),
        first="state",
        ours="the command",
    ),
    Command(
        "END",
        SESSION,
        "The last line of a deck, after STOP.",
        "END",
        opens=True,
        ours="its name; the report only requires one more line",
        ends=True,
    ),
    FILL,
    FLOW,
    FLUID,
    FOS,
    Command(
        "FUnction",
        CHANGES,
        "Define function number n for BOUNDARY, GRAVITY and PROPERTY: factors f at the times t of the model, "
        "linear in between. FILE reads them from a text file with two columns, in place of the list. "
        "Relative names start in the folder of the deck.",
        "FUNCTION 1 0 0 0.5 1",
        numbers="n",
        words=(Word("FILE", "path", sets="path", text=True, replaces=True),),
        list="t f",
        ours="the command",
    ),
    Command(
        "FRaction",
        CHANGES,
        "Use the fraction f of the critical time-step. Without a word this is the estimate of 1980, which "
        "is only approximate; the default is 0.1 of it. SAFE: of a bound that no mode of the present "
        "contacts and zones exceeds. SCALED: of that bound, with inertial masses that make all modes as "
        "quick as the quickest. The path to rest is then not that of the model, and time has no meaning.",
        "FRAC 0.1",
        numbers="f",
        words=(Word("Safe"), Word("SCaled")),
        ours="Safe, Scaled",
    ),
    FRACTURES,
    Command(
        "Fix",
        CHANGES,
        "Fix the blocks with centroids in x1<x<x2, y1<y<y2.",
        "FIX 0 60 0 10",
        numbers=RANGE,
        counts=Counts("block", "fixed"),
    ),
    Command(
        "FRee",
        CHANGES,
        "Set free the blocks with centroids in x1<x<x2, y1<y<y2.",
        "FREE 0 60 0 10",
        numbers=RANGE,
        counts=Counts("block", "set free"),
    ),
    Command(
        "GEnerate",
        CHANGES,
        "Make blocks in the range that have no zones fully-deformable. Manual: the first of them, with "
        "grid-points (x,y), and zones as triples of their numbers; the last grid-point is number 1; the same "
        "command again takes the next block. Automatic: all of them, with triangles with sides of about d, "
        "or GRADED: of d plus growth times the distance of the block from (x,y). Mixed: zones 1 and 2, 3 and "
        "4 ... are pairs for mixed discretisation.",
        "GEN 0 10 0 10 M G (5,5) (0,10) (0,0) (10,0) (10,10) Z 1,2,5 2,3,5 3,4,5 4,1,5",
        numbers=RANGE,
        words=(
            Word("Manual", sets="mode"),
            Word("Automatic", sets="mode"),
            Word("Gridpoints", "x y", repeated=True),
            Word("Zones", "l m n", repeated=True),
            Word("Edge", "d"),
            Word("GRADED", "growth x y"),
            Word("MIxed"),
        ),
        first="mode",
        first_error=22,
        ours="the form, whose line the scan of the report has lost; Edge, GRADED and Mixed",
    ),
    GEOMETRY,
    GROUP,
    Command(
        "Gravity",
        CHANGES,
        "Set the accelerations of gravity. FUNCTION multiplies both by a FUNCTION of the time from now on.",
        "GRAVITY 0 -9.81",
        numbers="gx gy",
        words=(FOLLOWS,),
        ours="FUNCTION",
    ),
    Command(
        "HElp",
        SESSION,
        "Explain a command, or list them all.",
        "HELP PROPERTY",
        text="command",
        opens=True,
        ours="the command",
    ),
    Command(
        "HIStory",
        CHANGES,
        "Record a number every n cycles. It is a field of a group, named as in the table of data groups; "
        "the group is given by its address, or as the one nearest to a point. Or it is a variable of the "
        "common block, such as TIME or WFRIC, or a quantity of the whole model: "
        + ", ".join(QUANTITIES)
        + ". XREAction, YREAction and MREAction sum up the reactions on all that is held, or with RANGE on "
        "what is held in x1<x<x2, y1<y<y2 now. The numbers go to NAME-history.csv and NAME-history.h5 "
        "after every CYCLE.",
        "HISTORY 10 KXD AT 15,25 25,25",
        numbers="n",
        words=(
            *FIELDS,
            *(Word(keyword, sets="field") for keyword in QUANTITIES),
            Word("Address", "ia"),
            Word("AT", "x y", repeated=True),
            Word("RANGE", RANGE, sets="within"),
        ),
        first="field",
        ours="the command",
    ),
    INFO,
    Command(
        "INsitu",
        CHANGES,
        "Initial stresses of the blocks with centroids in x1<x<x2, y1<y<y2. Tension is positive; "
        "stresses are those at x = 0 and y = 0; XGrad and YGrad are their increases with x and y. Joints, "
        "also those of rigid blocks, get the forces that balance these stresses.",
        "INSITU 0 60 0 40 -1.E6 0 -2.E6",
        numbers=RANGE + " s11 s12 s22",
        words=(Word("XGrad", "g11 g12 g22"), Word("YGrad", "g11 g12 g22")),
        ours="the command",
        counts=Counts("block", "stressed"),
    ),
    Command(
        "JPROPERTY",
        CHANGES,
        "Define joint material n: normal and shear stiffness (Pa/m), friction coefficient, cohesion and "
        "tensile strength (Pa), dilation (a tangent) and the slip at which it ends, and friction and "
        "cohesion after the first slip or opening. The model is COULOMB, the default, YIELDING (friction "
        "that decreases with slip: NEXPONENT to ROUGHNESS), BARTON (closure and strength of a rough joint: "
        "JRC to APERTURE), or JL2 to JL5 (laws of your own: docs/laws.md); docs/joints.md has the formulas. "
        "CONTACT: stiffness and strength are those of a contact (N/m2, N/m) as in 1980; LENGTH, the default: "
        "those of a length; ENDS: the same, with averages of the two ends of a joint (report 2.4). BETWEEN: "
        "joints between blocks of materials i and j have this joint material, unless CHANGE or the joint of "
        "SPLIT gives another. FUNCTION multiplies friction, cohesion, and tensile and residual strength of "
        "the command by a FUNCTION of the time. APERTURE, RAPERTURE, MAPERTURE, PFACTOR: for water.",
        "JPROPERTY JMATERIAL=1 KN=1.E9 KS=1.E9 F=0.6 C=1.E5 T=1.E4 BETWEEN 1 1",
        words=(
            JMATERIAL,
            *JPROPERTIES,
            Word("COULOMB", sets="model"),
            Word("YIELDING", sets="model"),
            Word("BARTON", sets="model"),
            *(Word(f"JL{n}", sets="model") for n in range(2, 6)),
            Word("LENGTH", sets="unit"),
            Word("CONTACT", sets="unit"),
            Word("ENDS", sets="unit"),
            Word("BETWEEN", "i j"),
            FOLLOWS,
        ),
        first="jmaterial",
        ours="the command",
    ),
    JSET,
    Command(
        "PAtch",
        CHANGES,
        "Change words of the main array by name: a field of a group, a variable of the common block, or an "
        "integer word by its address. Separate several with commas. The state is first proved sound with "
        "the new values; otherwise nothing is changed. A fixed block that gets a velocity stays where it is "
        "and drags what touches it, like a conveyor belt.",
        "PATCH block@88.KXD = 0.5, zone@9.KZG(2) = 412, FRAC = 0.1",
        text="assignments",
        needs_text=True,
        ours="the command",
        writes_words=True,
    ),
    PLOT,
    POLYLINE,
    PPRESSURE,
    Command(
        "Print",
        SHOWS,
        "Print data of blocks, contacts, corners, domains, grid-points, zones with their strain rates, or "
        "boundary conditions. List and DList print the linked lists of blocks and domains. Energy prints "
        "the account of the energy, HIStories the histories, REActions the forces that hold what is fixed "
        "or has a prescribed velocity, FUnctions the functions and what follows them, JOINTS the contacts "
        "with a joint material, with their lengths and stresses, and before them the joint materials, WATER "
        "pressures, flows and the account of the water, MAX the greatest velocity, forces and overlap, "
        "BOLTS, ELEMENTS and NODES the structures, CRACKS the cracks that runs have made.",
        "PRINT BLOCKS CONTACTS",
        words=tuple(Word(keyword, sets=SEVERAL) for keyword in PRINTED),
        first=SEVERAL,
    ),
    Command(
        "PROperty",
        CHANGES,
        "Define the properties of material n: bulk modulus (Bulk or K, Pa), cohesion of a contact (N/m), "
        "density (kg/m3), normal and shear stiffness of a contact (N/m2, not Pa/m: a force in N for each "
        "metre of thickness, per metre of overlap or slip), joint friction coefficient, shear modulus (G, "
        "Pa). A value never given is 0: a joint without friction slides. Stiffness and cohesion are those of "
        "each contact, whatever the length of the joint; two blocks face to face have two contacts. A "
        "contact has the material of its first block, so the contacts of one joint between two materials "
        "can differ (PRINT CONTACTS shows them): give both the same joint properties. For constitutive "
        "numbers 2 to 5: dilation of joints, residual friction and cohesion, and the critical slip that "
        "leads to them; friction, cohesion, tensile strength and dilation inside blocks; four numbers for "
        "laws of your own. Frictions and dilations are tangents. FUNCTION multiplies the values of the "
        "command by a FUNCTION of the time, until PROPERTY gives them again. Densities, stiffnesses and "
        "moduli, from which masses and the time-step follow, take none.",
        "PROP MAT=1 DENS=2000 KN=1.E08 KS=1.E08 F=0.5",
        words=(MATERIAL, *PROPERTIES, Word("K", "b", sets="bulk"), FOLLOWS),
        first="material",
        ours="all properties behind G; FUNCTION",
    ),
    REMOVE,
    Command(
        "Restart",
        SESSION,
        "Continue from the restart file; the default is restart.h5. Relative names start in the folder for "
        "files (--out). The whole state is checked first, as by udec check. UNCHECKED checks "
        "links, codes and counts only. FORCE also accepts an unsound state, for inspection and repair. "
        "Commands that follow links, such as CYCLE, are then refused until the state is sound.",
        "RESTART slope.h5",
        words=(BY_FORCE, UNCHECKED),
        text="path",
        opens=True,
        ours="the name of the file; FORCE; UNCHECKED",
        begins=True,
    ),
    RESET,
    Command(
        "RSet",
        CHANGES,
        "Insert the real v in the main array at address ia, with offset ioff.",
        "RSET 9.81 100 5",
        numbers="v ia ioff",
        writes_words=True,
    ),
    Command(
        "Round",
        CHANGES,
        "Round each corner with a circle tangential to its edges at the distance d. The upper limit is half"
        " the shortest edge, the lower limit twice the greatest overlap. Blocks touch where the circles of "
        "their corners begin: a block turns about a point at d from its corner.",
        "ROUND 0.5",
        numbers="d",
    ),
    Command(
        "SAve",
        SESSION,
        "Save the state in the restart file; the default is restart.h5. Relative names start in the folder "
        "for files (--out), outside of which no folder is created. The file may replace a restart file and "
        "nothing else. FORCE also saves an unsound state, and marks the file. Put the name of a file "
        "called FORCE in quotes.",
        "SAVE slope.h5",
        words=(BY_FORCE,),
        text="path",
        ours="the name of the file; FORCE",
    ),
    Command("SCale", SHOWS, "Set the plot scale to s.", "SCALE 0.2", numbers="s"),
    SOLVE,
    Command(
        "SPlit",
        CHANGES,
        "Split the blocks in the path of the line from (x1,y1) to (x2,y2). A line that splits none, but ends "
        "inside a block, is kept there until later cuts meet it. JOINT: number of the joint that "
        "the cracks belong to. JMATERIAL: joint material of that joint, also for contacts that form on it "
        "later.",
        "SPLIT -1,10 61,10",
        numbers="x1 y1 x2 y2",
        words=(Word("JOINT", "n"), JMATERIAL),
        ours="JOINT, JMATERIAL",
        counts=Counts("block", "cut off", none="no block was cut", of_all=True),
    ),
    SPROPERTY,
    STAGE,
    Command("STArt", CHANGES, "Start from nothing.", "START", opens=True, begins=True),
    Command("Stop", SESSION, "End the run.", "STOP", opens=True, ends=True),
    TIDY,
    TUNNEL,
    VELOCITY,
    VORONOI,
    VOUSSOIRS,
)
