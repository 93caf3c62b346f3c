"""What an error tells the user besides its number: where it arose, what to do, what may have been meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from udec_ia.deck.deck_statements import Token
from udec_ia.errors import UdecError

SHOWN = 40  # characters of a word that are worth repeating
SUGGESTED = 3  # keywords that begin with what was typed
ALIKE = 0.65  # share of two words that must agree for one to be taken for the other
WIDTH = 200  # longer lines are shown up to the place of the error, and not at all if it is beyond


def at(error: UdecError, place: Token) -> UdecError:
    """`error`, telling that it arose at `place`, in the line as it was written."""
    line, column = place.line.as_written(place.column)
    error.file, error.line, error.column = line.file, line.number, column
    error.token = place.text
    if column <= WIDTH:
        error.source = line.shown if len(line.shown) <= WIDTH else line.shown[: column + SHOWN] + " ..."
    return error


def quoted(text: str) -> str:
    """`text` in quotes, cut off when it is very long, harmless to print."""
    shown = "".join(c if c.isprintable() else "?" for c in text[:SHOWN])
    return f'"{shown}{"..." if len(text) > SHOWN else ""}"'


def hint(typed: str, keywords: Iterable[str], advice: str) -> str:
    """`advice`, behind `did you mean PROPERTY?` if one of `keywords` is, or means, nearly what was typed."""
    word, known = typed[:SHOWN].upper(), [keyword.upper() for keyword in keywords]
    meant = ALSO_CALLED.get(word) or ALSO_CALLED.get(word.removesuffix("S"), "")
    near = [name for name in meant.split() if name in known]
    near = near or [name for name in known if name.startswith(word)][:SUGGESTED]  # not long enough
    begun = {name[: len(word)]: name for name in reversed(known)} | {name: name for name in known}
    alike = difflib.get_close_matches(word, begun, n=SUGGESTED, cutoff=ALIKE)
    near = near or list(dict.fromkeys(begun[one] for one in alike))[:2]
    return f"did you mean {' or '.join(near)}? {advice}" if near else advice


# ---- What other programs and other people call the things of the deck language

ALSO_CALLED = {
    "?": "HELP",
    "ANGLE": "FRICTION",
    "BEGIN": "START",
    "BYE": "STOP",
    "CONTINUE": "CYCLE RESTART",
    "CRACK": "SPLIT",
    "CUT": "SPLIT",
    "DEFINE": "DEFAULT",
    "DEFORMABLE": "SDEF FDEF",
    "DRAW": "PLOT",
    "DT": "FRACTION",
    "E": "BULK G",
    "ERASE": "DELETE",
    "EXIT": "STOP",
    "FORCE": "BOUNDARY CONTACTS KCFN KBFX",
    "GO": "CYCLE",
    "INFO": "PRINT HELP",
    "JFRICTION": "FRICTION",
    "JKN": "KN",
    "JKS": "KS",
    "JOINT": "SPLIT",
    "JSET": "SPLIT",
    "KILL": "DELETE",
    "LET": "DEFAULT",
    "LIST": "PRINT",
    "LOAD": "BOUNDARY RESTART",
    "LOG": "HISTORY",
    "MAN": "HELP",
    "MAT": "PROPERTY",
    "MATERIAL": "PROPERTY",
    "MESH": "GENERATE",
    "MU": "FRICTION",
    "NEW": "START",
    "NU": "BULK G",
    "OPEN": "RESTART",
    "PARAMETER": "DEFAULT",
    "PHI": "FRICTION",
    "POISSON": "BULK G",
    "POLYGON": "BLOCK",
    "QUIT": "STOP",
    "RECORD": "HISTORY",
    "REMOVE": "DELETE",
    "RHO": "DENSITY",
    "RUN": "CYCLE",
    "SET": "GRAVITY DAMPING FRACTION",
    "SHEAR": "G",
    "SHOW": "PRINT",
    "STEP": "CYCLE",
    "STRESS": "BOUNDARY INSITU KZS11 KS111",
    "SXX": "STRESS",
    "TENSION": "BTENSION",
    "TIMESTEP": "FRACTION",
    "VARIABLE": "DEFAULT",
    "VELOCITY": "BOUNDARY XVEL YVEL KXD KYD",
    "VIEW": "PLOT",
    "WRITE": "SAVE",
    "X": "KX KXG",
    "XVEL": "KXD KXDG",
    "Y": "KY KYG",
    "YOUNG": "BULK G",
    "YVEL": "KYD KYDG",
    "ZONE": "GENERATE",
}
