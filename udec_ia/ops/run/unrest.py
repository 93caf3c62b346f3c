"""What keeps a SOLVE from rest, or has spoilt the rest that it found: told from where blocks were on the way.

On the way the places of all blocks are noted, evenly spread and KEPT times at most. The last two quarters of
them are compared. With d the displacements in a quarter, d' those in the one before, sums over blocks
weighted with their masses,

    share     of the kinetic energy in displacement, (sum m d d/2)/T T over it: 1 for what moves one way
    steady    (sum m d d')/sqrt(sum m d d  sum m d' d'): 1 for what goes on in the same direction
    growth    sqrt(sum m d d/sum m d' d'): above 1 for what moves ever faster

tell what moves on from what swings about its place. What moves on collapses, creeps, or settles; of what
swings, contacts may chatter, the energy may fall or not, or the last digit of the coordinates is all that
moves.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from udec_ia.counting import counted
from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.heap.array import MainArray
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.kernels.drive.unbalanced import carried
from udec_ia.kernels.energy.stored import liveliest, strain_of_blocks, strain_of_contacts
from udec_ia.layout import offsets as g
from udec_ia.ops.common.soft import soft_in
from udec_ia.ops.run.bearing import at_strength, closed, overlap, slipped_farthest
from udec_ia.ops.run.chatter import SHARE, Chatter, place_of
from udec_ia.ops.run.damped import damped, what_damps
from udec_ia.ops.run.guard import Guard
from udec_ia.ops.run.remarks import digit_force
from udec_ia.ops.run.timestep import kind_of

FIRST, KEPT = 20, 16  # cycles between the first looks; looks that are kept
ENOUGH = 8  # looks, without which nothing is said of what goes on
ONE_WAY, STEADY = 0.3, 0.5  # share and steady from which on blocks move on
FASTER, SLOWER = 1.15, 0.87  # growth of what collapses, and of what settles
FAR = 0.1  # of the rounding length: what moves less and does not slip has not lost its hold
FALLS = 0.8  # kinetic energy over that of the quarter before, of what settles
SLIPPED = 0.0015  # of the strain energy: work of friction, and shear that contacts lost as they opened, from
# which on the way is said to matter. Slip of a hundredth of the elastic shear takes a fiftieth of the energy
# of shear, which may be a tenth of all (tools/studies/ways.py)
AHEAD = 10_000  # cycles for which what still moves at rest is judged
STOPPED = 0.1  # of its speed in the last quarter: what has no more than that has come to a stop
TRIED = 500, 2000  # cycles, at least and at most, that are tried on a copy to see whether it goes on
NAMED = 3  # blocks that are named
HARDLY = 10  # safe time-steps: the stiffest joints have not swung three times
STATES = (
    "hardly begun",
    "collapse",
    "creep",
    "settles",
    "chatter",
    "swings",
    "last digits",
    "still moves",
    "joints slipped",
)


GoesOn = Callable[[int, float, int], bool]  # block, speed in metres a cycle, cycles: see aside.py


class Look(NamedTuple):
    """cycle; x, y: centroids of all blocks; moving: kinetic energy in J/m."""

    cycle: int
    x: Any
    y: Any
    moving: float


class Motion(NamedTuple):
    """The last two quarters of what was noted; see above. by: how far each block has moved in the last."""

    cycles: int
    by: Any
    share: float
    steady: float
    growth: float
    fall: float  # kinetic energy over that of the quarter before
    now: Any  # what each block would move by in as many cycles with its present velocity


class Unrest:
    """Notes the way of one SOLVE. rested: work of friction until the model was at rest last, in J/m."""

    def __init__(self, rested: float) -> None:
        self.rested = rested
        self.looks: list[Look] = []
        self.every = FIRST
        self._blocks: Any = np.zeros(0, np.int64)

    def begin(self, array: MainArray) -> None:
        """The state before the first cycle, blocks being where they will stay."""
        self._blocks = addresses(array.h, int(array.h.ci[g.IBPNT]), g.KB)
        self.looks, self.every = [], FIRST
        self.note(array)

    def ahead(self, h: Memory) -> int:
        """Cycles until the next look."""
        return self.every - (int(h.ci[g.MCTOT]) - self.looks[0].cycle) % self.every

    def note(self, array: MainArray) -> None:
        """Look, if it is time to."""
        h = array.h
        cycle = int(h.ci[g.MCTOT])
        if self.looks and (cycle == self.looks[-1].cycle or self.ahead(h) != self.every):
            return
        x, y = self._seen(h)
        moving = float(liveliest(h, soft_in(h))[0])
        self.looks.append(Look(cycle, x, y, moving))
        if len(self.looks) > KEPT:
            self.looks, self.every = self.looks[::2], 2 * self.every

    def _seen(self, h: Memory) -> tuple[Any, Any]:
        """Where all blocks are."""
        x, y = (np.asarray(getr(h, self._blocks, k), np.float64) for k in (g.KX, g.KY))
        return x, y

    def motion(self, h: Memory) -> Motion | None:
        """The last two quarters; None if there are too few looks."""
        n = len(self.looks) - 1
        if n < ENOUGH:
            return None
        q = n // 4
        a, b, c = (self.looks[k] for k in (n - 2 * q, n - q, n))
        free = integers(h, self._blocks, g.KBFIX) != g.FIXED
        m = np.where(free, np.asarray(getr(h, self._blocks, g.KBM), np.float64), 0.0)
        (dx, dy), (ex, ey) = ((two.x - one.x, two.y - one.y) for one, two in ((b, c), (a, b)))
        now, before, both = (float((m * s).sum()) for s in (dx**2 + dy**2, ex**2 + ey**2, dx * ex + dy * ey))
        energy, earlier = (
            float(np.mean([one.moving for one in self.looks[k : k + q]])) for k in (n + 1 - q, n + 1 - 2 * q)
        )
        time = (c.cycle - b.cycle) * float(h.cr[g.TDEL])
        vx, vy = (np.asarray(getr(h, self._blocks, k), np.float64) for k in (g.KXD, g.KYD))
        return Motion(
            c.cycle - b.cycle,
            np.where(free, np.hypot(dx, dy), 0.0),
            now / time**2 / 2 / energy if energy > 0 else 0.0,
            both / math.sqrt(now * before) if now * before > 0 else 0.0,
            math.sqrt(now / before) if before > 0 else math.inf,
            energy / earlier if earlier > 0 else 1.0,
            np.hypot(vx, vy) * time,
        )

    def explain(
        self, array: MainArray, reached: bool, wanted: float, guard: Guard, goes_on: GoesOn
    ) -> tuple[str, str]:
        """One of STATES and a sentence; two empty ones if there is nothing to be said."""
        motion = self.motion(array.h)
        if reached and (integers(array.h, self._blocks, g.KBFIX) == g.FIXED).all():
            return "", "all blocks are fixed, and nothing can move: FREE some"
        if reached:
            said = driven(array.h) or (self._still(array.h, motion, goes_on) if motion else "")
            if said:
                return "still moves", said
            said = self._slipped(array.h)
            return ("joints slipped", said) if said else ("", "")
        if motion is None:
            return "", ""
        chatter, safe = guard.chatter, damped(array.h, guard.runaway.safe.step)
        if self._time(array.h) < HARDLY * safe < math.inf:
            return "hardly begun", self._hardly(array.h, safe, wanted)
        falls = self._falling(array.h, motion)
        if falls:
            return "collapse", falls
        if chatter.share >= SHARE and chatter.judged > self.looks[0].cycle:
            return "chatter", self._chatters(array.h, motion, chatter)
        if motion.share > ONE_WAY and motion.steady > STEADY:
            return self._moves_on(array.h, motion)
        return self._swings(array, motion, wanted)

    # ---- not reached

    def _time(self, h: Memory) -> float:
        """Seconds since the beginning, with the present time-step."""
        return (int(h.ci[g.MCTOT]) - self.looks[0].cycle) * float(h.cr[g.TDEL])

    def _hardly(self, h: Memory, safe: float, wanted: float) -> str:
        step = float(h.cr[g.TDEL])
        return (
            f"it has hardly begun: the time-step of {step:.3g} s is {step / safe:.2g} of the safe one, and "
            f"{self._time(h):.2g} s have gone by, in which no joint has swung; take a greater "
            f"FRACTION{self._static(h, wanted)}"
        )

    def _falling(self, h: Memory, motion: Motion) -> str:
        """What is said if a block that no contact bears has fallen far; that of most speed."""
        pull = math.hypot(float(h.cr[g.GRAVX]), float(h.cr[g.GRAVY]))
        bearing = np.concatenate([integers(h, closed(h)[0], k) for k in (g.KB1, g.KB2)])
        loose = ~np.isin(self._blocks, bearing) & (integers(h, self._blocks, g.KBFIX) != g.FIXED)
        vx, vy = (np.asarray(getr(h, self._blocks, k), np.float64) for k in (g.KXD, g.KYD))
        height = np.where(loose, vx * vx + vy * vy, 0.0) / (2 * pull) if pull else np.zeros(len(loose))
        k = int(height.argmax()) if len(height) else 0
        if not len(height) or not height[k] > FAR * h.cr[g.DTOL] or not motion.by[k] > FAR * h.cr[g.DTOL]:
            return ""
        ib = int(self._blocks[k])
        return (
            f"no contact bears block@{ib} at ({getr(h, ib, g.KX):.4g}, {getr(h, ib, g.KY):.4g}): it has come "
            f"{motion.by[k]:.2g} m in the last {motion.cycles} cycles, and falls on at "
            f"{math.hypot(vx[k], vy[k]):.2g} m/s; a support would hold it, or wait until it has landed"
        )

    def _chatters(self, h: Memory, motion: Motion, chatter: Chatter) -> str:
        moved = f", and {self._named(h, motion)}" if motion.by.max() > 0 else ""
        return (
            f"contacts chatter: {chatter.share:.0%} of those that bear a force open and close again and "
            f"again, most of all {chatter.place}{moved}; DAMPING LOCAL 0.8, or a smaller KN"
        )

    def _moves_on(self, h: Memory, motion: Motion) -> tuple[str, str]:
        moved = self._named(h, motion)
        slipping = at_strength(h)
        far, k = motion.by.max() >= FAR * h.cr[g.DTOL], int(motion.by.argmax())
        if far and motion.now[k] < STOPPED * motion.by[k] and h.ci[g.LREST] != g.KINETIC:
            return "settles", f"{moved}, and what moved most has come to a stop; take more cycles (LIMIT)"
        if (far or motion.growth > FASTER) and self._falls(h, motion):
            return "collapse", f"{moved}, and nothing holds what moves most; a support would hold it"
        if not len(slipping) and not far:
            return "settles", f"it settles: {moved}, and no joint slips; take more cycles (LIMIT)"
        slip = (
            f", and joints slip at their strength in {counted(len(slipping), 'contact')}, "
            f"as in {place_of(h, int(slipping[0]))}"
            if len(slipping)
            else ""
        )
        if motion.growth > FASTER:
            return "collapse", (
                f"it collapses: {moved}, {motion.growth:.1f} times as far as in the {motion.cycles} "
                f"before{slip}; more strength or a support would hold it, CYCLE shows where it goes"
            )
        if motion.growth < SLOWER:
            return "settles", (
                f"it slows down: {moved}, {motion.growth:.2f} of the way of the {motion.cycles} "
                f"before{slip}{self._in_all(h, motion)}; take more cycles (LIMIT)"
            )
        return "creep", (
            f"it creeps at a steady pace: {moved}{slip}; more cycles change nothing: the strength or a "
            "support is lacking, and damping alone holds the speed down"
        )

    def _falls(self, h: Memory, motion: Motion) -> bool:
        """True if no contact bears what moves most."""
        ib = int(self._blocks[int(motion.by.argmax())])
        contacts = closed(h)[0]
        return not any((integers(h, contacts, k) == ib).any() for k in (g.KB1, g.KB2))

    def _swings(self, array: MainArray, motion: Motion, wanted: float) -> tuple[str, str]:
        h = array.h
        force, digit = digit_force(array)
        if force > wanted * float(carried(h, soft_in(h))) and motion.by.max() < 100 * digit:
            wider = "reals of 64 bits or " if array.scheme.real_bits < 64 else ""
            return "last digits", (
                f"the last digit of coordinates, {digit:.2g} m, is a force of {force:.3g} N/m in stiff "
                f"joints: the precision allows no smaller ratio; take {wider}a nearer origin"
            )
        if motion.fall < FALLS:
            tenth = motion.cycles * math.log(10) / -math.log(max(motion.fall, 1e-9))
            return "settles", (
                f"it is on its way to rest: the kinetic energy falls to a tenth in about "
                f"{round(tenth, -1):.0f} cycles; take more of them (LIMIT){self._static(h, wanted)}"
            )
        damping = "; ".join(what_damps(h)) or "nothing damps"
        cure = "take DAMPING LOCAL 0.8, which damps at any frequency"
        if h.ci[g.LREST]:
            cure = "take more cycles (LIMIT)"
        return "swings", (
            f"it swings about its place, and does not lose energy: {damping}; {cure}{self._static(h, wanted)}"
        )

    def _static(self, h: Memory, wanted: float) -> str:
        """A quicker way, unless this is it."""
        return "" if h.ci[g.LSCALE] else f", or SOLVE {wanted:g} STATIC"

    def _in_all(self, h: Memory, motion: Motion) -> str:
        """How far what moves most has come since the beginning, if that is much more."""
        x, y = self._seen(h)
        k, first = int(motion.by.argmax()), self.looks[0]
        far = math.hypot(x[k] - first.x[k], y[k] - first.y[k])
        return f"; it has come {far:.2g} m in all" if far > 2 * motion.by[k] else ""

    def _named(self, h: Memory, motion: Motion) -> str:
        """How many blocks move, which do most, and how far they came in the last quarter."""
        order = np.argsort(-motion.by, kind="stable")
        many = int((motion.by > motion.by.max() / 10).sum())
        parts = [
            f"block@{self._blocks[k]} at ({getr(h, int(self._blocks[k]), g.KX):.4g}, "
            f"{getr(h, int(self._blocks[k]), g.KY):.4g}) by {motion.by[k]:.2g} m"
            for k in order[: min(many, NAMED)]
        ]
        blocks = "1 block has" if many == 1 else f"{many} blocks have"
        return f"{blocks} moved in the last {motion.cycles} cycles, {', '.join(parts)}"

    # ---- reached

    def _still(self, h: Memory, motion: Motion, goes_on: GoesOn) -> str:
        """What is said if blocks go on as fast as before, and would get somewhere."""
        usual = overlap(h)
        if motion.steady < 0.9 or motion.growth < 0.9 or motion.share < ONE_WAY:
            return ""
        k = int(motion.by.argmax())
        if not float(motion.by[k]) * AHEAD / motion.cycles > usual:
            return ""
        speed = float(motion.by[k]) / motion.cycles
        n = min(max((self.looks[-1].cycle - self.looks[0].cycle) // 4, TRIED[0]), TRIED[1])
        if not goes_on(int(self._blocks[k]), speed, n):
            return ""
        return f"and yet it moves on, as fast as before: {self._named(h, motion)}; that is no rest"

    def _slipped(self, h: Memory) -> str:
        """What is said if friction and opening contacts have taken much since the last rest."""
        taken = float(h.cd[g.WFRIC]) - self.rested
        stored = float(strain_of_contacts(h)) + float(strain_of_blocks(h, soft_in(h)))
        if taken <= SLIPPED * stored:
            return ""
        share = taken / stored if stored else math.inf
        of = f"{share:.2%} of" if share < 1 else f"{share:.3g} times"
        return (
            f"joints have slipped on the way{slipped_farthest(h)}, or opened and lost their shear: that "
            f"took {taken:.3g} J/m, {of} what joints and blocks hold now, and where all rests may "
            "depend on the way; load in steps, and compare"
        )


def driven(h: Memory) -> str:
    """What is said at rest if a velocity that BOUNDARY gives goes on moving something."""
    bounds = addresses(h, int(h.ci[g.IBNPNT]), g.KU)
    if not len(bounds):
        return ""
    blocks, points, given = (integers(h, bounds, k) for k in (g.KUB, g.KUG, g.KUFIX))
    of_point = points > 0
    some: Any = np.where(of_point, points, 1)
    x, y = (
        np.where(of_point, getr(h, some, kg), getr(h, blocks, k)) * (given & flag != 0)
        for flag, k, kg in ((g.ALONG_X, g.KXD, g.KXDG), (g.ALONG_Y, g.KYD, g.KYDG))
    )
    speed = np.where(integers(h, blocks, g.KBFIX) != g.FIXED, np.hypot(x, y), 0.0)
    k = int(speed.argmax())
    if not speed[k] > 0:
        return ""
    return (
        f"and yet BOUNDARY moves {kind_of(h, int(np.where(of_point, points, blocks)[k]))} at {speed[k]:.3g} "
        "m/s: what is at rest now will not stay so; BOUNDARY ... XVEL=0 YVEL=0 stops it"
    )
