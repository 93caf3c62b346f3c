"""Commands that concern decks, pictures and states: CALL, DEFAULT, PLOT and STAGE."""

from __future__ import annotations

from udec_ia.deck.command_forms import SESSION, SHOWS, Command, Word
from udec_ia.reader.drawable_quantities import IN_BLOCKS, KEYWORDS, OF_JOINTS

CALL = Command(
    "CALL",
    SESSION,
    "Execute the commands in another deck, up to its end or to RETURN. Relative names start in the "
    "folder of the deck.",
    "CALL materials.dat",
    text="path",
    needs_text=True,
    opens=True,
    ours="the command",
)
DEFAULT = Command(
    "DEFault",
    SESSION,
    "Give variables of the deck their values: a name, a value, and so on. In the lines that follow, $F "
    "or ${F} stands for the value of F, except in comments. A value is a number or a word. A value "
    "given with the deck, by --set F=0.4, takes precedence.",
    "DEFAULT F=0.5 N=1000",
    text="assignments",
    needs_text=True,
    opens=True,
    ours="the command, and variables",
)
PLOT = Command(
    "PLot",
    SHOWS,
    "Plot all blocks and centroids. 0 starts a frame, 1 draws over the last one. Words that draw over the "
    "blocks: CONTACTS with their forces, DOMAINS, ADDRESSES, principal STRESSES, VELOCITIES, DISPLACEMENTS "
    "that the state has, or else since the frame began (so use PLOT 1), STRUCTURES: bolts, cables and beams "
    "with their forces, CRACKS: "
    "those that runs have made, where they were, by their causes. Words that colour zones, and blocks "
    "without zones: the stresses S11, S12, S22, Pressure, SHear, and the MAJOR and MINOR principal stress, "
    "compression positive, of deformable blocks; MOVEMENT (the length of the displacement), XDISPLACEMENT, "
    "YDISPLACEMENT; SPEED, XVELOCITY, YVELOCITY. Words that colour the joints, contact by contact: SLip, "
    "Opening, STAte, NORMALSTRESS, SHEARSTRESS, SAFETY (shear strength over shear stress), and of water "
    "PPRESSURE, SATURATION, FLOW, APERTURE. WINDOW is the range that the picture shows. SINCE, last in "
    "the line: the state is drawn over that of a STAGE, with displacements and slip since then. HISTORY "
    "alone plots the histories instead, over time. HISTORY n plots that one, LESS another one, AGAINST "
    "another one instead of time; LOGX and LOGY make an axis logarithmic. A picture is written at once. If "
    "PLOT 1 adds to it within seconds, as in a deck, or if it has more than ten states, it is written again "
    "later, and when it or the deck ends.",
    "PLOT 0 CONTACTS",
    optional="n",
    words=(
        Word("Contacts"),
        Word("Domains"),
        Word("Addresses"),
        Word("Stresses"),
        Word("Velocities"),
        Word("DIsplacements"),
        *(Word(KEYWORDS[name], sets="contour") for name in IN_BLOCKS),
        *(Word(KEYWORDS[name], sets="joints") for name in OF_JOINTS),
        Word("STRUCTURES"),
        Word("CRACKS"),
        Word("Window", "x1 x2 y1 y2"),
        Word("HIStory", "[n]"),
        Word("LESS", "n"),
        Word("AGAINST", "n"),
        Word("LOGX"),
        Word("LOGY"),
        Word("SINCE", "name", text=True),
    ),
    ours="the words; n is used in both example runs",
)
STAGE = Command(
    "STAGE",
    SESSION,
    "Keep the state under a name, in one file for all stages of the run, NAME-stages.zip. RESTART "
    "NAME-stages.zip/name goes back to it; PLOT ... SINCE name shows the change since then.",
    "STAGE excavated",
    text="name",
    needs_text=True,
    ours="the command",
)
