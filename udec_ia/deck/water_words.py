"""Commands and words for water: FLUID, PPRESSURE, FLOW, and words of BOUNDARY."""

from __future__ import annotations

from udec_ia.deck.command_forms import CHANGES, Command, Counts, Word

OUTSIDE = (  # words of BOUNDARY
    Word("PPRESSURE", "p"),
    Word("LEVEL", "y"),
    Word("PXGRAD", "gx"),
    Word("PYGRAD", "gy"),
    Word("FLOW", "q"),
    Word("IMPERMEABLE"),
)
FLOW = Command(
    "FLOW",
    CHANGES,
    "Let water flow while the blocks do not move: STEADY, to the steady state; TIME, for t seconds; "
    "STEPS, for n stable steps; both: for t seconds in n steps, or in as many as are stable.",
    "FLOW STEADY",
    words=(Word("STEADY"), Word("TIME", "t"), Word("STEPS", "n")),
    ours="the command",
)

FLUID = Command(
    "FLUID",
    CHANGES,
    "There is water in the domains from now on: bulk modulus (2e9 Pa if it is not given), density "
    "(1000), viscosity (0.001). In a cycle deformation and flow change the pressures (COUPLED), "
    "deformation alone (UNDRAINED), or nothing (DRAINED). EVERY: cycles from one pass of flow to the next. "
    "Apertures are those of joint materials (JPROPERTY APERTURE).",
    "FLUID KW=2.E9 DENSITY=1000 VISCOSITY=0.001",
    words=(
        Word("KW", "b"),
        Word("DENSITY", "d"),
        Word("VISCOSITY", "v"),
        Word("COUPLED", sets="mode"),
        Word("UNDRAINED", sets="mode"),
        Word("DRAINED", sets="mode"),
        Word("EVERY", "n"),
    ),
    ours="the command",
)

PPRESSURE = Command(
    "PPRESSURE",
    CHANGES,
    "Pressure of the water in the domains with middles in x1<x<x2, y1<y<y2: p at x = 0 and y = 0, and "
    "its increases PXGRAD with x and PYGRAD with y; or that below a LEVEL under gravity. Domains in which "
    "it is below 0 have no water. HELD: it is held from now on; FREE ends that. FLOW: each of the domains "
    "gets that flow (m2/s) from now on. Both need no pressure: the present one stays.",
    "PPRESSURE 0 60 0 40 LEVEL=30",
    numbers="x1 x2 y1 y2",
    optional="p",
    words=(
        Word("LEVEL", "y"),
        Word("PXGRAD", "gx"),
        Word("PYGRAD", "gy"),
        Word("FLOW", "q"),
        Word("HELD", sets="state"),
        Word("FREE", sets="state"),
    ),
    ours="the command",
    counts=Counts("domain", "in the range", none="no domain in range"),
)
