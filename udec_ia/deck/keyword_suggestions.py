"""Suggestions for words that the deck language does not have: `did you mean PROPERTY?`.

A keyword is suggested if other programs call it by the typed word, if the typed word is its beginning or one
letter too long, or if both have the same first letter and most others; and only if the rest of the line fits.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable

SUGGESTED = 3  # keywords that begin with what was typed
ALIKE = 0.75  # least share of common letters

OTHER_NAMES = {  # our keywords, and their names in other programs and in common use
    "BLOCK": "POLYGON",
    "BOUNDARY CONTACTS KCFN KBFX": "FORCE",
    "BOUNDARY INSITU KZS11 KS111": "STRESS",
    "BOUNDARY RESTART": "LOAD",
    "BTENSION": "TENSION",
    "BULK G": "E NU POISSON YOUNG",
    "CYCLE": "GO RUN STEP",
    "CYCLE RESTART": "CONTINUE",
    "DEFAULT": "DEFINE LET PARAMETER VARIABLE",
    "DELETE": "ERASE KILL",
    "DENSITY": "RHO",
    "FRACTION": "DT TIMESTEP",
    "FRICTION": "ANGLE JFRICTION MU PHI",
    "FUNCTION": "TABLE",
    "G": "SHEAR",
    "GENERATE": "MESH ZONE",
    "HELP": "? MAN",
    "HISTORY": "LOG RECORD",
    "KN": "JKN",
    "KS": "JKS",
    "KX KXG": "X",
    "KXD KXDG": "XVEL",
    "KY KYG": "Y",
    "KYD KYDG": "YVEL",
    "MATERIAL": "JMAT",
    "PLOT": "DRAW VIEW",
    "PRINT": "LIST SHOW",
    "PROPERTY": "MAT MATERIAL",
    "RESTART": "OPEN RESTORE",
    "SAVE": "WRITE",
    "SDEF FDEF": "DEFORMABLE",
    "SPLIT": "CRACK CUT JOINT",
    "START": "BEGIN NEW",
    "STOP": "BYE EXIT QUIT",
    "STRESS": "SXX",
}
ALSO_CALLED = {name: ours for ours, names in OTHER_NAMES.items() for name in names.split()}


def with_suggestion(
    typed: str, keywords: Iterable[str], advice: str, fits: Callable[[str], bool] = lambda keyword: True
) -> str:
    """`advice`, behind `did you mean PROPERTY?` if `typed` is probably one of `keywords`.

    fits: True if the rest of the line fits a keyword, which is given in upper case.
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
    """Words of `known` that are spelt like `word`, or begin like it; nearest first."""
    same = [name for name in known if name[:1] == word[:1]]
    begun = {name[: len(word)]: name for name in reversed(same)} | {name: name for name in same}
    alike = difflib.get_close_matches(word, begun, n=SUGGESTED, cutoff=ALIKE)
    return list(dict.fromkeys(begun[one] for one in alike))
