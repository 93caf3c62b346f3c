"""The calculation cycle (CYCLE; report 2.6): blocks, domains, contacts.

JPHASE says which pass comes next, so that a cycle that had to stop, because an update ran out of memory or
a pass is not compiled yet, can be taken up again at that very point and goes on as if it had not stopped.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import kernel
from udec_ia.compiling.outlined_calls import call_entry
from udec_ia.heap.accessors import Memory, int64
from udec_ia.heap.find_lose import room
from udec_ia.kernels.body.blocks import move_all
from udec_ia.kernels.contact.ford import ford_all
from udec_ia.kernels.detect.domains import accumulate
from udec_ia.kernels.drive.passes import (
    BOUNDS,
    CHANGES,
    CONTACT,
    FORCES,
    LOADS,
    MOTION,
    RELAX,
    STRESSES,
    TUNNELLING,
    UPDATE,
)
from udec_ia.layout import offsets as g

CONTACTS = 1000  # for each of which a safe time-step may wait a cycle to be judged again


@kernel
def has_to_judge(h: Memory) -> bool:
    """True if contacts have been made since a SAFE time-step was found: it may be too long for them.

    In a large model that waits for a cycle whose number is a multiple of its thousands of contacts. Where
    masses are scaled the step stays.
    """
    if h.ci[g.LSAFE] == 0 or h.ci[g.LSCALE] != 0 or h.ci[g.NMADE] == h.ci[g.MSCALE]:
        return False
    return bool(h.ci[g.MCTOT] % (1 + h.ci[g.NCON] // CONTACTS) == 0)


@kernel
def run_cycles(h: Memory, n: int, soft: Any, laws: Any, joints: Any, passes: Any) -> int:
    """Up to `n` cycles; returns how many were completed. Stops early when NERR is set.

    soft: None if all blocks are rigid, else True. laws: of blocks, None if
    `soft` is. joints: None if no contact follows a law of the user's, else these (compiling.law_calls).
    passes: see drive.passes. Stops early, too, when a safe time-step has to be judged.
    """
    waiting = np.empty(h.ci[g.NCON], np.int64)
    done = 0
    while done < n:
        if h.ci[g.JPHASE] == g.AT_BLOCKS:
            if h.ci[g.NSPARE] > 0 and not room(h, h.ci[g.NSPARE]):
                return done  # IA() grows between two cycles, where growing changes nothing
            if passes[BOUNDS] != 0:
                call_entry(passes[BOUNDS], h)
            if passes[MOTION] != 0:
                call_entry(passes[MOTION], h)
            if passes[RELAX] != 0:
                call_entry(passes[RELAX], h)
            if passes[FORCES] != 0:
                call_entry(passes[FORCES], h)
            if passes[LOADS] != 0:
                call_entry(passes[LOADS], h)
            fastest = move_all(h, soft, laws)
            if passes[STRESSES] != 0:
                call_entry(passes[STRESSES], h)
            h.ci[g.JPHASE] = accumulate(h, fastest, soft)
        if h.ci[g.JPHASE] == g.AT_WAYS:
            if passes[TUNNELLING] == 0:
                return done  # it is not compiled before a step needs it
            call_entry(passes[TUNNELLING], h)
            h.ci[g.JPHASE] = g.AT_DOMAINS
        if h.ci[g.JPHASE] == g.AT_DOMAINS:
            if not call_entry(passes[UPDATE], h, int64(0)):
                return done
            h.ci[g.JPHASE] = g.AT_CONTACTS
        if h.ci[g.JPHASE] == g.AT_CONTACTS:
            broken = h.ci[g.NBROKE]
            if len(waiting) < h.ci[g.NCON]:
                waiting = np.empty(2 * h.ci[g.NCON], np.int64)
            ford_all(h, soft, joints, passes[CHANGES], passes[CONTACT], waiting)
            h.ci[g.JPHASE] = g.AT_BLOCKS if h.ci[g.NBROKE] == broken else g.AT_BROKEN
        if h.ci[g.JPHASE] == g.AT_BROKEN:  # domains that merged are looked through at once
            if not call_entry(passes[UPDATE], h, int64(0)):
                return done
            h.ci[g.JPHASE] = g.AT_BLOCKS
        h.ci[g.MCTOT] += 1
        h.cd[g.TIME] += h.cr[g.TDEL]
        done += 1
        if h.ci[g.NERR] != 0 or has_to_judge(h):
            return done
    return done
