"""The block pass: every block moves by the law of its type (report 2.6).

`soft` is None in a scene that has rigid blocks only: numba then leaves all else out of the machine code,
and such a scene neither compiles nor tests anything about deformable blocks. `laws` is None unless one of
these follows a law of the user's.
"""

from __future__ import annotations

from typing import Any

from offsets.generated import IBPNT, KB, MFDEF, MSDEF, NVBL
from udec_ia.heap.accessors import HEAD, Memory, iget, real
from udec_ia.heap.ahead import LEAD, fetch
from udec_ia.heap.jit import kernel
from udec_ia.kernels.fdef import move_fdef
from udec_ia.kernels.motion import motion
from udec_ia.kernels.sdef import move_sdef


@kernel
def move_all(h: Memory, soft: Any, laws: Any) -> float:
    """Move every block; returns a bound on the velocity, in x or in y, of any point."""
    fastest = real(h, 0.0)
    ib = h.ci[IBPNT]
    while ib != 0:
        fetch(h, ib, NVBL, LEAD)
        if soft is not None:
            kind = iget(h, ib, HEAD)
            if kind == MFDEF:
                fastest = max(fastest, move_fdef(h, ib, laws))
            elif kind == MSDEF:
                fastest = max(fastest, move_sdef(h, ib, laws))
            else:
                fastest = max(fastest, motion(h, ib))
        else:
            fastest = max(fastest, motion(h, ib))
        ib = iget(h, ib, KB)
    return fastest
