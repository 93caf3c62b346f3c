"""A lone block made, changed and moved for some cycles: what tests/heap/test_plain.py runs in its processes.

Printed are whatever is told of compiling, and in the last line a hash of all words and what the checker says.
"""

from __future__ import annotations

import logging
import sys
from hashlib import sha256
from typing import Any

from udec_ia import Model
from udec_ia.compiling.kernel_decorators import outlined
from udec_ia.compiling.non_inlined_calls import entry
from udec_ia.heap.accessors import Memory
from udec_ia.kernels.drive import cycle as passes


@outlined
def nothing_found(h: Memory, domain: int) -> bool:
    """Stands for the update of domains, half of the time to compile: a lone block finds nothing."""
    return True


@outlined
def none_waits(h: Memory, waiting: Any, n: int, have_forces: bool) -> bool:
    """Stands for the changes of the map, a quarter of the time to compile: a lone block has no contact."""
    return True


def main() -> None:
    """Play the scene."""
    logging.basicConfig(level=logging.WARNING, stream=sys.stdout, format="%(message)s")
    passes.updating = lambda h: entry(nothing_found, h, 0)
    passes.change_map = none_waits
    m = Model()
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    m.property(1, density=2000, kn=1e8, ks=1e8)
    m.gravity(0, -10)
    m.rset(0.5, int(m.table("block")["address"][0]), 7)
    m.cycle(3)
    print(sha256(m.array.h.ia.tobytes() + m.array.h.cr.tobytes()).hexdigest(), m.check())


if __name__ == "__main__":
    main()
