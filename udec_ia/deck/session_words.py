"""Commands that concern decks and states: CALL, DEFAULT and STAGE."""

from __future__ import annotations

from udec_ia.deck.command_forms import SESSION, Command

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
