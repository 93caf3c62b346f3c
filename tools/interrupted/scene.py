"""A model with blocks of all types, conditions and histories, and all that it holds."""

from __future__ import annotations

from typing import Any

from udec_ia import Model
from udec_ia.layout.offsets import MFREE

SCENE = """START
PROP MAT=1 DENS=2000 KN=1E8 KS=1E8 F=0.5 BULK=1E9 G=6E8
PROP MAT=2 DENS=1000 KN=2E8 KS=1E8 F=0.1 BULK=2E8 G=1E8
BLOCK 0,0 0,4 6,4 6,0
SPLIT -1 1 7 1
SPLIT -1 2 7 2
SPLIT 2 1 2 4
SPLIT 4 1 4 4
ROUND 0.05
FIX 0 6 0 1
GRAVITY 0 -10
ENERGY ON
FUNCTION 3 0 0 0.01 1
CHANGE 2 4 1 2 SDEF
CHANGE 0 2 2 4 SDEF
GENERATE 0 2 1 2 AUTOMATIC EDGE 0.8
BOUNDARY 1.9 6 3.9 4.1 STRESS 0 0 -1E4 FUNCTION 3
BOUNDARY 2 4 2 4 XVEL 0.01 SINE 20 1
HISTORY 5 KYD AT 1,3 5,3
HISTORY 3 UNBALANCED"""


def state(model: Model) -> dict[str, Any]:
    """All that a command may change, bit for bit."""
    h, plots = model.array.h, model.session.plots
    frame = None if plots is None or plots.frame is None else plots.frame
    return {
        "words": h.ia[: int(h.ci[MFREE]) - 1].tobytes(),
        "integers": h.ci.tobytes(),
        "reals": h.cr.tobytes(),
        "doubles": h.cd.tobytes(),
        "size": (len(h.ia), model.array.scheme.name, model.array.fixed),
        "deck": tuple(model.session.deck_log),
        "series": tuple((str(one), one.lost, one.numbers.tobytes()) for one in model.session.recorder.series),
        "solutions": tuple(model.session.recorder.solutions),
        "files": tuple(model.session.files),
        "frame": None if plots is None else (plots.count, len(frame.states) if frame else -1),
        "flags": (model.session.started, model.session.written, model.session.unproved, model.explain_step),
        "remarks": (
            sorted(model.session._remarks),
            model.session.guard.runaway._judged,
            model.session.guard.runaway._warned,
            model.session.guard.runaway._account,
        ),
    }
