"""What an error tells the user besides its number: where it arose, what to do, what may have been meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from udec_ia.deck.reader import Token
from udec_ia.errors import UdecError

SHOWN = 40  # characters of a word that are worth repeating
WIDTH = 200  # longer lines are shown up to the place of the error, and not at all if it is beyond

ADVICE = {
    1: "take a larger --mtop, or leave --mtop off and choose a --build with wider integers",
    2: "HELP lists the commands",
    3: "put START before this line, or RESTART to go on from a saved state",
    4: "material numbers run from 1 to 50",
    5: "give at least three corners, clockwise",
    6: "give the corners in clockwise order, along an outline that does not cross itself",
    7: "HELP and the name of the command show its form",
    8: "x and y of a point must stand on one line",
    9: "constitutive numbers run from 1 to 5; for 2 to 5 give laws: --constitutive law.py",
    10: "HELP and the name of the command list its parameters",
    11: "give KN and KS of every material in use: PROPERTY MAT=1 KN=... KS=...",
    12: "give the density of every material in use: PROPERTY MAT=1 DENS=...",
    13: "take a smaller fcrit in DAMPING, or a smaller FRACTION",
    14: "the shortest edge must hold two roundings, no overlap may exceed half of one: change d in ROUND",
    15: "take a larger joint stiffness or a smaller FRACTION, or look for what drives the blocks together",
    16: "take a smaller fcrit in DAMPING ... INTERNAL, or a smaller FRACTION",
    17: "split blocks before they are divided into zones, or CHANGE them to RIGID or SDEF first",
    18: "make the first block large enough, then SPLIT it and DELETE what is not needed",
    19: "leave at least two blocks that touch",
    20: "the main array is damaged: look at the last RSET, and go back to what was saved before it",
    21: "delete blocks before they are made fully-deformable",
    22: "write GENERATE x1 x2 y1 y2 MANUAL GRIDPOINTS ... ZONES ..., or AUTOMATIC EDGE d",
    23: "HELP lists what there is",
    24: "a block counts by its centroid: PRINT BLOCKS shows the centroids",
    25: "zones name grid-points from 1 to their number, and the last grid-point given is number 1",
    26: "a zone needs its three grid-points on one line",
    27: "move the line: it may pass exactly through a corner, but not graze one",
    28: "HELP and the name of the command show what it takes",
    29: "check the name of the file and whether it is complete: udec info FILE",
    30: "addresses run from 1 to MFREE: DUMP 1 1 shows it",
    31: "check that the folder exists and can be written to",
    32: "take stiffer zones, a smaller FRACTION or smaller loads",
    33: "the zones must cover the block side to side, each side between two grid-points once",
    34: "correct the file that --constitutive names",
    35: "look for what the law divides by or takes a root of, and at the properties of the material",
}


def at(error: UdecError, place: Token) -> UdecError:
    """`error`, telling that it arose at `place`; the advice of its number if it has none of its own."""
    error.file, error.line, error.column = place.line.file, place.line.number, place.column
    error.token = place.text
    if place.column <= WIDTH:
        shown = place.line.shown
        error.source = shown if len(shown) <= WIDTH else shown[: place.column + SHOWN] + " ..."
    error.advice = error.advice or ADVICE[error.number]
    return error


def quoted(text: str) -> str:
    """`text` in quotes, cut off when it is very long, harmless to print."""
    shown = "".join(c if c.isprintable() else "?" for c in text[:SHOWN])
    return f'"{shown}{"..." if len(text) > SHOWN else ""}"'


def hint(typed: str, keywords: Iterable[str], advice: str) -> str:
    """`advice`, behind `did you mean PROPERTY?` if one of `keywords` comes near to what was typed."""
    near = difflib.get_close_matches(typed[:SHOWN].upper(), [k.upper() for k in keywords], n=1, cutoff=0.5)
    return f"did you mean {near[0]}? {advice}" if near else advice
