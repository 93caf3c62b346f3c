"""Settings: what a run of a deck is made with, and the numbers that follow from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from udec_ia.heap.word_scheme import DEFAULT_SCHEME


@dataclass(frozen=True)
class Setting:
    """What a run is made with.

    build: word scheme. step: times the time-step of the deck. safe: fraction of the safe bound instead, 0 for
    none. ratio: times the ratio of SOLVE. static: SOLVE ... STATIC. rounding, edge, stiffness: times the
    lengths of ROUND and of GENERATE ... EDGE, and KN and KS. contact: times KN, KS and the cohesions, which
    are those of one contact, instead. types: "" as they are, "rigid" or "sdef".
    """

    build: str = DEFAULT_SCHEME
    step: float = 1.0
    safe: float = 0.0
    ratio: float = 1.0
    static: bool = False
    rounding: float = 1.0
    edge: float = 1.0
    stiffness: float = 1.0
    contact: float = 1.0
    types: str = ""

    @property
    def name(self) -> str:
        """What it is called, and its folder."""
        parts = [self.build]
        if self.safe:
            parts.append(f"safe={self.safe:.3g}")
        elif not self.static:
            parts.append(f"step={self.step:.4g}")
        times = {
            "ratio": self.ratio,
            "round": self.rounding,
            "edge": self.edge,
            "stiffness": self.stiffness,
            "contact": self.contact,
        }
        parts += [f"{what}={factor:.3g}" for what, factor in times.items() if factor != 1]
        parts += ["static"] if self.static else []
        parts += [self.types] if self.types else []
        return ",".join(parts)


@dataclass(frozen=True)
class Numbers:
    """What a setting puts into the lines that count cycles.

    fit: times the fraction that is asked for, a little below 1. cycles: of each CYCLE and SOLVE, in order;
    None as they are. longer: of each of these, time-step of the deck over the new one. limits: cycles of each
    SOLVE, after which it gives up; None as it is.
    """

    fit: float = 1.0
    cycles: tuple[int | None, ...] = ()
    longer: tuple[float, ...] = ()
    limits: tuple[int | None, ...] = ()


class Fraction(NamedTuple):
    """What FRACTION says. words: " SAFE" or " SCALED", "" for a fraction of the estimate."""

    value: float
    words: str = ""
