"""The numbered errors of Appendix I-2, and the few that this program adds.

Numbers 1 to 26 are those of 1980; from 27 on they are ours. An error carries the place in the deck
where it arose, when it arose in a deck.
"""

from __future__ import annotations

MESSAGES = {
    1: "memory overflow",
    2: "unrecognisable command",
    3: "not START or RESTART as first command",
    4: "material number out of range",
    5: "block has less than 3 corners",
    6: "negative or zero block area",
    7: "missing parameter",
    8: "missing y-value",
    9: "constitutive number out of range",
    10: "unrecognised parameter",
    11: "contact stiffnesses undefined: cannot cycle",
    12: "zero mass block(s) present: cannot cycle",
    13: "mass damping for rigid-body motion too high",
    14: "rounding length too great",
    15: "contact overlap too great",
    16: "internal mass damping too high",
    17: "cannot split fully-deformable block",
    18: "only one block may be created at present: use SPLIT for more",
    19: "cannot delete final contact in problem",
    20: "internal error, subroutine DELC",
    21: "cannot delete fully-deformable block at present",
    22: 'fifth parameter must be "Manual" or "Automatic"',
    23: "not available yet",
    24: "cannot find block in range",
    25: "zone pointer references non-existent grid-point",
    26: "missing data",
    27: "split line runs too close to a corner or an edge",
    28: "value out of range",
    29: "restart file cannot be used",
    30: "address outside the main array",
    31: "file cannot be written",
    32: "zone has turned inside out",
    33: "zones do not fill the block",
    34: "constitutive law cannot be used",
    35: "constitutive law returned no finite number",
}


class UdecError(Exception):
    """A numbered error.

    number: key of MESSAGES. detail: what exactly is wrong. advice: what to do about it.
    file, line, column, source, token: place in the deck (line and column count from 1), or None.
    group: address of the group concerned, or 0. parameter: name of the argument that is to blame, or "".
    saved: restart file written because of the error.
    """

    def __init__(
        self, number: int, detail: str = "", advice: str = "", *, group: int = 0, parameter: str = ""
    ) -> None:
        self.number = number
        self.detail = detail
        self.advice = advice
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
        """The 1980 text and what exactly is wrong, on one line."""
        return MESSAGES[self.number] + (f": {self.detail}" if self.detail else "")

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: " if self.line is not None else ""
        lines = [f"{place}error {self.number}: {self.message}"]
        if self.source is not None and self.column is not None:
            lines += [f"    {self.source}", "    " + " " * (self.column - 1) + "^"]
        lines += [self.advice] if self.advice else []
        lines += [f"what was computed so far is saved in {self.saved}"] if self.saved else []
        return "\n".join(lines)
