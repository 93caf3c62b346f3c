"""What keeps a SOLVE from rest, or has spoilt the rest that it found: told from where blocks were on the way.

Where blocks were in the last two quarters of the run (noted.py) tells what moves on from what swings about
its place. What moves on collapses, creeps, or settles; of what swings, contacts may chatter, the energy may
fall or not, or the last digit of the coordinates is all that moves.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from udec_ia.counting import counted
from udec_ia.heap.accessors import Memory, getr, integers
from udec_ia.heap.main_array import MainArray
from udec_ia.kernels.drive.timestep import addresses
from udec_ia.kernels.drive.unbalanced import carried
from udec_ia.kernels.energy.stored import strain_of_blocks, strain_of_contacts
from udec_ia.layout import offsets as g
from udec_ia.ops.common.deformable_scene import soft_in
from udec_ia.ops.run.bearing import at_strength, borne, overlap, own_laws, slipped_farthest
from udec_ia.ops.run.chatter import SHARE, Chatter, place_of
from udec_ia.ops.run.damped import damped, what_damps
from udec_ia.ops.run.guard import Guard
from udec_ia.ops.run.noted import Motion, Noted
from udec_ia.ops.run.remarks import digit_force
from udec_ia.ops.run.timestep import kind_of

ONE_WAY, STEADY = 0.3, 0.5  # share and steady from which on blocks move on
FASTER, SLOWER = 1.15, 0.87  # growth of what collapses, and of what settles
FAR = 0.1  # of the rounding length: what moves less and does not slip has not lost its hold
FALLS = 0.8  # energy that swings over that of the quarter before, of what settles
SLIPPED = 0.0015  # of the strain energy: work of friction, and shear that contacts lost as they opened, from
# which on the way is said to matter. Slip of a hundredth of the elastic shear takes a fiftieth of the energy
# of shear, which may be a tenth of all (tools/studies/ways.py)
AHEAD = 10_000  # cycles for which what still moves at rest is judged
KEEPS = 0.1  # of its speed at the end: what has so much after the cycles on the copy goes on
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
SpeedAfter = Callable[[int, int], float]  # of a block, after some cycles, in metres a cycle: see aside.py


class Unrest(Noted):
    """Judges the way of one SOLVE. rested: work of friction until the model was at rest last, in J/m."""

    def __init__(self, rested: float) -> None:
        super().__init__()
        self.rested = rested

    def explain(
        self, array: MainArray, reached: bool, wanted: float, guard: Guard, speed_after: SpeedAfter
    ) -> tuple[str, str]:
        """One of STATES and a sentence; two empty ones if there is nothing to be said."""
        motion = self.motion(array.h)
        if reached and (integers(array.h, self._blocks, g.KBFIX) == g.FIXED).all():
            return "", "all blocks are fixed, and nothing can move: FREE some"
        if reached:
            said = driven(array.h) or (self._still(array.h, motion, speed_after) if motion else "")
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
        loose = ~np.isin(self._blocks, borne(h)) & (integers(h, self._blocks, g.KBFIX) != g.FIXED)
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
        if (far or motion.growth > SLOWER) and self._falls(h, motion):
            return "collapse", f"{moved}, and nothing holds what moves most; a support would hold it"
        steady = SLOWER <= motion.growth <= FASTER
        if not len(slipping) and not far and not (steady and own_laws(h)):
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
                f"before{slip}{self._in_all(h, motion)}; {self._slower(h)}"
            )
        return "creep", f"it creeps at a steady pace: {moved}{slip}; {self._steady(h, slipping)}"

    def _slower(self, h: Memory) -> str:
        """What to do about what slows down."""
        if h.ci[g.LREST] == g.KINETIC:
            return "KINETIC damping has stopped it on the way, and it may go on: take more cycles (LIMIT)"
        return "take more cycles (LIMIT)"

    def _steady(self, h: Memory, slipping: Any) -> str:
        """What there is to be said of a steady pace."""
        if not what_damps(h):
            return "nothing damps, and contacts open as they swing: DAMPING LOCAL 0.8 shows what holds"
        if not len(slipping) and own_laws(h):
            return "more cycles change nothing: the law of its contacts lets it"
        return (
            "more cycles change nothing: the strength or a support is lacking, and damping alone holds the "
            "speed down"
        )

    def _falls(self, h: Memory, motion: Motion) -> bool:
        """True if no contact bears what moves most."""
        return int(self._blocks[int(motion.by.argmax())]) not in borne(h)

    def _swings(self, array: MainArray, motion: Motion, wanted: float) -> tuple[str, str]:
        h = array.h
        force, digit = digit_force(array)
        if force > wanted * float(carried(h, soft_in(h))) and motion.by.max() < 100 * digit:
            wider = "reals of 64 bits or " if array.scheme.real_bits < 64 else ""
            return "last digits", (
                f"the last digit of coordinates, {digit:.2g} m, is a force of {force:.3g} N/m in stiff "
                f"joints: the precision allows no smaller ratio; take {wider}a nearer origin"
            )
        if motion.fall < FALLS and what_damps(h):
            tenth = motion.cycles * math.log(10) / -math.log(max(motion.fall, 1e-9))
            return "settles", (
                f"it is on its way to rest: the kinetic energy falls to a tenth in about "
                f"{round(tenth, -1):.0f} cycles; take more of them (LIMIT){self._static(h, wanted)}"
            )
        damping = "; ".join(what_damps(h)) or "nothing damps"
        loses = "and does not lose energy"
        if motion.fall < FALLS:
            loses = "and friction alone takes energy, which it may cease to"
        cure = "take DAMPING LOCAL 0.8, which damps at any frequency"
        if h.ci[g.LREST]:
            cure = "take more cycles (LIMIT)"
        return "swings", f"it swings about its place, {loses}: {damping}; {cure}{self._static(h, wanted)}"

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

    def _still(self, h: Memory, motion: Motion, speed_after: SpeedAfter) -> str:
        """What is said if blocks go on as fast as before, and would get somewhere."""
        usual = overlap(h)
        as_before = motion.growth >= 0.9 or len(at_strength(h))  # what slips slows down, and may never stop
        if motion.steady < 0.9 or motion.share < ONE_WAY or not as_before:
            return ""
        k = int(motion.by.argmax())
        way = motion.by[k] if h.ci[g.LREST] == g.KINETIC else min(motion.by[k], motion.now[k])
        speed = float(way) / motion.cycles
        if not speed * AHEAD > usual:
            return ""
        n = min(max((self.looks[-1].cycle - self.looks[0].cycle) // 4, TRIED[0]), TRIED[1])
        later = speed_after(int(self._blocks[k]), n)
        if later * AHEAD <= usual or later < KEEPS * speed:
            return ""
        return f"and yet it moves on: {self._named(h, motion)}; that is no rest"

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
