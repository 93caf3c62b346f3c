"""Whether a run has the time-steps and the time that its setting means it to have.

A deck can set its time-step past FRACTION, by PATCH or RSET of the word FRAC or by a START on its way. What
a setting puts in the line of FRACTION is then of no effect, and CYCLEs that were counted for another step
end too early or too late. Such a run is none of the deck, and is not compared.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from udec_ia.trade.levers import Numbers, Setting
from udec_ia.trade.surveyed import Segment

SAME = 1e-5  # of a fraction: what reals of 32 bits and ten digits of a deck leave
LASTS = 0.05  # of the time of all CYCLEs: by what a run may be off, as cycles are whole and steps come out so


def astray(survey: Sequence[Segment], found: Sequence[Segment], setting: Setting, numbers: Numbers) -> int:
    """The first CYCLE or SOLVE whose fraction is not the one that was meant, counted from 0; -1 for none."""
    for k, (own, one) in enumerate(zip(survey, found, strict=False)):
        if own.static or setting.static:
            continue
        meant = (setting.safe or own.fraction * setting.step) * numbers.fit
        safe = own.safe or bool(setting.safe)
        if one.safe != safe or not math.isclose(one.fraction, meant, rel_tol=SAME):
            return k
    return -1


def lasts(found: Sequence[Segment], end: float) -> float:
    """Time of the model in all CYCLEs of a run that has ended then (s); that in SOLVEs means nothing."""
    ends = [*(one.began for one in found[1:]), end]
    return sum(stop - one.began for one, stop in zip(found, ends, strict=False) if not one.solve)


def differs(time: float, own: float) -> bool:
    """True if the time in CYCLEs is not that of the deck."""
    return abs(time - own) > LASTS * abs(own)
