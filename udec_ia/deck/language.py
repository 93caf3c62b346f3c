"""The deck language in one table: every command, its parameters, and what it means (Appendix I-1).

A keyword is printed as in the report: its upper-case letters must be typed, the others may be left off
from the end. `PROperty` is matched by PRO, PROP and property, not by PR or PROPS. Where two keywords
match, the one that stands first in the table is meant: R is Restart, FR is FRaction.

A number is named as in the report: names that begin with i to n take an integer, all others a real. After
its numbers a command takes words, in any order, and after its words a list. Each parameter reaches the
method of Model that has the command's full keyword as its name: numbers and the list as positional
arguments, words by name.

The parser, HELP, the suggestions in error messages and docs/commands.md all come from this table.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol, TypeVar

from udec_ia.layout.table import read_table
from udec_ia.ops.commands.recordable import QUANTITIES, recordable

MANY = 20  # choices that are told by the name of their argument, not one by one
SEVERAL = "*"  # a word that sets this stands for itself among the positional arguments


class Named(Protocol):
    """Anything that is called by a keyword."""

    @property
    def keyword(self) -> str: ...


N = TypeVar("N", bound=Named)


@dataclass(frozen=True)
class Word:
    """A keyword among the parameters of a command.

    values: names of the numbers that follow the word. repeated: a list of such tuples follows.
    sets: the argument that the word sets; by default the keyword itself, in lower case.
    Several values without a list are one tuple.
    Without values the word sets True, or its own name if it shares an argument with others.
    """

    keyword: str
    values: str = ""
    sets: str = ""
    repeated: bool = False

    @property
    def argument(self) -> str:
        return self.sets or self.keyword.lower()

    @property
    def form(self) -> str:
        """The word as the report prints it: `Material n`."""
        return f"{self.keyword} {self.values}".strip() + (" ..." if self.repeated else "")


@dataclass(frozen=True)
class Command:
    """A command of the language.

    numbers: names of the numbers that must be given. optional: of those that may be left off.
    words: its keywords. first: the argument that its first word must set, and the error if it does not.
    list: names of one tuple of the list that ends the command. text: name of a parameter that is taken as
    it stands, to the end of the line or to the word that stands last in it; needs_text: it must be given.
    opens: may come before START.
    ours: what of the command is not in Appendix I-1.
    """

    keyword: str
    help: str
    example: str
    numbers: str = ""
    optional: str = ""
    words: tuple[Word, ...] = ()
    first: str = ""
    first_error: int = 10
    list: str = ""
    text: str = ""
    needs_text: bool = False
    opens: bool = False
    ours: str = ""

    @property
    def name(self) -> str:
        """The full keyword in lower case: the name of the method of Model."""
        return self.keyword.lower()

    @property
    def extends(self) -> bool:
        """True if the command takes a list, for which one line is often too short."""
        return bool(self.list) or any(word.repeated for word in self.words)

    @property
    def form(self) -> str:
        """The command as the report prints it, brackets around what may be left off."""
        parts = [self.keyword, self.numbers, *(f"[{name}]" for name in self.optional.split())]
        parts += [self.text if self.needs_text else f"[{self.text}]"] if self.text else []
        for argument in dict.fromkeys(word.argument for word in self.words):
            forms = [word.form for word in self.words if word.argument == argument]
            if argument == SEVERAL:
                parts += forms
            else:
                choice = " | ".join(forms) if len(forms) < MANY else argument
                parts.append(choice if argument == self.first else f"[{choice}]")
        parts += [f"{self.list} ..."] if self.list else []
        return " ".join(part for part in parts if part)


MATERIAL = Word("Material", "n")
PROPERTIES = [
    Word(one.keyword, one.value, sets=one.argument if one.argument != one.keyword.lower() else "")
    for one in read_table().properties
    if one.keyword
]
CONSTITUTIVE = Word("Constitutive", "m")
BY_FORCE = Word("FORCE")
RANGE = "x1 x2 y1 y2"
FIELDS = tuple(Word(name, sets="field") for name in recordable() if name not in map(str.upper, QUANTITIES))

COMMANDS = (
    Command(
        "Block",
        "Create a rigid block with the corners (x,y), given clockwise. One BLOCK in a run; SPLIT makes more.",
        "BLOCK MAT=2 0,0 0,40 60,40 60,0",
        words=(MATERIAL, CONSTITUTIVE),
        list="x y",
    ),
    Command(
        "BOundary",
        "Conditions on the grid-points and block centroids in x1<x<x2, y1<y<y2: velocities or forces; on the "
        "edges with both ends there, those of joints too: stresses (tension positive, growing with x and y "
        "by XGrad and YGrad) or viscous, non-reflecting edges, with the properties of now. A sine "
        "(frequency, duration), which begins now, or a FUNCTION of the time of the model multiplies loads "
        "and velocities. Loads add to those that are there, a velocity takes the place of the last one. "
        "Free takes all conditions away.",
        "BOUNDARY -1 61 39 41 STRESS 0 0 -1.E6",
        numbers=RANGE,
        words=(
            Word("XVel", "v"),
            Word("YVel", "v"),
            Word("XForce", "f"),
            Word("YForce", "f"),
            Word("Stress", "s11 s12 s22"),
            Word("XGrad", "g11 g12 g22"),
            Word("YGrad", "g11 g12 g22"),
            Word("Viscous"),
            Word("SIne", "freq t"),
            Word("Function", "n"),
            Word("FRee"),
        ),
        ours="the command, which the report lists under further developments",
    ),
    Command(
        "Change",
        "Change type, material or constitutive number of the blocks with centroids in x1<x<x2, y1<y<y2.",
        "CHANGE 0 60 30 40 MATERIAL=2",
        numbers=RANGE,
        words=(
            Word("Sdef", sets="type"),
            Word("Fdef", sets="type"),
            Word("Rigid", sets="type"),
            MATERIAL,
            CONSTITUTIVE,
        ),
        ours="Rigid",
    ),
    Command(
        "CYcle",
        "Calculate n cycles.",
        "CYCLE 300",
        numbers="n",
        ours="listed in no appendix, but used in both example runs",
    ),
    Command(
        "DAmping",
        "Rayleigh damping: fraction of critical damping at the centre frequency, in cycles per unit time. "
        "Mass or Stiffness takes that half alone, which is fcrit/2 at that frequency. There is none "
        "by default. Or what only leads to rest: LOCAL takes the fraction f of every unbalanced force, "
        "against the velocity; COMBINED half of that, and half against the change of the force; KINETIC "
        "stops all when the kinetic energy has passed a peak; ADAPTIVE is mass damping, of which f is "
        "the fraction of critical for what moves. None of these is physics.",
        "DAMP 0.1 30 STIFFNESS",
        optional="fcrit freq",
        words=(
            Word("Mass", sets="only"),
            Word("Stiffness", sets="only"),
            Word("Internal", sets="only"),
            Word("Local", "f"),
            Word("Combined", "f"),
            Word("Kinetic"),
            Word("Adaptive", "f"),
        ),
        ours="LOCAL, COMBINED, KINETIC, ADAPTIVE",
    ),
    Command(
        "DEFault",
        "Give variables of the deck their values: names and values by turns. In the lines that follow $F or "
        "${F} stands for the value of F, in any place but a comment. A value that is given with the deck, by "
        "--set F=0.4, goes before it. A value is a number or a word.",
        "DEFAULT F=0.5 N=1000",
        text="assignments",
        needs_text=True,
        opens=True,
        ours="the command, and variables",
    ),
    Command(
        "DElete", "Delete the blocks with centroids in x1<x<x2, y1<y<y2.", "DELETE 20 40 10 20", numbers=RANGE
    ),
    Command(
        "Dump",
        "Dump the main array from address n to address m, and its five pointers.",
        "DUMP 1 100",
        numbers="n m",
    ),
    Command(
        "ENErgy",
        "ON: an account of the energy begins, which PRINT ENERGY shows: motion, springs, weight, friction, "
        "damping, boundary conditions. It makes a cycle longer. OFF: it ends.",
        "ENERGY ON",
        words=(Word("ON", sets="state"), Word("OFf", sets="state")),
        first="state",
        ours="the command",
    ),
    Command(
        "END", "The last line of a deck, after STOP.", "END", opens=True, ours="only said to be one more line"
    ),
    Command(
        "FUnction",
        "Function number n for BOUNDARY: factors f at the times t of the model, linear between them.",
        "FUNCTION 1 0 0 0.5 1",
        numbers="n",
        list="t f",
        ours="the command",
    ),
    Command(
        "FRaction",
        "Use the fraction f of the critical time-step: of the estimate of 1980, which is only approximate, "
        "or of a bound that no mode of the contacts and zones of now exceeds. By default it is 0.1 of the "
        "estimate. SCALED: of that bound, with inertial masses that make all as quick as the quickest; "
        "the way to rest is then none of the model, and time has no meaning.",
        "FRAC 0.1",
        numbers="f",
        words=(Word("Safe"), Word("SCaled")),
        ours="Safe, Scaled",
    ),
    Command("Fix", "Fix the blocks with centroids in x1<x<x2, y1<y<y2.", "FIX 0 60 0 10", numbers=RANGE),
    Command(
        "FRee", "Set free the blocks with centroids in x1<x<x2, y1<y<y2.", "FREE 0 60 0 10", numbers=RANGE
    ),
    Command(
        "GEnerate",
        "Make the first block in range fully-deformable: grid-points (x,y), and zones as triples of them, "
        "where the last grid-point is number 1. Automatic makes triangles with sides of about the length d. "
        "Mixed: zones 1 and 2, 3 and 4 ... are pairs for mixed discretisation.",
        "GEN 0 10 0 10 M G (5,5) (0,10) (0,0) (10,0) (10,10) Z 1,2,5 2,3,5 3,4,5 4,1,5",
        numbers=RANGE,
        words=(
            Word("Manual", sets="mode"),
            Word("Automatic", sets="mode"),
            Word("Gridpoints", "x y", repeated=True),
            Word("Zones", "l m n", repeated=True),
            Word("Edge", "d"),
            Word("MIxed"),
        ),
        first="mode",
        first_error=22,
        ours="the form, whose line the scan of the report has lost; Edge and Mixed",
    ),
    Command("Gravity", "Set the gravitational accelerations in x and y.", "GRAVITY 0 -9.81", numbers="gx gy"),
    Command(
        "HElp",
        "Explain a command, or list them all.",
        "HELP PROPERTY",
        text="command",
        opens=True,
        ours="the command",
    ),
    Command(
        "HIStory",
        "Record a number every n cycles: a field of a group, by its name in the table of data groups, of the "
        "group at an address or of those nearest to points; a variable of the common block, such as TIME or "
        "WFRIC; or a quantity of the whole model: " + ", ".join(QUANTITIES) + ". The numbers go to "
        "NAME-history.csv and NAME-history.h5 after every CYCLE.",
        "HISTORY 10 KXD AT 15,25 25,25",
        numbers="n",
        words=(
            *FIELDS,
            *(Word(keyword, sets="field") for keyword in QUANTITIES),
            Word("Address", "ia"),
            Word("AT", "x y", repeated=True),
        ),
        first="field",
        ours="the command",
    ),
    Command(
        "INsitu",
        "Initial stresses of the deformable blocks with centroids in x1<x<x2, y1<y<y2, tension positive; "
        "they grow with x and y by XGrad and YGrad. Joints begin without force and close under them.",
        "INSITU 0 60 0 40 -1.E6 0 -2.E6",
        numbers=RANGE + " s11 s12 s22",
        words=(Word("XGrad", "g11 g12 g22"), Word("YGrad", "g11 g12 g22")),
        ours="the command",
    ),
    Command(
        "PAtch",
        "Give words of the main array other values by name: the field of a group, a variable of the common "
        "block, or an integer word by its address; several with commas between them. All or none: the state "
        "is proved sound with them first.",
        "PATCH block@88.KXD = 0.5, zone@9.KZG(2) = 412, FRAC = 0.1",
        text="assignments",
        needs_text=True,
        ours="the command",
    ),
    Command(
        "PLot",
        "Plot all blocks and centroids: 0 starts a frame, 1 draws over the last one. The picture is written "
        "at once, one of more than ten states when it has grown by a quarter and when it ends. On request "
        "also contacts with their forces, domains, addresses, principal stresses, velocities, displacements "
        "since the frame began (so with PLOT 1), and deformable blocks coloured by a stress (11, 12, 22), "
        "pressure or shear stress. WINDOW is the range that the picture shows. HISTORY alone plots what was "
        "recorded instead.",
        "PLOT 0 CONTACTS",
        optional="n",
        words=(
            Word("Contacts"),
            Word("Domains"),
            Word("Addresses"),
            Word("Stresses"),
            Word("Velocities"),
            Word("DIsplacements"),
            *(Word(keyword, sets="contour") for keyword in ("S11", "S12", "S22", "Pressure", "SHear")),
            Word("HIStory"),
            Word("Window", RANGE),
        ),
        ours="the words; n is used in both example runs",
    ),
    Command(
        "Print",
        "Print data of blocks, contacts, corners, domains, the linked lists of blocks and domains, "
        "grid-points, zones with their strain rates, boundary conditions, the account of the energy, or what "
        "histories have recorded.",
        "PRINT BLOCKS CONTACTS",
        words=tuple(
            Word(keyword, sets=SEVERAL)
            for keyword in (
                "Blocks",
                "Contacts",
                "CORners",
                "Domains",
                "List",
                "DList",
                "Gridpoints",
                "Zones",
                "BOundaries",
                "ENErgy",
                "HIStories",
            )
        ),
        first=SEVERAL,
    ),
    Command(
        "PROperty",
        "Define properties of material n: bulk modulus (Bulk or K, Pa), joint cohesion (N/m), density "
        "(kg/m3), normal and shear joint stiffness (N/m2: N/m of force for a metre of overlap), joint "
        "friction coefficient, shear modulus (G, Pa). Stiffnesses and cohesion are those of each contact, "
        "however long the joint: two blocks face to face have two. What is not given is 0: a joint without "
        "friction slides. For constitutive numbers 2 to "
        "5: dilation of joints, their residual friction and cohesion and the critical slip that leads to "
        "these; friction, cohesion, tensile strength and dilation inside blocks; four numbers for laws of "
        "your own. Frictions and dilations are tangents of angles.",
        "PROP MAT=1 DENS=2000 KN=1.E08 KS=1.E08 F=0.5",
        words=(
            MATERIAL,
            *PROPERTIES,
            Word("K", "b", sets="bulk"),
        ),
        first="material",
        ours="what stands behind G",
    ),
    Command(
        "Restart",
        "Go on from the restart file, restart.h5 if it is not named; relative names begin in the folder for "
        "files (--out). FORCE takes an unsound state, too, to be looked at and mended: what follows "
        "links, as CYCLE does, is refused until they are sound.",
        "RESTART slope.h5",
        words=(BY_FORCE,),
        text="path",
        opens=True,
        ours="the name of the file; FORCE",
    ),
    Command(
        "RSet",
        "Insert the real v in the main array at address ia, with offset ioff.",
        "RSET 9.81 100 5",
        numbers="v ia ioff",
    ),
    Command(
        "Round",
        "Round each corner with a circle tangential to its edges at the distance d. Half the shortest edge "
        "is the most, twice the greatest overlap the least. Blocks touch where their corners' circles begin: "
        "a block turns about a point at d from its corner.",
        "ROUND 0.5",
        numbers="d",
    ),
    Command(
        "SAve",
        "Save the state on the restart file, restart.h5 if it is not named; relative names begin in the "
        "folder for files (--out). It may replace a restart file, and nothing else. FORCE saves an unsound "
        "state, too, and marks the file; a file that is called FORCE has its name in quotes.",
        "SAVE slope.h5",
        words=(BY_FORCE,),
        text="path",
        ours="the name of the file; FORCE",
    ),
    Command("SCale", "Set the plot scale to s.", "SCALE 0.2", numbers="s"),
    Command(
        "SOLve",
        "Cycle until the force ratio is at most that: the greatest unbalanced force on a block or grid-point "
        "(MAX, the default) or the mean of all (MEAN), over the mean of the forces that contacts and zones "
        "carry; and until kinetic over strain energy is no more either. At its end it says what still moves, "
        "and whether joints slipped. LIMIT: cycles after which to give up, "
        "100000 if it is left off. STATIC: with ADAPTIVE damping, the greatest safe step and scaled masses, "
        "whatever DAMPING and FRACTION say; all stands still at its end.",
        "SOLVE 1E-3 LIMIT 20000",
        numbers="ratio",
        words=(
            Word("Limit", "n"),
            Word("STatic"),
            Word("MEan", sets="criterion"),
            Word("MAx", sets="criterion"),
        ),
        ours="the command",
    ),
    Command(
        "SPlit",
        "Split the blocks in the path of the line from (x1,y1) to (x2,y2).",
        "SPLIT -1,10 61,10",
        numbers="x1 y1 x2 y2",
    ),
    Command("STArt", "Start from nothing.", "START", opens=True),
    Command("Stop", "End the run.", "STOP", opens=True),
)


def required(keyword: str) -> str:
    """The letters of `keyword` that must be typed: those up to its last upper-case one."""
    return keyword.rstrip("abcdefghijklmnopqrstuvwxyz")


def matches(keyword: str, typed: str) -> bool:
    """True if `typed` has all required letters of `keyword`, and nothing that does not belong to it."""
    return (
        typed.isascii() and len(typed) >= len(required(keyword)) and keyword.upper().startswith(typed.upper())
    )


def match(table: Iterable[N], typed: str) -> N | None:
    """The first entry of `table` whose keyword matches `typed` (MATCH, Appendix III-3), or None."""
    return next((entry for entry in table if matches(entry.keyword, typed)), None)
