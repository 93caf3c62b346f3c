"""The block pass: every block moves by the law of its type (report 2.6).

`soft` is None in a scene that has rigid blocks only: numba then leaves all else out of the machine code,
and such a scene neither compiles nor tests anything about deformable blocks. `laws` is None unless one of
these follows a law of the user's.
"""

from __future__ import annotations

from typing import Any

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.compiling.prefetch import LEAD, fetch
from udec_ia.errors import TOO_FAR
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, real
from udec_ia.kernels.body.fdef import move_fdef
from udec_ia.kernels.body.motion import motion
from udec_ia.kernels.body.sdef import move_sdef
from udec_ia.kernels.geometry.shape import keep_circles
from udec_ia.layout import offsets as g

KEEP = 16  # cycles from one time to the next that rigid blocks have their circles put back
FINE = 1e-10  # reals that cannot tell 1 + FINE from 1 need that


@inlined
def check_place(h: Memory, ib: int) -> None:
    """Error 36 if block `ib` is where reals no longer tell x from x + FTOL, or if its place is no number."""
    x, y, tolerance = abs(getr(h, ib, g.KX)), abs(getr(h, ib, g.KY)), h.cr[g.FTOL]
    if not (x + tolerance > x and y + tolerance > y) and h.ci[g.NERR] == 0:
        h.ci[g.NERR] = TOO_FAR
        h.ci[g.IERAD] = ib


@kernel
def move_all(h: Memory, soft: Any, laws: Any) -> float:
    """Move every block; returns a bound on the velocity, in x or in y, of any point.

    Error 36 if a block has flown to where nothing can be calculated any more.
    """
    fastest = real(h, 0.0)
    narrow = real(h, 1.0) + real(h, FINE) == real(h, 1.0)
    keep = narrow and h.ci[g.MCTOT] % KEEP == 0
    ib = h.ci[g.IBPNT]
    while ib != 0:
        fetch(h, ib, g.NVBL, LEAD)
        if soft is not None:
            kind = iget(h, ib, HEAD)
            if kind == g.MFDEF:
                fastest = max(fastest, move_fdef(h, ib, laws))
            elif kind == g.MSDEF:
                fastest = max(fastest, move_sdef(h, ib, laws))
            else:
                fastest = max(fastest, motion(h, ib))
        else:
            fastest = max(fastest, motion(h, ib))
        if keep and iget(h, ib, HEAD) == g.MRIG and iget(h, ib, g.KBFIX) != g.FIXED:
            keep_circles(h, ib)
        check_place(h, ib)
        ib = iget(h, ib, g.KB)
    return fastest
