"""Which settings are tried for a deck."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from udec_ia.deck.command_table import COMMANDS
from udec_ia.trade.deck import Deck
from udec_ia.trade.levers import Setting
from udec_ia.trade.steps import longest, share_of_bound
from udec_ia.trade.surveyed import Segment

RUNG = 2**0.5  # of the ladder of time-steps: what is cheapest on it is so to within that factor
LONGEST = 16.0  # times the step of the deck
BEYOND = 1.4  # of the safe bound, which is 0.7 of the true one or more: nothing is stable above
SAFE = (0.9, 0.5)
TIGHTER = 0.1  # ratio of SOLVE, from one level of the reference to the next


def level(setting: Setting, k: int, deck: Deck) -> Setting:
    """The setting of the reference after `k` halvings."""
    ratio = TIGHTER**k if deck.has("solve") else 1.0
    return replace(setting, step=2.0**-k if deck.is_stepped else 1.0, ratio=float(f"{ratio:.6g}"))


def longer(deck: Deck, survey: Sequence[Segment], builds: Sequence[str]) -> list[Setting]:
    """Steps of the deck and above, as far as they can be stable, and what else is cheaper."""
    found: list[Setting] = []
    if not deck.is_stepped:
        found = [Setting(build) for build in builds]
        return found + tighter(deck, found)
    largest = longest(survey)
    for build in builds:
        step = 1.0
        while step <= min(LONGEST * 1.01, largest):
            one = Setting(build, rounded(step))
            if step == 1 or share_of_bound(survey, one) <= BEYOND:
                found.append(one)
            step *= RUNG
        if any(0 < one.bound < math.inf for one in survey):
            found += [Setting(build, safe=safe) for safe in SAFE]
        if deck.rests and has_static():
            found.append(Setting(build, static=True))
    return found + tighter(deck, found)


def tighter(deck: Deck, settings: Sequence[Setting]) -> list[Setting]:
    """The same settings closer to rest."""
    if not deck.has("solve"):
        return []
    return [replace(one, ratio=one.ratio * TIGHTER) for one in settings]


def shorter(deck: Deck, builds: Sequence[str], finest: float) -> list[Setting]:
    """Steps below that of the deck, down to `finest`, if they matter to it."""
    if not deck.is_stepped:
        return []
    found: list[Setting] = []
    step = 1 / RUNG
    while step > finest * 0.99:
        found += [Setting(build, rounded(step)) for build in builds]
        step /= RUNG
    return found


def rounded(step: float) -> float:
    """A step as it is written: no two of one name differ in their last digits."""
    return float(f"{step:.4g}")


def has_static() -> bool:
    """True if the deck language has SOLVE ... STATIC."""
    solve = next(one for one in COMMANDS if one.name == "solve")
    return any(word.keyword.upper() == "STATIC" for word in solve.words)
