"""Suggestions for words that the deck language does not have: `did you mean PROPERTY?`.

A keyword is suggested if it is what other programs call the typed word, if the typed word is its beginning or
one letter too long, or if both begin with the same letter and agree in most others; and only if what follows
on the line fits it (`fits`).
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable

SUGGESTED = 3  # keywords that begin with what was typed
ALIKE = 0.75  # share of two words that must agree for one to be taken for the other

# Names in other programs and in common use. The parser does not take them.
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
    "JMAT": "MATERIAL",
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
    "RESTORE": "RESTART",
    "RHO": "DENSITY",
    "RUN": "CYCLE",
    "SHEAR": "G",
    "SHOW": "PRINT",
    "STEP": "CYCLE",
    "STRESS": "BOUNDARY INSITU KZS11 KS111",
    "SXX": "STRESS",
    "TABLE": "FUNCTION",
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


def with_suggestion(
    typed: str, keywords: Iterable[str], advice: str, fits: Callable[[str], bool] = lambda keyword: True
) -> str:
    """`advice`, behind `did you mean PROPERTY?` if one of `keywords` was probably meant by `typed`.

    fits: whether the rest of the line goes with a keyword, given in upper case.
    """
    word, known = typed.upper(), [keyword.upper() for keyword in keywords]
    names = (ALSO_CALLED.get(word) or ALSO_CALLED.get(word.removesuffix("S"), "")).split()
    near = (
        [name for name in names if name in known and fits(name)]
        or [name for name in known if (name.startswith(word) or name == word[:-1]) and fits(name)][:SUGGESTED]
        or [name for name in _alike(word, known) if fits(name)][:2]
    )
    return f"did you mean {' or '.join(near)}? {advice}" if near else advice


def _alike(word: str, known: Iterable[str]) -> list[str]:
    """Those of `known` that are spelt much like `word`, whole or as far as `word` goes; nearest first."""
    same = [name for name in known if name[:1] == word[:1]]
    begun = {name[: len(word)]: name for name in reversed(same)} | {name: name for name in same}
    alike = difflib.get_close_matches(word, begun, n=SUGGESTED, cutoff=ALIKE)
    return list(dict.fromkeys(begun[one] for one in alike))
