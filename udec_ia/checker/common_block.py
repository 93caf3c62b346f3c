"""What kernels believe of the common block without a further test."""

from __future__ import annotations

import numpy as np

from udec_ia.checker.checked_state import State
from udec_ia.compiling.interpreting import interpreted
from udec_ia.errors import MESSAGES
from udec_ia.kernels.geometry.tolerances import tolset
from udec_ia.layout import offsets as g


def check_common(state: State) -> None:
    """Size of the array, tolerances, error of a run: invariants 1 and 5."""
    ci, cr = state.h.ci, state.h.cr
    size, d = len(state.h.ia), cr[g.DTOL]
    tolerances = cr.copy()
    with interpreted():  # to load what is compiled takes longer
        tolset(state.h._replace(cr=tolerances), d)
    alike = np.allclose(tolerances, cr, rtol=4 * np.finfo(cr.dtype).eps, atol=0, equal_nan=True)
    ended = ci[g.NSPOIL]
    trusted = [
        (
            ci[g.MTOP] == size and 1 <= ci[g.MFREE] <= size + 1,
            1,
            f"MFREE and MTOP do not fit an array of {size} words",
        ),
        (ended <= 0 or ended in MESSAGES, 5, f"NSPOIL is {ended}, which is not the number of an error"),
        (0 <= d < np.inf and alike, 5, f"tolerances do not follow from the rounding length, {d:g}"),
    ]
    for true, number, message in trusted:
        if not true:
            state.report(number, message)
