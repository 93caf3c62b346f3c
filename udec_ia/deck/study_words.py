"""Commands that name parts of a rock mass, measure and study it, bring it to rest or to failure."""

from __future__ import annotations

from udec_ia.deck.command_forms import CHANGES, LIMITS, RUNS, SEVERAL, SHOWS, Command, Counts, Word

GEOMETRY = Command(
    "GEOMETRY",
    SHOWS,
    "List the shortest edges, the smallest blocks and the sharpest angles, with their places, and what they "
    "cost in time-step and rounding length.",
    "GEOMETRY",
    ours="the command",
)
CHECK = Command(
    "CHECK",
    SHOWS,
    "Prove the invariants of the state, as udec check does of a file, and list what violates them.",
    "CHECK",
    when_empty="sound: all invariants hold",
    ours="the command",
)
INFO = Command(
    "INFO",
    SHOWS,
    "Show what is in the model: blocks by type, contacts, materials, time, unbalanced force; what is missing "
    "before it can run; and remarks.",
    "INFO",
    ours="the command",
)
GROUP = Command(
    "GROUP",
    CHANGES,
    "The blocks that are in the range now are the group with that name (12 letters or digits) from now on: "
    "RANGE GROUP name. Parts of a block that is cut belong to its groups.",
    "GROUP crown CIRCLE 30 25 4",
    text="name",
    needs_text=True,
    ours="the command",
    counts=Counts("block", "in the group"),
)
FOS = Command(
    "FOS",
    SHOWS,
    "Find the factor of safety: that by which friction, cohesion and tensile strength can be divided before "
    "blocks fail. Every trial begins with the present state, which stays (docs/safety.md). "
    "BLOCKS, JOINTS: only the strength inside blocks, or of joints. In a range: only the strength there. "
    "TOLERANCE: width of the bracket over the factor (0.01). The last stable and the first failing state are "
    "drawn.",
    "FOS JOINTS TOLERANCE=0.005",
    numbers=LIMITS,
    words=(Word("BLOCKS"), Word("JOINTS"), Word("TOLERANCE", "t")),
    of_all=True,
    ours="the command",
)
SOLVE = Command(
    "SOLve",
    RUNS,
    "Cycle until the model is at rest: the force ratio and kinetic over strain energy are at most "
    "ratio (1E-5). The force ratio is an unbalanced force over the mean of the forces that contacts and "
    "zones carry. MAX, the default: the greatest unbalanced force on a block or grid-point. MEAN: that "
    "of all in the mean. At its end it reports which blocks have fallen. If the ratio is reached, it "
    "also reports slip of joints that makes the result depend on the loading path. If not, it reports "
    "which blocks moved most, and whether nothing damps. LIMIT: greatest number of cycles, 100000 by "
    "default. STATIC: with ADAPTIVE damping, the greatest safe step and scaled masses, whatever DAMPING "
    "and FRACTION are; at its end all velocities are 0.",
    "SOLVE 1E-3 LIMIT 20000",
    optional="ratio",
    words=(
        Word("Limit", "n"),
        Word("STatic"),
        Word("MEan", sets="criterion"),
        Word("MAx", sets="criterion"),
    ),
    ours="the command",
)
VELOCITY = Command(
    "VELOCITY",
    CHANGES,
    "Throw the blocks in the range: vx and vy (m/s) are the velocity of their centroids, w (rad/s, "
    "anticlockwise) is their angular velocity. Their motion then follows from forces, where BOUNDARY "
    "prescribes none. Fixed blocks are left out.",
    "VELOCITY 0 5 10 15 4 0 -2",
    numbers=LIMITS + " vx vy",
    optional="w",
    ours="the command",
    counts=Counts("block", "thrown"),
)
DISPLACEMENTS = Command(
    "DISPLACEMENTS",
    CHANGES,
    "The state has the displacements of all blocks and grid-points from now on (KBDX, KBDY, KBDT; KGDX, "
    "KGDY): HISTORY records them, and export writes them. RESET DISPLACEMENTS sets them to 0. Blocks and "
    "grid-points get new addresses.",
    "DISPLACEMENTS",
    ours="the command",
)
RESET = Command(
    "RESET",
    CHANGES,
    "Begin anew what a run adds up. Displacements of plots are measured from the present state, and "
    "those that the state has become 0. Slip: shear displacements of all contacts become 0. Time: the "
    "time of the model becomes 0; functions then begin again, and sines go on.",
    "RESET DISPLACEMENTS TIME",
    words=tuple(Word(word, sets=SEVERAL) for word in ("Displacements", "Slip", "Time")),
    first=SEVERAL,
    ours="the command",
)
