"""Commands that study the state of a rock mass: FOS, GEOMETRY."""

from __future__ import annotations

from udec_ia.deck.command_forms import LIMITS, SHOWS, Command, Word

GEOMETRY = Command(
    "GEOMETRY",
    SHOWS,
    "List the shortest edges, the smallest blocks and the sharpest angles, with their places, and what they "
    "cost in time-step and rounding length.",
    "GEOMETRY",
    ours="the command",
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
