"""The monitor of contacts that chatter: contacts that open and close again and again.

A stiff contact vibrates at a frequency that mass damping of a low frequency does not reach. If it opens, it
loses its friction each time, and blocks on such contacts slide at any friction.

All contacts are examined every 100 cycles (LOOK in kernels/drive/cycle.py). In a window of JUDGE cycles a
contact chatters if it has opened or closed between OFTEN pairs of looks or more. Blocks that fall or settle
rattle as well, for a while. So the warning needs two windows in a row in which a SHARE of the loaded contacts
chatters.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_stresses import joints_of
from udec_ia.kernels.drive.cycle import STRIDE
from udec_ia.layout import offsets as g
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.remark import Remark
from udec_ia.running.group_names import contact_name

JUDGE = 1000  # cycles of a window
OFTEN = 4  # openings and closings in a window, of at most JUDGE / 100
SHARE = 0.25  # of the contacts that carry a force
FEWEST = 4  # contacts that chatter; fewer may be blocks that bounce
ROOM = 1.25  # size of a new array of marks over the size needed


class ChatterMonitor:
    """Monitors the contacts of one model. tell: takes warnings.

    share: of the loaded contacts, those that chattered in the last window.
    """

    def __init__(self, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.tell = tell
        self.share = 0.0
        self._checked = 0  # cycle at the end of the last window
        self._warned = False
        self._marks = np.zeros(0, np.uint8)

    def marks(self, h: Memory, n: int) -> Any:
        """Marks for the next `n` cycles of drive.cycle; an empty array if no window ends in these."""
        if h.ci[g.MCTOT] + n < JUDGE:
            return np.zeros(0, np.uint8)
        needed = int(h.ci[g.MFREE]) // STRIDE + 1
        if needed > len(self._marks):
            self._marks = np.pad(self._marks, (0, int(ROOM * needed) - len(self._marks)))
        return self._marks

    def forget(self) -> None:
        """Forget all marks: groups have new addresses."""
        self._marks[:] = 0

    def check_window(self, array: MainArray, safe: bool) -> None:
        """At the end of a window, warn if contacts chatter; once until they stop.

        safe: the time-step is safe; an unsafe one makes contacts chatter, and has its own warning.
        """
        h = array.h
        cycle = int(h.ci[g.MCTOT])
        if cycle % JUDGE or cycle == self._checked or not len(self._marks):
            return
        self._checked = cycle
        loaded, many = int((self._marks > 0).sum()), int((self._marks >= 2 * OFTEN).sum())
        before, self.share = self.share, many / max(loaded, 1) if many >= FEWEST else 0.0
        if self.share >= SHARE and before >= SHARE and safe and not self._warned:
            self._warned = True
            self.tell(Remark("contacts-chatter", self._text(h, many, loaded)))
        elif self.share < SHARE / 2:
            self._warned = False
        self._marks &= 1

    def _text(self, h: Memory, many: int, loaded: int) -> str:
        """The warning, with the contact that has opened and closed most often."""
        contacts = list_of(h, "contact")
        at = contacts // STRIDE
        seen = np.where(at < len(self._marks), self._marks[np.minimum(at, len(self._marks) - 1)], 0)
        worst = int(contacts[int(seen.argmax())])
        frequency = _own_frequency(h, worst)
        damping, cure = "", "use a smaller FRACTION or KN"
        if not h.ci[g.LREST]:
            damping = f", where damping is {_fraction_of_critical(h, frequency):.2g} of critical"
            cure = "use DAMPING LOCAL 0.8, which damps all frequencies, for a state of rest; or a smaller KN"
        return (
            f"contacts chatter: {many} of {loaded} loaded contacts open and close repeatedly, most often "
            f"{contact_name(h, worst)}. They vibrate at about {frequency:.3g} Hz{damping}. An open joint has "
            f"no friction, and blocks on it slide: {cure}"
        )


def _fraction_of_critical(h: Memory, frequency: float) -> float:
    """Rayleigh damping at a frequency (Hz), as a fraction of critical damping."""
    w = 2 * math.pi * frequency
    return float(h.cr[g.ALPHA]) / (2 * w) + float(h.cr[g.BETA]) * w / 2 if w > 0 else 0.0


def _own_frequency(h: Memory, ic: int) -> float:
    """Frequency (Hz) of the lighter block of contact `ic` between two springs like it."""
    blocks = [iget(h, ic, k) for k in (g.KB1, g.KB2)]
    masses = [float(getr(h, ib, g.KBM)) for ib in blocks if iget(h, ib, g.KBFIX) != g.FIXED]
    kn = float(joints_of(h, np.array([ic])).kn[0])
    return math.sqrt(2 * kn / min(masses, default=math.inf)) / (2 * math.pi)
