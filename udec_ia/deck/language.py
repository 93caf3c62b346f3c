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
from udec_ia.reader.recordable_numbers import QUANTITIES, recordable

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
        "Create a rigid block with the corners (x,y), given clockwise. A run has one BLOCK; SPLIT makes "
        "more blocks.",
        "BLOCK MAT=2 0,0 0,40 60,40 60,0",
        words=(MATERIAL, CONSTITUTIVE),
        list="x y",
    ),
    Command(
        "BOundary",
        "Boundary conditions in x1<x<x2, y1<y<y2. Velocities and forces act on the grid-points and block "
        "centroids there. Stresses act on the edges with both ends there, edges of joints included: tension"
        " is positive, and XGrad and YGrad are the increases with x and y. Viscous makes those edges "
        "non-reflecting, with the present properties. A sine (frequency, duration) begins now; a FUNCTION "
        "depends on the time of the model. Either multiplies loads and velocities. Loads add to existing "
        "loads. A velocity replaces the previous one. Free removes all conditions.",
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
        "Rayleigh damping: the fraction of critical damping at the centre frequency, in cycles per unit "
        "time. Mass or Stiffness keeps that half alone, which is fcrit/2 at that frequency. There is no "
        "damping by default. The other kinds only lead to rest and are not physical. LOCAL opposes the "
        "velocity with the fraction f of every unbalanced force. COMBINED takes half of that, and half "
        "against the change of the force. KINETIC stops all motion when the kinetic energy has passed a "
        "peak. ADAPTIVE is mass damping, with f the fraction of critical damping for what moves.",
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
        "Give variables of the deck their values: a name, a value, and so on. In the lines that follow, $F "
        "or ${F} stands for the value of F, except in comments. A value is a number or a word. A value "
        "given with the deck, by --set F=0.4, takes precedence.",
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
        "ON starts an account of the energy, which PRINT ENERGY shows: motion, springs, weight, friction, "
        "damping, boundary conditions. Cycles take longer with it. OFF ends it.",
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
        "Define function number n for BOUNDARY: factors f at the times t of the model, linear in between.",
        "FUNCTION 1 0 0 0.5 1",
        numbers="n",
        list="t f",
        ours="the command",
    ),
    Command(
        "FRaction",
        "Use the fraction f of the critical time-step. Without a word this is the estimate of 1980, which "
        "is only approximate; the default is 0.1 of it. SAFE: of a bound that no mode of the present "
        "contacts and zones exceeds. SCALED: of that bound, with inertial masses that make all modes as "
        "quick as the quickest. The path to rest is then not that of the model, and time has no meaning.",
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
        "Make the first block in the range fully-deformable. Manual: grid-points (x,y), and zones as "
        "triples of their numbers; the last grid-point is number 1. Automatic: triangles with sides of "
        "about d. Mixed: zones 1 and 2, 3 and 4 ... are pairs for mixed discretisation.",
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
        "Record a number every n cycles. It is a field of a group, named as in the table of data groups; "
        "the group is given by its address, or as the one nearest to a point. Or it is a variable of the "
        "common block, such as TIME or WFRIC, or a quantity of the whole model: "
        + ", ".join(QUANTITIES)
        + ". The numbers go to NAME-history.csv and NAME-history.h5 after every CYCLE.",
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
        "Initial stresses of the deformable blocks with centroids in x1<x<x2, y1<y<y2. Tension is positive;"
        " XGrad and YGrad are the increases with x and y. Joints start without force and close under these "
        "stresses.",
        "INSITU 0 60 0 40 -1.E6 0 -2.E6",
        numbers=RANGE + " s11 s12 s22",
        words=(Word("XGrad", "g11 g12 g22"), Word("YGrad", "g11 g12 g22")),
        ours="the command",
    ),
    Command(
        "PAtch",
        "Change words of the main array by name: a field of a group, a variable of the common block, or an "
        "integer word by its address. Separate several with commas. The state is first proved sound with "
        "the new values; otherwise nothing is changed.",
        "PATCH block@88.KXD = 0.5, zone@9.KZG(2) = 412, FRAC = 0.1",
        text="assignments",
        needs_text=True,
        ours="the command",
    ),
    Command(
        "PLot",
        "Plot all blocks and centroids. 0 starts a frame, 1 draws over the last one. The words add contacts"
        " with their forces, domains, addresses, principal stresses, velocities, or displacements since the"
        " frame began (so use PLOT 1). S11, S12, S22, Pressure and SHear colour deformable blocks by that "
        "stress. WINDOW is the range that the picture shows. HISTORY alone plots the histories instead. A "
        "picture is written at once; one with more than ten states is written when it has grown by a "
        "quarter, and when it ends.",
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
        "grid-points, zones with their strain rates, boundary conditions, the account of the energy, or the"
        " histories.",
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
        "Define the properties of material n: bulk modulus (Bulk or K, Pa), joint cohesion (N/m), density "
        "(kg/m3), normal and shear joint stiffness (N/m2: N/m of force per metre of overlap), joint "
        "friction coefficient, shear modulus (G, Pa). Values not given are 0: a joint without friction "
        "slides. Stiffness and cohesion are those of each contact, whatever the length of the joint; two "
        "blocks face to face have two contacts. A joint between two materials has the properties of one of "
        "them (PRINT CONTACTS shows which): give both the same joint properties, or check. For constitutive"
        " numbers 2 to 5: dilation of joints, residual friction and cohesion, and the critical slip that "
        "leads to them; friction, cohesion, tensile strength and dilation inside blocks; four numbers for "
        "laws of your own. Frictions and dilations are tangents of angles.",
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
        "Continue from the restart file; the default is restart.h5. Relative names start in the folder for "
        "files (--out). FORCE also accepts an unsound state, for inspection and repair. Commands that "
        "follow links, such as CYCLE, are then refused until the links are sound.",
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
        "Round each corner with a circle tangential to its edges at the distance d. The upper limit is half"
        " the shortest edge, the lower limit twice the greatest overlap. Blocks touch where the circles of "
        "their corners begin: a block turns about a point at d from its corner.",
        "ROUND 0.5",
        numbers="d",
    ),
    Command(
        "SAve",
        "Save the state in the restart file; the default is restart.h5. Relative names start in the folder "
        "for files (--out). The file may replace a restart file and nothing else. FORCE also saves an "
        "unsound state, and marks the file. Put the name of a file called FORCE in quotes.",
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
