"""The numbered errors of Appendix I-2, and the few that this program adds.

Numbers 1 to 26 are those of 1980, without 21 (DELETE takes fully-deformable blocks away); 27 and above are
new. An error that arises in a deck carries its place there.
"""

from __future__ import annotations

from udec_ia.printable_text import MESSAGE, printable

ERRORS = {  # number: message, and what to do about it
    1: ("memory overflow", "use a larger --mtop, or omit --mtop and choose a --build with wider integers"),
    2: ("unrecognisable command", "HELP lists the commands"),
    3: (
        "not START or RESTART as first command",
        "put START before this line, or RESTART to continue from a saved state",
    ),
    4: ("material number out of range", "material numbers run from 1 to 50"),
    5: ("block has less than 3 corners", "give at least three corners, clockwise"),
    6: (
        "negative or zero block area",
        "give the corners in clockwise order, along an outline that does not cross itself",
    ),
    7: ("missing parameter", "HELP and the name of the command show its form"),
    8: ("missing y-value", "x and y of a point must be on one line"),
    9: (
        "constitutive number out of range",
        "constitutive numbers run from 1 to 5; for 2 to 5 give laws: --constitutive law.py",
    ),
    10: ("unrecognised parameter", "HELP and the name of the command list its parameters"),
    11: (
        "contact stiffnesses undefined: cannot cycle",
        "give KN and KS of every material in use: PROPERTY MAT=1 KN=... KS=...",
    ),
    12: (
        "zero mass block(s) present: cannot cycle",
        "give the density of every material in use: PROPERTY MAT=1 DENS=...",
    ),
    13: (
        "mass damping for rigid-body motion too high",
        "use a smaller fcrit in DAMPING, or a smaller FRACTION",
    ),
    14: (
        "rounding length too great",
        "change d in ROUND: two roundings must fit on the shortest edge, and no overlap may exceed d/2",
    ),
    15: (
        "contact overlap too great",
        "use a larger joint stiffness or a smaller FRACTION, and check what drives the blocks together",
    ),
    16: (
        "internal mass damping too high",
        "use a smaller fcrit in DAMPING ... INTERNAL, or a smaller FRACTION",
    ),
    18: (
        "the block overlaps another one",
        "give corners beside the other blocks, or SPLIT a larger block",
    ),
    19: ("cannot delete final contact in problem", "at least two blocks must remain"),
    20: (
        "internal error, the main array is damaged",
        "check the last RSET, or go back to a state that was saved before it",
    ),
    22: (
        'fifth parameter must be "Manual" or "Automatic"',
        "write GENERATE x1 x2 y1 y2 MANUAL GRIDPOINTS ... ZONES ..., or AUTOMATIC EDGE d",
    ),
    23: (
        "not available yet",
        'AUTOMATIC zones need one more package: python -m pip install "pythoncdt>=2.0"',
    ),
    24: ("cannot find block in range", "a block counts by its centroid: PRINT BLOCKS shows the centroids"),
    25: (
        "zone pointer references non-existent grid-point",
        "zones refer to grid-points by number; the last grid-point given is number 1",
    ),
    26: ("missing data", "the three grid-points of a zone must be on one line"),
    27: (
        "split line runs too close to a corner or an edge",
        "move the line: it may pass exactly through a corner, but not graze one",
    ),
    28: ("value out of range", "HELP and the name of the command show what it takes"),
    29: (
        "file cannot be used",
        "check the name of the file and whether it is complete; `udec info FILE` reads a restart file",
    ),
    30: ("address outside the main array", "addresses run from 1 to MFREE: DUMP 1 1 shows it"),
    31: ("file cannot be written", "check the name of the folder, and that it can be written to"),
    32: (
        "zone or block has turned inside out",
        "use a stiffer material, a smaller FRACTION or smaller loads",
    ),
    33: (
        "zones do not fill the block",
        "the zones must cover the block side to side, each side between two grid-points once",
    ),
    34: ("constitutive law cannot be used", "correct the file that --constitutive names"),
    35: (
        "constitutive law returned no finite number",
        "check divisions and square roots in the law, and the properties of the material",
    ),
    36: (
        "coordinate or force beyond the precision",
        "FIX or DELETE the blocks that fly away, apply smaller loads, or use 64-bit reals",
    ),
    37: ("more energy than was put in", "take a smaller FRACTION, or FRACTION f SAFE"),
    38: (
        "joint closes too fast for its stiffness",
        "let the load grow with a FUNCTION, or give KNMAX of the joint material: the time-step allows for it",
    ),
    39: (
        "too many steps of flow in one cycle",
        "lower KW of FLUID, or MAPERTURE of wide joints; RAPERTURE raises the volume of tight ones beside "
        "them; FLUID DRAINED after FLOW STEADY needs no steps",
    ),
}
MESSAGES = {number: message for number, (message, _) in ERRORS.items()}
ADVICE = {number: advice for number, (_, advice) in ERRORS.items()}


# Numbers that kernels put into NERR, or that other modules test
OVERFLOW = 1
TOO_SHORT = 14  # an edge can no longer hold its roundings
OVERLAP_TOO_GREAT = 15  # blocks overlap by more than DTOL2, or without a contact
DAMAGED = 20  # after this error the state can be saved by force only, for inspection
INSIDE_OUT = 32  # a body or zone is strained until it has no area any more
LAW_FAILED = 35
TOO_FAR = 36
OUT_OF_NOWHERE = 37
TOO_STIFF = 38  # a joint, in one step
TOO_MANY_FLOW_STEPS = 39

DISORDERED = TOO_SHORT, OVERLAP_TOO_GREAT, INSIDE_OUT, TOO_FAR  # leave blocks too deep or too thin


def spoilt(number: int, cycle: int) -> str:
    """Sentence on a state in which error `number` has ended a run, in `cycle` (NSPOIL, MCSPOI)."""
    return f"error {number} in cycle {cycle}, {MESSAGES[number]}, has ended a run of this state"


class UdecError(Exception):
    """A numbered error.

    number: key of MESSAGES. detail: what exactly is wrong. advice: what to do about it, by default ADVICE.
    file, line, column, source, token: place in the deck (line and column count from 1), or None.
    group: address of the group concerned, or 0. parameter: name of the argument that is to blame, or "".
    saved: restart file written because of the error.
    """

    def __init__(
        self, number: int, detail: str = "", advice: str = "", *, group: int = 0, parameter: str = ""
    ) -> None:
        self.number = number
        self.detail = detail
        self.advice = advice or ADVICE[number]
        self.group = group
        self.parameter = parameter
        self.file: str | None = None
        self.line: int | None = None
        self.column: int | None = None
        self.source: str | None = None
        self.token: str | None = None
        self.saved: str | None = None
        super().__init__(number, detail)

    @property
    def message(self) -> str:
        """The 1980 text and what exactly is wrong, on one line, safe to print."""
        return printable(MESSAGES[self.number] + (f": {self.detail}" if self.detail else ""), MESSAGE)

    def __str__(self) -> str:
        file = printable(str(self.file), MESSAGE)
        place = f"{file}:{self.line}:{self.column}: " if self.line is not None else ""
        lines = [f"{place}error {self.number}: {self.message}"]
        if self.source is not None and self.column is not None:
            lines += [f"    {self.source}", "    " + " " * (self.column - 1) + "^"]
        lines += [printable(self.advice, MESSAGE)] if self.advice else []
        if self.saved:
            what = "the damaged state is" if self.number == DAMAGED else "the results so far are"
            lines.append(printable(f"{what} saved in {self.saved}", MESSAGE))
        return "\n".join(lines)


class WrongAddress(UdecError):
    """Error 20 of the checked build: a kernel has used a wrong address, and may have changed words before."""
