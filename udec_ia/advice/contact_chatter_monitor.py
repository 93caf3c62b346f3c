"""The monitor of contacts that chatter: it warns in a run, with the place and a remedy.

A stiff contact swings at a frequency that mass damping of a low one does not reach. Where it swings so widely
that it opens, it loses its friction each time, and what lies on such contacts slides at any friction.

The only cost is a look at all contacts every LOOK cycles (kernels.drive.cycle). Every JUDGE cycles the
contacts are counted that have opened or closed between OFTEN pairs of looks or more, against all that bore a
force. Blocks that fall or settle rattle as well, in some places and for a while. It is chatter if a SHARE of
all contacts does so in two such windows in a row.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.constitutive.joint_properties import joints_of
from udec_ia.kernels.drive.cycle import LOOK, STRIDE
from udec_ia.kernels.links.linked_lists import addresses
from udec_ia.layout import offsets as g
from udec_ia.remark_key import Remark
from udec_ia.running.group_names import contact_name

JUDGE = 1000  # cycles of a window
OFTEN = 4  # openings and closings within a window, of JUDGE / LOOK that can be seen
SHARE = 0.25  # of the contacts that bear a force
FEWEST = 4  # contacts; of fewer one cannot tell chatter from blocks that bounce
ROOM = 1.25  # more marks than are needed, when more are needed


class ChatterMonitor:
    """Monitors the contacts of one model. tell: takes warnings.

    share: of the contacts that bore a force, what chattered in the last window.
    """

    def __init__(self, tell: Callable[[str], None] = lambda warning: None) -> None:
        self.tell = tell
        self.share = 0.0
        self._judged = 0  # cycle at the end of the last window
        self._warned = False
        self._marks = np.zeros(0, np.uint8)

    def marks(self, h: Memory, n: int) -> Any:
        """Marks for `n` cycles, as drive.cycle wants them: none before there is a window to be judged."""
        if h.ci[g.MCTOT] + n < JUDGE:
            return np.zeros(0, np.uint8)
        needed = int(h.ci[g.MFREE]) // STRIDE + 1
        if needed > len(self._marks):
            more = np.zeros(int(ROOM * needed), np.uint8)
            more[: len(self._marks)] = self._marks
            self._marks = more
        return self._marks

    def judge(self, array: MainArray, safe: bool) -> None:
        """Warn at the end of a window, every JUDGE cycles, if contacts chatter; once until they cease to.

        safe: the time-step is safe; one that is not makes contacts chatter, and has its own warning.
        """
        h = array.h
        cycle = int(h.ci[g.MCTOT])
        if cycle % JUDGE or cycle == self._judged or not len(self._marks):
            return
        self._judged = cycle
        often = self._marks >= 2 * OFTEN
        bore, many = int((self._marks > 0).sum()), int(often.sum())
        before, self.share = self.share, many / max(bore, 1) if many >= FEWEST else 0.0
        if self.share >= SHARE:
            if before >= SHARE and safe and not self._warned:
                self._warned = True
                text = f"contacts chatter: {many} of {bore} {self._what(h, self._worst(h))}"
                self.tell(Remark("contacts-chatter", text))
        elif self.share < SHARE / 2:
            self._warned = False
        self._marks &= 1

    def _worst(self, h: Memory) -> int:
        """The contact that has opened and closed most often."""
        contacts = addresses(h, int(h.ci[g.ICPNT]), g.KC)
        at = contacts // STRIDE
        seen = np.where(at < len(self._marks), self._marks[np.minimum(at, len(self._marks) - 1)], 0)
        return int(contacts[int(seen.argmax())])

    def _what(self, h: Memory, worst: int) -> str:
        """What they do, where it is worst, and the remedy."""
        frequency = _own_frequency(h, worst)
        share = _fraction_of_critical(h, 2 * math.pi * frequency)
        damping = "" if h.ci[g.LREST] else f", where damping is {share:.2g} of critical"
        cure = (
            "take a smaller FRACTION or KN"
            if h.ci[g.LREST]
            else "DAMPING LOCAL 0.8 damps at any frequency, for a state of rest; or take a smaller KN"
        )
        return (
            f"that bear a force open and close again and again (in {OFTEN} and more of the last "
            f"{JUDGE // LOOK} looks, each {LOOK} cycles), most of all {contact_name(h, worst)}. They swing "
            f"at about {frequency:.3g} Hz{damping}; a joint that opens has no friction, and what lies on it "
            f"slides: {cure}"
        )


def _fraction_of_critical(h: Memory, w: float) -> float:
    """Rayleigh damping at `w` (rad/s), as a fraction of critical damping."""
    return float(h.cr[g.ALPHA]) / (2 * w) + float(h.cr[g.BETA]) * w / 2 if w > 0 else 0.0


def _own_frequency(h: Memory, ic: int) -> float:
    """Frequency (Hz) of the lighter block of contact `ic` on two springs like it."""
    blocks = [iget(h, ic, k) for k in (g.KB1, g.KB2)]
    masses = [float(getr(h, ib, g.KBM)) for ib in blocks if iget(h, ib, g.KBFIX) != g.FIXED]
    kn = float(joints_of(h, np.array([ic])).kn[0])
    return math.sqrt(2 * kn / min(masses, default=math.inf)) / (2 * math.pi)
